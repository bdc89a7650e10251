// A pose that comes from elsewhere: a mover, a camera, another robot that says where it is and how it moves. Between
// two messages it goes on as it moves.
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
  double goes_on_s = 0.5;  // s after a message in which it goes on; then it stands
};

// Where it is and how it moves, in the world.
struct SetPose {
  double x = 0, y = 0, z = 0;     // mm
  double a = 0, b = 0, c = 0;     // deg
  double vx = 0, vy = 0, vz = 0;  // mm/s
  double wx = 0, wy = 0, wz = 0;  // deg/s, about X, Y and Z of the world
  double age_s = 0;               // s since it was so
};
using PoseCommand = std::variant<SetPose>;

struct PoseState {
  SetPose last;
  std::uint64_t cycle = 0;  // in which it came
  bool known = false;       // one has come
};

struct PoseOutputs {
  kinematics::Pose pose;  // in the world; nan until one has come
  double velocity = 0;    // mm/s
  double turning = 0;     // deg/s
  double age_s = 0;       // s since it was so
  bool fresh = false;     // it goes on
};

// Carries the command out, or refuses it; reports either way.
void Apply(const Cycle& cycle, FeedbackSink& feedback, Ticket ticket, const PoseCommand& command,
           PoseState& state) noexcept;
// At the instant for which the axes get their set points in this cycle. Of kind kNone until one has come.
kinematics::Carrier CarrierOf(const PoseParams& params, const Cycle& cycle, const PoseState& state) noexcept;
void Publish(const PoseParams& params, const Cycle& cycle, const PoseState& state, PoseOutputs& out) noexcept;

void describe(Description<PoseParams>&);
void describe(Description<SetPose>&);
void describe(Description<PoseState>&);
void describe(Description<PoseOutputs>&);

}  // namespace takt::conveyor
