// CV-03, CV-20 to CV-23: moves in product coordinate systems that go along with belts and tables.
#include <random>

#include "belts.h"
#include "takt/group/clutch.h"

namespace takt::group {
namespace {

// How far the tool is from a place on an object in the cycle recorded last.
double OffPlace(const Rig& rig, const Belts& belts, std::size_t belt, double from, const Pose& on, const Pose& place) {
  const Frame object = ObjectOn(belts, belt, from, on, rig.cycle.count - 1);
  return (ToolOf(rig).p - object * kinematics::ToFrame(place).p).Norm();
}

// CV-20, CV-21: from standstill onto a belt, and along with it.
TEST(Riding, OntoABeltAndAlongWithIt) {
  for (const double speed : {0.0, 100.0, 400.0, -250.0}) {
    SCOPED_TRACE(speed);
    Rig rig = Gantry();
    rig.StartAt({0, 0, 0});
    const auto belts = Put(rig, {BeltAt("belt", {50, 200, -100}, [=](double t) { return Steady(t, speed); })});
    const Pose on = {20, 10, 5};
    rig.RunToEnd(rig.Give(SetDynCoordTransform{
        .pcs = 3, .carrier = Name::Of("belt"), .x = 20, .y = 10, .z = 5, .recorded_position = 30.0}));
    rig.trace.clear();
    const Ticket move = rig.Give(Line(0, 0, 40, 3));
    ASSERT_TRUE(rig.RunToEnd(move, 5));
    ASSERT_TRUE(rig.lives[move].done) << static_cast<int>(rig.lives[move].error_id);
    for (int i = 0; i < 300; ++i) {
      rig.Step();
      ASSERT_LE(OffPlace(rig, *belts, 0, 30, on, {0, 0, 40}), kOnObject);
    }
    EXPECT_EQ(rig.out().state, speed == 0 ? rig.out().state : GroupState::kMoving);
    ExpectSmooth(rig);
  }
}

// From one belt to another, 25 mm up, across, 25 mm down, with corners rounded so much.
struct Pick {
  double time = 0;        // s
  double slowest = 1e99;  // mm/s, further than 5 mm from both ends
};
using Travel = std::function<KinematicState(double t)>;
Pick Across(Rig rig, double z, const Travel& first, const Travel& second, double radius) {
  rig.StartAt({0, -152.5, z + 20});
  const auto belts = Put(rig, {BeltAt("first", {0, -152.5, z}, first), BeltAt("second", {0, 152.5, z}, second)});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("first"), .recorded_position = 0.0}));
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 2, .carrier = Name::Of("second"), .recorded_position = 0.0}));
  EXPECT_TRUE(rig.RunToEnd(rig.Give(Line(0, 0, 0, 1)), 2));
  rig.trace.clear();
  rig.Give(Line(0, 0, 25, 1, BufferMode::kBuffered));
  rig.Give(Line(0, 0, 25, 2, BufferMode::kBlendingNext, radius));
  const Ticket down = rig.Give(Line(0, 0, 0, 2, BufferMode::kBlendingNext, radius));
  EXPECT_TRUE(rig.RunToEnd(down, 5));
  EXPECT_TRUE(rig.lives[down].done) << static_cast<int>(rig.lives[down].error_id);
  EXPECT_LE(OffPlace(rig, *belts, 1, 0, {}, {}), kOnObject);
  ExpectSmooth(rig);
  Pick pick;
  const double begin = rig.trace.front().out.path_position, end = rig.trace.back().out.path_position;
  for (const Sample& sample : rig.trace) {
    const Outputs& out = sample.out;
    if (out.path_velocity > 0) pick.time += rig.cycle.period_s;
    if (out.path_position > begin + 5 && out.path_position < end - 5) {
      pick.slowest = std::min(pick.slowest, out.path_velocity);
    }
  }
  return pick;
}

