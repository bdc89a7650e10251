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

inline std::string AxisChannel(std::string_view name) {
  return "takt/axis/" + std::string(name);
}

}  // namespace takt::lcm
