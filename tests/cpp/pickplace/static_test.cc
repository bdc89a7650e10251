// PP-10, PP-14 to PP-16, PP-21, PP-30: profiles between static places.
#include "cell.h"

namespace takt::pickplace {
namespace {

// Returns the first cycle of the trace from which on the set points stay at a place.
std::size_t ArrivalAt(const Cell& cell, double x, double y, double z) {
  std::size_t i = cell.rig.trace.size();
  const auto off = [&](std::size_t k) {
    const group::Outputs& o = cell.rig.trace[k].out;
    return (KDL::Vector(o.x, o.y, o.z) - KDL::Vector(x, y, z)).Norm();
  };
  while (i > 0 && off(i - 1) < 1e-9) --i;
  return i;
}
std::vector<std::size_t> PulsesOf(const Cell& cell) {
  std::vector<std::size_t> pulses;
  for (std::size_t i = 0; i < cell.outs.size(); ++i) {
    if (cell.outs[i].pulse_gripper) pulses.push_back(i);
  }
  return pulses;
}

// PP-10: via both points to the target; the ticket ends there.
TEST(Static, OneProfile) {
  Cell cell;
  cell.Start();
  cell.Do(To(300, 0, -10));
  const Ticket ticket = cell.Execute();
  cell.Step();
  EXPECT_EQ(cell.state.state, PickPlaceState::kPreparingPath);
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  EXPECT_LT(cell.Off(300, 0, -10), 1e-9);
  double highest = -100;
  for (const auto& sample : cell.rig.trace) highest = std::max(highest, sample.out.z);
  EXPECT_NEAR(highest, 30, 2.5);  // the corner is rounded
  EXPECT_TRUE(cell.RunTo(PickPlaceState::kReady, 0.1));
  EXPECT_TRUE(cell.out().in_target);
  EXPECT_TRUE(cell.out().done);
}

// PP-10: without a radius it stops at both points, and passes them.
TEST(Static, StopsAtPointsWithoutARadius) {
  Settings s = Fast();
  s.blending_radius = 0;
  Cell cell(s);
  cell.Start();
  cell.Do(To(300, 0, -10));
  ASSERT_TRUE(cell.RunToEnd(cell.Execute(), 5));
  int stops = 0;
  for (const KDL::Vector& point : {KDL::Vector(0, 0, 30), KDL::Vector(300, 0, 10)}) {
    for (const auto& sample : cell.rig.trace) {
      if ((KDL::Vector(sample.out.x, sample.out.y, sample.out.z) - point).Norm() > 1e-9) continue;
      EXPECT_LT(sample.out.velocity, 1e-9);
      ++stops;
      break;
    }
  }
  EXPECT_EQ(stops, 2);
}

// PP-11: half an ellipse: its crest lies z_elliptical above the higher point; refused in a PCS that is turned about A.
TEST(Static, Ellipse) {
  Settings s = Fast();
  s.path_mode = PathMode::kElliptical;
  s.z_elliptical = 60;
  Cell cell(s);
  cell.Start();
  cell.Do(To(300, 0, -10));
  const Ticket ticket = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  ASSERT_TRUE(cell.rig.lives[ticket].done) << static_cast<int>(cell.rig.lives[ticket].error_id);
  EXPECT_LT(cell.Off(300, 0, -10), 1e-9);
  double highest = -100;
  for (const auto& sample : cell.rig.trace) highest = std::max(highest, sample.out.z);
  EXPECT_NEAR(highest, 90, 0.05);
  ASSERT_TRUE(cell.RunTo(PickPlaceState::kReady, 1));
  cell.rig.RunToEnd(cell.rig.Give(group::SetCartesianTransform{.pcs = 4, .x = 100, .a = 5}), 1);
  Configure c;
  c.target_coordinate_system = group::CoordinateSystem::kPcs;
  c.target_pcs = 4;
  cell.Do(c);
  const Ticket turned = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(turned, 1));
  EXPECT_EQ(cell.rig.lives[turned].error_id, ErrorId::kTiltedEllipse);
}

// PP-20: stopped in the middle of an ellipse, jogged away and brought back: it continues over the same height.
TEST(Static, EllipseGoneOnWith) {
  Settings s = Fast();
  s.path_mode = PathMode::kElliptical;
  s.z_elliptical = 60;
  Cell cell(s);
  cell.Start();
  cell.Do(To(400, 0, 0));
  const Ticket ticket = cell.Execute();
  cell.RunUntil([&] { return cell.tool().x() > 30; }, 5);
  cell.Do(Control{.path_stop = true});
  ASSERT_TRUE(cell.RunUntil([&] { return cell.out().path_hold; }, 5));
  cell.Do(Control{.select_axis = SelectAxis::kY});
  cell.Do(Jog{.negative = true});
  cell.Steps(300);
  cell.Do(Jog{});
  ASSERT_TRUE(cell.RunTo(PickPlaceState::kStop, 2));
  cell.Do(Control{.path_stop = false});
  const Ticket back = cell.Give(Control{.return_to_path = true});
  ASSERT_TRUE(cell.RunToEnd(back, 5));
  cell.rig.trace.clear();
  cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done) << static_cast<int>(cell.rig.lives[ticket].error_id);
  double highest = -100;
  for (const auto& sample : cell.rig.trace) highest = std::max(highest, sample.out.z);
  EXPECT_NEAR(highest, 90, 3);
  EXPECT_LT(cell.Off(400, 0, 0), 1e-9);
}

