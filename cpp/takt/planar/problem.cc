#include "takt/planar/problem.h"

#include "takt/core/describe.h"

namespace takt::planar {

std::string_view Text(Problem problem) noexcept {
  switch (problem) {
    case Problem::kNone:
      return "";
    case Problem::kNotFinite:
      return "a number of the track is not finite, or a position is more than 1 km away";
    case Problem::kLengthZero:
      return "a line begins where it ends, or a position is where its neighbour is";
    case Problem::kRadiusZero:
      return "the arc begins at its centre";
    case Problem::kNotOnCircle:
      return "start and end of the arc are not equally far from its centre";
    case Problem::kTooTight:
      return "a radius is less than 1 mm";
    case Problem::kKink:
      return "two pieces of the track touch where their directions differ: leave a gap for the transition";
    case Problem::kCurvatureJump:
      return "two pieces of the track touch where their curvatures differ: leave a gap for the transition";
    case Problem::kTooSharp:
      return "the gap is too small: the transition would have a radius of less than 1 mm";
    case Problem::kReversal:
      return "the transition would have to go back the way it came";
    case Problem::kLoop:
      return "the transition would make a loop";
    case Problem::kEmpty:
      return "the track has no length";
    case Problem::kClosed:
      return "the track is a closed loop: nothing can be appended";
    case Problem::kEnded:
      return "the track ends at another track: nothing can be appended";
    case Problem::kLinked:
      return "a track that starts from or ends at another one cannot be a closed loop";
    case Problem::kNotItsStart:
      return "the track starts elsewhere, or in another direction or curvature, than the other track ends";
    case Problem::kNotItsEnd:
      return "the track ends elsewhere, or in another direction or curvature, than the other track starts";
    case Problem::kCrosses:
      return "the track crosses or touches itself";
    case Problem::kTooMany:
      return "a track has at most 64 elements, starts from at most 8 tracks and ends at as many; at most 64 start, or "
             "end, at one "
             "point";
    case Problem::kOtherEmpty:
      return "the other track has no length yet";
    case Problem::kOtherClosed:
      return "the other track is a closed loop, which neither starts nor ends";
    case Problem::kInUse:
      return "other tracks start from this one or end at it: its geometry stays until they are cleared";
    case Problem::kNotDisabled:
      return "the geometry of a track can be changed only while it is disabled";
    case Problem::kBusy:
      return "too many changes of tracks are pending";
    case Problem::kApart:
      return "the parts of the tracks are not in one coordinate system";
    case Problem::kNotOnBorder:
      return "tracks of two parts meet on the border of both and nowhere else";
    case Problem::kOffPart:
      return "the track leaves its part";
  }
  return "";
}

Problem FromPath(path::Problem problem) noexcept {
  switch (problem) {
    case path::Problem::kNone:
      return Problem::kNone;
    case path::Problem::kLengthZero:
    case path::Problem::kCoincide:
      return Problem::kLengthZero;
    case path::Problem::kRadiusZero:
      return Problem::kRadiusZero;
    case path::Problem::kNotOnCircle:
      return Problem::kNotOnCircle;
    default:
      return Problem::kNotFinite;
  }
}

void describe(Enumeration<Problem>& e) {
  e.about("Why a track cannot be made.");
  e.value(Problem::kNone, "none", "No problem.");
  e.value(Problem::kNotFinite, "not_finite", "A number is not finite, or too large.");
  e.value(Problem::kLengthZero, "length_zero", "A line ends at its start, or a position coincides with its neighbour.");
  e.value(Problem::kRadiusZero, "radius_zero", "An arc starts at its centre.");
  e.value(Problem::kNotOnCircle, "not_on_circle",
          "Start and end of an arc are not at the same distance from its centre.");
  e.value(Problem::kTooTight, "too_tight", "A radius is too small.");
  e.value(Problem::kKink, "kink", "Two pieces join with different directions.");
  e.value(Problem::kCurvatureJump, "curvature_jump", "Two pieces join with different curvatures.");
  e.value(Problem::kTooSharp, "too_sharp", "The radius of a transition would be too small.");
  e.value(Problem::kReversal, "reversal", "A transition would have to reverse the direction.");
  e.value(Problem::kLoop, "loop", "A transition would make a loop.");
  e.value(Problem::kEmpty, "empty", "The track has no length.");
  e.value(Problem::kClosed, "closed", "The track is a closed loop.");
  e.value(Problem::kEnded, "ended", "The track ends at another track.");
  e.value(Problem::kLinked, "linked", "A track linked with another one cannot be a closed loop.");
  e.value(Problem::kNotItsStart, "not_its_start",
          "The track does not start where the other track ends, or joins it with another direction or curvature.");
  e.value(Problem::kNotItsEnd, "not_its_end",
          "The track does not end where the other track starts, or joins it with another direction or curvature.");
  e.value(Problem::kCrosses, "crosses", "The track crosses or touches itself.");
  e.value(Problem::kTooMany, "too_many", "Too many elements or links.");
  e.value(Problem::kOtherEmpty, "other_empty", "The other track has no length.");
  e.value(Problem::kOtherClosed, "other_closed", "The other track is a closed loop.");
  e.value(Problem::kInUse, "in_use", "Other tracks start from the track or end at it.");
  e.value(Problem::kNotDisabled, "not_disabled", "The track is not disabled.");
  e.value(Problem::kBusy, "busy", "Too many changes of tracks are pending.");
  e.value(Problem::kApart, "apart", "The parts of the tracks are not in one coordinate system.");
  e.value(Problem::kNotOnBorder, "not_on_border", "The tracks do not meet on the border of both parts.");
  e.value(Problem::kOffPart, "off_part", "The track leaves its part.");
}

}  // namespace takt::planar
