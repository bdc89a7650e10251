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
// Of the states of a component; `kind` as ComponentKind::name.
inline std::string StateChannel(std::string_view kind, std::string_view name) {
  return "takt/" + std::string(kind) + "/" + std::string(name);
}

// What lies on a belt.
inline std::string ObjectsChannel(std::string_view name) {
  return "takt/belt_objects/" + std::string(name);
}

// The tracks that a mover is to go along.
inline std::string TrailChannel(std::string_view name) {
  return "takt/mover_trails/" + std::string(name);
}

// The places of a mover's route over the free surface.
inline std::string RouteChannel(std::string_view name) {
  return "takt/mover_routes/" + std::string(name);
}

// The shape of a track.
inline std::string ShapeChannel(std::string_view name) {
  return "takt/track_shapes/" + std::string(name);
}

inline constexpr std::string_view kDriveChannels = "takt/drive/";  // they begin with it
// Of an axis whose drive lives in another process.
inline std::string SetPointChannel(std::string_view name) {
  return "takt/drive/" + std::string(name) + "/setpoint";
}
inline std::string DriveFeedbackChannel(std::string_view name) {
  return "takt/drive/" + std::string(name) + "/feedback";
}
// As a regular expression: all of the latter.
inline constexpr char kDriveFeedbackChannels[] = "takt/drive/[^/]*/feedback";

}  // namespace takt::lcm
