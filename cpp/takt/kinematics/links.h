// The parts of a mechanism: names, frames and bounds of their displacement between two positions of the axes. For users
// that attach shapes to them.
//
//   gantry, CoreXY   the parts that move with some of the coordinates: x, y, z, xy, xz, yz, xyz; their frames are level
//   SCARA            arm_1, arm_2 (X along the arm, at its axis), spindle (moves up and down), flange (also turns)
//   Delta            upper_arm_1 to 3 (X along the arm, at the motor), lower_arm_1_a to 3_b (X along the rod, at the
//                    knee; b is the rod on the other side of the arm), platform (level)
//   six axes         link_1 to link_6; each at its axis, as the axis has turned it
//   URDF             the same; their names are those of URDF (the first 40 bytes), or link_1 and so on where that would
//                    be base, tool, or the name of another link
//
// The first link is base, the last one tool: the frame returned by Forward.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "takt/kinematics/kinematics.h"

namespace takt::kinematics {

inline constexpr std::size_t kMaxLinks = 12;

struct LinkInfo {
  std::string name;
  // [mm] from its own axis to the next one, in its own frame; zero for links without this extent.
  KDL::Vector span;
  // Links to which it is fixed, on which it turns or along which it slides: they touch at all times.
  std::vector<std::size_t> neighbours;
};

// Returns the links in the order of the frames below; base is the first, tool the last. Allocates.
std::vector<LinkInfo> LinksOf(const Kinematics& kinematics);

using LinkFrameArray = std::array<Frame, kMaxLinks>;

// Computes the frame of each link in the base, in the order of LinksOf; `out` is valid with kNone only. Returns the
// reasons of Forward, and kSingular also where a rod of a Delta is parallel to the axis of its arm.
Reason LinkFrames(const Kinematics& kinematics, const Joints& joints, LinkFrameArray& out) noexcept;

// A motion of all axes from one position to another, each monotonically.
struct Sweep {
  LinkFrameArray start;           // frames of the links at the start
  Joints way{};                   // displacement of each axis [mm] or [rad], without sign
  std::array<double, 4> shift{};  // gantries: displacement of each coordinate [mm] or [rad], without sign
  double platform = 0;            // Delta: largest displacement of the platform [mm]
};

// Returns the reasons of LinkFrames, for the start; `out` is valid with kNone only.
Reason MakeSweep(const Kinematics& kinematics, const Joints& from, const Joints& to, Sweep& out) noexcept;

// Returns an upper bound [mm] of the displacement, relative to the link `seen_from`, of every point of the ball of
// `radius` [mm] about `point` ([mm], in the frame of `link`, to which it is fixed) during the sweep. During the first
// share f in [0, 1] of the sweep the displacement is at most f times the bound. Infinite: no bound is known for so long
// a motion (Delta); split it.
double DisplacementBound(const Kinematics& kinematics, const Sweep& sweep, std::size_t link, std::size_t seen_from,
                         const KDL::Vector& point, double radius) noexcept;

}  // namespace takt::kinematics
