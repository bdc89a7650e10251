#include "takt/axis/commands/homing.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

namespace {
// Homing begins at rest.
constexpr const char* kBlendedHoming =
    "How the command follows the one before it; blended: at its end, with velocity 0.";
}  // namespace

void describe(Enumeration<HomingDirection>& e) {
  e.about("Where a search goes first.");
  e.value(HomingDirection::kPositive, "positive", "Upwards.");
  e.value(HomingDirection::kNegative, "negative", "Downwards.");
  e.value(HomingDirection::kSwitchPositive, "switch_positive",
          "Upwards while the switch is off, downwards while it is on.");
  e.value(HomingDirection::kSwitchNegative, "switch_negative",
          "Downwards while the switch is off, upwards while it is on.");
}

void describe(Enumeration<SwitchMode>& e) {
  e.about("What of a switch ends a search.");
  e.value(SwitchMode::kOn, "is_on", "It is on.");
  e.value(SwitchMode::kOff, "is_off", "It is off.");
  e.value(SwitchMode::kEdgeOn, "edge_on", "It goes on.");
  e.value(SwitchMode::kEdgeOff, "edge_off", "It goes off.");
  e.value(SwitchMode::kEdgeSwitchPositive, "edge_switch_positive", "Upwards: it goes on; downwards: it goes off.");
  e.value(SwitchMode::kEdgeSwitchNegative, "edge_switch_negative", "Downwards: it goes on; upwards: it goes off.");
}

void describe(Description<Home>& d) {
  using C = Home;
  d.about("Finds the reference as the section `homing` of the axis says, and ends homing (MC_Home).");
  d.defaulted<&C::position>(
      unit::u,
      "What the place of the reference is called; methods absolute and distance_coded know that by "
      "themselves.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepAbsSwitch>& d) {
  using C = StepAbsSwitch;
  d.about(
      "Searches the reference switch and returns to where it was found (MC_StepAbsSwitch). The axis stays in Homing.");
  d.defaulted<&C::direction>("Where to search first.");
  d.defaulted<&C::switch_mode>("Which state or edge of the switch ends the search.");
  d.required<&C::velocity>(unit::u_s, positive, "How fast to search.");
  d.defaulted<&C::set_position>(unit::u, "What the place is called; unset: positions keep their numbers.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative, "Longest search; 0: any. Then error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative, "Longest way of the search; 0: any. Then error 0002.");
  d.defaulted<&C::torque_limit>(unit::nm, positive, "Largest torque meanwhile, at most that of the axis; unset: that.");
  d.defaulted<&C::buffer_mode>(kBlendedHoming);
}

void describe(Description<StepLimitSwitch>& d) {
  using C = StepLimitSwitch;
  d.about("Searches a limit switch and returns to where it was found (MC_StepLimitSwitch). The axis stays in Homing.");
  d.defaulted<&C::direction>("Where to search first.");
  d.defaulted<&C::switch_mode>("Which state or edge of the switch ends the search.");
  d.required<&C::velocity>(unit::u_s, positive, "How fast to search.");
  d.defaulted<&C::set_position>(unit::u, "What the place is called; unset: positions keep their numbers.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative, "Longest search; 0: any. Then error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative, "Longest way of the search; 0: any. Then error 0002.");
  d.defaulted<&C::torque_limit>(unit::nm, positive, "Largest torque meanwhile, at most that of the axis; unset: that.");
  d.defaulted<&C::buffer_mode>(kBlendedHoming);
}

void describe(Description<StepBlock>& d) {
  using C = StepBlock;
  d.about("Searches an end stop: the axis hardly moves any more, and lags behind (MC_StepBlock). Ends homing.");
  d.defaulted<&C::direction>("Where to search first.");
  d.required<&C::velocity>(unit::u_s, positive, "How fast to search.");
  d.required<&C::deviation>(unit::u, positive, "DevRef: the lag that says so.");
  d.defaulted<&C::set_position>(unit::u, "What the position is called there.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative, "Longest search; 0: any. Then error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative, "Longest way of the search; 0: any. Then error 0002.");
  d.defaulted<&C::torque_limit>(unit::nm, positive, "Largest torque meanwhile, at most that of the axis; unset: that.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepRefPulse>& d) {
  using C = StepRefPulse;
  d.about(
      "Searches the encoder's next index pulse (MC_StepRefPulse); stops behind it and does not return. Ends homing.");
  d.defaulted<&C::direction>("Where to search first.");
  d.required<&C::velocity>(unit::u_s, positive, "How fast to search.");
  d.defaulted<&C::set_position>(unit::u, "What the position is called there.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative, "Longest search; 0: any. Then error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative, "Longest way of the search; 0: any. Then error 0002.");
  d.defaulted<&C::torque_limit>(unit::nm, positive, "Largest torque meanwhile, at most that of the axis; unset: that.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepDistanceCoded>& d) {
  using C = StepDistanceCoded;
  d.about(
      "Finds the position from the distance between two index pulses of a scale with distance-coded marks "
      "(MC_StepDistanceCoded), which encoder.coded_marks describes; stops behind the second one. Ends homing.");
  d.defaulted<&C::direction>("Where to search.");
  d.required<&C::velocity>(unit::u_s, positive, "How fast to search.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative, "Longest search; 0: any. Then error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative, "Longest way of the search; 0: any. Then error 0002.");
  d.defaulted<&C::torque_limit>(unit::nm, positive, "Largest torque meanwhile, at most that of the axis; unset: that.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepDirect>& d) {
  using C = StepDirect;
  d.about("The axis stands at its reference (MC_StepDirect). Ends homing.");
  d.defaulted<&C::set_position>(unit::u, "What the position is called there.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepAbsolute>& d) {
  using C = StepAbsolute;
  d.about("Takes the position of the absolute encoder as it is (MC_StepAbsolute). Ends homing.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<FinishHoming>& d) {
  using C = FinishHoming;
  d.about("Moves off by a distance and ends homing (MC_FinishHoming).");
  d.defaulted<&C::distance>(unit::u, "How far; 0: stay.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "How fast; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBlendedHoming);
}

void describe(Description<StepRefFlyingSwitch>& d) {
  using C = StepRefFlyingSwitch;
  d.about("Takes the reference from the reference switch while another motion goes on (MC_StepRefFlyingSwitch).");
  d.defaulted<&C::switch_mode>("Which state or edge of the switch ends the search.");
  d.defaulted<&C::set_position>(unit::u, "What the position is called there.");
  d.defaulted<&C::time_limit>(unit::s, not_negative, "Longest search; 0: any. Then error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative, "Longest way of the search; 0: any. Then error 0002.");
  d.defaulted<&C::until_halt>("True: a halt or a stop of the axis ends it, too.");
}

void describe(Description<StepRefFlyingRefPulse>& d) {
  using C = StepRefFlyingRefPulse;
  d.about(
      "Takes the reference from the encoder's index pulse while another motion goes on (MC_StepRefFlyingRefPulse).");
  d.defaulted<&C::set_position>(unit::u, "What the position is called there.");
  d.defaulted<&C::time_limit>(unit::s, not_negative, "Longest search; 0: any. Then error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative, "Longest way of the search; 0: any. Then error 0002.");
  d.defaulted<&C::until_halt>("True: a halt or a stop of the axis ends it, too.");
}

void describe(Description<AbortPassiveHoming>& d) {
  d.about("Gives up a reference that is to be taken in passing (MC_AbortPassiveHoming). Done also without one.");
}

}  // namespace takt::axis
