// Commands that make cams at run time (CAM-88). A cam is sent in pieces of bounded size, in the terms of a machine
// file, and then built outside the cycle (builder.h). It can be used from the cycle that accepts the result.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "takt/cam/params.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/inline_vector.h"
#include "takt/core/name.h"

namespace takt::cam {

// As many as fit into a command without making it larger than other commands.
inline constexpr std::size_t kPointsPerCommand = 20;
inline constexpr std::size_t kSegmentsPerCommand = 8;

struct BeginCam {  // a draft without points and segments
  Name name;
  bool cyclic = false;
  Interpolation interpolation = Interpolation::kQuintic;
  Name x_unit = Name::Of("u");
  Name y_unit = Name::Of("u");
};
struct AddCamPoints {
  Name cam;
  std::optional<std::uint32_t> first{};  // number of points in the draft before this command
  InlineVector<CamPoint, kPointsPerCommand> points;
};
struct AddCamSegments {
  Name cam;
  std::optional<std::uint32_t> first{};  // number of segments in the draft before this command
  InlineVector<CamSegment, kSegmentsPerCommand> segments;
};
struct BuildCam {  // done when the cam can be used
  Name cam;
  std::optional<std::uint32_t> count{};  // total number of points or segments
};
struct DropCam {  // only cams made at run time
  Name cam;
};

// publishes a CamPiece; the feedback's value is the total number of points or segments
struct ReadCam {
  Name cam{};                             // empty: by number
  std::optional<std::uint64_t> number{};  // of the cam
  std::uint32_t first = 0;                // index of the first point or segment, from 0
};
// Result of the builder, which runs outside the cycle; issued by the engine only, never by a client.
struct CamBuilt {
  std::uint64_t number = 0;  // of the draft
  bool good = false;
};

// A piece of the source of a cam.
struct CamPiece {
  static constexpr std::size_t kPoints = 100, kSegments = 20;

  std::uint64_t cycle = 0;
  std::uint64_t number = 0;  // of the cam
  Name name, x_unit, y_unit;
  bool cyclic = false;
  Interpolation interpolation = Interpolation::kQuintic;
  std::uint32_t total = 0;  // total number of points or segments
  std::uint32_t first = 0;  // index of the first one below
  InlineVector<CamPoint, kPoints> points;
  InlineVector<CamSegment, kSegments> segments;
};

// Why a cam was not made: the value of a feedback with ErrorId::kCamMaking.
enum class MakingProblem : std::uint8_t {
  kNone,
  kFaulty,           // Build found errors
  kNoDraft,          // no draft has this name
  kBusy,             // all drafts are being built
  kTooManyPoints,    // more than kMaxPoints in the draft
  kTooManySegments,  // more than kMaxSegments in the draft
  kMixed,            // points and segments in one draft
  kOutOfOrder,       // `first` is not the number of those in the draft
  kIncomplete,       // a piece was refused
  kMissing,          // `count` is not the number of those in the draft
  kNoRoom,           // kMadeCams cams are in use
  kNotMade,          // no cam of this name was made at run time
  kUnknown,          // no cam has this name or number
  kBehindEnd,        // `first` is not below the number of points or segments
};
// Returns the value of the feedback for a refused command: the problem, and the expected and found numbers if there are
// any.
double CodeOf(MakingProblem problem, std::size_t expected = 0, std::size_t found = 0) noexcept;
MakingProblem ProblemOf(double code) noexcept;
// Returns the message for users; empty for kNone. Not for use within the cycle.
std::string MessageOf(double code);

void describe(Description<BeginCam>&);
void describe(Description<AddCamPoints>&);
void describe(Description<AddCamSegments>&);
void describe(Description<BuildCam>&);
void describe(Description<DropCam>&);
void describe(Description<ReadCam>&);
void describe(Description<CamBuilt>&);

}  // namespace takt::cam
