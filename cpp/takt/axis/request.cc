#include "takt/axis/request.h"

#include <array>
#include <sstream>

#include "takt/axis/request_builder.h"
#include "takt/core/describe.h"

namespace takt::axis {

namespace {

constexpr std::array kRules = {
    RequestRules{RequestKind::kNone, false, false, true, PlcState::kStandstill},
    RequestRules{RequestKind::kPower, true, false, true, PlcState::kStopping},
    RequestRules{RequestKind::kMoveAbsolute, true, true, true, PlcState::kDiscreteMotion},
    RequestRules{RequestKind::kMoveRelative, true, true, true, PlcState::kDiscreteMotion},
    RequestRules{RequestKind::kMoveAdditive, true, true, true, PlcState::kDiscreteMotion},
    RequestRules{RequestKind::kMoveVelocity, true, true, true, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kHalt, true, false, true, PlcState::kDiscreteMotion},
    RequestRules{RequestKind::kStop, true, false, true, PlcState::kStopping},
    RequestRules{RequestKind::kJog, false, false, false, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kMoveContinuousAbsolute, true, true, true, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kMoveContinuousRelative, true, true, true, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kInch, false, false, false, PlcState::kDiscreteMotion},
    RequestRules{RequestKind::kTorqueControl, true, false, true, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kGearIn, true, true, false, PlcState::kSynchronizedMotion},
    RequestRules{RequestKind::kGearInPos, true, false, true, PlcState::kSynchronizedMotion},
    RequestRules{RequestKind::kCombineAxes, true, false, true, PlcState::kSynchronizedMotion},
    RequestRules{RequestKind::kCamIn, true, false, true, PlcState::kSynchronizedMotion},
    RequestRules{RequestKind::kPositionProfile, true, false, true, PlcState::kDiscreteMotion},
    RequestRules{RequestKind::kVelocityProfile, true, false, true, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kAccelerationProfile, true, false, true, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kLetGo, false, false, true, PlcState::kContinuousMotion},
    RequestRules{RequestKind::kStepAbsSwitch, true, true, true, PlcState::kHoming},
    RequestRules{RequestKind::kStepLimitSwitch, true, true, true, PlcState::kHoming},
    RequestRules{RequestKind::kStepBlock, true, false, true, PlcState::kHoming},
    RequestRules{RequestKind::kStepRefPulse, true, false, true, PlcState::kHoming},
    RequestRules{RequestKind::kStepDistanceCoded, true, false, true, PlcState::kHoming},
    RequestRules{RequestKind::kStepDirect, true, false, true, PlcState::kHoming},
    RequestRules{RequestKind::kStepAbsolute, true, false, true, PlcState::kHoming},
    RequestRules{RequestKind::kFinishHoming, true, true, true, PlcState::kHoming},
    RequestRules{RequestKind::kTouch, false, false, true, PlcState::kDiscreteMotion},
    RequestRules{RequestKind::kStream, false, false, false, PlcState::kSynchronizedMotion},
    RequestRules{RequestKind::kGuided, false, false, false, PlcState::kSynchronizedMotion},
};

}  // namespace

bool Fill(const RequestBuilder& m, const Power& c) {
  m.r.kind = RequestKind::kPower;
  m.r.enable = c.enable;
  m.r.buffer_mode = c.buffer_mode;
  return m.Braking(Halt{});
}
bool Fill(const RequestBuilder&, const Reset&) {
  return true;
}
bool Fill(const RequestBuilder& m, const MoveAbsolute& c) {
  m.r.kind = RequestKind::kMoveAbsolute;
  m.r.value = c.position;
  m.r.direction = c.direction;
  m.r.buffer_mode = c.buffer_mode;
  const double low = m.params.rotary() ? 0 : -kMaxPosition;
  const double high = m.params.rotary() ? m.params.modulus : kMaxPosition;
  return m.In("position", c.position, low, high) &&
         m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}
namespace {

template <typename T>
bool ByDistance(const RequestBuilder& m, RequestKind kind, const T& c) {
  m.r.kind = kind;
  m.r.value = c.distance;
  m.r.buffer_mode = c.buffer_mode;
  return m.In("distance", c.distance, -kMaxPosition, kMaxPosition) &&
         m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}
}  // namespace

bool Fill(const RequestBuilder& m, const MoveRelative& c) {
  return ByDistance(m, RequestKind::kMoveRelative, c);
}
bool Fill(const RequestBuilder& m, const MoveAdditive& c) {
  return ByDistance(m, RequestKind::kMoveAdditive, c);
}
bool Fill(const RequestBuilder& m, const MoveContinuousAbsolute& c) {
  const MoveAbsolute move = {c.position, c.velocity,  c.acceleration, c.deceleration,
                             c.jerk,     c.direction, c.buffer_mode};
  if (!Fill(m, move)) return false;
  m.r.kind = RequestKind::kMoveContinuousAbsolute;
  m.r.end_velocity = c.end_velocity;
  return m.In("end_velocity", c.end_velocity, 0, m.params.limits.velocity);
}

bool Fill(const RequestBuilder& m, const MoveContinuousRelative& c) {
  m.r.end_velocity = c.end_velocity;
  return ByDistance(m, RequestKind::kMoveContinuousRelative, c) &&
         m.In("end_velocity", c.end_velocity, 0, m.params.limits.velocity);
}

bool Fill(const RequestBuilder& m, const Inch& c) {
  return ByDistance(
      m, RequestKind::kInch,
      MoveRelative{c.distance, c.velocity, c.acceleration, c.deceleration, c.jerk, BufferMode::kAborting});
}

bool Fill(const RequestBuilder& m, const MoveVelocity& c) {
  m.r.kind = RequestKind::kMoveVelocity;
  m.r.velocity = c.velocity;
  m.r.direction = c.direction;
  m.r.buffer_mode = c.buffer_mode;
  if (c.direction == Direction::kShortest) {
    m.why.field = "direction";
    return false;
  }
  return m.In("velocity", c.velocity, 0, m.params.limits.velocity) && m.Ramps(c);
}
bool Fill(const RequestBuilder& m, const Halt& c) {
  m.r.kind = RequestKind::kHalt;
  m.r.buffer_mode = c.buffer_mode;
  return m.Braking(c);
}
bool Fill(const RequestBuilder& m, const Stop& c) {
  m.r.kind = RequestKind::kStop;
  m.r.hold = c.hold;
  m.r.buffer_mode = c.buffer_mode;
  return m.Braking(c);
}
bool Fill(const RequestBuilder& m, const Jog& c) {
  m.r.kind = RequestKind::kJog;
  m.r.forward = c.forward;
  m.r.backward = c.backward;
  return m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}

const RequestRules& RulesOf(RequestKind kind) noexcept {
  return kRules[static_cast<std::size_t>(kind)];
}

Status MakeRequest(const Command& command, const AxisParams& params, Request& out, Refusal* why) noexcept {
  Request request;
  Refusal refusal;
  const bool good = std::visit(
      [maker = RequestBuilder{params, request, refusal}](const auto& c) {
        if constexpr (requires { c.update&& c.buffer_mode == BufferMode::kAborting; }) {
          maker.r.update = c.update && c.buffer_mode == BufferMode::kAborting;
        }
        return Fill(maker, c);
      },
      command);
  if (why) *why = refusal;
  if (!good) return Status::Failed(ErrorId::kParameter);
  const RequestRules& rules = RulesOf(request.kind);
  const bool known = request.buffer_mode <= BufferMode::kBlendingHigh && request.direction <= Direction::kNegative;
  if (!known || (request.buffer_mode == BufferMode::kBuffered && !rules.may_be_buffered) ||
      (request.blends() && !rules.may_be_blended)) {
    if (why) why->field = known ? "buffer_mode" : "direction or buffer_mode";
    return Status::Failed(ErrorId::kParameter);
  }
  out = request;
  return Status::Ok();
}

namespace {

// Returns the buffer modes of a command, for users.
std::string ModesOf(const Command& command, const AxisParams& params) {
  Request request;
  Refusal refusal;
  std::visit([maker = RequestBuilder{params, request, refusal}](const auto& c) { return Fill(maker, c); }, command);
  const RequestRules& rules = RulesOf(request.kind);
  std::string modes = "aborting";
  if (rules.may_be_buffered) modes += rules.may_be_blended ? ", buffered" : " or buffered";
  if (rules.may_be_blended) modes += " or one of the blending modes";
  return modes;
}

}  // namespace

std::string Diagnose(const Command& command, const AxisParams& params) {
  Request request;
  Refusal why;
  if (MakeRequest(command, params, request, &why).ok()) return {};
  const std::string field = why.field;
  if (field == "master" && why.high == 0) return "master: expected the name of another axis than " + params.name;
  if (why.high == 0 && (field == "cam" || field == "profile")) return field + ": expected the name of a cam";
  if (field == "master_scaling") return "master_scaling: expected a number other than 0 from -1e12 to 1e12";
  if (field == "buffer_mode") return "buffer_mode: expected " + ModesOf(command, params);
  if (why.high == 0) return field + ": expected another value, this command has no such " + field;
  const bool of_axis = field == "velocity" || field == "acceleration" || field == "deceleration" || field == "jerk" ||
                       field == "end_velocity";
  const bool open = why.high > kMaxPosition;
  std::ostringstream text;
  text << field << ": expected ";
  if (why.low == std::numeric_limits<double>::min()) {
    text << "more than 0";
    if (!open) text << " and at most " << why.high;
  } else if (open) {
    text << "at least " << why.low;
  } else {
    text << "a number from " << why.low << " to " << why.high;
  }
  if (of_axis && !open) text << ", the limit of axis " << params.name;
  text << ", found " << why.found;
  return text.str();
}

void describe(Enumeration<RequestKind>& e) {
  e.about("Command that a request came from.");
  e.value(RequestKind::kNone, "none", "None.");
  e.value(RequestKind::kPower, "power", "Power.");
  e.value(RequestKind::kMoveAbsolute, "move_absolute", "MoveAbsolute.");
  e.value(RequestKind::kMoveRelative, "move_relative", "MoveRelative.");
  e.value(RequestKind::kMoveAdditive, "move_additive", "MoveAdditive.");
  e.value(RequestKind::kMoveVelocity, "move_velocity", "MoveVelocity.");
  e.value(RequestKind::kHalt, "halt", "Halt.");
  e.value(RequestKind::kStop, "stop", "Stop.");
  e.value(RequestKind::kJog, "jog", "Jog.");
  e.value(RequestKind::kMoveContinuousAbsolute, "move_continuous_absolute", "MoveContinuousAbsolute.");
  e.value(RequestKind::kMoveContinuousRelative, "move_continuous_relative", "MoveContinuousRelative.");
  e.value(RequestKind::kInch, "inch", "Inch.");
  e.value(RequestKind::kTorqueControl, "torque_control", "TorqueControl.");
  e.value(RequestKind::kGearIn, "gear_in", "GearIn.");
  e.value(RequestKind::kGearInPos, "gear_in_pos", "GearInPos.");
  e.value(RequestKind::kCombineAxes, "combine_axes", "CombineAxes.");
  e.value(RequestKind::kCamIn, "cam_in", "CamIn.");
  e.value(RequestKind::kPositionProfile, "position_profile", "PositionProfile.");
  e.value(RequestKind::kVelocityProfile, "velocity_profile", "VelocityProfile.");
  e.value(RequestKind::kAccelerationProfile, "acceleration_profile", "AccelerationProfile.");
  e.value(RequestKind::kLetGo, "let_go", "LetGo.");
  e.value(RequestKind::kStepAbsSwitch, "step_abs_switch", "StepAbsSwitch.");
  e.value(RequestKind::kStepLimitSwitch, "step_limit_switch", "StepLimitSwitch.");
  e.value(RequestKind::kStepBlock, "step_block", "StepBlock.");
  e.value(RequestKind::kStepRefPulse, "step_ref_pulse", "StepRefPulse.");
  e.value(RequestKind::kStepDistanceCoded, "step_distance_coded", "StepDistanceCoded.");
  e.value(RequestKind::kStepDirect, "step_direct", "StepDirect.");
  e.value(RequestKind::kStepAbsolute, "step_absolute", "StepAbsolute.");
  e.value(RequestKind::kFinishHoming, "finish_homing", "FinishHoming.");
  e.value(RequestKind::kTouch, "touch", "Touch.");
  e.value(RequestKind::kStream, "stream", "Stream.");
  e.value(RequestKind::kGuided, "guided", "Set points of another component of the machine.");
}

void describe(Description<Request>& d) {
  using R = Request;
  d.about("A checked command.");
  d.internal<&R::ticket>("Ticket of the command.");
  d.internal<&R::value>(unit::u, "Position or distance.");
  d.internal<&R::velocity>(unit::u_s, "Largest velocity.");
  d.internal<&R::acceleration>(unit::u_s2, "Largest acceleration.");
  d.internal<&R::deceleration>(unit::u_s2, "Largest deceleration.");
  d.internal<&R::jerk>(unit::u_s3, "Largest jerk; 0: unlimited.");
  d.internal<&R::torque_ramp>("Torque control: Nm/s; 0: at once.");
  d.internal<&R::end_velocity>(unit::u_s, "Speed that a continuous move keeps at its position.");
  d.internal<&R::timeout_s>(unit::s, "Longest time without a set point of a stream.");
  d.internal<&R::key>("Key that set points of a stream must carry.");
  d.internal<&R::lease_s>(unit::s, "Dead man's lease; 0: none.");
  d.internal<&R::kind>("Kind of command.");
  d.internal<&R::direction>("Sense of travel.");
  d.internal<&R::buffer_mode>("How the command follows the previous one.");
  d.internal<&R::enable>("Power: switch on.");
  d.internal<&R::hold>("Stop: hold until released.");
  d.internal<&R::update>("Changes the command of its kind that is in control.");
  d.internal<&R::forward>("Jog: key for upwards.");
  d.internal<&R::backward>("Jog: key for downwards.");
  d.internal<&R::coupling>("Parameters of commands that couple axes.");
  d.internal<&R::table>("Parameters of commands that follow a table.");
  d.internal<&R::homing>("Parameters of homing steps.");
}

}  // namespace takt::axis
