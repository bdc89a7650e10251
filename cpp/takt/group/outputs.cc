#include "takt/group/outputs.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.about(
      "What a group of axes publishes. Places are those of the tool centre point in the machine coordinate system.");
  d.internal<&O::state>("State of the group.");
  d.internal<&O::error>("Why it is in GroupErrorStop.");
  d.internal<&O::x>(unit::mm, "X as commanded; nan without kinematics, as all that follows.");
  d.internal<&O::y>(unit::mm, "Y as commanded.");
  d.internal<&O::z>(unit::mm, "Z as commanded.");
  d.internal<&O::a>(unit::deg, "A as commanded: about X.");
  d.internal<&O::b>(unit::deg, "B as commanded: about Y.");
  d.internal<&O::c>(unit::deg, "C as commanded: about Z.");
  d.internal<&O::actual_x>(unit::mm, "X as measured.");
  d.internal<&O::actual_y>(unit::mm, "Y as measured.");
  d.internal<&O::actual_z>(unit::mm, "Z as measured.");
  d.internal<&O::actual_a>(unit::deg, "A as measured.");
  d.internal<&O::actual_b>(unit::deg, "B as measured.");
  d.internal<&O::actual_c>(unit::deg, "C as measured.");
  d.internal<&O::velocity>(unit::mm_s, "Speed of the commanded place.");
  d.internal<&O::acceleration>(unit::mm_s2, "Its acceleration: the length of the vector.");
  d.internal<&O::actual_velocity>(unit::mm_s, "Speed as measured.");
  d.internal<&O::path_position>(unit::mm, "Way along the path since the group began to move from rest.");
  d.internal<&O::path_velocity>(unit::mm_s, "Speed along the path.");
  d.internal<&O::path_acceleration>(unit::mm_s2, "Acceleration along the path.");
  d.internal<&O::path_left>(unit::mm, "How much of the path is left, as far as it is known.");
  d.internal<&O::time_left>(unit::s, "Until it stands at the end of what was commanded; NaN: not known.");
  d.internal<&O::path_error>(unit::mm, "From the place commanded for this cycle to the measured one.");
  d.internal<&O::override_factor>(unit::one, "Velocity factor of the override.");
  d.internal<&O::command>("Ticket of the move in control; 0: none.");
  d.internal<&O::buffered>("Moves that wait behind it.");
  d.internal<&O::axes>("Members.");
  d.internal<&O::member1>("Number of the axis in place 1, from 1; 0: none.");
  d.internal<&O::member2>("In place 2.");
  d.internal<&O::member3>("In place 3.");
  d.internal<&O::member4>("In place 4.");
  d.internal<&O::member5>("In place 5.");
  d.internal<&O::member6>("In place 6.");
  d.internal<&O::member7>("In place 7.");
  d.internal<&O::member8>("In place 8.");
  d.internal<&O::pcs1>("Product coordinate system 1 as it is now, seen from that of the machine.");
  d.internal<&O::pcs2>("The same of 2.");
  d.internal<&O::pcs3>("The same of 3.");
  d.internal<&O::pcs4>("The same of 4.");
  d.internal<&O::pcs5>("The same of 5.");
  d.internal<&O::pcs6>("The same of 6.");
  d.internal<&O::pcs7>("The same of 7.");
  d.internal<&O::pcs8>("The same of 8.");
  d.internal<&O::pcs9>("The same of 9.");
  d.internal<&O::pcs10>("The same of 10.");
  d.internal<&O::pcs11>("The same of 11.");
  d.internal<&O::pcs12>("The same of 12.");
  d.internal<&O::pcs13>("The same of 13.");
  d.internal<&O::pcs14>("The same of 14.");
  d.internal<&O::pcs15>("The same of 15.");
  d.internal<&O::pcs16>("The same of 16.");
  d.internal<&O::track_state>("How the tool goes along with an object.");
  d.internal<&O::in_sync>("It is in step with it.");
  d.internal<&O::track_lag>(
      unit::mm,
      "Of the carrier's travel (tables: rad), from the tool to the object; NaN without one, as what follows.");
  d.internal<&O::object_x>(unit::mm, "X of the commanded tool, seen from the object.");
  d.internal<&O::object_y>(unit::mm, "Y of it.");
  d.internal<&O::object_z>(unit::mm, "Z of it.");
  d.internal<&O::object_a>(unit::deg, "A of it: about X.");
  d.internal<&O::object_b>(unit::deg, "B of it: about Y.");
  d.internal<&O::object_c>(unit::deg, "C of it: about Z.");
  d.internal<&O::kinematics_on>("There are kinematics, and they are switched on.");
  d.internal<&O::in_position>("It stands and has nothing to do.");
  d.internal<&O::interrupted>("It rests on the path until it is continued.");
  d.internal<&O::synchronized>("A path that follows a master is in step with it.");
  d.internal<&O::reason>("Why no position of the axes was found, where the last move was refused or ended for that.");
  d.internal<&O::problem>("Why there is no such path, where the last move was refused for that.");
  d.internal<&O::blocked_at>(unit::mm, "Where on that move, from its beginning.");
  d.internal<&O::blocked_element>("On which element, from 1, where it is a path of the machine file; 0: it is none.");
  d.internal<&O::trouble>("Why the path is not free, where the last move was refused for that.");
  d.internal<&O::first_part>("What comes too near there: its number among the group's parts, from 1; 0: nothing.");
  d.internal<&O::second_part>("To what; 0: to nothing.");
  d.internal<&O::on_blend>("That is on the blend into the move, or into that element of a path.");
  d.internal<&O::checking>("It waits until the next path has been checked.");
  d.internal<&O::zones>("Zones that it has, a mask: bit 0 is the first of the machine file.");
  d.internal<&O::waits_for>("Number of the group that it waits for at a zone, from 1; 0: it does not wait.");
  d.internal<&O::waits_zone>("Number of that zone, from 1; 0: none.");
  d.internal<&O::tool>("Where the tool centre point is on the flange.");
}

}  // namespace takt::group
