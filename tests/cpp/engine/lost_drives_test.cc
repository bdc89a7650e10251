// External drives that no longer answer (AX-82, AX-87): a drive error and a controlled stop.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "drive_rig.h"
#include "takt/axis/state_table.h"

namespace takt::engine {
namespace {

// AX-82, AX-87: with missing_cycles missing answers: ErrorStop 3002; the set point brakes within the axis' limits and
// is sent to the drive, then it is off and the brake is applied. Other axes continue.
TEST(LostDrives, ALostDriveIsStoppedInAControlledWay) {
  for (std::size_t lost = 0; lost < 3; ++lost) {
    DriveRig rig;
    rig.PowerOn();
    rig.Move();
    const Ticket running = rig.Give(lost, axis::MoveVelocity{.velocity = 200});
    rig.Run(300);
    rig.Silence(lost);
    rig.Run(kMissing - 1);
    EXPECT_EQ(rig.At(lost).state, axis::PlcState::kContinuousMotion);
    EXPECT_EQ(rig.At(lost).error, ErrorId::kNone);
    rig.Step();
    EXPECT_EQ(rig.At(lost).state, axis::PlcState::kErrorStop) << "mode " << lost;
    EXPECT_EQ(rig.At(lost).error, ErrorId::kDrive);
    EXPECT_EQ(rig.last[running].state, FeedbackState::kError);
    EXPECT_EQ(rig.last[running].error, ErrorId::kDrive);

    double velocity = 200, acceleration = 0, driven = 200;
    int cycles = 0;
    while (rig.At(lost).loop_closed && ++cycles < 1000) {
      const axis::Outputs& o = rig.At(lost);
      EXPECT_TRUE(rig.plant.told[lost].enable);
      EXPECT_TRUE(rig.plant.told[lost].release_brake);
      EXPECT_LE(o.set_velocity, velocity + 1e-9);
      EXPECT_LE(std::abs(o.set_acceleration), 5000 * (1 + 1e-9));
      EXPECT_LE(std::abs(o.set_acceleration - acceleration), 100000 * 0.001 * (1 + 1e-6));
      // The drive follows smoothly, although it is not measured any more.
      EXPECT_LE(std::abs(rig.plant.states[lost].velocity - driven), 10) << "mode " << lost << ", cycle " << cycles;
      velocity = o.set_velocity;
      acceleration = o.set_acceleration;
      driven = rig.plant.states[lost].velocity;
      rig.Step();
    }
    // 200 u/s at 5000 u/s², 100000 u/s³: v/a + a/j = 90 ms.
    EXPECT_NEAR(cycles, 90, 3) << "mode " << lost;
    EXPECT_NEAR(rig.plant.states[lost].velocity, 0, 3) << "mode " << lost;
    rig.Step();
    EXPECT_FALSE(rig.plant.told[lost].enable);
    EXPECT_FALSE(rig.plant.told[lost].release_brake);
    EXPECT_EQ(rig.plant.told[lost].voltage_v, 0);
    EXPECT_EQ(rig.At(lost).state, axis::PlcState::kErrorStop);
    rig.Run(300);
    EXPECT_EQ(rig.At(3).state, axis::PlcState::kContinuousMotion);
    EXPECT_NEAR(rig.At(3).set_velocity, 100, 1e-9);
  }
}

// AX-87: when it answers again and is reset, it runs again; not before. Its reference is lost.
TEST(LostDrives, HeardAgainAndResetItRunsAgain) {
  DriveRig rig;
  rig.PowerOn();
  const Ticket homed = rig.Done(0, axis::StepDirect{});
  ASSERT_EQ(rig.last[homed].state, FeedbackState::kDone);
  rig.Done(0, axis::FinishHoming{});
  ASSERT_TRUE(rig.At(0).homed);
  rig.Move();
  rig.Silence(0);
  rig.Run(500);
  EXPECT_FALSE(rig.At(0).homed);
  Ticket reset = rig.Done(0, axis::Reset{});
  EXPECT_EQ(rig.last[reset].state, FeedbackState::kError);
  EXPECT_EQ(rig.last[reset].error, ErrorId::kAxisFault);
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kErrorStop);
  rig.HearAll();
  rig.Run(10);
  EXPECT_EQ(rig.At(0).error, ErrorId::kDrive);
  EXPECT_NEAR(rig.At(0).actual_position, rig.plant.states[0].load_position, 0.01);
  reset = rig.Done(0, axis::Reset{});
  EXPECT_EQ(rig.last[reset].state, FeedbackState::kDone);
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kDisabled);
  rig.Done(0, axis::Power{});
  const Ticket move = rig.Done(0, axis::MoveAbsolute{.position = 20});
  EXPECT_EQ(rig.last[move].state, FeedbackState::kDone);
  EXPECT_NEAR(rig.plant.states[0].load_position, 20, 0.01);
}

