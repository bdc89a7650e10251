// Geometry of one move, from the end of the plan.
#pragma once

#include "takt/group/plan.h"

namespace takt::group {

// A limit that is never reached: motions without limits along the path have those of the axes.
inline constexpr double kUnlimited = 1e12;

// Fills `ahead.next` from the end of `ahead`. Returns an error if there is no such path (State::problem and reason:
// why).
ErrorId MakeStretch(const Context& c, const Request& move, std::uint32_t element, LookAhead& ahead, State& s) noexcept;

// Returns the segment transformed by a frame.
path::Segment Moved(const Frame& frame, const path::Segment& segment) noexcept;

// Returns the number of stretches of a move; of an arch only once the first is made.
std::size_t ElementsOf(const Context& c, const Request& move) noexcept;

// Computes the axes for a tool on a stretch in a motion `along` its segment. Returns the reason if there are none.
kinematics::Reason AxesFor(const Context& c, const State& s, const Stretch& stretch, const path::MovingFrame& tool,
                           const KinematicState& along, const kinematics::Joints& near,
                           kinematics::JointMotion& motion) noexcept;

// Returns why the axes cannot continue from `near` to `way` on a stretch; as FeedbackEvent::detail.
std::uint64_t FailuresOn(const Context& c, const State& s, const Stretch& stretch, double way,
                         kinematics::Reason reason, const kinematics::Joints& near) noexcept;

// Returns velocities and accelerations of all coordinates of LimitsOf: the axes, then the tool along and about X, Y and
// Z of the world.
trajectory::PathSlopes CoordinatesOf(const Context& c, const kinematics::JointMotion& motion,
                                     const path::MovingFrame& tool) noexcept;

// Computes what a motion along a carried path demands of all coordinates of LimitsOf `ahead_s` from now, with carriers
// that move on as now. `positions`: in, of the previous point (NaN: none); out, of this one. Returns false if the path
// is not carried there, or if the axes cannot follow.
bool Foresee(const Context& c, const State& s, const KinematicState& along, double ahead_s,
             trajectory::PathCoordinateValues& positions, trajectory::PathCoordinateValues& velocities,
             trajectory::PathCoordinateValues& accelerations) noexcept;

// What carriers take of a coordinate: velocity, acceleration by the curvature along their travel, and mixed
// acceleration per path speed.
struct CarrierPart {
  double velocity = 0;
  double bend = 0;
  double cross = 0;
};
// Returns the shares of the limits of coordinate k that remain for the path at this path speed, after carriers and, if
// not nullptr, boarding.
trajectory::Left LeftBeside(const trajectory::CoordinateLimits::One& of, const CarrierPart& part, double speed,
                            const Boarding* boarding = nullptr, std::size_t k = 0) noexcept;

// Computes the axes, the slopes of all coordinates of LimitsOf, and the shares of their limits that carriers leave.
kinematics::Reason SlopesOn(const Context& c, const State& s, const Stretch& stretch, double way,
                            const kinematics::Joints& near, trajectory::PathPoint& point,
                            kinematics::JointMotion& motion) noexcept;

}  // namespace takt::group
