#include "takt/group/request.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Enumeration<MoveKind>& e) {
  e.about("Kind of move.");
  e.value(MoveKind::kNone, "none", "No move.");
  e.value(MoveKind::kLinear, "linear", "A straight line.");
  e.value(MoveKind::kCircular, "circular", "A circular arc.");
  e.value(MoveKind::kDirect, "direct", "All axes in proportion.");
  e.value(MoveKind::kPath, "path", "A path of the machine file.");
  e.value(MoveKind::kArch, "arch", "Half an ellipse.");
  e.value(MoveKind::kJog, "jog", "A jog, as long as it is held.");
}

void describe(Description<CarriedTarget>& d) {
  d.about("A target on a carrier.");
  d.internal<&CarriedTarget::carrier>("Number of the carrier; 0: none.");
  d.internal<&CarriedTarget::from>("Travel of the carrier at which the target was recorded.");
  d.internal<&CarriedTarget::lies>("Pose relative to the origin of the carrier.");
  d.internal<&CarriedTarget::has_origin>("Another origin replaces that of the carrier.");
  d.internal<&CarriedTarget::origin>("That origin, in the MCS.");
}

void describe(Description<Request>& d) {
  using R = Request;
  d.about("A checked move of a group.");
  d.internal<&R::ticket>("Ticket of the command.");
  d.internal<&R::kind>("Kind of move.");
  d.internal<&R::relative>("Displacements instead of a target.");
  d.internal<&R::system>("Coordinate system.");
  d.internal<&R::pcs>("Index of the product coordinate system, from 0.");
  d.internal<&R::frame>("Pose of the coordinate system when the command was given.");
  d.internal<&R::cargo>("Target of the coordinate system instead, if it moves.");
  d.internal<&R::to>("Given coordinates of the tool and of the axes; NaN: not given.");
  d.internal<&R::circle>("Definition of circular moves.");
  d.internal<&R::path>("Index of the path.");
  d.internal<&R::master>("Number of the axis that the path follows, from 1; 0: none.");
  d.internal<&R::height>("Height of an arch.");
  d.internal<&R::ratio>("Path per unit of the master, mm.");
  d.internal<&R::limits>("Limits along the path.");
  d.internal<&R::configuration>("Configuration, for direct moves to a pose.");
  d.internal<&R::velocity_factor>("Direct moves: factor of the axes' velocities; jogs: factor of the given speeds.");
  d.internal<&R::acceleration_factor>("Factor of the axes' accelerations.");
  d.internal<&R::jerk_factor>("Factor of the axes' jerks.");
  d.internal<&R::buffer_mode>("Start of the move relative to the previous one.");
  d.internal<&R::transition_mode>("Transition from the previous move.");
  d.internal<&R::transition_parameter>("Parameter of the transition.");
  d.internal<&R::jog_system>("Coordinate system of a jog.");
  d.internal<&R::most_s>("Longest duration of a jog at these speeds.");
  d.internal<&R::border>("Obstacle that limits that duration.");
}

}  // namespace takt::group
