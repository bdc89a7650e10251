#include "takt/group/boarding_plan.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/group/ask.h"
#include "takt/group/boarding.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/clutch.h"
#include "takt/group/make_stretch.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

// Candidates: the share of each coordinate's limits that the clutch may use, and its lead as a multiple of the distance
// on which it accelerates.
constexpr std::array kShares = {0.15, 0.3, 0.5, 0.7, 0.9};
constexpr std::array kLeads = {0.0, 0.5, 1.0, 1.5, 2.5};
constexpr double kVelocityShare = 0.9;      // of each coordinate's velocity limit, for the clutch
constexpr double kBendsShare = 0.4;         // of acceleration and jerk limits, for the curvature along the travel
constexpr double kLeastOverspeed = 1.3;     // of the carrier's velocity: curvature leaves the clutch this in any case
constexpr int kTries = 3;                   // candidates that are measured
constexpr double kShareMargin = 1.1;        // on the share computed from a failed measurement
constexpr double kMostSampled = 0.96;       // of a limit, as sampled
constexpr double kSampleMargin = 1.05;      // between samples
constexpr int kSamplesPerPiece = 4;         // of the profile, both ends among them
constexpr int kSamplesPerPieceOfChain = 2;  // with inverse kinematics of a serial chain
constexpr int kSpeedRounds = 4;             // fixed-point iterations of the path speed at the end of boarding
constexpr double kDifference = 1e-3;        // [s] of the carrier's travel, for difference quotients
// Time of the transition between carrier bindings relative to a path at rest, per path length that the carrier travels
// meanwhile: up to one length, and from there to kTransitionLengths. Margin on the estimated time with boarding. Fitted
// to 213 moves of gantries on belts and tables.
constexpr double kTransitionNear = 0.3;
constexpr double kTransitionFar = 0.5;
constexpr double kTransitionLengths = 4;
constexpr double kEstimateMargin = 1.04;

// The initial state: the tool at rest.
struct Start {
  CarrierBinding to;
  CarriedTarget cargo;
  KinematicState carrier;  // travel in the previous cycle
  End tool;
  // First to third derivatives of the coordinates with respect to the travel.
  trajectory::PathCoordinateValues by_carrier{};
  trajectory::PathCoordinateValues bend{};
  trajectory::PathCoordinateValues twist{};
  MovingFrame taken;   // tool pose and its derivatives with respect to the travel
  KDL::Vector target;  // present position of the target in the MCS
};

// Motion along the path from rest with constant acceleration up to a velocity: what boarding leaves.
struct ReservedMotion {
  double velocity = 0;
  double acceleration = 0;
  double build_up_s = 0;

  // Of the raw motion (trajectory/path_window.h).
  double Speed(double time_s) const { return std::min(acceleration * time_s, velocity); }
  double Distance(double time_s) const {
    const double speeds_up_s = std::min(time_s, velocity / acceleration);
    return 0.5 * acceleration * speeds_up_s * speeds_up_s + velocity * (time_s - speeds_up_s);
  }
  // Returns the mean motion at `time_s`, approximately; it ends at `length`.
  trajectory::Piece At(double time_s, double length) const {
    const double built_s = std::min(time_s, build_up_s), jerk = acceleration / build_up_s;
    const trajectory::Piece begin{0, 0, 0, jerk};
    const KinematicState built = begin.At(built_s);
    const trajectory::Piece then{built.position, built.velocity, built.acceleration, time_s < build_up_s ? jerk : 0};
    KinematicState now = then.At(time_s - built_s);
    if (now.velocity > velocity) now = {std::max(0.0, Distance(time_s - 0.5 * build_up_s)), velocity, 0};
    if (now.position > length) now = {length, 0, 0};
    return {now.position, now.velocity, now.acceleration, now.acceleration > 0 ? then.jerk : 0};
  }
};

