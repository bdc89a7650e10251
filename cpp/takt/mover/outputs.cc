#include "takt/mover/outputs.h"

#include "takt/core/describe.h"

namespace takt::mover {

void describe(Enumeration<Delay>& e) {
  e.about("Why a mover that has a command does not go on.");
  e.value(Delay::kNone, "none", "It goes on, or has nothing to do.");
  e.value(Delay::kMover, "mover", "Another one is in its way: waits_for.");
  e.value(Delay::kTrackEnd, "track_end", "Its way ends here.");
  e.value(Delay::kTime, "time", "It is told to wait for some time.");
  e.value(Delay::kRelease, "release", "It is told to wait for a release, or its route is being held.");
  e.value(Delay::kMaster, "master",
          "It waits for its master, an axis or a mover, to come where it may go, or to go on: blocker.");
  e.value(Delay::kPart, "part", "It waits for a part that is on its way, or not enabled: blocker.");
  e.value(Delay::kDeadlock, "deadlock", "The movers ahead of it wait for one another: waits_for.");
  e.value(Delay::kTrack, "track", "A track that is Moving is in its way: blocker.");
  e.value(Delay::kFormation, "formation",
          "What is buffered waits until the mover has left its formation: blocker is the star.");
  e.value(Delay::kPlace, "place", "Another mover visits the next place of its route before: blocker.");
}

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("MoverOutputs");
  d.about("State of a planar mover after a cycle.");
  d.internal<&O::state>("What it can do.");
  d.internal<&O::command_mode>("What kind of command it carries out.");
  d.internal<&O::error>("Of the last fault; 0 without one.");
  d.internal<&O::limited_by>("What of the dynamics of the last command was more than the mover can do, and reduced.");
  d.internal<&O::x>(unit::mm, "Set position of X at the end of the cycle.");
  d.internal<&O::y>(unit::mm, "Of Y.");
  d.internal<&O::z>(unit::mm, "Of Z.");
  d.internal<&O::a>(unit::deg, "Of A.");
  d.internal<&O::b>(unit::deg, "Of B.");
  d.internal<&O::c>(unit::deg, "Of C, over all turns.");
  d.internal<&O::velocity_x>(unit::mm_s, "Set velocity of X.");
  d.internal<&O::velocity_y>(unit::mm_s, "Of Y.");
  d.internal<&O::velocity_z>(unit::mm_s, "Of Z.");
  d.internal<&O::velocity_a>(unit::deg_s, "Of A.");
  d.internal<&O::velocity_b>(unit::deg_s, "Of B.");
  d.internal<&O::velocity_c>(unit::deg_s, "Of C.");
  d.internal<&O::acceleration_x>(unit::mm_s2, "Set acceleration of X.");
  d.internal<&O::acceleration_y>(unit::mm_s2, "Of Y.");
  d.internal<&O::acceleration_z>(unit::mm_s2, "Of Z.");
  d.internal<&O::acceleration_a>(unit::deg_s2, "Of A.");
  d.internal<&O::acceleration_b>(unit::deg_s2, "Of B.");
  d.internal<&O::acceleration_c>(unit::deg_s2, "Of C.");
  d.internal<&O::actual_x>(unit::mm, "Actual position of X, as it was when the cycle began.");
  d.internal<&O::actual_y>(unit::mm, "Of Y.");
  d.internal<&O::actual_z>(unit::mm, "Of Z.");
  d.internal<&O::actual_a>(unit::deg, "Of A.");
  d.internal<&O::actual_b>(unit::deg, "Of B.");
  d.internal<&O::actual_c>(unit::deg, "Of C.");
  d.internal<&O::busy_xyc>("X and Y move, or C with them.");
  d.internal<&O::busy_z>("Z moves.");
  d.internal<&O::busy_a>("A moves.");
  d.internal<&O::busy_b>("B moves.");
  d.internal<&O::busy_c>("C moves.");
  d.internal<&O::external>("How set points from outside move it.");
  d.internal<&O::track>("Number of the track that it joins, is on, or leaves, from 1; 0: none.");
  d.internal<&O::track_position>(unit::mm, "Along the track that it is on.");
  d.internal<&O::track_velocity>(unit::mm_s, "Along it.");
  d.internal<&O::track_acceleration>(unit::mm_s2, "Along it.");
  d.internal<&O::gap>(unit::mm, "Gap that it keeps to the mover before it on a track.");
  d.internal<&O::target_x>(unit::mm, "Where its command leads X; on a track, or moved from outside: where it is.");
  d.internal<&O::target_y>(unit::mm, "The same of Y.");
  d.internal<&O::target_c>(unit::deg, "Where its command leads C.");
  d.internal<&O::target_track>("Number of the track that its command leads it to, from 1; 0: none.");
  d.internal<&O::target_position>(unit::mm, "Along that track.");
  d.internal<&O::reserved_lower_x>(
      unit::mm,
      "Left side of the rectangle that what it has reserved in its group lies in; 0 where that does not watch.");
  d.internal<&O::reserved_lower_y>(unit::mm, "Its lower side.");
  d.internal<&O::reserved_upper_x>(unit::mm, "Its right side.");
  d.internal<&O::reserved_upper_y>(unit::mm, "Its upper side.");
  d.internal<&O::in_sync>("It goes along with a master and is in step, or with the star of its formation.");
  d.internal<&O::sync_error>(unit::mm, "Of one that goes along with a master: its place minus where it should be.");
  d.internal<&O::waits_for>("Number of the mover that is in its way and that it waits for, from 1; 0: none.");
  d.internal<&O::deadlocked>("The mover that it waits for waits for it, be it over others.");
  d.internal<&O::delay>("Why it does not go on.");
  d.internal<&O::delay_since>("Cycle since which it does not; 0: it goes on.");
  d.internal<&O::blocker_kind>("Of what kind the component is that it waits for.");
  d.internal<&O::blocker>("Number of that, from 1, in the order of the machine file; 0: none.");
  d.internal<&O::buffered>("So many commands wait for their turn.");
  d.internal<&O::group>("Number of the group of movers that it is in, from 1; 0: none.");
  d.internal<&O::coordinate_system>("Number of the coordinate system that its positions are in, from 1; 0: none.");
  d.internal<&O::part>("Number of the part that its middle is on, from 1; 0: none.");
  d.internal<&O::formation>(
      "Number of the star of the formation that it is in, itself or another mover, from 1; 0: none.");
  d.internal<&O::commands>("So many commands have come, external set points apart.");
  d.internal<&O::on_route>("It is on its way along a route over the free surface.");
  d.internal<&O::route_granted>("Number of the last visit of its route that is its turn.");
  d.internal<&O::route_visit>("Number of the last visit of its routes whose place it has reached.");
}

}  // namespace takt::mover