// CV-23, GR-22: whatever the belts do, the corners of a pick are rounded, and a larger blend is no slower.
TEST(Riding, BlendsBetweenBelts) {
  const auto steady = [](double speed) { return [=](double t) { return Steady(t - 0.3, speed); }; };
  const auto uneven = [](double t) {  // 250 mm/s, more and less by 50
    return KinematicState{250 * (t - 0.3) - 2.5 * std::cos(20 * t), 250 + 50 * std::sin(20 * t),
                          1000 * std::cos(20 * t)};
  };
  const auto gantry = [] {
    KinematicsParams k;
    k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
    return Machine(k, {"x", "y", "z"}, {4000, 40000, 2e6},
                   {.velocity = 3000, .acceleration = 30000, .deceleration = {}, .jerk = 1.5e6});
  };
  const std::vector<std::pair<Travel, Travel>> cases = {
      {steady(0), steady(0)}, {steady(300), steady(400)}, {steady(300), steady(-200)}, {uneven, steady(200)}};
  double standing[2] = {};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const bool delta : {false, true}) {
      double before = 1e99;
      for (const double radius : {2.5, 5.0, 7.5, 10.0, 11.0, 12.0, 12.5}) {
        SCOPED_TRACE(testing::Message() << "case " << i << (delta ? ", Delta, " : ", gantry, ") << radius << " mm");
        const Pick pick =
            Across(delta ? DeltaRobot() : gantry(), delta ? -850 : 0, cases[i].first, cases[i].second, radius);
        EXPECT_LE(pick.time, 1.03 * before);
        EXPECT_GE(pick.slowest, 20 * radius);  // mm/s: it does not stop there
        before = pick.time;
      }
      if (i == 0) standing[delta] = before;
      // Limits are not used up where belts change their speed.
      EXPECT_LE(before, (i == 3 ? 1.2 : 1.1) * standing[delta]);
    }
  }
}

// CV-11: what is published as the tool gets onto a belt, over to another one and off: in step it is seen from the
// object that it is on, to the last digits.
TEST(Riding, TellsWhatItIsOn) {
  Rig rig = Gantry();
  rig.StartAt({-100, 0, 0});
  const auto belts = Put(rig, {BeltAt("first", {0, 0, 0}, [](double t) { return Steady(t, 100); }),
                               BeltAt("second", {0, 200, 0}, [](double t) { return Steady(t, -50); })});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("first"), .recorded_position = 0.0}));
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 2, .carrier = Name::Of("second"), .recorded_position = 0.0}));
  std::vector<TrackState> seen;
  int in_sync = 0;
  const auto step = [&] {
    rig.Step();
    const Outputs& out = rig.out();
    if (seen.empty() || out.track_state != seen.back()) seen.push_back(out.track_state);
    EXPECT_EQ(out.in_sync, out.track_state == TrackState::kInSync);
    if (!out.in_sync) return;
    ++in_sync;
    const std::size_t belt = seen.size() > 3 ? 1 : 0;
    const KDL::Vector place(out.object_x, out.object_y, out.object_z);
    EXPECT_LE((ObjectOn(*belts, belt, 0, {}, rig.cycle.count - 1) * place - ToolOf(rig).p).Norm(), kOnObject);
  };
  for (const bool together : {false, true}) {
    for (const BufferMode buffer : {BufferMode::kBuffered, BufferMode::kBlendingNext}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(buffer) << (together ? " together" : " one by one"));
      seen.clear();
      step();
      Ticket last = 0;
      const auto wait = [&] {
        for (int i = 0; i < 3000 && !rig.lives[last].ended(); ++i) step();
        EXPECT_TRUE(rig.lives[last].done);
        for (int i = 0; i < 20; ++i) step();
      };
      for (const MoveLinearAbsolute& move :
           {Line(0, 0, 0, 1, buffer), Line(0, 0, 30, 1, buffer, 10), Line(0, 0, 30, 2, buffer, 10),
            Line(0, 0, 0, 2, buffer, 10), Line(-100, 0, 0, 0, buffer, 10)}) {
        last = rig.Give(move);
        if (!together) wait();
      }
      wait();
      using enum TrackState;
      EXPECT_EQ(seen, (std::vector{kNone, kSynchronizing, kInSync, kSynchronizing, kInSync, kDesynchronizing, kNone}));
    }
  }
  EXPECT_GT(in_sync, 1000);
}

