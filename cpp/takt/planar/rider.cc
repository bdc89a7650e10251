#include "takt/planar/rider.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::planar {

trajectory::Limits LimitsNow(const Rider& r) noexcept {
  trajectory::Limits limits = r.pace.limits;
  const double speed = r.at.velocity + r.at.acceleration * std::abs(r.at.acceleration) / (2 * limits.jerk);
  const bool too_fast = std::abs(speed) > std::max(limits.velocity, std::abs(r.at.velocity)) * (1 + 1e-9);
  // Only a mover that follows a master reverses without a stop, with at most its limit of acceleration.
  const bool turns = speed * r.at.velocity < 0 && std::abs(speed) > 1e-6;
  const bool may_turn = r.aim == Aim::kFollow && std::abs(r.at.acceleration) <= limits.acceleration;
  if (too_fast || (turns && !may_turn)) limits.jerk = std::max(limits.jerk, r.brakes.jerk);
  return limits;
}

Route RemainingTracks(const Rider& r) noexcept {
  Route trail;
  if (!r.on) return trail;
  const bool stays = Rests(r.at) && (r.aim == Aim::kRest || r.there);
  trail.count = stays ? 1 : r.route.count;
  std::copy_n(r.route.tracks.begin(), trail.count, trail.tracks.begin());
  return trail;
}

void describe(Enumeration<Aim>& e) {
  e.about("Task of a mover on a track.");
  e.value(Aim::kRest, "rest", "To come to rest and stay.");
  e.value(Aim::kTarget, "target", "To move to a position on its route.");
  e.value(Aim::kFollow, "follow", "To follow a master.");
}

void describe(Enumeration<Waits>& e) {
  e.about("Why a mover on a track does not move on.");
  e.value(Waits::kNot, "not", "It moves on, or has no task.");
  e.value(Waits::kMover, "mover", "Another mover is in its way.");
  e.value(Waits::kRoute, "route", "Its route ends here.");
  e.value(Waits::kMaster, "master", "Its master, an axis, is at a position that the mover may not take.");
}

void describe(Description<Brakes>& d) {
  d.about("Limits of braking.");
  d.internal<&Brakes::deceleration>(unit::mm_s2, "Deceleration.");
  d.internal<&Brakes::jerk>(unit::mm_s3, "Jerk.");
}

void describe(Description<Pace>& d) {
  d.about("Limits of the motion of a mover along tracks.");
  d.internal<&Pace::limits>("Limits along the route.");
  d.internal<&Pace::lateral>(unit::mm_s2, "Largest lateral acceleration in curves.");
  d.internal<&Pace::vector_acceleration>(unit::mm_s2, "Largest length of the acceleration in the plane.");
  d.internal<&Pace::vector_jerk>(unit::mm_s3, "Largest length of the jerk in the plane.");
}

void describe(Description<Rider>& d) {
  using R = Rider;
  d.about("State of a mover on a track.");
  d.internal<&R::on>("True: it is on a track.");
  d.internal<&R::at>("Position on the first track of the route, and its derivatives.");
  d.internal<&R::route>("Tracks of the route, the present one first.");
  d.internal<&R::passed>("Tracks before the present one, the latest first.");
  d.internal<&R::passed_count>("Number of these tracks.");
  d.internal<&R::direction>("Direction of its motion.");
  d.internal<&R::aim>("Task of the mover.");
  d.internal<&R::softly>("True: it comes to rest with the commanded limits.");
  d.internal<&R::target>(unit::mm, "Target position on the last track of the route.");
  d.internal<&R::gear>("Coupling to its master.");
  d.internal<&R::demand>("State of the master, over all tracks.");
  d.internal<&R::pace>("Commanded limits.");
  d.internal<&R::brakes>("Maximum dynamics of braking.");
  d.internal<&R::share>("Index of the share of its dynamics for braking in the bends ahead.");
  d.internal<&R::top_speed>(unit::mm_s, "Maximum speed.");
  d.internal<&R::gap>(unit::mm, "Gap to the mover ahead, from centre to centre.");
  d.internal<&R::zone>(unit::mm, "Least distance from nodes within which it is active there.");
  d.internal<&R::off>(unit::mm, "Largest displacement from its position on the track.");
  d.internal<&R::planned>("True: it has a plan.");
  d.internal<&R::plan>("Planned motion along the route.");
  d.internal<&R::plan_from>(unit::mm, "Start of the plan on the first track.");
  d.internal<&R::plan_time>(unit::s, "Time since the start of the plan.");
  d.internal<&R::plan_ends>("True: the plan reaches the target.");
  d.internal<&R::there>("True: it is at rest at its target.");
  d.internal<&R::calm_cycles>("Cycles left in which its acceleration does not grow, after it had to brake.");
  d.internal<&R::eased>(unit::mm_s2, "Smoothed acceleration that following asks for.");
  d.internal<&R::origin>(unit::mm, "Length of all tracks left behind.");
  d.internal<&R::held_by>("Mover across its path, for which it brakes.");
  d.internal<&R::waits>("Why it does not move on.");
  d.internal<&R::waits_for>("Mover in its way.");
  d.internal<&R::waits_since>("Cycle since which it does not move on.");
}

}  // namespace takt::planar