// AX-87: a restarted plant counts from 0 again. That is no motion.
TEST(LostDrives, ANewPlantIsTakenAsItIs) {
  DriveRig rig;
  rig.PowerOn();
  rig.Done(0, axis::MoveAbsolute{.position = 150});
  rig.Silence(0);
  rig.Run(100);
  rig.plant.states[0] = plant::MakeServoState(rig.plant.params[0]);
  rig.HearAll();
  rig.Run(10);
  const Ticket reset = rig.Done(0, axis::Reset{});
  EXPECT_EQ(rig.last[reset].state, FeedbackState::kDone);
  rig.Run(2);
  EXPECT_EQ(rig.At(0).error, ErrorId::kNone);
  rig.Done(0, axis::Power{});
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kStandstill);
  rig.Run(100);
  EXPECT_NEAR(rig.plant.states[0].load_position, 0, 0.01);
  EXPECT_NEAR(rig.At(0).following_error, 0, 0.01);
}

// AX-82, AX-87: an axis at rest needs no braking: off at once.
TEST(LostDrives, AtRestItIsSwitchedOffAtOnce) {
  DriveRig rig;
  rig.PowerOn();
  rig.Silence(1);
  rig.Run(kMissing);
  EXPECT_EQ(rig.At(1).state, axis::PlcState::kErrorStop);
  EXPECT_FALSE(rig.At(1).loop_closed);
  rig.plant.Serve(rig.engine);
  EXPECT_FALSE(rig.plant.told[1].enable);
  EXPECT_FALSE(rig.plant.told[1].release_brake);
}

// AX-10, AX-87: a Disabled axis has the fault and stays Disabled; it cannot be switched on.
TEST(LostDrives, ADisabledAxisJustHasTheFault) {
  DriveRig rig;
  rig.Run(20);
  rig.Silence(0);
  rig.Run(kMissing + 1);
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kDisabled);
  EXPECT_EQ(rig.At(0).error, ErrorId::kDrive);
  const Ticket power = rig.Done(0, axis::Power{});
  EXPECT_EQ(rig.last[power].state, FeedbackState::kError);
  EXPECT_FALSE(rig.plant.told[0].enable);
  rig.HearAll();
  rig.Run(2);
  rig.Done(0, axis::Reset{});
  EXPECT_EQ(rig.At(0).error, ErrorId::kNone);
}

