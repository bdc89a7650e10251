// The geometry of one move, from where the plan ends.
#pragma once

#include "takt/group/plan.h"

namespace takt::group {

// Faster and stronger than anything: what has no limit along the way has those of the axes.
inline constexpr double kUnlimited = 1e12;

// Fills `ahead.next` from where `ahead` ends. An error: there is no such path (State::problem and reason say why).
ErrorId MakeStretch(const Context& c, const Request& move, std::uint32_t element, LookAhead& ahead, State& s) noexcept;

// The same segment, seen from where a frame is seen from.
path::Segment Moved(const Frame& frame, const path::Segment& segment) noexcept;

// How many stretches a move is made of; of an arch, once the first is made.
std::size_t ElementsOf(const Context& c, const Request& move) noexcept;

// The axes for a tool on a stretch that moves `along` its segment.
kinematics::Reason AxesFor(const Context& c, const State& s, const Stretch& stretch, const path::MovingFrame& tool,
                           const KinematicState& along, const kinematics::Joints& near,
                           kinematics::JointMotion& motion) noexcept;

// Why the axes cannot go on from `near` to a place of a stretch; as FeedbackEvent::detail.
std::uint64_t FailuresOn(const Context& c, const State& s, const Stretch& stretch, double way,
                         kinematics::Reason reason, const kinematics::Joints& near) noexcept;

// Velocities and accelerations of all coordinates of LimitsOf: the axes, then the tool along and about X, Y and Z of
// the world.
trajectory::PathSlopes CoordinatesOf(const Context& c, const kinematics::JointMotion& motion,
                                     const path::MovingFrame& tool) noexcept;

// What a motion along the path asks of all coordinates of LimitsOf where it is carried, if that goes on as it does now.
// `positions` of the place before, NaN: none. False: it is not carried there, or the axes cannot be so.
bool Foresee(const Context& c, const State& s, const KinematicState& along, double ahead_s,
             trajectory::PathCoordinateValues& positions, trajectory::PathCoordinateValues& velocities,
             trajectory::PathCoordinateValues& accelerations) noexcept;

// Use of a coordinate by carriers: velocity, acceleration by the curvature along their travel, and mixed acceleration
// per path speed.
struct CarrierPart {
  double velocity = 0;
  double bend = 0;
  double cross = 0;
};
// Returns the shares of the limits of coordinate k that remain for the path at this path speed, after carriers and, if
// not nullptr, boarding.
trajectory::Left LeftBeside(const trajectory::CoordinateLimits::One& of, const CarrierPart& part, double speed,
                            const Boarding* boarding = nullptr, std::size_t k = 0) noexcept;

// Slopes of all coordinates of LimitsOf and what is left of their limits, and the axes.
kinematics::Reason SlopesOn(const Context& c, const State& s, const Stretch& stretch, double way,
                            const kinematics::Joints& near, trajectory::PathPoint& point,
                            kinematics::JointMotion& motion) noexcept;

}  // namespace takt::group
