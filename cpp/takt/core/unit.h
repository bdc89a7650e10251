// Units of described fields, as users write them, and ranges of their values.
#pragma once

#include <limits>
#include <numbers>
#include <string>
#include <string_view>

namespace takt {

struct Unit {
  std::string_view text;     // "mm/s"; empty: a plain number
  std::string_view meaning;  // added to the text where the text is not self-explanatory
  double scale = 1;          // held value = written value * scale
};

namespace unit {

inline constexpr Unit none{"", ""};
inline constexpr Unit one{"1", "a factor"};
// The axis' own unit: mm, deg, ..., as its description says.
inline constexpr Unit u{"u", "the axis' own unit"};
inline constexpr Unit u_s{"u/s", "the axis' unit per second"};
inline constexpr Unit u_s2{"u/s2", "the axis' unit per second squared"};
inline constexpr Unit u_s3{"u/s3", "the axis' unit per second cubed"};
inline constexpr Unit u_m{"u_m", "the master's own unit"};
inline constexpr Unit u_m_s{"u_m/s", "the master's own unit per second"};
inline constexpr Unit x{"x", "the unit of a cam's x"};
inline constexpr Unit x_s{"x/s", "the unit of a cam's x per second"};
inline constexpr Unit x_s2{"x/s2", "the unit of a cam's x per second squared"};
inline constexpr Unit y{"y", "the unit of a cam's y"};
inline constexpr Unit y_s{"y/s", "the unit of a cam's y per second"};
inline constexpr Unit y_s2{"y/s2", "the unit of a cam's y per second squared"};
inline constexpr Unit us_u{"s/u", "seconds per axis' unit"};
inline constexpr Unit mm{"mm", ""};
inline constexpr Unit mm_s{"mm/s", ""};
inline constexpr Unit mm_s2{"mm/s2", ""};
inline constexpr Unit mm_s3{"mm/s3", ""};
inline constexpr Unit deg{"deg", ""};
inline constexpr Unit deg_s{"deg/s", ""};
inline constexpr Unit deg_s2{"deg/s2", ""};
inline constexpr Unit deg_s3{"deg/s3", ""};
inline constexpr Unit mm_u_m{"mm/u_m", "mm per the master's own unit"};
inline constexpr Unit u_mm{"u/mm", "the axis' own unit per mm"};
// Written in degrees, held in radians.
inline constexpr Unit deg_as_rad{"deg", "", std::numbers::pi / 180};
inline constexpr Unit deg_s_as_rad_s{"deg/s", "", std::numbers::pi / 180};
inline constexpr Unit s{"s", ""};
inline constexpr Unit ms{"ms", ""};
inline constexpr Unit us{"us", "microseconds"};
inline constexpr Unit ns{"ns", "nanoseconds"};
inline constexpr Unit hz{"Hz", ""};
inline constexpr Unit one_s{"1/s", ""};
inline constexpr Unit volt{"V", ""};
inline constexpr Unit percent{"%", "percent"};
inline constexpr Unit cycles{"cycles", "cycles of the engine"};
inline constexpr Unit count{"count", "encoder counts"};
inline constexpr Unit count_s{"count/s", "encoder counts per second"};
inline constexpr Unit count_u{"1/u", "encoder counts per axis' unit"};
inline constexpr Unit revolution{"rev", "revolutions"};
inline constexpr Unit u_rev{"u/rev", "the axis' unit per revolution"};
inline constexpr Unit rpm{"1/min", "revolutions per minute"};
inline constexpr Unit kg{"kg", ""};
inline constexpr Unit kg_m2{"kg m2", "moment of inertia"};
inline constexpr Unit newton{"N", ""};
inline constexpr Unit nm{"Nm", ""};
inline constexpr Unit nm_s{"Nm s", "torque per speed in rad/s"};

}  // namespace unit

// Returns "u/s (the axis' unit per second)"; empty for a plain number.
std::string LongText(const Unit& unit);

// The legal values, in written units. Numbers must be finite in any range.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool without_min = false;  // min itself is excluded

  constexpr bool Holds(double x) const { return (without_min ? x > min : x >= min) && x <= max; }
  constexpr bool bounded_below() const { return min > -std::numeric_limits<double>::infinity(); }
  constexpr bool bounded_above() const { return max < std::numeric_limits<double>::infinity(); }
  constexpr bool bounded() const { return bounded_below() || bounded_above(); }
};

inline constexpr Range any_value{};
inline constexpr Range positive{.min = 0, .without_min = true};
inline constexpr Range not_negative{.min = 0};
constexpr Range at_least(double min) {
  return {.min = min};
}
constexpr Range at_most(double max) {
  return {.max = max};
}
constexpr Range between(double min, double max) {
  return {.min = min, .max = max};
}

// Returns "above 0", "at least 0", "from -360 to 360"; empty for any_value.
std::string Text(const Range& range);

}  // namespace takt
