#include "takt/group/outputs.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.about("Outputs of a group of axes. Poses are those of the tool centre point in the machine coordinate system.");
  d.internal<&O::state>("State of the group.");
  d.internal<&O::error>("Reason for GroupErrorStop.");
  d.internal<&O::x>(unit::mm, "Commanded X; nan without kinematics, as for all poses and speeds of the tool.");
  d.internal<&O::y>(unit::mm, "Commanded Y.");
  d.internal<&O::z>(unit::mm, "Commanded Z.");
  d.internal<&O::a>(unit::deg, "Commanded A: about X.");
  d.internal<&O::b>(unit::deg, "Commanded B: about Y.");
  d.internal<&O::c>(unit::deg, "Commanded C: about Z.");
  d.internal<&O::actual_x>(unit::mm, "Actual X.");
  d.internal<&O::actual_y>(unit::mm, "Actual Y.");
  d.internal<&O::actual_z>(unit::mm, "Actual Z.");
  d.internal<&O::actual_a>(unit::deg, "Actual A.");
  d.internal<&O::actual_b>(unit::deg, "Actual B.");
  d.internal<&O::actual_c>(unit::deg, "Actual C.");
  d.internal<&O::velocity>(unit::mm_s, "Commanded speed of the tool centre point.");
  d.internal<&O::acceleration>(unit::mm_s2, "Magnitude of its commanded acceleration.");
  d.internal<&O::actual_velocity>(unit::mm_s, "Actual speed of the tool centre point.");
  d.internal<&O::path_position>(unit::mm, "Arc length along the path since the group began to move from rest.");
  d.internal<&O::path_velocity>(unit::mm_s, "Speed along the path.");
  d.internal<&O::path_acceleration>(unit::mm_s2, "Acceleration along the path.");
  d.internal<&O::path_left>(unit::mm, "Remaining length of the path as far as it is planned.");
  d.internal<&O::time_left>(unit::s,
                            "Time until the group is at rest at the end of all commanded moves; NaN: not known.");
  d.internal<&O::path_error>(
      unit::mm, "Distance from the position commanded for this cycle to the actual one; 0 while a member is off.");
  d.internal<&O::override_factor>(unit::one, "Velocity factor of the override.");
  d.internal<&O::command>("Ticket of the move in execution; 0: none.");
  d.internal<&O::buffered>("Number of moves waiting behind it.");
  d.internal<&O::axes>("Number of members.");
  d.internal<&O::member1>("Number of the axis at index 1 of the group, from 1; 0: none.");
  d.internal<&O::member2>("Number of the axis at index 2 of the group.");
  d.internal<&O::member3>("Number of the axis at index 3 of the group.");
  d.internal<&O::member4>("Number of the axis at index 4 of the group.");
  d.internal<&O::member5>("Number of the axis at index 5 of the group.");
  d.internal<&O::member6>("Number of the axis at index 6 of the group.");
  d.internal<&O::member7>("Number of the axis at index 7 of the group.");
  d.internal<&O::member8>("Number of the axis at index 8 of the group.");
  d.internal<&O::pcs1>("Present pose of product coordinate system 1 in the machine coordinate system.");
  d.internal<&O::pcs2>("Present pose of product coordinate system 2.");
  d.internal<&O::pcs3>("Present pose of product coordinate system 3.");
  d.internal<&O::pcs4>("Present pose of product coordinate system 4.");
  d.internal<&O::pcs5>("Present pose of product coordinate system 5.");
  d.internal<&O::pcs6>("Present pose of product coordinate system 6.");
  d.internal<&O::pcs7>("Present pose of product coordinate system 7.");
  d.internal<&O::pcs8>("Present pose of product coordinate system 8.");
  d.internal<&O::pcs9>("Present pose of product coordinate system 9.");
  d.internal<&O::pcs10>("Present pose of product coordinate system 10.");
  d.internal<&O::pcs11>("Present pose of product coordinate system 11.");
  d.internal<&O::pcs12>("Present pose of product coordinate system 12.");
  d.internal<&O::pcs13>("Present pose of product coordinate system 13.");
  d.internal<&O::pcs14>("Present pose of product coordinate system 14.");
  d.internal<&O::pcs15>("Present pose of product coordinate system 15.");
  d.internal<&O::pcs16>("Present pose of product coordinate system 16.");
  d.internal<&O::track_state>("Synchronisation of the tool with an object.");
  d.internal<&O::in_sync>("The tool is in sync with the object.");
  d.internal<&O::track_lag>(unit::mm,
                            "Travel of the carrier minus that of the tool (tables: rad); NaN while the tool does not "
                            "follow the travel of a carrier.");
  d.internal<&O::object_x>(
      unit::mm,
      "X of the commanded tool in the coordinate system of the object; NaN without one, as for the next five.");
  d.internal<&O::object_y>(unit::mm, "Y in that system.");
  d.internal<&O::object_z>(unit::mm, "Z in that system.");
  d.internal<&O::object_a>(unit::deg, "A in that system: about X.");
  d.internal<&O::object_b>(unit::deg, "B in that system: about Y.");
  d.internal<&O::object_c>(unit::deg, "C in that system: about Z.");
  d.internal<&O::kinematics_on>("The group has kinematics, and they are switched on.");
  d.internal<&O::in_position>("The group is in GroupStandby and no move is waiting.");
  d.internal<&O::interrupted>("The group rests on the path, or comes to rest there, until it is continued.");
  d.internal<&O::synchronized>("A path that follows a master is in sync with it.");
  d.internal<&O::reason>(
      "Reason why the axes cannot take a pose, if the last move was refused or ended because of that.");
  d.internal<&O::problem>("Reason why there is no such path, if the last move was refused because of that.");
  d.internal<&O::blocked_at>(unit::mm,
                             "Arc length at which that move was refused or ended, from its start; in a path from the "
                             "start of blocked_element, with trouble from the start of the path.");
  d.internal<&O::blocked_element>("Number of that element in a path of the machine file, from 1; 0: not such a path.");
  d.internal<&O::trouble>("Reason why the path is not free, if the last move was refused because of that.");
  d.internal<&O::first_part>("Number of the part that comes too close, among the group's parts, from 1; 0: none.");
  d.internal<&O::second_part>("Number of the part to which it comes too close; 0: none.");
  d.internal<&O::on_blend>("The trouble is on the blend into the move, or into that element of a path.");
  d.internal<&O::checking>("The group waits for the check of the next path.");
  d.internal<&O::zones>("Zones held by the group, a mask: bit 0 is the first one of the machine file.");
  d.internal<&O::waits_for>("Number of the group for which it waits at a zone, from 1; 0: it does not wait.");
  d.internal<&O::waits_zone>("Number of that zone, from 1; 0: none.");
  d.internal<&O::tool>("Pose of the tool centre point on the flange.");
}

}  // namespace takt::group
