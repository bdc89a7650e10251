#include "takt/axis/commands/moves.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Enumeration<Direction>& e) {
  e.about("Sense of travel of a rotary axis; without meaning on a linear one.");
  e.value(Direction::kCurrent, "current", "As the axis moves now, or moved last.");
  e.value(Direction::kPositive, "positive", "Upwards only.");
  e.value(Direction::kShortest, "shortest", "Whichever way is shorter; upwards when both are equal.");
  e.value(Direction::kNegative, "negative", "Downwards only.");
}

void describe(Enumeration<BufferMode>& e) {
  e.about("When a command takes over from the one before it, and how fast the axis is at that moment.");
  e.value(BufferMode::kAborting, "aborting", "At once; the command in progress and all buffered ones are aborted.");
  e.value(BufferMode::kBuffered, "buffered", "When the command before is done.");
  e.value(BufferMode::kBlendingLow, "blending_low",
          "At the end position of the move before, at the lower of both velocities.");
  e.value(BufferMode::kBlendingPrevious, "blending_previous", "At that position, at the velocity of the move before.");
  e.value(BufferMode::kBlendingNext, "blending_next", "At that position, at the velocity of this move.");
  e.value(BufferMode::kBlendingHigh, "blending_high", "At that position, at the higher of both velocities.");
}

void describe(Description<Power>& d) {
  d.about(
      "Switches the drive on and closes the position loop, or opens it (MC_Power). Done when the axis stands in "
      "Standstill, or is Disabled.");
  d.defaulted<&Power::enable>("True: on. False: off; a moving axis stops along its ramp first.");
  d.defaulted<&Power::buffer_mode>("aborting, or buffered: after the motion in progress.");
  d.defaulted<&Power::enable_positive>(
      "Whether the axis may move in the positive direction, from this command on; unset: as before, at first it may. "
      "Motion in a direction that is not enabled is refused; one in progress ends as at a limit switch.");
  d.defaulted<&Power::enable_negative>("The same for the negative direction.");
}

void describe(Description<Reset>& d) {
  d.about(
      "Clears the axis' fault and leaves ErrorStop: to Standstill, or to Disabled where the fault opened the loop "
      "(MC_Reset).");
}

void describe(Description<MoveAbsolute>& d) {
  using M = MoveAbsolute;
  d.about("Moves to a position (MC_MoveAbsolute).");
  d.required<&M::position>(unit::u, "Where to stop. Rotary axes: 0 to the modulus.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity on the way; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::direction>("Sense of travel of a rotary axis.");
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveRelative>& d) {
  using M = MoveRelative;
  d.about("Moves by a distance from the set position at the moment it starts (MC_MoveRelative).");
  d.required<&M::distance>(unit::u, "How far; negative: downwards.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity on the way; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>(kBufferMode);
}

void describe(Description<MoveAdditive>& d) {
  using M = MoveAdditive;
  d.about(
      "Moves by a distance from where the move in progress was to end, or from the set position where there is none "
      "(MC_MoveAdditive).");
  d.required<&M::distance>(unit::u, "How much further; negative: less far.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity on the way; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveVelocity>& d) {
  using M = MoveVelocity;
  d.about("Moves on and on at a velocity (MC_MoveVelocity). Reached when the velocity is; never done by itself.");
  d.required<&M::velocity>(unit::u_s, not_negative, "How fast; the direction gives the sense.");
  DescribeRamps(d);
  d.defaulted<&M::direction>("positive, negative or current.");
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveContinuousAbsolute>& d) {
  using M = MoveContinuousAbsolute;
  d.about("Moves to a position and goes on from there with a set velocity (MC_MoveContinuousAbsolute).");
  d.required<&M::position>(unit::u, "Where the end velocity is reached. Rotary axes: 0 to the modulus.");
  d.required<&M::end_velocity>(unit::u_s, not_negative, "How fast to go on from there, in the sense of travel.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity on the way; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::direction>("Sense of travel of a rotary axis.");
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kChange);
}

void describe(Description<MoveContinuousRelative>& d) {
  using M = MoveContinuousRelative;
  d.about(
      "Moves by a distance from the set position at the moment it starts, and goes on from there with a set velocity "
      "(MC_MoveContinuousRelative).");
  d.required<&M::distance>(unit::u, "How far to where the end velocity is reached; negative: downwards.");
  d.required<&M::end_velocity>(unit::u_s, not_negative, "How fast to go on from there, in the sense of travel.");
  d.defaulted<&M::velocity>(unit::u_s, positive, "Largest velocity on the way; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>(kBufferMode);
  d.defaulted<&M::update>(kUpdate);
}

void describe(Description<Inch>& d) {
  d.about("Moves by one increment from standstill (MC_Inch); refused while the axis moves.");
  d.required<&Inch::distance>(unit::u, "The increment; negative: downwards.");
  d.defaulted<&Inch::velocity>(unit::u_s, positive, "Largest velocity on the way; unset: the axis' limit.");
  DescribeRamps(d);
}

void describe(Description<Halt>& d) {
  d.about("Brakes to standstill; another command may take over on the way (MC_Halt).");
  d.defaulted<&Halt::deceleration>(unit::u_s2, positive, kDeceleration);
  d.defaulted<&Halt::jerk>(unit::u_s3, not_negative, kJerk);
  d.defaulted<&Halt::buffer_mode>("aborting or buffered.");
}

void describe(Description<Straighten>& d) {
  d.about(
      "Straightens a gantry: an axis that follows another from load on goes to where its master, which stands, has it. "
      "Done when the skew of the set points is 0.");
  d.defaulted<&Straighten::velocity>(unit::u_s, positive, "Largest velocity; unset: a tenth of the limit.");
}

void describe(Description<Stop>& d) {
  d.about("Brakes to standstill; nothing may take over until it is released (MC_Stop).");
  d.defaulted<&Stop::deceleration>(unit::u_s2, positive, kDeceleration);
  d.defaulted<&Stop::jerk>(unit::u_s3, not_negative, kJerk);
  d.defaulted<&Stop::hold>("True: stay in Stopping until released (Execute kept true). False: until at rest.");
  d.defaulted<&Stop::buffer_mode>("aborting or buffered.");
}

void describe(Description<Jog>& d) {
  d.about(
      "Moves as long as a key is held (GT_Jog). The direction pressed first wins; both must be let go before the next "
      "jog. Given again it changes the keys; done when both are let go and the axis is at rest.");
  d.defaulted<&Jog::forward>("The key for upwards.");
  d.defaulted<&Jog::backward>("The key for downwards.");
  d.defaulted<&Jog::velocity>(unit::u_s, positive, "How fast; unset: the axis' limit.");
  DescribeRamps(d);
}

}  // namespace takt::axis
