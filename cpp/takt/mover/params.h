// Parameters of one planar mover, from the machine file.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "takt/core/describe_fwd.h"
#include "takt/trajectory/limits.h"

namespace takt::mover {

// Dynamic limits of a coordinate, or of X and Y together along the path. u: mm, or deg for angles.
struct Dynamics {
  double velocity = 1;                   // [u/s]
  double acceleration = 1;               // [u/s²]
  std::optional<double> deceleration{};  // [u/s²]; unset: equal to the acceleration
  double jerk = 1;                       // [u/s³]

  trajectory::Limits limits() const noexcept {
    return {velocity, acceleration, deceleration.value_or(acceleration), jerk};
  }
};

struct PlaneParams {  // X and Y
  Dynamics maximum{2000, 10000, {}, 200000};
  std::optional<Dynamics> standard{};  // of commands that give none; unset: the maximum
};

struct CoordinateParams {  // one of the other coordinates
  Dynamics maximum;
  std::optional<Dynamics> standard{};
  double lower = 0;  // [mm, deg]
  double upper = 0;
};

// Pose of a mover: at the start, and as measured.
struct Place {
  double x = 0, y = 0, z = 0;  // [mm]
  double a = 0, b = 0, c = 0;  // [deg]
};

struct MoverParams {
  std::string name{};
  double width = 113;   // [mm] along X at C = 0
  double height = 113;  // [mm] along Y
  Place initial{};
  std::string reference{};  // part or coordinate system of the initial pose
  PlaneParams xy{};
  CoordinateParams z{{100, 1000, {}, 20000}, {}, 0, 5};
  CoordinateParams a{{30, 300, {}, 6000}, {}, -5, 5};
  CoordinateParams b{{30, 300, {}, 6000}, {}, -5, 5};
  // The limits are those of a window, which exists four times, each turned by 90 deg.
  CoordinateParams c{{360, 3600, {}, 72000}, {}, -15, 15};
  double c_modulus = 360;         // [deg] a full turn for the directions of move_c
  double c_modulo_tolerance = 0;  // [deg] within which move_c turns against its direction instead
  // [mm/s²] in curves of tracks; unset: see lateral()
  std::optional<double> lateral_acceleration{};
  double gap = 200;  // [mm] to the mover ahead on tracks, unless a command gives one
  // [mm] between set and actual position, above which is an error; unset: not checked
  std::optional<double> deviation{};
  std::uint32_t missing_setpoints = 1;  // number of consecutive missing external set points that is an error

  double lateral() const noexcept { return lateral_acceleration.value_or(std::min(5000.0, xy.maximum.acceleration)); }
};

void describe(Description<Dynamics>&);
void describe(Description<PlaneParams>&);
void describe(Description<CoordinateParams>&);
void describe(Description<Place>&);
void describe(Description<MoverParams>&);

}  // namespace takt::mover
