// External drives, from the engine's side (AX-87, EN-26): answers in time, late or invalid.
#include "takt/engine/drives.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <utility>

#include "drive_rig.h"
#include "takt/core/describe.h"
#include "takt/core/hash.h"

namespace takt::engine {
namespace {

bool Same(const axis::Outputs& a, const axis::Outputs& b) {
  return HashOf(a) == HashOf(b);
}

// AX-87, EN-26: in lock step an external drive makes no difference: identical values, bit for bit.
TEST(ExternalDrives, InLockStepAreTheBuiltInOnes) {
  const Machine machine = FullMachine();
  const auto commands = Scenario(machine);
  Engine built_in(machine);
  DriveRig rig(WithExternalDrives(machine, 1));
  std::uint64_t moving = 0;
  for (std::uint64_t c = 0; c < 3000; ++c) {
    for (const auto& [when, command] : commands) {
      if (when != c) continue;
      built_in.Submit(command);
      rig.engine.Submit(command);
    }
    built_in.RunCycle();
    rig.Step();
    for (std::size_t i = 0; i < machine.axes.size(); ++i) {
      axis::Outputs other = rig.At(i);
      other.true_position = built_in.outputs(i).true_position;  // only the plant knows it
      ASSERT_TRUE(Same(built_in.outputs(i), other)) << machine.axes[i].name << " in cycle " << c;
      moving += rig.At(i).actual_velocity != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(moving, 3000u);
}

// AX-87: repeatedly one missing answer less than missing_cycles: no error, and the actual position is extrapolated.
TEST(ExternalDrives, FewAnswersMissingAreNothing) {
  DriveRig rig;
  rig.PowerOn();
  rig.Move();
  rig.plant.answers = [](const DriveSample& s) { return s.cycle % kMissing == 0; };
  for (int c = 0; c < 500; ++c) {
    rig.Step();
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_EQ(rig.At(i).error, ErrorId::kNone) << i;
      ASSERT_EQ(rig.At(i).state, axis::PlcState::kContinuousMotion) << i;
      ASSERT_NEAR(rig.At(i).set_velocity, 100, 1e-9) << i;
      ASSERT_NEAR(rig.At(i).actual_velocity, 100, 5) << i;
      // 4 cycles at 100 u/s are 0.4 u: the axis is not at its last received position.
      ASSERT_NEAR(rig.At(i).actual_position, rig.plant.states[i].load_position, 0.15) << i << " in cycle " << c;
    }
  }
}

// AX-87: answers that are always late: their cycle number tells the axis their age.
TEST(ExternalDrives, LateAnswersAreCarriedOn) {
  DriveRig rig;
  std::vector<DriveSample> held;
  rig.plant.answers = [&](const DriveSample& s) {
    held.push_back(s);
    return false;
  };
  const auto step = [&] {
    const std::vector<DriveSample> late = std::exchange(held, {});
    rig.Step();
    for (const DriveSample& s : late) rig.engine.drive_samples().TryPush(s);
  };
  for (std::size_t i = 0; i < 4; ++i) rig.Give(i, axis::Power{});
  for (int c = 0; c < 200; ++c) step();
  for (std::size_t i = 0; i < 4; ++i) rig.Give(i, axis::MoveVelocity{.velocity = 100});
  for (int c = 0; c < 500; ++c) step();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rig.At(i).state, axis::PlcState::kContinuousMotion) << i;
    EXPECT_NEAR(rig.At(i).actual_velocity, 100, 1) << i;
    // Each unknown cycle of delay would be 0.1 u. The lag of the drives themselves is less.
    EXPECT_NEAR(rig.At(i).following_error, 0, 0.06) << i;
  }
}

// AX-87: engine and plants may be started in any order: a drive that has not answered yet is no fault, but cannot be
// switched on.
TEST(ExternalDrives, NotHeardYetIsNoFault) {
  DriveRig rig;
  rig.Silence(0);
  rig.Run(500);
  EXPECT_EQ(rig.At(0).error, ErrorId::kNone);
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kDisabled);
  const Ticket power = rig.Done(0, axis::Power{});
  EXPECT_EQ(rig.last[power].error, ErrorId::kDrive);
  EXPECT_EQ(rig.At(0).state, axis::PlcState::kErrorStop);
  rig.Done(0, axis::Reset{});

