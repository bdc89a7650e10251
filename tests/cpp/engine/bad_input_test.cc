// Every number of every command of an axis, made invalid, in every state of an axis: refused, and the machine is
// identical to a twin that did not receive the command.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "cam_rig.h"
#include "wrong.h"

namespace takt::engine {
namespace {

// One valid command of each kind.
std::vector<axis::Command> GoodAxisCommands() {
  const Name master = Name::Of("a0");
  return {axis::MoveAbsolute{.position = 10},
          axis::MoveRelative{.distance = 10},
          axis::CamAdd{.cam = Name::Of("feed")},
          axis::MoveAdditive{.distance = 10},
          axis::MoveVelocity{.velocity = 10},
          axis::MoveContinuousAbsolute{.position = 10, .end_velocity = 1},
          axis::MoveContinuousRelative{.distance = 10, .end_velocity = 1},
          axis::Inch{.distance = 1},
          axis::Halt{},
          axis::Stop{},
          axis::Jog{.forward = true},
          axis::MoveSuperimposed{.distance = 1},
          axis::HaltSuperimposed{},
          axis::TorqueControl{.torque = 1},
          Gear("a0"),
          axis::GearInPos{.master = master},
          axis::PhasingAbsolute{.phase_shift = 1},
          axis::PhasingRelative{.phase_shift = 1},
          axis::CombineAxes{.master1 = master, .master2 = Name::Of("a2")},
          Cam("a0", "lift"),
          axis::PositionProfile{.profile = Name::Of("lift")},
          axis::VelocityProfile{.profile = Name::Of("lift")},
          axis::AccelerationProfile{.profile = Name::Of("lift")},
          axis::Home{.position = 1},
          axis::StepAbsSwitch{.velocity = 5},
          axis::StepLimitSwitch{.velocity = 5},
          axis::StepBlock{.velocity = 5, .deviation = 1},
          axis::StepRefPulse{.velocity = 5},
          axis::StepDistanceCoded{.velocity = 5},
          axis::StepDirect{.set_position = 1},
          axis::FinishHoming{},
          axis::StepRefFlyingSwitch{},
          axis::StepRefFlyingRefPulse{},
          axis::SetConstants{.kp = 1},
          axis::WriteParameter{.number = 2, .value = 1},
          axis::SetSoftLimits{},
          axis::DirectOutput{},
          axis::PulseOutput{.voltage = 1, .duration = 1},
          axis::WriteOutput{.number = 1, .value = true},
          axis::SetPosition{.position = 1},
          axis::SetOverride{},
          axis::TouchProbe{},
          axis::Touch{},
          axis::Stream{},
          axis::StreamPoint{.position = 1},
          axis::SetLoad{.inertia = 1, .coulomb_friction = 1, .viscous_friction = 1, .load_torque = 1}};
}

struct AxisSituation {
  const char* name;
  axis::PlcState state;
  void (*bring)(Line&);
};

// Axis 1 receives the commands.
const AxisSituation kAxisSituations[] = {
    {"disabled", axis::PlcState::kDisabled,
     [](Line& l) {
       l.Give(1, axis::Power{.enable = false});
       l.Run(50);
     }},
    {"standstill", axis::PlcState::kStandstill, [](Line&) {}},
    {"discrete", axis::PlcState::kDiscreteMotion,
     [](Line& l) {
       l.Give(1, axis::MoveAbsolute{.position = 1e5, .velocity = 20});
       l.Give(1, axis::MoveAbsolute{.position = 2e5, .buffer_mode = axis::BufferMode::kBlendingLow});
       l.Run(50);
     }},
    {"superimposed", axis::PlcState::kDiscreteMotion,
     [](Line& l) {
       l.Give(1, axis::MoveAbsolute{.position = 1e5, .velocity = 20});
       l.Give(1, axis::MoveSuperimposed{.distance = 1e5, .velocity_difference = 10});
       l.Run(50);
     }},
    {"continuous", axis::PlcState::kContinuousMotion,
     [](Line& l) {
       l.Give(1, axis::MoveVelocity{.velocity = 20});
       l.Run(50);
     }},
    {"synchronized", axis::PlcState::kSynchronizedMotion,
     [](Line& l) {
       l.Give(0, axis::MoveVelocity{.velocity = 20});
       l.Give(1, Gear("a0", 2));
       l.Run(50);
     }},
    {"homing", axis::PlcState::kHoming,
     [](Line& l) {
       l.Give(1, axis::StepAbsSwitch{.velocity = 1});
       l.Run(50);
     }},
    {"stopping", axis::PlcState::kStopping,
     [](Line& l) {
       l.Give(1, axis::MoveVelocity{.velocity = 400});
       l.Run(300);
       l.Give(1, axis::Stop{.deceleration = 20, .hold = true});
       l.Run(50);
     }},
    {"error_stop", axis::PlcState::kErrorStop, [](Line& l) {
       l.Give(1, axis::MoveVelocity{.velocity = 20});
       l.Run(50);
       l.engine.faults(1).drive_fault = true;
       l.Run(50);
     }}};

class BadInput : public testing::TestWithParam<AxisSituation> {};

// AX-06, AX-11, AX-13
TEST_P(BadInput, IsRefusedAndLeavesTheMachineLikeItsTwin) {
  Line asked(WithCams(LineOf(3)));
  Line twin(WithCams(LineOf(3)));
  for (Line* line : {&asked, &twin}) GetParam().bring(*line);
  ASSERT_EQ(asked.At(1).state, GetParam().state);
  ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash());
  int refused = 0;
  for (const axis::Command& good : GoodAxisCommands()) {
    for (const Wrong<axis::Command>& wrong : WrongVersionsOf(good)) {
      const Ticket ticket = asked.Give(1, wrong.command);
      asked.Step();
      twin.Step();
      ASSERT_EQ(asked.last[ticket].state, FeedbackState::kError) << wrong.what;
      ASSERT_NE(asked.last[ticket].error, ErrorId::kNone) << wrong.what;
      ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash()) << wrong.what;
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_EQ(asked.At(1).state, GetParam().state);  // the state was kept to the end
}

INSTANTIATE_TEST_SUITE_P(AllStates, BadInput, testing::ValuesIn(kAxisSituations),
                         [](const auto& info) { return std::string(info.param.name); });

// Every command is among those that are made invalid, or has no number.
TEST(BadInput, KnowsEveryCommand) {
  std::set<std::size_t> known;
  for (const axis::Command& good : GoodAxisCommands()) known.insert(good.index());
  const auto without_numbers = [](std::size_t index) {
    return index == axis::Command(axis::Power{}).index() || index == axis::Command(axis::Reset{}).index() ||
           index == axis::Command(axis::Straighten{}).index() ||  // no required number: refused as a whole
           index == axis::Command(axis::GearOut{}).index() || index == axis::Command(axis::CamTableSelect{}).index() ||
           index == axis::Command(axis::CamOut{}).index() || index == axis::Command(axis::CamRemove{}).index() ||
           index == axis::Command(axis::StepAbsolute{}).index() ||
           index == axis::Command(axis::ReadParameter{}).index() ||
           index == axis::Command(axis::AbortTrigger{}).index() ||
           index == axis::Command(axis::AbortPassiveHoming{}).index() ||
           index == axis::Command(axis::DigitalCamSwitch{}).index();
  };
  for (std::size_t i = 0; i < std::variant_size_v<axis::Command>; ++i) {
    EXPECT_TRUE(known.count(i) == 1 || without_numbers(i)) << "command " << i << " of axis::Command";
  }
}

}  // namespace
}  // namespace takt::engine
