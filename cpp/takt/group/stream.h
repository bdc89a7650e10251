// Set points streamed from outside for a group (AX-114); axis/stream.h does this for an axis.
//
// A set point is converted to one for each axis on arrival: by the inverse kinematics from the previous one, so in its
// branch. Each axis follows its own curve through them, all with the same times, within its limits
// (trajectory/demand_follower.h). Between set points the tool deviates from the straight line by what the axes bend in
// that time.
//
// Invariant: with the set points given, braking each axis at its limits ends within its SW limits, and outside zones of
// other groups; a set point that would break that is not given, and the stream ends.
#pragma once

#include <array>
#include <cstdint>

#include "takt/axis/stream.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/group/commands.h"
#include "takt/group/params.h"
#include "takt/kinematics/joints.h"

namespace takt::group {

struct Context;
struct State;

struct StreamState {
  Ticket ticket = 0;  // 0: none
  std::int32_t key = 0;
  double delay = 0;    // [s]
  double timeout = 0;  // [s]
  double velocity_factor = 1;
  double acceleration_factor = 1;
  double jerk_factor = 1;
  bool reached = false;                          // all axes have been on their curves once
  std::array<axis::StreamState, kMaxAxes> of{};  // of each member; all have the same times
  std::array<double, kZones> zones_until{};      // [s] by the sender's clock: end of the set points in each zone
  std::uint32_t zones = 0;                       // claimed for set points, a mask
};

bool Streams(const State& s) noexcept;
// Takes control at once: what the group did before is aborted, without a stop. Returns an error, with nothing
// changed, if a member cannot be controlled.
ErrorId BeginStream(const Context& c, Ticket ticket, const Stream& command, State& s) noexcept;
ErrorId TakePoint(const Context& c, const StreamPoint& command, State& s) noexcept;
// Ends the stream: each axis comes to rest individually, within its limits.
void EndStream(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
// Stage move: computes the next set points of the members.
void FollowStream(const Context& c, State& s) noexcept;

// Returns the positions at which the members come to rest if each is braked individually from now on.
kinematics::Joints JointsBraked(const Context& c, const State& s) noexcept;

void describe(Description<StreamState>&);

}  // namespace takt::group