  rig.plant.states[0].counter_origin = 4'000'000;  // far away from its zero
  rig.HearAll();
  rig.Run(5);
  EXPECT_EQ(rig.At(0).error, ErrorId::kNone);
  EXPECT_NEAR(rig.At(0).actual_position, 4000, 1e-6);
  const Ticket again = rig.Done(0, axis::Power{});
  EXPECT_EQ(rig.last[again].state, FeedbackState::kDone);
}

// AX-87: samples that are old, repeated, answer a future set point, or belong to no axis change nothing.
TEST(ExternalDrives, WrongSamplesHaveNoEffect) {
  DriveRig rig, plain;
  for (DriveRig* r : {&rig, &plain}) {
    r->PowerOn();
    r->Move();
  }
  std::mt19937 random(1);
  for (int c = 0; c < 500; ++c) {
    const auto now = static_cast<std::int64_t>(rig.engine.cycle().count);
    for (const std::int64_t cycle :
         {now, now + 1, now - 2, now - 3, std::int64_t{-1}, std::int64_t{-2}, std::numeric_limits<std::int64_t>::min(),
          std::numeric_limits<std::int64_t>::max()}) {
      DriveSample wrong{cycle, static_cast<std::uint32_t>(random() % 6), {}};
      wrong.inputs.counts = static_cast<std::uint32_t>(random());
      wrong.inputs.drive_fault = true;
      rig.plant.Serve(rig.engine);
      rig.engine.drive_samples().TryPush(wrong);
    }
    rig.Step();
    plain.Step();
    ASSERT_EQ(rig.engine.StateHash(), plain.engine.StateHash()) << c;
  }
  EXPECT_GE(rig.engine.figures().samples_refused, 4000u);
  EXPECT_EQ(plain.engine.figures().samples_refused, 0u);
}

// EN-07, AX-87: received samples are in the journal: the run is reproduced without any plant, losses included.
TEST(ExternalDrives, AJournalNeedsNoPlant) {
  DriveRig rig(WithExternalDrives(AxisPerMode(), kMissing), true);
  std::mt19937 random(2);
  rig.plant.answers = [&](const DriveSample& s) {
    return s.cycle < 300 || (random() % 3 != 0 && !(s.axis == 1 && s.cycle > 700 && s.cycle < 900));
  };
  rig.PowerOn();
  rig.Move();
  rig.Run(600);
  EXPECT_EQ(rig.At(1).error, ErrorId::kDrive);

  Engine again(rig.machine, {.journal = true});
  std::vector<DriveEntry> heard;
  std::vector<JournalEntry> commands;
  std::vector<HashEntry> hashes;
  for (DriveEntry e; rig.engine.drive_journal().TryPop(e);) heard.push_back(e);
  for (JournalEntry e; rig.engine.journal().TryPop(e);) commands.push_back(e);
  for (HashEntry e; rig.engine.hashes().TryPop(e);) hashes.push_back(e);
  for (const HashEntry& expected : hashes) {
    for (const JournalEntry& e : commands) {
      if (e.cycle == expected.cycle) again.Resubmit(e.command);
    }
    for (const DriveEntry& e : heard) {
      if (e.cycle == expected.cycle) again.drive_samples().TryPush(e.sample);
    }
    again.RunCycle();
    HashEntry made;
    ASSERT_TRUE(again.hashes().TryPop(made));
    ASSERT_EQ(made.hash, expected.hash) << "cycle " << expected.cycle;
  }
}

// EN-10: the machine file names existing axes, each once.
TEST(ExternalDrives, TheMachineFileIsChecked) {
  const std::string axes = "name: m\naxes:\n  - {name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}\n";
  const auto problems = [&](const std::string& external) {
    const LoadResult loaded = LoadMachine(axes + "external: " + external + "\n", "m.yaml");
    return loaded.problems.empty() ? "" : loaded.problems.front();
  };
  EXPECT_EQ(problems("{drives: [{axis: x, missing_cycles: 3}], answer_within_s: 0.5}"), "");
  EXPECT_NE(problems("{drives: [{axis: z}]}").find("expected the name of an axis, found 'z'"), std::string::npos);
  EXPECT_NE(problems("{drives: [{axis: x}, {axis: x}]}").find("expected each axis once"), std::string::npos);
  EXPECT_NE(problems("{drives: [{axis: x, missing_cycles: 0}]}").find("missing_cycles"), std::string::npos);
  EXPECT_NE(problems("{drives: [{axis: x}], answer_within_s: 0}").find("answer_within_s"), std::string::npos);
}

}  // namespace
}  // namespace takt::engine
