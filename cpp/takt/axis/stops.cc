#include "takt/axis/stops.h"

#include <algorithm>
#include <span>

#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

namespace {

std::span<StopRequest> All(State& s) {
  return {s.stops.of.data(), s.stops.count};
}
std::span<const StopRequest> All(const State& s) {
  return {s.stops.of.data(), s.stops.count};
}

void Note(const Context& c, const Request& r, bool stands, State& s) {
  if (s.stops.Add({r.ticket, r.lease_s, CycleIn(c.cycle, r.lease_s), r.hold, stands})) return;
  Report(c, r.ticket, FeedbackState::kError, ErrorId::kBufferFull);
}

StopRequest* Find(Ticket ticket, StopRequests& stops) {
  const auto end = stops.of.begin() + stops.count;
  const auto found = std::find_if(stops.of.begin(), end, [&](const StopRequest& o) { return o.ticket == ticket; });
  return found == end ? nullptr : &*found;
}

}  // namespace

const StopRequest* StopRequests::Holder() const noexcept {
  const auto found = std::find_if(of.begin(), of.begin() + count, [](const StopRequest& o) { return o.hold; });
  return found == of.begin() + count ? nullptr : &*found;
}

bool StopRequests::Add(const StopRequest& order) noexcept {
  if (StopRequest* const known = axis::Find(order.ticket, *this)) {  // another component has one at most
    known->hold |= order.hold;
    known->reported &= order.reported;
    return true;
  }
  if (count == kMost) return false;
  of[count++] = order;
  return true;
}

bool StopRequests::LetGo(Ticket ticket) noexcept {
  StopRequest* const order = axis::Find(ticket, *this);
  if (order == nullptr) return false;
  order->hold = false;
  Tidy();
  return true;
}

bool StopRequests::Renew(const Cycle& cycle, Ticket ticket) noexcept {
  StopRequest* const order = axis::Find(ticket, *this);
  if (order == nullptr || order->lease_s <= 0) return false;
  order->lease_end_cycle = CycleIn(cycle, order->lease_s);
  return true;
}

bool StopRequests::EndLeases(const Cycle& cycle) noexcept {
  const bool held = Holder() != nullptr;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (of[i].lease_s > 0 && cycle.count >= of[i].lease_end_cycle) of[i].hold = false;
  }
  Tidy();
  return held && Holder() == nullptr;
}

void StopRequests::Tidy() noexcept {
  const auto end = of.begin() + count;
  const auto kept = std::remove_if(of.begin(), end, [](const StopRequest& o) { return o.reported && !o.hold; });
  std::fill(kept, end, StopRequest{});
  count = static_cast<std::uint32_t>(kept - of.begin());
}

bool IsHeldStopped(const State& s) noexcept {
  return s.stops.count > 0 && s.stops.Holder() != nullptr;
}

bool HoldsStop(Ticket ticket, const State& s) noexcept {
  return std::ranges::any_of(All(s), [&](const StopRequest& o) { return o.ticket == ticket && o.hold; });
}

void BeginStop(const Context& c, const Request& r, State& s) noexcept {
  Note(c, r, false, s);
}

void JoinStop(const Context& c, const Request& r, State& s) noexcept {
  AbortBuffer(c, s);
  Report(c, r.ticket, FeedbackState::kActive);
  Note(c, r, false, s);
  if (s.motion.arrived) return;
  const double left_s = s.motion.profile.duration() - Elapsed(c, s) + c.cycle.period_s;
  trajectory::Profile sooner{s.setpoint};
  PlanStop(c.params, c.planner, s.setpoint, r.limits(), {}, sooner);
  if (sooner.duration() < left_s) StartMotion(sooner, sooner.end().position, FromCycleBefore(c), s);
}

void StopAtOnce(const Context& c, const Request& r, State& s) noexcept {
  AbortBuffer(c, s);
  Report(c, r.ticket, FeedbackState::kActive);
  Report(c, r.ticket, FeedbackState::kDone);
  if (r.hold) Note(c, r, true, s);
}

void ReportStopped(const Context& c, bool just_arrived, State& s) noexcept {
  for (StopRequest& order : All(s)) {
    if (order.reported || (just_arrived && !order.hold)) continue;
    Report(c, order.ticket, FeedbackState::kDone);
    order.reported = true;
  }
  s.stops.Tidy();
}

void EndStops(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  for (StopRequest& order : All(s)) {
    if (!order.reported) ReportEnd(c, order.ticket, feedback, error, s);
    order.reported = true;
  }
  s.stops.Tidy();
}

void FollowStops(const Context& c, State& s) noexcept {
  const bool lost = s.stops.EndLeases(c.cycle);
  // Without a release buffered motions must not begin, except another stop.
  if (lost && s.buffered > 0 && s.buffer[0].kind != RequestKind::kStop) AbortBuffer(c, s);
  const StopRequest* const holder = s.stops.Holder();
  const bool free = s.plc == PlcState::kStandstill && s.active.kind == RequestKind::kNone && !s.superimposed;
  if (holder == nullptr || !free) return;
  s.active = Request{};
  s.active.kind = RequestKind::kStop;
  s.active.ticket = holder->ticket;
  s.active.hold = true;
  Enter(s, PlcState::kStopping);
}

void describe(Description<StopRequest>& d) {
  using O = StopRequest;
  d.about("A command that stops the axis.");
  d.internal<&O::ticket>("Ticket of the command.");
  d.internal<&O::lease_s>(unit::s, "Lease after each renewal; 0: held until released.");
  d.internal<&O::lease_end_cycle>("Cycle in which the lease ends.");
  d.internal<&O::hold>("The axis is kept stopped.");
  d.internal<&O::reported>("Its final feedback has been reported.");
}

void describe(Description<StopRequests>& d) {
  using O = StopRequests;
  d.about("Commands that stop the axis.");
  d.internal<&O::of>("The commands, the oldest first.");
  d.internal<&O::count>("Number of commands.");
}

}  // namespace takt::axis
