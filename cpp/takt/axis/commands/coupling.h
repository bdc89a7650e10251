// Commands that couple an axis to one or two masters.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/commands/moves.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"

namespace takt::axis {

// Which position of a master is followed.
enum class MasterSource : std::uint8_t { kSetValue, kActualValue };
// Which of its turns a rotary axis synchronises to.
enum class SyncMode : std::uint8_t { kShortest, kCatchUp, kSlowDown };
// How two masters are combined.
enum class CombineMode : std::uint8_t { kAdd, kSubtract };

struct GearIn {  // MC_GearIn
  Name master;
  double ratio_numerator = 1;
  double ratio_denominator = 1;
  MasterSource source = MasterSource::kSetValue;
  std::optional<double> master_filter{};
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // only changes the command of its kind in control

  bool operator==(const GearIn&) const = default;
};
struct GearOut {  // MC_GearOut
};
struct GearInPos {  // MC_GearInPos
  Name master;
  double ratio_numerator = 1;
  double ratio_denominator = 1;
  MasterSource source = MasterSource::kSetValue;
  double master_sync_position = 0;
  double slave_sync_position = 0;
  SyncMode sync_mode = SyncMode::kShortest;
  std::optional<double> master_filter{};
  std::optional<double> master_start_distance{};
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct PhasingAbsolute {  // MC_PhasingAbsolute
  double phase_shift = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
};
struct PhasingRelative {  // MC_PhasingRelative
  double phase_shift = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
};
struct CombineAxes {  // MC_CombineAxes
  Name master1;
  Name master2;
  CombineMode mode = CombineMode::kAdd;
  double ratio_numerator1 = 1;
  double ratio_denominator1 = 1;
  double ratio_numerator2 = 1;
  double ratio_denominator2 = 1;
  MasterSource source1 = MasterSource::kSetValue;
  MasterSource source2 = MasterSource::kSetValue;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // only changes the command of its kind in control

  bool operator==(const CombineAxes&) const = default;
};

void describe(Enumeration<MasterSource>&);
void describe(Enumeration<SyncMode>&);
void describe(Enumeration<CombineMode>&);
void describe(Description<GearIn>&);
void describe(Description<GearOut>&);
void describe(Description<GearInPos>&);
void describe(Description<PhasingAbsolute>&);
void describe(Description<PhasingRelative>&);
void describe(Description<CombineAxes>&);

}  // namespace takt::axis
