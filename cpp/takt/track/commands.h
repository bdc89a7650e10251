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
};
struct AppendCircle {  // a whole one if it ends where it starts
  double start_x = 0, start_y = 0;
  double end_x = 0, end_y = 0;
  double center_x = 0, center_y = 0;
  bool clockwise = false;
};
struct AppendPosition {
  double x = 0, y = 0;
};
struct CloseLoop {};
struct Clear {};
struct StartFromTrack {  // at the end of that one
  Name track;
};
struct EndAtTrack {  // at the start of that one
  Name track;
};

struct Enable {};
struct Disable {};
struct Reset {};

struct AddToGroup {  // of movers
  Name group;
};
struct RemoveFromGroup {};

// The answer to a question (desk.h); no command of people.
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
