// Stops of an axis (MC_Stop) as levels: several commands may stop the axis and hold it stopped independently.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"

namespace takt::axis {

struct Context;
struct Request;
struct State;

// Invariants:
// - While any stop is held no command moves the axis: it is in Stopping or ErrorStop, or its loop is open. Power off,
//   faults, resets and emergency stops do not end a hold; its release or the end of its lease does.
// - The axis brakes on the ramp with the shortest time to rest; all stops are done at standstill.
// - A stop that is reported and not held is removed. While one is not reported a stop is in control.
struct StopRequest {
  Ticket ticket = 0;  // 0: of another component
  double lease_s = 0;
  std::uint64_t lease_end_cycle = 0;
  bool hold = false;
  bool reported = false;  // its final feedback has been reported
};

// The stops of an axis, or of a group of axes.
struct StopRequests {
  static constexpr std::size_t kMost = 8;
  std::array<StopRequest, kMost> of{};
  std::uint32_t count = 0;

  // Returns the oldest stop that is held; null if there is none.
  const StopRequest* Holder() const noexcept;
  // Adds a stop, or joins it to one with the same ticket. Returns false if there is no room.
  bool Add(const StopRequest& order) noexcept;
  // Ends a hold. Returns false if there is no stop with this ticket.
  bool LetGo(Ticket ticket) noexcept;
  // Extends a lease. Returns false if there is no stop with a lease and this ticket.
  bool Renew(const Cycle& cycle, Ticket ticket) noexcept;
  // Ends holds whose lease has expired. Returns true if this ended the last hold.
  bool EndLeases(const Cycle& cycle) noexcept;
  // Removes stops that are reported and not held.
  void Tidy() noexcept;
};

// Returns true if no command may move the axis until it is released.
bool IsHeldStopped(const State& s) noexcept;
// Returns true if the stop with this ticket is held.
bool HoldsStop(Ticket ticket, const State& s) noexcept;

// Adds a stop that takes control. If there is no room the axis brakes, but the stop is not held: error kBufferFull.
void BeginStop(const Context& c, const Request& request, State& s) noexcept;
// Adds another stop while the axis is stopping.
void JoinStop(const Context& c, const Request& request, State& s) noexcept;
// Adds a stop while there is no motion to brake: the drive becomes ready, the brake opens, or a voltage was output with
// the loop open. Buffered commands are aborted; the stop is done at once.
void StopAtOnce(const Context& c, const Request& request, State& s) noexcept;
// Handles an axis at rest: held stops are reported as done, the others one cycle later, so that Stopping is visible.
void ReportStopped(const Context& c, bool just_arrived, State& s) noexcept;
// Ends the stop in control before the axis is at rest; holds stay.
void EndStops(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
// Ends expired leases, and enters Stopping again if the axis is held and has reached Standstill (powered or reset
// since).
void FollowStops(const Context& c, State& s) noexcept;

void describe(Description<StopRequest>&);
void describe(Description<StopRequests>&);

}  // namespace takt::axis
