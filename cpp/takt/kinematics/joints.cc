#include "takt/kinematics/joints.h"

#include "takt/core/describe.h"

namespace takt::kinematics {

std::string_view Text(Reason reason) noexcept {
  switch (reason) {
    case Reason::kNone:
      return "";
    case Reason::kNotFinite:
      return "a number is not finite";
    case Reason::kOutOfReach:
      return "the place is out of reach";
    case Reason::kOrientation:
      return "the mechanism has no axes for this orientation";
    case Reason::kSingular:
      return "the axes are in a singular position there";
    case Reason::kAxisLimit:
      return "an axis would leave its range";
  }
  return "unknown reason";
}

void describe(Enumeration<Reason>& e) {
  e.about("Reason why no position of the axes gives a pose.");
  e.value(Reason::kNone, "none", "There is a position.");
  e.value(Reason::kNotFinite, "not_finite", "A given number is NaN or infinite.");
  e.value(Reason::kOutOfReach, "out_of_reach", "The position is out of reach of the axes.");
  e.value(Reason::kOrientation, "orientation", "The position can be reached, but not in this orientation.");
  e.value(Reason::kSingular, "singular", "The axes cannot move the tool in every direction there.");
  e.value(Reason::kAxisLimit, "axis_limit", "An axis would leave its range.");
}

void describe(Enumeration<Shoulder>& e) {
  e.about("Side to which an articulated arm faces.");
  e.value(Shoulder::kKeep, "keep", "As it is.");
  e.value(Shoulder::kFront, "front", "The wrist is in front of axis 1.");
  e.value(Shoulder::kBack, "back", "The wrist is behind axis 1: the arm leans over backwards.");
}

void describe(Enumeration<Elbow>& e) {
  e.about("Direction in which the elbow of an arm is bent.");
  e.value(Elbow::kKeep, "keep", "As it is.");
  e.value(Elbow::kPositive, "positive", "In the positive direction of the elbow's axis. SCARA: a right arm.");
  e.value(Elbow::kNegative, "negative", "In the negative direction. SCARA: a left arm.");
}

void describe(Enumeration<Wrist>& e) {
  e.about("Direction in which the wrist of an articulated arm is bent.");
  e.value(Wrist::kKeep, "keep", "As it is.");
  e.value(Wrist::kPositive, "positive", "Axis 5 is bent in the positive direction (no flip).");
  e.value(Wrist::kNegative, "negative", "Axis 5 is bent in the negative direction (flip).");
}

void describe(Description<Configuration>& d) {
  using C = Configuration;
  d.about("Choice between several positions of the axes for one pose.");
  d.defaulted<&C::shoulder>("Side to which the arm faces; articulated arms.");
  d.defaulted<&C::elbow>("Direction in which the elbow is bent; SCARA and articulated arms.");
  d.defaulted<&C::wrist>("Direction in which the wrist is bent; articulated arms.");
}

}  // namespace takt::kinematics
