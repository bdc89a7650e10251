#include "takt/kinematics/solutions.h"

#include <algorithm>
#include <cmath>

namespace takt::kinematics {

namespace {

constexpr std::array kShoulders = {Shoulder::kFront, Shoulder::kBack};
constexpr std::array kElbows = {Elbow::kPositive, Elbow::kNegative};
constexpr std::array kWrists = {Wrist::kPositive, Wrist::kNegative};

template <typename T>
bool Wants(T wanted, T one) {
  return wanted == T::kKeep || wanted == one;
}

// Out of reach in one configuration is less specific than singular in another.
void TakeReason(const Configuration& in, Reason reason, Solutions& out) {
  if (reason != Reason::kOutOfReach) out.reason = reason;
  if (out.failed_count == kMostSolutions) return;
  out.failed[out.failed_count] = in;
  out.failed_for[out.failed_count++] = reason;
}

void Add(const Kinematics& k, const Configuration& in, const Joints& own, Solutions& out) {
  const Joints found = ToAxes(k, own);
  const bool finite = std::all_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(k.count),
                                  [](double position) { return std::isfinite(position); });
  if (!finite || out.count == kMostSolutions) return;
  out.in[out.count] = in;
  out.of[out.count++] = found;
}

bool IsThere(const Chain& chain, const Joints& own, const Frame& tool) {
  const Frame at = Forward(chain, own);
  return (at.p - tool.p).Norm() <= kSlack && ArcBetween(at.M, tool.M).angle <= kSlack;
}

template <typename Mechanism>
void Try(const Kinematics& k, const Mechanism& mechanism, const Frame& tool, const Configuration& in,
         const Joints& present, Solutions& out) {
  Joints own{};
  const Reason reason = Inverse(mechanism, tool, in, present, own);
  if (reason != Reason::kNone) return TakeReason(in, reason, out);
  Add(k, in, own, out);
}

void TryAll(const Kinematics& k, const SixAxis& arm, const Frame& tool, const Configuration& wanted,
            const Joints& present, Solutions& out) {
  for (const Shoulder shoulder : kShoulders) {
    for (const Elbow elbow : kElbows) {
      for (const Wrist wrist : kWrists) {
        if (!Wants(wanted.shoulder, shoulder) || !Wants(wanted.elbow, elbow) || !Wants(wanted.wrist, wrist)) continue;
        Try(k, arm, tool, {shoulder, elbow, wrist}, present, out);
      }
    }
  }
}

void TryAll(const Kinematics& k, const Scara& scara, const Frame& tool, const Configuration& wanted,
            const Joints& present, Solutions& out) {
  for (const Elbow elbow : kElbows) {
    if (Wants(wanted.elbow, elbow)) Try(k, scara, tool, {.elbow = elbow}, present, out);
  }
}

// A closed form gives the starting point; the iteration meets the chain itself to the last bit.
void TryAll(const Kinematics& k, const Serial& serial, const Frame& tool, const Configuration& wanted,
            const Joints& present, Solutions& out) {
  if (!serial.closed.known) return Try(k, serial, tool, {}, present, out);
  const ClosedForm& form = serial.closed;
  const Frame flange = form.base.Inverse() * tool * form.flange.Inverse();
  Joints near{};
  for (std::size_t i = 0; i < serial.chain.count; ++i) near[i] = form.zero[i] + form.sign[i] * present[i];
  for (const Shoulder shoulder : kShoulders) {
    for (const Elbow elbow : kElbows) {
      for (const Wrist wrist : kWrists) {
        if (!Wants(wanted.shoulder, shoulder) || !Wants(wanted.elbow, elbow) || !Wants(wanted.wrist, wrist)) continue;
        Joints arm{};
        const Configuration in = {shoulder, elbow, wrist};
        const Reason reason =
            std::visit([&](const auto& own) { return Inverse(own, flange, in, near, arm); }, form.arm);
        if (reason != Reason::kNone) {
          TakeReason(in, reason, out);
          continue;
        }
        for (std::size_t i = 0; i < serial.chain.count; ++i) arm[i] = form.sign[i] * (arm[i] - form.zero[i]);
        if (IsThere(serial.chain, arm, tool)) {
          Add(k, in, arm, out);
        } else {
          Try(k, serial, tool, in, arm, out);
        }
      }
    }
  }
}

template <typename Mechanism>
void TryAll(const Kinematics& k, const Mechanism& mechanism, const Frame& tool, const Configuration&,
            const Joints& present, Solutions& out) {
  Try(k, mechanism, tool, {}, present, out);
}

}  // namespace

Solutions SolutionsOf(const Kinematics& k, const Frame& tool, const Configuration& wanted,
                      const Joints& near) noexcept {
  Solutions out;
  if (!Finite(tool)) {
    out.reason = Reason::kNotFinite;
    return out;
  }
  const Joints present = ToMechanism(k, near);
  std::visit([&](const auto& mechanism) { TryAll(k, mechanism, tool, wanted, present, out); }, k.mechanism);
  if (out.count > 0) out.reason = Reason::kNone;
  return out;
}

}  // namespace takt::kinematics
