// What people tell a track.
#pragma once

#include <cstdint>
#include <variant>

#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"
#include "takt/planar/problem.h"

namespace takt::track {

// These change the geometry. They are taken in the order given, all tracks together, each done when the track has been
// made anew outside the cycle.
struct AppendLine {
  double start_x = 0, start_y = 0;  // mm
  double end_x = 0, end_y = 0;
  Name reference{};  // part or coordinate system that the places belong to
};
struct AppendCircle {  // a whole one if it ends where it starts
  double start_x = 0, start_y = 0;
  double end_x = 0, end_y = 0;
  double center_x = 0, center_y = 0;
  bool clockwise = false;
  Name reference{};
};
struct AppendPosition {
  double x = 0, y = 0;
  Name reference{};
};
struct CloseLoop {};
struct Clear {};
struct StartFromTrack {  // at the end of that one
  Name track;
  // Indices of positions of the parts of both, which the geometry is made for; 0: as they are.
  std::uint32_t this_position_index = 0;
  std::uint32_t other_position_index = 0;
  bool only_there = false;  // the link is in force there alone, not wherever the tracks meet
};
struct EndAtTrack {  // at the start of that one
  Name track;
  // Indices of positions of the parts of both, which the geometry is made for; 0: as they are.
  std::uint32_t this_position_index = 0;
  std::uint32_t other_position_index = 0;
  bool only_there = false;  // the link is in force there alone, not wherever the tracks meet
};

struct Enable {};
struct Disable {};
struct Reset {};

struct AddToGroup {  // of movers
  Name group;
};
struct RemoveFromGroup {};

// The answer to a question (build_queues.h); no command of people.
struct TrackMade {
  std::uint64_t number = 0;  // of the question
  planar::Problem problem = planar::Problem::kNone;
  std::uint32_t element = 0;  // where the problem is, from 1; 0: nowhere
};

using Command = std::variant<AppendLine, AppendCircle, AppendPosition, CloseLoop, Clear, StartFromTrack, EndAtTrack,
                             Enable, Disable, Reset, AddToGroup, RemoveFromGroup, TrackMade>;

void describe(Description<AppendLine>&);
void describe(Description<AppendCircle>&);
void describe(Description<AppendPosition>&);
void describe(Description<CloseLoop>&);
void describe(Description<Clear>&);
void describe(Description<StartFromTrack>&);
void describe(Description<EndAtTrack>&);
void describe(Description<Enable>&);
void describe(Description<Disable>&);
void describe(Description<Reset>&);
void describe(Description<AddToGroup>&);
void describe(Description<RemoveFromGroup>&);
void describe(Description<TrackMade>&);

}  // namespace takt::track