// CV-23: given at any time while the tool comes to rest, a move onto a belt and the one behind it are rounded. Behind a
// path that is planned ahead it stops.
TEST(Riding, BlendsBehindAMotionThatEnds) {
  for (const double speed : {0.0, 300.0}) {
    for (int given = 0; given < 200; given += 10) {
      SCOPED_TRACE(testing::Message() << speed << " mm/s, given in cycle " << given);
      Rig rig = DeltaRobot();
      rig.params.path.planned_ahead = false;
      rig.StartAt({-150, -60, -850});
      const auto belts =
          Put(rig, {BeltAt("belt", {100, 150, -900, 0, 0, 180}, [=](double t) { return Steady(t, speed); })});
      rig.Give(Line(0, -60, -850, 0, BufferMode::kBuffered));
      rig.Run(0.001 * given);
      rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt")});
      const Ticket over = rig.Give(Line(0, 0, 40, 1, BufferMode::kBlendingNext, 18));
      const Ticket down = rig.Give(Line(0, 0, 0, 1, BufferMode::kBlendingNext, 18));
      bool fast = false;
      while (!rig.lives[down].ended() && rig.cycle.count < 3000) {
        rig.Step();
        fast |= rig.out().command == over && rig.out().path_velocity > 1000;
        if (fast && rig.out().path_left > 30) {
          ASSERT_GT(rig.out().path_velocity, 400);
        }
      }
      EXPECT_TRUE(fast);
      EXPECT_TRUE(rig.lives[down].done);
    }
  }
}

MoveArch Arch(double x, double y, double z, double height, std::uint32_t pcs, BufferMode buffer, double radius = 0) {
  return On(MoveArch{.x = x, .y = y, .z = z, .height = height}, pcs, buffer, radius);
}

// PP-11: an arch that stands keeps to its ellipse.
TEST(Arch, KeepsToItsEllipse) {
  Rig rig = Gantry();
  rig.StartAt({-150, 0, 0});
  const Ticket move = rig.Give(Arch(150, 0, 0, 60, 0, BufferMode::kBuffered));
  ASSERT_TRUE(rig.RunToEnd(move, 5));
  EXPECT_TRUE(rig.lives[move].done);
  ExpectSmooth(rig);
  double highest = 0;
  for (const Sample& sample : rig.trace) {
    const KDL::Vector p = ToolOf(rig, sample).p;
    highest = std::max(highest, p.z());
    EXPECT_NEAR(p.x() * p.x() / (150 * 150) + p.z() * p.z() / (60 * 60), 1, 1e-3);
  }
  EXPECT_NEAR(highest, 60, 1e-2);
}

// PP-11, CV-23: onto a belt along an arch, between a lift and a lowering.
TEST(Arch, LeadsOntoABelt) {
  Rig rig = Gantry();
  rig.StartAt({-150, 0, 0});
  const auto belts = Put(rig, {BeltAt("belt", {0, 100, -20}, [](double t) { return Steady(t, 300); })});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt"), .recorded_position = 0.0}));
  rig.trace.clear();
  rig.Give(Line(-150, 0, 30, 0, BufferMode::kBuffered));
  rig.Give(Arch(0, 0, 30, 50, 1, BufferMode::kBlendingNext, 10));
  const Ticket down = rig.Give(Line(0, 0, 0, 1, BufferMode::kBlendingNext, 10));
  ASSERT_TRUE(rig.RunToEnd(down, 5));
  ASSERT_TRUE(rig.lives[down].done) << static_cast<int>(rig.lives[down].error_id);
  EXPECT_LE(OffPlace(rig, *belts, 0, 0, {}, {}), kOnObject);
  ExpectSmooth(rig);
  // No stop on the way.
  bool moving = false;
  for (std::size_t n = 50; n + 50 < rig.trace.size(); ++n) {
    moving |= rig.trace[n].out.path_velocity > 0;
    EXPECT_GT(rig.trace[n].out.path_velocity, 20) << n;
  }
  EXPECT_TRUE(moving);
}

// Standing on an object of a belt with this motion, `on` the belt.
struct Seated {
  explicit Seated(std::function<KinematicState(double)> travel, const Pose& origin = {0, 100, -20})
      : belts(Put(rig, {BeltAt("belt", origin, std::move(travel))})) {
    rig.StartAt({-50, 0, 0});
    rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt")}));
    from = rig.state.cargoes[0].from;
    rig.trace.clear();
    const Ticket move = rig.Give(Line(0, 0, 0, 1));
    EXPECT_TRUE(rig.RunToEnd(move, 5));
    EXPECT_TRUE(rig.lives[move].done) << static_cast<int>(rig.lives[move].error_id);
  }
  double off(const Pose& place = {}) const { return OffPlace(rig, *belts, 0, from, {}, place); }

  Rig rig = Gantry();
  std::unique_ptr<Belts> belts;
  double from = 0;
};

KinematicState Wavy(double t) {  // 200 mm/s, more and less by 100
  return {200 * t - 20 * std::cos(5 * t), 200 + 100 * std::sin(5 * t), 500 * std::cos(5 * t)};
}