// PP-14: a target in a PCS at rest, from the MCS.
TEST(Static, TargetInAPcs) {
  Cell cell;
  cell.Start();
  cell.rig.RunToEnd(cell.rig.Give(group::SetCartesianTransform{.pcs = 4, .x = 100, .y = 50, .z = 0, .c = 90}), 1);
  Configure c = To(200, 0, 5);
  c.target_coordinate_system = group::CoordinateSystem::kPcs;
  c.target_pcs = 4;
  cell.Do(c);
  ASSERT_TRUE(cell.RunToEnd(cell.Execute(), 5));
  EXPECT_LT(cell.Off(100, 250, 5), 1e-9);
}

// PP-16: waiting profiles are executed in sequence, as they were accepted; the eighth fills the module.
TEST(Static, ProfilesWait) {
  Cell cell;
  cell.Start();
  std::vector<Ticket> tickets;
  for (std::size_t i = 0; i < kOrders; ++i) {
    cell.Give(To(i % 2 == 0 ? 100 + 10.0 * static_cast<double>(i) : 0, 0, 0));
    tickets.push_back(cell.Execute());
  }
  const Ticket beyond = cell.Execute();
  cell.Step();
  EXPECT_EQ(cell.rig.lives[beyond].error_id, ErrorId::kBufferFull);
  EXPECT_TRUE(cell.out().profile_in_preparation);
  cell.Do(To(-500, -500, -500));
  for (std::size_t i = 0; i < kOrders; ++i) {
    ASSERT_TRUE(cell.RunToEnd(tickets[i], 5)) << i;
    EXPECT_TRUE(cell.rig.lives[tickets[i]].done);
    EXPECT_LT(cell.Off(i % 2 == 0 ? 100 + 10.0 * static_cast<double>(i) : 0, 0, 0), 0.01) << i;
  }
  EXPECT_TRUE(cell.RunTo(PickPlaceState::kReady, 0.1));
  EXPECT_EQ(cell.state.counters.placed, kOrders);
}

