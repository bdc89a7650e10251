#include "takt/conveyor/commands.h"

#include "takt/conveyor/texts.h"

namespace takt::conveyor {

namespace {

template <typename T>
void DescribePose(Description<T>& d) {
  d.template defaulted<&T::x>(unit::mm, kPlaces, "X of the object when it was detected, from the belt's origin.");
  d.template defaulted<&T::y>(unit::mm, kPlaces, "Y of the object.");
  d.template defaulted<&T::z>(unit::mm, kPlaces, "Z of the object.");
  d.template defaulted<&T::a>(unit::deg, kAngles, "Rotation about X.");
  d.template defaulted<&T::b>(unit::deg, kAngles, "Rotation about Y.");
  d.template defaulted<&T::c>(unit::deg, kAngles, "Rotation about Z.");
  d.template defaulted<&T::kind>("Kind of the object, a user-defined number.");
  d.template defaulted<&T::colour>("Colour of the object, a user-defined number.");
  d.template defaulted<&T::quality>(unit::one, kPlaces, "Quality of the object, a user-defined number.");
}

template <typename T>
void DescribeNumber(Description<T>& d) {
  d.template required<&T::number>(between(1, 4294967295.0), "Number of the object.");
}

}  // namespace

void describe(Description<Detect>& d) {
  using D = Detect;
  d.about(
      "Adds an object to the belt, latched at the belt's present or a recorded position. Given any of x to c it is "
      "visible at once, with the others 0; else locate has to follow. The value of the feedback is the object's "
      "number.");
  d.defaulted<&D::recorded_position>(
      unit::u, kAxisPositions,
      "Position of the belt's axis at the detection, from a touch probe; unset: the present one.");
  d.defaulted<&D::latched_with>(
      between(1, 4294967295.0),
      "Number of an object still on the belt that was detected at the same instant; unset: none.");
  DescribePose(d);
  d.rule<&D::latched_with>("must not be given besides recorded_position",
                           [](const D& c) { return !c.latched_with || !c.recorded_position; });
}

void describe(Description<Locate>& d) {
  using L = Locate;
  d.about(
      "Gives the pose that an object had when it was detected, and makes the object visible; the belt's travel since "
      "then is compensated.");
  d.defaulted<&L::number>(between(1, 4294967295.0),
                          "Number of an object that has not been taken; unset: the first one not located yet.");
  DescribePose(d);
}

void describe(Description<TakeObject>& d) {
  d.about("Reserves a visible object: it cannot be taken again, and is not deleted beyond the work range.");
  DescribeNumber(d);
}

void describe(Description<GiveBackObject>& d) {
  d.about("Makes an object that was taken available again.");
  DescribeNumber(d);
}

void describe(Description<RemoveObject>& d) {
  d.about("Deletes an object.");
  DescribeNumber(d);
}

void describe(Description<ClearObjects>& d) {
  d.about("Deletes all objects of the belt.");
}

}  // namespace takt::conveyor
