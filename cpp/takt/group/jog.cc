#include "takt/group/jog.h"

#include <algorithm>
#include <cmath>

#include "takt/core/angle.h"
#include "takt/group/members.h"
#include "takt/group/plan.h"
#include "takt/group/run.h"
#include "takt/group/systems.h"
#include "takt/kinematics/rotations.h"
#include "takt/path/make.h"

namespace takt::group {

namespace {

constexpr double kFarthest = 16'384;  // [mm or u] longest path; a jog continues from its end
constexpr double kMostTurn = 3'600;   // [deg] likewise
constexpr double kShort = 1e-3;       // [mm, deg or u] distance kept from the border
constexpr double kLeastWay = 1e-2;    // likewise, shortest path
constexpr double kOfTurn = 0.1;       // tolerance of the orientation, as a share of the demanded turn
constexpr double kLeastTurn = 1e-6;   // [rad]
constexpr double kSameDirection = 1e-9;
constexpr int kSpeedPlaces = 32;  // points of a path at which the speed of the tool is computed

using kinematics::Joints;
using kinematics::Reason;

double OrZero(double speed) {
  return std::isnan(speed) ? 0 : speed;
}

// The velocities of a jog, in the MCS.
struct Speeds {
  KDL::Vector along;  // [mm/s]
  KDL::Vector about;  // [rad/s]
  Joints axes{};      // [u/s]
  double most = 0;    // largest of them, mm/s, deg/s or u/s

  Frame ToolAfter(const Frame& from, double time_s) const {
    const double rate = about.Norm();
    const KDL::Rotation turned = rate > 0 ? kinematics::About(about / rate, rate * time_s) * from.M : from.M;
    return {turned, from.p + along * time_s};
  }
  Joints AxesAfter(const Joints& from, double time_s) const {
    Joints joints = from;
    for (std::size_t k = 0; k < kMaxAxes; ++k) joints[k] += axes[k] * time_s;
    return joints;
  }
};

Speeds SpeedsOf(const Request& jog, const Frame& tool) {
  const KDL::Rotation system = jog.jog_system == JogSystem::kTool ? tool.M : kinematics::ToFrame(jog.frame).M;
  const auto three = [&](std::size_t i) {
    return KDL::Vector(OrZero(jog.to[i]), OrZero(jog.to[i + 1]), OrZero(jog.to[i + 2]));
  };
  Speeds speeds{system * three(0), system * three(3) * kDegree};
  speeds.most = std::max(three(0).Norm(), three(3).Norm());
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    speeds.axes[k] = OrZero(jog.to[kToolNumbers + k]);
    speeds.most = std::max(speeds.most, std::abs(speeds.axes[k]));
  }
  return speeds;
}

// Returns the longest duration of one path of a jog [s].
double LongestTime(const Speeds& speeds) {
  double time = kNoLimit;
  const auto take = [&](double most, double speed) {
    if (speed > 0) time = std::min(time, most / speed);
  };
  take(kFarthest, speeds.along.Norm());
  take(kMostTurn * kDegree, speeds.about.Norm());
  for (const double speed : speeds.axes) take(kFarthest, std::abs(speed));
  return time;
}

path::Triple TripleOf(const KDL::Vector& v) {
  return {v.x(), v.y(), v.z()};
}

// Limits the path speed to the jog limits of the group. `time_s`: duration of the path at the velocities given.
void HoldSpeed(const Context& c, const State& s, const Speeds& speeds, double time_s, Stretch& stretch) {
  const JogLimits& most = c.params.jog;
  const double speed = stretch.segment.length / time_s;
  double& velocity = stretch.limits.velocity;
  const auto hold = [&](double limit, double given) {
    if (given > 0) velocity = std::min(velocity, limit * speed / given);
  };
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    hold(most.axis_factor * c.ahead.window.limits().of[k].velocity, std::abs(speeds.axes[k]));
  }
  if (!HasTool(c, s)) return;
  const double along = most.velocity.value_or(kNoLimit), about = most.angular_velocity.value_or(kNoLimit) * kDegree;
  if (!stretch.joints) {
    hold(along, speeds.along.Norm());
    hold(about, speeds.about.Norm());
    return;
  }
  if (!most.velocity && !most.angular_velocity) return;
  for (int i = 0; i <= kSpeedPlaces; ++i) {
    const kinematics::JointMotion motion =
        path::AuxiliariesAt(stretch.segment, stretch.segment.length * i / kSpeedPlaces);
    kinematics::MovingFrame flange;
    if (kinematics::Forward(*c.kinematics, motion, flange) != Reason::kNone) continue;
    const kinematics::MovingFrame tool = flange * c.mounting.tool;
    hold(along, tool.p.v.Norm() * speed);
    hold(about, tool.M.w.Norm() * speed);
  }
}

}  // namespace

