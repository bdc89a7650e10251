// A route of one mover over the free surface, as it is carried out (follow_route.h).
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
inline constexpr std::size_t kMostKept = 32;     // of the route before, that the mover is bound for already
inline constexpr double kNear = 0.05;            // mm that a mover may be off its route

// Visits of one mover, numbered through over all its routes.
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
  // False: there is no room.
  bool Add(const Visit& visit) noexcept {
    if (count_ == kMostVisits) return false;
    items_[kMostKept + count_++] = visit;
    return true;
  }
  // The first one, or up to kMostKept before it.
  void Put(std::uint64_t number, const Visit& visit) noexcept { items_[Place(number)] = visit; }

 private:
  std::size_t Place(std::uint64_t number) const noexcept {
    return kMostKept + static_cast<std::size_t>(number - first_);  // unsigned: right below `first_`, too
  }

  std::vector<Visit> items_;
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
};

// Of the motions; unset: the mover's standard.
struct RouteDynamics {
  std::optional<double> velocity{};      // mm/s
  std::optional<double> acceleration{};  // mm/s²
  std::optional<double> deceleration{};  // mm/s²
  std::optional<double> jerk{};          // mm/s³
};

// Numbers are those of visits.
struct SurfaceRoute {
  Visits visits;
  RouteDynamics dynamics{};
  std::uint64_t started = 0;      // cycle
  std::uint64_t begin = 0;        // the first visit that is known
  std::uint64_t passed = 0;       // the last place whose middle it has reached
  std::uint64_t granted = 0;      // the last place that is its turn
  std::uint64_t sent = 0;         // the last place that it was told
  bool aims = false;              // its motion ends at ...
  double aim_x = 0, aim_y = 0;    // mm
  std::uint32_t system = 0;       // coordinate system of the places
  std::uint32_t pause = 0;        // cycles until it is tried again
  std::uint64_t rests_since = 0;  // cycle since which it rests before a place of another one; 0: it does not

  bool held = false;          // no place is granted
  std::uint64_t held_at = 0;  // for a look at all: where it comes to rest

  bool timed = false;            // there are times
  std::uint64_t leg = 0;         // where its present planned motion begins, or at rest the next one
  bool leaves = false;           // that motion has begun; ...
  double late = 0;               // s, by which it began late; infinite: not known
  std::uint64_t look_again = 0;  // cycle in which it is asked anew when that may begin

  Visits draft;             // told, and not started
  Ticket draft_ticket = 0;  // of the command that told it; 0: none
  bool takes = false;       // for a look at all: it begins now

  std::uint64_t last() const noexcept { return visits.empty() ? passed : visits.last(); }
};

// Along X or Y.
struct Heading {
  double x = 0, y = 0;
  bool operator==(const Heading&) const = default;
};

// mm between places of which one lies along X or Y of the other.
inline double Distance(const Visit& a, const Visit& b) noexcept {
  return std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
}

inline Heading HeadingOf(const Visit& a, const Visit& b) noexcept {
  const double x = b.x - a.x, y = b.y - a.y;
  if (std::abs(x) > std::abs(y)) return {x > 0 ? 1.0 : -1.0, 0};
  return {0, y > 0 ? 1.0 : -1.0};
}

// From this visit to the next one.
inline Heading HeadingAt(const SurfaceRoute& r, std::uint64_t visit) noexcept {
  return HeadingOf(r.visits[visit], r.visits[visit + 1]);
}
inline double PitchAt(const SurfaceRoute& r, std::uint64_t visit) noexcept {
  return Distance(r.visits[visit], r.visits[visit + 1]);
}

// Of all movers, by number.
struct SurfaceRoutes {
  explicit SurfaceRoutes(std::size_t movers) : of(movers) {}

  std::vector<SurfaceRoute> of;
  std::uint64_t changes = 0;  // so many commands have changed any
};

// Why routes were refused: the value of a feedback with ErrorId::kRoute.
enum class RouteProblem : std::uint8_t {
  kNone,
  kTooMany,    // more than kMostVisits
  kNotNext,    // `first` of what continues is not the number behind the last one
  kNotBeside,  // a place is not beside the one before, along X or Y
  kTimes,      // a motion as planned without both times, or not straight
  kNoMover,    // there is no mover `after`
  kNoVisit,    // that mover has no visit `after_visit`
  kNumber,     // `first` is not the number of the visit where it is
  kElsewhere,  // the mover, at rest, is not in the place
  kTooLate,    // it is bound for places further on, and cannot come to rest before
  kBehind,     // it is bound for a place that a mover is to visit before, and that one does not get so far
  kMissing,    // it is behind one that changes over, and has no new route
  kNoneTold,   // no mover was told a route
  kMoves,      // it has to rest for this
  kNoRoute,    // it has no route that it could go on along
};
std::string_view MessageOf(RouteProblem problem) noexcept;

void describe(Description<RouteDynamics>&);
void describe(Description<SurfaceRoute>&);

}  // namespace takt::mover
