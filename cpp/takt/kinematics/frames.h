// Frames: where something is and how it is turned, seen from somewhere else.
//
// People write a pose: X, Y, Z in mm and A, B, C in degrees. Inside, frames are KDL's: mm and a rotation matrix.
//
// The order of the rotations, stated here for all of Takt: turn by A about X, then by B about Y, then by C about Z, all
// about the axes of the frame the pose is given in, which stand still: R = Rz(C) Ry(B) Rx(A). (The same rotation comes
// from turning by C about Z first, then by B about the new Y, then by A about the newest X.)
#pragma once

#include <kdl/frameacc.hpp>
#include <kdl/frames.hpp>

#include "takt/core/describe_fwd.h"

namespace takt::kinematics {

// A point and an orientation, in mm and as a rotation matrix.
using Frame = KDL::Frame;
// A frame, its velocity (mm/s, rad/s) and its acceleration (mm/s², rad/s²), all seen from the frame it is given in. The
// velocity is that of the frame's own origin. Products of moving frames are exact: belt times workpiece times gripper.
using MovingFrame = KDL::FrameAcc;

struct Pose {
  double x = 0;  // mm
  double y = 0;  // mm
  double z = 0;  // mm
  double a = 0;  // deg, about X
  double b = 0;  // deg, about Y
  double c = 0;  // deg, about Z

  constexpr bool operator==(const Pose&) const = default;
};

Frame ToFrame(const Pose& pose) noexcept;

// A and C come in (-180, 180], B in [-90, 90]. With B = +-90 (gimbal lock) A and C turn about the same axis: A is 0
// then and C has it all. The pose always stands for the very rotation of the frame, near the lock, too.
Pose ToPose(const Frame& frame) noexcept;

// Every element.
bool Finite(const Frame& frame) noexcept;
bool Finite(const MovingFrame& frame) noexcept;

// The shortest turn from one orientation to another, about one axis that stands still (slerp).
struct GreatArc {
  KDL::Rotation start;
  KDL::Vector axis{0, 0, 1};  // a unit vector, in the frame the orientations are given in
  double angle = 0;           // rad, 0 to pi
};

// Half a turn has two shortest ways: the same one is taken each time.
GreatArc ArcBetween(const KDL::Rotation& from, const KDL::Rotation& to) noexcept;

// The turn from one orientation to another as axis times angle, rad. (KDL::diff takes small turns for none.)
KDL::Vector TurnBetween(const KDL::Rotation& from, const KDL::Rotation& to) noexcept;

// A share of the way with its first and second derivative by time: 0 is at the start, 1 at the end.
struct Share {
  double value = 0;
  double rate = 0;          // 1/s
  double acceleration = 0;  // 1/s²
};

// Where the arc is, how fast it turns (rad/s) and how that changes (rad/s²).
KDL::RotationAcc Along(const GreatArc& arc, const Share& share) noexcept;

void describe(Description<Pose>&);

}  // namespace takt::kinematics
