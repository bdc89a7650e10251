// Power, set_position and halts.
#include "takt/mover/admission.h"
#include "takt/mover/course.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

using planar::ObjectState;
using trajectory::Limits;

AdmissionResult CarryOut(const CommandContext& g, const Enable&) noexcept {
  switch (g.s.state) {
    case ObjectState::kEnabled:
      return Done();
    case ObjectState::kDisabled:
    case ObjectState::kDisabling:
    case ObjectState::kEnabling:
      if (!CanPartBeReady(g.c, g.s)) return Refused(ErrorId::kPartDisabled);
      Take(g, kPower);
      if (g.s.state != ObjectState::kEnabling) Enter(g.c, ObjectState::kEnabling, g.s);
      return {};
    default:
      return Refused(ErrorId::kState);
  }
}

AdmissionResult CarryOut(const CommandContext& g, const Disable&) noexcept {
  switch (g.s.state) {
    case ObjectState::kDisabled:
      return Done();
    case ObjectState::kErrorPending:
    case ObjectState::kError:
    case ObjectState::kResetting:
      g.s.aborts = true;
      return Done();
    default:
      break;
  }
  EndAll(g.c, false, FeedbackState::kAborted, ErrorId::kNone, g.s);
  Take(g, kPower);
  if (g.s.state == ObjectState::kEnabled) BringToRest(g.c, nullptr, g.s);
  if (g.s.state != ObjectState::kDisabling) Enter(g.c, ObjectState::kDisabling, g.s);
  return {};
}

AdmissionResult CarryOut(const CommandContext& g, const Reset&) noexcept {
  switch (g.s.state) {
    case ObjectState::kErrorPending:
      return Refused(ErrorId::kState);
    case ObjectState::kError:
      Take(g, kPower);
      Enter(g.c, ObjectState::kResetting, g.s);
      return {};
    case ObjectState::kResetting:
      Take(g, kPower);
      return {};
    default:
      return Done();  // nothing to reset
  }
}

AdmissionResult CarryOut(const CommandContext& g, const SetPosition& command) noexcept {
  if (g.s.state != ObjectState::kDisabled) return Refused(ErrorId::kState);
  planar::Spot at;
  const ErrorId why =
      FindSpot(g.c.params, *g.c.streets.parts, command.reference.view(), {{command.x, command.y}, command.c}, at);
  if (why != ErrorId::kNone) return Refused(why);
  const planar::Verdict room = planar::SetDown(g.c.index, {at.origin, command.c}, at.system, g.c.grounds);
  if (room.error != ErrorId::kNone) return Refused(room.error, room.object);
  if (const ObjectInfo object = FindCourseObstacle(g.c, at, command.c)) return Refused(ErrorId::kCollision, object);
  if (IsOnTrack(g.s)) g.s.mode = CommandMode::kFreeMovement;
  LeaveTrackNetwork(g.c, g.s);
  g.s.set_point[kC].position = command.c;
  CoordinateMove& turn = g.s.others.back();
  turn.profile = {g.s.set_point[kC], g.s.set_point[kC]};
  PutAt(at, g.s);
  Locate(g.c, g.s);
  return Done();
}

namespace {

// Halts a planet: the star detects it and brings the whole formation to rest; the formation persists.
AdmissionResult HaltPlanet(const CommandContext& g) {
  for (const Slot slot : {kMoveZ, kMoveA, kMoveB, kWait}) End(g.c, slot, FeedbackState::kAborted, ErrorId::kNone, g.s);
  AbortBuffered(g.c, g.s);
  g.s.buffer.releases = 0;
  BringToRest(g.c, nullptr, g.s);
  Take(g, kHalt);
  return {};
}

}  // namespace

AdmissionResult CarryOut(const CommandContext& g, const Halt& command) noexcept {
  if (g.s.state != ObjectState::kEnabled) return Refused(ErrorId::kMoverDisabled);
  if (IsPlanet(g.s)) return HaltPlanet(g);
  const MoveToPosition as{.deceleration = command.deceleration, .jerk = command.jerk};
  const Limits limits = LimitsOf(as, g.c.params.xy, g.s.limited_by);
  EndAll(g.c, false, FeedbackState::kAborted, ErrorId::kNone, g.s);
  BringToRest(g.c, &limits, g.s);
  Take(g, kHalt);
  if (!IsOnTrack(g.s)) return {Status::Ok(), DurationOf(g.s.plane.motion)};
  const planar::Rider& rider = g.c.rider();
  return {Status::Ok(), planar::Brake(rider.at, rider.pace.brakes()).ends_s.back()};
}

AdmissionResult CarryOut(const CommandContext& g, const HaltOnTrack& command) noexcept {
  State& s = g.s;
  if (const ErrorId why = Diagnose(s, Ask::kHaltOnTrack); why != ErrorId::kNone) return Refused(why);
  const MoveToPosition as{.deceleration = command.deceleration, .jerk = command.jerk};
  const Limits limits = LimitsOf(as, g.c.params.xy, s.limited_by);
  for (const Slot slot : {kPlane, kPassing}) End(g.c, slot, FeedbackState::kAborted, ErrorId::kNone, s);
  BringToRestOnTrack(g.c, limits, s);
  Take(g, kHaltOnTrack);
  const planar::Rider& rider = g.c.rider();
  return {Status::Ok(), planar::Brake(rider.at, rider.pace.brakes()).ends_s.back()};
}

}  // namespace takt::mover