bool IsReleased(const Request& jog) noexcept {
  return std::ranges::all_of(jog.to, [](double speed) { return std::isnan(speed); });
}

void BeginJog(const Context& c, Ticket ticket, const Request& jog, State& s) noexcept {
  Request move = jog;
  move.ticket = ticket;
  const auto system = move.jog_system == JogSystem::kWcs   ? CoordinateSystem::kWcs
                      : move.jog_system == JogSystem::kPcs ? CoordinateSystem::kPcs
                                                           : CoordinateSystem::kMcs;
  move.frame = kinematics::ToPose(SystemFrame(c, s, system, move.pcs));
  Push(move, s);
  Report(c, ticket, FeedbackState::kBusy);
}

bool ChangeJog(const Context& c, Ticket ticket, const Request& jog, State& s) noexcept {
  if (!Jogs(s) || s.interrupted) return false;
  Request& move = MoveAt(s, s.done);
  if (jog.jog_system != move.jog_system || (jog.jog_system == JogSystem::kPcs && jog.pcs != move.pcs)) return false;
  const trajectory::AlongPath &now = jog.limits, &before = move.limits;
  if (!(now == before)) return false;
  double product = 0, square = 0, largest = 0;
  for (std::size_t i = 0; i < jog.to.size(); ++i) {
    product += OrZero(jog.to[i]) * OrZero(move.to[i]);
    square += OrZero(move.to[i]) * OrZero(move.to[i]);
    largest = std::max(largest, std::abs(OrZero(jog.to[i])));
  }
  const double factor = product / square;
  if (!(factor > 0) || !std::isfinite(factor)) return false;
  for (std::size_t i = 0; i < jog.to.size(); ++i) {
    if (std::abs(OrZero(jog.to[i]) - factor * OrZero(move.to[i])) > kSameDirection * largest) return false;
  }
  Report(c, move.ticket, FeedbackState::kAborted);
  move.ticket = ticket;
  move.velocity_factor = factor;
  Report(c, ticket, FeedbackState::kBusy);
  return true;
}

void EndJog(const Context& c, Ticket ticket, State& s) noexcept {
  EndTask(c, FeedbackState::kAborted, ErrorId::kNone, s);
  const trajectory::AlongPath limits = MoveAt(s, s.done).limits;
  MoveAt(s, s.done).ticket = 0;
  AbortMoves(c, ErrorId::kNone, s);
  GiveUpPath(c, {limits.deceleration, limits.jerk}, true, s);
  s.ends = true;
  s.task = Task::kHalt;
  s.ticket = ticket;
  if (s.active != ticket) Report(c, ticket, FeedbackState::kActive);
}

