// PL-12, PL-13, PL-24: movers on tracks, with commands and external set points.
#include <functional>
#include <memory>

#include "rig.h"
#include "takt/mover/gear.h"
#include "takt/mover/run.h"
#include "takt/planar/builder.h"

namespace takt::mover {
namespace {

using planar::ObjectState;

constexpr double kPeriod = 0.001;  // [s]

planar::Layout Straight(const planar::Place& from, const planar::Place& to) {
  planar::Layout layout;
  layout.elements.push_back({.shape = planar::ElementShape::kLine, .start = from, .end = to});
  return layout;
}

// Movers on tracks of this test. Tracks whose ends and starts coincide are linked.
class TrackRig {
 public:
  TrackRig(std::size_t movers, const std::vector<planar::Layout>& layouts)
      : streets(movers, Named(layouts.size())), params(movers), grounds(movers, layouts.size(), 0, {}) {
    now.resize(layouts.size());
    for (std::uint32_t i = 0; i < layouts.size(); ++i) {
      ways.push_back(std::make_unique<planar::Track>());
      EXPECT_EQ(planar::MakeTrack(layouts[i], *ways[i]).problem, planar::Problem::kNone);
      now[i].way = ways[i].get();
      now[i].length = ways[i]->length;
      now[i].enabled = true;
      now[i].start_node = 2 * i;
      now[i].end_node = 2 * i + 1;
      now[i].reach = std::hypot(155, 155);
      now[i].width = now[i].height = 155;
    }
    for (std::uint32_t i = 0; i < layouts.size(); ++i) {
      for (std::uint32_t k = 0; k < layouts.size(); ++k) {
        const planar::Place end = planar::At(*ways[i], ways[i]->length).place, start = planar::At(*ways[k], 0).place;
        if (planar::SamePoint(end, start)) now[k].start_node = now[i].end_node;
      }
    }
  }
  static std::vector<std::string> Named(std::size_t count) {
    std::vector<std::string> names(count);
    for (std::size_t i = 0; i < count; ++i) names[i] = "t" + std::to_string(i);
    return names;
  }

