// PL-73: formations: a star and its planets move as one body, rotations included.
#include <algorithm>

#include "../core/trials.h"
#include "takt/core/angle.h"
#include "troop.h"

namespace takt::mover {
namespace {

using planar::ObjectState;

std::vector<MoverParams> Plate() {
  return {Turning(200, 200), Turning(500, 200), Turning(500, 500), Turning(200, 500)};
}

TEST(MoverFormation, PlanetsKeepTheirPlaceAroundTheStar) {
  Troop t(Plate());
  t.Form();
  for (const Ticket join : t.joins) {
    EXPECT_EQ(t.Of(join).state, FeedbackState::kActive);
    EXPECT_TRUE(t.Of(join).reached);
  }
  EXPECT_EQ(t.outs[1].command_mode, CommandMode::kFormation);
  EXPECT_EQ(t.outs[0].command_mode, CommandMode::kFreeMovement);
  for (const Outputs& out : t.outs) EXPECT_EQ(out.formation, 1u);
  const Ticket move = t.Give(0, MoveToPosition{.x = 900, .y = 700, .c = 90, .use_orientation = true});
  EXPECT_EQ(t.Become(move), FeedbackState::kDone);
  // Turned by 90 deg about the star: (x, y) becomes (-y, x).
  EXPECT_NEAR(t.outs[1].x, 900, 1e-9);
  EXPECT_NEAR(t.outs[1].y, 1000, 1e-9);
  EXPECT_NEAR(t.outs[2].x, 600, 1e-9);
  EXPECT_NEAR(t.outs[2].y, 1000, 1e-9);
  EXPECT_NEAR(t.outs[3].x, 600, 1e-9);
  EXPECT_NEAR(t.outs[3].y, 700, 1e-9);
  for (const Outputs& out : t.outs) EXPECT_NEAR(out.c, 90, 1e-9);

  const Ticket leave = t.Give(2, LeaveFormation{});
  EXPECT_EQ(t.Of(leave).state, FeedbackState::kDone);
  EXPECT_EQ(t.Of(t.joins[1]).state, FeedbackState::kDone);
  t.Step();
  EXPECT_EQ(t.outs[2].formation, 0u);
  EXPECT_EQ(t.outs[2].command_mode, CommandMode::kFreeMovement);
  EXPECT_EQ(t.Become(t.Give(0, MoveToPosition{.x = 200, .y = 200})), FeedbackState::kDone);
  EXPECT_NEAR(t.outs[1].y, 500, 1e-9);
  EXPECT_NEAR(t.outs[2].x, 600, 1e-9);
  EXPECT_EQ(t.Become(t.Give(2, MoveToPosition{.x = 700, .y = 700})), FeedbackState::kDone);
}

// The slowest member limits X and Y while the body does not turn; the member furthest away limits the rotation in
// place.
TEST(MoverFormation, KeepsTheLimitsOfTheSlowest) {
  std::vector<MoverParams> params = Plate();
  params[2].xy.maximum = {300, 4000, 3000.0, 50000};
  Troop t(params);
  t.Form();
  const Ticket move = t.Give(0, MoveToPosition{.x = 1200, .y = 200});
  EXPECT_EQ(t.outs[0].limited_by, LimitedBy::kNothing);
  double most = 0;
  for (int i = 0; !IsFinal(t.Of(move).state) && i < 10000; ++i) {
    t.Step();
    most = std::max(most, t.outs[0].velocity_x);
  }
  EXPECT_NEAR(most, 300, 1e-6);
  const Ticket turn = t.Give(0, MoveC{.position = 180});
  double quickest = 0;
  for (int i = 0; !IsFinal(t.Of(turn).state) && i < 10000; ++i) {
    t.Step();
    quickest = std::max(quickest, std::hypot(t.outs[2].velocity_x, t.outs[2].velocity_y));
  }
  EXPECT_EQ(t.Of(turn).state, FeedbackState::kDone);
  EXPECT_NEAR(quickest, 300, 1e-6);
  // A velocity that is too high is reduced, and reported.
  t.Give(0, MoveToPosition{.x = 0, .y = 0, .velocity = 301});
  t.Step();
  EXPECT_EQ(t.outs[0].limited_by, LimitedBy::kVelocity);
}

// If the jerk of the planets is the binding limit, turning uses most of it and no more.
TEST(MoverFormation, TurnsWithinTheJerkOfThePlanets) {
  std::vector<MoverParams> params = {Turning(0, 0), Turning(300, 400), Turning(-500, 0)};
  for (MoverParams& p : params) {
    p.xy.maximum = {5000, 50000, {}, 10000};
    p.c.maximum = {2000, 20000, {}, 400000};
  }
  Troop t(params);
  t.Form();
  const Ticket turn = t.Give(0, MoveC{.position = 150});
  double most = 0;
  while (!IsFinal(t.Of(turn).state)) {
    const Complex before = AccelerationOf(t.states[1].set_point);
    t.Step();
    most = std::max(most, std::abs(AccelerationOf(t.states[1].set_point) - before) / 0.001);
  }
  EXPECT_LT(most, 10000);
  EXPECT_GT(most, 7000);
}

// A motion that began alone has to be over before the other begins; motions that began together continue together.
TEST(MoverFormation, TurnsAndMovesAtOnceOnlyFromRest) {
  Troop t(Plate());
  t.Form();
  const Ticket move = t.Give(0, MoveToPosition{.x = 1200, .y = 200});
  t.Run(100);
  EXPECT_EQ(t.Of(t.Give(0, MoveC{.position = 45})).error, ErrorId::kFormationShare);
  EXPECT_EQ(t.Of(t.Give(0, MoveToPosition{.x = 900, .y = 400, .c = 45, .use_orientation = true})).error,
            ErrorId::kFormationShare);
  EXPECT_EQ(t.Become(move), FeedbackState::kDone);
  const Ticket turn = t.Give(0, MoveC{.position = 45});
  t.Run(50);
  EXPECT_EQ(t.Of(t.Give(0, MoveToPosition{.x = 200, .y = 200})).error, ErrorId::kFormationShare);
  EXPECT_EQ(t.Become(turn), FeedbackState::kDone);
  t.Give(0, MoveToPosition{.x = 200, .y = 200, .c = 90, .use_orientation = true});
  t.Run(100);
  const Ticket other = t.Give(0, MoveToPosition{.x = 400, .y = 600, .c = 0, .use_orientation = true});
  EXPECT_EQ(t.Become(other), FeedbackState::kDone);
}

// If X, Y and C begin at once, the shares of the dynamics minimise the total time: a small turn or a short path costs
// hardly anything.
TEST(MoverFormation, SharesTheDynamicsWell) {
  const auto takes = [](double x, double c) {
    Troop t(Plate());
    t.Form();
    const Ticket move = t.Give(0, MoveToPosition{.x = 200 + x, .y = 200, .c = c, .use_orientation = true});
    EXPECT_EQ(t.Become(move), FeedbackState::kDone);
    return t.Of(move).value;
  };
  const double straight = takes(1500, 0), turn = takes(0, 150);
  EXPECT_LT(takes(1500, 10), 1.15 * straight);
  EXPECT_LT(takes(10, 150), 1.1 * turn);
  const double both = takes(1500, 150);
  EXPECT_GT(both, std::max(straight, turn));
  EXPECT_LT(both, straight + turn);  // than one after the other
}

TEST(MoverFormation, WhatAPlanetAccepts) {
  Troop t(Plate());
  t.Form();
  EXPECT_EQ(t.Of(t.Give(1, MoveToPosition{.x = 0})).error, ErrorId::kCommandMode);
  EXPECT_EQ(t.Of(t.Give(1, MoveC{.position = 3})).error, ErrorId::kCommandMode);
  EXPECT_EQ(t.Of(t.Give(1, StartExternalSetpointGeneration{SetpointMode::kRelative})).error, ErrorId::kCommandMode);
  EXPECT_EQ(t.Of(t.Give(1, JoinFormation{Name::Of("m0")})).error, ErrorId::kCommandMode);
  EXPECT_EQ(t.Of(t.Give(0, LeaveFormation{})).error, ErrorId::kCommandMode);
  t.Give(0, MoveToPosition{.x = 800, .y = 200});
  const Ticket lift = t.Give(1, MoveZ{.position = 3});
  EXPECT_EQ(t.Become(lift), FeedbackState::kDone);
  EXPECT_EQ(t.outs[1].z, 3);
  EXPECT_GT(t.outs[1].velocity_x, 0);
  EXPECT_EQ(t.Of(t.Give(1, LeaveFormation{})).error, ErrorId::kObjectMoves);
  EXPECT_EQ(t.Of(t.Give(1, LeaveFormation{})).object, (ObjectInfo{ObjectKind::kMover, 1}));
}

// Which movers can be a planet of which star.
TEST(MoverFormation, RefusesWhatIsNoFormation) {
  Troop t(Plate());
  const auto refused = [&](std::uint32_t mover, const char* star, ErrorId error, std::uint32_t object) {
    const FeedbackEvent& answer = t.Of(t.Give(mover, JoinFormation{Name::Of(star)}));
    EXPECT_EQ(answer.state, FeedbackState::kError);
    EXPECT_EQ(answer.error, error);
    EXPECT_EQ(answer.object.number, object);
  };
  refused(1, "m0", ErrorId::kMoverDisabled, 0);
  t.Give(1, Enable{});
  t.Give(2, Enable{});
  t.Give(3, Enable{});
  t.Run(3);
  refused(1, "m0", ErrorId::kMoverDisabled, 1);
  refused(1, "m1", ErrorId::kFormationChain, 2);
  refused(1, "sun", ErrorId::kUnknownTarget, 0);
  t.Give(0, Enable{});
  t.Run(3);
  const Ticket move = t.Give(0, MoveToPosition{.x = 300, .y = 200});
  t.Step();
  refused(1, "m0", ErrorId::kObjectMoves, 1);
  t.Become(move);
  t.Give(1, MoveToPosition{.x = 600, .y = 200});
  t.Step();
  refused(1, "m0", ErrorId::kObjectMoves, 2);
  t.Run(2000);
  t.Give(1, JoinFormation{Name::Of("m0")});
  t.Step();
  refused(2, "m1", ErrorId::kFormationChain, 2);  // a planet as star
  refused(0, "m2", ErrorId::kFormationChain, 1);  // a star as planet
  t.Give(3, MoveC{.position = 90});
  t.Step();
  refused(3, "m0", ErrorId::kObjectMoves, 4);
  EXPECT_EQ(t.Of(t.Give(0, JoinTrack{.track = Name::Of("way")})).error, ErrorId::kFormationOnTrack);
}

// The body turns no further than all of its members may.
TEST(MoverFormation, KeepsTheWindowsOfAll) {
  std::vector<MoverParams> params = {Turning(0, 0), Turning(300, 0, 5), Turning(0, 300, 90)};
  params[1].c.lower = params[2].c.lower = -15;
  params[1].c.upper = params[2].c.upper = 15;
  Troop t(params);
  t.Form();
  EXPECT_EQ(t.Of(t.Give(0, MoveC{.position = 11})).error, ErrorId::kOutsideWindow);   // 5 + 11 > 15
  EXPECT_EQ(t.Of(t.Give(0, MoveC{.position = -16})).error, ErrorId::kOutsideWindow);  // 90 - 16 < 75
  EXPECT_EQ(t.Become(t.Give(0, MoveC{.position = 10})), FeedbackState::kDone);
  EXPECT_EQ(t.Become(t.Give(0, MoveToPosition{.x = 50, .y = 0, .c = -15, .use_orientation = true})),
            FeedbackState::kDone);
  EXPECT_NEAR(t.outs[1].c, -10, 1e-9);
  EXPECT_NEAR(t.outs[2].c, 75, 1e-9);
}

// A lost planet brings all to rest, as one body, and drops out there; the others stay.
TEST(MoverFormation, APlanetThatIsLostStopsAll) {
  const auto lose = [](const auto& how, ObjectState becomes, FeedbackState join) {
    std::vector<MoverParams> params = Plate();
    params[2].deviation = 2;
    Troop t(params);
    t.Form();
    const Ticket move = t.Give(0, MoveToPosition{.x = 1200, .y = 900, .c = 60, .use_orientation = true});
    const Ticket next = t.Give(0, MoveToPosition{.x = 0, .y = 0, .buffer_mode = Buffering::kBuffered});
    t.Run(200);
    how(t);
    t.Step();
    t.Step();
    EXPECT_EQ(t.Of(move).error, ErrorId::kPlanetLost);
    EXPECT_EQ(t.Of(next).state, FeedbackState::kAborted);
    EXPECT_EQ(t.Of(t.joins[1]).state, join);
    const auto apart = [&](std::size_t i) {
      return std::abs(PlaceOf(t.states[i].set_point) - PlaceOf(t.states[0].set_point));
    };
    int braking = 0;
    for (; !AtRest(t.states[0]) && braking < 2000; ++braking) {
      const FeedbackEvent refused = t.Of(t.Give(0, MoveToPosition{.x = 0, .y = 0}));
      EXPECT_EQ(refused.error, ErrorId::kPlanetLost);
      EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kMover, 3}));
      t.Step();
      EXPECT_NEAR(apart(2), std::hypot(300, 300), 1e-9);
      EXPECT_NEAR(apart(1), 300, 1e-9);
    }
    EXPECT_GT(braking, 20);
    t.Run(3);
    EXPECT_EQ(t.outs[2].state, becomes);
    EXPECT_EQ(t.outs[0].state, ObjectState::kEnabled);
    EXPECT_EQ(t.outs[1].formation, 1u);
    EXPECT_EQ(t.Become(t.Give(0, MoveToPosition{.x = 300, .y = 300})), FeedbackState::kDone);
    EXPECT_NEAR(apart(1), 300, 1e-9);
    return t.outs[2].formation;
  };
  using enum FeedbackState;
  EXPECT_EQ(lose([](Troop& t) { t.Break(2); }, ObjectState::kError, kError), 0u);
  EXPECT_EQ(lose([](Troop& t) { t.Give(2, Disable{}); }, ObjectState::kDisabled, kAborted), 0u);
  EXPECT_EQ(lose([](Troop& t) { t.inputs[2].actual.x += 3; }, ObjectState::kError, kError), 0u);
}

