#include "takt/axis/commands/overlay.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Description<MoveSuperimposed>& d) {
  using C = MoveSuperimposed;
  d.about(
      "Moves by a distance on top of the motion in progress, whatever that is; standing, like move_relative "
      "(MC_MoveSuperimposed).");
  d.required<&C::distance>(unit::u, "How far; negative: downwards.");
  d.defaulted<&C::velocity_difference>(unit::u_s, positive, "Largest velocity added; unset: what the limits leave.");
  d.defaulted<&C::acceleration>(unit::u_s2, positive, "Largest acceleration added; unset: the axis' limit.");
  d.defaulted<&C::deceleration>(unit::u_s2, positive, "Largest deceleration added; unset: the axis' limit.");
  d.defaulted<&C::jerk>(unit::u_s3, not_negative, kJerk);
  d.defaulted<&C::update>(
      "True: changes the motion that is on top already, the distance counts from where that began; where there is "
      "none, "
      "it begins as without.");
}

void describe(Description<HaltSuperimposed>& d) {
  using C = HaltSuperimposed;
  d.about("Brakes what was put on top of the motion in progress, which goes on (MC_HaltSuperimposed).");
  d.defaulted<&C::deceleration>(unit::u_s2, positive, kDeceleration);
  d.defaulted<&C::jerk>(unit::u_s3, not_negative, kJerk);
}

}  // namespace takt::axis
