// Axes along a path to be checked (path_check_request.h), computed again outside the cycle: all elements of the move in
// full, and the blends at their corners, so that every way in which a corner may be passed is checked (except short
// chords: join.h). Allocates.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "takt/group/group.h"
#include "takt/workspace/checker.h"

namespace takt::group {

// Data of a group that do not change while the machine runs, except the tool, which each request has.
struct Fixed {
  const GroupParams& params;
  Mounting mounting;
  const kinematics::Kinematics& kinematics;
  std::span<const PathTable> paths{};
  Cycle cycle;
};

class Survey {
 public:
  explicit Survey(const Fixed& fixed);
  ~Survey();

  struct Part {
    std::uint32_t element = 0;  // of a path, from 1; 0: no path
    bool on_blend = false;      // into the move, or into that element; else after it
    path::Measure measure = path::Measure::kWay;
    // s counts from the start of the move. The first sample is the last one of the previous part that is no blend.
    std::span<const workspace::Sample> samples;
  };
  // Calls `use` with one part after the other, until it returns false: each blend before what it leads to. Returns the
  // reason if the axes cannot reach a point: the last sample is the one before it.
  kinematics::Reason Run(const PathCheckRequest& question, const std::function<bool(const Part&)>& use);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace takt::group
