#include "takt/conveyor/state.h"

#include "takt/conveyor/texts.h"

namespace takt::conveyor {

void describe(Enumeration<ObjectState>& e) {
  e.about("State of an object on a belt.");
  e.value(ObjectState::kDetected, "detected", "Latched; its pose is not known yet.");
  e.value(ObjectState::kVisible, "visible", "Its pose is known.");
  e.value(ObjectState::kTaken, "taken", "Reserved to be picked.");
}

void describe(Description<Attributes>& d) {
  using A = Attributes;
  d.about("Attributes of an object, given by the user.");
  d.internal<&A::kind>("Kind of the object, a user-defined number.");
  d.internal<&A::colour>("Colour of the object, a user-defined number.");
  d.internal<&A::quality>(unit::one, "Quality of the object, a user-defined number.");
}

void describe(Description<Object>& d) {
  using O = Object;
  d.about("An object on a belt.");
  d.internal<&O::number>("Number of the object, from 1, never used again; 0: none.");
  d.internal<&O::state>("State of the object.");
  d.internal<&O::latch>(kAlong, "Travel of the belt at the detection.");
  d.internal<&O::pose>("Pose at the detection, from the belt's origin.");
  d.internal<&O::attributes>("Attributes given by the user.");
}

void describe(Description<LostObject>& d) {
  d.about("An object that a belt has lost.");
  d.internal<&LostObject::number>("Number that it had on the belt; 0: none.");
  d.internal<&LostObject::attributes>("Attributes that it had.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("State of a belt.");
  d.internal<&S::travel>("Travel of the belt over all turns.");
  d.internal<&S::filter>("Filter of the measured position.");
  d.internal<&S::known>("The position of its axis is known.");
  d.internal<&S::started>("A position of its axis has been received.");
  d.internal<&S::sense>("Direction of the last motion.");
  d.internal<&S::objects>("Objects on the belt.");
  d.internal<&S::count>("Number of objects on the belt.");
  d.internal<&S::last_number>("Number of the last detected object.");
  d.internal<&S::lost>("Number of objects that were lost: beyond the work range, or too long without a pose.");
  d.internal<&S::last_lost>("The last objects that were lost.");
  d.internal<&S::refused>("Number of objects refused because the belt was full.");
}

}  // namespace takt::conveyor
