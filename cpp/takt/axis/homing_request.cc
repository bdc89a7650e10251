#include "takt/axis/homing_request.h"

#include "takt/axis/request_builder.h"

namespace takt::axis {

namespace {

template <typename T>
bool Search(const RequestBuilder& m, RequestKind kind, const T& c) {
  m.r.kind = kind;
  m.r.homing.direction = c.direction;
  m.r.homing.time_limit = c.time_limit;
  m.r.homing.distance_limit = c.distance_limit;
  const double most = m.params.limits.torque.value_or(kMaxTorque);
  if (c.torque_limit && !m.Take("torque_limit", c.torque_limit, most, m.r.homing.torque_limit)) return false;
  if (c.direction > HomingDirection::kSwitchNegative) {
    m.why.field = "direction";
    return false;
  }
  m.r.buffer_mode = c.buffer_mode;
  return m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c) &&
         m.In("time_limit", c.time_limit, 0, kMaxPosition) && m.In("distance_limit", c.distance_limit, 0, kMaxPosition);
}

template <typename T>
bool SwitchSearch(const RequestBuilder& m, RequestKind kind, const T& c) {
  m.r.homing.switch_mode = c.switch_mode;
  m.r.homing.sets_position = c.set_position.has_value();
  m.r.homing.set_position = c.set_position.value_or(0);
  if (c.switch_mode > SwitchMode::kEdgeSwitchNegative) {
    m.why.field = "switch_mode";
    return false;
  }
  return Search(m, kind, c) && m.In("set_position", c.set_position.value_or(0), -kMaxPosition, kMaxPosition);
}

// Without a switch nothing could select the direction.
bool OneWay(const RequestBuilder& m, HomingDirection direction) {
  const bool good = direction == HomingDirection::kPositive || direction == HomingDirection::kNegative;
  if (!good) m.why.field = "direction";
  return good;
}

bool Position(const RequestBuilder& m, double position) {
  m.r.homing.set_position = position;
  return m.In("set_position", position, -kMaxPosition, kMaxPosition);
}

}  // namespace

namespace {

template <typename Step>
Step StepOf(const HomingParams& h, const Home& c) {
  Step step;
  step.direction = h.direction;
  step.velocity = h.velocity;
  if constexpr (requires { step.set_position; }) step.set_position = c.position;
  step.buffer_mode = c.buffer_mode;
  step.time_limit = h.time_limit;
  step.distance_limit = h.distance_limit;
  step.torque_limit = h.torque_limit;
  return step;
}

template <typename Step>
bool HomeBySwitch(const RequestBuilder& m, const Home& c) {
  const HomingParams& h = m.params.homing;
  Step step = StepOf<Step>(h, c);
  step.switch_mode = h.switch_mode;
  if (!Fill(m, step)) return false;
  m.r.homing.ends = true;
  m.r.homing.sets_position = !h.pulse_velocity;
  m.r.homing.pulse_velocity = h.pulse_velocity.value_or(0);
  m.r.homing.pulse_direction = h.pulse_direction;
  return true;
}

}  // namespace

bool Fill(const RequestBuilder& m, const Home& c) {
  const HomingParams& h = m.params.homing;
  if (!Position(m, c.position)) return false;
  switch (h.method) {
    case HomingMethod::kDirect:
      return Fill(m, StepDirect{c.position, c.buffer_mode});
    case HomingMethod::kAbsolute:
      return Fill(m, StepAbsolute{c.buffer_mode});
    case HomingMethod::kSwitch:
      return HomeBySwitch<StepAbsSwitch>(m, c);
    case HomingMethod::kLimitSwitch:
      return HomeBySwitch<StepLimitSwitch>(m, c);
    case HomingMethod::kBlock: {
      StepBlock step = StepOf<StepBlock>(h, c);
      step.deviation = h.deviation;
      return Fill(m, step);
    }
    case HomingMethod::kPulse:
      return Fill(m, StepOf<StepRefPulse>(h, c));
    case HomingMethod::kDistanceCoded:
      return Fill(m, StepOf<StepDistanceCoded>(h, c));
  }
  return false;
}