// CV-20: whatever the belt does, the set point is on the object.
TEST(Riding, StaysOnABeltWhoseSpeedChanges) {
  Seated seat(Wavy);
  for (int i = 0; i < 1000; ++i) {
    seat.rig.Step();
    ASSERT_LE(seat.off(), kOnObject);
    ASSERT_EQ(seat.rig.out().track_state, TrackState::kInSync);
  }
  ExpectSmooth(seat.rig);
}

// CV-14, GR-03: stop brakes the tool in the world, while the belt goes on.
TEST(Riding, StopLetsGo) {
  Seated seat([](double t) { return Steady(t, 300); });
  const Ticket stop = seat.rig.Give(Stop{.deceleration = 2000, .jerk = 100000});
  const double x = seat.rig.out().x;
  seat.rig.Step();
  EXPECT_EQ(seat.rig.out().track_state, TrackState::kDesynchronizing);
  ASSERT_TRUE(seat.rig.RunToEnd(stop, 2));
  EXPECT_TRUE(seat.rig.lives[stop].done);
  EXPECT_EQ(seat.rig.out().velocity, 0);
  // As a closed form: braked from 300 mm/s with these.
  const double way = trajectory::StopPosition({0, 300, 0}, {300, 2000, 2000, 100000});
  EXPECT_NEAR(seat.rig.out().x - x, way, 1);
  EXPECT_EQ(seat.rig.out().state, GroupState::kStandby);
  ExpectSmooth(seat.rig);
}

// PP-20: interrupted in the middle of a path onto a belt the tool rests in the world; continued it catches up with the
// belt and goes on from the same place of its path.
TEST(Riding, InterruptRestsAndContinueCatchesUp) {
  for (const double after : {0.02, 0.06, 0.1, 0.14, 0.2, 0.3, 0.5}) {
    SCOPED_TRACE(after);
    Seated seat([](double t) { return Steady(t, 150); });
    Rig& rig = seat.rig;
    const Ticket up = rig.Give(Line(0, 0, 40, 1, BufferMode::kBuffered));
    const Ticket over = rig.Give(Line(60, 30, 40, 1, BufferMode::kBlendingNext, 10));
    const Ticket down = rig.Give(Line(60, 30, 0, 1, BufferMode::kBlendingNext, 10));
    rig.Run(after);
    rig.Give(Interrupt{});
    rig.Run(0.3);
    const Frame rests = ToolOf(rig);
    const KDL::Vector on_object = (ObjectOn(*seat.belts, 0, seat.from, {}, rig.cycle.count - 1).Inverse() * rests).p;
    rig.Run(0.2);
    EXPECT_LE((ToolOf(rig).p - rests.p).Norm(), 1e-9);
    EXPECT_EQ(rig.out().velocity, 0);
    if (!rig.lives[down].ended()) {
      const double position = rig.out().path_position;
      rig.Give(Continue{});
      rig.Step();
      while (IsUncoupled(rig.state)) {
        EXPECT_EQ(rig.out().path_position, position);
        rig.Step();
      }
    }
    EXPECT_TRUE(rig.RunToEnd(down, 5));
    EXPECT_TRUE(rig.lives[up].done && rig.lives[over].done && rig.lives[down].done);
    if (!rig.state.interrupted) {
      EXPECT_LE(seat.off({60, 30, 0}), kOnObject);
    }
    ExpectSmooth(rig);
    EXPECT_LE(std::abs(on_object.y()), 30 + 1e-6);
  }
}

// CV-01: a belt that is found elsewhere after its encoder was lost: the tool follows within the limits, and falls into
// step again.
TEST(Riding, CatchesUpWithABeltThatJumps) {
  for (const double jump : {80.0, -80.0}) {
    SCOPED_TRACE(jump);
    double jumped = 0;
    Seated seat([&](double t) { return KinematicState{150 * t + jumped, 150, 0}; });
    Rig& rig = seat.rig;
    rig.Run(0.1);
    ASSERT_LE(seat.off(), kOnObject);
    jumped = jump;
    rig.Step();
    EXPECT_FALSE(rig.out().in_sync);
    EXPECT_NEAR(seat.off(), std::abs(jump), 1);
    for (int i = 0; i < 500; ++i) {
      rig.Step();
      EXPECT_NEAR(rig.out().y, 100, 1e-9);  // along the belt
      for (const axis::State& member : rig.states) {
        const double lag = member.guidance.demand.position - member.origin - member.setpoint.position;
        ASSERT_LE(std::abs(lag), 1e-6) << i;
      }
    }
    EXPECT_TRUE(rig.out().in_sync);
    EXPECT_LE(seat.off(), kOnObject);
    ExpectSmooth(rig);
  }
}

