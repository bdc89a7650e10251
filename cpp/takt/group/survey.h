// The axes along a path that is asked about (path_check_request.h), made once more outside the cycle: all elements of
// the move in full, and the blends at their corners, so that whatever becomes of a corner has been looked at (but for
// short chords: join.h). Allocates.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "takt/group/group.h"
#include "takt/workspace/checker.h"

namespace takt::group {

// What of a group never changes while the machine runs, but for the tool, which each question has.
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
    bool on_blend = false;      // into the move, or into that element; else behind it
    path::Measure measure = path::Measure::kWay;
    // s counts from the beginning of the move. The first one is the last of the part before it that is no blend.
    std::span<const workspace::Sample> samples;
  };
  // One part after the other, until `use` returns false: each blend before what it leads to. The reason, if there is a
  // place without a position of the axes: the last sample is the one before it.
  kinematics::Reason Run(const PathCheckRequest& question, const std::function<bool(const Part&)>& use);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace takt::group
