// Parameters of one belt from the machine file: an axis that carries workpieces through the cell. A rotary table is a
// belt, too.
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

// Lengths of a belt are [mm] along X of its origin; those of a table are [deg] about Z of it.
struct BeltParams {
  std::string name;
  BeltKind kind = BeltKind::kStraight;
  std::string axis;                                           // name of the axis; an axis with only an encoder suffices
  axis::MasterSource source = axis::MasterSource::kSetValue;  // which position of the axis is used
  // [mm] or [deg] per u of the axis; < 0: opposite direction
  double ratio = 1;
  kinematics::Pose origin;  // in the world; X is the direction of travel; of a table: Z is its axis
  // The work range, relative to the origin; unset: no limit.
  std::optional<double> lower_limit{};  // [mm] or [deg]
  std::optional<double> upper_limit{};  // [mm] or [deg]; objects beyond it are lost
  // [s]; unset: measured positions as their resolution requires, and faster while the velocity changes; set positions 0
  // (no filter). Measured positions are always filtered.
  std::optional<double> filter_s{};
  // [s] age of the axis' position that is compensated, in addition to the regular cycle
  double dead_time_s = 0;
  std::optional<double> forget_after{};  // [mm] or [deg] of travel without a pose after the detection; unset: never
};

inline bool IsMeasured(const BeltParams& params) noexcept {
  return params.source == axis::MasterSource::kActualValue;
}
// Returns the filter for a position that is measured in steps of this size [mm] or [deg] (0: not known).
trajectory::TrackingFilter FilterOf(const BeltParams& params, double step, double period_s) noexcept;

void describe(Enumeration<BeltKind>&);
void describe(Description<BeltParams>&);

}  // namespace takt::conveyor
