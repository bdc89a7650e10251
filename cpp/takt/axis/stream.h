// Set points streamed from outside (AX-114): at any rate, with jitter, losses and a clock of the sender's own.
//
// The first set point is due `delay` after its arrival, the others by their times after it. Between two of them the
// axis follows a cubic through both positions and velocities (Hermite); if the sender gives no velocities, with those
// of the chords (Catmull-Rom). A velocity is fixed when the curve first uses it, so the curve has no step in position
// or velocity whenever the next set point arrives. The curve is followed like a master (trajectory/demand_follower.h):
// within limits, whatever was sent. Beyond the last set point it continues at its velocity until the timeout.
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

inline constexpr std::size_t kStreamed = 32;  // set points that are buffered

struct StreamedPoint {
  double time = 0;      // [s] by the sender's clock
  double position = 0;  // [u] over all turns
  double velocity = 0;  // [u/s]
  bool fixed = false;   // the velocity was given, or the curve has used it
};

struct StreamState {
  std::array<StreamedPoint, kStreamed> points;  // by time; the curve is between the first two
  std::uint8_t count = 0;
  double clock = 0;               // [s] by the sender's clock: time in the stream at the end of this cycle
  std::uint64_t heard_cycle = 0;  // cycle of the last accepted set point
  trajectory::DemandFollowerState chase;
};

inline bool Streams(RequestKind kind) noexcept {
  return kind == RequestKind::kStream;
}
// Returns the demand of the stream now, over all turns. Requires: it has a set point.
KinematicState DemandAt(StreamState& k) noexcept;
// Index at which a set point is to be inserted by its time. kStreamLate: the time has passed or is taken; kBufferFull:
// there is no room.
struct StreamSlot {
  ErrorId error = ErrorId::kNone;
  std::size_t place = 0;
};
StreamSlot SlotOf(const StreamState& k, double time) noexcept;
// Inserts a set point at index `place`, and adjusts the clock to the sender's, so that the stream stays `delay` behind.
void Keep(const Cycle& cycle, const StreamedPoint& point, std::size_t place, double delay, StreamState& k) noexcept;
// A set point jumps if it requires more than this many times the velocity limit of the axis.
inline constexpr double kStreamJumpFactor = 1.5;

// Puts a stream in control. Requires: the command that was in control has been ended.
void BeginStream(const Context& c, const Request& r, State& s) noexcept;
// Computes the next set point. Returns false if the stream has ended: the motion in progress then gives it.
bool FollowStream(const Context& c, State& s) noexcept;

Status CarryOut(const Context& c, Ticket ticket, const StreamPoint& command, State& s) noexcept;

void describe(Description<StreamedPoint>&);
void describe(Description<StreamState>&);

}  // namespace takt::axis
