#include "takt/group/request.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Enumeration<MoveKind>& e) {
  e.about("What kind of move.");
  e.value(MoveKind::kNone, "none", "None.");
  e.value(MoveKind::kLinear, "linear", "Straight on.");
  e.value(MoveKind::kCircular, "circular", "Along an arc.");
  e.value(MoveKind::kDirect, "direct", "All axes evenly.");
  e.value(MoveKind::kPath, "path", "Along a path of the machine file.");
  e.value(MoveKind::kArch, "arch", "Along half an ellipse.");
  e.value(MoveKind::kJog, "jog", "As long as it is held.");
}

void describe(Description<CarriedTarget>& d) {
  d.about("Something that lies on a carrier.");
  d.internal<&CarriedTarget::carrier>("Its number; 0: none.");
  d.internal<&CarriedTarget::from>("Travel at which it lay there.");
  d.internal<&CarriedTarget::lies>("Of the origin.");
  d.internal<&CarriedTarget::has_origin>("Another origin than that of the carrier.");
  d.internal<&CarriedTarget::origin>("In the MCS.");
}

void describe(Description<Request>& d) {
  using R = Request;
  d.about("A checked move of a group.");
  d.internal<&R::ticket>("Of the command.");
  d.internal<&R::kind>("What kind.");
  d.internal<&R::relative>("How far, not where to.");
  d.internal<&R::system>("Coordinate system.");
  d.internal<&R::pcs>("Which product coordinate system, from 0.");
  d.internal<&R::frame>("Where it was then.");
  d.internal<&R::cargo>("Or what it is that of, if that moves.");
  d.internal<&R::to>("Numbers given, of the tool and of the axes; NaN: none.");
  d.internal<&R::circle>("Of circular moves.");
  d.internal<&R::path>("Index of the path.");
  d.internal<&R::master>("Axis that gives the way, from 1; 0: none.");
  d.internal<&R::height>("Of arches.");
  d.internal<&R::ratio>("mm per unit of it.");
  d.internal<&R::limits>("Along the path.");
  d.internal<&R::configuration>("Direct moves to a pose.");
  d.internal<&R::velocity_factor>("Direct moves: of the axes' velocity; jogs: of the speeds given.");
  d.internal<&R::acceleration_factor>("Of their acceleration.");
  d.internal<&R::jerk_factor>("Of their jerk.");
  d.internal<&R::buffer_mode>("When it takes over.");
  d.internal<&R::transition_mode>("How.");
  d.internal<&R::transition_parameter>("With what.");
  d.internal<&R::jog_system>("Of a jog.");
  d.internal<&R::most_s>("A jog goes on for so long at most.");
  d.internal<&R::border>("Because this is in the way.");
}

}  // namespace takt::group