// AX-55, AX-87: coupled axes stop, too; the others continue.
TEST(LostDrives, WhatIsCoupledStopsToo) {
  for (const bool follower_is_lost : {true, false}) {
    DriveRig rig;
    rig.PowerOn();
    axis::GearIn gear;
    gear.master = Name::Of("csp");
    rig.Give(2, gear);
    rig.Run(10);
    rig.Give(0, axis::MoveVelocity{.velocity = 100});
    rig.Give(3, axis::MoveVelocity{.velocity = 100});
    rig.Run(400);
    ASSERT_TRUE(rig.At(2).in_step);
    const double ahead = rig.At(2).set_position - rig.At(0).set_position;
    rig.Silence(follower_is_lost ? 2 : 0);
    for (int c = 0; c < 600; ++c) {
      rig.Step();
      if (!follower_is_lost) {
        EXPECT_NEAR(rig.At(2).set_position - rig.At(0).set_position, ahead, 1e-6) << c;
      }
    }
    EXPECT_EQ(rig.At(0).set_velocity, 0);
    EXPECT_EQ(rig.At(2).set_velocity, 0);
    EXPECT_EQ(rig.At(0).error, follower_is_lost ? ErrorId::kAxisFault : ErrorId::kDrive);
    EXPECT_EQ(rig.At(2).state == axis::PlcState::kErrorStop, follower_is_lost);
    EXPECT_NEAR(rig.At(3).set_velocity, 100, 1e-9);
  }
}

// AX-87, CV-01: an encoder without a drive that others follow, e.g. of a belt: if it is lost, they come to rest.
TEST(LostDrives, WhatFollowsALostEncoderComesToRest) {
  DriveRig rig;
  double counts = 0;
  rig.plant.change = [&](DriveSample& s) {
    if (s.axis == 3) s.inputs.counts = static_cast<std::uint32_t>(counts += 100);  // 100 u/s
  };
  rig.PowerOn();
  rig.Done(3, axis::Power{.enable = false});
  axis::GearIn gear;
  gear.master = Name::Of("other");
  gear.source = axis::MasterSource::kActualValue;
  rig.Give(0, gear);
  rig.Run(300);
  ASSERT_EQ(rig.At(3).state, axis::PlcState::kDisabled);
  ASSERT_TRUE(rig.At(0).in_step);
  ASSERT_NEAR(rig.At(0).set_velocity, 100, 1e-6);
  rig.Silence(3);
  axis::Outputs before = rig.At(0);
  for (int c = 0; c < 300; ++c) {
    rig.Step();
    const axis::Outputs& o = rig.At(0);
    ASSERT_LE(std::abs(o.set_acceleration), 5000 * (1 + 1e-6)) << c;
    ASSERT_LE(std::abs(o.set_acceleration - before.set_acceleration), 100 * (1 + 1e-6)) << c;
    before = o;
  }
  EXPECT_EQ(rig.At(3).error, ErrorId::kDrive);
  EXPECT_EQ(rig.At(0).error, ErrorId::kNone);
  EXPECT_NEAR(rig.At(0).set_velocity, 0, 1e-9);
  // When it answers again, it has no followers: that needs a reset and a new command.
  const double at_rest = rig.At(0).set_position;
  rig.HearAll();
  rig.Run(500);
  EXPECT_EQ(rig.At(0).set_position, at_rest);
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kStandstill);
}

// AX-87: if it answers again while it brakes, it is stopped and switched off all the same; a fault that it reports ends
// that at once, as does the emergency stop.
TEST(LostDrives, WhatComesDuringTheStop) {
  for (const bool fault : {false, true}) {
    DriveRig rig;
    rig.PowerOn();
    rig.Move();
    rig.Silence(2);
    rig.Run(kMissing + 10);
    rig.HearAll();
    if (fault) rig.plant.states[2].faults.drive_fault = true;
    rig.Run(3);
    EXPECT_EQ(rig.At(2).loop_closed, !fault);
    rig.Run(200);
    EXPECT_EQ(rig.At(2).state, axis::PlcState::kErrorStop);
    EXPECT_FALSE(rig.At(2).loop_closed);
    EXPECT_FALSE(rig.plant.told[2].enable);
  }
  DriveRig rig;
  rig.PowerOn();
  rig.Move();
  rig.Silence(0);
  rig.Run(kMissing + 10);
  EXPECT_TRUE(rig.At(0).loop_closed);
  rig.engine.Submit({0, kMachineTarget, 0, MachineCommand(EmergencyStop{})});
  rig.Run(2);
  EXPECT_FALSE(rig.plant.told[0].enable);
}

