// The step order of axes: masters before followers (EN-03).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "takt/engine/machine.h"

namespace takt::engine {

// An order of `count` components in which each comes after all its masters. All memory is allocated at construction, so
// that the order can be made anew within a cycle.
class Order {
 public:
  explicit Order(std::size_t count);

  // Makes the order by depth-first search. `master_of(i, k)` is the k-th master of i, or nothing if i has no more.
  // Returns false, and keeps the old order, if there is a loop.
  template <typename MasterOf>
  bool Make(const MasterOf& master_of) noexcept {
    Begin();
    for (std::uint32_t first = 0; first < marks_.size(); ++first) {
      if (marks_[first] == Mark::kNew) Open(first);
      while (depth_ > 0) {
        Visit& visit = path_[depth_ - 1];
        const std::optional<std::uint32_t> master = master_of(visit.component, visit.next++);
        if (!master) {
          Close();
        } else if (marks_[*master] == Mark::kOpen) {
          RecordCycle(*master);
          return false;
        } else if (marks_[*master] == Mark::kNew) {
          Open(*master);
        }
      }
    }
    sequence_.swap(made_);
    return true;
  }

  std::span<const std::uint32_t> sequence() const noexcept { return sequence_; }
  // Returns the members of the loop that the last Make found: each is a master of the next, the last one of the first.
  std::span<const std::uint32_t> loop() const noexcept { return {loop_.data(), loop_size_}; }

 private:
  enum class Mark : std::uint8_t { kNew, kOpen, kDone };
  struct Visit {
    std::uint32_t component;
    std::uint32_t next;  // index of the master to visit next
  };

  void Begin() noexcept;
  void Open(std::uint32_t component) noexcept;
  void Close() noexcept;
  void RecordCycle(std::uint32_t again) noexcept;

  std::vector<Mark> marks_;
  std::vector<Visit> path_;  // from the root of the search to the current component
  std::size_t depth_ = 0;
  std::vector<std::uint32_t> sequence_, made_, loop_;
  std::size_t made_size_ = 0, loop_size_ = 0;
};

// Returns the index of the axis that this axis follows by the machine file; nothing if it follows none.
std::optional<std::uint32_t> MasterOf(const Machine& machine, std::size_t axis);
// Returns the names of all masters that a cam module can follow: axes, belts, movers and their coordinates.
std::vector<std::string> MasterNames(const Machine& machine);
// Returns the index of the axis (or of the axis of the belt by set position) that the cam module of this axis follows;
// nothing if there is none.
std::optional<std::uint32_t> MasterOfModule(const Machine& machine, std::size_t axis);

}  // namespace takt::engine