ErrorId MakeJog(const Context& c, const Request& jog, LookAhead& ahead, State& s) noexcept {
  Stretch& stretch = ahead.next;
  stretch.limits = jog.limits;
  const Speeds speeds = SpeedsOf(jog, ahead.end_tool);
  const bool axes = jog.system == CoordinateSystem::kAcs;
  Joints good = ahead.end_joints;
  Reason reason = Reason::kNone;  // of the last failure
  const auto may = [&](double time_s) {
    Joints joints = speeds.AxesAfter(axes ? ahead.end_joints : good, axes ? time_s : 0);
    if (!axes) {
      for (std::size_t k = c.kinematics->count; k < kMaxAxes; ++k) {
        joints[k] = ahead.end_joints[k] + speeds.axes[k] * time_s;
      }
      const Frame tool = speeds.ToolAfter(ahead.end_tool, time_s);
      if (const Reason found = JointsAt(c, tool, joints, joints); found != Reason::kNone) {
        reason = found;
        return false;
      }
      // Mechanisms without a wrist ignore the demanded orientation.
      Frame reached;
      const double turn = speeds.about.Norm() * time_s;
      if (turn > 0 && (ToolAt(c, joints, reached) != Reason::kNone ||
                       !KDL::Equal(reached.M, tool.M, std::max(kLeastTurn, kOfTurn * std::min(turn, 1.0))))) {
        reason = Reason::kOrientation;
        return false;
      }
    }
    if (!WithinRanges(c, s, joints)) {
      reason = Reason::kAxisLimit;
      return false;
    }
    good = joints;
    return true;
  };
  const double longest = LongestTime(speeds);
  double time = Furthest(longest, 1 / speeds.most, kShort / speeds.most, may);
  s.jog.border = time < longest ? ErrorId::kUnreachable : ErrorId::kNone;
  s.jog.reason = time < longest ? reason : Reason::kNone;
  if (jog.most_s < time) {
    time = jog.most_s;
    s.jog.border = jog.border;
    s.jog.reason = Reason::kNone;
  }
  if (!(time * speeds.most >= kLeastWay)) {
    s.reason = s.jog.reason;
    return s.jog.border;
  }
  stretch.joints = axes;
  const path::Auxiliaries before = ahead.end_joints, after = speeds.AxesAfter(ahead.end_joints, time);
  if (axes) {
    s.problem = path::MakeLine({Frame::Identity(), before}, {Frame::Identity(), after}, stretch.segment);
  } else {
    path::Point from{ahead.end_tool};
    path::Auxiliaries to{};
    const auto count = static_cast<std::ptrdiff_t>(c.kinematics->count);
    std::copy(before.begin() + count, before.end(), from.auxiliaries.begin());
    std::copy(after.begin() + count, after.end(), to.begin());
    s.problem =
        path::MakeTwist(from, TripleOf(speeds.along * time), TripleOf(speeds.about * time), to, stretch.segment);
  }
  if (s.problem != path::Problem::kNone) {
    s.problem = path::Problem::kNone;
    return ErrorId::kUnreachable;
  }
  s.jog.speed = stretch.segment.length / time;
  HoldSpeed(c, s, speeds, time, stretch);
  return ErrorId::kNone;
}

bool ShortenJog(double most, ErrorId border, State& s) noexcept {
  Request& move = MoveAt(s, s.planning.move);
  if (!IsJog(move) || !(most >= kLeastWay)) return false;
  move.most_s = most / s.jog.speed;
  move.border = border;
  return true;
}

double JogSpeed(const State& s) noexcept {
  return s.jog.speed * MoveAt(s, s.done).velocity_factor;
}

bool AtBorder(const Context& c, State& s) noexcept {
  if (s.jog.border == ErrorId::kNone) {  // the largest length of one path
    s.begun = false;
    s.way_before += s.pace.now.position;
    s.pace = {};
    ForgetPlan(c, s);
    return false;
  }
  s.reason = s.jog.reason;
  s.blocked_at = s.pace.now.position;
  if (s.jog.border == ErrorId::kCollision) s.answer = s.jog.met;
  Pop(c, FeedbackState::kError, s.jog.border, s);
  return true;
}

}  // namespace takt::group
