#include "takt/engine/order.h"

#include <algorithm>
#include <numeric>

namespace takt::engine {

Order::Order(std::size_t count) : marks_(count), path_(count), sequence_(count), made_(count), loop_(count) {
  std::iota(sequence_.begin(), sequence_.end(), 0u);
}

void Order::Begin() noexcept {
  std::fill(marks_.begin(), marks_.end(), Mark::kNew);
  depth_ = made_size_ = loop_size_ = 0;
}

void Order::Open(std::uint32_t component) noexcept {
  marks_[component] = Mark::kOpen;
  path_[depth_++] = {component, 0};
}

void Order::Close() noexcept {
  const std::uint32_t component = path_[--depth_].component;
  marks_[component] = Mark::kDone;
  made_[made_size_++] = component;
}

// The path leads from followers to masters, and reaches `again` a second time.
void Order::RecordCycle(std::uint32_t again) noexcept {
  while (depth_ > 0) {
    const std::uint32_t member = path_[--depth_].component;
    loop_[loop_size_++] = member;
    if (member == again) break;
  }
}

namespace {

std::optional<std::uint32_t> Named(const Machine& machine, std::string_view name) {
  const std::uint32_t axis = axis::FindAxis(machine.axes, name);
  return axis != axis::kNoAxis ? std::optional(axis) : std::nullopt;
}

}  // namespace

std::optional<std::uint32_t> MasterOf(const Machine& machine, std::size_t axis) {
  const std::optional<axis::Following>& follows = machine.axes[axis].follows;
  return follows ? Named(machine, follows->axis) : std::nullopt;
}

std::vector<std::string> MasterNames(const Machine& machine) {
  std::vector<std::string> names;
  for (const axis::AxisParams& axis : machine.axes) names.push_back(axis.name);
  for (const conveyor::BeltParams& belt : machine.belts) names.push_back(belt.name);
  for (const mover::MoverParams& mover : machine.movers) {
    for (const char* suffix : {"", ".x", ".y", ".c"}) names.push_back(mover.name + suffix);
  }
  return names;
}

std::optional<std::uint32_t> MasterOfModule(const Machine& machine, std::size_t axis) {
  for (const flexcam::FlexCamParams& module : machine.flex_cams) {
    if (module.slave != machine.axes[axis].name || !module.master) continue;
    for (const conveyor::BeltParams& belt : machine.belts) {
      if (belt.name == *module.master && !IsMeasured(belt)) return Named(machine, belt.axis);
    }
    return Named(machine, *module.master);
  }
  return std::nullopt;
}

}  // namespace takt::engine
