// A described machine that uses every kind of field, for the tests of reading, writing and hashing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/describe_fwd.h"

namespace example {

template <typename T>
using Description = takt::Description<T>;
template <typename E>
using Enumeration = takt::Enumeration<E>;

enum class Direction : std::int8_t { kCurrent = -1, kPositive, kShortest, kNegative };
enum class DriveMode { kPosition, kVelocity };

struct Homing {
  double velocity = 10;
  Direction direction = Direction::kCurrent;
  std::optional<double> timeout_s;
};

struct Drive {
  DriveMode mode = DriveMode::kPosition;
  std::uint8_t station = 0;
  std::int16_t offset = 0;
};

struct Limits {
  double lower = -100;
  double upper = 100;
};

struct Axis {
  std::string name;
  double velocity = 0;
  double mounting_angle = 0;  // [rad]
  bool inverted = false;
  std::uint64_t serial = 0;
  std::int64_t shift = 0;
  std::array<double, 3> gains{1, 0, 0};
  Drive drive{};
  std::optional<Homing> homing{};
  Limits limits{};
  std::uint32_t counter = 0;  // state
};

struct Machine {
  std::string title = "untitled";
  std::vector<Axis> axes;
  std::vector<double> table;
  std::vector<std::string> tags;
  std::vector<std::array<double, 2>> points;
  std::optional<std::int32_t> spare;
};

struct MoveAbsolute {
  double position = 0;
  double velocity = 0;
  double jerk = 0;
  Direction direction = Direction::kCurrent;
};

void describe(Enumeration<Direction>&);
void describe(Enumeration<DriveMode>&);
void describe(Description<Homing>&);
void describe(Description<Drive>&);
void describe(Description<Limits>&);
void describe(Description<Axis>&);
void describe(Description<Machine>&);
void describe(Description<MoveAbsolute>&);

// A machine file without problems that contains every key.
extern const std::string_view kMachineYaml;

}  // namespace example
