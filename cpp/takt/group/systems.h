// Coordinate systems of a group: where each is in that of the machine, and numbers of people in them.
//
// ACS: the axes themselves. MCS: that of the kinematics. WCS: the world, in which the machine file places the MCS. PCS
// 1 to 16: products, placed in the MCS at run time. The tool centre point (TCP) lies on the flange as the machine file
// says, or SetTool.
#pragma once

#include "takt/group/failures.h"
#include "takt/group/group.h"
#include "takt/kinematics/frames.h"

namespace takt::group {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

// Where the tool centre point is on the flange: as SetTool said, or the machine file.
inline const kinematics::Pose& ToolOnFlange(const Context& c, const State& s) noexcept {
  return s.tool_changed ? s.tool : c.params.tool;
}

// Number of members, and of those that the kinematics moves.
std::size_t CountOf(const State& s) noexcept;
std::size_t InKinematics(const Context& c, const State& s) noexcept;
// Whether there is a tool to speak of.
bool HasTool(const Context& c, const State& s) noexcept;

// Seen from the MCS; of ACS: the MCS itself.
// That of a moving PCS: where it is in this cycle.
Frame SystemFrame(const Context& c, const State& s, CoordinateSystem system, std::uint32_t pcs) noexcept;

// The TCP in the MCS. A reason, and nothing in `tcp`, where the axes cannot be so.
kinematics::Reason ToolAt(const Context& c, const kinematics::Joints& joints, Frame& tcp) noexcept;
// The axes for a TCP in the MCS, the others as in `near`.
kinematics::Reason JointsAt(const Context& c, const Frame& tcp, const kinematics::Joints& near,
                            kinematics::Joints& joints) noexcept;
// The nearest position of the axes for a TCP in the MCS, of those within all ranges, in all configurations and turns
// that `wanted` leaves (GR-44): that which the slowest axis reaches first from `near` at its velocity limit.
// `failures`: of those that do not do.
kinematics::Reason NearestJointsAt(const Context& c, const State& s, const Frame& tcp,
                                   const kinematics::Configuration& wanted, const kinematics::Joints& near,
                                   kinematics::Joints& joints, Failures& failures) noexcept;
// Why the axes cannot go on from `near` to a TCP in the MCS that is next to it, where `reason` says that they cannot.
Failures FailuresAt(const Context& c, const State& s, const Frame& tcp, kinematics::Reason reason,
                    const kinematics::Joints& near) noexcept;
// The first member that is out of its range.
Failures FailuresOf(const Context& c, const State& s, const kinematics::Joints& joints) noexcept;
// Whether the members in the first `count` places are within their SW limits and those of the kinematics.
bool WithinRanges(const Context& c, const State& s, const kinematics::Joints& joints,
                  std::size_t count = kMaxAxes) noexcept;

// Where a plan ends.
struct End {
  kinematics::Joints joints{};
  Frame tool;  // in the MCS; without a tool of no meaning
};
// Where the members stand as they are told.
End Present(const Context& c, const State& s) noexcept;
kinematics::Joints PresentJoints(const Context& c, const State& s) noexcept;

}  // namespace takt::group
