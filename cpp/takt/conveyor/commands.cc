#include "takt/conveyor/commands.h"

#include "takt/conveyor/texts.h"

namespace takt::conveyor {

namespace {

template <typename T>
void DescribePose(Description<T>& d) {
  d.template defaulted<&T::x>(unit::mm, kPlaces, "X of where it lay when it was detected, from the belt's origin.");
  d.template defaulted<&T::y>(unit::mm, kPlaces, "Y of it.");
  d.template defaulted<&T::z>(unit::mm, kPlaces, "Z of it.");
  d.template defaulted<&T::a>(unit::deg, kAngles, "Turned about X.");
  d.template defaulted<&T::b>(unit::deg, kAngles, "Turned about Y.");
  d.template defaulted<&T::c>(unit::deg, kAngles, "Turned about Z.");
  d.template defaulted<&T::kind>("What it is: a number of your own.");
  d.template defaulted<&T::colour>("Its colour: a number of your own.");
  d.template defaulted<&T::quality>(unit::one, kPlaces, "How good it is: a number of your own.");
}

template <typename T>
void DescribeNumber(Description<T>& d) {
  d.template required<&T::number>(between(1, 4294967295.0), "Of the object.");
}

}  // namespace

void describe(Description<Detect>& d) {
  using D = Detect;
  d.about(
      "An object is on the belt: it is latched where the belt is now, or was. Given any of x to c it is visible at "
      "once, the others being 0; else locate has to follow. The value of the feedback is its number.");
  d.defaulted<&D::recorded_position>(unit::u, kAxisPositions,
                                     "Position of the belt's axis when it was seen, from a touch probe; unset: now.");
  d.defaulted<&D::latched_with>(
      between(1, 4294967295.0),
      "It was seen together with the object of that number, which is still there; unset: not.");
  DescribePose(d);
  d.rule<&D::latched_with>("must not be given besides recorded_position",
                           [](const D& c) { return !c.latched_with || !c.recorded_position; });
}

void describe(Description<Locate>& d) {
  using L = Locate;
  d.about(
      "Tells where an object lay when it was detected, and makes it visible; what the belt has travelled since is "
      "made good.");
  d.defaulted<&L::number>(between(1, 4294967295.0),
                          "Of the object; unset: of those that were not located yet the first one.");
  DescribePose(d);
}

void describe(Description<TakeObject>& d) {
  d.about("Marks a visible object as somebody's: nobody else can take it, and it does not get lost.");
  DescribeNumber(d);
}

void describe(Description<GiveBackObject>& d) {
  d.about("Lets others take an object again.");
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
