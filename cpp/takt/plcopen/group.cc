#include "takt/plcopen/group.h"

namespace takt::plcopen {

namespace {

bool IsProduct(std::uint32_t pcs) noexcept {
  return pcs >= 1 && pcs <= group::kProductSystems;
}

// Returns the frame of a system in the machine coordinate system; empty if there is no such system, or it has no frame.
std::optional<kinematics::Frame> FrameOf(group::CoordinateSystem system, std::uint32_t pcs, const group::Outputs& now,
                                         const group::GroupParams& params) noexcept {
  using group::CoordinateSystem;
  if (system == CoordinateSystem::kMcs) return kinematics::Frame::Identity();
  if (system == CoordinateSystem::kWcs) return kinematics::ToFrame(params.base).Inverse();
  if (system != CoordinateSystem::kPcs || !IsProduct(pcs)) return std::nullopt;
  return kinematics::ToFrame(now.*group::kPublishedSystems[pcs - 1]);
}

}  // namespace

void MC_GroupStop::operator()() noexcept {
  hold = true;
  BlockOfGroup::operator()();
  if (!Execute) feedback().Release();
}

void MC_SyncAxisToGroup::operator()() noexcept {
  if (Rises()) {
    slave_ = axis::FindAxis(AxesGroup().program().engine().machine().axes, axis.view());
    StartWith(*this);
  }
  Show();
}

bool MC_SyncAxisToGroup::InSync() const noexcept {
  return CommandInControl() && slave_ != axis::kNoAxis && AxesGroup().program().engine().outputs(slave_).in_step;
}

std::array<double, 6> MC_GroupReadActualPosition::Position() const noexcept {
  const group::Outputs& o = shown();
  return {o.actual_x, o.actual_y, o.actual_z, o.actual_a, o.actual_b, o.actual_c};
}

void MC_ReadCoordinateTransform::operator()() noexcept {
  GroupReadBlock::operator()();
  const group::GroupParams& params = subject().params();
  const auto product = FrameOf(group::CoordinateSystem::kPcs, Pcs, shown(), params);
  const auto reference = FrameOf(Reference, ReferencePcs, shown(), params);
  found_.reset();
  if (!GroupReadBlock::Valid() || !product || !reference) return;
  // The pose as it was given, not another pose of the same frame.
  found_ = Reference == group::CoordinateSystem::kMcs ? shown().*group::kPublishedSystems[Pcs - 1]
                                                      : kinematics::ToPose(reference->Inverse() * *product);
}

std::uint32_t MC_GroupReadConfiguration::Axis() const noexcept {
  const group::Outputs& o = shown();
  const std::array members{o.member1, o.member2, o.member3, o.member4, o.member5, o.member6, o.member7, o.member8};
  return IdentInGroup >= 1 && IdentInGroup <= members.size() ? members[IdentInGroup - 1] : 0;
}

}  // namespace takt::plcopen
