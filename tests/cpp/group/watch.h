// What a motion that a rig has recorded did, beside limits and closed forms.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rig.h"

namespace takt::group {

// The largest shares of the axes' limits, and the largest step that velocity and acceleration do not explain, u.
struct Use {
  double velocity = 0, acceleration = 0, jerk = 0, step = 0;
};

inline void Take(const KinematicState& before, const KinematicState& now, const axis::AxisLimits& limits,
                 double period_s, Use& use) {
  const double jump = now.position - before.position - period_s * 0.5 * (before.velocity + now.velocity) +
                      period_s * period_s / 12 * (now.acceleration - before.acceleration);
  const auto larger = [](double& most, double value) { most = std::isnan(value) ? 1e99 : std::max(most, value); };
  larger(use.velocity, std::abs(now.velocity) / limits.velocity);
  larger(use.acceleration, std::abs(now.acceleration) / limits.acceleration);
  larger(use.jerk, std::abs(now.acceleration - before.acceleration) / period_s / limits.jerk);
  larger(use.step, std::abs(jump));
}

// Over all cycles recorded, of all axes.
inline Use UseOf(const Rig& rig) {
  Use use;
  for (std::size_t n = 1; n < rig.trace.size(); ++n) {
    for (std::size_t i = 0; i < rig.axes.size(); ++i) {
      Take(rig.trace[n - 1].set[i], rig.trace[n].set[i], rig.axes[i].limits, rig.cycle.period_s, use);
    }
  }
  return use;
}

// Limits are kept exactly, but for rounding of differences; and no set point jumps.
inline void ExpectSmooth(const Rig& rig, const std::string& what = {}) {
  const Use use = UseOf(rig);
  EXPECT_LE(use.velocity, 1 + 1e-9) << what;
  EXPECT_LE(use.acceleration, 1 + 1e-9) << what;
  EXPECT_LE(use.jerk, 1 + 1e-6) << what;
  EXPECT_LE(use.step, 1e-4) << what;
}

// How far the tool may be from its path, mm: not at all. Axes that are asked for too much keep their limits, so it
// shows here if timing asks for it.
inline constexpr double kOnPath = 1e-6;

// The tool where the axes are told to be, in the MCS.
inline Frame ToolOf(const Rig& rig, const Sample& sample) {
  kinematics::Joints joints{};
  for (std::size_t k = 0; k < rig.kinematics->count; ++k) joints[k] = sample.set[k].position;
  Frame flange;
  EXPECT_EQ(kinematics::Forward(*rig.kinematics, joints, flange), kinematics::Reason::kNone);
  return flange * kinematics::ToFrame(rig.params.tool);
}
inline Frame ToolOf(const Rig& rig) {
  return ToolOf(rig, rig.trace.back());
}

inline double FromLine(const KDL::Vector& p, const KDL::Vector& a, const KDL::Vector& b) {
  const KDL::Vector d = b - a;
  const double share = std::clamp(KDL::dot(p - a, d) / KDL::dot(d, d), 0.0, 1.0);
  return (p - a - share * d).Norm();
}

// How far the tool was from a line at most.
inline double WorstFromLine(const Rig& rig, const KDL::Vector& a, const KDL::Vector& b) {
  double worst = 0;
  for (const Sample& sample : rig.trace) worst = std::max(worst, FromLine(ToolOf(rig, sample).p, a, b));
  return worst;
}

inline void ExpectAt(const Frame& tool, const kinematics::Pose& pose, double within = 1e-6) {
  const Frame want = kinematics::ToFrame(pose);
  EXPECT_LE((tool.p - want.p).Norm(), within);
  EXPECT_LE(KDL::diff(tool.M, want.M).Norm(), within);
}

}  // namespace takt::group
