// Stops of an axis (MC_Stop) as levels: several commands may stop it and hold it stopped, each by itself.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"

namespace takt::axis {

struct Context;
struct Request;
struct State;

// Invariants:
// - While any of them holds nothing moves the axis: it is in Stopping, or the loop is open, or it is in ErrorStop.
//   Power off, faults, resets and emergency stops leave a hold as it is; only its release or its lease ends it.
// - The axis brakes along the one that brings it to rest soonest; all are done when it stands.
// - One that neither holds nor waits for standstill is forgotten. While one waits a stop is in control.
struct StopOrder {
  Ticket ticket = 0;  // 0: another component's
  double lease_s = 0;
  std::uint64_t lease_end_cycle = 0;
  bool hold = false;
  bool reported = false;  // its final feedback is out
};

// Of an axis, or of a group of axes.
struct StopOrders {
  static constexpr std::size_t kMost = 8;
  std::array<StopOrder, kMost> of{};
  std::uint32_t count = 0;

  // The one that has held for the longest time; null: none holds.
  const StopOrder* Holder() const noexcept;
  StopOrder* Find(Ticket ticket) noexcept;
  // Forgets those that neither hold nor wait.
  void Tidy() noexcept;
};

// Whether nothing may move the axis before it is released.
bool IsHeldStopped(const State& s) noexcept;
bool HoldsStop(Ticket ticket, const State& s) noexcept;

// A stop takes control. With no room for another one it holds nothing: error kBufferFull, braked all the same.
void BeginStop(const Context& c, const Request& request, State& s) noexcept;
// Another one while the axis stops already.
void JoinStop(const Context& c, const Request& request, State& s) noexcept;
// One with no motion to brake, while the drive gets ready or the brake opens: what waits for that is aborted.
void StopBeforeReady(const Context& c, const Request& request, State& s) noexcept;
// The axis stands. Those that hold are done; the others one cycle later, so that Stopping is seen.
void TellStopped(const Context& c, bool just_arrived, State& s) noexcept;
// The stop in control ends before the axis stands. What holds goes on holding.
void EndStops(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
// False: there is none of this ticket.
bool LetGoOfStop(Ticket ticket, State& s) noexcept;
bool RenewStop(const Context& c, Ticket ticket, State& s) noexcept;
// Leases, and back into Stopping what is held and has come to Standstill (powered or reset since).
void FollowStops(const Context& c, State& s) noexcept;

void describe(Description<StopOrder>&);
void describe(Description<StopOrders>&);

}  // namespace takt::axis
