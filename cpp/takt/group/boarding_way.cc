#include "takt/group/boarding_way.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/group/ask.h"
#include "takt/group/boarding.h"
#include "takt/group/clutch.h"
#include "takt/group/make_stretch.h"
#include "takt/group/rides.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

// What boarding may take of the limits of an axis, and how far the clutch begins ahead, of the way on which it speeds
// up: of all of them the best is taken.
constexpr std::array kParts = {0.15, 0.3, 0.5, 0.7, 0.9};
constexpr std::array kLeads = {0.0, 0.5, 1.0, 1.5, 2.5};
constexpr double kBoardingShare = 0.9;  // of the coordinates', for boarding at most
constexpr int kTries = 3;               // ways that are looked at
constexpr double kNotLess = 1.1;        // where a part turns out to be too much: of what would be right, others
// Going over takes longer than along a path that stands: per length of the path that the carrier goes meanwhile by the
// first part up to one length, by the second up to some; and boarding takes longer than estimated (measured on
// gantries, belts and tables).
constexpr double kGoesOver = 0.3;
constexpr double kGoesOverFar = 0.5;
constexpr double kMostLengths = 4;
constexpr double kBoardsLonger = 1.04;
constexpr double kBoardingBends = 0.4;  // of acceleration and jerk, for bends along the travel of the carrier
constexpr int kWeighRounds = 4;         // of the speed that the path attains while the tool boards
constexpr double kLeastFaster = 1.3;    // than the carrier, whatever bends there are
constexpr double kNearBy = 1e-3;        // of the travel that the carrier has in a second, for differences
constexpr double kMost = 0.96;          // of them, as seen
constexpr double kMore = 1.05;          // than was seen
constexpr int kPlacesInPiece = 4;       // of the profile, its ends among them, ...
constexpr int kPlacesIfCostly = 2;      // ... with an inverse of a chain for each

// The tool at rest, about to board.
struct Start {
  Cargo cargo;
  KinematicState carrier;  // its travel, a cycle ago
  End tool;
  // The derivatives of the coordinates by the travel.
  trajectory::PathCoordinateValues by_carrier{};
  trajectory::PathCoordinateValues bend{};
  trajectory::PathCoordinateValues twist{};
  MovingFrame taken;   // the tool likewise
  KDL::Vector target;  // where its place is now
};

// A motion along the path that begins at rest: at this acceleration up to this velocity.
struct Throttled {
  double velocity = 0;
  double acceleration = 0;
  double build_up_s = 0;

  // Of the raw motion.
  double Speed(double time_s) const { return std::min(acceleration * time_s, velocity); }
  double Way(double time_s) const {
    const double speeds_up_s = std::min(time_s, velocity / acceleration);
    return 0.5 * acceleration * speeds_up_s * speeds_up_s + velocity * (time_s - speeds_up_s);
  }
  // Of its mean, about, up to a place where it stands.
  trajectory::Piece At(double time_s, double length) const {
    const double built_s = std::min(time_s, build_up_s), jerk = acceleration / build_up_s;
    const trajectory::Piece begin{0, 0, 0, jerk};
    const KinematicState built = begin.At(built_s);
    const trajectory::Piece then{built.position, built.velocity, built.acceleration, time_s < build_up_s ? jerk : 0};
    KinematicState now = then.At(time_s - built_s);
    if (now.velocity > velocity) now = {std::max(0.0, Way(time_s - 0.5 * build_up_s)), velocity, 0};
    if (now.position > length) now = {length, 0, 0};
    return {now.position, now.velocity, now.acceleration, now.acceleration > 0 ? then.jerk : 0};
  }
};

// With the path meanwhile.
struct Candidate : BoardingWay {
  double time_s = HUGE_VAL;  // until the tool is at its place, about
  double length = 0;         // of the path
  MovingFrame along;         // its beginning, per mm
  Throttled path;
};

// A tool taken along from rest by a carrier with this travel, which was at `rest` before.
MovingFrame TakenBy(const Context& c, const Start& start, double rest, const KinematicState& travel,
                    const MovingFrame& tool) {
  kinematics::Carrier carrier = CarrierOf(c, start.cargo);
  carrier.travel = travel;
  const MovingFrame place = kinematics::PoseOn(carrier, start.cargo.from, kinematics::ToFrame(start.cargo.lies));
  return place * (RideAtRest(c, start.cargo, rest).reference_inverse * tool);
}

MovingFrame TakenBy(const Context& c, const Start& start, double rest, const KinematicState& travel) {
  return TakenBy(c, start, rest, travel, MovingFrame(start.tool.tool));
}

KinematicState TravelAt(const Start& start, const KinematicState& apart, double time_s) {
  const double v = start.carrier.velocity;
  return {start.carrier.position + time_s * v + apart.position, v + apart.velocity, apart.acceleration};
}

