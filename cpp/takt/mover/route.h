// A route of one mover over the free surface, during its execution (follow_route.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/mover/commands.h"

namespace takt::mover {

inline constexpr std::size_t kMostVisits = 512;  // of one route
inline constexpr std::size_t kMostKept = 32;     // of the preceding route, to which the mover is already bound
inline constexpr double kNear = 0.05;            // [mm] tolerance of the distance from the route

// Visits of one mover, numbered consecutively over all its routes.
class Visits {
 public:
  Visits() : items_(kMostKept + kMostVisits) {}

  const Visit& operator[](std::uint64_t number) const noexcept { return items_[Place(number)]; }
  std::uint64_t first() const noexcept { return first_; }
  std::uint64_t last() const noexcept { return first_ + count_ - 1; }
  bool empty() const noexcept { return count_ == 0; }

  void Clear(std::uint64_t first) noexcept {
    first_ = first;
    count_ = 0;
  }
  // Returns false if there is no room.
  bool Add(const Visit& visit) noexcept {
    if (count_ == kMostVisits) return false;
    items_[kMostKept + count_++] = visit;
    return true;
  }
  // Sets a visit of the route, or one of up to kMostKept visits before its first one.
  void Put(std::uint64_t number, const Visit& visit) noexcept { items_[Place(number)] = visit; }

 private:
  std::size_t Place(std::uint64_t number) const noexcept {
    return kMostKept + static_cast<std::size_t>(number - first_);  // unsigned arithmetic is also right below `first_`
  }

  std::vector<Visit> items_;
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
};

// Dynamics of the motions on a route; unset: the mover's standard.
struct RouteDynamics {
  std::optional<double> velocity{};      // [mm/s]
  std::optional<double> acceleration{};  // [mm/s²]
  std::optional<double> deceleration{};  // [mm/s²]
  std::optional<double> jerk{};          // [mm/s³]
};

// `begin`, `passed`, `granted`, `sent`, `held_at` and `leg` are numbers of visits.
struct SurfaceRoute {
  Visits visits;
  RouteDynamics dynamics{};
  std::uint64_t started = 0;      // cycle
  std::uint64_t begin = 0;        // the first visit in `visits`
  std::uint64_t passed = 0;       // the last place whose centre the mover has reached
  std::uint64_t granted = 0;      // the last place that is granted
  std::uint64_t sent = 0;         // the place to which the mover was last sent
  bool aims = false;              // the motion ends at the known position ...
  double aim_x = 0, aim_y = 0;    // [mm]
  std::uint32_t system = 0;       // coordinate system of the places
  std::uint32_t pause = 0;        // cycles until a refused move is tried again
  std::uint64_t rests_since = 0;  // cycle since which it rests before a place that is not granted; 0: it does not

  bool held = false;          // no further place is granted
  std::uint64_t held_at = 0;  // while routes are held: where the mover comes to rest

  bool timed = false;            // the visits have planned times
  std::uint64_t leg = 0;         // start of the present planned motion, or at rest of the next one
  bool leaves = false;           // that motion has begun ...
  double late = 0;               // [s] ... with this delay; infinite: not known
  std::uint64_t look_again = 0;  // cycle in which the start of that motion is computed anew

  Visits draft;             // received, and not started
  Ticket draft_ticket = 0;  // of the command that gave it; 0: none
  bool takes = false;       // while routes are started: the draft begins now

  std::uint64_t last() const noexcept { return visits.empty() ? passed : visits.last(); }
};

// Unit vector along X or Y.
struct Heading {
  double x = 0, y = 0;
  bool operator==(const Heading&) const = default;
};

// Returns the distance [mm] between two places on a line along X or Y.
inline double Distance(const Visit& a, const Visit& b) noexcept {
  return std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
}

inline Heading HeadingOf(const Visit& a, const Visit& b) noexcept {
  const double x = b.x - a.x, y = b.y - a.y;
  if (std::abs(x) > std::abs(y)) return {x > 0 ? 1.0 : -1.0, 0};
  return {0, y > 0 ? 1.0 : -1.0};
}

// The heading and the distance from this visit to the next one.
inline Heading HeadingAt(const SurfaceRoute& r, std::uint64_t visit) noexcept {
  return HeadingOf(r.visits[visit], r.visits[visit + 1]);
}
inline double PitchAt(const SurfaceRoute& r, std::uint64_t visit) noexcept {
  return Distance(r.visits[visit], r.visits[visit + 1]);
}

// The routes of all movers.
struct SurfaceRoutes {
  explicit SurfaceRoutes(std::size_t movers) : of(movers) {}

  std::vector<SurfaceRoute> of;
  std::uint64_t changes = 0;  // number of SetRoute commands accepted so far
};

// Why a route was refused: the value of a feedback with ErrorId::kRoute.
enum class RouteProblem : std::uint8_t {
  kNone,
  kTooMany,    // more than kMostVisits
  kNotNext,    // `first` of a continuation is not the number after the last visit
  kNotBeside,  // a place is not beside the preceding one, along X or Y
  kTimes,      // a planned motion without both times, or not straight
  kNoMover,    // no mover has the number `after`
  kNoVisit,    // that mover has no visit `after_visit`
  kNumber,     // `first` is not the number of the visit where the mover is
  kElsewhere,  // the mover, at rest, is not at the place
  kTooLate,    // the mover is bound for later places, and cannot come to rest before them
  kBehind,     // the mover is bound for a place that another mover, which does not get that far, is to visit before
  kMissing,    // the mover is behind one that changes its route, and has no new route
  kNoneTold,   // no mover has received a route
  kMoves,      // the mover is not at rest
  kNoRoute,    // the mover has no route to resume
};
std::string_view MessageOf(RouteProblem problem) noexcept;

void describe(Description<RouteDynamics>&);
void describe(Description<SurfaceRoute>&);

}  // namespace takt::mover
