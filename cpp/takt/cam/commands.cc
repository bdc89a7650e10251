#include "takt/cam/commands.h"

#include <algorithm>

#include "takt/core/describe.h"

namespace takt::cam {

namespace {

// Bits of a code, which a double holds exactly: the problem, a number up to 2^17 and one up to 2^32.
constexpr std::uint64_t kOfProblem = 4, kOfExpected = 17, kOfFound = 32;

std::uint64_t Bits(double code, std::uint64_t first, std::uint64_t count) {
  return code >= 0 && code < 0x1p53 ? (static_cast<std::uint64_t>(code) >> first) & ((std::uint64_t{1} << count) - 1)
                                    : 0;
}

}  // namespace

double CodeOf(MakingProblem problem, std::size_t expected, std::size_t found) noexcept {
  const auto least = [](std::uint64_t value, std::uint64_t bits) {
    return std::min(value, (std::uint64_t{1} << bits) - 1);
  };
  return static_cast<double>(static_cast<std::uint64_t>(problem) | least(expected, kOfExpected) << kOfProblem |
                             least(found, kOfFound) << (kOfProblem + kOfExpected));
}

MakingProblem ProblemOf(double code) noexcept {
  return static_cast<MakingProblem>(Bits(code, 0, kOfProblem));
}

std::string MessageOf(double code) {
  const std::string expected = std::to_string(Bits(code, kOfProblem, kOfExpected));
  const std::string found = std::to_string(Bits(code, kOfProblem + kOfExpected, kOfFound));
  switch (ProblemOf(code)) {
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
      return "expected 2 to 100,000 points, found " + found;
    case MakingProblem::kTooManySegments:
      return "expected 20,000 segments at most, found " + found;
    case MakingProblem::kMixed:
      return "expected points or segments, found both in one cam";
    case MakingProblem::kOutOfOrder:
      return "first: expected " + expected + ", the number of points or segments sent before, found " + found +
             ": a piece of the cam is missing or was sent twice";
    case MakingProblem::kIncomplete:
      return "a piece of the cam was refused; send the cam again from begin_cam on";
    case MakingProblem::kMissing:
      return "count: expected " + expected + ", the number of points or segments that have come, found " + found +
             ": a piece of the cam is missing; send the cam again from begin_cam on";
    case MakingProblem::kNoRoom:
      return "64 cams made at run time are in use; drop one with drop_cam first";
    case MakingProblem::kNotMade:
      return "expected the name of a cam made at run time";
    case MakingProblem::kUnknown:
      return "cam, number: expected the name or the number of a cam that the engine has";
    case MakingProblem::kBehindEnd:
      return "first: expected less than " + expected + ", the number of points or segments of the cam, found " + found;
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

void describe(Description<ReadCam>& d) {
  using C = ReadCam;
  d.about(
      "Publishes a piece of the points or segments of a cam, from the machine file or made at run time, on channel "
      "takt/cams: up to 100 points or 20 segments. Done: the value is the number of its points or segments in all. In "
      "Python, cam(name) of a session and cam_in_force of a cam module gather the pieces.");
  d.defaulted<&C::cam>("Name of the cam.");
  d.defaulted<&C::number>("Number of the cam, instead.");
  d.defaulted<&C::first>("Number of points or segments to leave out.");
}

void describe(Description<CamBuilt>& d) {
  d.about("Result of the builder.");
  d.required<&CamBuilt::number>("Number of the draft.");
  d.required<&CamBuilt::good>("The cam can be used.");
}

}  // namespace takt::cam