// Velocities and accelerations of all coordinates for a motion of the tool. False: the axes cannot follow it.
bool CoordinatesFor(const Context& c, const State& s, const MovingFrame& tool, kinematics::Joints& near,
                    trajectory::PathSlopes& out) {
  const Stretch& next = c.ahead.next;
  kinematics::JointMotion motion;
  if (AxesFor(c, s, next, tool, {next.from, 0, 0}, near, motion) != kinematics::Reason::kNone) return false;
  near = motion.position;
  out = CoordinatesOf(c, motion, tool);
  return true;
}

// About how long a motion from rest to rest takes that is throttled at first, for so long.
double TimeAlong(double length, const Throttled& first, double first_s, const trajectory::AlongPath& then) {
  if (!(length > 0)) return 0;
  const double a = then.acceleration, build_up_s = a / then.jerk;
  const double v = first.Speed(first_s), left = length - first.Way(first_s);
  if (left <= 0.5 * v * v / a) {
    const double most = std::min(std::sqrt(first.acceleration * length), first.velocity);
    return build_up_s + length / most + most / first.acceleration;
  }
  const double most = std::min(std::sqrt(a * left + 0.5 * v * v), then.velocity);
  const double at_speed = left - (most * most - 0.5 * v * v) / a;
  return build_up_s + first_s + (2 * most - v) / a + at_speed / most;
}

// The profile of the clutch for what `way.limits` says. False: there is none.
bool PlanBoarding(const Context& c, const Start& start, double lead_share, Candidate& way) {
  const double v = start.carrier.velocity;
  way.lead = lead_share * trajectory::StopPosition({0, v, 0}, way.limits);
  return !ComeAboard(c.axes.Of(0).planner, v, way.limits, {way.lead, -v, 0}, way.boarding.apart).failed();
}

// The coordinates by the way where the path begins, and by way and time together: the half of what is more than the sum
// of both. False: the axes cannot follow it.
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

// Estimates the time of the path while the tool boards and after that, and the reach.
void WeighPath(const Context& c, const State& s, const Start& start, Candidate& way) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const Stretch& next = c.ahead.next;
  Boarding& boarding = way.boarding;
  const double v = start.carrier.velocity, boards_s = boarding.apart.duration();
  const KDL::Vector to = start.target + way.lead * start.taken.p.v - start.tool.tool.p;
  const bool straight = next.segment.shape == path::Shape::kLine;
  // Where the tool only turns, the way is counted otherwise.
  const bool by_segment = !straight || next.segment.measure != path::Measure::kWay;
  const double length = std::max(straight ? to.Norm() : 0.0, by_segment ? next.segment.length : 0.0);
  trajectory::AlongPath full = next.limits;
  Throttled& first = way.path;
  way.length = length;
  double speed = 0;  // of the path when boarding ends
  trajectory::PathSlopes by_path;
  trajectory::PathCoordinateValues cross{};
  if (length > 0) {
    const path::MovingFrame begins = path::At(next.segment, next.from);
    MovingFrame& along = way.along;
    along = MovingFrame(start.tool.tool);
    along.p.v = straight ? to / length : begins.p.v;
    along.M.w = begins.M.w * (next.segment.length / length);
    if (!CoordinatesAlong(c, s, start, along, by_path, cross)) return;
  }
  for (int round = 0; round < kWeighRounds; ++round) {
    full = next.limits;
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
      full = trajectory::Least(full, along(LeftBeside(own.of[k], part, full.velocity)));
      left = trajectory::Least(left, along(LeftBeside(own.of[k], part, speed, &boarding, k)));
    }
    // Accelerations build up in the same time everywhere.
    const double build_up_s = full.acceleration / full.jerk;
    first = {left.velocity, std::min(left.acceleration, left.jerk * build_up_s), build_up_s};
    const double attained = kReachesFurther * first.Speed(boards_s);
    speed = round == 0 ? 0.5 * attained : std::sqrt(speed * attained);
  }
  way.time_s = std::max(boards_s, TimeAlong(length, first, boards_s, full));
  boarding.reach = kReachesFurther * first.Way(boards_s);
}

