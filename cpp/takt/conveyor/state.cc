#include "takt/conveyor/state.h"

#include "takt/conveyor/texts.h"

namespace takt::conveyor {

void describe(Enumeration<ObjectState>& e) {
  e.about("What is known of an object on a belt.");
  e.value(ObjectState::kDetected, "detected", "It was latched; its pose is still to come.");
  e.value(ObjectState::kVisible, "visible", "It is known where it lies.");
  e.value(ObjectState::kTaken, "taken", "Somebody is to fetch it.");
}

void describe(Description<Attributes>& d) {
  using A = Attributes;
  d.about("What people know of an object.");
  d.internal<&A::kind>("What it is, a number of your own.");
  d.internal<&A::colour>("Its colour, a number of your own.");
  d.internal<&A::quality>(unit::one, "How good it is, a number of your own.");
}

void describe(Description<Object>& d) {
  using O = Object;
  d.about("An object on a belt.");
  d.internal<&O::number>("From 1, never used again; 0: none.");
  d.internal<&O::state>("What is known of it.");
  d.internal<&O::latch>(kAlong, "Travel of the belt when it was detected.");
  d.internal<&O::pose>("As it lay then, seen from the belt's origin.");
  d.internal<&O::attributes>("What people know of it.");
}

void describe(Description<LostObject>& d) {
  d.about("An object that a belt has lost.");
  d.internal<&LostObject::number>("As it was on the belt; 0: none.");
  d.internal<&LostObject::attributes>("As they were.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("A belt.");
  d.internal<&S::travel>("How far it has come, over all turns.");
  d.internal<&S::filter>("Of what is measured.");
  d.internal<&S::known>("Its axis says where it is.");
  d.internal<&S::started>("It has seen its axis.");
  d.internal<&S::sense>("In which it moved last.");
  d.internal<&S::objects>("What lies on it.");
  d.internal<&S::count>("So many.");
  d.internal<&S::last_number>("Of the object detected last.");
  d.internal<&S::lost>("Objects that left the range untaken.");
  d.internal<&S::last_lost>("The last of them.");
  d.internal<&S::refused>("Objects without room.");
}

}  // namespace takt::conveyor
