// The state of a cam module: plain data, so that it can be copied, compared, hashed and replayed.
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

// How X entered the present cam of a sequence: a cam that X leaves again over the same end was not run.
struct SequenceEntry {
  std::int8_t sense = 0;    // of X at that end of the cam; 0: X began within the cam, or the cam is cyclic
  bool has_before = false;  // the members below hold the state that was left there
  ProfilerState profiler;
  SequencerState sequencer;
};

struct JogKeys {
  Ticket ticket = 0;  // 0: no key is held
  Jog keys;
  double lease_s = 0;  // [s] > 0: dead man's lease ...
  std::uint64_t lease_end_cycle = 0;
};

// Values that Control may change by a ramp.
enum class Adjustment : std::uint8_t { kOffsetMaster, kOffsetSlave, kScalingMaster, kScalingSlave };
inline constexpr std::size_t kAdjustments = 4;

// The action started by Control whose end is to be reported.
enum class Action : std::uint8_t { kNone, kSyncIn, kSyncOut, kHome };

struct State {
  Inputs inputs;
  Inputs before;  // inputs of the previous cycle, for their edges
  Inputs rose;    // levels that rose in this cycle, even if they fell before or after that
  Settings settings;
  std::array<std::uint32_t, kSlots> slots{};  // number of the machine's cam in each slot, from 1; 0: none
  ModuleState state = ModuleState::kInit;
  ErrorId error = ErrorId::kNone;
  ErrorId warning = ErrorId::kNone;
  Action action = Action::kNone;  // in progress
  Ticket action_ticket = 0;
  Action request = Action::kNone;  // requested in this cycle
  Ticket request_ticket = 0;
  std::array<Ticket, kAdjustments> adjusting{};  // commands whose ramps are reported when they end; 0: none
  bool done = false;
  bool holds = false;    // the slave's stop is held by the module
  bool instant = false;  // the selected cam is to be changed at once
  JogKeys jog;

  MasterState master;
  Way way;
  KinematicState x;       // over all cycles
  KinematicState wanted;  // position of the slave by Y, over all turns
  ProfilerValue at;
  KinematicState y;       // Y and its derivatives over time
  bool assigned = false;  // X is the master's position
  ClutchState clutch;
  SequencerState sequencer;
  SequenceEntry entry;
  BoundsState bounds;
  std::array<PendingChange, kPendingChanges> pending;  // [0] is next
  std::uint8_t pending_count = 0;
  bool gap_known = false;  // the gap between this cam and the next in the previous cycle is known (without_jump)
  double gap = 0;          // [y or y per x] in position or slope
  std::uint32_t cam_ends = 0;
  bool end_of_profile = false;
};

void describe(Description<PendingChange>&);
void describe(Description<SequenceEntry>&);
void describe(Description<JogKeys>&);
void describe(Enumeration<Action>&);
void describe(Description<State>&);

}  // namespace takt::flexcam
