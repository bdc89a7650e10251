// A pose from outside: of a mover, a camera, another robot that reports its position and velocity. Between two messages
// it continues at its last velocity.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/kinematics/carrier.h"

namespace takt::conveyor {

struct PoseParams {
  std::string name;
  double goes_on_s = 0.5;  // [s] after a message during which it continues to move; then it is at rest
};

// Pose and velocity, in the world.
struct SetPose {
  double x = 0, y = 0, z = 0;     // [mm]
  double a = 0, b = 0, c = 0;     // [deg]
  double vx = 0, vy = 0, vz = 0;  // [mm/s]
  double wx = 0, wy = 0, wz = 0;  // [deg/s] about X, Y and Z of the world
  double age_s = 0;               // [s] age of these values
};
using PoseCommand = std::variant<SetPose>;

struct PoseState {
  SetPose last;
  std::uint64_t cycle = 0;  // in which it was received
  bool known = false;       // a pose has been received
};

struct PoseOutputs {
  kinematics::Pose pose;  // in the world; nan until one has been received
  double velocity = 0;    // [mm/s]
  double turning = 0;     // [deg/s]
  double age_s = 0;       // [s] age of the last values
  bool fresh = false;     // it is within goes_on_s
};

// Carries the command out or refuses it, and reports either.
void Apply(const Cycle& cycle, FeedbackSink& feedback, Ticket ticket, const PoseCommand& command,
           PoseState& state) noexcept;
// Returns the carrier at the instant for which the axes get their set points in this cycle; kNone until a pose has been
// received.
kinematics::Carrier CarrierOf(const PoseParams& params, const Cycle& cycle, const PoseState& state) noexcept;
void Publish(const PoseParams& params, const Cycle& cycle, const PoseState& state, PoseOutputs& out) noexcept;

void describe(Description<PoseParams>&);
void describe(Description<SetPose>&);
void describe(Description<PoseState>&);
void describe(Description<PoseOutputs>&);

}  // namespace takt::conveyor
