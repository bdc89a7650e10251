#include "takt/group/track.h"

#include <cmath>
#include <numbers>

#include "takt/core/angle.h"
#include "takt/core/maths.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/clutch.h"
#include "takt/group/members.h"
#include "takt/group/plan.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

constexpr double kCenter = 1e-6;       // [mm] from the axis of a table: the angle is undefined
constexpr double kBackwards = -1e-9;   // [mm/s or rad/s]
constexpr double kRoundingWay = 1e-9;  // [mm or rad]

// Returns the travel since the recorded position, in the direction in which the carrier is expected to move.
double Progress(const Track& track, const kinematics::Carrier& carrier) {
  return track.sense * (carrier.travel.position - track.cargo.from);
}

ErrorId Check(const Context& c, const State& s, const Track& track, const kinematics::Carrier& carrier) {
  if (!HasTool(c, s)) return ErrorId::kState;
  if (carrier.kind != track.kind) return ErrorId::kUnknownTarget;
  if (track.begin > track.end) return ErrorId::kTrackOrder;
  if (track.end - track.begin < track.in_distance) return ErrorId::kTrackShort;
  if (track.sense * carrier.travel.velocity < kBackwards) return ErrorId::kBeltBackwards;
  return ErrorId::kNone;
}

void TakeMode(ExecutionMode mode, const State& s, Track& track) {
  track.behind = 0;
  if (mode == ExecutionMode::kImmediately || s.queue.count == 0) return;
  track.behind = mode == ExecutionMode::kDelayed ? s.done : s.done + s.queue.count - 1;
}

ErrorId Begin(const Context& c, Ticket ticket, std::uint32_t pcs, double offset, const Track& track, State& s) {
  const ErrorId error = Check(c, s, track, CarrierOf(c, track.cargo));
  if (error != ErrorId::kNone) return error;
  EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
  s.track = track;
  s.track.begin += offset;
  s.track.ticket = ticket;
  s.cargoes[pcs - 1] = track.cargo;
  Report(c, ticket, FeedbackState::kBusy);
  return ErrorId::kNone;
}

// Returns the travel of the carrier at which the object would be at the present position of the tool, along the travel.
double TravelOfTool(const Track& track, const kinematics::Carrier& carrier, const Frame& tool) {
  const KDL::Vector there = carrier.origin.Inverse() * tool.p;
  const kinematics::Pose& on = track.cargo.lies;
  if (carrier.kind == kinematics::CarrierKind::kStraight) return track.cargo.from + there.x() - on.x;
  const double now = carrier.travel.position;
  if (maths::Hypot(there.x(), there.y()) < kCenter || maths::Hypot(on.x, on.y) < kCenter) return now;
  const double angle = track.cargo.from + maths::Atan2(there.y(), there.x()) - maths::Atan2(on.y, on.x);
  return now + std::remainder(angle - now, 2 * std::numbers::pi);
}

// Binds the tool to the object's carrier; the clutch brings it into sync.
void SitDownOnObject(const Context& c, const kinematics::Carrier& carrier, State& s) {
  const ErrorId error = TakeMembers(c, s);
  if (error != ErrorId::kNone) return EndTracking(c, FeedbackState::kError, error, s);
  Track& track = s.track;
  Clutch clutch;
  // Start of tracking, if it was passed just now.
  const double begin = track.cargo.from + track.sense * track.begin;
  const double passed = std::abs(carrier.travel.position - begin);
  const bool just = passed <= 2 * c.cycle.period_s * std::abs(carrier.travel.velocity);
  clutch.law_begin = just ? begin : carrier.travel.position;
  clutch.law_length = track.sense * track.in_distance;
  const bool given = track.in_distance > 0 && track.in_tool > 0;
  clutch.travel.position = given ? clutch.law_begin + clutch.law_length - track.sense * track.in_tool
                                 : TravelOfTool(track, carrier, Present(c, s).tool);
  clutch.law_from = clutch.travel.position;
  clutch.law_way = clutch.law_begin + clutch.law_length - clutch.law_from;
  Clutch& seated = BindAtRest(c, track.cargo, clutch.travel.position, s);
  clutch.used = true;
  clutch.ride = seated.ride;
  seated = clutch;
  const Stretch& seat = c.ahead[c.ahead.first];
  SetLimits(LimitsAlong(c, s, seat, seat.from, clutch.ride, carrier.travel, kAhead_s * carrier.travel.velocity),
            seated);
  track.started = track.boarded = true;
}