// PP-30: the pulse comes the time set before the profile ends, to the cycle, for one cycle; with blending and without,
// for short and long times. The precalculated time is the real one (PP-15).
TEST(Static, PulseToTheCycle) {
  for (const double radius : {0.0, 10.0}) {
    for (const double time : {0.001, 0.02, 0.05, 0.15}) {
      SCOPED_TRACE(testing::Message() << "radius " << radius << ", time " << time);
      Settings s = Fast();
      s.blending_radius = radius;
      s.gripper_closing_time = time;
      Cell cell(s);
      cell.Start();
      cell.Do(To(310, 20, -10));
      const Ticket ticket = cell.Execute();
      cell.Step();
      ASSERT_TRUE(cell.RunToEnd(ticket, 5));
      cell.Steps(5);
      const std::size_t end = ArrivalAt(cell, 310, 20, -10);
      const auto pulses = PulsesOf(cell);
      ASSERT_EQ(pulses.size(), 1u);
      EXPECT_EQ(end - pulses[0], static_cast<std::size_t>(std::llround(time / 0.001)));
      std::size_t begin = 0;
      while (cell.rig.trace[begin].out.velocity == 0) ++begin;
      EXPECT_NEAR(cell.state.profile_time, 0.001 * static_cast<double>(end - begin), 0.0011);
    }
  }
}

// PP-63, PP-15: the time of a profile that waited is known when the tool starts, and is the real one; for a profile
// from rest and for the last one it is known later.
TEST(Static, ProfileTimeIsKnownWhenTheToolSetsOut) {
  Cell cell(Fast());
  cell.Start();
  std::vector<Ticket> tickets;
  for (int i = 0; i < 5; ++i) {
    cell.Give(To(i % 2 == 0 ? 200 + 10.0 * i : 0, 10.0 * i, 0));
    tickets.push_back(cell.Execute());
  }
  for (std::size_t k = 0; k < tickets.size(); ++k) {
    int cycles = 0, known = -1;
    double told = 0, later = 0;
    while (!cell.rig.lives[tickets[k]].done && cycles < 5000) {
      cell.Step();
      if (cell.out().set_path_velocity > 0 || cycles > 0) ++cycles;
      if (cycles == 0 || cell.rig.lives[tickets[k]].done) continue;
      later = cell.out().precalculated_profile_time;
      if (known >= 0 || !(later > 0)) continue;
      known = cycles;
      told = later;
    }
    ASSERT_GE(known, 0) << k;
    EXPECT_NEAR(told, 0.001 * cycles, k == 0 ? 0.0051 : 0.0021) << k;
    EXPECT_NEAR(later, told, 0.0021) << k;
    // The corner before the last line stays open as long as there is time.
    if (k + 1 < tickets.size()) {
      EXPECT_LE(known, k == 0 ? 60 : 1) << k;
    }
  }
}

// PP-30: each of several profiles has its pulse, to the cycle, although the next one is planned already.
TEST(Static, PulsesOfProfilesBehindOneAnother) {
  Settings s = Fast();
  s.gripper_closing_time = 0.03;
  Cell cell(s);
  cell.Start();
  cell.Give(To(200, 0, 0));
  const Ticket first = cell.Execute();
  cell.Give(To(0, 100, 0));
  const Ticket second = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(second, 5));
  EXPECT_TRUE(cell.rig.lives[first].done);
  const auto pulses = PulsesOf(cell);
  ASSERT_EQ(pulses.size(), 2u);
  std::size_t at_first = 0;
  while (std::abs(cell.rig.trace[at_first].out.x - 200) + std::abs(cell.rig.trace[at_first].out.z) > 1e-9) ++at_first;
  EXPECT_EQ(at_first - pulses[0], 30u);
  EXPECT_EQ(ArrivalAt(cell, 0, 100, 0) - pulses[1], 30u);
}

// PP-30: without a time there is no gripper control and no pulse.
TEST(Static, NoTimeNoPulse) {
  Cell cell;
  cell.Start();
  cell.Do(To(200, 0, 0));
  const Ticket ticket = cell.Execute();
  cell.Steps(50);
  EXPECT_FALSE(cell.out().gripper_control_active);
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(PulsesOf(cell).empty());
}