bool Fill(const RequestBuilder& m, const StepAbsSwitch& c) {
  return SwitchSearch(m, RequestKind::kStepAbsSwitch, c);
}

bool Fill(const RequestBuilder& m, const StepLimitSwitch& c) {
  return SwitchSearch(m, RequestKind::kStepLimitSwitch, c);
}

bool Fill(const RequestBuilder& m, const StepBlock& c) {
  m.r.homing.deviation = c.deviation;
  const double largest = m.params.supervision.deviation_moving.value_or(kMaxPosition);
  return OneWay(m, c.direction) && m.In("deviation", c.deviation, std::numeric_limits<double>::min(), largest) &&
         Position(m, c.set_position) && Search(m, RequestKind::kStepBlock, c);
}

bool Fill(const RequestBuilder& m, const StepRefPulse& c) {
  return OneWay(m, c.direction) && Position(m, c.set_position) && Search(m, RequestKind::kStepRefPulse, c);
}

bool Fill(const RequestBuilder& m, const StepDistanceCoded& c) {
  return OneWay(m, c.direction) && Search(m, RequestKind::kStepDistanceCoded, c);
}

bool Fill(const RequestBuilder& m, const StepDirect& c) {
  m.r.kind = RequestKind::kStepDirect;
  m.r.buffer_mode = c.buffer_mode;
  return Position(m, c.set_position);
}

bool Fill(const RequestBuilder& m, const StepAbsolute& c) {
  m.r.kind = RequestKind::kStepAbsolute;
  m.r.buffer_mode = c.buffer_mode;
  return true;
}

bool Fill(const RequestBuilder& m, const FinishHoming& c) {
  m.r.kind = RequestKind::kFinishHoming;
  m.r.buffer_mode = c.buffer_mode;
  m.r.value = c.distance;
  return m.In("distance", c.distance, -kMaxPosition, kMaxPosition) &&
         m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}

namespace {

template <typename T>
bool Flying(const RequestBuilder& m, const T& c) {
  return m.In("set_position", c.set_position, -kMaxPosition, kMaxPosition) &&
         m.In("time_limit", c.time_limit, 0, kMaxPosition) && m.In("distance_limit", c.distance_limit, 0, kMaxPosition);
}

}  // namespace

bool Fill(const RequestBuilder& m, const StepRefFlyingSwitch& c) {
  if (c.switch_mode > SwitchMode::kEdgeSwitchNegative) {
    m.why.field = "switch_mode";
    return false;
  }
  return Flying(m, c);
}

bool Fill(const RequestBuilder& m, const StepRefFlyingRefPulse& c) {
  return Flying(m, c);
}

void describe(Description<HomingRequest>& d) {
  using H = HomingRequest;
  d.about("Parameters of a homing step.");
  d.internal<&H::direction>("Direction in which the search begins.");
  d.internal<&H::switch_mode>("State or edge of the switch that ends the search.");
  d.internal<&H::set_position>(unit::u, "Position to be set at the position found.");
  d.internal<&H::sets_position>("The position is set; else positions keep their values.");
  d.internal<&H::deviation>(unit::u, "Following error at an end stop.");
  d.internal<&H::time_limit>(unit::s, "Longest duration of the search; 0: unlimited.");
  d.internal<&H::distance_limit>(unit::u, "Longest distance of the search; 0: unlimited.");
  d.internal<&H::torque_limit>(unit::nm, "Largest torque; 0: the limit of the axis.");
  d.internal<&H::until_halt>("A halt or a stop ends a search during another motion.");
  d.internal<&H::ends>("The search of a switch ends homing.");
  d.internal<&H::pulse_velocity>(unit::u_s, "Velocity of the search for the index pulse after the switch; 0: none.");
  d.internal<&H::pulse_direction>("Direction of that search.");
}

}  // namespace takt::axis