// A plan with its estimated motion along the path.
struct Candidate : BoardingPlan {
  double time_s = HUGE_VAL;    // estimated, until the target is reached [s]
  double length = 0;           // of the path [mm]
  trajectory::AlongPath axes;  // limits along the path that the coordinates leave beside the carrier
  MovingFrame along;           // initial tangent, per mm
  ReservedMotion path;
};

// Returns the pose of a tool that the carrier moves to `travel`; at travel `rest` the tool is `tool`.
MovingFrame TakenBy(const Context& c, const Start& start, double rest, const KinematicState& travel,
                    const MovingFrame& tool) {
  kinematics::Carrier carrier = CarrierOf(c, start.cargo);
  carrier.travel = travel;
  const MovingFrame place = kinematics::PoseOn(carrier, start.cargo.from, kinematics::ToFrame(start.cargo.lies));
  return place * (BindingAtRest(c, start.cargo, rest).reference_inverse * tool);
}

MovingFrame TakenBy(const Context& c, const Start& start, double rest, const KinematicState& travel) {
  return TakenBy(c, start, rest, travel, MovingFrame(start.tool.tool));
}

KinematicState TravelAt(const Start& start, const KinematicState& apart, double time_s) {
  const double v = start.carrier.velocity;
  return {start.carrier.position + time_s * v + apart.position, v + apart.velocity, apart.acceleration};
}

// Computes velocities and accelerations of all coordinates for a motion of the tool. Returns false if the inverse
// kinematics fails.
bool CoordinatesFor(const Context& c, const State& s, const MovingFrame& tool, kinematics::Joints& near,
                    trajectory::PathSlopes& out) {
  const Stretch& next = c.ahead.next;
  kinematics::JointMotion motion;
  if (AxesFor(c, s, next, tool, {next.from, 0, 0}, near, motion) != kinematics::Reason::kNone) return false;
  near = motion.position;
  out = CoordinatesOf(c, motion, tool);
  return true;
}

// Estimates the time of a motion from rest to rest that is limited to `first` for `first_s`, then to `then` [s].
double EstimatePathTime(double length, const ReservedMotion& first, double first_s, const trajectory::AlongPath& then) {
  if (!(length > 0)) return 0;
  const double a = then.acceleration, build_up_s = a / then.jerk;
  const double v = first.Speed(first_s), left = length - first.Distance(first_s);
  if (left <= 0.5 * v * v / a) {
    const double most = std::min(std::sqrt(first.acceleration * length), first.velocity);
    return build_up_s + length / most + most / first.acceleration;
  }
  const double most = std::min(std::sqrt(a * left + 0.5 * v * v), then.velocity);
  const double at_speed = left - (most * most - 0.5 * v * v) / a;
  return build_up_s + first_s + (2 * most - v) / a + at_speed / most;
}

// Plans lead and profile of the clutch for the limits of the candidate. Returns false if there is no profile.
bool PlanProfile(const Context& c, const Start& start, double lead_share, Candidate& candidate) {
  const double v = start.carrier.velocity;
  candidate.lead = lead_share * trajectory::StopPosition({0, v, 0}, candidate.limits);
  return !ComeAboard(c.axes.Of(0).planner, v, candidate.limits, {candidate.lead, -v, 0}, candidate.boarding.apart)
              .failed();
}

// Computes the slopes of the coordinates at the beginning of the path, and their mixed second derivative with respect
// to arc length and travel, times the velocity of the carrier. Returns false if the inverse kinematics fails.
bool CoordinatesAlong(const Context& c, const State& s, const Start& start, const MovingFrame& along,
                      trajectory::PathSlopes& by_path, trajectory::PathCoordinateValues& cross) {
  kinematics::Joints near = start.tool.joints;
  if (!CoordinatesFor(c, s, along, near, by_path)) return false;
  const double v = start.carrier.velocity;
  MovingFrame both = start.taken;
  both.p.v = v * start.taken.p.v + along.p.v;
  both.p.dv = v * v * start.taken.p.dv + 2 * v * (start.taken.M.w * along.p.v);
  both.M.w = v * start.taken.M.w + along.M.w;
  both.M.dw = v * v * start.taken.M.dw + v * (start.taken.M.w * along.M.w);
  trajectory::PathSlopes slopes;
  if (!CoordinatesFor(c, s, both, near, slopes)) return false;
  for (std::size_t k = 0; k < cross.size(); ++k) {
    cross[k] = 0.5 * (slopes.second[k] - by_path.second[k] - v * v * start.bend[k]);
  }
  return true;
}

