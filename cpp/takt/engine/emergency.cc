#include "takt/engine/emergency.h"

#include <algorithm>
#include <type_traits>

#include "takt/axis/axis.h"

namespace takt::engine {

bool EmergencyHolders::Add(Ticket ticket) noexcept {
  if (count_ == kMost) return false;
  tickets_[count_++] = ticket;
  return true;
}

bool EmergencyHolders::Remove(Ticket ticket) noexcept {
  const auto end = tickets_.begin() + count_;
  const auto kept = std::remove(tickets_.begin(), end, ticket);
  const auto removed = end - kept;
  count_ -= static_cast<std::uint32_t>(removed);
  return removed > 0;
}

namespace {

template <typename T, typename... Kinds>
constexpr bool kIsOneOf = (std::is_same_v<T, Kinds> || ...);

// For each kind of component: every command requests motion except those listed.
bool Asks(const axis::Command& command) {
  return axis::AsksToMove(command);
}

bool Asks(const flexcam::Command& command) {
  return std::visit(
      []<typename T>(const T& body) {
        if constexpr (std::is_same_v<T, flexcam::Control>) return flexcam::AsksToMove(body);
        return std::is_same_v<T, flexcam::Jog>;
      },
      command);
}

bool Asks(const pickplace::Command& command) {
  return std::visit(
      []<typename T>(const T& body) {
        if constexpr (std::is_same_v<T, pickplace::Control>) return pickplace::AsksToMove(body);
        return std::is_same_v<T, pickplace::Jog>;
      },
      command);
}

bool Asks(const group::Command& command) {
  return std::visit(
      []<typename T>(const T&) {
        return !kIsOneOf<T, group::AddAxis, group::RemoveAxis, group::UngroupAllAxes, group::Enable, group::Disable,
                         group::Reset, group::SetPosition, group::SetOverride, group::SetKinTransform,
                         group::SetCartesianTransform, group::SetCoordinateTransform, group::SetDynCoordTransform,
                         group::SetTool, group::Calibrate, group::PathChecked, group::PathPlanned>;
      },
      command);
}

bool Asks(const mover::Command& command) {
  return std::visit(
      []<typename T>(const T&) {
        return !kIsOneOf<T, mover::Reset, mover::SetPosition, mover::AddToGroup, mover::RemoveFromGroup,
                         mover::LeaveFormation, mover::SetRoute>;
      },
      command);
}

bool Asks(const MachineCommand& command) {
  return std::holds_alternative<mover::StartRoutes>(command) || std::holds_alternative<mover::HoldRoutes>(command);
}

bool Asks(const part::Command& command) {
  return std::holds_alternative<part::ActivatePosition>(command);
}

// Belts, poses, tracks, groups of movers, environments: they cause no motion by themselves.
template <typename Other>
bool Asks(const Other&) {
  return false;
}

}  // namespace

bool AsksToMove(const Command& command) noexcept {
  return !LetsGo(command) && std::visit([](const auto& body) { return Asks(body); }, command.body);
}

}  // namespace takt::engine