  // The movers rest there, enabled.
  void Start(const std::vector<planar::Place>& places) {
    for (std::size_t i = 0; i < params.size(); ++i) {
      params[i].initial = {.x = places[i].x, .y = places[i].y};
      states.push_back(MakeState(params[i]));
      states[i].state = ObjectState::kEnabled;
    }
    out.resize(states.size());
    Step();
  }
  Context context(std::size_t i) {
    return {params[i], cycle, planner, feedback, streets, grounds, static_cast<std::uint32_t>(i)};
  }
  Ticket Give(std::size_t mover, const Command& command) {
    Apply(context(mover), ++ticket, command, states[mover]);
    Hear();
    return ticket;
  }
  void Step() {
    Refresh(now, streets);
    for (std::size_t i = 0; i < states.size(); ++i) Lead(context(i), states[i]);
    streets.traffic.Step(cycle, planner, streets.network, streets.riders);
    std::ranges::fill(streets.uses, TrackUse{});
    for (std::size_t i = 0; i < states.size(); ++i) {
      const SetPoint before = states[i].set_point;
      mover::Step(context(i), Simulate(states[i]), states[i]);
      Publish(context(i), Simulate(states[i]), states[i], out[i]);
      Look(params[i], before, states[i].set_point);
      const planar::Rider& rider = streets.riders[i];
      if (!rider.on) continue;
      const bool on_track = states[i].mode == CommandMode::kOnTrack;
      if (!on_track) ++streets.uses[states[i].track].configuring;
      const bool goes = on_track && IsMovingAlongTrack(context(i), states[i]);
      for (const std::uint32_t track : rider.route.all()) streets.uses[track].moving += goes ? 1 : 0;
    }
    Hear();
    ++cycle.count;
    if (each_cycle) each_cycle();
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  const FeedbackEvent& End(Ticket of) {
    for (int i = 0; i < 20000 && !IsFinal(answers[of].state); ++i) Step();
    EXPECT_TRUE(IsFinal(answers[of].state));
    return answers[of];
  }
  ErrorId Do(std::size_t mover, const Command& command) { return End(Give(mover, command)).error; }
  ErrorId Join(std::size_t mover, const std::string& track) { return Do(mover, JoinTrack{.track = Name::Of(track)}); }

  TrackNetworkState streets;
  std::vector<MoverParams> params;
  planar::GroupRegistry grounds;
  std::vector<std::unique_ptr<planar::Track>> ways;
  std::vector<TrackView> now;
  std::vector<State> states;
  std::vector<Outputs> out;
  Cycle cycle{0, kPeriod};
  trajectory::Planner planner;
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(256);
  FeedbackSink feedback{storage};
  Ticket ticket = 0;
  std::map<Ticket, FeedbackEvent> answers;  // the last one of each
  std::function<void()> each_cycle;
  double fastest = 0, hardest = 0;  // share of the limits that X and Y used

 private:
  void Hear() {
    for (const FeedbackEvent& event : feedback.events()) answers[event.ticket] = event;
    feedback.Clear();
  }
  // Nothing jumps: velocities and positions belong to one motion.
  void Look(const MoverParams& p, const SetPoint& was, const SetPoint& is) {
    const trajectory::Limits l = p.xy.maximum.limits();
    for (const Coordinate i : {kX, kY}) {
      EXPECT_NEAR(is[i].position - was[i].position, 0.5 * kPeriod * (was[i].velocity + is[i].velocity), 0.002);
      EXPECT_NEAR(is[i].velocity - was[i].velocity, 0.5 * kPeriod * (was[i].acceleration + is[i].acceleration), 0.3);
    }
    fastest = std::max(fastest, std::hypot(is[kX].velocity, is[kY].velocity) / l.velocity);
    hardest = std::max(hardest, std::hypot(is[kX].acceleration, is[kY].acceleration) / l.acceleration);
  }
};

// From 0 to `to` in 0.5 s.
KinematicState Ramp(double to, double t) {
  const double u = std::min(1.0, t / 0.5);
  return {to * u * u * u * (10 - u * (15 - 6 * u)), to / 0.5 * 30 * u * u * (1 - u) * (1 - u),
          to / 0.25 * 60 * u * (1 - u) * (1 - 2 * u)};
}
SetExternalSetpoint Offset(const KinematicState& x, const KinematicState& y) {
  return {.x = x.position,
          .y = y.position,
          .velocity_x = x.velocity,
          .velocity_y = y.velocity,
          .acceleration_x = x.acceleration,
          .acceleration_y = y.acceleration};
}

// However relative set points end, the mover comes to rest on its track, and without a jump.
TEST(MoverOnTracks, RelativeSetPointsEndInOrder) {  // PL-13
  enum How { kStopped, kHalted, kDisabled, kMissing, kWild, kHows };
  for (int how = 0; how < kHows; ++how) {
    for (const bool moving : {false, true}) {
      for (const int cycles : {250, 600}) {  // while it moves out, and at rest there
        TrackRig rig(1, {Straight({0, 0}, {1500, 0})});
        rig.Start({{100, 0}});
        ASSERT_EQ(rig.Join(0, "t0"), ErrorId::kNone);
        const Ticket start = rig.Give(0, StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
        if (moving) rig.Give(0, MoveOnTrack{.position = 1400, .velocity = 300, .acceleration = 2000.0});
        for (int i = 1; i <= cycles; ++i) {
          rig.Give(0, Offset({}, Ramp(50, i * kPeriod)));
          rig.Step();
          ASSERT_EQ(rig.out[0].y, Ramp(50, i * kPeriod).position);
        }
        const double x = rig.out[0].x;
        Ticket end = 0;
        if (how == kStopped) end = rig.Give(0, StopExternalSetpointGeneration{});
        if (how == kHalted) end = rig.Give(0, Halt{});
        if (how == kDisabled) end = rig.Give(0, Disable{});
        if (how == kWild) rig.Give(0, SetExternalSetpoint{.y = 1000});
        rig.Run(1500);
        if (end != 0) {
          EXPECT_EQ(rig.answers[end].state, FeedbackState::kDone) << how;
        }
        const ErrorId error = how == kMissing ? ErrorId::kNoSetPoint
                              : how == kWild  ? ErrorId::kWildSetPoint
                                              : ErrorId::kNone;
        EXPECT_EQ(rig.out[0].error, error);
        EXPECT_EQ(rig.answers[start].error, error);
        EXPECT_EQ(rig.out[0].y, 0) << how;
        EXPECT_EQ(rig.out[0].x, rig.out[0].track_position);
        EXPECT_LT(rig.out[0].x, x + 20);
        EXPECT_TRUE(AtRest(rig.states[0]));
        EXPECT_EQ(rig.out[0].command_mode, CommandMode::kOnTrack);
        EXPECT_LE(rig.fastest, 1 + 1e-6);
        if (cycles == 600) {
          EXPECT_LE(rig.hardest, 1 + 1e-6) << how << moving;
        }
        if (testing::Test::HasFailure()) return;
        if (error != ErrorId::kNone) rig.Do(0, Reset{});
        if (how == kDisabled) rig.Do(0, Enable{});
        ASSERT_EQ(rig.out[0].state, ObjectState::kEnabled);
        EXPECT_EQ(rig.Do(0, MoveOnTrack{.position = 700}), ErrorId::kNone);
        EXPECT_EQ(rig.out[0].x, 700);
        EXPECT_EQ(rig.Do(0, LeaveTrack{.x = 700, .y = 300}), ErrorId::kNone);
        EXPECT_EQ(rig.out[0].y, 300);
      }
    }
  }
}

// Relative set points continue over the moves from a track, and onto one.
TEST(MoverOnTracks, RelativeSetPointsStayOverLeavingAndJoining) {  // PL-13
  TrackRig rig(1, {Straight({0, 0}, {1500, 0})});
  rig.Start({{100, 0}});
  ASSERT_EQ(rig.Join(0, "t0"), ErrorId::kNone);
  rig.Give(0, StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
  int i = 0;
  const auto until = [&](const std::function<bool()>& over) {
    do {
      rig.Give(0, Offset({}, Ramp(50, ++i * kPeriod)));
      rig.Step();
      ASSERT_EQ(rig.out[0].error, ErrorId::kNone);
    } while (!over());
  };
  until([&] { return i == 600; });
  const Ticket leave = rig.Give(0, LeaveTrack{.x = 400, .y = 300});
  until([&] { return IsFinal(rig.answers[leave].state); });
  EXPECT_EQ(rig.answers[leave].state, FeedbackState::kDone);
  EXPECT_NEAR(rig.out[0].x, 400, 1e-9);
  EXPECT_NEAR(rig.out[0].y, 350, 1e-9);
  const Ticket join = rig.Give(0, JoinTrack{.track = Name::Of("t0")});
  until([&] { return IsFinal(rig.answers[join].state); });
  EXPECT_EQ(rig.answers[join].state, FeedbackState::kDone);
  EXPECT_NEAR(rig.out[0].x, 400, 1e-9);
  EXPECT_NEAR(rig.out[0].y, 50, 1e-9);
  EXPECT_EQ(rig.Do(0, StopExternalSetpointGeneration{}), ErrorId::kNone);
  EXPECT_EQ(rig.out[0].y, 0);
}

// Other movers keep their gap plus the displacement of a mover; there must be room for that first.
TEST(MoverOnTracks, RelativeSetPointsAreKeptAwayFrom) {  // PL-13, PL-24
  const auto apart = [](const TrackRig& rig) {
    return std::hypot(rig.out[1].x - rig.out[0].x, rig.out[1].y - rig.out[0].y);
  };
  for (const double to : {-60.0, 60.0}) {  // towards the other mover, and away from it
    TrackRig rig(2, {Straight({0, 0}, {1500, 0})});
    rig.Start({{100, 0}, {1000, 0}});
    for (const std::size_t i : {0u, 1u}) ASSERT_EQ(rig.Join(i, "t0"), ErrorId::kNone);
    rig.Give(1, StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
    rig.Give(0, MoveOnTrack{.position = 1400});
    for (int i = 1; i <= 3000; ++i) {
      rig.Give(1, Offset(Ramp(to, i * kPeriod), {}));
      rig.Step();
      ASSERT_GT(apart(rig), 200 - 0.1);
    }
    EXPECT_NEAR(rig.out[0].x, 1000 - 200 - 60, 0.1);
    EXPECT_EQ(rig.out[0].waits_for, 2u);
    // Once it is back at its position they need no more than the gap.
    rig.Give(1, StopExternalSetpointGeneration{});
    rig.Run(2000);
    EXPECT_NEAR(rig.out[0].x, 1000 - 200, 0.1);

    const Ticket start = rig.Give(1, StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
    for (int i = 1; i <= 700 && !IsFinal(rig.answers[start].state); ++i) {
      rig.Give(1, Offset(Ramp(to, i * kPeriod), {}));
      rig.Step();
    }
    EXPECT_EQ(rig.answers[start].error, ErrorId::kCollision);
    rig.Run(1000);
    EXPECT_NEAR(apart(rig), 200, 0.1);
  }
}

// Random moves, halts and faults on a loop, with relative set points in between: nothing jumps, no mover comes too near
// to another, and in the end all are on the track again.
TEST(MoverOnTracks, PropertyWithRelativeSetPoints) {  // PL-13, PL-24
  int started = 0, collisions = 0;
  double least = 1e9, furthest = 0;
  for (unsigned seed = 0; seed < 12 && !HasFailure(); ++seed) {
    std::mt19937 random(seed);
    planar::Layout circle;
    circle.elements.push_back(
        {.shape = planar::ElementShape::kArc, .start = {500, 0}, .end = {500, 0}, .center = {0, 0}});
    circle.closed = true;
    TrackRig rig(3, {circle});
    rig.Start({{500, 0}, {-500, 0}, {0, 500}});
    for (const std::size_t i : {0u, 1u, 2u}) ASSERT_EQ(rig.Join(i, "t0"), ErrorId::kNone);
    struct Source {
      trajectory::Profile x, y;
      double t = 0;
    };
    std::vector<Source> sources(3);
    const trajectory::Limits limits{400, 3000, 3000, 100000};
    rig.each_cycle = [&] {
      for (std::size_t i = 0; i < 3; ++i) {
        furthest = std::max(furthest, std::hypot(rig.out[i].x, rig.out[i].y));
        for (std::size_t k = 0; k < i; ++k) {
          least = std::min(least, std::hypot(rig.out[i].x - rig.out[k].x, rig.out[i].y - rig.out[k].y));
        }
      }
    };
    for (int cycle = 0; cycle < 6000; ++cycle) {
      for (std::size_t i = 0; i < 3; ++i) {
        Source& own = sources[i];
        const bool external = rig.out[i].external == SetpointMode::kRelative;
        const int what = Whole(random, 0, 3000);
        if (what < 6) {
          rig.Give(i, MoveOnTrack{.position = Uniform(random, 0, 3141),
                                  .direction = what < 3 ? TurnDirection::kPositive : TurnDirection::kShortestWay});
        }
        if (what == 6) rig.Give(i, Halt{});
        if (what < 12 && !external && rig.out[i].state == ObjectState::kEnabled) {
          rig.Give(i, StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
          own = {};
          ++started;
        } else if (what == 12 && external) {
          rig.Give(i, StopExternalSetpointGeneration{});
        }
        if (rig.out[i].state == ObjectState::kError) {
          collisions += rig.out[i].error == ErrorId::kCollision ? 1 : 0;
          rig.Give(i, Reset{});
        }
        if (rig.states[i].external.mode != SetpointMode::kRelative || what == 13) continue;
        if (what > 2950) {
          const KinematicState x = own.x.At(own.t), y = own.y.At(own.t);
          ASSERT_TRUE(rig.planner.ToPosition(x, Uniform(random, -40, 40), 0, limits, own.x).ok());
          ASSERT_TRUE(rig.planner.ToPosition(y, Uniform(random, -40, 40), 0, limits, own.y).ok());
          own.t = 0;
        }
        own.t += kPeriod;
        rig.Give(i, Offset(own.x.At(own.t), own.y.At(own.t)));
      }
      rig.Step();
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (rig.out[i].state == ObjectState::kEnabled) rig.Give(i, Halt{});
    }
    rig.Run(2000);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(std::hypot(rig.out[i].x, rig.out[i].y), 500, 1e-6);
      EXPECT_TRUE(AtRest(rig.states[i]));
    }
  }
  EXPECT_GT(least, 195);  // the chord of a gap, between positions off the circle
  EXPECT_GT(furthest, 520);
  EXPECT_GT(started, 100);
  EXPECT_GT(collisions, 0);
}

// A mover joins only where both could still brake, whatever the target of the other one is.
TEST(MoverOnTracks, JoinsWhereNobodyComesTooNear) {  // PL-24
  int refused = 0, joined = 0;
  for (const double at : {0.0, 700.0, 1000.0, 1200.0, 1250.0, 1280.0, 1300.0, 1400.0, 1499.0}) {
    for (const double gap : {200.0, 400.0}) {
      planar::Layout up = Straight({2000, 300}, {2500, 500}), down = Straight({2000, -300}, {2500, -500});
      up.from = down.from = planar::TrackPoint{.place = {1500, 0}};
      TrackRig rig(2, {Straight({0, 0}, {1500, 0}), up, down});
      for (MoverParams& p : rig.params) p.gap = gap;
      rig.Start({{0, 0}, {1530, -150}});
      ASSERT_EQ(rig.Join(0, "t0"), ErrorId::kNone);
      const Ticket going = rig.Give(0, MoveOnTrack{.position = 800, .track = Name::Of("t1")});
      while (rig.out[0].track_position < at) rig.Step();
      double least = 1e9;
      rig.each_cycle = [&] {
        const double s = rig.streets.riders[1].at.position;
        if (rig.out[1].track == 3 && rig.out[0].track == 1)
          least = std::min(least, s + 1500 - rig.out[0].track_position);
      };
      const Ticket join = rig.Give(1, JoinTrack{.track = Name::Of("t2")});
      rig.Run(4000);
      if (rig.answers[join].error == ErrorId::kCollision) {
        ++refused;
        EXPECT_EQ(rig.answers[join].object.kind, ObjectKind::kMover);
        EXPECT_EQ(rig.answers[join].object.number, 1u);
        EXPECT_EQ(rig.answers[going].state, FeedbackState::kDone);
        continue;
      }
      ++joined;
      EXPECT_EQ(rig.answers[join].state, FeedbackState::kDone);
      EXPECT_GE(least, gap - 1e-5) << at;
    }
  }
  EXPECT_GT(refused, 4);
  EXPECT_GT(joined, 4);
}

// The gap counts across a border between tracks; tracks that are not linked are not checked.
TEST(MoverOnTracks, JoinsAtTheGapOverABorder) {  // PL-24
  for (const double place : {1699.9, 1700.0}) {
    TrackRig rig(3, {Straight({0, 0}, {1500, 0}), Straight({1500, 0}, {3000, 0}), Straight({0, 120}, {3000, 120})});
    rig.Start({{1500 - 200, 0}, {place + 0, 0}, {1500, 300}});
    for (MoverParams& p : rig.params) p.gap = 400;
    ASSERT_EQ(rig.Join(0, "t0"), ErrorId::kNone);
    EXPECT_EQ(rig.Join(1, "t1"), place < 1700 ? ErrorId::kCollision : ErrorId::kNone);
    EXPECT_EQ(rig.Join(2, "t2"), ErrorId::kNone);
  }
}

// A mover that may not leave its track stays where it is.
TEST(MoverOnTracks, StaysWhereItMayNotLeave) {
  TrackRig rig(1, {Straight({0, 0}, {1500, 0})});
  rig.Start({{100, 0}});
  ASSERT_EQ(rig.Join(0, "t0"), ErrorId::kNone);
  EXPECT_EQ(rig.Do(0, LeaveTrack{.x = 100, .y = 300, .c = 40, .use_orientation = true}), ErrorId::kOutsideWindow);
  rig.Run(10);
  EXPECT_EQ(rig.out[0].x, 100);
  EXPECT_EQ(rig.Do(0, MoveOnTrack{.position = 300}), ErrorId::kNone);
  EXPECT_EQ(rig.out[0].x, 300);
}

TEST(MoverOnTracks, RefusesWhatTheTrackIsNotFor) {
  TrackRig rig(2, {Straight({0, 0}, {1500, 0}), Straight({0, 900}, {1500, 900})});
  rig.params[0].width = 156;
  rig.now[1].spot.system = 1;
  rig.Start({{100, 0}, {500, 0}});
  EXPECT_EQ(rig.Join(0, "t0"), ErrorId::kMoverTooLarge);
  EXPECT_FALSE(rig.streets.riders[0].on);
  // In another coordinate system, enabled or not.
  EXPECT_EQ(rig.Join(1, "t1"), ErrorId::kReference);
  rig.now[1].enabled = false;
  rig.Step();
  EXPECT_EQ(rig.Join(1, "t1"), ErrorId::kReference);
  // Arguments of closed loops only.
  ASSERT_EQ(rig.Join(1, "t0"), ErrorId::kNone);
  EXPECT_EQ(rig.Do(1, MoveOnTrack{.position = 700, .additional_turns = 1}), ErrorId::kParameter);
  EXPECT_EQ(rig.Do(1, MoveOnTrack{.position = 700, .modulo_tolerance = 1}), ErrorId::kParameter);
  EXPECT_EQ(rig.Do(1, MoveOnTrack{.position = 700}), ErrorId::kNone);
}

}  // namespace
}  // namespace takt::mover
