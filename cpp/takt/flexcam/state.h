// All memory of a cam module: plain, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"
#include "takt/flexcam/bounds.h"
#include "takt/flexcam/clutch.h"
#include "takt/flexcam/commands.h"
#include "takt/flexcam/master.h"
#include "takt/flexcam/outputs.h"
#include "takt/flexcam/profiler.h"
#include "takt/flexcam/sequencer.h"
#include "takt/flexcam/way.h"

namespace takt::flexcam {

inline constexpr int kPendingChanges = 8;

struct PendingChange {
  Ticket ticket = 0;
  ChangeCam change;
};

// How X came into the cam of a sequence that it is in: a cam that is left over the side where X came in was not run.
struct SequenceEntry {
  std::int8_t sense = 0;    // of X at that end of the cam; 0: it was taken up within, or runs again and again
  bool has_before = false;  // what follows is what was left there
  ProfilerState profiler;
  SequencerState sequencer;
};

struct JogKeys {
  Ticket ticket = 0;  // 0: none is held
  Jog keys;
  double lease_s = 0;  // > 0: a dead man's lease ...
  std::uint64_t lease_end_cycle = 0;
};

// What Control may change by a ramp.
enum class Adjustment : std::uint8_t { kOffsetMaster, kOffsetSlave, kScalingMaster, kScalingSlave };
inline constexpr std::size_t kAdjustments = 4;

// What Control started and whose end is to be told.
enum class Action : std::uint8_t { kNone, kSyncIn, kSyncOut, kHome };

struct State {
  Inputs inputs;
  Inputs before;  // inputs of the cycle before, for their edges
  Inputs rose;    // levels that rose in this cycle, also if they fell before or behind that
  Settings settings;
  std::array<std::uint32_t, kSlots> slots{};  // number of the machine's cam in each, from 1; 0: none
  ModuleState state = ModuleState::kInit;
  ErrorId error = ErrorId::kNone;
  ErrorId warning = ErrorId::kNone;
  Action action = Action::kNone;  // in progress
  Ticket action_ticket = 0;
  Action request = Action::kNone;  // asked for in this cycle
  Ticket request_ticket = 0;
  std::array<Ticket, kAdjustments> adjusting{};  // whose ramps are told when they end; 0: none
  bool done = false;
  bool holds = false;    // the slave's stop is the module's
  bool instant = false;  // the cam that is set is to be taken at once
  JogKeys jog;

  MasterState master;
  Way way;
  KinematicState x;       // over all cycles
  KinematicState wanted;  // of the slave by Y, over all turns
  ProfilerValue at;
  KinematicState y;       // Y and its derivatives over time
  bool assigned = false;  // X is the master's position
  ClutchState clutch;
  SequencerState sequencer;
  SequenceEntry entry;
  BoundsState bounds;
  std::array<PendingChange, kPendingChanges> pending;  // [0] is next
  std::uint8_t pending_count = 0;
  bool gap_known = false;  // between this cam and the next, in the cycle before (without_jump)
  double gap = 0;          // in place or slope
  std::uint32_t cam_ends = 0;
  bool end_of_profile = false;
};

void describe(Description<PendingChange>&);
void describe(Description<SequenceEntry>&);
void describe(Description<JogKeys>&);
void describe(Enumeration<Action>&);
void describe(Description<State>&);

}  // namespace takt::flexcam