// Estimates the time of the move and the arc length reached while boarding.
void EstimateTime(const Context& c, const State& s, const Start& start, Candidate& candidate) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const Stretch& next = c.ahead.next;
  Boarding& boarding = candidate.boarding;
  const double v = start.carrier.velocity, boards_s = boarding.apart.duration();
  const KDL::Vector to = start.target + candidate.lead * start.taken.p.v - start.tool.tool.p;
  const bool straight = next.segment.shape == path::Shape::kLine;
  // The arc length of a segment that only turns is an angle.
  const bool by_segment = !straight || next.segment.measure != path::Measure::kWay;
  const double length = std::max(straight ? to.Norm() : 0.0, by_segment ? next.segment.length : 0.0);
  trajectory::AlongPath full = next.limits;
  ReservedMotion& first = candidate.path;
  candidate.length = length;
  double speed = 0;  // along the path at the end of boarding
  trajectory::PathSlopes by_path;
  trajectory::PathCoordinateValues cross{};
  if (length > 0) {
    const path::MovingFrame begins = path::At(next.segment, next.from);
    MovingFrame& along = candidate.along;
    along = MovingFrame(start.tool.tool);
    along.p.v = straight ? to / length : begins.p.v;
    along.M.w = begins.M.w * (next.segment.length / length);
    if (!CoordinatesAlong(c, s, start, along, by_path, cross)) return;
  }
  for (int round = 0; round < kSpeedRounds; ++round) {
    trajectory::AlongPath axes = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    trajectory::AlongPath left = next.limits;
    for (std::size_t k = 0; k < own.count; ++k) {
      const double slope = std::abs(by_path.first[k]);
      if (slope == 0) continue;
      const auto along = [&](const trajectory::Left& share) {
        const trajectory::CoordinateLimits::One& of = own.of[k];
        const double a = share.acceleration * of.acceleration / slope;
        return trajectory::AlongPath{share.velocity * of.velocity / slope, a, a, share.jerk * of.jerk / slope};
      };
      const CarrierPart part = {v * start.by_carrier[k], v * v * start.bend[k], cross[k]};
      axes = trajectory::Least(axes, along(LeftBeside(own.of[k], part, full.velocity)));
      left = trajectory::Least(left, along(LeftBeside(own.of[k], part, speed, &boarding, k)));
    }
    candidate.axes = axes;
    full = trajectory::Least(next.limits, axes);
    // The build-up time is the same all along the path.
    const double build_up_s = full.acceleration / full.jerk;
    first = {left.velocity, std::min(left.acceleration, left.jerk * build_up_s), build_up_s};
    const double attained = kReachMargin * first.Speed(boards_s);
    speed = round == 0 ? 0.5 * attained : std::sqrt(speed * attained);
  }
  candidate.time_s = std::max(boards_s, EstimatePathTime(length, first, boards_s, full));
  boarding.reach = kReachMargin * first.Distance(boards_s);
}

