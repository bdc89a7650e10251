#include "takt/axis/commands/stream.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Description<Stream>& d) {
  using C = Stream;
  d.about(
      "Follows set points from outside, given by stream_point commands, at 20 Hz to once a cycle. They are "
      "interpolated, and followed within the limits of the axis. Reached when the axis is in step with them. Ends with "
      "error 3123 and a stop within limits if no set point arrives within the timeout.");
  d.defaulted<&C::key>(
      "Number that the set points must carry. A number of the client's own keeps out set points of other clients.");
  d.defaulted<&C::delay>(unit::s, between(0, 10),
                         "Time from the arrival of the first set point until it is due; the others are due by their "
                         "times. It covers jitter and losses.");
  d.defaulted<&C::timeout>(unit::s, between(0.001, 60), "Longest time without a set point, from the first one on.");
  d.defaulted<&C::velocity>(unit::u_s, positive,
                            "Largest velocity of synchronising with the set points; unset: the axis' limit.");
  DescribeRamps(d);
}

void describe(Description<StreamPoint>& d) {
  using C = StreamPoint;
  d.about(
      "A set point of the stream in control. Refused, while the stream continues: a key of another stream (3120), a "
      "time that has passed or is taken (3121), a distance from the previous set point that the axis cannot move in "
      "the time between them (3122), a position beyond a SW limit (8).");
  d.required<&C::position>(unit::u,
                           "Position of the axis; rotary axes: in [0, modulus), reached over the shorter distance.");
  d.defaulted<&C::velocity>(unit::u_s, "Velocity at that position; unset: from the neighbouring set points.");
  d.defaulted<&C::time>(unit::s,
                        "Time of the set point, by any monotonic clock of the sender; unset: the time of arrival.");
  d.defaulted<&C::key>("Key of the stream.");
}

}  // namespace takt::axis
