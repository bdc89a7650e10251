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
  e.about("What a mover on a track is about.");
  e.value(Aim::kRest, "rest", "Come to rest and stay.");
  e.value(Aim::kTarget, "target", "Go to a place on its route.");
  e.value(Aim::kFollow, "follow", "Go along with a master.");
}

void describe(Enumeration<Waits>& e) {
  e.about("Why a mover does not go on.");
  e.value(Waits::kNot, "not", "It does, or has nothing to do.");
  e.value(Waits::kMover, "mover", "Another mover is in its way.");
  e.value(Waits::kRoute, "route", "Its route ends here.");
  e.value(Waits::kMaster, "master", "Its master, an axis, is where it may not go.");
}

void describe(Description<Brakes>& d) {
  d.about("How hard a mover brakes.");
  d.internal<&Brakes::deceleration>(unit::mm_s2, "Deceleration.");
  d.internal<&Brakes::jerk>(unit::mm_s3, "Jerk.");
}

void describe(Description<Pace>& d) {
  d.about("How fast a mover may go.");
  d.internal<&Pace::limits>("Along the way.");
  d.internal<&Pace::lateral>(unit::mm_s2, "Across it, in curves.");
  d.internal<&Pace::vector_acceleration>(unit::mm_s2, "Largest length of the acceleration in the plane.");
  d.internal<&Pace::vector_jerk>(unit::mm_s3, "Largest length of the jerk in the plane.");
}

void describe(Description<Rider>& d) {
  using R = Rider;
  d.about("A mover on a track.");
  d.internal<&R::on>("It is on a track.");
  d.internal<&R::at>("On the first track of the route.");
  d.internal<&R::route>("The tracks it goes along.");
  d.internal<&R::passed>("Those it has come from, the last one first.");
  d.internal<&R::passed_count>("So many.");
  d.internal<&R::direction>("Of its way.");
  d.internal<&R::aim>("What it is about.");
  d.internal<&R::softly>("It comes to rest as its pace says.");
  d.internal<&R::target>(unit::mm, "On the last track of the route.");
  d.internal<&R::gear>("Whom it goes along with, and how.");
  d.internal<&R::demand>("Where that one is, over all tracks.");
  d.internal<&R::pace>("As commanded.");
  d.internal<&R::brakes>("Its greatest.");
  d.internal<&R::share>("Number of the share of its dynamics that it brakes with, by the bends on its way to rest.");
  d.internal<&R::top_speed>(unit::mm_s, "Its greatest.");
  d.internal<&R::gap>(unit::mm, "To the mover before it.");
  d.internal<&R::zone>(unit::mm, "So near to a node it is active there, at the least.");
  d.internal<&R::off>(unit::mm, "So far from its place it may be.");
  d.internal<&R::planned>("It has a plan.");
  d.internal<&R::plan>("Along the way.");
  d.internal<&R::plan_from>(unit::mm, "Where that began.");
  d.internal<&R::plan_time>(unit::s, "Since that began.");
  d.internal<&R::plan_ends>("It goes all the way to the target.");
  d.internal<&R::there>("It rests at its target.");
  d.internal<&R::calm_cycles>("So long it does not speed up more, having had to brake.");
  d.internal<&R::eased>(unit::mm_s2, "What following asks for, without the shaking of those before it.");
  d.internal<&R::origin>(unit::mm, "Of all tracks it has left behind.");
  d.internal<&R::held_by>("The mover that is across its way.");
  d.internal<&R::waits>("Why it does not go on.");
  d.internal<&R::waits_for>("The mover that is in its way.");
  d.internal<&R::waits_since>("Cycle since when.");
}

}  // namespace takt::planar
