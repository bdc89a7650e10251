// Parameters of one axes group, and of paths for groups, in a machine file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/frames.h"
#include "takt/kinematics/params.h"
#include "takt/workspace/params.h"

namespace takt::group {

// Default limits along the path, for moves that give none; all > 0.
struct PathLimits {
  double velocity = 0;                   // [mm/s]
  double acceleration = 0;               // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]; unset: as acceleration
  double jerk = 0;                       // [mm/s³]
  bool planned_ahead = true;             // timing laws that are known up to rest (trajectory/path_timing.h)
};

// Limits of the TCP along and about each of X, Y and Z of the world frame; unset: only those of the axes apply.
struct ToolLimits {
  std::optional<double> velocity{};              // [mm/s]
  std::optional<double> acceleration{};          // [mm/s²]
  std::optional<double> jerk{};                  // [mm/s³]
  std::optional<double> angular_velocity{};      // [deg/s]
  std::optional<double> angular_acceleration{};  // [deg/s²]
  std::optional<double> angular_jerk{};          // [deg/s³]
};

// Upper limits of jogs; faster ones are limited to them.
struct JogLimits {
  // Speed of the TCP and angular speed of the tool, also for jogs of axes; unset: the limits of moves.
  std::optional<double> velocity{};          // [mm/s]
  std::optional<double> angular_velocity{};  // [deg/s]
  double axis_factor = 1;                    // 1e-3 to 1, of the velocity limits of jogged axes
};

// Behaviour once in sync with a moving object. kStay: stays in sync, within the limits of the axes only; kLimited:
// keeps the limits of the group, and may lose sync.
enum class AfterSync : std::uint8_t { kStay, kLimited };

// Tracking of objects on belts and tables.
struct TrackingParams {
  AfterSync after_sync = AfterSync::kStay;
  // Largest lag that counts as in sync: along the belt [mm] or table [rad], and of each axis [u] (at least 1e-3 u).
  double tolerance = 0;
  double tolerance_time_s = 0;    // time for which the lag must stay within the tolerance
  bool override_in_sync = false;  // the override also scales the velocity of getting into sync
  double zones_ahead_s = 0.5;     // 0 to 10: time before the tool is carried into a zone at which the zone is taken
  bool board = false;             // gets onto a belt at constant speed from rest by time, beside the path (boarding.h)
};

struct GroupParams {
  std::string name;
  std::vector<std::string> axes;  // names: those of the kinematics first, in its order, then auxiliary axes
  std::optional<kinematics::KinematicsParams> kinematics{};
  PathLimits path;
  ToolLimits tool_limits;
  JogLimits jog;
  TrackingParams tracking;
  kinematics::Pose base;                                  // of the machine coordinate system in the world
  kinematics::Pose tool;                                  // of the tool centre point on the flange
  std::optional<workspace::WorkspaceParams> workspace{};  // unset: paths are not checked
};

// A pose on a path of the machine file.
struct PathPose {
  double x = 0, y = 0, z = 0;           // [mm]
  std::optional<double> a{}, b{}, c{};  // [deg]; unset: as before
};

enum class ElementShape : std::uint8_t { kLine, kArc, kSpline };

// Starts at the end of the previous element.
struct PathElement {
  ElementShape shape = ElementShape::kLine;
  std::optional<PathPose> to{};                     // end of the element; unset for splines
  std::optional<double> via_x{}, via_y{}, via_z{};  // arc: a point on it
  std::vector<PathPose> points;                     // spline: its end last; as a path's first element its start first
  std::optional<double> velocity{};                 // [mm/s] on this element; unset: that of the command
};

struct PathParams {
  std::string name;
  std::string file;                   // instead of elements: a CSV file, relative to the machine file
  std::vector<PathElement> elements;  // the first one starts at the present pose, unless it is a spline
};

inline constexpr std::size_t kZones = 8;  // per machine

struct ZoneCorner {
  double x = 0;  // [mm] in the world
  double y = 0;
  double z = 0;
};

// A box that several groups share: the tool of only one of them is inside at a time (zones.h).
struct ZoneParams {
  std::string name;
  std::vector<std::string> groups;  // names; empty: all
  ZoneCorner lower;
  ZoneCorner upper;
  double margin = 5;  // [mm] around the box that count as inside
};

void describe(Description<ZoneCorner>&);
void describe(Description<ZoneParams>&);
void describe(Description<PathLimits>&);
void describe(Description<ToolLimits>&);
void describe(Description<JogLimits>&);
void describe(Enumeration<AfterSync>&);
void describe(Description<TrackingParams>&);
void describe(Description<GroupParams>&);
void describe(Description<PathPose>&);
void describe(Enumeration<ElementShape>&);
void describe(Description<PathElement>&);
void describe(Description<PathParams>&);

}  // namespace takt::group
