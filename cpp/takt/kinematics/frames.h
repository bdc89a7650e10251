// Frames: position and orientation of a body relative to another frame.
//
// Users give poses: X, Y, Z in mm and A, B, C in degrees. Internally, frames are KDL's: mm and a rotation matrix.
//
// The order of the rotations, stated here for all of Takt: turn by A about X, then by B about Y, then by C about Z, all
// about the fixed axes of the frame in which the pose is given: R = Rz(C) Ry(B) Rx(A). (The same rotation results from
// turning by C about Z first, then by B about the new Y, then by A about the newest X.)
#pragma once

#include <kdl/frameacc.hpp>
#include <kdl/frames.hpp>

#include "takt/core/describe_fwd.h"

namespace takt::kinematics {

// A position [mm] and an orientation (rotation matrix).
using Frame = KDL::Frame;
// A frame, its velocity (mm/s, rad/s) and its acceleration (mm/s², rad/s²), all relative to the frame in which it is
// given. The velocity is the one of the frame's own origin. Products of moving frames are exact: belt times workpiece
// times gripper.
using MovingFrame = KDL::FrameAcc;

struct Pose {
  double x = 0;  // [mm]
  double y = 0;  // [mm]
  double z = 0;  // [mm]
  double a = 0;  // [deg] about X
  double b = 0;  // [deg] about Y
  double c = 0;  // [deg] about Z

  constexpr bool operator==(const Pose&) const = default;
};

Frame ToFrame(const Pose& pose) noexcept;

// Returns the pose of a frame: A and C in (-180, 180], B in [-90, 90]. With B = +-90 (gimbal lock) A and C turn about
// the same axis: then A is 0 and C the whole turn. The pose always gives exactly the rotation of the frame, near the
// lock, too.
Pose ToPose(const Frame& frame) noexcept;

// Returns true if every element is finite.
bool Finite(const Frame& frame) noexcept;
bool Finite(const MovingFrame& frame) noexcept;

// The shortest turn from one orientation to another, about one fixed axis (slerp).
struct GreatArc {
  KDL::Rotation start;
  KDL::Vector axis{0, 0, 1};  // a unit vector, in the frame in which the orientations are given
  double angle = 0;           // [rad] 0 to pi
};

// Returns the shortest turn. For half a turn there are two: the choice is always the same.
GreatArc ArcBetween(const KDL::Rotation& from, const KDL::Rotation& to) noexcept;

// Returns the turn from one orientation to another as axis times angle [rad]. (KDL::diff takes small turns as none.)
KDL::Vector TurnBetween(const KDL::Rotation& from, const KDL::Rotation& to) noexcept;

// A share of the turn with its first and second derivative by time: 0 at the start, 1 at the end.
struct Share {
  double value = 0;
  double rate = 0;          // [1/s]
  double acceleration = 0;  // [1/s²]
};

// Returns the orientation on the arc with its angular velocity (rad/s) and acceleration (rad/s²).
KDL::RotationAcc Along(const GreatArc& arc, const Share& share) noexcept;

void describe(Description<Pose>&);

}  // namespace takt::kinematics
