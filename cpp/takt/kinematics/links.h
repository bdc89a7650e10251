// The parts of a mechanism: what they are called, where they are and how far they can come between two positions of
// the axes. For whoever gives them shapes.
//
//   gantry, CoreXY   what moves with some of the coordinates: x, y, z, xy, xz, yz, xyz; their frames are level
//   SCARA            arm_1, arm_2 (X along the arm, at its axis), spindle (goes up and down), flange (turns, too)
//   Delta            upper_arm_1 to 3 (X along the arm, at the motor), lower_arm_1_a to 3_b (X along the rod, at the
//                    knee; b is the rod on the other side of the arm), platform (level)
//   six axes         link_1 to link_6; each at its axis, as the axis has turned it
//   URDF             the same; their names are those of URDF (40 bytes of them), but link_1 and so on where that would
//                    be base, tool, or the name of another link
//
// In front of them stands base, behind them tool: the frame that Forward gives.
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
  // From its own axis to the next one, in its own frame, mm; zero for those without such an extent.
  KDL::Vector span;
  // What it is fixed to, turns on or slides along: they meet at all times.
  std::vector<std::size_t> neighbours;
};

// In the order of the frames below; base is the first, tool the last. Allocates.
std::vector<LinkInfo> LinksOf(const Kinematics& kinematics);

using LinkFrameArray = std::array<Frame, kMaxLinks>;

// Where each link is, seen from the base. The reasons of Forward.
Reason LinkFrames(const Kinematics& kinematics, const Joints& joints, LinkFrameArray& out) noexcept;

// All axes on their way from one position to another, each going straight and no further.
struct Sweep {
  LinkFrameArray start;           // where the links are at the start
  Joints way{};                   // of each axis, mm or rad, without sign
  std::array<double, 4> shift{};  // gantries: of each coordinate, mm and rad, without sign
  double platform = 0;            // Delta: the most that the platform moves, mm
};

// The reasons of Forward, for the start.
Reason MakeSweep(const Kinematics& kinematics, const Joints& from, const Joints& to, Sweep& out) noexcept;

// No point of a ball about `point` (mm, in the frame of `link`, on which it is fixed) ever gets further from where it
// was at the start of the sweep than this, seen from the link `seen_from`, mm. Infinite: nothing can be said about so
// long a way (Delta); of a shorter one it can. At most in proportion for a part of the way.
double LargestMove(const Kinematics& kinematics, const Sweep& sweep, std::size_t link, std::size_t seen_from,
                   const KDL::Vector& point, double radius) noexcept;

}  // namespace takt::kinematics
