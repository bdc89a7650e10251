#include "takt/engine/order.h"

#include <algorithm>

namespace takt::engine {

namespace {

enum class Mark : std::uint8_t { kNew, kOpen, kDone };

// Depth first; `path` holds the components between the first one asked and the one at hand.
class Sorter {
 public:
  explicit Sorter(std::span<const std::vector<std::uint32_t>> masters)
      : masters_(masters), marks_(masters.size(), Mark::kNew) {}

  bool Visit(std::uint32_t i) {
    if (marks_[i] == Mark::kDone) return true;
    path.push_back(i);
    if (marks_[i] == Mark::kOpen) return false;
    marks_[i] = Mark::kOpen;
    for (const std::uint32_t master : masters_[i]) {
      if (!Visit(master)) return false;
    }
    path.pop_back();
    marks_[i] = Mark::kDone;
    order.push_back(i);
    return true;
  }

  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> path;

 private:
  std::span<const std::vector<std::uint32_t>> masters_;
  std::vector<Mark> marks_;
};

}  // namespace

std::optional<std::vector<std::uint32_t>> OrderByMasters(std::span<const std::vector<std::uint32_t>> masters,
                                                         std::vector<std::uint32_t>& loop) {
  Sorter sorter(masters);
  for (std::uint32_t i = 0; i < masters.size(); ++i) {
    if (sorter.Visit(i)) continue;
    // The path ends with the component that was met a second time; the loop begins where it was met first.
    const auto first = std::find(sorter.path.begin(), sorter.path.end(), sorter.path.back());
    loop.assign(first, sorter.path.end() - 1);
    std::reverse(loop.begin(), loop.end());
    return std::nullopt;
  }
  return sorter.order;
}

std::vector<std::vector<std::uint32_t>> MastersOf(const Machine& machine) {
  std::vector<std::vector<std::uint32_t>> masters(machine.axes.size());
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (const std::optional<std::uint32_t> master = MasterOf(machine, i)) masters[i].push_back(*master);
  }
  return masters;
}

std::optional<std::uint32_t> MasterOf(const Machine& machine, std::size_t axis) {
  const std::optional<axis::Following>& follows = machine.axes[axis].follows;
  for (std::uint32_t k = 0; follows && k < machine.axes.size(); ++k) {
    if (machine.axes[k].name == follows->axis) return k;
  }
  return std::nullopt;
}

}  // namespace takt::engine
