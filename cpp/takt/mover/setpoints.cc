// External set points.
#include "takt/mover/admission.h"
#include "takt/mover/follow_route.h"
#include "takt/mover/on_parts.h"

namespace takt::mover {

AdmissionResult CarryOut(const CommandContext& g, const StartExternalSetpointGeneration& command) noexcept {
  State& s = g.s;
  const bool alone = command.mode == SetpointMode::kAbsolute;
  if (command.mode == SetpointMode::kNone) return Refused(ErrorId::kParameter);
  const ErrorId why = Diagnose(s, alone ? Ask::kExternalAbsolute : Ask::kExternalRelative);
  if (why != ErrorId::kNone) return Refused(why);
  if (s.external.mode != SetpointMode::kNone) return Refused(ErrorId::kCommandMode);
  if (alone ? !IsResting(g.c, s) : IsOnRoute(s)) return Refused(ErrorId::kCommandMode);
  s.external = {};
  s.external.mode = command.mode;
  if (alone) {  // at rest, until the first set point arrives
    s.external.given = s.external.taken = s.set_point;
    s.mode = CommandMode::kExternalSetpointGeneration;
  }
  Take(g, kExternal);
  return {};
}

AdmissionResult CarryOut(const CommandContext& g, const SetExternalSetpoint& p) noexcept {
  External& external = g.s.external;
  if (external.mode == SetpointMode::kNone) return Refused(ErrorId::kCommandMode);
  double x = p.x, y = p.y;
  if (external.mode == SetpointMode::kAbsolute) {
    const ErrorId why = ToMoverSystem(g.c, g.s, p.reference, x, y);
    if (why != ErrorId::kNone) return Refused(why);
  }
  external.given = {{{x, p.velocity_x, p.acceleration_x},
                     {y, p.velocity_y, p.acceleration_y},
                     {p.z, p.velocity_z, p.acceleration_z},
                     {p.a, p.velocity_a, p.acceleration_a},
                     {p.b, p.velocity_b, p.acceleration_b},
                     {p.c, p.velocity_c, p.acceleration_c}}};
  external.fresh = true;
  return Done();
}

AdmissionResult CarryOut(const CommandContext& g, const StopExternalSetpointGeneration&) noexcept {
  State& s = g.s;
  if (s.external.mode == SetpointMode::kNone) return Refused(ErrorId::kCommandMode);
  End(g.c, kExternal, FeedbackState::kDone, ErrorId::kNone, s);
  EndAll(g.c, false, FeedbackState::kAborted, ErrorId::kNone, s);
  BringToRest(g.c, nullptr, s);
  Take(g, kStopExternal);
  return {Status::Ok(), DurationOf(s.plane.motion)};
}
}  // namespace takt::mover
