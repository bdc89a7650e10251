// What a machine file says about one belt: something with an axis that carries workpieces through the cell. A table
// that turns is a belt, too.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "takt/axis/commands/coupling.h"
#include "takt/core/describe_fwd.h"
#include "takt/kinematics/frames.h"
#include "takt/trajectory/tracking_filter.h"

namespace takt::conveyor {

enum class BeltKind : std::uint8_t {
  kStraight,  // along X of its origin
  kTurning,   // about Z of its origin
};

// Lengths of a belt are mm along X of its origin; those of a table are deg about Z of it.
struct BeltParams {
  std::string name;
  BeltKind kind = BeltKind::kStraight;
  std::string axis;                                           // name of the axis; one with an encoder alone will do
  axis::MasterSource source = axis::MasterSource::kSetValue;  // which position of it counts
  double ratio = 1;                                           // mm or deg per u of the axis; < 0: against it
  kinematics::Pose origin;  // in the world; X is the direction of travel; of a table: the axis is its Z
  // The work range, seen from the origin; unset: none.
  std::optional<double> lower_limit{};  // mm or deg
  std::optional<double> upper_limit{};  // mm or deg; objects beyond it are lost
  // s; unset: measured positions as their steps need, and fast where the speed changes; set positions 0, which is no
  // filter. Measured positions always are filtered.
  std::optional<double> filter_s{};
  double dead_time_s = 0;                // s that what is measured is older than the cycle in which it comes
  std::optional<double> forget_after{};  // mm or deg of travel without a pose after a latch; unset: never
};

inline bool IsMeasured(const BeltParams& params) noexcept {
  return params.source == axis::MasterSource::kActualValue;
}
// For a position that is measured in steps of so many mm or deg (0: not known).
trajectory::TrackingFilter FilterOf(const BeltParams& params, double step, double period_s) noexcept;

void describe(Enumeration<BeltKind>&);
void describe(Description<BeltParams>&);

}  // namespace takt::conveyor
