#include "takt/conveyor/outputs.h"

#include "takt/core/describe.h"

namespace takt::conveyor {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  constexpr Unit along{"u", "mm; of a table: deg"};
  constexpr Unit speed{"u/s", "mm/s; of a table: deg/s"};
  constexpr Unit acceleration{"u/s2", "mm/s2; of a table: deg/s2"};
  d.about("State of a belt after a cycle.");
  d.internal<&O::position>(
      along, "Travel of the belt over all turns, at the instant for which the axes have their set points.");
  d.internal<&O::velocity>(speed, "Velocity at that instant.");
  d.internal<&O::acceleration>(acceleration, "Acceleration at that instant.");
  d.internal<&O::known>(
      "The position of the belt's axis is known; else a belt of source actual_value is taken to move on at its last "
      "velocity.");
  d.internal<&O::object_count>("Objects on the belt.");
  d.internal<&O::visible_count>("Objects whose pose is known, including taken ones.");
  d.internal<&O::taken_count>("Objects that have been taken.");
  d.internal<&O::in_range_count>("Objects within the work range, including taken ones.");
  d.internal<&O::last_number>("Number of the last detected object; 0: none yet.");
  d.internal<&O::lost_count>(
      "Objects deleted beyond the work range or, without a pose, after forget_after, since the start.");
  d.internal<&O::refused_count>("Objects that were refused because the belt was full, since the start.");
  d.internal<&O::first_number>(
      "Number of the visible, untaken object in the work range that is farthest along in the last direction of motion; "
      "0: none.");
  d.internal<&O::first_kind>("Kind of that object; 0 without one.");
  d.internal<&O::first_colour>("Colour of that object; 0 without one.");
  d.internal<&O::first_quality>(unit::one, "Quality of that object; nan without one, as for all quantities below.");
  d.internal<&O::first_place>(along, "Position of that object along the belt, from the belt's origin.");
  d.internal<&O::first_pose>("Pose of that object in the world.");
  d.internal<&O::first_time_left>(unit::s,
                                  "Time until that object leaves the work range at the present speed; inf: never.");
}

}  // namespace takt::conveyor
