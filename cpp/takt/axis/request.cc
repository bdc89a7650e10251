#include "takt/axis/request.h"

#include <array>
#include <limits>
#include <sstream>

#include "takt/core/describe.h"

namespace takt::axis {

namespace {

constexpr double kMaxPosition = 1e12;  // u; beyond it a double no longer tells thousandths apart

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
};

struct Maker {
  const AxisParams& params;
  Request& r;
  Refusal& why;

  // NaN is in no range.
  bool In(const char* field, double value, double low, double high) const {
    const bool inside = value >= low && value <= high;
    if (!inside) why = {field, value, low, high};
    return inside;
  }
  // One of a command's limits: what is asked for, else the axis' own, and never beyond that.
  bool Take(const char* field, std::optional<double> asked, double own, double& out) const {
    out = asked.value_or(own);
    return In(field, out, std::numeric_limits<double>::min(), own);
  }
  // Jerk 0 is unlimited, and so beyond any limit of the axis.
  bool TakeJerk(std::optional<double> asked, double own, double& out) const {
    out = asked.value_or(own);
    return own == 0 ? In("jerk", out, 0, std::numeric_limits<double>::max()) : Take("jerk", asked, own, out);
  }

  template <typename T>
  bool Ramps(const T& c) const {
    const trajectory::Limits own = params.planner_limits();
    return Take("acceleration", c.acceleration, own.acceleration, r.acceleration) &&
           Take("deceleration", c.deceleration, own.deceleration, r.deceleration) && TakeJerk(c.jerk, own.jerk, r.jerk);
  }
  template <typename T>
  bool Braking(const T& c) const {
    const trajectory::Limits own = params.planner_limits();
    r.velocity = own.velocity;
    r.acceleration = own.acceleration;
    return Take("deceleration", c.deceleration, own.deceleration, r.deceleration) && TakeJerk(c.jerk, own.jerk, r.jerk);
  }

  bool operator()(const Power& c) const {
    r.kind = RequestKind::kPower;
    r.enable = c.enable;
    r.buffer_mode = c.buffer_mode;
    return Braking(Halt{});
  }
  bool operator()(const Reset&) const { return false; }  // no request: handled where it arrives
  bool operator()(const MoveAbsolute& c) const {
    r.kind = RequestKind::kMoveAbsolute;
    r.value = c.position;
    r.direction = c.direction;
    r.buffer_mode = c.buffer_mode;
    const double low = params.rotary() ? 0 : -kMaxPosition;
    const double high = params.rotary() ? params.modulus : kMaxPosition;
    return In("position", c.position, low, high) && Take("velocity", c.velocity, params.limits.velocity, r.velocity) &&
           Ramps(c);
  }
  template <typename T>
  bool ByDistance(RequestKind kind, const T& c) const {
    r.kind = kind;
    r.value = c.distance;
    r.buffer_mode = c.buffer_mode;
    return In("distance", c.distance, -kMaxPosition, kMaxPosition) &&
           Take("velocity", c.velocity, params.limits.velocity, r.velocity) && Ramps(c);
  }
  bool operator()(const MoveRelative& c) const { return ByDistance(RequestKind::kMoveRelative, c); }
  bool operator()(const MoveAdditive& c) const { return ByDistance(RequestKind::kMoveAdditive, c); }
  bool operator()(const MoveVelocity& c) const {
    r.kind = RequestKind::kMoveVelocity;
    r.velocity = c.velocity;
    r.direction = c.direction;
    r.buffer_mode = c.buffer_mode;
    if (c.direction == Direction::kShortest) {
      why.field = "direction";
      return false;
    }
    return In("velocity", c.velocity, 0, params.limits.velocity) && Ramps(c);
  }
  bool operator()(const Halt& c) const {
    r.kind = RequestKind::kHalt;
    r.buffer_mode = c.buffer_mode;
    return Braking(c);
  }
  bool operator()(const Stop& c) const {
    r.kind = RequestKind::kStop;
    r.hold = c.hold;
    r.buffer_mode = c.buffer_mode;
    return Braking(c);
  }
  bool operator()(const Jog& c) const {
    r.kind = RequestKind::kJog;
    r.forward = c.forward;
    r.backward = c.backward;
    return Take("velocity", c.velocity, params.limits.velocity, r.velocity) && Ramps(c);
  }
};

}  // namespace

const RequestRules& RulesOf(RequestKind kind) noexcept {
  return kRules[static_cast<std::size_t>(kind)];
}

Status MakeRequest(const Command& command, const AxisParams& params, Request& out, Refusal* why) noexcept {
  Request request;
  Refusal refusal;
  const bool good = std::visit(Maker{params, request, refusal}, command);
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

std::string WhyNot(const Command& command, const AxisParams& params) {
  Request request;
  Refusal why;
  if (std::holds_alternative<Reset>(command) || MakeRequest(command, params, request, &why).ok()) return {};
  const std::string field = why.field;
  if (why.high == 0) return field + ": expected another value, this command has no such " + field;
  std::ostringstream text;
  text << field << ": expected ";
  if (field == "position" || field == "distance") {
    text << "a finite number from " << why.low << " to " << why.high;
  } else {
    text << (why.low > 0 ? "more than 0 and " : "0 or more and ") << "at most " << why.high << ", the limit of axis "
         << params.name;
  }
  text << ", found " << why.found;
  return text.str();
}

void describe(Enumeration<RequestKind>& e) {
  e.about("Which command a request came from.");
  e.value(RequestKind::kNone, "none", "None.");
  e.value(RequestKind::kPower, "power", "Power.");
  e.value(RequestKind::kMoveAbsolute, "move_absolute", "MoveAbsolute.");
  e.value(RequestKind::kMoveRelative, "move_relative", "MoveRelative.");
  e.value(RequestKind::kMoveAdditive, "move_additive", "MoveAdditive.");
  e.value(RequestKind::kMoveVelocity, "move_velocity", "MoveVelocity.");
  e.value(RequestKind::kHalt, "halt", "Halt.");
  e.value(RequestKind::kStop, "stop", "Stop.");
  e.value(RequestKind::kJog, "jog", "Jog.");
}

void describe(Description<Request>& d) {
  using R = Request;
  d.about("A checked command.");
  d.internal<&R::ticket>("Of the command.");
  d.internal<&R::value>(unit::u, "Position or distance.");
  d.internal<&R::velocity>(unit::u_s, "Largest velocity.");
  d.internal<&R::acceleration>(unit::u_s2, "Largest acceleration.");
  d.internal<&R::deceleration>(unit::u_s2, "Largest deceleration.");
  d.internal<&R::jerk>(unit::u_s3, "Largest jerk; 0: unlimited.");
  d.internal<&R::lease_s>(unit::s, "Dead man's lease; 0: none.");
  d.internal<&R::kind>("Which command.");
  d.internal<&R::direction>("Sense of travel.");
  d.internal<&R::buffer_mode>("How it follows the one before.");
  d.internal<&R::enable>("Power: on.");
  d.internal<&R::hold>("Stop: until released.");
  d.internal<&R::forward>("Jog: key for upwards.");
  d.internal<&R::backward>("Jog: key for downwards.");
}

}  // namespace takt::axis
