#include "takt/group/join.h"

#include <algorithm>
#include <cmath>

#include "takt/group/make_stretch.h"
#include "takt/group/queue.h"
#include "takt/path/blend.h"

namespace takt::group {

namespace {

constexpr int kBlendPlaces = 6;
constexpr int kHalvings = 8;
// Slower than this a joint without a blend is no better than a stop, mm/s.
constexpr double kLeastJointSpeed = 1;
constexpr double kRounding = 1e-9;
constexpr double kNoEnd = 1e12;  // mm

// How a path goes on at this element: that of the move, but for the first element of a path, which is joined as the
// move.
bool Blends(const Request& move, std::uint32_t element) {
  return move.transition_mode != TransitionMode::kNone && (move.blends() || element > 0);
}

// Whether the path goes on behind this stretch without a stop, as far as is known.
bool GoesOn(const Context& c, const State& s) {
  const Request& move = MoveAt(s, s.planning.move);
  if (move.kind == MoveKind::kPath && s.planning.element + 1 < c.paths[move.path].pieces.size()) return true;
  return s.planning.move + 1 < s.done + s.queue.count && MoveAt(s, s.planning.move + 1).blends();
}

double BlendVelocity(const Request& move, double before, double after) {
  switch (move.buffer_mode) {
    case BufferMode::kBlendingLow:
      return std::min(before, after);
    case BufferMode::kBlendingPrevious:
      return before;
    case BufferMode::kBlendingHigh:
      return std::max(before, after);
    default:
      return after;
  }
}

// The distance in which a speed is braked to standstill.
double BrakingWay(double v, const trajectory::AlongPath& limits) {
  const double build_up = limits.deceleration / limits.jerk;
  return v * build_up >= v * v / limits.deceleration ? v * std::sqrt(v / limits.jerk)
                                                     : 0.5 * v * (v / limits.deceleration + build_up);
}

// A blend that begins and ends so far from the corner.
bool MakeBlend(const Stretch& before, const Stretch& after, double first, double second, path::Segment& out) {
  return path::Blend(before.segment, before.to - first, after.segment, after.from + second, out) ==
         path::Problem::kNone;
}

// The slowest speed, squared, that the limits ask for on a blend; negative where it cannot be gone.
double SquareOn(const Context& c, const State& s, const Stretch& blend) {
  double square = std::numeric_limits<double>::infinity();
  kinematics::Joints near = c.ahead.end_joints;
  for (int i = 0; i <= kBlendPlaces; ++i) {
    trajectory::PathPoint point;
    point.limits = blend.limits;
    kinematics::JointMotion motion;
    const double way = blend.segment.length * i / kBlendPlaces;
    if (SlopesOn(c, s, blend, way, near, point.slopes, motion) != kinematics::Reason::kNone) return -1;
    near = motion.position;
    square = std::min(square, trajectory::SquareAt(point, c.ahead.window.limits(), 1));
  }
  return square;
}

struct Distances {
  double first = 0;
  double second = 0;
};

// How far from the corner the transition that a move asks for begins and ends. 0: none.
Distances DistancesOf(const Context& c, const State& s, const Request& move, const Stretch& before,
                      const Stretch& after, const path::Room& room, Stretch blend, int& work) {
  const double parameter = move.transition_parameter;
  const auto both = [&](double d) { return Distances{std::min(d, room.first), std::min(d, room.second)}; };
  switch (move.transition_mode) {
    case TransitionMode::kCornerDistance:
      return both(parameter);
    case TransitionMode::kMaxCornerDeviation:
      return both(path::CornerDistance(before.segment, after.segment, parameter, room));
    case TransitionMode::kStartVelocity:
      return both(BrakingWay(parameter, before.limits));
    case TransitionMode::kConstantVelocity: {
      // The shortest one on which that speed can be kept.
      double short_of = 0;
      double enough = std::min(room.first, room.second);
      for (int i = 0; i < kHalvings; ++i) {
        const double d = 0.5 * (short_of + enough);
        work += kBlendPlaces + 1;
        const bool made = MakeBlend(before, after, d, d, blend.segment);
        (made && SquareOn(c, s, blend) >= parameter * parameter ? enough : short_of) = d;
      }
      return both(enough);
    }
    default:
      return {};
  }
}

// Takes back what is planned of the last stretch behind a place, if the motion can still stop before that.
bool CutAt(const Context& c, State& s, double place) {
  trajectory::PathWindow& window = c.ahead.window;
  std::uint64_t node = window.end() - 1;
  while (node > window.begin() && window[node].at.s > place) --node;
  if (window[node].stop || window[node].at.s > place) return false;
  if (s.begun && s.pace.node >= node) return false;
  const bool moves = s.begun && !s.pace.raw_stands;
  c.ahead.window.CutBehind(node);
  c.ahead.rehearsal.Clear();
  c.ahead.last = window[node].at;
  if (!moves) return true;
  const trajectory::PathNode& next = window[s.pace.node + 1];
  const double v = s.pace.raw.velocity;
  const double left = next.at.s - s.pace.raw.position;
  // It may go by the ceiling itself.
  const double least = v * v + 2 * left * window[s.pace.node].bounds.Least(s.pace.entered);
  return least <= next.ceiling * (1 + kRounding);
}

void Append(LookAhead& ahead, Stretch stretch) {
  stretch.begin = ahead.count > 0 ? ahead[ahead.end() - 1].end() : 0;
  stretch.begun = stretch.stops = false;
  ++ahead.count;
  ahead[ahead.end() - 1] = stretch;
}

// What a corner without a blend allows.
bool Passes(const Context& c, const State& s, const Stretch& before, const Stretch& after) {
  trajectory::PathSlopes ends, begins;
  kinematics::JointMotion motion;
  if (before.joints != after.joints) return false;
  if (SlopesOn(c, s, before, before.to, c.ahead.end_joints, ends, motion) != kinematics::Reason::kNone) return false;
  if (SlopesOn(c, s, after, 0, c.ahead.end_joints, begins, motion) != kinematics::Reason::kNone) return false;
  const double square = trajectory::JointSquare(ends, begins, c.ahead.window.limits(), c.cycle.period_s);
  return square > kLeastJointSpeed * kLeastJointSpeed;
}

bool TryBlend(const Context& c, State& s, const Request& move, Stretch& before, int& work) {
  LookAhead& ahead = c.ahead;
  CornerBlend blend;
  if (!FindBlend(c, s, move, s.planning.element, before, ahead.next, work, blend)) return false;
  const double cut = before.to - blend.first;
  const bool good = CutAt(c, s, before.begin + cut - before.from);
  ahead.sampling = ahead.end() - 1;
  if (!good) return false;
  before.to = cut;
  ahead.next.from = blend.second;
  Append(ahead, blend.stretch);
  return true;
}

}  // namespace

bool FindBlend(const Context& c, const State& s, const Request& move, std::uint32_t element, const Stretch& before,
               const Stretch& after, int& work, CornerBlend& out) noexcept {
  if (!Blends(move, element)) return false;
  if (before.joints != after.joints || before.segment.measure != after.segment.measure) return false;
  path::Room room = path::HalfOf(before.segment, after.segment);
  room.first = std::min(room.first, before.to - before.from);
  Stretch& blend = out.stretch;
  blend.move = after.move;
  blend.joints = after.joints;
  blend.limits = trajectory::Least(before.limits, after.limits);
  blend.build_up_s = before.build_up_s;
  blend.limits.velocity = BlendVelocity(move, before.limits.velocity, after.limits.velocity);
  const Distances d = DistancesOf(c, s, move, before, after, room, blend, work);
  if (!(d.first > 0 && d.second > 0)) return false;
  work += kBlendPlaces + 1;
  if (!MakeBlend(before, after, d.first, d.second, blend.segment) || !(SquareOn(c, s, blend) > 0)) return false;
  blend.to = blend.segment.length;
  out.first = d.first;
  out.second = d.second;
  return true;
}

int Join(const Context& c, State& s) noexcept {
  LookAhead& ahead = c.ahead;
  const Request& move = MoveAt(s, s.planning.move);
  ahead.next.to = ahead.next.segment.length;
  ahead.next.from = 0;
  int work = 4;
  bool goes_on = false;
  const bool follows = ahead.known && ahead.count > 0;
  if (follows) {
    Stretch& before = ahead[ahead.end() - 1];
    ahead.near = ahead.end_joints;
    const bool wanted = move.blends() || s.planning.element > 0;
    goes_on = wanted && Passes(c, s, before, ahead.next);
    const bool smooth = goes_on && path::Smooth(before.segment, ahead.next.segment);
    if (!smooth) goes_on = TryBlend(c, s, move, before, work) || goes_on;
    if (!goes_on) {
      before.stops = true;
      if (ahead.last.s >= before.end()) ahead.window.Stay();
    }
  }
  if (!goes_on) {
    const double length = GoesOn(c, s) ? kNoEnd : ahead.next.segment.length;
    ahead.next.build_up_s = ahead.build_up.For(length, c.cycle.period_s, trajectory::kMostBuildUpCycles);
  } else {
    ahead.next.build_up_s = ahead[ahead.end() - 1].build_up_s;
  }
  if (!follows) {
    ahead.near = ahead.end_joints;
    ahead.sampling = ahead.end();
  }
  Append(ahead, ahead.next);
  ahead.known = true;
  ahead.end_joints = ahead.next_joints;
  ahead.end_tool = ahead.next_tool;
  return work;
}

}  // namespace takt::group
