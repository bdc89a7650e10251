// Changes from one cam to another, and sequences (CAM-05, CAM-22, CAM-23, CAM-70).
#include <gtest/gtest.h>

#include "bench.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

// CAM-22: the selected cam takes over at the end of the running one, also with an X offset, without the clutch.
TEST(Change, TakesPlaceAtTheEndOfTheCam) {
  for (const double offset : {0.0, 77.0}) {
    for (const double velocity : {500.0, -500.0}) {
      Bench b(MachineOf({UpAndDown("hill", 50), UpAndDown("dip", -30)}, Quick()));
      b.Tell(Control{.offset_master = offset});
      b.Web(velocity);
      b.Run(300);
      ASSERT_TRUE(b.Sync());
      Watch watch(b);
      b.Tell(Control{.cam_table = std::uint32_t{2}});
      b.Run(2);
      EXPECT_EQ(b.Module().cam_table, 1u);
      EXPECT_EQ(b.Module().next_cam_table, 2u);
      double last = b.Module().set_x_position;
      ASSERT_TRUE(b.Until(
          [&] {
            if (b.Module().cam_table == 1) last = b.Module().set_x_position;
            EXPECT_TRUE(b.Module().cam_synchronised);
            return b.Module().cam_table == 2;
          },
          2000));
      EXPECT_NEAR(last, velocity > 0 ? 360 : 0, 0.51);
      EXPECT_EQ(b.Module().next_cam_table, 0u);
      for (int i = 0; i < 500; ++i) {
        b.Step();
        ASSERT_NEAR(b.Knife().set_position, -Hill(b.Module().set_x_position, 30), 1e-8);
        ASSERT_LT(Apart(b.Module().set_x_position, b.TheWeb().set_position + offset), 1e-6);
      }
      watch.ExpectSmooth();
    }
  }
}

// CAM-22, CAM-05: another cam in the running slot takes over at the end, too; the running one does not change.
TEST(Change, OfTheCamInTheSlot) {
  Machine m = MachineOf({UpAndDown("hill", 50), UpAndDown("dip", -30)}, Quick());
  m.flex_cams[0].cams = {"hill"};
  Bench b(m);
  b.Web(500);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  b.Tell(SetCam{1, Name::Of("dip")});
  const std::uint32_t ends = b.Module().cam_ends;
  while (b.Module().cam_ends == ends) {
    ASSERT_NEAR(b.Knife().set_position, Hill(b.Module().set_x_position), 1e-8);
    b.Step();
  }
  for (int i = 0; i < 500; ++i) {
    b.Step();
    ASSERT_NEAR(b.Knife().set_position, -Hill(b.Module().set_x_position, 30), 1e-8);
  }
}

// CAM-22: at once; the step is caught up within the limits.
TEST(Change, AtOnce) {
  Bench b(MachineOf({UpAndDown("hill", 50), UpAndDown("high", 80)}, Quick()));
  b.Web(360);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  ASSERT_TRUE(b.Until([&] { return std::abs(b.Module().set_x_position - 90) < 1; }));
  Watch watch(b);
  b.Tell(Control{.cam_change_instant = true, .cam_table = std::uint32_t{2}});
  b.Run(2);
  EXPECT_EQ(b.Module().cam_table, 2u);
  EXPECT_EQ(b.Module().state, ModuleState::kSync);
  EXPECT_NEAR(b.Module().set_y_position, Hill(b.Module().set_x_position, 80), 1e-9);
  b.Run(300);
  EXPECT_TRUE(b.Module().cam_synchronised);
  EXPECT_NEAR(b.Knife().set_position, Hill(b.Module().set_x_position, 80), 1e-8);
  watch.ExpectSmooth();
}

// The order in which the slots are run, and the output sequencer_active.
struct Ran {
  std::vector<std::uint32_t> slots;
  std::vector<bool> active;
};

Ran RunSequence(SequenceMode mode, int cycles_on, int cycles_off) {
  Settings s = Quick();
  s.cam_sequence_mode = mode;
  Bench b(MachineOf({UpAndDown("a", 10), UpAndDown("b", 20), UpAndDown("c", 30), UpAndDown("d", 40)}, s));
  b.Tell(Control{.cam_sequencer = true, .cam_table = std::uint32_t{2}});
  b.Step();
  EXPECT_TRUE(b.Sync());
  b.Web(1200);
  Ran ran;
  std::uint32_t ends = b.Module().cam_ends;
  for (int i = 0; i < cycles_on + cycles_off; ++i) {
    if (i == cycles_on) b.Tell(Control{.cam_sequencer = false});
    b.Step();
    ran.slots.push_back(b.Module().cam_table);
    ran.active.push_back(b.Module().sequencer_active);
    for (int k = 0; k < 600 && b.Module().cam_ends == ends; ++k) b.Step();
    ends = b.Module().cam_ends;
  }
  return ran;
}

using Slots = std::vector<std::uint32_t>;
using Flags = std::vector<bool>;