// Returns a candidate, estimated with the derivatives at the initial state.
Candidate MakeCandidate(const Context& c, const State& s, const Start& start, const trajectory::Limits& limits,
                        double part, double lead_share) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const double v = std::abs(start.carrier.velocity);
  Candidate candidate;
  candidate.limits = limits;
  const auto limit = [](double& value, double share, double slope) {
    if (slope != 0) value = std::min(value, share / std::abs(slope));
  };
  for (std::size_t k = 0; k < own.count; ++k) {
    limit(candidate.limits.acceleration, part * own.of[k].acceleration, start.by_carrier[k]);
    limit(candidate.limits.acceleration, kBendsShare * own.of[k].jerk, 3 * v * start.bend[k]);
    limit(candidate.limits.jerk, part * own.of[k].jerk, start.by_carrier[k]);
  }
  candidate.limits.deceleration = candidate.limits.acceleration;
  if (!PlanProfile(c, start, lead_share, candidate)) return candidate;
  for (std::size_t k = 0; k < own.count; ++k) {
    const double slope = std::abs(start.by_carrier[k]), bend = std::abs(start.bend[k]);
    candidate.boarding.velocity[k] = slope * v;
    candidate.boarding.acceleration[k] = slope * candidate.limits.acceleration + bend * v * v;
    candidate.boarding.jerk[k] = slope * candidate.limits.jerk + 3 * bend * v * candidate.limits.acceleration +
                                 std::abs(start.twist[k]) * v * v * v;
  }
  EstimateTime(c, s, start, candidate);
  return candidate;
}

// The largest absolute values of each coordinate.
struct Extremes {
  trajectory::PathCoordinateValues velocity{};
  trajectory::PathCoordinateValues acceleration{};
  trajectory::PathCoordinateValues jerk{};
};

// Samples a motion of the tool in each piece of a profile: tool_at(time, later) returns its pose `later` seconds after
// a time within the piece. Returns false if the inverse kinematics fails.
template <typename ToolAt>
bool FindExtremes(const Context& c, const State& s, const trajectory::Profile& profile, kinematics::Joints near,
                  const ToolAt& tool_at, Extremes& out) {
  const bool costly = std::holds_alternative<kinematics::Serial>(c.kinematics->mechanism);
  const int places = costly ? kSamplesPerPieceOfChain : kSamplesPerPiece;
  double begin_s = 0;
  for (std::size_t piece = 0; piece < static_cast<std::size_t>(profile.size()); ++piece) {
    const double end_s = profile.piece_ends_s[piece];
    const double step_s = std::min(c.cycle.period_s, end_s - begin_s);  // shorter pieces have no effect on set points
    for (int i = 0; i < places; ++i) {
      const double time_s = std::lerp(begin_s, end_s - step_s, static_cast<double>(i) / (places - 1));
      trajectory::PathSlopes now, then;
      if (!CoordinatesFor(c, s, tool_at(time_s, 0.0), near, now)) return false;
      if (!CoordinatesFor(c, s, tool_at(time_s, step_s), near, then)) return false;
      for (std::size_t k = 0; k < c.ahead.window.limits().count; ++k) {
        const double jerk = (then.second[k] - now.second[k]) / c.cycle.period_s;
        out.velocity[k] = std::max(out.velocity[k], std::abs(then.first[k]));
        out.acceleration[k] = std::max(out.acceleration[k], std::abs(then.second[k]));
        out.jerk[k] = std::max(out.jerk[k], std::abs(jerk));
      }
    }
    begin_s = end_s;
  }
  return true;
}

// Returns the largest ratio of a value to its limit.
double LargestShare(const trajectory::CoordinateLimits& own, const Extremes& extremes) {
  double part = 0;
  for (std::size_t k = 0; k < own.count; ++k) {
    part = std::max({part, extremes.velocity[k] / own.of[k].velocity, extremes.acceleration[k] / own.of[k].acceleration,
                     extremes.jerk[k] / own.of[k].jerk});
  }
  return part;
}

// Samples what boarding needs of each coordinate. Returns the largest ratio to a limit.
double MeasureBoarding(const Context& c, const State& s, const Start& start, Candidate& candidate) {
  Boarding& boarding = candidate.boarding;
  const double v = start.carrier.velocity;
  boarding.faster = 1;
  Extremes extremes;
  const auto taken_at = [&](double time_s, double later_s) {
    const KinematicState apart = boarding.apart.At(time_s + later_s);
    boarding.faster = std::max(boarding.faster, std::abs((v + apart.velocity) / v));
    return TakenBy(c, start, start.carrier.position + candidate.lead, TravelAt(start, apart, time_s + later_s));
  };
  if (!FindExtremes(c, s, boarding.apart, start.tool.joints, taken_at, extremes)) return HUGE_VAL;
  for (std::size_t k = 0; k < extremes.velocity.size(); ++k) {
    boarding.velocity[k] = kSampleMargin * extremes.velocity[k];
    boarding.acceleration[k] = kSampleMargin * extremes.acceleration[k];
    boarding.jerk[k] = kSampleMargin * extremes.jerk[k];
  }
  return kSampleMargin * LargestShare(c.ahead.window.limits(), extremes);
}

