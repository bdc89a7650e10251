#include "takt/conveyor/pose.h"

#include <algorithm>
#include <limits>

#include "takt/conveyor/texts.h"
#include "takt/core/angle.h"
#include "takt/core/in_range.h"

namespace takt::conveyor {

namespace {

constexpr Range kSpeeds = between(-1e9, 1e9);

// Returns the age [s] at the end of this cycle.
double AgeOf(const Cycle& cycle, const PoseState& s) {
  return s.last.age_s + static_cast<double>(cycle.count + 1 - s.cycle) * cycle.period_s;
}

}  // namespace

void Apply(const Cycle& cycle, FeedbackSink& feedback, Ticket ticket, const PoseCommand& command,
           PoseState& s) noexcept {
  const SetPose& set = std::get<SetPose>(command);
  const auto report = [&](FeedbackState state, ErrorId error) {
    feedback.Report({ticket, cycle.count, state, false, error, 0});
  };
  if (!takt::InRange(set)) return report(FeedbackState::kError, ErrorId::kParameter);
  s = {set, cycle.count, true};
  report(FeedbackState::kActive, ErrorId::kNone);
  report(FeedbackState::kDone, ErrorId::kNone);
}

kinematics::Carrier CarrierOf(const PoseParams& p, const Cycle& cycle, const PoseState& s) noexcept {
  kinematics::Carrier carrier;
  if (!s.known) return carrier;
  const SetPose& last = s.last;
  carrier.kind = kinematics::CarrierKind::kFree;
  const kinematics::Frame frame = kinematics::ToFrame({last.x, last.y, last.z, last.a, last.b, last.c});
  carrier.pose.p = KDL::VectorAcc(frame.p, KDL::Vector(last.vx, last.vy, last.vz), KDL::Vector::Zero());
  carrier.pose.M = KDL::RotationAcc(frame.M, kDegree * KDL::Vector(last.wx, last.wy, last.wz), KDL::Vector::Zero());
  const double age = AgeOf(cycle, s);
  carrier = kinematics::Ahead(carrier, std::min(age, p.goes_on_s));
  if (age > p.goes_on_s) carrier.pose = kinematics::MovingFrame(carrier.pose.GetFrame());
  return carrier;
}

void Publish(const PoseParams& p, const Cycle& cycle, const PoseState& s, PoseOutputs& out) noexcept {
  out = {};
  if (s.known) {
    const kinematics::MovingFrame pose = CarrierOf(p, cycle, s).pose;
    out.pose = kinematics::ToPose(pose.GetFrame());
    out.velocity = pose.p.v.Norm();
    out.turning = pose.M.w.Norm() / kDegree;
    out.age_s = AgeOf(cycle, s);
    out.fresh = out.age_s <= p.goes_on_s;
  } else {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    out.pose = {kNone, kNone, kNone, kNone, kNone, kNone};
    out.age_s = std::numeric_limits<double>::infinity();
  }
}

void describe(Description<PoseParams>& d) {
  using P = PoseParams;
  d.about("A pose given by programs or other processes, which groups can follow: that of a mover or of another robot.");
  d.required<&P::name>("Name of the pose, to which commands are addressed.");
  d.defaulted<&P::goes_on_s>(
      unit::s, between(0, 3600),
      "Time after the last given pose for which the motion is extrapolated; then the pose is at rest.");
}

void describe(Description<SetPose>& d) {
  using S = SetPose;
  d.about(
      "Gives a pose in the world and its velocity. The motion is extrapolated until a new pose is given, or this one "
      "is too old.");
  d.defaulted<&S::x>(unit::mm, kPlaces, "Along X.");
  d.defaulted<&S::y>(unit::mm, kPlaces, "Along Y.");
  d.defaulted<&S::z>(unit::mm, kPlaces, "Along Z.");
  d.defaulted<&S::a>(unit::deg, kAngles, "Rotation about X.");
  d.defaulted<&S::b>(unit::deg, kAngles, "Rotation about Y.");
  d.defaulted<&S::c>(unit::deg, kAngles, "Rotation about Z.");
  d.defaulted<&S::vx>(unit::mm_s, kSpeeds, "Velocity along X.");
  d.defaulted<&S::vy>(unit::mm_s, kSpeeds, "Velocity along Y.");
  d.defaulted<&S::vz>(unit::mm_s, kSpeeds, "Velocity along Z.");
  d.defaulted<&S::wx>(unit::deg_s, kAngles, "Angular velocity about X of the world.");
  d.defaulted<&S::wy>(unit::deg_s, kAngles, "Angular velocity about Y of the world.");
  d.defaulted<&S::wz>(unit::deg_s, kAngles, "Angular velocity about Z of the world.");
  d.defaulted<&S::age_s>(unit::s, between(0, 3600), "Age of the pose on arrival.");
}

void describe(Description<PoseState>& d) {
  d.about("State of an external pose.");
  d.internal<&PoseState::last>("The last given pose.");
  d.internal<&PoseState::cycle>("Cycle in which it was given.");
  d.internal<&PoseState::known>("A pose has been given.");
}

void describe(Description<PoseOutputs>& d) {
  using O = PoseOutputs;
  d.about("State of an external pose after a cycle, at the instant for which the axes have their set points.");
  d.internal<&O::pose>("Pose in the world; nan before one was given.");
  d.internal<&O::velocity>(unit::mm_s, "Magnitude of the velocity.");
  d.internal<&O::turning>(unit::deg_s, "Magnitude of the angular velocity.");
  d.internal<&O::age_s>(unit::s, "Age of the last given pose; inf before.");
  d.internal<&O::fresh>("The motion is extrapolated; false: the pose is at rest, or none was given.");
}

}  // namespace takt::conveyor