// CAM-23: the table of the manual's 3.24, in both positions of the input.
TEST(Sequencer, Mode0RunsCam1) {
  const Ran ran = RunSequence(SequenceMode::kCam1, 4, 3);
  EXPECT_EQ(ran.slots, (Slots{1, 1, 1, 1, 1, 2, 2}));  // then the selected slot
  EXPECT_EQ(ran.active, (Flags{1, 1, 1, 1, 1, 0, 0}));
}
TEST(Sequencer, Mode1RunsCam3) {
  const Ran ran = RunSequence(SequenceMode::kCam3, 3, 3);
  EXPECT_EQ(ran.slots, (Slots{3, 3, 3, 3, 2, 2}));
  EXPECT_EQ(ran.active, (Flags{1, 1, 1, 1, 0, 0}));
}
TEST(Sequencer, Mode2RunsCam1OnceThenCam3AndCam1OnceAtTheEnd) {
  const Ran ran = RunSequence(SequenceMode::kCam1Cam3, 4, 4);
  EXPECT_EQ(Slots(ran.slots.begin(), ran.slots.begin() + 6), (Slots{1, 3, 3, 3, 3, 1}));
  EXPECT_EQ(Flags(ran.active.begin(), ran.active.begin() + 6), (Flags{1, 1, 1, 1, 1, 1}));
  EXPECT_FALSE(ran.active.back());
}
TEST(Sequencer, Mode3RunsCams1And2OnceThenCam3AndCams4And1AtTheEnd) {
  const Ran ran = RunSequence(SequenceMode::kCam1Cam2Cam3, 5, 5);
  EXPECT_EQ(Slots(ran.slots.begin(), ran.slots.begin() + 8), (Slots{1, 2, 3, 3, 3, 3, 4, 1}));
  EXPECT_EQ(Flags(ran.active.begin(), ran.active.begin() + 8), (Flags{1, 1, 1, 1, 1, 1, 1, 0}));
}

// CAM-70
TEST(ChangeCam, AtAPositionOfTheMasterOrOfX) {
  for (const ChangeWhen when : {ChangeWhen::kMasterPosition, ChangeWhen::kCamPosition}) {
    Bench b(MachineOf({UpAndDown("hill", 50), UpAndDown("dip", -30)}, Quick()));
    b.Tell(Control{.offset_master = 40.0});
    b.Web(360);
    b.Run(300);
    ASSERT_TRUE(b.Sync());
    Watch watch(b);
    const Ticket change = b.Tell(ChangeCam{2, when, 123, ChangeAlign::kPosition});
    b.Run(2);
    EXPECT_EQ(b.Of(change), FeedbackState::kActive);
    EXPECT_EQ(b.Module().pending_changes, 1u);
    EXPECT_EQ(b.Module().next_cam_table, 2u);
    ASSERT_TRUE(b.Until([&] { return b.Module().cam_table == 2; }, 3000));
    const double place = when == ChangeWhen::kMasterPosition ? b.TheWeb().set_position : b.Module().set_x_position;
    EXPECT_NEAR(place, 123, 0.37);
    EXPECT_EQ(b.Of(change), FeedbackState::kDone);
    EXPECT_EQ(b.Module().pending_changes, 0u);
    watch.ExpectSmooth();
  }
}

// CAM-70: also with X shifted to a position of the same slope, the slave is in step throughout.
TEST(ChangeCam, WithPositionAndVelocityMet) {
  Bench b(MachineOf({UpAndDown("hill", 50), UpAndDown("high", 80)}, Quick()));
  b.Web(360);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  ASSERT_TRUE(b.Until([&] { return std::abs(b.Module().set_x_position - 60) < 1; }));
  const double slope = b.Module().set_y_velocity;
  Watch watch(b);
  const Ticket change = b.Tell(ChangeCam{2, ChangeWhen::kAtOnce, 0, ChangeAlign::kVelocity});
  b.Run(1);
  EXPECT_EQ(b.Of(change), FeedbackState::kDone);
  EXPECT_NEAR(b.Module().set_y_velocity, slope, 3);
  for (int i = 0; i < 500; ++i) {
    b.Step();
    ASSERT_LT(std::abs(b.Knife().set_position - b.Module().mp06_y_to_slave_position), 0.02);
  }
  EXPECT_TRUE(b.Module().cam_synchronised);
  watch.ExpectSmooth();
}

// CAM-70: as soon as both cams meet.
TEST(ChangeCam, WithoutAJump) {
  Settings s = Quick();
  cam::CamParams other = UpAndDown("other", 50);
  other.points = {engine::Rest(0, 0), engine::Rest(90, 0), engine::Rest(180, 50), engine::Rest(360, 0)};
  Bench b(MachineOf({UpAndDown("hill", 50), other}, s));
  b.Web(360);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  ASSERT_TRUE(b.Until([&] { return std::abs(b.Module().set_x_position - 30) < 1; }));
  Watch watch(b);
  b.Tell(ChangeCam{2, ChangeWhen::kWithoutJump, 0, ChangeAlign::kNothing});
  double place = 0;
  ASSERT_TRUE(b.Until(
      [&] {
        place = b.Module().set_x_position;
        EXPECT_LT(std::abs(b.Knife().set_position - b.Module().mp06_y_to_slave_position), 1e-3);
        return b.Module().cam_table == 2;
      },
      3000));
  EXPECT_NEAR(place, 180, 1);  // the first position where they meet
  watch.ExpectSmooth();
}