// CV-22: near the middle of a table the tool hardly moves; it stays in step also where the table becomes much faster
// than it was, and than it could have been further out, when the tool got onto it.
TEST(Riding, StaysNearTheMiddleOfATable) {
  Rig rig = Gantry();
  rig.StartAt({-300, 0, 0});
  const auto speed = [](double t) {  // 10 deg/s, from 2 s on up to 80 deg/s within a second
    const double x = std::clamp(t - 2, 0.0, 1.0), after = std::max(0.0, t - 3);
    const double degrees = 10 * t + 70 * (x * x * x * (1 - 0.5 * x) + after);
    const double radians = std::numbers::pi / 180;
    return KinematicState{radians * degrees, radians * (10 + 70 * x * x * (3 - 2 * x)), radians * 420 * x * (1 - x)};
  };
  const auto belts = Put(rig, {BeltAt("table", {}, speed, CarrierKind::kTurning)});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("table")}));
  const double from = rig.state.cargoes[0].from;
  MoveLinearAbsolute on = Line(30, 0, 0, 1);
  on.velocity = 300;
  ASSERT_TRUE(rig.RunToEnd(rig.Give(on), 5));
  for (int i = 0; i < 6000; ++i) {
    rig.Step();
    ASSERT_LE(OffPlace(rig, *belts, 0, from, {}, {30, 0, 0}), kOnObject) << i;
    ASSERT_TRUE(rig.out().in_sync);
  }
  const Ticket next = rig.Give(Line(-30, 0, 0, 1));
  EXPECT_TRUE(rig.RunToEnd(next, 5));
  EXPECT_TRUE(rig.lives[next].done);
  ExpectSmooth(rig);
}

// A stop before any border (GR-13): a belt that takes the tool out of the axes' range.
TEST(Riding, LetsGoBeforeTheBorder) {
  Rig rig = [] {
    KinematicsParams k;
    k.gantry.emplace().axes = {Coordinate::kX, Coordinate::kY, Coordinate::kZ};
    Rig made = Machine(k, {"x", "y", "z"}, {}, kGantryPath);
    made.axes[0].limits.upper = 300;
    return made;
  }();
  rig.StartAt({-50, 0, 0});
  const auto belts = Put(rig, {BeltAt("belt", {}, [](double t) { return Steady(t, 400); })});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt")}));
  const Ticket move = rig.Give(Line(0, 0, 0, 1));
  ASSERT_TRUE(rig.RunToEnd(move, 3));
  EXPECT_TRUE(rig.lives[move].done);
  rig.Run(2);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_EQ(rig.out().error, ErrorId::kNone);
  EXPECT_EQ(rig.out().reason, kinematics::Reason::kAxisLimit);
  EXPECT_LE(rig.out().x, 300);
  EXPECT_GE(rig.out().x, 270);
  ExpectSmooth(rig);
  // And off again.
  const Ticket back = rig.Give(Line(0, 0, 0));
  EXPECT_TRUE(rig.RunToEnd(back, 3));
  EXPECT_TRUE(rig.lives[back].done);
}

// CV-13 of moves: a belt that is faster than the group can follow.
TEST(Riding, RefusesBeltsThatAreTooFast) {
  Rig rig = Gantry();
  rig.StartAt({0, 0, 0});
  const auto belts = Put(rig, {BeltAt("belt", {}, [](double t) { return Steady(t, 1400); })});
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt")}));
  const Ticket move = rig.Give(Line(0, 0, 0, 1));
  EXPECT_TRUE(rig.RunToEnd(move, 1));
  EXPECT_EQ(rig.lives[move].error_id, ErrorId::kTooFast);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
}

// An aborting move in the object's system goes on from the ride, one of axes leads off it.
TEST(Riding, OtherMovesTakeOver) {
  Seated seat([](double t) { return Steady(t, 150); });
  Rig& rig = seat.rig;
  const Ticket first = rig.Give(Line(100, 0, 0, 1));
  rig.Run(0.05);
  MoveDirectAbsolute direct{.x = 0, .y = 20, .z = 10};
  direct.coordinate_system = CoordinateSystem::kPcs;
  const Ticket second = rig.Give(direct);
  ASSERT_TRUE(rig.RunToEnd(second, 3));
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_TRUE(rig.lives[second].done);
  EXPECT_LE(seat.off({0, 20, 10}), kOnObject);
  const Ticket axes = rig.Give(MoveDirectAbsolute{.a1 = -100, .a2 = -20, .a3 = 30});
  ASSERT_TRUE(rig.RunToEnd(axes, 3));
  EXPECT_TRUE(rig.lives[axes].done);
  EXPECT_NEAR(rig.out().x, -100, 1e-9);
  EXPECT_NEAR(rig.out().z, 30, 1e-9);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  ExpectSmooth(rig);
}

