// Enabled or not, and where; and coming to rest.
#include "takt/mover/admission.h"

namespace takt::mover {

using planar::ObjectState;
using trajectory::Limits;

Answer CarryOut(const Given& g, const Enable&) noexcept {
  switch (g.s.state) {
    case ObjectState::kEnabled:
      return Done();
    case ObjectState::kDisabled:
    case ObjectState::kDisabling:
    case ObjectState::kEnabling:
      Take(g, kPower);
      if (g.s.state != ObjectState::kEnabling) Enter(g.c, ObjectState::kEnabling, g.s);
      return {};
    default:
      return Refused(ErrorId::kState);
  }
}

Answer CarryOut(const Given& g, const Disable&) noexcept {
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

Answer CarryOut(const Given& g, const Reset&) noexcept {
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

Answer CarryOut(const Given& g, const SetPosition& command) noexcept {
  if (g.s.state != ObjectState::kDisabled) return Refused(ErrorId::kState);
  const planar::Verdict room = planar::SetDown(g.c.index, {{command.x, command.y}, command.c}, g.c.grounds);
  if (room.error != ErrorId::kNone) return Refused(room.error, room.object);
  g.s.set_point[kX].position = command.x;
  g.s.set_point[kY].position = command.y;
  g.s.set_point[kC].position = command.c;
  g.s.plane.motion = StandingAt(command.x, command.y);
  if (IsOnTrack(g.s)) g.s.mode = CommandMode::kFreeMovement;
  LeaveStreets(g.c, g.s);
  CoordinateMove& turn = g.s.others.back();
  turn.profile = {g.s.set_point[kC], g.s.set_point[kC]};
  return Done();
}

Answer CarryOut(const Given& g, const Halt& command) noexcept {
  if (g.s.state != ObjectState::kEnabled) return Refused(ErrorId::kMoverDisabled);
  const MoveToPosition as{.deceleration = command.deceleration, .jerk = command.jerk};
  const Limits limits = LimitsOf(as, g.c.params.xy, g.s.limited_by);
  EndAll(g.c, false, FeedbackState::kAborted, ErrorId::kNone, g.s);
  BringToRest(g.c, &limits, g.s);
  Take(g, kHalt);
  return {Status::Ok(), DurationOf(g.s.plane.motion)};
}

}  // namespace takt::mover
