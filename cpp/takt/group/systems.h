// Coordinate systems of a group: their poses in the MCS, and conversions between tool and axes.
//
// ACS: the axes themselves. MCS: the machine coordinate system of the kinematics. WCS: the world, in which the machine
// file places the MCS. PCS 1 to 16: products, placed in the MCS at run time. The tool centre point (TCP) on the flange
// is given by the machine file or by SetTool.
#pragma once

#include "takt/group/failures.h"
#include "takt/group/group.h"
#include "takt/kinematics/frames.h"

namespace takt::group {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

// Returns the pose of the tool centre point on the flange: that of SetTool, else that of the machine file.
inline const kinematics::Pose& ToolOnFlange(const Context& c, const State& s) noexcept {
  return s.tool_changed ? s.tool : c.params.tool;
}

// Return the number of members, and of the axes of the kinematics (0 without a tool).
std::size_t CountOf(const State& s) noexcept;
std::size_t InKinematics(const Context& c, const State& s) noexcept;
// Returns true if there are kinematics with all their members, and they are switched on.
bool HasTool(const Context& c, const State& s) noexcept;

// Returns the pose of a coordinate system in the MCS; of ACS: identity; of a moving PCS: in this cycle.
Frame SystemFrame(const Context& c, const State& s, CoordinateSystem system, std::uint32_t pcs) noexcept;

// Computes the TCP in the MCS. Returns a reason, with `tcp` unchanged, if there is none for these axes.
kinematics::Reason ToolAt(const Context& c, const kinematics::Joints& joints, Frame& tcp) noexcept;
// Computes the axes for a TCP in the MCS, the auxiliary ones as in `near`. Returns a reason, with `joints` unchanged,
// if they cannot reach it.
kinematics::Reason JointsAt(const Context& c, const Frame& tcp, const kinematics::Joints& near,
                            kinematics::Joints& joints) noexcept;
// Computes the nearest position of the axes for a TCP in the MCS, among those within all ranges, in all configurations
// and turns that `wanted` permits (GR-44): the one that the slowest axis reaches first from `near` at its velocity
// limit. `failures`: of the other configurations.
kinematics::Reason NearestJointsAt(const Context& c, const State& s, const Frame& tcp,
                                   const kinematics::Configuration& wanted, const kinematics::Joints& near,
                                   kinematics::Joints& joints, Failures& failures) noexcept;
// Returns why the axes cannot continue from `near` to a neighbouring TCP in the MCS, where `reason` says that they
// cannot.
Failures FailuresAt(const Context& c, const State& s, const Frame& tcp, kinematics::Reason reason,
                    const kinematics::Joints& near) noexcept;
// Returns the first member that is out of its range.
Failures FailuresOf(const Context& c, const State& s, const kinematics::Joints& joints) noexcept;
// Returns true if the first `count` members are within their SW limits and the ranges of the kinematics.
bool WithinRanges(const Context& c, const State& s, const kinematics::Joints& joints,
                  std::size_t count = kMaxAxes) noexcept;

// End of a plan.
struct End {
  kinematics::Joints joints{};
  Frame tool;  // in the MCS; unused without a tool
};
// Return the present commanded position.
End Present(const Context& c, const State& s) noexcept;
kinematics::Joints PresentJoints(const Context& c, const State& s) noexcept;

}  // namespace takt::group