// What boarding takes if the coordinates follow the travel all along as they do at its beginning.
Candidate WayWith(const Context& c, const State& s, const Start& start, const trajectory::Limits& limits, double part,
                  double lead_share) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const double v = std::abs(start.carrier.velocity);
  Candidate way;
  way.limits = limits;
  const auto limit = [](double& value, double share, double slope) {
    if (slope != 0) value = std::min(value, share / std::abs(slope));
  };
  for (std::size_t k = 0; k < own.count; ++k) {
    limit(way.limits.acceleration, part * own.of[k].acceleration, start.by_carrier[k]);
    limit(way.limits.acceleration, kBoardingBends * own.of[k].jerk, 3 * v * start.bend[k]);
    limit(way.limits.jerk, part * own.of[k].jerk, start.by_carrier[k]);
  }
  way.limits.deceleration = way.limits.acceleration;
  if (!PlanBoarding(c, start, lead_share, way)) return way;
  for (std::size_t k = 0; k < own.count; ++k) {
    const double slope = std::abs(start.by_carrier[k]), bend = std::abs(start.bend[k]);
    way.boarding.velocity[k] = slope * v;
    way.boarding.acceleration[k] = slope * way.limits.acceleration + bend * v * v;
    way.boarding.jerk[k] =
        slope * way.limits.jerk + 3 * bend * v * way.limits.acceleration + std::abs(start.twist[k]) * v * v * v;
  }
  WeighPath(c, s, start, way);
  return way;
}

// The largest values of the coordinates.
struct Extremes {
  trajectory::PathCoordinateValues velocity{};
  trajectory::PathCoordinateValues acceleration{};
  trajectory::PathCoordinateValues jerk{};
};

