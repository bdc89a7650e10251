// What a machine file says about one axes group, and about paths for groups.
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

// Along the path; what a move does not say itself.
struct PathLimits {
  double velocity = 0;                   // mm/s
  double acceleration = 0;               // mm/s²
  std::optional<double> deceleration{};  // mm/s²; unset: as acceleration
  double jerk = 0;                       // mm/s³
  bool planned_ahead = true;             // by laws that are known to rest (trajectory/path_timing.h)
};

// Of the tool along X, Y and Z and about them, seen from the world; unset: none but those of the axes.
struct ToolLimits {
  std::optional<double> velocity{};              // mm/s
  std::optional<double> acceleration{};          // mm/s²
  std::optional<double> jerk{};                  // mm/s³
  std::optional<double> angular_velocity{};      // deg/s
  std::optional<double> angular_acceleration{};  // deg/s²
  std::optional<double> angular_jerk{};          // deg/s³
};

// The most that jogs may ask for; faster ones are held to it.
struct JogLimits {
  // Of the tool centre point, and of its turn, also where axes are jogged; unset: as moves.
  std::optional<double> velocity{};          // mm/s
  std::optional<double> angular_velocity{};  // deg/s
  double axis_factor = 1;                    // of the velocity limits of axes that are jogged themselves
};

// Once in step with what moves: go along whatever it does, or keep the limits of the group and fall out of step.
enum class AfterSync : std::uint8_t { kStay, kLimited };

// How the group follows objects on belts.
struct TrackingParams {
  AfterSync after_sync = AfterSync::kStay;
  double tolerance = 0;           // mm (tables: rad) from the object that count as in step; 0: exactly there
  double tolerance_time_s = 0;    // s, for so long
  bool override_in_sync = false;  // the override slows down getting into step, too
  double zones_ahead_s = 0.5;     // s: so long beforehand a zone is taken that the tool is carried into
};

struct GroupParams {
  std::string name;
  std::vector<std::string> axes;  // names: those of the kinematics first, in its order, then auxiliary ones
  std::optional<kinematics::KinematicsParams> kinematics{};
  PathLimits path;
  ToolLimits tool_limits;
  JogLimits jog;
  TrackingParams tracking;
  kinematics::Pose base;                                  // of the machine coordinate system in the world
  kinematics::Pose tool;                                  // of the tool centre point on the flange
  std::optional<workspace::WorkspaceParams> workspace{};  // unset: paths are not checked
};

// A place on a path of the machine file.
struct PathPose {
  double x = 0, y = 0, z = 0;           // mm
  std::optional<double> a{}, b{}, c{};  // deg; unset: as before
};

enum class ElementShape : std::uint8_t { kLine, kArc, kSpline };

// From where the element before it ends.
struct PathElement {
  ElementShape shape = ElementShape::kLine;
  std::optional<PathPose> to{};                     // where it ends; splines: see points
  std::optional<double> via_x{}, via_y{}, via_z{};  // arc: a point that it goes through
  std::vector<PathPose> points;                     // spline: what it goes through, the last one is its end
  std::optional<double> velocity{};                 // mm/s, on this element; unset: that of the command
};

struct PathParams {
  std::string name;
  std::string file;                   // CSV of elements instead, seen from the machine file
  std::vector<PathElement> elements;  // the first one begins where the group is, but for a spline's
};

inline constexpr std::size_t kZones = 8;  // of a machine

struct ZoneCorner {
  double x = 0;  // mm, in the world
  double y = 0;
  double z = 0;
};

// A box that several groups share: the tool of one of them is inside at a time (zones.h).
struct ZoneParams {
  std::string name;
  std::vector<std::string> groups;  // names; empty: all
  ZoneCorner lower;
  ZoneCorner upper;
  double margin = 5;  // mm around it that count as inside
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
