// How a command becomes a request: one Fill for each command, which checks its values and copies what is needed.
// Returns false if the command is rejected; `why` then says why. A command that does not take control leaves kind
// kNone.
#pragma once

#include <limits>

#include "takt/axis/request.h"
#include "takt/core/describe.h"

namespace takt::axis {

inline constexpr double kMaxTorque = 1e9;     // [Nm]
inline constexpr double kMaxPosition = 1e12;  // [u] beyond it a double does not resolve thousandths

struct RequestBuilder {
  const AxisParams& params;
  Request& r;
  Refusal& why;

  // Returns true if the value is within the range; NaN is in no range.
  bool In(const char* field, double value, double low, double high) const {
    const bool inside = value >= low && value <= high;
    if (!inside) why = {field, value, low, high};
    return inside;
  }
  // Takes one of a command's limits: the value asked for, or the axis' own, which it must not exceed.
  bool Take(const char* field, std::optional<double> asked, double own, double& out) const {
    out = asked.value_or(own);
    return In(field, out, std::numeric_limits<double>::min(), own);
  }
  // Jerk 0 is unlimited, and so exceeds any jerk limit of the axis.
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
};

bool Fill(const RequestBuilder& m, const Power& c);
bool Fill(const RequestBuilder& m, const Reset& c);
bool Fill(const RequestBuilder& m, const Straighten& c);
bool Fill(const RequestBuilder& m, const MoveAbsolute& c);
bool Fill(const RequestBuilder& m, const MoveRelative& c);
bool Fill(const RequestBuilder& m, const MoveAdditive& c);
bool Fill(const RequestBuilder& m, const MoveVelocity& c);
bool Fill(const RequestBuilder& m, const Halt& c);
bool Fill(const RequestBuilder& m, const Stop& c);
bool Fill(const RequestBuilder& m, const Jog& c);
bool Fill(const RequestBuilder& m, const TouchProbe& c);
bool Fill(const RequestBuilder& m, const Touch& c);
bool Fill(const RequestBuilder& m, const TorqueControl& c);
bool Fill(const RequestBuilder& m, const GearIn& c);
bool Fill(const RequestBuilder& m, const GearOut& c);
bool Fill(const RequestBuilder& m, const GearInPos& c);
bool Fill(const RequestBuilder& m, const CombineAxes& c);
bool Fill(const RequestBuilder& m, const CamTableSelect& c);
bool Fill(const RequestBuilder& m, const CamIn& c);
bool Fill(const RequestBuilder& m, const CamAdd& c);
bool Fill(const RequestBuilder& m, const CamOut& c);
bool Fill(const RequestBuilder& m, const PositionProfile& c);
bool Fill(const RequestBuilder& m, const VelocityProfile& c);
bool Fill(const RequestBuilder& m, const AccelerationProfile& c);
bool Fill(const RequestBuilder& m, const PhasingAbsolute& c);
bool Fill(const RequestBuilder& m, const PhasingRelative& c);
bool Fill(const RequestBuilder& m, const MoveContinuousAbsolute& c);
bool Fill(const RequestBuilder& m, const MoveContinuousRelative& c);
bool Fill(const RequestBuilder& m, const Inch& c);
bool Fill(const RequestBuilder& m, const MoveSuperimposed& c);
bool Fill(const RequestBuilder& m, const HaltSuperimposed& c);
bool Fill(const RequestBuilder& m, const SetConstants& c);
bool Fill(const RequestBuilder& m, const SetLoad& c);
bool Fill(const RequestBuilder& m, const WriteParameter& c);
bool Fill(const RequestBuilder& m, const ReadParameter& c);
bool Fill(const RequestBuilder& m, const SetSoftLimits& c);
bool Fill(const RequestBuilder& m, const DirectOutput& c);
bool Fill(const RequestBuilder& m, const PulseOutput& c);
bool Fill(const RequestBuilder& m, const WriteOutput& c);
bool Fill(const RequestBuilder& m, const SetPosition& c);
bool Fill(const RequestBuilder& m, const SetOverride& c);
bool Fill(const RequestBuilder& m, const Home& c);
bool Fill(const RequestBuilder& m, const StepAbsSwitch& c);
bool Fill(const RequestBuilder& m, const StepLimitSwitch& c);
bool Fill(const RequestBuilder& m, const StepBlock& c);
bool Fill(const RequestBuilder& m, const StepRefPulse& c);
bool Fill(const RequestBuilder& m, const StepDistanceCoded& c);
bool Fill(const RequestBuilder& m, const StepDirect& c);
bool Fill(const RequestBuilder& m, const StepAbsolute& c);
bool Fill(const RequestBuilder& m, const FinishHoming& c);
bool Fill(const RequestBuilder& m, const StepRefFlyingSwitch& c);
bool Fill(const RequestBuilder& m, const StepRefFlyingRefPulse& c);
bool Fill(const RequestBuilder& m, const Stream& c);
bool Fill(const RequestBuilder& m, const StreamPoint& c);
template <typename T>
bool Fill(const RequestBuilder&, const T&) {
  return true;
}

}  // namespace takt::axis
