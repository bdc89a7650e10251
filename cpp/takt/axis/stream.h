// Set points that are streamed from outside (AX-114): any rate, jitter, losses, a clock of the sender's own.
//
// The first set point is due `delay` after it came, the others by their times after it. Between two of them the axis
// goes by a cubic through both positions and velocities (Hermite); where the sender gives no velocities, by those of
// the chords (Catmull-Rom). A velocity is fixed when the curve first uses it, so the curve has no step in position or
// velocity whenever the next set point comes. What it asks for is followed as a master is
// (trajectory/demand_follower.h): within limits, whatever was sent. Behind the last set point it goes on with its
// velocity until the timeout.
#pragma once

#include <array>
#include <cstdint>

#include "takt/axis/request.h"
#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/demand_follower.h"

namespace takt::axis {

struct Context;
struct State;

inline constexpr std::size_t kStreamed = 32;  // set points that are kept

struct StreamedPoint {
  double time = 0;      // [s] by the sender's clock
  double position = 0;  // [u] over all turns
  double velocity = 0;  // [u/s]
  bool fixed = false;   // its velocity was given, or the curve has used it
};

struct StreamState {
  std::array<StreamedPoint, kStreamed> points;  // by time; the curve is between the first two
  std::uint8_t count = 0;
  double clock = 0;               // [s] by the sender's clock: the end of this cycle is that far along the stream
  std::uint64_t heard_cycle = 0;  // when the last set point was taken
  trajectory::DemandFollowerState chase;
};

inline bool Streams(RequestKind kind) noexcept {
  return kind == RequestKind::kStream;
}
// What a stream asks for now, over all turns. Requires: it has a set point.
KinematicState DemandAt(StreamState& k) noexcept;
// The slot of a set point by its time; kStreamLate: the time has passed or has a set point already.
struct StreamSlot {
  ErrorId error = ErrorId::kNone;
  std::size_t place = 0;
};
StreamSlot SlotOf(const StreamState& k, double time) noexcept;
// Keeps a set point there, and follows the sender's clock, so that the stream stays `delay` behind it.
void Keep(const Cycle& cycle, const StreamedPoint& point, std::size_t place, double delay, StreamState& k) noexcept;
// Faster than an axis with this velocity by so much: a set point jumps.
inline constexpr double kStreamJumpFactor = 1.5;

// Puts a stream in control. What was in control must have been ended.
void BeginStream(const Context& c, const Request& r, State& s) noexcept;
// The next set point; false: it has ended, the motion in progress counts.
bool FollowStream(const Context& c, State& s) noexcept;

Status CarryOut(const Context& c, Ticket ticket, const StreamPoint& command, State& s) noexcept;

void describe(Description<StreamedPoint>&);
void describe(Description<StreamState>&);

}  // namespace takt::axis
