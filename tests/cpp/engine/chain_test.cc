// Chains and trees of coupled axes, and random ones: AX-13, AX-55.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cam_rig.h"

namespace takt::engine {
namespace {

using axis::PlcState;

// AX-55: a chain against the order of the axes has no lag, though it was made at run time, beginning at its end.
TEST(Chain, HasNoLag) {
  Line line(LineOf(5));
  for (std::size_t i = 0; i < 4; ++i) line.Give(i, Gear(("a" + std::to_string(i + 1)).c_str(), -1));
  line.Run(10);
  line.Give(4, axis::MoveAbsolute{.position = 100});
  for (int i = 0; i < 600; ++i) {
    line.Step();
    for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(line.At(k).set_position, -line.At(k + 1).set_position) << i;
  }
  EXPECT_EQ(line.At(0).set_position, 100);
}

// AX-55: no axis follows itself, neither directly nor through other axes, nor through buffered commands.
TEST(Chain, MakesNoLoop) {
  Line line(LineOf(3));
  line.Give(1, Gear("a0"));
  axis::GearIn buffered = Gear("a1");
  buffered.buffer_mode = axis::BufferMode::kBuffered;
  line.Give(2, axis::MoveVelocity{.velocity = 0.1, .acceleration = 1, .jerk = 1});
  line.Give(2, buffered);
  const Ticket loop = line.Give(0, Gear("a2"));
  const Ticket itself = line.Give(0, Gear("a0"));
  const Ticket nobody = line.Give(0, Gear("b"));
  line.Run(3);
  EXPECT_EQ(line.last[loop].error, ErrorId::kCouplingLoop);
  EXPECT_EQ(line.last[itself].error, ErrorId::kParameter);
  EXPECT_EQ(line.last[nobody].error, ErrorId::kUnknownTarget);
  EXPECT_EQ(line.At(0).state, PlcState::kStandstill);
  line.Give(1, axis::Halt{});  // now there is no loop
  line.Run(50);
  const Ticket good = line.Give(0, Gear("a2"));
  line.Run(3);
  EXPECT_EQ(line.last[good].state, FeedbackState::kActive);
}

// AX-55: coupled axes stop together, whichever of them fails.
TEST(Chain, StopsTogether) {
  for (std::size_t failing = 0; failing < 3; ++failing) {
    SCOPED_TRACE(failing);
    Line line(LineOf(3));
    line.Give(1, Gear("a0"));
    line.Give(2, Gear("a1"));
    line.Give(0, axis::MoveVelocity{.velocity = 100});
    line.Run(500);
    double begin[3];
    for (std::size_t i = 0; i < 3; ++i) begin[i] = line.At(i).set_position;
    line.engine.faults(failing).drive_fault = true;
    line.Run(500);
    // Limited by jerk alone: 5000 u/s2 are not reached, and it takes 2 sqrt(v / j) with v / 2 on average.
    const double stop = 100 * std::sqrt(100 / 100000.0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(line.At(i).set_velocity, 0) << i;
      if (i != failing) {
        EXPECT_NEAR(line.At(i).set_position - begin[i], stop, 0.35) << i;  // within three cycles of each other
      }
    }
    EXPECT_EQ(line.At(failing).state, PlcState::kErrorStop);
  }
}

// AX-13, AX-35, AX-55: random couplings, cams, moves, superimposed motions, stops and faults: no step, no limit
// exceeded.
TEST(Coupling, KeepsTheLimitsInARandomWalk) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const auto any = [&](unsigned n) { return std::uniform_int_distribution(0u, n - 1)(random); };
    Machine machine = WithCams(LineOf(5, seed % 2 == 0 ? axis::AxisKind::kLinear : axis::AxisKind::kRotary));
    machine.cams.push_back({.name = "rough"});
    for (int i = 0; i < 6; ++i) machine.cams.back().points.push_back({50.0 * i, between(-100, 100), {}, {}});
    for (axis::AxisParams& a : machine.axes) {
      a.limits.velocity = between(100, 800);
      a.limits.acceleration = between(1000, 10000);
      a.limits.jerk = between(2e4, 4e5);
      if (seed % 4 == 0) {
        a.limits.lower = -300;
        a.limits.upper = 400;
      }
    }
    Line line(machine);
    std::vector<axis::Outputs> before;
    for (std::size_t i = 0; i < 5; ++i) before.push_back(line.At(i));
    for (int cycle = 0; cycle < 8000; ++cycle) {
      if (any(20) == 0) {
        const std::size_t who = any(5);
        const std::string master = "a" + std::to_string(any(5));
        axis::GearInPos in_pos;
        in_pos.master = Name::Of(master);
        in_pos.ratio_numerator = between(-2, 2);
        in_pos.master_sync_position = between(0, 300);
        in_pos.slave_sync_position = between(0, 300);
        if (any(2) == 0) in_pos.master_start_distance = between(0, 100);
        axis::CombineAxes combine;
        combine.master1 = Name::Of(master);
        combine.master2 = Name::Of("a" + std::to_string(any(5)));
        axis::PhasingRelative phase;
        phase.phase_shift = between(-20, 20);
        axis::CamIn cam = Cam(master.c_str(), machine.cams[any(4)].name.c_str());
        cam.master_scaling = between(-2, 2);
        cam.slave_scaling = between(-2, 2);
        cam.slave_offset = between(-50, 50);
        cam.master_absolute = any(2) == 0;
        cam.slave_absolute = any(2) == 0;
        if (any(2) == 0) cam.periodic = any(2) == 0;
        if (any(3) == 0) cam.master_start_distance = between(0, 100);
        if (any(3) == 0) cam.master_sync_position = between(0, 300);
        if (any(2) == 0) cam.buffer_mode = axis::BufferMode::kBuffered;
        switch (any(18)) {
          case 15:
          case 16:
            line.Give(who,
                      axis::MoveSuperimposed{.distance = between(-30, 30), .velocity_difference = between(1, 100)});
            break;
          case 17:
            line.Give(who, axis::HaltSuperimposed{});
            break;
          case 11:
          case 12:
          case 13:
            line.Give(who, cam);
            break;
          case 14:
            line.Give(who, axis::CamOut{});
            break;
          case 0:
          case 1:
            line.Give(who, Gear(master.c_str(), between(-3, 3)));
            break;
          case 2:
            line.Give(who, in_pos);
            break;
          case 3:
            line.Give(who, combine);
            break;
          case 4:
            line.Give(who, phase);
            break;
          case 5:
            line.Give(who, axis::GearOut{});
            break;
          case 6:
            line.Give(who, axis::MoveAbsolute{.position = between(0, 300)});
            break;
          case 7:
            line.Give(who, axis::MoveVelocity{.velocity = between(0, 100)});
            break;
          case 8:
            line.Give(who, axis::Stop{});
            break;
          case 9:
            if (any(10) == 0) line.engine.Submit({0, 0, 0, MachineCommand{FailAllAxes{}}});
            break;
          default:
            line.Give(who, axis::Reset{});
            line.Give(who, axis::Power{});
        }
      }
      line.Step();
      for (std::size_t i = 0; i < 5; ++i) {
        const axis::AxisLimits& own = machine.axes[i].limits;
        const axis::Outputs& out = line.At(i);
        ASSERT_LE(std::abs(out.set_velocity), own.velocity * (1 + 1e-8)) << cycle << " " << i;
        ASSERT_LE(std::abs(out.set_acceleration), own.acceleration * (1 + 1e-8)) << cycle << " " << i;
        if (own.upper) {
          ASSERT_LE(out.set_position, *own.upper + 1e-6) << cycle << " " << i;
        }
        if (own.lower) {
          ASSERT_GE(out.set_position, *own.lower - 1e-6) << cycle << " " << i;
        }
        const double step = out.set_acceleration - before[i].set_acceleration;
        ASSERT_LE(std::abs(step), own.jerk * 0.001 * (1 + 1e-5) + 1e-6) << cycle << " " << i;
        double way = out.set_position - before[i].set_position;
        if (machine.axes[i].rotary()) way -= 360 * std::round(way / 360);
        ASSERT_LE(std::abs(way - 0.0005 * (out.set_velocity + before[i].set_velocity)), own.jerk * 1e-9 + 1e-6)
            << cycle << " " << i;
        before[i] = out;
      }
    }
  }
}

}  // namespace
}  // namespace takt::engine
