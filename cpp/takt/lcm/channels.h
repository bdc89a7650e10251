// Names of the LCM channels.
#pragma once

#include <string>
#include <string_view>

namespace takt::lcm {

inline constexpr char kEngineChannel[] = "takt/engine";
inline constexpr char kMachineChannel[] = "takt/machine";
inline constexpr char kCommandChannel[] = "takt/command";
inline constexpr char kFeedbackChannel[] = "takt/feedback";
inline constexpr char kHeartbeatChannel[] = "takt/heartbeat";
// Log files only.
inline constexpr char kJournalStartChannel[] = "takt/journal/start";
inline constexpr char kJournalCommandChannel[] = "takt/journal/command";
inline constexpr char kJournalHashesChannel[] = "takt/journal/hashes";
inline constexpr char kJournalDriveChannel[] = "takt/journal/drive";

inline constexpr char kCamChannel[] = "takt/cams";  // pieces of cams that are read back
// Of the states of a component; `kind` is ComponentKind::name.
inline std::string StateChannel(std::string_view kind, std::string_view name) {
  return "takt/" + std::string(kind) + "/" + std::string(name);
}

// The objects on a belt.
inline std::string ObjectsChannel(std::string_view name) {
  return "takt/belt_objects/" + std::string(name);
}

// The tracks that a mover has yet to travel.
inline std::string TrailChannel(std::string_view name) {
  return "takt/mover_trails/" + std::string(name);
}

// The positions of a mover's route over the free surface.
inline std::string RouteChannel(std::string_view name) {
  return "takt/mover_routes/" + std::string(name);
}

// The shape of a track.
inline std::string ShapeChannel(std::string_view name) {
  return "takt/track_shapes/" + std::string(name);
}

inline constexpr std::string_view kDriveChannels = "takt/drive/";  // common prefix
// Of an axis with an external drive.
inline std::string SetPointChannel(std::string_view name) {
  return "takt/drive/" + std::string(name) + "/setpoint";
}
inline std::string DriveFeedbackChannel(std::string_view name) {
  return "takt/drive/" + std::string(name) + "/feedback";
}
// All feedback channels, as a regular expression.
inline constexpr char kDriveFeedbackChannels[] = "takt/drive/[^/]*/feedback";

}  // namespace takt::lcm