void Wait(const Context& c, const kinematics::Carrier& carrier, State& s) {
  const double progress = Progress(s.track, carrier);
  if (progress < s.track.begin) return;
  if (progress > s.track.end) return EndTracking(c, FeedbackState::kError, ErrorId::kTrackShort, s);
  if (s.ends) return;
  const bool by_move = s.planning.move < s.done + s.queue.count && WaitsForTracking(s, MoveAt(s, s.planning.move));
  if (by_move && IsOnCarrier(c, s) && s.planning.move == s.done) {  // from one carrier to the next
    s.track.started = true;
    return;
  }
  if (s.begun || s.queue.count > 0 || s.planning.stage != Stage::kIdle) {  // it comes to rest first
    bool waits = !s.begun;
    for (std::uint32_t i = 0; i < s.queue.count; ++i) waits &= WaitsForTracking(s, MoveAt(s, s.done + i));
    if (!waits) {
      AbortMoves(c, ErrorId::kNone, s);
      return EndMotion(c, {}, true, s);
    }
  }
  SitDownOnObject(c, carrier, s);
}

Clutch* ClutchOf(const Context& c, State& s) {
  for (Clutch& clutch : s.clutches) {
    if (clutch.used && c.ahead.rides[clutch.ride % kRides].cargo == s.track.cargo) return &clutch;
  }
  return nullptr;
}

// The object leaves the range of tracking.
void Leave(const Context& c, double distance, double of_tool, State& s) {
  AbortMoves(c, ErrorId::kNone, s);
  EndMotion(c, {}, true, s);
  s.track.ends = true;
  if (Clutch* clutch = ClutchOf(c, s); clutch && distance > 0) {
    clutch->law_begin = clutch->travel.position;
    clutch->law_length = s.track.sense * distance;
    clutch->law_from = clutch->travel.position;
    clutch->law_way = s.track.sense * (of_tool > 0 ? of_tool : 0.5 * distance);
  }
}

}  // namespace

ErrorId BeginTracking(const Context& c, Ticket ticket, const TrackConveyorBelt& m, State& s) noexcept {
  Track track;
  CarriedTarget& cargo = track.cargo;
  cargo.carrier = c.carriers.Find(m.belt.view());
  if (cargo.carrier == 0) return ErrorId::kUnknownTarget;
  cargo.lies = {m.x, m.y, m.z, m.a, m.b, m.c};
  cargo.has_origin = m.origin_x || m.origin_y || m.origin_z || m.origin_a || m.origin_b || m.origin_c;
  if (cargo.has_origin) {
    cargo.origin = {m.origin_x.value_or(0), m.origin_y.value_or(0), m.origin_z.value_or(0),
                    m.origin_a.value_or(0), m.origin_b.value_or(0), m.origin_c.value_or(0)};
  }
  cargo.from = m.recorded_position ? c.carriers.TravelAt(cargo.carrier, *m.recorded_position)
                                   : c.carriers.At(cargo.carrier).travel.position;
  track.begin = m.start_distance;
  track.end = m.end_distance.value_or(std::numeric_limits<double>::infinity());
  track.in_distance = m.sync_in_conveyor_distance.value_or(0);
  track.in_tool = m.sync_in_tcp_distance.value_or(0);
  track.out_distance = m.sync_out_conveyor_distance.value_or(0);
  track.out_tool = m.sync_out_tcp_distance.value_or(0);
  TakeMode(m.execution_mode, s, track);
  return Begin(c, ticket, m.pcs, m.x, track, s);
}

