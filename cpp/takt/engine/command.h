// Commands to the cycle, and their text form (target, verb, arguments), which LCM, Python and the journal share.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "takt/axis/commands.h"
#include "takt/cam/commands.h"
#include "takt/conveyor/commands.h"
#include "takt/conveyor/pose.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/engine/machine.h"
#include "takt/environment/commands.h"
#include "takt/flexcam/commands.h"
#include "takt/group/commands.h"
#include "takt/mover/commands.h"
#include "takt/part/commands.h"
#include "takt/pickplace/commands.h"
#include "takt/planargroup/commands.h"
#include "takt/track/commands.h"

namespace takt::engine {

// Commands of the engine itself; their target is "machine".
struct StopAll {            // stops every axis along its ramp
  bool open_loops = false;  // and then opens its loop
};
struct EmergencyStop {  // GT_EStop: disables every drive and applies every brake at once
  bool hold = false;    // until it is released; otherwise for one cycle
};
struct ReleaseEmergencyStop {  // releases the emergency stop of all its holders
};
struct FailAllAxes {  // every axis brakes and enters ErrorStop with error 3007 (overruns)
};
struct Release {  // ends a level-sensitive command (jog, stop with hold): its Execute falls
  Ticket ticket = 0;
};
struct Renew {  // heartbeat: extends the lease of a level-sensitive command
  Ticket ticket = 0;
};

void describe(Description<StopAll>&);
void describe(Description<EmergencyStop>&);
void describe(Description<ReleaseEmergencyStop>&);
void describe(Description<FailAllAxes>&);
void describe(Description<Release>&);
void describe(Description<Renew>&);

using MachineCommand = std::variant<StopAll, EmergencyStop, ReleaseEmergencyStop, FailAllAxes, Release, Renew,
                                    cam::BeginCam, cam::AddCamPoints, cam::AddCamSegments, cam::BuildCam, cam::DropCam,
                                    cam::ReadCam, cam::CamBuilt, mover::StartRoutes, mover::HoldRoutes>;
// After the commands of the machine, in the order of ComponentKinds().
using CommandBody = std::variant<MachineCommand, axis::Command, flexcam::Command, group::Command, conveyor::Command,
                                 conveyor::PoseCommand, pickplace::Command, mover::Command, track::Command,
                                 planargroup::Command, environment::Command, part::Command>;

// Component i (components.h) has target i + 1.
inline constexpr std::uint32_t kMachineTarget = 0;

struct Command {
  Ticket ticket = 0;
  std::uint32_t target = kMachineTarget;
  double lease_s = 0;  // [s] > 0: a level-sensitive command releases itself this long after its last renewal
  CommandBody body{};
  // [ns] on the monotonic clock: cycles that begin later refuse the command, unless LetsGo() is true for it (EN-33); 0:
  // never.
  std::int64_t expires_ns = 0;
};

// Returns true if the command stops, releases or switches off something: such commands are always accepted (EN-32).
bool LetsGo(const Command& command) noexcept;
// The same for a command in its text form; returns false if the text cannot be parsed.
bool LetsGo(std::string_view target_kind, std::string_view verb, std::string_view arguments);

// One verb that a kind of component understands; `arguments` describes its struct.
struct Verb {
  std::string_view target_kind;  // "machine", or the name of a ComponentKind
  std::string_view name;         // "move_absolute"
  const Type* arguments;
  bool level_sensitive;  // needs a heartbeat over LCM
};
// Returns all verbs that users may give, without those that only the engine gives.
std::span<const Verb> Verbs();

struct ParsedCommand {
  Command command;  // its ticket is not set yet
  ErrorId error = ErrorId::kNone;
  bool level_sensitive = false;
  std::string sentence;  // what is wrong, where, and what was expected; empty if error is kNone
};
// Origin of a command text: a journal also holds commands that the engine gave to itself.
enum class Giver : std::uint8_t { kUser, kJournal };

// Parses a command for a component of `machine`; `arguments` as in "{position: 100, velocity: 50}" or empty.
ParsedCommand ParseCommand(const Machine& machine, std::string_view target, std::string_view verb,
                           std::string_view arguments, Giver giver = Giver::kUser);

struct CommandText {
  std::string target, verb, arguments;
};
// The inverse of ParseCommand: parsing the text again gives the identical command.
CommandText ToText(const Machine& machine, const Command& command);

}  // namespace takt::engine