// A lost star brakes its planets with it, and they are free again at rest.
TEST(MoverFormation, AStarThatIsLostEndsIt) {
  const auto lose = [](const auto& how, ObjectState becomes) {
    Troop t(Plate());
    t.Form();
    t.Give(0, MoveToPosition{.x = 1200, .y = 900, .c = 60, .use_orientation = true});
    t.Run(200);
    how(t);
    for (int i = 0; i < 2000 && !AtRest(t.states[0]); ++i) {
      t.Step();
      if (AtRest(t.states[0])) break;
      EXPECT_EQ(t.outs[1].command_mode, CommandMode::kFormation);
      EXPECT_NEAR(std::abs(PlaceOf(t.states[2].set_point) - PlaceOf(t.states[0].set_point)), std::hypot(300, 300),
                  1e-9);
    }
    t.Run(3);
    EXPECT_EQ(t.outs[0].state, becomes);
    for (const Ticket join : t.joins) EXPECT_EQ(t.Of(join).error, ErrorId::kStarLost);
    for (std::uint32_t i = 1; i < 4; ++i) {
      EXPECT_EQ(t.outs[i].state, ObjectState::kEnabled);
      EXPECT_EQ(t.outs[i].command_mode, CommandMode::kFreeMovement);
      EXPECT_EQ(t.outs[i].formation, 0u);
    }
    EXPECT_EQ(t.outs[0].formation, 0u);
    // Away from the others, which are at rest where they were.
    const Complex away = 2.0 * PlaceOf(t.states[1].set_point) - PlaceOf(t.states[0].set_point);
    EXPECT_EQ(t.Become(t.Give(1, MoveToPosition{.x = away.real(), .y = away.imag()})), FeedbackState::kDone);
  };
  lose([](Troop& t) { t.Break(0); }, ObjectState::kError);
  lose([](Troop& t) { t.Give(0, Disable{}); }, ObjectState::kDisabled);
}

