#include "takt/cam/commands.h"

#include "takt/core/describe.h"

namespace takt::cam {

std::string_view Text(MakingProblem problem) noexcept {
  switch (problem) {
    case MakingProblem::kNone:
      return {};
    case MakingProblem::kFaulty:
      return "the cam has errors";
    case MakingProblem::kNoDraft:
      return "expected a begin_cam of this name before; at most two drafts exist at a time, and a third replaces the "
             "oldest that is not being built";
    case MakingProblem::kBusy:
      return "two cams are being built; wait until one of them is done";
    case MakingProblem::kTooManyPoints:
      return "expected 2 to 100,000 points, found more";
    case MakingProblem::kTooManySegments:
      return "expected 20,000 segments at most, found more";
    case MakingProblem::kMixed:
      return "expected points or segments, found both in one cam";
    case MakingProblem::kOutOfOrder:
      return "first: expected the number of points or segments sent before, found another: a piece of the cam is "
             "missing or was sent twice";
    case MakingProblem::kIncomplete:
      return "a piece of the cam was refused or is missing; send the cam again from begin_cam on";
    case MakingProblem::kNoRoom:
      return "64 cams made at run time are in use; drop one with drop_cam first";
    case MakingProblem::kNotMade:
      return "expected the name of a cam made at run time";
  }
  return {};
}

void describe(Description<BeginCam>& d) {
  using C = BeginCam;
  d.about(
      "Begins a cam at run time; add_cam_points or add_cam_segments send its data, build_cam builds it. Two drafts "
      "exist at a time; a third replaces the oldest that is not being built.");
  d.required<&C::name>("Name of the cam. A cam in use under this name stays in use until it is left.");
  d.defaulted<&C::cyclic>("The end continues at the beginning, raised by the stroke.");
  d.defaulted<&C::interpolation>("Curve between the points.");
  d.defaulted<&C::x_unit>("The master's unit, for display.");
  d.defaulted<&C::y_unit>("The slave's unit, for display.");
}

void describe(Description<AddCamPoints>& d) {
  using C = AddCamPoints;
  d.about("Adds up to 20 points to a draft; 100,000 in all.");
  d.required<&C::cam>("Name of the cam.");
  d.defaulted<&C::first>("Number of points sent before; detects a lost piece.");
  d.required<&C::points>("Points, x increasing.");
}

void describe(Description<AddCamSegments>& d) {
  using C = AddCamSegments;
  d.about("Adds up to 8 segments to a draft; 20,000 in all.");
  d.required<&C::cam>("Name of the cam.");
  d.defaulted<&C::first>("Number of segments sent before; detects a lost piece.");
  d.required<&C::segments>("Segments, in order.");
}

void describe(Description<BuildCam>& d) {
  using C = BuildCam;
  d.about(
      "Checks and builds a draft outside the cycle. Done: the name stands for the new cam, and the value of the "
      "feedback is its number; axes and modules that run an earlier cam of this name keep it. Error 3113: the sentence "
      "says what is wrong and where.");
  d.required<&C::cam>("Name of the cam.");
  d.defaulted<&C::count>("Number of points or segments sent in all; detects a lost piece.");
}

void describe(Description<DropCam>& d) {
  d.about(
      "Removes the name of a cam made at run time; its memory is free once nothing runs it. A cam of the machine file "
      "with this name can be used again.");
  d.required<&DropCam::cam>("Name of the cam.");
}

void describe(Description<CamBuilt>& d) {
  d.about("Result of the builder.");
  d.required<&CamBuilt::number>("Number of the draft.");
  d.required<&CamBuilt::good>("The cam can be used.");
}

}  // namespace takt::cam
