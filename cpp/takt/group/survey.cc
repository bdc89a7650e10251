#include "takt/group/survey.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "takt/group/join.h"
#include "takt/group/make_stretch.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

// [mm or deg] between two samples, on lines and on bends; in between the axes are assumed to move straight.
constexpr double kStep = 1;
constexpr double kStepInBend = 0.25;
constexpr double kFewest = 8;
constexpr double kMost = 100000;  // on an element
constexpr double kOnBlendOfAxes = 32;

double StepsOn(const Stretch& stretch, bool blend) {
  if (stretch.joints || stretch.segment.measure == path::Measure::kAuxiliaries) return blend ? kOnBlendOfAxes : 1;
  const double step = stretch.segment.shape == path::Shape::kLine ? kStep : kStepInBend;
  return std::clamp(std::ceil(stretch.segment.length / step), kFewest, kMost);
}

}  // namespace

// A group as in the cycle that only plans.
struct Survey::Inside {
  explicit Inside(const Fixed& f) : fixed(f), ahead({}, f.cycle.period_s), sink({}) {}

  Context Now() {
    Context c{fixed.params, fixed.mounting, &fixed.kinematics, fixed.paths, {}, 0, {}, fixed.cycle, sink, ahead};
    c.axes.params = axes;
    return c;
  }

  void Begin(const PathCheckRequest& q) {
    MountTool(kinematics::ToFrame(q.tool), fixed.mounting);
    for (std::size_t k = 0; k < kMaxAxes; ++k) {
      state.members[k] = q.members[k] ? static_cast<std::uint32_t>(k + 1) : 0;
      axes[k].limits.lower = q.ranges[k].lower;
      axes[k].limits.upper = q.ranges[k].upper;
      axes[k].limits.velocity = q.limits.of[k].velocity;  // for the choice of configurations
    }
    ahead.window.SetLimits(q.limits);
    GoTo(q.from);
    way = 0;
  }
  void GoTo(const kinematics::Joints& joints) {
    ahead.end_joints = joints;
    ToolAt(Now(), joints, ahead.end_tool);
  }

  // Samples from the end of `ahead`. `s_at_begin`, `s_at_end`: values of s at both ends, even over the stretch.
  kinematics::Reason Walk(const Stretch& stretch, bool blend, kinematics::Joints near, double s_at_begin,
                          double s_at_end) {
    samples.clear();
    const double steps = StepsOn(stretch, blend);
    for (double i = 0; i <= steps; ++i) {
      kinematics::JointMotion motion;
      const kinematics::Reason reason = AxesOn(Now(), state, stretch, stretch.segment.length * i / steps, near, motion);
      if (reason != kinematics::Reason::kNone) return reason;
      near = motion.position;
      samples.push_back({std::max(0.0, std::lerp(s_at_begin, s_at_end, i / steps)), near});
    }
    return kinematics::Reason::kNone;
  }

  kinematics::Reason Run(const PathCheckRequest& q, const std::function<bool(const Part&)>& use);

  Fixed fixed;
  LookAhead ahead;
  State state;
  FeedbackSink sink;
  std::array<axis::AxisParams, kMaxAxes> axes;
  std::vector<workspace::Sample> samples;
  double way = 0;  // at the end of `ahead`
};

kinematics::Reason Survey::Inside::Run(const PathCheckRequest& q, const std::function<bool(const Part&)>& use) {
  Begin(q);
  const bool path = q.move.kind == MoveKind::kPath;
  std::optional<Stretch> before;
  if (q.follows) before = q.before;
  for (std::uint32_t i = 0; i < ElementsOf(Now(), q.move); ++i) {
    ahead.next = {};
    state.problem = path::Problem::kNone;
    const ErrorId error = MakeStretch(Now(), q.move, i, ahead, state);
    if (state.problem == path::Problem::kLengthZero) continue;
    if (error != ErrorId::kNone) return kinematics::Reason::kOutOfReach;
    Stretch& next = ahead.next;
    next.to = next.segment.length;
    Part part{path ? i + 1 : 0, true, next.segment.measure, {}};
    CornerBlend blend;
    int work = 0;
    if (before && FindBlend(Now(), state, q.move, i, *before, next, work, blend)) {
      kinematics::JointMotion at;
      const double leaves = before->to - blend.first;
      kinematics::Reason reason = AxesOn(Now(), state, *before, leaves, ahead.end_joints, at);
      if (reason == kinematics::Reason::kNone)
        reason = Walk(blend.stretch, true, at.position, way - blend.first, way + blend.second);
      part.samples = samples;
      if (!use(part) || reason != kinematics::Reason::kNone) return reason;
      next.from = blend.second;
    }
    const kinematics::Reason reason = Walk(next, false, ahead.end_joints, way, way + next.to);
    part.on_blend = false;
    part.samples = samples;
    if (!use(part) || reason != kinematics::Reason::kNone) return reason;
    way += next.to;
    GoTo(samples.back().joints);
    before = next;
  }
  return kinematics::Reason::kNone;
}

Survey::Survey(const Fixed& fixed) : inside_(std::make_unique<Inside>(fixed)) {}
Survey::~Survey() = default;

kinematics::Reason Survey::Run(const PathCheckRequest& question, const std::function<bool(const Part&)>& use) {
  return inside_->Run(question, use);
}

}  // namespace takt::group