// Those of a motion of the tool, by places along each piece of a profile: tool_at(time, later), with the time within
// the piece and what is to be added to it. False: the axes cannot follow.
template <typename ToolAt>
bool FindExtremes(const Context& c, const State& s, const trajectory::Profile& profile, kinematics::Joints near,
                  const ToolAt& tool_at, Extremes& out) {
  const bool costly = std::holds_alternative<kinematics::Serial>(c.kinematics->mechanism);
  const int places = costly ? kPlacesIfCostly : kPlacesInPiece;
  double begin_s = 0;
  for (std::size_t piece = 0; piece < static_cast<std::size_t>(profile.size()); ++piece) {
    const double end_s = profile.piece_ends_s[piece];
    const double step_s = std::min(c.cycle.period_s, end_s - begin_s);  // nothing is known within less than a cycle
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

// The largest part of a limit that is taken.
double PartOf(const trajectory::CoordinateLimits& own, const Extremes& extremes) {
  double part = 0;
  for (std::size_t k = 0; k < own.count; ++k) {
    part = std::max({part, extremes.velocity[k] / own.of[k].velocity, extremes.acceleration[k] / own.of[k].acceleration,
                     extremes.jerk[k] / own.of[k].jerk});
  }
  return part;
}

// What boarding takes of the coordinates as they are. The largest part of a limit.
double LookAt(const Context& c, const State& s, const Start& start, Candidate& way) {
  Boarding& boarding = way.boarding;
  const double v = start.carrier.velocity;
  boarding.faster = 1;
  Extremes extremes;
  const auto taken_at = [&](double time_s, double later_s) {
    const KinematicState apart = boarding.apart.At(time_s + later_s);
    boarding.faster = std::max(boarding.faster, std::abs((v + apart.velocity) / v));
    return TakenBy(c, start, start.carrier.position + way.lead, TravelAt(start, apart, time_s + later_s));
  };
  if (!FindExtremes(c, s, boarding.apart, start.tool.joints, taken_at, extremes)) return HUGE_VAL;
  for (std::size_t k = 0; k < extremes.velocity.size(); ++k) {
    boarding.velocity[k] = kMore * extremes.velocity[k];
    boarding.acceleration[k] = kMore * extremes.acceleration[k];
    boarding.jerk[k] = kMore * extremes.jerk[k];
  }
  return kMore * PartOf(c.ahead.window.limits(), extremes);
}

// The same with the motion along the path, once what that may use is known.
double LookAtBoth(const Context& c, const State& s, const Start& start, const Candidate& way) {
  Extremes extremes;
  const auto both_at = [&](double time_s, double later_s) {
    const KinematicState travel = TravelAt(start, way.boarding.apart.At(time_s + later_s), time_s + later_s);
    const KinematicState along = way.path.At(time_s, way.length).At(later_s);
    MovingFrame tool(start.tool.tool);
    tool.p.p += along.position * way.along.p.v;
    tool.p.v = along.velocity * way.along.p.v;
    tool.p.dv = along.acceleration * way.along.p.v;
    return TakenBy(c, start, start.carrier.position + way.lead, travel, tool);
  };
  const bool found = FindExtremes(c, s, way.boarding.apart, start.tool.joints, both_at, extremes);
  return found ? PartOf(c.ahead.window.limits(), extremes) : HUGE_VAL;
}

// About how long the transition between rides takes instead.
double TimeToGoOver(const Context& c, const Start& start) {
  const Stretch& next = c.ahead.next;
  const double time_s = next.eta_end - next.eta_begin;
  const double carried = std::abs(start.carrier.velocity) * start.taken.p.v.Norm() * time_s;
  const double lengths = std::min(carried / next.segment.length, kMostLengths);
  return time_s * (1 + kGoesOver * std::min(lengths, 1.0) + kGoesOverFar * std::max(0.0, lengths - 1));
}

// False: the axes cannot follow the carrier.
bool FindStart(const Context& c, const State& s, const Ride& to, Start& start) {
  start.cargo = to.cargo;
  start.carrier = CarrierOf(c, to.cargo).travel;
  start.carrier.position -= c.cycle.period_s * start.carrier.velocity;
  start.tool = Present(c, s);
  const Stretch& next = c.ahead.next;
  start.target = DisplacementOf(c, to, 0).GetFrame() * path::PointAt(next.segment, next.to).frame.p;
  start.taken = TakenBy(c, start, start.carrier.position, {start.carrier.position, 1, 0});
  trajectory::PathSlopes slopes, near_by;
  kinematics::Joints near = start.tool.joints;
  const double step = kNearBy * start.carrier.velocity;
  const MovingFrame taken = TakenBy(c, start, start.carrier.position, {start.carrier.position + step, 1, 0});
  if (!CoordinatesFor(c, s, start.taken, near, slopes) || !CoordinatesFor(c, s, taken, near, near_by)) return false;
  start.by_carrier = slopes.first;
  start.bend = slopes.second;
  for (std::size_t k = 0; k < slopes.second.size(); ++k) start.twist[k] = (near_by.second[k] - slopes.second[k]) / step;
  return true;
}

// The best way that keeps the limits. False: there is none.
bool FindBest(const Context& c, const State& s, const Start& start, Candidate& best) {
  const trajectory::CoordinateLimits& own = c.ahead.window.limits();
  const trajectory::AlongPath& path = c.ahead.next.limits;
  const double length = start.taken.p.v.Norm(), scale = length > 0 ? 1 / length : 1;
  trajectory::Limits limits = {HUGE_VAL, scale * path.acceleration, scale * path.acceleration, scale * path.jerk};
  const double least = kLeastFaster * std::abs(start.carrier.velocity);
  const auto limit = [&limits](double share, double slope) {
    if (slope != 0) limits.velocity = std::min(limits.velocity, share / std::abs(slope));
  };
  for (std::size_t k = 0; k < own.count; ++k) {
    limit(kBoardingShare * own.of[k].velocity, start.by_carrier[k]);
    const double bend = std::abs(start.bend[k]), twist = std::abs(start.twist[k]);
    if (bend > 0) limit(std::max(least, std::sqrt(kBoardingBends * own.of[k].acceleration / bend)), 1);
    if (twist > 0) limit(std::max(least, maths::Cbrt(kBoardingBends * own.of[k].jerk / twist)), 1);
  }
  if (!(limits.velocity < kUnlimited)) return false;
  std::array<std::array<double, kLeads.size()>, kParts.size()> times_s;
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    for (std::size_t k = 0; k < kLeads.size(); ++k) {
      times_s[i][k] = WayWith(c, s, start, limits, kParts[i], kLeads[k]).time_s;
    }
  }
  const double most_s = TimeToGoOver(c, start) / kBoardsLonger;
  double most_part = 1;
  const bool turns = CarrierOf(c, start.cargo).kind == kinematics::CarrierKind::kTurning;
  for (int i = 0; i < kTries; ++i) {
    std::size_t part = 0, lead = 0;
    double time_s = HUGE_VAL;
    for (std::size_t j = 0; j < kParts.size() && kParts[j] <= most_part; ++j) {
      const auto least = std::ranges::min_element(times_s[j]);
      if (*least >= time_s) continue;
      time_s = *least;
      part = j;
      lead = static_cast<std::size_t>(least - times_s[j].begin());
    }
    if (time_s > most_s) return false;
    best = WayWith(c, s, start, limits, kParts[part], kLeads[lead]);
    double taken = LookAt(c, s, start, best);
    if (taken <= kMost) {
      WeighPath(c, s, start, best);
      if (best.time_s > most_s) return false;
      // Across a table the motion along the path takes another part, because it is turned.
      taken = turns ? kMost * LookAtBoth(c, s, start, best) : 0;
      if (taken <= kMost) return true;
    }
    times_s[part][lead] = HUGE_VAL;
    most_part = std::min(most_part, kNotLess * kParts[part] * kMost / taken);
  }
  return false;
}

}  // namespace

bool FindWay(const Context& c, const State& s, const Ride& to, BoardingWay& way) noexcept {
  Start start;
  Candidate best;
  if (!FindStart(c, s, to, start) || !FindBest(c, s, start, best)) return false;
  way = best;
  way.carrier = start.carrier;
  return true;
}

}  // namespace takt::group
