// Movers on a network of tracks, cycle by cycle, and measurements of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "takt/planar/clearance.h"
#include "takt/planar/send.h"
#include "takt/planar/traffic.h"
#include "tracks.h"

namespace takt::planar::testing {

inline constexpr double kPeriod = 0.001;  // [s]

inline Pace PaceOf(double velocity, double acceleration, double jerk, double lateral = 5000) {
  return {{velocity, acceleration, acceleration, jerk}, lateral};
}

// Returns a pace whose vectors of acceleration and jerk are bounded by its maximum dynamics.
inline Pace InPlane(Pace pace) {
  pace.vector_acceleration = std::max(pace.limits.acceleration, pace.limits.deceleration);
  pace.vector_jerk = pace.limits.jerk;
  return pace;
}

// A track from the origin along X.
inline Layout Straight(double length) {
  return {{Line({0, 0}, {length, 0})}};
}

class TrackNetworkState {
 public:
  // Tracks by their layouts; ends are linked to the starts at the same point.
  explicit TrackNetworkState(const std::vector<Layout>& layouts, std::uint32_t movers, double size = 100);

  Network& network() { return network_; }
  std::vector<Rider>& riders() { return riders_; }
  Rider& operator[](std::size_t i) { return riders_[i]; }
  const Track& track(std::size_t i) const { return *tracks_[i]; }

  // Puts a mover at rest on a track.
  Rider& Put(std::uint32_t mover, std::uint32_t track, double s, const Pace& pace, double gap = 120);
  // Sends a mover to a position on a track. Returns false if there is no route.
  bool Send(std::uint32_t mover, std::uint32_t track, double s);
  bool Send(std::uint32_t mover, const Destination& to);
  void Halt(std::uint32_t mover) {
    riders_[mover].aim = Aim::kRest;
    riders_[mover].softly = false;
  }
  void HaltSoftly(std::uint32_t mover, double deceleration, double jerk) {
    Halt(mover);
    riders_[mover].softly = true;
    riders_[mover].pace.limits.deceleration = deceleration;
    riders_[mover].pace.limits.jerk = jerk;
  }

  void Step();
  // Returns a mover that is too near to this one.
  std::uint32_t TooNear(std::uint32_t mover) { return traffic_.TooNear(cycle_, network_, riders_, mover); }
  // Steps until all movers with a target have reached it, at most for `seconds`. Returns true if they have.
  bool Run(double seconds);
  double now() const { return static_cast<double>(cycle_.count) * kPeriod; }
  Traffic& traffic() { return traffic_; }

  TrackPoint PointOf(std::uint32_t mover) const;
  // Returns how much the nearest pair of movers on one track, or one route, falls short of its gap, or of `gap`, along
  // the tracks.
  double Missing() const {
    return MissingOf([](const Rider& r) { return r.gap; });
  }
  double Missing(double gap) const {
    return MissingOf([gap](const Rider&) { return gap; });
  }
  // Returns the least distance [mm] between the bodies of two movers, at any angles.
  double Nearest() const;

  // Called after each step.
  std::function<void()> watch;

 private:
  double MissingOf(const std::function<double(const Rider&)>& gap) const;

  std::vector<std::unique_ptr<Track>> tracks_;
  Network network_;
  std::vector<Rider> riders_;
  Traffic traffic_;
  RouteSearch search_;
  trajectory::Planner planner_;
  Cycle cycle_{0, kPeriod};
  double reach_;  // [mm] distance at which the centres of two movers may touch
};

// Returns tracks between random crossings, with merges, branches and rings; bodies of this size can only meet where
// tracks do.
std::vector<Layout> RandomCity(Random& random, int tracks, double size);

// Checks the limits of every mover in each cycle: speed, acceleration and jerk along the route, lateral acceleration,
// and the lengths of the vectors of acceleration and jerk, where they are bounded.
class Watcher {
 public:
  explicit Watcher(TrackNetworkState& streets) : streets_(streets) {}
  void Look();

  double speed = 0;         // largest share of the limit
  double acceleration = 0;  // of the maximum brakes while it slows down
  double jerk = 0;
  double lateral = 0;
  double vector_acceleration = 0;
  double vector_jerk = 0;

 private:
  TrackNetworkState& streets_;
  std::vector<KinematicState> before_;
  std::vector<double> ways_, most_;
  std::vector<Place> pushes_;  // [mm/s²] acceleration in the plane
};

}  // namespace takt::planar::testing