ErrorId BeginTracking(const Context& c, Ticket ticket, const TrackRotaryTable& m, State& s) noexcept {
  Track track;
  CarriedTarget& cargo = track.cargo;
  cargo.carrier = c.carriers.Find(m.table.view());
  if (cargo.carrier == 0) return ErrorId::kUnknownTarget;
  cargo.lies = {m.x, m.y, m.z, m.a, m.b, m.c};
  const kinematics::Carrier carrier = c.carriers.At(cargo.carrier);
  cargo.from = m.recorded_position ? c.carriers.TravelAt(cargo.carrier, *m.recorded_position) : carrier.travel.position;
  track.kind = kinematics::CarrierKind::kTurning;
  track.sense = carrier.travel.velocity < 0 ? -1 : 1;
  track.begin = kDegree * m.start_angle;
  track.end = m.end_angle ? kDegree * *m.end_angle : std::numeric_limits<double>::infinity();
  track.in_distance = kDegree * m.sync_in_angle.value_or(0);
  track.out_distance = kDegree * m.sync_out_angle.value_or(0);
  TakeMode(m.execution_mode, s, track);
  return Begin(c, ticket, m.pcs, 0, track, s);
}

void StepTracking(const Context& c, State& s) noexcept {
  Track& track = s.track;
  if (track.ticket == 0) return;
  if (!track.active) {
    if (s.done <= track.behind && s.queue.count > 0) return;
    track.active = true;
    Report(c, track.ticket, FeedbackState::kActive);
  }
  const kinematics::Carrier carrier = CarrierOf(c, track.cargo);
  if (!track.started) return Wait(c, carrier, s);
  if (track.ends) return;
  const double progress = Progress(track, carrier);
  if (progress < track.begin - kRoundingWay) Leave(c, 0, 0, s);
  if (progress >= track.end) Leave(c, track.out_distance, track.out_tool, s);
}

void WatchTracking(const Context& c, State& s) noexcept {
  Track& track = s.track;
  if (track.ticket == 0 || !track.started) return;
  if (!s.begun) {
    return EndTracking(c, track.ends ? FeedbackState::kDone : FeedbackState::kAborted, ErrorId::kNone, s);
  }
  const Stretch* stretch = Here(c, s);
  const auto is_ours = [&](std::uint64_t ride) { return c.ahead.rides[ride % kRides].cargo == track.cargo; };
  if (!track.boarded) {
    track.boarded = stretch && is_ours(stretch->to_ride);
    if (!track.boarded && s.queue.count == 0) EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
    return;
  }
  if (stretch && !is_ours(stretch->to_ride)) return EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
  const Clutch* clutch = ClutchOf(c, s);
  if (!clutch || track.ends) return;
  const double apart = std::abs(clutch->travel.position - CarrierOf(c, track.cargo).travel.position);
  const TrackingParams& params = c.params.tracking;
  const bool near = clutch->coupled || (clutch->law_length == 0 && apart <= params.tolerance && params.tolerance > 0);
  track.near_cycles = near && AreAtDemand(c, s) ? track.near_cycles + 1 : 0;
  const bool was = track.in_sync;
  track.in_sync =
      track.near_cycles > 0 && static_cast<double>(track.near_cycles) * c.cycle.period_s >= params.tolerance_time_s;
  if (track.in_sync != was) {
    c.feedback.Report({track.ticket, c.cycle.count, FeedbackState::kActive, track.in_sync, ErrorId::kNone, 0});
  }
}

void EndTracking(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  if (s.track.ticket != 0) Report(c, s.track.ticket, feedback, error);
  s.track = {};
}

bool WaitsForTracking(const State& s, const Request& move) noexcept {
  return s.track.ticket != 0 && !s.track.started && move.cargo == s.track.cargo;
}

TrackState TrackStateOf(const Context& c, const State& s) noexcept {
  if (!IsOnCarrier(c, s)) return s.track.active && !s.track.started ? TrackState::kWaiting : TrackState::kNone;
  if (s.lets_go) return TrackState::kDesynchronizing;
  const Stretch& stretch = *Here(c, s);
  if (IsInTransition(c, s)) {
    const bool to = Moves(c.ahead.rides[stretch.to_ride % kRides]);
    return to ? TrackState::kSynchronizing : TrackState::kDesynchronizing;
  }
  if (s.track.started) return s.track.in_sync ? TrackState::kInSync : TrackState::kSynchronizing;
  return IsUncoupled(s) || !AreAtDemand(c, s) ? TrackState::kSynchronizing : TrackState::kInSync;
}

}  // namespace takt::group
