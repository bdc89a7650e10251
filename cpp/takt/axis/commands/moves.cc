#include "takt/axis/commands/moves.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Enumeration<Direction>& e) {
  e.about("Sense of travel of a rotary axis; ignored by linear axes.");
  e.value(Direction::kCurrent, "current", "Sense of the present motion, or of the last one at rest.");
  e.value(Direction::kPositive, "positive", "Upwards only.");
  e.value(Direction::kShortest, "shortest", "In the sense of the shorter distance; upwards if both are equal.");
  e.value(Direction::kNegative, "negative", "Downwards only.");
}

void describe(Enumeration<BufferMode>& e) {
  e.about("When a command takes over from the previous one, and the velocity of the axis at that moment.");
  e.value(BufferMode::kAborting, "aborting", "At once; the command in progress and all buffered ones are aborted.");
  e.value(BufferMode::kBuffered, "buffered", "When the previous command is done.");
  e.value(BufferMode::kBlendingLow, "blending_low",
          "At the end position of the previous move, at the lower of both velocities.");
  e.value(BufferMode::kBlendingPrevious, "blending_previous",
          "At that position, at the velocity of the previous move.");
  e.value(BufferMode::kBlendingNext, "blending_next", "At that position, at the velocity of this move.");
  e.value(BufferMode::kBlendingHigh, "blending_high", "At that position, at the higher of both velocities.");
}

void describe(Description<Power>& d) {
  d.about(
      "Switches the drive on and closes the position loop, or opens it (MC_Power). Done when the axis is in "
      "Standstill, or Disabled.");
  d.defaulted<&Power::enable>("True: on. False: off; a moving axis first stops along its ramp.");
  d.defaulted<&Power::buffer_mode>("aborting, or buffered: after the motion in progress.");
  d.defaulted<&Power::enable_positive>(
      "Enables motion in the positive direction, from this command on; unset: as before, initially enabled. Motion in "
      "a direction that is not enabled is refused; a motion in progress ends as at a limit switch.");
  d.defaulted<&Power::enable_negative>("Enables motion in the negative direction, likewise.");
}

void describe(Description<Reset>& d) {
  d.about(
      "Clears the fault of the axis and leaves ErrorStop: to Standstill, or to Disabled if the fault opened the loop "
      "(MC_Reset).");
}

void describe(Description<MoveAbsolute>& d) {
  using M = MoveAbsolute;
  d.about("Moves to a position (MC_MoveAbsolute).");
  d.required<&M::position>(unit::u, "Target position. Rotary axes: 0 to the modulus.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity of the move; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::direction>("Sense of travel of a rotary axis.");
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveRelative>& d) {
  using M = MoveRelative;
  d.about("Moves by a distance from the set position at its start (MC_MoveRelative).");
  d.required<&M::distance>(unit::u, "Distance; negative: downwards.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity of the move; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>(kBufferMode);
}

void describe(Description<MoveAdditive>& d) {
  using M = MoveAdditive;
  d.about(
      "Moves by a distance from the target of the move in progress, or from the set position if there is none "
      "(MC_MoveAdditive).");
  d.required<&M::distance>(unit::u, "Distance to add to the target; negative: downwards.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity of the move; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveVelocity>& d) {
  using M = MoveVelocity;
  d.about(
      "Moves at a constant velocity without an end (MC_MoveVelocity). Reached when the velocity is reached; active "
      "until another command takes over.");
  d.required<&M::velocity>(unit::u_s, not_negative, "Speed; the sense is given by the direction.");
  DescribeRamps(d);
  d.defaulted<&M::direction>("positive, negative or current.");
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveContinuousAbsolute>& d) {
  using M = MoveContinuousAbsolute;
  d.about("Moves to a position and continues from there at a given velocity (MC_MoveContinuousAbsolute).");
  d.required<&M::position>(unit::u, "Position at which the end velocity is reached. Rotary axes: 0 to the modulus.");
  d.required<&M::end_velocity>(unit::u_s, not_negative, "Speed from that position on, in the sense of travel.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity of the move; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::direction>("Sense of travel of a rotary axis.");
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveContinuousRelative>& d) {
  using M = MoveContinuousRelative;
  d.about(
      "Moves by a distance from the set position at its start, and continues from there at a given velocity "
      "(MC_MoveContinuousRelative).");
  d.required<&M::distance>(unit::u,
                           "Distance to the position at which the end velocity is reached; negative: downwards.");
  d.required<&M::end_velocity>(unit::u_s, not_negative, "Speed from that position on, in the sense of travel.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity of the move; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kUpdate);
}

void describe(Description<Inch>& d) {
  d.about("Moves by one increment from rest (MC_Inch); refused while the axis moves.");
  d.required<&Inch::distance>(unit::u, "Increment; negative: downwards.");
  d.defaulted<&Inch::velocity>(unit::u_s, positive, "Largest velocity of the move; unset: the axis' limit.");
  DescribeRamps(d);
}

void describe(Description<Halt>& d) {
  d.about("Brakes to rest; another command may take over before (MC_Halt).");
  d.defaulted<&Halt::deceleration>(unit::u_s2, positive, kDeceleration);
  d.defaulted<&Halt::jerk>(unit::u_s3, not_negative, kJerk);
  d.defaulted<&Halt::buffer_mode>("aborting or buffered.");
}

void describe(Description<Straighten>& d) {
  d.about(
      "Straightens a gantry: an axis that follows another from load on moves to the position due by its master, which "
      "is at rest. Done when the skew of the set points is 0.");
  d.defaulted<&Straighten::velocity>(unit::u_s, positive,
                                     "Largest velocity relative to the master; unset: a tenth of the axis' limit.");
}

void describe(Description<Stop>& d) {
  d.about("Brakes to rest; no other command may take over until it is released (MC_Stop).");
  d.defaulted<&Stop::deceleration>(unit::u_s2, positive, kDeceleration);
  d.defaulted<&Stop::jerk>(unit::u_s3, not_negative, kJerk);
  d.defaulted<&Stop::hold>(
      "True: the axis stays in Stopping until released (Execute kept true). False: until it is at rest.");
  d.defaulted<&Stop::buffer_mode>("aborting or buffered.");
}

void describe(Description<Jog>& d) {
  d.about(
      "Moves as long as a key is held (GT_Jog). The direction pressed first has priority; both keys must be released "
      "before the next jog. Repeated, it changes the keys; done when both are released and the axis is at rest.");
  d.defaulted<&Jog::forward>("State of the key for upwards.");
  d.defaulted<&Jog::backward>("State of the key for downwards.");
  d.defaulted<&Jog::velocity>(unit::u_s, positive, "Speed; unset: the axis' limit.");
  DescribeRamps(d);
}

}  // namespace takt::axis