TEST(MoverFormation, AHaltStopsAll) {
  for (const std::uint32_t who : {0u, 2u}) {
    Troop t(Plate());
    t.Form();
    const Ticket move = t.Give(0, MoveToPosition{.x = 1200, .y = 900, .c = 60, .use_orientation = true});
    t.Run(200);
    const Ticket halt = t.Give(who, Halt{});
    EXPECT_EQ(t.Become(halt), FeedbackState::kDone);
    for (const State& s : t.states) EXPECT_TRUE(AtRest(s));
    EXPECT_LT(t.outs[0].x, 1000);
    EXPECT_EQ(t.Of(move).state, who == 0 ? FeedbackState::kAborted : FeedbackState::kError);
    for (const Ticket join : t.joins) EXPECT_EQ(t.Of(join).state, FeedbackState::kActive);
    EXPECT_EQ(t.Become(t.Give(0, MoveToPosition{.x = 0, .y = 0})), FeedbackState::kDone);
    EXPECT_NEAR(std::abs(PlaceOf(t.states[2].set_point) - PlaceOf(t.states[0].set_point)), std::hypot(300, 300), 1e-9);
  }
}

// External set points move the planets, too; each of them is checked against the limits of all members.
TEST(MoverFormation, FollowsSetPointsFromOutside) {
  const auto run = [](double turns_per_s) {
    Troop t(Plate());
    t.Form();
    const Ticket begun = t.Give(0, StartExternalSetpointGeneration{SetpointMode::kAbsolute});
    const double pi = std::numbers::pi, w = 360 * turns_per_s;  // [deg/s] peak of an oscillation
    for (int i = 1; i < 1000 && !IsFinal(t.Of(begun).state); ++i) {
      const double at = 0.001 * i;
      t.Give(0, SetExternalSetpoint{.x = 200 + 50 * (1 - std::cos(2 * pi * at)),
                                    .y = 200,
                                    .c = w / (2 * pi) * (1 - std::cos(2 * pi * at)),
                                    .velocity_x = 100 * pi * std::sin(2 * pi * at),
                                    .velocity_c = w * std::sin(2 * pi * at),
                                    .acceleration_x = 200 * pi * pi * std::cos(2 * pi * at),
                                    .acceleration_c = 2 * pi * w * std::cos(2 * pi * at)});
      t.Step();
    }
    const Complex r = PlaceOf(t.states[2].set_point) - PlaceOf(t.states[0].set_point);
    EXPECT_NEAR(std::abs(r), std::hypot(300, 300), 1e-9);
    EXPECT_NEAR(std::arg(r), pi / 4 + t.outs[0].c * kDegree, 1e-9);
    return t.Of(begun);
  };
  EXPECT_EQ(run(0.3).state, FeedbackState::kActive);
  // 424 mm away, at 0.8 turns a second: 2133 mm/s are more than the 2000 that a planet can do.
  EXPECT_EQ(run(0.8).error, ErrorId::kWildSetPoint);
}

