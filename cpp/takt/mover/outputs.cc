#include "takt/mover/outputs.h"

#include "takt/core/describe.h"

namespace takt::mover {

void describe(Enumeration<Delay>& e) {
  e.about("Why a mover with a command does not move on.");
  e.value(Delay::kNone, "none", "It moves on, or has no command.");
  e.value(Delay::kMover, "mover", "Another mover is in its way: waits_for.");
  e.value(Delay::kTrackEnd, "track_end", "Its route ends here.");
  e.value(Delay::kTime, "time", "It waits for a time.");
  e.value(Delay::kRelease, "release", "It waits for a release, or its route is held.");
  e.value(Delay::kMaster, "master",
          "Its master, an axis or a mover, is where the mover may not go, or is delayed itself: blocker.");
  e.value(Delay::kPart, "part", "It waits for a part that is moving or not enabled: blocker.");
  e.value(Delay::kDeadlock, "deadlock", "The movers ahead of it wait for one another: waits_for.");
  e.value(Delay::kTrack, "track", "A track that is Moving is in its way: blocker.");
  e.value(Delay::kFormation, "formation",
          "Buffered commands wait until the mover has left its formation; blocker is the star.");
  e.value(Delay::kPlace, "place", "Another mover visits the next place of its route first: blocker.");
}

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("MoverOutputs");
  d.about("State of a planar mover after a cycle.");
  d.internal<&O::state>("State of the mover.");
  d.internal<&O::command_mode>("Kind of command that it executes.");
  d.internal<&O::error>("Error of the last fault; 0: none.");
  d.internal<&O::limited_by>(
      "First value of the dynamics of the last command that was reduced to the mover's maximum.");
  d.internal<&O::x>(unit::mm, "Set position of X at the end of the cycle.");
  d.internal<&O::y>(unit::mm, "Set position of Y.");
  d.internal<&O::z>(unit::mm, "Set position of Z.");
  d.internal<&O::a>(unit::deg, "Set position of A.");
  d.internal<&O::b>(unit::deg, "Set position of B.");
  d.internal<&O::c>(unit::deg, "Set position of C, over all turns.");
  d.internal<&O::velocity_x>(unit::mm_s, "Set velocity of X.");
  d.internal<&O::velocity_y>(unit::mm_s, "Set velocity of Y.");
  d.internal<&O::velocity_z>(unit::mm_s, "Set velocity of Z.");
  d.internal<&O::velocity_a>(unit::deg_s, "Set velocity of A.");
  d.internal<&O::velocity_b>(unit::deg_s, "Set velocity of B.");
  d.internal<&O::velocity_c>(unit::deg_s, "Set velocity of C.");
  d.internal<&O::acceleration_x>(unit::mm_s2, "Set acceleration of X.");
  d.internal<&O::acceleration_y>(unit::mm_s2, "Set acceleration of Y.");
  d.internal<&O::acceleration_z>(unit::mm_s2, "Set acceleration of Z.");
  d.internal<&O::acceleration_a>(unit::deg_s2, "Set acceleration of A.");
  d.internal<&O::acceleration_b>(unit::deg_s2, "Set acceleration of B.");
  d.internal<&O::acceleration_c>(unit::deg_s2, "Set acceleration of C.");
  d.internal<&O::actual_x>(unit::mm, "Actual position of X at the beginning of the cycle.");
  d.internal<&O::actual_y>(unit::mm, "Actual position of Y.");
  d.internal<&O::actual_z>(unit::mm, "Actual position of Z.");
  d.internal<&O::actual_a>(unit::deg, "Actual position of A.");
  d.internal<&O::actual_b>(unit::deg, "Actual position of B.");
  d.internal<&O::actual_c>(unit::deg, "Actual position of C.");
  d.internal<&O::busy_xyc>("True: X or Y moves, or the C that belongs to their move.");
  d.internal<&O::busy_z>("True: Z moves.");
  d.internal<&O::busy_a>("True: A moves.");
  d.internal<&O::busy_b>("True: B moves.");
  d.internal<&O::busy_c>("True: C moves.");
  d.internal<&O::external>("Effect of external set points.");
  d.internal<&O::track>("Number of the track that it joins, is on, or leaves, from 1; 0: none.");
  d.internal<&O::track_position>(unit::mm, "Position along its track.");
  d.internal<&O::track_velocity>(unit::mm_s, "Velocity along its track.");
  d.internal<&O::track_acceleration>(unit::mm_s2, "Acceleration along its track.");
  d.internal<&O::gap>(unit::mm, "Gap that it keeps to the mover ahead on a track.");
  d.internal<&O::target_x>(unit::mm,
                           "X of the target of its command; on a track or with external set points, the set position.");
  d.internal<&O::target_y>(unit::mm,
                           "Y of the target of its command; on a track or with external set points, the set position.");
  d.internal<&O::target_c>(unit::deg, "C of the target of its command.");
  d.internal<&O::target_track>("Number of the track of the target of its command, from 1; 0: none.");
  d.internal<&O::target_position>(unit::mm, "Position of the target along that track.");
  d.internal<&O::reserved_lower_x>(unit::mm,
                                   "Least X of the bounding rectangle of the area that it has reserved in its group; 0 "
                                   "unless the group is enabled.");
  d.internal<&O::reserved_lower_y>(unit::mm, "Least Y of that rectangle.");
  d.internal<&O::reserved_upper_x>(unit::mm, "Largest X of that rectangle.");
  d.internal<&O::reserved_upper_y>(unit::mm, "Largest Y of that rectangle.");
  d.internal<&O::in_sync>("True: it is in sync with its master, or follows the star of its formation.");
  d.internal<&O::sync_error>(unit::mm, "Position minus the one that its master demands; 0 without a master.");
  d.internal<&O::waits_for>("Number of the mover in its way, for which it waits, from 1; 0: none.");
  d.internal<&O::deadlocked>("True: the mover that it waits for waits for it, directly or over other movers.");
  d.internal<&O::delay>("Why it does not move on.");
  d.internal<&O::delay_since>("Cycle since which it does not move on; 0: no delay.");
  d.internal<&O::blocker_kind>("Kind of the component that it waits for.");
  d.internal<&O::blocker>(
      "Number of the component that it waits for, from 1, in the order of the machine file; 0: none.");
  d.internal<&O::buffered>("Number of buffered commands.");
  d.internal<&O::group>("Number of the group of movers that it is in, from 1; 0: none.");
  d.internal<&O::coordinate_system>("Number of the coordinate system of its positions, from 1; 0: none.");
  d.internal<&O::part>("Number of the part that its centre is on, from 1; 0: none.");
  d.internal<&O::formation>("Number of the star of its formation, the mover itself or another one, from 1; 0: none.");
  d.internal<&O::commands>("Number of commands received, without external set points.");
  d.internal<&O::on_route>("True: it is on a route over the free surface.");
  d.internal<&O::route_granted>("Number of the last visit of its route that is granted.");
  d.internal<&O::route_visit>("Number of the last visit of its routes whose place it has reached.");
}

}  // namespace takt::mover
