#include "takt/axis/commands/stream.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Description<Stream>& d) {
  using C = Stream;
  d.about(
      "Follows set points that come from outside, one stream_point after another, at 20 Hz to once a cycle. They are "
      "interpolated, and followed within the limits of the axis. Reached when the axis is on them. Ends with error "
      "3123 "
      "and a stop within limits when no set point has come for the timeout.");
  d.defaulted<&C::key>(
      "A number that the set points must carry: choose one of your own, so that no other client's are taken.");
  d.defaulted<&C::delay>(
      unit::s, between(0, 10),
      "How long after it came the first set point is due, the others by their times: what jitter and "
      "losses may take.");
  d.defaulted<&C::timeout>(unit::s, between(0.001, 60), "Longest time without a set point, from the first one on.");
  d.defaulted<&C::velocity>(unit::u_s, positive,
                            "Largest velocity of getting onto the set points; unset: the axis' limit.");
  DescribeRamps(d);
}

void describe(Description<StreamPoint>& d) {
  using C = StreamPoint;
  d.about(
      "A set point of the stream in control. Refused, and the stream goes on: a key of another stream (3120), a time "
      "that "
      "is over or there already (3121), a distance from the set point before that the axis cannot move in the time "
      "between them (3122), a position beyond a SW limit (8).");
  d.required<&C::position>(unit::u, "Where the axis is to be; rotary axes: in [0, modulus), by the shorter way.");
  d.defaulted<&C::velocity>(unit::u_s, "How fast it is there; unset: as the set points around it say.");
  d.defaulted<&C::time>(unit::s, "When, by any clock of the sender that goes on; unset: when it comes.");
  d.defaulted<&C::key>("That of the stream.");
}

}  // namespace takt::axis
