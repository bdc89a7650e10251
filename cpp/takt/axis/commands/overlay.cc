#include "takt/axis/commands/overlay.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Description<MoveSuperimposed>& d) {
  using C = MoveSuperimposed;
  d.about(
      "Moves by a distance superimposed on the motion in progress; on an axis at rest, like move_relative "
      "(MC_MoveSuperimposed).");
  d.required<&C::distance>(unit::u, "Distance; negative: downwards.");
  d.defaulted<&C::velocity_difference>(unit::u_s, positive,
                                       "Largest velocity added; unset: as far as the axis' limits allow.");
  d.defaulted<&C::acceleration>(unit::u_s2, positive, "Largest acceleration added; unset: the axis' limit.");
  d.defaulted<&C::deceleration>(unit::u_s2, positive, "Largest deceleration added; unset: the axis' limit.");
  d.defaulted<&C::jerk>(unit::u_s3, not_negative, kJerk);
  d.defaulted<&C::update>(
      "True: changes the superimposed motion in progress, and the distance counts from the start of that motion; if "
      "there is none, a new one begins.");
}

void describe(Description<HaltSuperimposed>& d) {
  using C = HaltSuperimposed;
  d.about("Brakes the superimposed motion to rest; the motion in progress continues (MC_HaltSuperimposed).");
  d.defaulted<&C::deceleration>(unit::u_s2, positive, kDeceleration);
  d.defaulted<&C::jerk>(unit::u_s3, not_negative, kJerk);
}

}  // namespace takt::axis
