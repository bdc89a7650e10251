#include "takt/axis/commands/homing.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

namespace {
// Homing begins at rest.
constexpr const char* kBlendedHoming =
    "How the command follows the previous one; blended: at the end of the previous one, with velocity 0.";
}  // namespace

void describe(Enumeration<HomingDirection>& e) {
  e.about("Direction in which a search begins.");
  e.value(HomingDirection::kPositive, "positive", "Upwards.");
  e.value(HomingDirection::kNegative, "negative", "Downwards.");
  e.value(HomingDirection::kSwitchPositive, "switch_positive",
          "Upwards while the switch is off, downwards while it is on.");
  e.value(HomingDirection::kSwitchNegative, "switch_negative",
          "Downwards while the switch is off, upwards while it is on.");
}

void describe(Enumeration<SwitchMode>& e) {
  e.about("State or edge of a switch that ends a search.");
  e.value(SwitchMode::kOn, "is_on", "The switch is on.");
  e.value(SwitchMode::kOff, "is_off", "The switch is off.");
  e.value(SwitchMode::kEdgeOn, "edge_on", "The switch changes to on.");
  e.value(SwitchMode::kEdgeOff, "edge_off", "The switch changes to off.");
  e.value(SwitchMode::kEdgeSwitchPositive, "edge_switch_positive",
          "Upwards: the switch changes to on; downwards: it changes to off.");
  e.value(SwitchMode::kEdgeSwitchNegative, "edge_switch_negative",
          "Downwards: the switch changes to on; upwards: it changes to off.");
}

void describe(Description<Home>& d) {
  using C = Home;
  d.about("Finds the reference by the method in the section `homing` of the axis, and ends homing (MC_Home).");
  d.defaulted<&C::position>(
      unit::u, "Position to be set at the reference; unused by methods absolute and distance_coded, which measure it.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepAbsSwitch>& d) {
  using C = StepAbsSwitch;
  d.about(
      "Searches the reference switch and returns to where it was found (MC_StepAbsSwitch). The axis stays in Homing.");
  d.defaulted<&C::direction>("Direction in which the search begins.");
  d.defaulted<&C::switch_mode>("State or edge of the switch that ends the search.");
  d.required<&C::velocity>(unit::u_s, positive, "Velocity of the search.");
  d.defaulted<&C::set_position>(unit::u, "Position to be set at the switch; unset: positions keep their values.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&C::torque_limit>(
      unit::nm, positive,
      "Largest torque during the search, at most the limit of the axis; unset: the limit of the axis.");
  d.defaulted<&C::buffer_mode>(kBlendedHoming);
}

void describe(Description<StepLimitSwitch>& d) {
  using C = StepLimitSwitch;
  d.about("Searches a limit switch and returns to where it was found (MC_StepLimitSwitch). The axis stays in Homing.");
  d.defaulted<&C::direction>("Direction in which the search begins.");
  d.defaulted<&C::switch_mode>("State or edge of the switch that ends the search.");
  d.required<&C::velocity>(unit::u_s, positive, "Velocity of the search.");
  d.defaulted<&C::set_position>(unit::u, "Position to be set at the switch; unset: positions keep their values.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&C::torque_limit>(
      unit::nm, positive,
      "Largest torque during the search, at most the limit of the axis; unset: the limit of the axis.");
  d.defaulted<&C::buffer_mode>(kBlendedHoming);
}

void describe(Description<StepBlock>& d) {
  using C = StepBlock;
  d.about("Searches an end stop, which blocks the axis so that its following error grows (MC_StepBlock). Ends homing.");
  d.defaulted<&C::direction>("Direction of the search: positive or negative.");
  d.required<&C::velocity>(unit::u_s, positive, "Velocity of the search.");
  d.required<&C::deviation>(unit::u, positive, "DevRef: following error at which the end stop is found.");
  d.defaulted<&C::set_position>(unit::u, "Position to be set at the end stop.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&C::torque_limit>(
      unit::nm, positive,
      "Largest torque during the search, at most the limit of the axis; unset: the limit of the axis.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepRefPulse>& d) {
  using C = StepRefPulse;
  d.about(
      "Searches the encoder's next index pulse (MC_StepRefPulse); stops behind it and does not return. Ends homing.");
  d.defaulted<&C::direction>("Direction of the search: positive or negative.");
  d.required<&C::velocity>(unit::u_s, positive, "Velocity of the search.");
  d.defaulted<&C::set_position>(unit::u, "Position to be set at the index pulse.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&C::torque_limit>(
      unit::nm, positive,
      "Largest torque during the search, at most the limit of the axis; unset: the limit of the axis.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepDistanceCoded>& d) {
  using C = StepDistanceCoded;
  d.about(
      "Finds the position from the distance between two index pulses of a scale with distance-coded marks "
      "(MC_StepDistanceCoded), which encoder.coded_marks describes; stops behind the second one. Ends homing.");
  d.defaulted<&C::direction>("Direction of the search: positive or negative.");
  d.required<&C::velocity>(unit::u_s, positive, "Velocity of the search.");
  DescribeRamps(d);
  d.defaulted<&C::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&C::torque_limit>(
      unit::nm, positive,
      "Largest torque during the search, at most the limit of the axis; unset: the limit of the axis.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepDirect>& d) {
  using C = StepDirect;
  d.about("Takes the present position as the reference (MC_StepDirect). Ends homing.");
  d.defaulted<&C::set_position>(unit::u, "Position to be set at the reference.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<StepAbsolute>& d) {
  using C = StepAbsolute;
  d.about("Takes the position of the absolute encoder as it is (MC_StepAbsolute). Ends homing.");
  d.defaulted<&C::buffer_mode>("aborting or buffered.");
}

void describe(Description<FinishHoming>& d) {
  using C = FinishHoming;
  d.about("Moves away by a distance and ends homing (MC_FinishHoming).");
  d.defaulted<&C::distance>(unit::u, "Distance of the move; 0: no motion.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Velocity of the move; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBlendedHoming);
}

void describe(Description<StepRefFlyingSwitch>& d) {
  using C = StepRefFlyingSwitch;
  d.about("Takes the reference from the reference switch during another motion (MC_StepRefFlyingSwitch).");
  d.defaulted<&C::switch_mode>("State or edge of the switch that ends the search.");
  d.defaulted<&C::set_position>(unit::u, "Position to be set at the switch.");
  d.defaulted<&C::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&C::until_halt>("True: a halt or a stop of the axis also ends the search.");
}

void describe(Description<StepRefFlyingRefPulse>& d) {
  using C = StepRefFlyingRefPulse;
  d.about("Takes the reference from the encoder's index pulse during another motion (MC_StepRefFlyingRefPulse).");
  d.defaulted<&C::set_position>(unit::u, "Position to be set at the index pulse.");
  d.defaulted<&C::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&C::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&C::until_halt>("True: a halt or a stop of the axis also ends the search.");
}

void describe(Description<AbortPassiveHoming>& d) {
  d.about("Ends the search for a reference during another motion, if there is one (MC_AbortPassiveHoming).");
}

}  // namespace takt::axis