// Random external set points that stop or fail in any cycle: no member exceeds its speed or acceleration.
TEST(MoverFormation, PropertyStopsFromSetPointsFromOutside) {
  const int seeds = Trials(60, 50);
  int faults = 0;
  double nearest = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(static_cast<unsigned>(seed));
    Troop t({Turning(0, 0), Turning(300, 0), Turning(200, -400)});
    t.Form();
    t.Give(0, StartExternalSetpointGeneration{SetpointMode::kAbsolute});
    const double way = Uniform(random, 2, 12), turn = Uniform(random, 2, 12);  // [rad/s]
    const double far = Uniform(random, 20, 1500) / way, round = Uniform(random, 5, 200) / turn;
    const int ends = Whole(random, 100, 1500);
    // An oscillation that grows from rest.
    const auto swing = [](double size, double w, double at) {
      const double rest = std::exp(-at), c = 1 - std::cos(w * at), s = w * std::sin(w * at);
      return KinematicState{size * (1 - rest) * c, size * (rest * c + (1 - rest) * s),
                            size * (-rest * c + 2 * rest * s + (1 - rest) * w * w * std::cos(w * at))};
    };
    bool failed = false;
    for (int i = 1; i < ends + 400; ++i) {
      const KinematicState x = swing(far, way, 0.001 * i), c = swing(round, turn, 0.001 * i);
      if (i < ends && !failed) {
        t.Give(0, SetExternalSetpoint{.x = x.position,
                                      .c = c.position,
                                      .velocity_x = x.velocity,
                                      .velocity_c = c.velocity,
                                      .acceleration_x = x.acceleration,
                                      .acceleration_c = c.acceleration});
      } else if (i == ends && !failed) {
        t.Give(0, Whole(random, 0, 1) == 0 ? Command(Halt{}) : Command(Disable{}));
      }
      t.Step();
      failed = failed || t.outs[0].error != ErrorId::kNone;
      for (const State& s : t.states) {
        const double v = std::abs(VelocityOf(s.set_point)), a = std::abs(AccelerationOf(s.set_point));
        ASSERT_LE(v, 2000 * (1 + 1e-6)) << i;
        ASSERT_LE(a, 10000 * (1 + 1e-6)) << i;
        nearest = std::max({nearest, v / 2000, a / 10000});
      }
    }
    faults += failed ? 1 : 0;
  }
  EXPECT_GT(faults, seeds / 10);
  EXPECT_LT(faults, seeds / 2);
  EXPECT_GT(nearest, 0.8);
}