// CAM-70
TEST(ChangeCam, CanBeWithdrawn) {
  Bench b(MachineOf({UpAndDown("hill", 50), UpAndDown("dip", -30)}, Quick()));
  b.Web(360);
  b.Run(300);
  const Ticket early = b.Tell(ChangeCam{2});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(early), ErrorId::kState);  // no cam runs
  ASSERT_TRUE(b.Sync());
  std::vector<Ticket> changes;
  for (int i = 0; i < 9; ++i) changes.push_back(b.Tell(ChangeCam{2, ChangeWhen::kMasterPosition, 1.0 + i}));
  const Ticket empty = b.Tell(ChangeCam{3});
  b.Run(3);
  EXPECT_EQ(b.Module().pending_changes, 8u);
  EXPECT_EQ(b.ErrorOf(changes.back()), ErrorId::kBufferFull);
  EXPECT_EQ(b.ErrorOf(empty), ErrorId::kUnknownTarget);
  b.Tell(WithdrawChanges{});
  b.Run(2);
  EXPECT_EQ(b.Module().pending_changes, 0u);
  EXPECT_EQ(b.Of(changes.front()), FeedbackState::kAborted);
  b.Run(3000);
  EXPECT_EQ(b.Module().cam_table, 1u);
}

// CAM-70: at the end of the cam, too, the shift makes both meet.
TEST(ChangeCam, AtTheEndWithWhatIsShifted) {
  cam::CamParams high = UpAndDown("high", 50);
  for (cam::CamPoint& point : high.points) point.y += 30;
  for (const ChangeAlign align : {ChangeAlign::kPosition, ChangeAlign::kVelocity}) {
    Bench b(MachineOf({UpAndDown("hill", 50), high}, Quick()));
    b.Web(360);
    b.Run(300);
    ASSERT_TRUE(b.Sync());
    Watch watch(b);
    const Ticket change = b.Tell(ChangeCam{2, ChangeWhen::kNextCycle, 0, align});
    ASSERT_TRUE(b.Until(
        [&] {
          EXPECT_TRUE(b.Module().cam_synchronised);
          return b.Module().cam_table == 2;
        },
        3000));
    EXPECT_EQ(b.Of(change), FeedbackState::kDone);
    EXPECT_NEAR(b.Knife().set_position, 0, 0.01);
    watch.ExpectSmooth();
  }
}

// CAM-70: and at an end that is held.
TEST(ChangeCam, AtAHeldEndWithWhatIsShifted) {
  cam::CamParams high = UpAndDown("high", 50);
  for (cam::CamPoint& point : high.points) point.y += 30;
  Settings settings = Quick();
  settings.cam_cyclic = false;
  settings.slave_absolute = true;
  for (const ChangeAlign align : {ChangeAlign::kPosition, ChangeAlign::kVelocity}) {
    Bench b(MachineOf({UpAndDown("hill", 50), high}, settings));
    b.Web(360);
    b.Run(300);
    ASSERT_TRUE(b.Sync());
    ASSERT_TRUE(b.Until([&] { return b.Module().cam_ends == 1; }, 3000));
    b.Run(100);
    Watch watch(b);
    const Ticket change = b.Tell(ChangeCam{2, ChangeWhen::kNextCycle, 0, align});
    ASSERT_TRUE(b.Until([&] { return b.Module().cam_table == 2; }, 3000));
    EXPECT_EQ(b.Of(change), FeedbackState::kDone);
    b.Run(40);  // a step of 30 mm would be caught up by now
    EXPECT_NEAR(b.Knife().set_position, 0, 5);
    watch.ExpectSmooth();
  }
}

// CAM-23: switched off during its first cam, and on again after the exit.
TEST(Sequencer, ItsFirstCamIsNotRunTwice) {
  Settings s = Quick();
  s.cam_sequence_mode = SequenceMode::kCam1Cam3;
  Bench b(MachineOf({UpAndDown("a", 10), UpAndDown("b", 20), UpAndDown("c", 30)}, s));
  b.Tell(Control{.cam_sequencer = true});
  b.Step();
  ASSERT_TRUE(b.Sync());
  b.Web(1200);
  b.Run(150);
  b.Tell(Control{.cam_sequencer = false});
  b.Run(1000);
  EXPECT_EQ(b.Module().cam_table, 1u);
  EXPECT_EQ(b.Module().cam_ends, 1u);  // held
  EXPECT_FALSE(b.Module().sequencer_active);
  b.Tell(Control{.cam_sequencer = true});
  b.Run(200);
  EXPECT_EQ(b.Module().cam_table, 1u);  // once more, then cam 3
  b.Run(300);
  EXPECT_EQ(b.Module().cam_table, 3u);
  const Ticket change = b.Tell(ChangeCam{2});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(change), ErrorId::kState);  // the sequence selects the next cam
}

}  // namespace
}  // namespace takt::flexcam
