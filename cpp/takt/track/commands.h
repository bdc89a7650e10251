// Commands to a track.
#pragma once

#include <cstdint>
#include <variant>

#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"
#include "takt/planar/problem.h"

namespace takt::track {

// Changes of the geometry. Carried out in the order given, for all tracks together; each is done when the track has
// been built anew outside the cycle.
struct AppendLine {
  double start_x = 0, start_y = 0;  // [mm]
  double end_x = 0, end_y = 0;
  Name reference{};  // part or coordinate system of the coordinates; empty: the only coordinate system
};
struct AppendCircle {  // a full circle if it ends at its start
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
struct StartFromTrack {  // starts at the end of `track`
  Name track;
  // Indices, from 1, of the positions of both tracks' parts for which the geometry is made; 0: the current ones.
  std::uint32_t this_position_index = 0;
  std::uint32_t other_position_index = 0;
  bool only_there = false;  // the link holds at these positions only; false: wherever the ends meet
};
struct EndAtTrack {  // ends at the start of `track`
  Name track;
  // Indices, from 1, of the positions of both tracks' parts for which the geometry is made; 0: the current ones.
  std::uint32_t this_position_index = 0;
  std::uint32_t other_position_index = 0;
  bool only_there = false;  // the link holds at these positions only; false: wherever the ends meet
};

struct Enable {};
struct Disable {};
struct Reset {};

struct AddToGroup {  // a group of movers
  Name group;
};
struct RemoveFromGroup {};

// Answer to a build request (build_queues.h); not a command of users.
struct TrackMade {
  std::uint64_t number = 0;  // of the request
  planar::Problem problem = planar::Problem::kNone;
  std::uint32_t element = 0;  // element with the problem, from 1; 0: none
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