// PP-21: the override scales the speed; gripper control is off while it is not 1, and for a profile in which it was
// not.
TEST(Static, Override) {
  Settings s = Fast();
  s.gripper_closing_time = 0.05;
  Cell cell(s);
  cell.Start();
  cell.Do(To(600, 0, 0));
  cell.Do(Control{.override_factor = 0.5});
  const Ticket ticket = cell.Execute();
  cell.Steps(20);
  EXPECT_FALSE(cell.out().gripper_control_active);
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  double fastest = 0;
  for (const auto& sample : cell.rig.trace) fastest = std::max(fastest, sample.out.velocity);
  EXPECT_NEAR(fastest, 500, 1);
  EXPECT_TRUE(PulsesOf(cell).empty());
  cell.Do(Control{.override_factor = 1});
  cell.outs.clear();
  cell.Do(To(0, 0, 0));
  ASSERT_TRUE(cell.RunToEnd(cell.Execute(), 5));
  EXPECT_EQ(PulsesOf(cell).size(), 1u);
}

// PP-15: limits of the axes of the tool and of Aux1 hold, each its own; 0 switches one off.
TEST(Static, LimitsOfEachAxis) {
  Settings s = Fast();
  s.max_velocity = {400, 0, 90, 0, 0, 0, 50};
  s.max_acceleration = {3000, 0, 900, 0, 0, 0, 700};
  s.max_jerk = {100000, 0, 40000, 0, 0, 0, 30000};
  Cell cell(s, {}, group::GantryWithAuxiliary());
  cell.Start();
  Configure c = To(300, 80, -10);
  c.aux1_target = 20;
  cell.Do(c);
  const Ticket ticket = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(ticket, 10));
  ASSERT_TRUE(cell.rig.lives[ticket].done);
  const std::array limits = {400.0, 1e9, 90.0, 50.0};
  const std::array ramps = {3000.0, 1e9, 900.0, 700.0};
  std::array<double, 4> fastest{}, strongest{};
  for (const auto& sample : cell.rig.trace) {
    for (std::size_t k = 0; k < 4; ++k) {
      fastest[k] = std::max(fastest[k], std::abs(sample.set[k].velocity));
      strongest[k] = std::max(strongest[k], std::abs(sample.set[k].acceleration));
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LE(fastest[k], limits[k] * (1 + 1e-9)) << k;
    EXPECT_LE(strongest[k], ramps[k] * (1 + 1e-9)) << k;
  }
  EXPECT_GT(fastest[2], 60);
  EXPECT_NEAR(cell.rig.trace.back().set[3].position, 20, 1e-9);
}

// PP-15: the points passed by the profile are published by number.
TEST(Static, PointsPassed) {
  Settings s = Fast();
  s.blending_radius = 0;
  Cell cell(s);
  cell.Start();
  cell.Do(To(200, 0, 0));
  const Ticket ticket = cell.Execute();
  std::vector<std::uint32_t> seen;
  while (!cell.rig.lives[ticket].ended()) {
    cell.Step();
    const std::uint32_t point = cell.out().profile_point_passed;
    if (cell.state.state == PickPlaceState::kMovePp && (seen.empty() || seen.back() != point)) seen.push_back(point);
  }
  EXPECT_EQ(seen, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

// PP-10: no path there: the module is in ERROR with the group's reason, and accepts the next profile after a reset.
TEST(Static, OutOfReach) {
  group::Rig rig = group::Gantry();
  rig.axes[0].limits.upper = 400;
  Cell cell(Fast(), {}, std::move(rig));
  cell.Start();
  cell.Do(To(500, 0, 0));
  const Ticket ticket = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_EQ(cell.rig.lives[ticket].error_id, ErrorId::kUnreachable);
  EXPECT_EQ(cell.state.state, PickPlaceState::kError);
  cell.Do(To(300, 0, 0));
  EXPECT_TRUE(cell.RunUntil([&] { return IsFree(cell.Now(), cell.rig.state); }, 2));
  cell.Do(Control{.reset_error = true});
  ASSERT_TRUE(cell.RunTo(PickPlaceState::kReady, 1));
  const Ticket again = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(again, 5));
  EXPECT_TRUE(cell.rig.lives[again].done);
}

}  // namespace
}  // namespace takt::pickplace
