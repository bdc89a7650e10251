#include "takt/conveyor/outputs.h"

#include "takt/core/describe.h"

namespace takt::conveyor {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  constexpr Unit along{"u", "mm; of a table: deg"};
  constexpr Unit speed{"u/s", "mm/s; of a table: deg/s"};
  constexpr Unit acceleration{"u/s2", "mm/s2; of a table: deg/s2"};
  d.about("State of a belt after a cycle.");
  d.internal<&O::position>(along, "How far it has come, over all turns, when the axes are at their set points.");
  d.internal<&O::velocity>(speed, "Its velocity then.");
  d.internal<&O::acceleration>(acceleration, "Its acceleration then.");
  d.internal<&O::known>("Its axis says where it is; else it is taken to go on as it went.");
  d.internal<&O::object_count>("Objects on it.");
  d.internal<&O::visible_count>("Those of which it is known where they lie.");
  d.internal<&O::taken_count>("Those that somebody has taken.");
  d.internal<&O::in_range_count>("Those that lie within the work range.");
  d.internal<&O::last_number>("Number of the object detected last; 0: none yet.");
  d.internal<&O::lost_count>("Objects that left the range without being taken, since the start.");
  d.internal<&O::refused_count>("Objects that found no room, since the start.");
  d.internal<&O::first_number>(
      "Number of the object that leaves the range first, of those not taken, in the sense in which the "
      "belt "
      "moved last; 0: there is none.");
  d.internal<&O::first_kind>("What that one is.");
  d.internal<&O::first_colour>("Its colour.");
  d.internal<&O::first_quality>(unit::one, "How good it is; nan without one, as all that follows.");
  d.internal<&O::first_place>(along, "Where it is along the belt, seen from the belt's origin.");
  d.internal<&O::first_pose>("The pose of it in the world.");
  d.internal<&O::first_time_left>(unit::s, "Until it leaves the range at this speed; inf: never.");
}

}  // namespace takt::conveyor
