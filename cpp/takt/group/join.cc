#include "takt/group/join.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/group/boarding.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/make_stretch.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"
#include "takt/path/blend.h"

namespace takt::group {

namespace {

constexpr int kBlendPlaces = 6;
constexpr int kHalvings = 8;
// [mm/s]; slower joints without a blend are no better than a stop
constexpr double kLeastJointSpeed = 1;
constexpr double kRounding = 1e-9;
constexpr double kLeastSaved = 3;  // cycles that a blend must save compared with a stop
// Share of a stretch with a transition between carrier bindings, at most, for blends at each end.
constexpr double kBlendShare = 0.4;
// Largest ratio of both sides of a corner between chords of a curve: beyond it the blend would bend to the other side.
constexpr double kMostUneven = 2.5;

// Returns true if a blend is demanded at the start of this element; the first element of a path is joined as the move
// is.
bool Blends(const Request& move, std::uint32_t element) {
  return move.transition_mode != TransitionMode::kNone && (move.blends() || element > 0);
}

// Returns true if the path continues after this stretch without a stop, as far as is known.
bool GoesOn(const Context& c, const State& s) {
  const Request& move = MoveAt(s, s.planning.move);
  if (s.planning.element + 1 < ElementsOf(c, move)) return true;
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

// Returns the limits that a motion along both shares.
path::Ramp RampOf(const Context& c, const Stretch& before, const Stretch& after) {
  const LookAhead& ahead = c.ahead;
  if (!c.params.path.planned_ahead || IsCarried(ahead, before) || IsCarried(ahead, after)) return {};
  const trajectory::AlongPath l = trajectory::Least(before.limits, after.limits);
  const double a = std::min(l.acceleration, l.deceleration);
  if (!(a < kUnlimited && l.jerk < kUnlimited)) return {};
  return {l.velocity, a, l.jerk};
}

// Makes a blend that begins and ends at these distances from the corner.
bool MakeBlend(const Context& c, const Stretch& before, const Stretch& after, double first, double second,
               path::Segment& out) {
  return path::Blend(before.segment, before.to - first, after.segment, after.from + second, out,
                     RampOf(c, before, after)) == path::Problem::kNone;
}

// Returns the least squared velocity that the limits allow on a blend; negative if the axes cannot follow it.
double SquareOn(const Context& c, const State& s, const Stretch& blend) {
  double square = std::numeric_limits<double>::infinity();
  kinematics::Joints near = c.ahead.end_joints;
  for (int i = 0; i <= kBlendPlaces; ++i) {
    trajectory::PathPoint point;
    point.limits = blend.limits;
    kinematics::JointMotion motion;
    const double way = blend.segment.length * i / kBlendPlaces;
    if (SlopesOn(c, s, blend, way, near, point, motion) != kinematics::Reason::kNone) return -1;
    near = motion.position;
    square = std::min(square, trajectory::SquareAt(point, c.ahead.window.limits(), 1));
  }
  return square;
}

// [mm] from the corner; 0: no transition.
struct Distances {
  double first = 0;
  double second = 0;
  // Largest values of both, and of the distance from the lines to the blend.
  double reach = 0;
  double deviation = kNoEnd;
};

// Returns the distances from the corner at which the transition that a move demands begins and ends.
Distances DistancesOf(const Context& c, const State& s, const Request& move, const Stretch& before,
                      const Stretch& after, const path::Room& room, Stretch blend, int& work) {
  const double parameter = move.transition_parameter;
  const auto both = [&](double d) { return Distances{std::min(d, room.first), std::min(d, room.second), d}; };
  switch (move.transition_mode) {
    case TransitionMode::kCornerDistance:
      return both(parameter);
    case TransitionMode::kMaxCornerDeviation: {
      const double d = path::CornerDistance(before.segment, after.segment, parameter, room, RampOf(c, before, after));
      return {d, d, kNoEnd, parameter};
    }
    case TransitionMode::kStartVelocity:
      return both(trajectory::RampLength(parameter, 0, before.limits.deceleration, before.limits.jerk));
    case TransitionMode::kConstantVelocity: {
      // The shortest blend on which that speed can be kept.
      double short_of = 0;
      double enough = std::min(room.first, room.second);
      for (int i = 0; i < kHalvings; ++i) {
        const double d = 0.5 * (short_of + enough);
        work += kBlendPlaces + 1;
        const bool made = MakeBlend(c, before, after, d, d, blend.segment);
        (made && SquareOn(c, s, blend) >= parameter * parameter ? enough : short_of) = d;
      }
      return both(enough);
    }
    default:
      return {};
  }
}

// Returns true if the motion can still stop at `place`, at a node or between it and the next one.
bool CanStopAt(const trajectory::PathWindow& window, const trajectory::PathPace& pace, std::uint64_t node,
               double place) {
  if (pace.raw_stands) return pace.node < node;
  double square = 0;
  double later = place;
  for (std::uint64_t i = place > window[node].at.s ? node + 1 : node; i > pace.node + 1; --i) {
    const trajectory::PathNode& before = window[i - 1];
    const double length = later - before.at.s;
    square = length > 0 ? trajectory::SquareBefore(before.bounds, length, square, before.ceiling)
                        : std::min(square, before.ceiling);
    if (square >= before.ceiling) return true;
    later = before.at.s;
  }
  const double v = pace.raw.velocity;
  const double left = later - pace.raw.position;
  // It may follow the ceiling itself.
  return left > 0 && v * v + 2 * left * window[pace.node].bounds.Least(pace.entered) <= square * (1 + kRounding);
}

// Removes the nodes behind `place`, so that the path is sampled again from `stretch` on. Returns false if the motion
// can no longer stop before.
bool CutAt(const Context& c, const State& s, double place, std::uint64_t stretch) {
  LookAhead& ahead = c.ahead;
  if (!ahead[stretch].begun) return true;  // it has no nodes yet: it waited for this
  trajectory::PathWindow& window = ahead.window;
  std::uint64_t node = window.end() - 1;
  while (node > window.begin() && window[node].at.s > place) --node;
  if (window[node].stop || window[node].at.s > place) return false;
  trajectory::PathPoint end = window[node].at;
  kinematics::JointMotion motion;
  motion.position = ahead.last_joints;
  const bool shorter = node + 1 < window.end();
  if (shorter) {
    std::uint64_t on = std::min(ahead.sampling, stretch);
    while (on > ahead.first && ahead[on].begin > place) --on;
    trajectory::PathPoint there = end;
    there.has_middle = false;
    there.s = place;
    const double way = ahead[on].from + (place - ahead[on].begin);
    const kinematics::Reason reason = SlopesOn(c, s, ahead[on], way, ahead.last_joints, there, motion);
    if (reason != kinematics::Reason::kNone) return false;
    // Where nodes are far apart, the motion would have to stop far before the place: it gets a node of its own.
    if (place > end.s) end = there;
  }
  if (s.begun) {
    const bool stops =
        ahead.timing.active() ? ahead.timing.StopBefore(window, end.s, s.pace) : CanStopAt(window, s.pace, node, end.s);
    if (!stops) return false;
  }
  if (shorter) {
    window.CutBehind(node);
    if (Boarding* boarding = BoardingOn(ahead, ahead[stretch])) CutReserve(c, window[node], *boarding);
    if (end.s > window[node].at.s) {
      window.Append(end);
      window.Close();
      window.Sweep(kNodes);
    }
    ahead.rehearsal.Clear();
  }
  ahead.sampling = std::min(ahead.sampling, stretch);
  ahead.last = end;
  ahead.last_joints = motion.position;
  return true;
}

void Append(LookAhead& ahead, Stretch stretch) {
  stretch.begin = ahead.count > 0 ? ahead[ahead.end() - 1].end() : 0;
  stretch.begun = stretch.stops = false;
  ++ahead.count;
  ahead[ahead.end() - 1] = stretch;
}

// Updates the arc lengths of the transition to the carrier binding of the last stretch.
void SettleRide(LookAhead& ahead, bool first, double left) {
  const Stretch& last = ahead[ahead.end() - 1];
  if (last.from_ride == last.to_ride) return;
  CarrierBinding& ride = ahead.rides[last.to_ride % kRides];
  if (first) ride.begin = last.begin;
  ride.end = last.end() + left;
}

// Returns true if a corner can be passed without a blend and without a stop.
bool Passes(const Context& c, const State& s, const Stretch& before, const Stretch& after) {
  trajectory::PathPoint ends, begins;
  kinematics::JointMotion motion;
  if (before.joints != after.joints) return false;
  if (SlopesOn(c, s, before, before.to, c.ahead.end_joints, ends, motion) != kinematics::Reason::kNone) return false;
  if (SlopesOn(c, s, after, 0, c.ahead.end_joints, begins, motion) != kinematics::Reason::kNone) return false;
  const double square = trajectory::JointSquare(ends.slopes, begins.slopes, c.ahead.window.limits(), c.cycle.period_s);
  return square > kLeastJointSpeed * kLeastJointSpeed;
}

// Makes a blend between two lines as chords of a curve.
bool MakeRound(const OpenCorner& corner, const path::Segment& second, double to, const path::Bends& bends,
               path::Segment& out) {
  const double before = corner.first.length - corner.from;
  if (std::max(before, to) > std::min(corner.reach * (1 + kRounding), kMostUneven * std::min(before, to))) return false;
  if (path::Blend(corner.first, corner.from, second, to, bends, out) != path::Problem::kNone) return false;
  return corner.deviation >= kNoEnd || path::Deviation(corner.first, second, out) <= corner.deviation;
}

// In place of a separate blend, makes one that continues that of the last corner from the middle of the stretch between
// them, with the same curvature. `blend` lacks its segment.
bool GoOnFromLastCorner(const Context& c, const State& s, const CornerBlend& d, int& work) {
  LookAhead& ahead = c.ahead;
  if (!ahead.corner.open || ahead.count < 2) return false;
  if (ahead.next.from_ride != ahead.next.to_ride || ahead[ahead.end() - 1].from_ride != ahead.end_ride) return false;
  const std::uint64_t last_one = ahead.end() - 2;
  const path::Segment line = ahead[last_one + 1].segment;
  if (c.params.workspace && line.length > c.params.workspace->margin) return false;
  Stretch blend = d.stretch;
  const double middle = line.length / 2;
  if (d.first < middle && d.second < ahead.next.segment.length / 2) return false;  // the deviation limits it
  // Both corners are passed sooner by two overlapping ramps each than at one speed: there is no curvature to keep up.
  const auto is_sharp = [&](const path::Segment& first, const path::Segment& second, double distance) {
    return std::isfinite(path::Overlap(first, second, distance, RampOf(c, ahead[last_one], ahead.next)));
  };
  if (is_sharp(ahead.corner.first, line, middle) && is_sharp(line, ahead.next.segment, std::min(middle, d.second))) {
    return false;
  }
  const auto bend = path::ChordCurvature(ahead.corner.first, line, ahead.next.segment);
  if (!bend) return false;
  Stretch last = ahead[last_one];
  OpenCorner corner{true, line, middle, {}, d.reach, d.deviation};
  bool made = false;
  for (const double share : {1.0, 0.5, 0.0}) {  // less curvature comes closer to the corners
    for (std::size_t i = 0; i < bend->size(); ++i) corner.bend[i] = share * (*bend)[i];
    made = MakeRound(ahead.corner, line, middle, {ahead.corner.bend, corner.bend}, last.segment) &&
           MakeRound(corner, ahead.next.segment, d.second, {corner.bend, {}}, blend.segment);
    if (made || *bend == path::Triple{}) break;
  }
  work += 2 * (kBlendPlaces + 1);
  if (!made || !(SquareOn(c, s, last) > 0) || !(SquareOn(c, s, blend) > 0)) return false;
  if (!CutAt(c, s, last.begin, last_one)) return false;
  last.to = last.segment.length;
  ahead[last_one] = last;
  --ahead.count;  // nothing is left of the line
  blend.to = blend.segment.length;
  ahead.next.from = d.second;
  Append(ahead, blend);
  ahead.corner = corner;
  return true;
}

bool GoesOver(const Stretch& stretch) {
  return stretch.from_ride != stretch.to_ride;
}

// Computes all of a blend but its segment. Returns false if there is none.
bool FindDistances(const Context& c, const State& s, const Request& move, std::uint32_t element, const Stretch& before,
                   const Stretch& after, int& work, CornerBlend& out) {
  if (!Blends(move, element)) return false;
  if (before.joints != after.joints || before.segment.measure != after.segment.measure) return false;
  if (before.begun && GoesOver(before)) return false;  // its end is fixed
  path::Room room = path::HalfOf(before.segment, after.segment);
  room.first = std::min(room.first, before.to - before.from);
  // Some length is left for the transition between carrier bindings.
  if (GoesOver(before)) room.first = std::min(room.first, kBlendShare * before.segment.length);
  if (GoesOver(after)) room.second = std::min(room.second, kBlendShare * after.segment.length);
  Stretch& blend = out.stretch;
  blend.move = after.move;
  blend.goes_on = true;
  blend.joints = after.joints;
  blend.limits = trajectory::Least(before.limits, after.limits);
  blend.build_up_s = before.build_up_s;
  blend.from_ride = blend.to_ride = before.to_ride;
  if (after.to_ride == before.to_ride) blend.from_ride = after.from_ride;  // within one transition
  blend.eta_begin = blend.eta_end = before.eta_end;
  // No element of a path is passed faster than it allows, nor are its blends.
  const double slower = std::min(before.limits.velocity, after.limits.velocity);
  blend.limits.velocity = element > 0 ? slower : BlendVelocity(move, before.limits.velocity, after.limits.velocity);
  const Distances d = DistancesOf(c, s, move, before, after, room, blend, work);
  out.first = d.first;
  out.second = d.second;
  out.reach = d.reach;
  out.deviation = d.deviation;
  // A blend that the deviation keeps short of the middle of both lines is never made again: nothing has to wait for it.
  out.to_middle = d.first >= room.first || d.second >= room.second;
  if (!(d.first > 0 && d.second > 0)) return false;
  // A stop takes hardly longer, and needs no plan through a bend of a micrometre.
  const double saved_s =
      path::Overlap(before.segment, after.segment, std::min(d.first, d.second), RampOf(c, before, after));
  return saved_s >= kLeastSaved * c.cycle.period_s;
}

bool MakeSegment(const Context& c, const State& s, const Stretch& before, const Stretch& after, int& work,
                 CornerBlend& out) {
  work += kBlendPlaces + 1;
  if (!MakeBlend(c, before, after, out.first, out.second, out.stretch.segment)) return false;
  out.stretch.to = out.stretch.segment.length;
  return SquareOn(c, s, out.stretch) > 0;
}

bool TryBlend(const Context& c, State& s, const Request& move, Stretch& before, int& work) {
  LookAhead& ahead = c.ahead;
  CornerBlend blend;
  if (!FindDistances(c, s, move, s.planning.element, before, ahead.next, work, blend)) return false;
  if (GoOnFromLastCorner(c, s, blend, work)) return true;
  ahead.corner.open = false;
  if (!MakeSegment(c, s, before, ahead.next, work, blend)) return false;
  const double cut = before.to - blend.first;
  if (!CutAt(c, s, before.begin + (cut - before.from), ahead.end() - 1)) return false;
  before.to = cut;
  SettleRide(ahead, false, 0);
  ahead.next.from = blend.second;
  ahead.corner = {blend.to_middle, before.segment, cut, {}, blend.reach, blend.deviation};
  Append(ahead, blend.stretch);
  return true;
}

}  // namespace

bool FindBlend(const Context& c, const State& s, const Request& move, std::uint32_t element, const Stretch& before,
               const Stretch& after, int& work, CornerBlend& out) noexcept {
  return FindDistances(c, s, move, element, before, after, work, out) && MakeSegment(c, s, before, after, work, out);
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
    const bool other = ahead.timing.active() && !IsTimed(c, move, ahead.next);
    const bool wanted = (move.blends() || s.planning.element > 0) && !other;
    goes_on = wanted && Passes(c, s, before, ahead.next);
    const bool bends = s.planning.element == 0 && (before.bends_at_ends || ahead.next.bends_at_ends);
    const bool smooth = goes_on && !bends && path::Smooth(before.segment, ahead.next.segment);
    const bool blended = wanted && !smooth && TryBlend(c, s, move, before, work);
    if (!blended) ahead.corner.open = false;
    goes_on = goes_on || blended;
    if (!goes_on) {
      before.stops = true;
      if (ahead.last.s >= before.end()) ahead.window.Stay();
    }
  }
  if (!goes_on) {
    const double length = GoesOn(c, s) ? std::numeric_limits<double>::infinity() : ahead.next.segment.length;
    ahead.next.build_up_s = ahead.build_up.For(length, c.cycle.period_s, trajectory::kMostBuildUpCycles);
  } else {
    ahead.next.build_up_s = ahead[ahead.end() - 1].build_up_s;
  }
  ahead.next.goes_on = goes_on;
  if (!follows) {
    ahead.last_joints = ahead.end_joints;
    ahead.sampling = ahead.end();
  }
  Append(ahead, ahead.next);
  SettleRide(ahead, s.planning.element == 0, move.kind == MoveKind::kArch ? ahead.arch_left : 0);
  ahead.end_ride = ahead.next.to_ride;
  ahead.rides_end = std::max(ahead.rides_end, ahead.end_ride + 1);
  ahead.end_eta = ahead.next.eta_end;
  ahead.known = true;
  ahead.end_joints = ahead.next_joints;
  ahead.end_tool = ahead.next_tool;
  return work;
}

}  // namespace takt::group
