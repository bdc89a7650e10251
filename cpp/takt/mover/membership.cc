// Membership of a mover in a group.
#include "takt/mover/admission.h"
#include "takt/mover/area_reservation.h"

namespace takt::mover {

AdmissionResult CarryOut(const CommandContext& g, const AddToGroup& command) noexcept {
  const std::uint32_t group = g.c.grounds.Find(command.group.view());
  if (group == 0) return Refused(ErrorId::kParameter);
  Stand(g.c, g.s);
  const planar::Verdict verdict = planar::AddMover(g.c.index, group, g.c.grounds);
  return verdict.error == ErrorId::kNone ? Done() : Refused(verdict.error, verdict.object);
}

AdmissionResult CarryOut(const CommandContext& g, const RemoveFromGroup&) noexcept {
  const planar::Verdict verdict = planar::RemoveMover(g.c.index, g.c.grounds);
  return verdict.error == ErrorId::kNone ? Done() : Refused(verdict.error, verdict.object);
}

}  // namespace takt::mover