// PP-15, PP-30: how long it will take is known to the cycle.
TEST(Riding, TimeLeftIsExact) {
  Seated seat([](double t) { return Steady(t, 200); });
  Rig& rig = seat.rig;
  rig.Give(Line(0, 0, 40, 1, BufferMode::kBuffered));
  rig.Give(Line(-100, 0, 40, 0, BufferMode::kBlendingNext, 15));
  const Ticket last = rig.Give(Line(-100, 0, 0, 0, BufferMode::kBlendingNext, 15));
  std::vector<std::pair<std::uint64_t, double>> said;
  while (!rig.lives[last].ended()) {
    rig.Step();
    if (!std::isnan(rig.out().time_left) && rig.out().path_velocity > 0) {
      said.push_back({rig.cycle.count - 1, rig.out().time_left});
    }
  }
  std::uint64_t stood = 0;
  for (std::size_t n = 0; n < rig.trace.size(); ++n) {
    if (rig.trace[n].out.path_velocity > 0) stood = n + 1;
  }
  stood += rig.cycle.count - rig.trace.size();
  ASSERT_GE(said.size(), 100u);
  for (const auto& [cycle, left] : said) {
    EXPECT_NEAR(left, static_cast<double>(stood - cycle) * 0.001, 1e-9) << cycle;
  }
}

// CV-42: another tool, or whatever else moves freely, turning and speeding up.
TEST(Riding, OntoAPoseFromElsewhere) {
  Rig rig = GantryWithC();
  rig.StartAt({0, 0, 0});
  const auto pose = [](double t) {
    kinematics::MovingFrame f;
    f.p = KDL::VectorAcc(KDL::Vector(100 + 50 * std::sin(t), 40 * std::cos(t), -30),
                         KDL::Vector(50 * std::cos(t), -40 * std::sin(t), 0),
                         KDL::Vector(-50 * std::sin(t), -40 * std::cos(t), 0));
    f.M = KDL::RotationAcc(KDL::Rotation::RotZ(0.5 * t), KDL::Vector(0, 0, 0.5), KDL::Vector::Zero());
    return f;
  };
  struct Free {
    Rig& rig;
    decltype(pose)& at;
  } free{rig, pose};
  rig.carriers = {[](void*, std::string_view) noexcept -> std::uint32_t { return 1; },
                  [](void* owner, std::uint32_t) noexcept {
                    const Free& f = *static_cast<Free*>(owner);
                    Carrier carrier;
                    carrier.kind = CarrierKind::kFree;
                    carrier.pose = f.at(static_cast<double>(f.rig.cycle.count) * f.rig.cycle.period_s);
                    return carrier;
                  },
                  nullptr, &free};
  rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("mover"), .z = 10}));
  rig.trace.clear();
  MoveLinearAbsolute onto = Line(5, 0, 0, 1);
  onto.c = 0;
  const Ticket move = rig.Give(onto);
  ASSERT_TRUE(rig.RunToEnd(move, 5));
  EXPECT_TRUE(rig.lives[move].done);
  for (int i = 0; i < 500; ++i) {
    rig.Step();
    const Frame want = pose(static_cast<double>(rig.cycle.count - 1) * 0.001).GetFrame() *
                       Frame(KDL::Vector(0, 0, 10)) * Frame(KDL::Vector(5, 0, 0));
    ASSERT_LE((ToolOf(rig).p - want.p).Norm(), 1e-9);
    ASSERT_LE(KDL::diff(ToolOf(rig).M, want.M).Norm(), 1e-9);
  }
  // Stop: there is no travel to be braked, each axis brakes by itself.
  const Ticket interrupt = rig.Give(Interrupt{});
  rig.Step();
  EXPECT_EQ(rig.lives[interrupt].error_id, ErrorId::kState);
  const Ticket stop = rig.Give(Stop{});
  ASSERT_TRUE(rig.RunToEnd(stop, 2));
  EXPECT_TRUE(rig.lives[stop].done);
  EXPECT_EQ(rig.out().velocity, 0);
  ExpectSmooth(rig);
}

}  // namespace
}  // namespace takt::group