// AX-87: a reset during the stop waits for its end.
TEST(LostDrives, AResetDuringTheStopWaits) {
  DriveRig rig;
  rig.PowerOn();
  rig.Move();
  rig.Silence(0);
  rig.Run(kMissing + 5);
  rig.HearAll();
  const Ticket reset = rig.Done(0, axis::Reset{});
  EXPECT_EQ(rig.last[reset].state, FeedbackState::kDone);
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kDisabled);
  EXPECT_FALSE(rig.At(0).loop_closed);
}

// AX-49, AX-87: an edge of the touch probe while the drive was lost is not captured.
TEST(LostDrives, EdgesWhileItWasLostAreNotCaptured) {
  DriveRig rig;
  rig.PowerOn();
  rig.Give(0, axis::TouchProbe{});
  rig.Run(5);
  rig.Silence(0);
  rig.Run(20);
  rig.plant.states[0].probe_rises = 7;
  rig.HearAll();
  rig.Run(20);
  EXPECT_EQ(rig.At(0).probe_captures, 0u);
  rig.plant.states[0].probe_rises = 8;
  rig.Run(2);
  EXPECT_EQ(rig.At(0).probe_captures, 1u);
}

// AX-10, AX-13, AX-87: answers get lost at random, for any number of cycles, during all kinds of motion: every set
// point of a closed loop follows from the previous one within the axis' limits, and no axis of a lost drive stays on.
TEST(LostDrives, AnyPatternOfLossesKeepsTheLimits) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    DriveRig rig;
    std::mt19937 random(seed);
    std::vector<int> silent(4, 0);
    rig.plant.answers = [&](const DriveSample& s) { return silent[s.axis] == 0; };
    rig.PowerOn();
    std::vector<axis::Outputs> before;
    for (std::size_t i = 0; i < 4; ++i) before.push_back(rig.At(i));
    std::vector<int> gone(4, 0);
    for (int c = 0; c < 4000; ++c) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (silent[i] > 0) --silent[i];
        if (silent[i] == 0 && random() % 200 == 0) silent[i] = static_cast<int>(random() % (random() % 4 ? 6 : 400));
        gone[i] = silent[i] > 0 ? gone[i] + 1 : 0;
        switch (random() % 300) {
          case 0:
            rig.Give(i, axis::MoveAbsolute{.position = static_cast<double>(random() % 400)});
            break;
          case 1:
            rig.Give(i, axis::MoveVelocity{.velocity = static_cast<double>(random() % 500)});
            break;
          case 2:
            rig.Give(i, axis::Halt{});
            break;
          case 3:
          case 4:
            rig.Give(i, axis::Reset{});
            rig.Give(i, axis::Power{});
            break;
          default:
            break;
        }
      }
      rig.Step();
      for (std::size_t i = 0; i < 4; ++i) {
        const axis::Outputs &b = before[i], &o = rig.At(i);
        ASSERT_TRUE(axis::IsLegal(b.state, o.state) || b.state == axis::PlcState::kErrorStop) << i;
        // v/a + a/j = 150 ms from full speed, 50 ms to end a preceding acceleration, and the cycles until it is
        // detected.
        if (gone[i] > 210) {
          ASSERT_FALSE(o.loop_closed) << "seed " << seed << ", axis " << i << ", cycle " << c;
        }
        if (b.loop_closed && o.loop_closed) {
          ASSERT_LE(std::abs(o.set_acceleration), 5000 * (1 + 1e-6)) << "seed " << seed << ", axis " << i;
          ASSERT_LE(std::abs(o.set_velocity), 500 * (1 + 1e-6)) << "seed " << seed << ", axis " << i;
          ASSERT_LE(std::abs(o.set_acceleration - b.set_acceleration), 100 * (1 + 1e-6)) << "seed " << seed;
          ASSERT_LE(std::abs(o.set_position - b.set_position), 0.5 * (1 + 1e-6)) << "seed " << seed;
        }
        before[i] = o;
      }
    }
  }
}

}  // namespace
}  // namespace takt::engine