// Random formations, moves, turns, halts, faults and disables: every member keeps its limits in every cycle, the body
// keeps its shape, and each planet keeps its pose relative to its star.
TEST(MoverFormation, PropertyKeepsLimitsAndShape) {
  const int seeds = Trials(40, 50);
  int moved_and_turned = 0, dropped = 0;
  double nearest = 0, nearest_of_both = 0;  // to a limit
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(static_cast<unsigned>(seed));
    std::vector<MoverParams> params;
    const int members = Whole(random, 2, 8);
    const bool alike = Whole(random, 0, 1) == 0;
    for (int i = 0; i < members; ++i) {
      const bool narrow = Whole(random, 0, 5) == 0;
      MoverParams p =
          Turning(Uniform(random, -700, 700), Uniform(random, -700, 700),
                  narrow ? 90 * Whole(random, -2, 2) + Uniform(random, -10, 10) : Uniform(random, -300, 300));
      if (narrow) p.c.lower = -15, p.c.upper = 15;
      const auto any = [&](double low, double high) {
        return std::exp(Uniform(random, std::log(low), std::log(high)));
      };
      p.xy.maximum = {any(50, 5000), any(500, 5e4), {}, any(1e4, 5e6)};
      if (Whole(random, 0, 1) == 0) p.xy.maximum.deceleration = any(500, 5e4);
      p.c.maximum = {any(30, 3000), any(300, 5e4), {}, any(4000, 1e6)};
      if (alike && i > 0) p.xy = params[0].xy, p.c.maximum = params[0].c.maximum;
      params.push_back(p);
    }
    Troop t(params, Whole(random, 0, 1) == 0 ? 0.001 : 0.00025);
    t.Form();
    const double period = t.cycle.period_s;
    std::vector<State> before = t.states;
    int left = 0;
    for (int cycle = 0; cycle < 4000; ++cycle) {
      if (left-- == 0) {
        left = Whole(random, 1, 400);
        const auto any = static_cast<std::uint32_t>(Whole(random, 0, members - 1));
        const auto some = [&](double low, double high) {
          return Whole(random, 0, 2) == 0 ? std::optional(std::exp(Uniform(random, std::log(low), std::log(high))))
                                          : std::nullopt;
        };
        const bool buffered = Whole(random, 0, 3) == 0;
        const double turned = t.states[0].set_point[kC].position + Uniform(random, -90, 90);
        switch (Whole(random, 0, 12)) {
          case 0:
            t.Give(any, Halt{.deceleration = some(1000, 20000)});
            break;
          case 1:
            if (Whole(random, 0, 2) == 0) t.Give(any, Disable{});
            break;
          case 2:
            if (Whole(random, 0, 2) == 0) t.Break(any);
            break;
          case 3:
          case 4:
            t.Give(0, MoveC{.position = turned, .velocity = some(1, 500), .acceleration = some(10, 5000)});
            break;
          default:
            t.Give(0, MoveToPosition{.x = Uniform(random, -900, 900),
                                     .y = Uniform(random, -900, 900),
                                     .c = turned,
                                     .use_orientation = Whole(random, 0, 1) == 0,
                                     .velocity = some(50, 3000),
                                     .acceleration = some(500, 20000),
                                     .jerk = some(1e4, 5e5),
                                     .buffer_mode = buffered ? Buffering::kBuffered : Buffering::kAborting,
                                     .blending = buffered ? Uniform(random, 0, 100) : 0});
        }
      }
      if (cycle % 1000 == 999) {  // movers that have dropped out join again
        for (std::uint32_t i = 0; i < t.params.size(); ++i) {
          if (t.states[i].state == ObjectState::kError) t.Give(i, Reset{});
          if (t.states[i].state == ObjectState::kDisabled) t.Give(i, Enable{});
        }
      }
      if (cycle % 1000 == 5 && cycle > 1000) {
        for (std::uint32_t i = 1; i < t.params.size(); ++i) {
          if (!IsPlanet(t.states[i])) t.Give(i, JoinFormation{Name::Of("m0")});
        }
        before = t.states;
      }
      t.Step();
      const SetPoint& star = t.states[0].set_point;
      const Complex turn = std::polar(1.0, star[kC].position * kDegree);
      const double w = star[kC].velocity * kDegree, u = star[kC].acceleration * kDegree;
      moved_and_turned += std::abs(VelocityOf(star)) > 10 && std::abs(w) > 0.1 ? 1 : 0;
      for (std::size_t i = 0; i < t.states.size(); ++i) {
        SCOPED_TRACE(i);
        const MoverParams& p = t.params[i];
        const SetPoint& now = t.states[i].set_point;
        const SetPoint& then = before[i].set_point;
        const double slack = 1 + 1e-6;
        const trajectory::Limits l = p.xy.maximum.limits(), lc = p.c.maximum.limits();
        const double v = std::abs(VelocityOf(now)), a = std::abs(AccelerationOf(now));
        const double j = std::abs(AccelerationOf(now) - AccelerationOf(then)) / period;
        ASSERT_LE(v, l.velocity * slack) << cycle;
        ASSERT_LE(a, std::max(l.acceleration, l.deceleration) * slack) << cycle;
        ASSERT_LE(j, l.jerk * slack + 1e-3) << cycle;
        double& near = VelocityOf(star) != Complex() && w != 0 ? nearest_of_both : nearest;
        if (i > 0 && t.outs[i].formation != 0) {
          near = std::max({near, v / l.velocity, a / std::max(l.acceleration, l.deceleration), j / l.jerk});
        }
        ASSERT_LE(std::abs(now[kC].velocity), lc.velocity * slack) << cycle;
        ASSERT_LE(std::abs(now[kC].acceleration), lc.acceleration * slack) << cycle;
        ASSERT_LE(std::abs(now[kC].acceleration - then[kC].acceleration), lc.jerk * period * slack + 1e-6) << cycle;
        ASSERT_TRUE(t.outs[i].formation == 0 || InOneWindow(p.c, now[kC].position, now[kC].position)) << cycle;
        // Velocities are the derivatives of positions.
        const Complex way = PlaceOf(now) - PlaceOf(then) - 0.5 * period * (VelocityOf(now) + VelocityOf(then));
        ASSERT_LE(std::abs(way), l.jerk * period * period * period + 1e-9 + period * period * j * period) << cycle;
        const FormationState& f = t.states[i].formation;
        if (f.star == kNoStar) {
          if (i > 0 && before[i].formation.star != kNoStar) {
            ++dropped;
            ASSERT_TRUE(AtRest(t.states[i]));
          }
          continue;
        }
        const Complex r = Complex(f.x, f.y) * turn;
        ASSERT_LE(std::abs(PlaceOf(now) - PlaceOf(star) - r), 1e-9) << cycle;
        ASSERT_LE(std::abs(VelocityOf(now) - VelocityOf(star) - Complex(0, w) * r), 1e-6) << cycle;
        ASSERT_LE(std::abs(AccelerationOf(now) - AccelerationOf(star) - Complex(-w * w, u) * r), 1e-5) << cycle;
        ASSERT_NEAR(now[kC].position - star[kC].position, f.c, 1e-9);
        for (std::size_t k = 0; k < i; ++k) {
          if (!IsPlanet(t.states[k]) || !IsPlanet(before[k]) || !IsPlanet(before[i])) continue;
          const auto apart = [](const State& one, const State& other) {
            return std::abs(PlaceOf(one.set_point) - PlaceOf(other.set_point));
          };
          ASSERT_NEAR(apart(t.states[i], t.states[k]), apart(before[i], before[k]), 1e-9) << cycle;
        }
      }
      before = t.states;
    }
    EXPECT_EQ(t.allocated, 0);
  }
  RecordProperty("nearest", std::to_string(nearest));
  RecordProperty("nearest_of_both", std::to_string(nearest_of_both));
  if (kSanitized) return;  // too few trials for rare events
  EXPECT_GT(moved_and_turned, 100 * seeds);
  EXPECT_GT(dropped, seeds / 4);
  EXPECT_GT(nearest, 0.99);
  EXPECT_GT(nearest_of_both, 0.95);
}

}  // namespace
}  // namespace takt::mover