// The same for boarding and the estimated motion along the path together.
double MeasureWithPath(const Context& c, const State& s, const Start& start, const Candidate& candidate) {
  Extremes extremes;
  const auto both_at = [&](double time_s, double later_s) {
    const KinematicState travel = TravelAt(start, candidate.boarding.apart.At(time_s + later_s), time_s + later_s);
    const KinematicState along = candidate.path.At(time_s, candidate.length).At(later_s);
    MovingFrame tool(start.tool.tool);
    tool.p.p += along.position * candidate.along.p.v;
    tool.p.v = along.velocity * candidate.along.p.v;
    tool.p.dv = along.acceleration * candidate.along.p.v;
    return TakenBy(c, start, start.carrier.position + candidate.lead, travel, tool);
  };
  const bool found = FindExtremes(c, s, candidate.boarding.apart, start.tool.joints, both_at, extremes);
  return found ? LargestShare(c.ahead.window.limits(), extremes) : HUGE_VAL;
}

// Returns 1 where the limits of the axes bind, 0 where those of the path are lower than half of them: then the
// transition between carrier bindings takes no longer than the path.
double BindingOf(const Context& c, const Candidate& candidate) {
  const trajectory::AlongPath& path = c.ahead.next.limits;
  const trajectory::AlongPath& axes = candidate.axes;
  const double ratio = std::max(path.velocity / axes.velocity, path.acceleration / axes.acceleration);
  return std::clamp(2 * ratio - 1, 0.0, 1.0);
}

// Estimates the time of the move with a transition between carrier bindings instead [s].
double EstimateTransitionTime(const Context& c, const Start& start, const Candidate& candidate) {
  const Stretch& next = c.ahead.next;
  const double time_s = next.eta_end - next.eta_begin;
  const double carried = std::abs(start.carrier.velocity) * start.taken.p.v.Norm() * time_s;
  const double lengths = std::min(carried / next.segment.length, kTransitionLengths) * BindingOf(c, candidate);
  return time_s * (1 + kTransitionNear * std::min(lengths, 1.0) + kTransitionFar * std::max(0.0, lengths - 1));
}

bool IsFaster(const Context& c, const Start& start, const Candidate& candidate) {
  return kEstimateMargin * candidate.time_s <= EstimateTransitionTime(c, start, candidate);
}

// Returns true if the axes reach the target at the pose of its carrier after `time_s`.
bool ReachesTarget(const Context& c, const State& s, const Start& start, double time_s) {
  const Stretch& next = c.ahead.next;
  const Frame target = DisplacementOf(c, start.to, time_s).GetFrame() * path::PointAt(next.segment, next.to).frame;
  kinematics::Joints near = c.ahead.next_joints;
  trajectory::PathSlopes slopes;
  return CoordinatesFor(c, s, MovingFrame(target), near, slopes);
}

