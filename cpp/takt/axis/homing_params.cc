#include "takt/axis/homing_params.h"

#include "takt/core/describe.h"

namespace takt::axis {

namespace {

bool IsOneWay(HomingDirection direction) {
  return direction == HomingDirection::kPositive || direction == HomingDirection::kNegative;
}

bool FindsSwitch(HomingMethod method) {
  return method == HomingMethod::kSwitch || method == HomingMethod::kLimitSwitch;
}

}  // namespace

void describe(Enumeration<HomingMethod>& e) {
  e.about("Method by which MC_Home finds the reference.");
  e.value(HomingMethod::kDirect, "direct", "The present position is the reference.");
  e.value(HomingMethod::kAbsolute, "absolute", "Takes the position of the absolute encoder as it is.");
  e.value(HomingMethod::kSwitch, "switch", "Searches the reference switch.");
  e.value(HomingMethod::kLimitSwitch, "limit_switch", "Searches a limit switch.");
  e.value(HomingMethod::kBlock, "block", "Searches an end stop.");
  e.value(HomingMethod::kPulse, "pulse", "Searches the next index pulse.");
  e.value(HomingMethod::kDistanceCoded, "distance_coded",
          "Finds the position from the distance between two marks (encoder.coded_marks).");
}

void describe(Description<HomingParams>& d) {
  using H = HomingParams;
  d.about("Method and parameters of MC_Home on this axis.");
  d.defaulted<&H::method>("Method by which the reference is found.");
  d.defaulted<&H::direction>("Direction in which the search begins.");
  d.defaulted<&H::switch_mode>("State or edge of the switch that ends the search.");
  d.defaulted<&H::velocity>(unit::u_s, not_negative, "Velocity of the search.");
  d.defaulted<&H::pulse_velocity>(unit::u_s, positive,
                                  "Velocity of a further search, from the switch to the next index pulse, which then "
                                  "is the reference; unset: the switch is the reference.");
  d.defaulted<&H::pulse_direction>("Direction of that search.");
  d.defaulted<&H::deviation>(unit::u, not_negative, "Following error at which the end stop is found.");
  d.defaulted<&H::time_limit>(unit::s, not_negative,
                              "Longest duration of the search; 0: unlimited. Beyond it: error 0001.");
  d.defaulted<&H::distance_limit>(unit::u, not_negative,
                                  "Longest distance of the search; 0: unlimited. Beyond it: error 0002.");
  d.defaulted<&H::torque_limit>(unit::nm, positive, "Largest torque during the search; unset: the limit of the axis.");
  d.rule<&H::velocity>("must be more than 0 for a search",
                       [](const H& h) { return !Searches(h.method) || h.velocity > 0; });
  d.rule<&H::direction>("must be positive or negative where there is no switch",
                        [](const H& h) { return FindsSwitch(h.method) || IsOneWay(h.direction); });
  d.rule<&H::pulse_velocity>("is for methods that search a switch",
                             [](const H& h) { return !h.pulse_velocity || FindsSwitch(h.method); });
  d.rule<&H::pulse_direction>("must be positive or negative", [](const H& h) { return IsOneWay(h.pulse_direction); });
  d.rule<&H::deviation>("must be more than 0 for an end stop",
                        [](const H& h) { return h.method != HomingMethod::kBlock || h.deviation > 0; });
}

}  // namespace takt::axis
