// CV-10 to CV-16, CV-22, CV-40: MC_TrackConveyorBelt and MC_TrackRotaryTable.
#include "belts.h"

namespace takt::group {
namespace {

constexpr double kOrigin = -10.5;  // of the belt, as in the manual's example

Belt SlowBelt(double speed) {
  return BeltAt("belt", {kOrigin, 0, 0}, [=](double t) { return Steady(t, speed); });
}
TrackConveyorBelt Example() {
  TrackConveyorBelt m;
  m.belt = Name::Of("belt");
  m.recorded_position = 0.0;
  m.start_distance = 9;
  m.end_distance = 60.0;
  m.sync_in_conveyor_distance = 3.0;
  m.sync_in_tcp_distance = 1.5;
  return m;
}

double TravelOf(const Rig& rig, const Belts& belts) {
  return belts.all[0].travel(static_cast<double>(rig.cycle.count - 1) * rig.cycle.period_s).position;
}

// CV-15: the manual's Example 1, number for number.
TEST(Track, TheManualsExample) {
  constexpr double kSpeed = 2;
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  const auto belts = Put(rig, {SlowBelt(kSpeed)});
  const Ticket track = rig.Give(Example());
  rig.Step();
  EXPECT_EQ(rig.out().track_state, TrackState::kWaiting);  // CV-11
  while (TravelOf(rig, *belts) < 9) {
    ASSERT_EQ(rig.out().x, 0);
    ASSERT_EQ(rig.out().state, GroupState::kStandby);
    rig.Step();
  }
  EXPECT_EQ(rig.out().state, GroupState::kMoving);
  while (TravelOf(rig, *belts) < 12 - 1e-9) {
    ASSERT_EQ(rig.out().track_state, TrackState::kSynchronizing);
    ASSERT_LE(rig.out().velocity, kSpeed * (1 + 1e-9));  // never faster than the belt
    rig.Step();
  }
  EXPECT_NEAR(TravelOf(rig, *belts), 12, 1e-9);
  EXPECT_NEAR(rig.out().x, 1.5, 1e-6);
  EXPECT_NEAR(rig.out().velocity, kSpeed, 1e-6);
  rig.Step();
  rig.Step();
  EXPECT_EQ(rig.out().track_state, TrackState::kInSync);
  EXPECT_TRUE(rig.out().in_sync);
  for (int i = 0; i < 1000; ++i) {
    rig.Step();
    ASSERT_NEAR(rig.out().x, kOrigin + TravelOf(rig, *belts), 1e-9);  // CV-20
    ASSERT_NEAR(rig.out().object_x, 0, 1e-9);
  }
  EXPECT_FALSE(rig.lives[track].ended());
  rig.Run(30);
  // CV-14: the end distance; the tool comes to rest.
  EXPECT_TRUE(rig.lives[track].done);
  EXPECT_EQ(rig.out().track_state, TrackState::kNone);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_GE(rig.out().x, kOrigin + 60);
  EXPECT_LE(rig.out().x, kOrigin + 60.1);
  ExpectSmooth(rig);
}

// CV-16: without distances as fast as the limits allow: the time of a motion from rest to the belt's speed and place.
TEST(Track, WithoutDistancesInTheShortestTime) {
  constexpr double kSpeed = 200;
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  const auto belts = Put(rig, {SlowBelt(kSpeed)});
  TrackConveyorBelt m;
  m.belt = Name::Of("belt");
  m.recorded_position = 0.0;
  m.start_distance = 40;
  const Ticket track = rig.Give(m);
  while (TravelOf(rig, *belts) < 40) rig.Step();
  const std::uint64_t begin = rig.cycle.count;
  while (!rig.out().in_sync && rig.cycle.count < begin + 2000) rig.Step();
  // The object is ahead: in its frame the tool has to catch up 29.5 mm, from -200 mm/s.
  trajectory::Profile best{};
  const trajectory::Limits limits = {0.9 * 1000 - kSpeed, 8000, 8000, 400000};
  ASSERT_FALSE(rig.planner.ToPosition({-29.5, -kSpeed, 0}, 0, 0, limits, best).failed());
  const double time = static_cast<double>(rig.cycle.count - begin) * rig.cycle.period_s;
  EXPECT_LE(time, 1.1 * best.duration() + 0.004);
  EXPECT_GE(time, 0.9 * best.duration());
  EXPECT_TRUE(rig.lives[track].active);
  ExpectSmooth(rig);
  for (const Sample& sample : rig.trace) EXPECT_LE(sample.out.velocity, 1000 * (1 + 1e-9));
}

// CV-13: each with its own id.
TEST(Track, RefusesWhatCannotBeTracked) {
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  double speed = 50;
  const auto belts = Put(rig, {BeltAt("belt", {}, [&](double t) { return KinematicState{speed * t, speed, 0}; })});
  const auto refused = [&](const TrackConveyorBelt& m) {
    const Ticket ticket = rig.Give(m);
    rig.Step();
    EXPECT_TRUE(rig.lives[ticket].error);
    return rig.lives[ticket].error_id;
  };
  TrackConveyorBelt m = Example();
  m.end_distance = 8.0;
  EXPECT_EQ(refused(m), ErrorId::kTrackOrder);
  m.end_distance = 11.0;
  EXPECT_EQ(refused(m), ErrorId::kTrackShort);
  m.belt = Name::Of("none");
  EXPECT_EQ(refused(m), ErrorId::kUnknownTarget);
  speed = -50;
  EXPECT_EQ(refused(Example()), ErrorId::kBeltBackwards);
  rig.RunToEnd(rig.Give(Disable{}), 1);
  speed = 50;
  EXPECT_EQ(refused(Example()), ErrorId::kGroupDisabled);
}

// CV-14: a belt that goes back past the start ends it, and it stays ended.
TEST(Track, EndsWhenTheBeltGoesBack) {
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  // Forwards to 20 mm, back to 0, forwards again.
  const auto there_and_back = [](double t) {
    const double w = std::numbers::pi / 4;
    return KinematicState{10 - 10 * std::cos(w * t), 10 * w * std::sin(w * t), 10 * w * w * std::cos(w * t)};
  };
  const auto belts = Put(rig, {BeltAt("belt", {kOrigin, 0, 0}, there_and_back)});
  const Ticket track = rig.Give(Example());
  bool in_sync = false;
  double last = 0;
  rig.Step();
  while (!rig.lives[track].ended() && rig.cycle.count < 9000) {
    last = TravelOf(rig, *belts);
    rig.Step();
    in_sync |= rig.out().in_sync;
  }
  EXPECT_TRUE(in_sync);
  EXPECT_TRUE(rig.lives[track].done);
  EXPECT_NEAR(last, 9, 0.5);
  rig.Run(6);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_EQ(rig.out().track_state, TrackState::kNone);
  ExpectSmooth(rig);
}

// CV-14: stop ends it, and the tool stands.
TEST(Track, EndsWithStop) {
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  const auto belts = Put(rig, {SlowBelt(100)});
  const Ticket track = rig.Give(Example());
  rig.Step();
  while (!rig.out().in_sync && rig.cycle.count < 5000) rig.Step();
  const Ticket stop = rig.Give(Stop{});
  ASSERT_TRUE(rig.RunToEnd(stop, 2));
  EXPECT_TRUE(rig.lives[stop].done);
  EXPECT_TRUE(rig.lives[track].aborted);
  EXPECT_EQ(rig.out().velocity, 0);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  ExpectSmooth(rig);
}

// CV-12, CV-21: moves in the object's coordinate system while it is tracked, and away from it (CV-14).
TEST(Track, MovesRunOnTop) {
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  const auto belts = Put(rig, {SlowBelt(100)});
  TrackConveyorBelt m = Example();
  m.end_distance = {};
  m.pcs = 2;
  const Ticket track = rig.Give(m);
  MoveLinearAbsolute down{.x = 0, .y = 5, .z = -20};
  down.coordinate_system = CoordinateSystem::kPcs;
  down.pcs = 2;
  const Ticket early = rig.Give(down);  // waits until it is tracked
  while (TravelOf(rig, *belts) < 9) {
    rig.Step();
    ASSERT_EQ(rig.out().z, 0);
  }
  ASSERT_TRUE(rig.RunToEnd(early, 3));
  EXPECT_TRUE(rig.lives[early].done);
  EXPECT_NEAR(rig.out().object_x, 0, 1e-9);
  EXPECT_NEAR(rig.out().object_y, 5, 1e-9);
  EXPECT_NEAR(rig.out().object_z, -20, 1e-9);
  EXPECT_FALSE(rig.lives[track].ended());
  MoveCircularAbsolute around{.aux_x = 10, .aux_y = 15, .aux_z = -20, .x = 20, .y = 5, .z = -20};
  around.coordinate_system = CoordinateSystem::kPcs;
  around.pcs = 2;
  const Ticket arc = rig.Give(around);
  ASSERT_TRUE(rig.RunToEnd(arc, 3));
  EXPECT_TRUE(rig.lives[arc].done);
  EXPECT_NEAR(rig.out().object_x, 20, 1e-9);
  EXPECT_FALSE(rig.lives[track].ended());
  const Ticket away = rig.Give(MoveLinearAbsolute{.x = -50, .y = 0, .z = 10});
  ASSERT_TRUE(rig.RunToEnd(away, 3));
  EXPECT_TRUE(rig.lives[away].done);
  EXPECT_TRUE(rig.lives[track].aborted);
  EXPECT_NEAR(rig.out().x, -50, 1e-9);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  ExpectSmooth(rig);
}

// CV-22: on a table, either way round.
TEST(Track, OnATableEitherWayRound) {
  for (const double speed : {0.4, -0.4}) {
    SCOPED_TRACE(speed);
    Rig rig = GantryWithC();
    rig.StartAt({100, 0, 0});
    const auto belts =
        Put(rig, {BeltAt(
                     "table", {0, 0, -5}, [=](double t) { return Steady(t, speed); }, CarrierKind::kTurning)});
    TrackRotaryTable m;
    m.table = Name::Of("table");
    m.x = 100;
    m.recorded_position = 0.0;
    m.start_angle = 20;
    m.end_angle = 140.0;
    const Ticket track = rig.Give(m);
    std::uint64_t steps = 0;
    rig.Step();
    while (!rig.out().in_sync && ++steps < 5000) rig.Step();
    ASSERT_TRUE(rig.out().in_sync);
    const double c0 = rig.out().c;
    const double turned = TravelOf(rig, *belts);
    for (int i = 0; i < 1000; ++i) {
      rig.Step();
      const double angle = TravelOf(rig, *belts);
      ASSERT_NEAR(rig.out().x, 100 * std::cos(angle), 1e-9);
      ASSERT_NEAR(rig.out().y, 100 * std::sin(angle), 1e-9);
    }
    EXPECT_NEAR(rig.out().c - c0, (TravelOf(rig, *belts) - turned) * 180 / std::numbers::pi, 1e-6);
    EXPECT_TRUE(rig.RunToEnd(track, 20));
    EXPECT_TRUE(rig.lives[track].done);
    ExpectSmooth(rig);
  }
}

// CV-41: the set points with the belt's share and without it.
TEST(Track, PublishesWithAndWithoutTheBeltsShare) {
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  const auto belts = Put(rig, {SlowBelt(100)});
  TrackConveyorBelt m = Example();
  m.end_distance = {};
  rig.Give(m);
  rig.Step();
  while (!rig.out().in_sync && rig.cycle.count < 5000) rig.Step();
  MoveLinearAbsolute move{.x = 30, .y = 0, .z = 0, .velocity = 50};
  move.coordinate_system = CoordinateSystem::kPcs;
  const Ticket ticket = rig.Give(move);
  double before = rig.out().object_x;
  while (!rig.lives[ticket].ended()) {
    rig.Step();
    ASSERT_NEAR(rig.out().object_x, rig.out().x - kOrigin - TravelOf(rig, *belts), 1e-9);
    ASSERT_LE(rig.out().object_x - before, 50 * 0.001 + 1e-9);  // the move's own speed
    before = rig.out().object_x;
  }
  EXPECT_NEAR(rig.out().object_x, 30, 1e-9);
  EXPECT_NEAR(rig.out().velocity, 100, 1e-6);
}

// In step with a belt that then speeds up harder than the group may.
Sample HardestOf(AfterSync after, double& out_of_step) {
  Rig rig = Gantry();
  rig.params.path.acceleration = 500;
  rig.params.tracking.after_sync = after;
  rig.Start({0, 0, 0});
  const auto pull = [](double t) {  // 100 mm/s, from 2 s on 2000 mm/s² for a tenth of a second
    const double x = std::clamp(t - 2, 0.0, 0.1), rest = std::max(0.0, t - 2.1);
    return KinematicState{100 * t + 1000 * x * x + 200 * rest, 100 + 2000 * x, x > 0 && rest == 0 ? 2000.0 : 0.0};
  };
  const auto belts = Put(rig, {BeltAt("belt", {kOrigin, 0, 0}, pull)});
  TrackConveyorBelt m = Example();
  m.end_distance = {};
  rig.Give(m);
  rig.Step();
  while (!rig.out().in_sync && rig.cycle.count < 1900) rig.Step();
  EXPECT_TRUE(rig.out().in_sync);
  Sample hardest = rig.trace.back();
  out_of_step = 0;
  for (int i = 0; i < 3000; ++i) {
    rig.Step();
    if (rig.out().acceleration > hardest.out.acceleration) hardest = rig.trace.back();
    if (!rig.out().in_sync) out_of_step += rig.cycle.period_s;
  }
  EXPECT_TRUE(rig.out().in_sync);  // and back
  EXPECT_NEAR(rig.out().x, kOrigin + TravelOf(rig, *belts), 1e-9);
  ExpectSmooth(rig);
  return hardest;
}

// CV-40: once in step the group's limits give way to the belt, or the tool falls out of step and comes back.
TEST(Track, StaysInStepOrKeepsTheLimits) {
  double out_of_step = 0;
  const Sample stays = HardestOf(AfterSync::kStay, out_of_step);
  EXPECT_GE(stays.out.acceleration, 2000 - 1);  // the belt steps harder than the axes can, who make up for it
  EXPECT_LE(out_of_step, 0.05);                 // until the axes have made up for what their jerk cost
  const Sample limited = HardestOf(AfterSync::kLimited, out_of_step);
  EXPECT_LE(limited.out.acceleration, 500 * (1 + 1e-9));
  EXPECT_GT(out_of_step, 0.1);
}

// CV-40: in step from a distance on, for a time; the override may hold for getting there.
TEST(Track, ToleranceAndOverride) {
  const auto time_to_sync = [](double tolerance, double time_s, bool override_in_sync) {
    Rig rig = Gantry();
    rig.params.tracking = {AfterSync::kStay, tolerance, time_s, override_in_sync};
    rig.Start({0, 0, 0});
    const auto belts = Put(rig, {SlowBelt(100)});
    rig.Give(SetOverride{.velocity_factor = 0.3});
    TrackConveyorBelt m;
    m.belt = Name::Of("belt");
    m.recorded_position = 0.0;
    m.start_distance = 80;
    rig.Give(m);
    while (TravelOf(rig, *belts) < 80) rig.Step();
    const std::uint64_t begin = rig.cycle.count;
    while (!rig.out().in_sync && rig.cycle.count < begin + 3000) rig.Step();
    ExpectSmooth(rig);
    return static_cast<double>(rig.cycle.count - begin) * rig.cycle.period_s;
  };
  const double exact = time_to_sync(0, 0, false);
  EXPECT_LT(time_to_sync(5, 0, false), exact);
  EXPECT_NEAR(time_to_sync(5, 0.05, false), time_to_sync(5, 0, false) + 0.05, 0.0021);
  EXPECT_GT(time_to_sync(0, 0, true), 1.2 * exact);
}

// CV-10: delayed behind the motion in progress, queued behind all.
TEST(Track, WaitsForMotionsAsItsModeSays) {
  for (const auto mode : {ExecutionMode::kImmediately, ExecutionMode::kDelayed, ExecutionMode::kQueued}) {
    Rig rig = Gantry();
    rig.Start({0, 0, 0});
    const auto belts = Put(rig, {SlowBelt(20)});
    const Ticket first = rig.Give(MoveLinearAbsolute{.x = 100, .velocity = 100});
    MoveLinearAbsolute back{.x = 0, .velocity = 100};
    back.buffer_mode = BufferMode::kBuffered;
    const Ticket second = rig.Give(back);
    rig.Step();
    TrackConveyorBelt m = Example();
    m.recorded_position = {};
    m.start_distance = 1;
    m.execution_mode = mode;
    const Ticket track = rig.Give(m);
    while (!rig.lives[track].active && rig.cycle.count < 5000) rig.Step();
    EXPECT_EQ(rig.lives[first].done, mode != ExecutionMode::kImmediately);
    EXPECT_EQ(rig.lives[second].done, mode == ExecutionMode::kQueued);
    while (!rig.out().in_sync && rig.cycle.count < 9000) rig.Step();
    EXPECT_TRUE(rig.out().in_sync);
    ExpectSmooth(rig);
  }
}

// CV-14, CV-23: from the object of one belt to that of another, both tracked, by a move and without a stop.
TEST(Track, FromBeltToBelt) {
  Rig rig = Gantry();
  rig.Start({0, 0, 0});
  const auto belts =
      Put(rig, {SlowBelt(100), BeltAt("other", {100, 80, 0, 0, 0, 180}, [](double t) { return Steady(t, 80); })});
  TrackConveyorBelt m = Example();
  m.end_distance = {};
  const Ticket first = rig.Give(m);
  rig.Step();
  while (!rig.out().in_sync && rig.cycle.count < 5000) rig.Step();
  TrackConveyorBelt other;
  other.belt = Name::Of("other");
  other.pcs = 2;
  other.start_distance = 5;
  const Ticket second = rig.Give(other);
  MoveLinearAbsolute onto{.x = 0, .y = 0, .z = 10};
  onto.coordinate_system = CoordinateSystem::kPcs;
  onto.pcs = 2;
  onto.buffer_mode = BufferMode::kBuffered;
  const Ticket move = rig.Give(onto);
  double slowest = 1e9;
  while (!rig.lives[move].ended() && rig.cycle.count < 9000) {
    rig.Step();
    slowest = std::min(slowest, rig.out().velocity);
  }
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_TRUE(rig.lives[first].aborted);
  rig.Run(0.1);
  EXPECT_TRUE(rig.lives[second].active && !rig.lives[second].ended());
  EXPECT_EQ(rig.out().track_state, TrackState::kInSync);
  EXPECT_NEAR(rig.out().object_z, 10, 1e-9);
  EXPECT_NEAR(rig.out().velocity, 80, 1e-6);
  EXPECT_GT(slowest, 5);
  ExpectSmooth(rig);
}

}  // namespace
}  // namespace takt::group
