#include "takt/kinematics/kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace takt::kinematics {
namespace {

// Returns the part that moves the tool: the chain of all mechanisms that have one.
const Linear& Mover(const Linear& linear) {
  return linear;
}
const Delta& Mover(const Delta& delta) {
  return delta;
}
template <typename Arm>
const Chain& Mover(const Arm& arm) {
  return arm.chain;
}

// Chains and gantries always have a solution.
Reason ForwardOf(const Chain& chain, const Joints& joints, Frame& tool) {
  tool = Forward(chain, joints);
  return Reason::kNone;
}
Reason ForwardOf(const Chain& chain, const JointMotion& motion, MovingFrame& tool) {
  tool = Forward(chain, motion);
  return Reason::kNone;
}
template <typename Mechanism, typename From, typename To>
Reason ForwardOf(const Mechanism& mechanism, const From& from, To& tool) {
  return Forward(mechanism, from, tool);
}
Reason JacobianOf(const Delta& delta, const Joints& joints, Jacobian& columns) {
  return JacobianAt(delta, joints, columns);
}
template <typename Mechanism>
Reason JacobianOf(const Mechanism& mechanism, const Joints& joints, Jacobian& columns) {
  columns = JacobianAt(mechanism, joints);
  return Reason::kNone;
}

Configuration ConfigurationOf(const auto&, const Joints&) noexcept {
  return {};
}

bool AllFinite(const Kinematics& k, const Joints& joints) {
  return std::all_of(joints.begin(), joints.begin() + static_cast<std::ptrdiff_t>(k.count),
                     [](double q) { return std::isfinite(q); });
}

Joints RatesToMechanism(const Kinematics& k, const Joints& rates) {
  Joints out{};
  for (std::size_t i = 0; i < k.count; ++i) out[i] = rates[i] * k.scales[i].factor;
  return out;
}

JointMotion ToMechanism(const Kinematics& k, const JointMotion& motion) {
  return {ToMechanism(k, motion.position), RatesToMechanism(k, motion.velocity),
          RatesToMechanism(k, motion.acceleration)};
}

Joints RatesToAxes(const Kinematics& k, const Joints& rates) {
  Joints out{};
  for (std::size_t i = 0; i < k.count; ++i) out[i] = rates[i] / k.scales[i].factor;
  return out;
}

Joints Middles(const Kinematics& k) {
  Joints out{};
  for (std::size_t i = 0; i < k.count; ++i) {
    const double middle = (k.ranges[i].lower + k.ranges[i].upper) / 2;
    out[i] = std::isfinite(middle) ? middle : 0;
  }
  return out;
}

Joints FilledIn(const Kinematics& k, const Joints& near) {
  Joints out = Middles(k);
  for (std::size_t i = 0; i < k.count; ++i) {
    if (std::isfinite(near[i])) out[i] = near[i];
  }
  return out;
}

bool InRange(const Kinematics& k, const Joints& joints) {
  for (std::size_t i = 0; i < k.count; ++i) {
    if (!(joints[i] >= k.ranges[i].lower && joints[i] <= k.ranges[i].upper)) return false;
  }
  return true;
}

template <typename From, typename To>
Reason ForwardOfAny(const Kinematics& k, const From& own, To& tool) {
  const Reason reason = std::visit([&](const auto& m) { return ForwardOf(Mover(m), own, tool); }, k.mechanism);
  return reason == Reason::kNone && !Finite(tool) ? Reason::kOutOfReach : reason;  // numbers too large to multiply
}

}  // namespace

Joints ToMechanism(const Kinematics& k, const Joints& joints) noexcept {
  Joints out{};
  for (std::size_t i = 0; i < k.count; ++i) out[i] = (joints[i] - k.scales[i].zero) * k.scales[i].factor;
  return out;
}

Joints ToAxes(const Kinematics& k, const Joints& joints) noexcept {
  Joints out = RatesToAxes(k, joints);
  for (std::size_t i = 0; i < k.count; ++i) out[i] += k.scales[i].zero;
  return out;
}

Reason Forward(const Kinematics& k, const Joints& joints, Frame& tool) noexcept {
  if (!AllFinite(k, joints)) return Reason::kNotFinite;
  return ForwardOfAny(k, ToMechanism(k, joints), tool);
}

Reason Forward(const Kinematics& k, const JointMotion& motion, MovingFrame& tool) noexcept {
  if (!AllFinite(k, motion.position) || !AllFinite(k, motion.velocity) || !AllFinite(k, motion.acceleration))
    return Reason::kNotFinite;
  return ForwardOfAny(k, ToMechanism(k, motion), tool);
}

Configuration ConfigurationOf(const Kinematics& k, const Joints& joints) noexcept {
  const Joints own = ToMechanism(k, joints);
  return std::visit([&](const auto& m) { return ConfigurationOf(m, own); }, k.mechanism);
}

Reason Inverse(const Kinematics& k, const Frame& tool, const Configuration& wanted, const Joints& near,
               Joints& joints) noexcept {
  if (!Finite(tool)) return Reason::kNotFinite;
  const Joints present = ToMechanism(k, FilledIn(k, near));
  Joints own{};
  const Reason reason = std::visit(
      [&](const auto& m) {
        const Configuration branch = ConfigurationOf(m, present);
        const Configuration resolved = Resolve(wanted, branch);
        return Inverse(m, tool, resolved, resolved == branch ? present : ToMechanism(k, Middles(k)), own);
      },
      k.mechanism);
  if (reason != Reason::kNone) return reason;
  const Joints found = ToAxes(k, own);
  if (!AllFinite(k, found)) return Reason::kOutOfReach;
  if (!InRange(k, found)) return Reason::kAxisLimit;
  joints = found;
  return Reason::kNone;
}

Reason Inverse(const Kinematics& k, const MovingFrame& tool, const Configuration& wanted, const Joints& near,
               JointMotion& motion) noexcept {
  if (!Finite(tool)) return Reason::kNotFinite;
  JointMotion found;
  if (const Reason reason = Inverse(k, tool.GetFrame(), wanted, near, found.position); reason != Reason::kNone)
    return reason;
  JointMotion own{ToMechanism(k, found.position), {}, {}};
  const Reason reason = std::visit([&](const auto& m) { return SolveMotion(Mover(m), tool, own); }, k.mechanism);
  if (reason != Reason::kNone) return reason;
  found.velocity = RatesToAxes(k, own.velocity);
  found.acceleration = RatesToAxes(k, own.acceleration);
  if (!AllFinite(k, found.velocity) || !AllFinite(k, found.acceleration)) return Reason::kSingular;
  motion = found;
  return Reason::kNone;
}

Reason JacobianAt(const Kinematics& k, const Joints& joints, Jacobian& columns) noexcept {
  if (!AllFinite(k, joints)) return Reason::kNotFinite;
  const Joints own = ToMechanism(k, joints);
  const Reason reason = std::visit([&](const auto& m) { return JacobianOf(Mover(m), own, columns); }, k.mechanism);
  if (reason != Reason::kNone) return reason;
  for (std::size_t i = 0; i < k.count; ++i) columns[i] = columns[i] * k.scales[i].factor;
  return Reason::kNone;
}

}  // namespace takt::kinematics
