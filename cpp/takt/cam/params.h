// The description of a cam: a list of points, a list of segments, or a file of points (CAM-01, CAM-02, CAM-04).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/cam/laws.h"
#include "takt/core/describe_fwd.h"

namespace takt::cam {

inline constexpr std::size_t kMinPoints = 2;
inline constexpr std::size_t kMaxPoints = 100'000;
inline constexpr std::size_t kMaxSegments = 20'000;

// The curve between the points of a list.
enum class Interpolation : std::uint8_t {
  kLinear,       // straight lines; the velocity jumps at the points
  kQuintic,      // polynomials of the fifth degree; position, velocity and acceleration do not jump
  kCubicSpline,  // polynomials of the third degree; the acceleration jumps only where a velocity is given
  kMonotone,     // polynomials of the fifth degree that rise and fall only where the points do
};

// Velocity is dy/dx, acceleration d²y/dx². Values that are not given are free: see Interpolate.
struct CamPoint {
  double x = 0;  // [master's unit]
  double y = 0;  // [slave's unit]
  std::optional<double> v{};
  std::optional<double> a{};
};

struct CamPlace {
  double x = 0;  // [master's unit]
  double y = 0;  // [slave's unit]
};

// One law of motion. For quintic, and for laws that are chosen automatically (HasFreeEnds), end values that are not
// given are taken from the neighbour; 0 if it has none either, and at the ends of a cam that is not cyclic. For other
// laws they are 0.
struct CamSegment {
  std::optional<CamPlace> from{};  // unset: where the previous segment ends; for the first one (0, 0)
  CamPlace to;
  Law law = Law::kQuintic;
  std::optional<double> begin_v{};
  std::optional<double> begin_a{};
  std::optional<double> end_v{};
  std::optional<double> end_a{};
  double sine_share = 0.25;  // sine-constant-cosine combination only
  double cosine_share = 0.5;
  double inflection = 0.5;  // share of the length at which the acceleration changes its sign; tasks.h
};

struct CamParams {
  std::string name;
  std::string x_unit = "u";  // for display
  std::string y_unit = "u";
  bool cyclic = false;  // the end continues at the beginning, raised by the stroke
  Interpolation interpolation = Interpolation::kQuintic;
  std::vector<CamPoint> points{};
  std::vector<CamSegment> segments{};  // instead of points
  std::string file{};                  // of points, instead; after reading they are in `points`, and this is empty
};

void describe(Enumeration<Interpolation>&);
void describe(Description<CamPoint>&);
void describe(Description<CamPlace>&);
void describe(Description<CamSegment>&);
void describe(Description<CamParams>&);

}  // namespace takt::cam
