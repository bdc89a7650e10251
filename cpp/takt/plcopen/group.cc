#include "takt/plcopen/group.h"

namespace takt::plcopen {

void MC_GroupStop::operator()() noexcept {
  hold = true;
  BlockOfGroup::operator()();
  if (!Execute) feedback().Release();
}

std::array<double, 6> MC_GroupReadActualPosition::Position() const noexcept {
  const group::Outputs& o = shown();
  return {o.actual_x, o.actual_y, o.actual_z, o.actual_a, o.actual_b, o.actual_c};
}

std::uint32_t MC_GroupReadConfiguration::Axis() const noexcept {
  const group::Outputs& o = shown();
  const std::array members{o.member1, o.member2, o.member3, o.member4, o.member5, o.member6, o.member7, o.member8};
  return IdentInGroup >= 1 && IdentInGroup <= members.size() ? members[IdentInGroup - 1] : 0;
}

}  // namespace takt::plcopen