// Returns false if the inverse kinematics fails.
bool FindStart(const Context& c, const State& s, const CarrierBinding& to, Start& start) {
  start.to = to;
  start.cargo = to.cargo;
  start.carrier = CarrierOf(c, to.cargo).travel;
  start.carrier.position -= c.cycle.period_s * start.carrier.velocity;
  start.tool = Present(c, s);
  const Stretch& next = c.ahead.next;
  start.target = DisplacementOf(c, to, 0).GetFrame() * path::PointAt(next.segment, next.to).frame.p;
  start.taken = TakenBy(c, start, start.carrier.position, {start.carrier.position, 1, 0});
  trajectory::PathSlopes slopes, near_by;
  kinematics::Joints near = start.tool.joints;
  const double step = kDifference * start.carrier.velocity;
  const MovingFrame taken = TakenBy(c, start, start.carrier.position, {start.carrier.position + step, 1, 0});
  if (!CoordinatesFor(c, s, start.taken, near, slopes) || !CoordinatesFor(c, s, taken, near, near_by)) return false;
  start.by_carrier = slopes.first;
  start.bend = slopes.second;
  for (std::size_t k = 0; k < slopes.second.size(); ++k) start.twist[k] = (near_by.second[k] - slopes.second[k]) / step;
  return true;
}

// Finds the fastest candidate within the limits. Returns false if there is none.
bool FindBest(const Context& c, const State& s, const Start& start, Candidate& best) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const trajectory::AlongPath& path = c.ahead.next.limits;
  const double length = start.taken.p.v.Norm(), scale = length > 0 ? 1 / length : 1;
  trajectory::Limits limits = {HUGE_VAL, scale * path.acceleration, scale * path.acceleration, scale * path.jerk};
  const double least = kLeastOverspeed * std::abs(start.carrier.velocity);
  const auto limit = [&limits](double share, double slope) {
    if (slope != 0) limits.velocity = std::min(limits.velocity, share / std::abs(slope));
  };
  for (std::size_t k = 0; k < own.count; ++k) {
    limit(kVelocityShare * own.of[k].velocity, start.by_carrier[k]);
    const double bend = std::abs(start.bend[k]), twist = std::abs(start.twist[k]);
    if (bend > 0) limit(std::max(least, std::sqrt(kBendsShare * own.of[k].acceleration / bend)), 1);
    if (twist > 0) limit(std::max(least, maths::Cbrt(kBendsShare * own.of[k].jerk / twist)), 1);
  }
  if (!(limits.velocity < kUnlimited)) return false;
  std::array<std::array<double, kLeads.size()>, kShares.size()> times_s;
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    for (std::size_t k = 0; k < kLeads.size(); ++k) {
      times_s[i][k] = MakeCandidate(c, s, start, limits, kShares[i], kLeads[k]).time_s;
    }
  }
  double most_part = 1;
  const bool turns = CarrierOf(c, start.cargo).kind == kinematics::CarrierKind::kTurning;
  for (int i = 0; i < kTries; ++i) {
    std::size_t part = 0, lead = 0;
    double time_s = HUGE_VAL;
    for (std::size_t j = 0; j < kShares.size() && kShares[j] <= most_part; ++j) {
      const auto least = std::ranges::min_element(times_s[j]);
      if (*least >= time_s) continue;
      time_s = *least;
      part = j;
      lead = static_cast<std::size_t>(least - times_s[j].begin());
    }
    if (time_s == HUGE_VAL) return false;
    best = MakeCandidate(c, s, start, limits, kShares[part], kLeads[lead]);
    if (!IsFaster(c, start, best)) return false;
    double taken = MeasureBoarding(c, s, start, best);
    if (taken <= kMostSampled) {
      EstimateTime(c, s, start, best);
      if (!IsFaster(c, start, best) || !ReachesTarget(c, s, start, best.time_s)) return false;
      // Turning adds Coriolis terms to the motion along the path.
      taken = turns ? kMostSampled * MeasureWithPath(c, s, start, best) : 0;
      if (taken <= kMostSampled) return true;
    }
    times_s[part][lead] = HUGE_VAL;
    most_part = std::min(most_part, kShareMargin * kShares[part] * kMostSampled / taken);
  }
  return false;
}

}  // namespace

bool PlanBoarding(const Context& c, const State& s, const CarrierBinding& to, BoardingPlan& plan) noexcept {
  Start start;
  Candidate best;
  if (!FindStart(c, s, to, start) || !FindBest(c, s, start, best)) return false;
  plan = best;
  plan.carrier = start.carrier;
  return true;
}

}  // namespace takt::group
