// Finding the reference of an axis (PLCopen Part 5): a search in stages, defined by a table.
#pragma once

#include <array>
#include <cstdint>

#include "takt/axis/request.h"
#include "takt/core/feedback.h"

namespace takt::axis {

struct Context;
struct State;

enum class HomingStage : std::uint8_t {
  kNone,       // not homing
  kSearching,  // moves at the search velocity
  kTurning,    // brakes, to search in the other direction
  kBraking,    // found: brakes
  kReturning,  // returns to the position found
  kLeaving,    // finishing: moves away
  kWaiting,    // for the next step; the axis stays in Homing
};

enum class HomingEvent : std::uint8_t {
  kFound,      // the switch, edge, mark or end stop of the step
  kWrongEdge,  // the switch changed in the opposite sense
  kNoCode,     // the distance between the marks is no code (StepDistanceCoded)
  kLimit,      // the limit switch ahead is on (steps that search a switch)
  kStopped,    // the motion of the stage is over
  kTimeOver,   // TimeLimit
  kTooFar,     // DistanceLimit, too many reversals, or a limit switch ahead while followers still search
};

enum class HomingAction : std::uint8_t {
  kBrake,      // with the axis' full ramp
  kTurnRound,  // search in the other direction
  kGoBack,     // to the captured position
  kPause,      // done, but the axis stays in Homing
  kFinish,     // done, Standstill, the axis has its reference
  kGiveUp,     // error, brake to Standstill
};

// The steps that a row applies to.
enum class HomingScope : std::uint8_t { kAll, kSwitches, kBlock, kPulse };

struct HomingRow {
  HomingStage from;
  HomingEvent event;
  HomingScope scope;
  HomingAction action;
  HomingStage to;
};

inline constexpr std::array kHomingTable = {
    HomingRow{HomingStage::kSearching, HomingEvent::kFound, HomingScope::kAll, HomingAction::kBrake,
              HomingStage::kBraking},
    HomingRow{HomingStage::kSearching, HomingEvent::kWrongEdge, HomingScope::kSwitches, HomingAction::kBrake,
              HomingStage::kTurning},
    HomingRow{HomingStage::kSearching, HomingEvent::kLimit, HomingScope::kSwitches, HomingAction::kBrake,
              HomingStage::kTurning},
    HomingRow{HomingStage::kSearching, HomingEvent::kNoCode, HomingScope::kPulse, HomingAction::kGiveUp,
              HomingStage::kNone},
    HomingRow{HomingStage::kSearching, HomingEvent::kTimeOver, HomingScope::kAll, HomingAction::kGiveUp,
              HomingStage::kNone},
    HomingRow{HomingStage::kSearching, HomingEvent::kTooFar, HomingScope::kAll, HomingAction::kGiveUp,
              HomingStage::kNone},
    HomingRow{HomingStage::kTurning, HomingEvent::kStopped, HomingScope::kSwitches, HomingAction::kTurnRound,
              HomingStage::kSearching},
    HomingRow{HomingStage::kTurning, HomingEvent::kTimeOver, HomingScope::kSwitches, HomingAction::kGiveUp,
              HomingStage::kNone},
    HomingRow{HomingStage::kTurning, HomingEvent::kTooFar, HomingScope::kSwitches, HomingAction::kGiveUp,
              HomingStage::kNone},
    HomingRow{HomingStage::kBraking, HomingEvent::kStopped, HomingScope::kSwitches, HomingAction::kGoBack,
              HomingStage::kReturning},
    HomingRow{HomingStage::kBraking, HomingEvent::kStopped, HomingScope::kBlock, HomingAction::kGoBack,
              HomingStage::kReturning},
    HomingRow{HomingStage::kBraking, HomingEvent::kStopped, HomingScope::kPulse, HomingAction::kFinish,
              HomingStage::kNone},
    HomingRow{HomingStage::kReturning, HomingEvent::kStopped, HomingScope::kSwitches, HomingAction::kPause,
              HomingStage::kWaiting},
    HomingRow{HomingStage::kReturning, HomingEvent::kStopped, HomingScope::kBlock, HomingAction::kFinish,
              HomingStage::kNone},
    HomingRow{HomingStage::kLeaving, HomingEvent::kStopped, HomingScope::kAll, HomingAction::kFinish,
              HomingStage::kNone},
};

struct HomingState {
  HomingStage stage = HomingStage::kNone;
  bool homed = false;          // the axis has its reference
  std::int8_t sense = 1;       // of the search
  bool switch_before = false;  // state of the switch in the previous cycle
  double captured = 0;         // [u] position found
  double renamed = 0;          // [u] sum of what MC_SetPosition has added to positions since the reference was set
  double mark = 0;             // [u] over all turns: the coded mark that was passed last
  bool mark_known = false;     // a mark was passed
  std::uint8_t turns = 0;      // number of reversals
  double way = 0;              // [u] distance travelled since the step began
  std::uint64_t begin_cycle = 0;
  bool found = false;             // its own switch was found; followers may still search theirs
  double edge = 0;                // [u] over all turns: position of the switch
  std::uint64_t found_cycle = 0;  // in which all switches were found

  // References taken in passing, during another motion.
  Ticket flying_ticket = 0;   // 0: none
  bool flying_pulse = false;  // the index pulse; else the reference switch
  HomingRequest flying;
  double flying_way = 0;
  std::uint64_t flying_begin = 0;
  bool reference_before = false;
};

// Returns true for homing steps.
bool Homes(RequestKind kind) noexcept;
// Returns true if a request may take over between two steps: a further step, a stop or power.
bool MayFollowStep(RequestKind kind) noexcept;
// Begins a step from rest, in Standstill or between two steps. `aborts`: the command in control and buffered ones are
// aborted first. Returns kState if the axis is in another state or cannot do the step, kAwayFromLimitOnly if the
// limit switch ahead is on and the step cannot turn round, kDirection, kNoCodedMarks, or kTargetBehindLimit.
Status BeginHoming(const Context& c, const Request& r, bool aborts, State& s) noexcept;
// Handles the events of the step in control; each cycle, after the set point.
void StepHoming(const Context& c, State& s) noexcept;
// Looks for a reference in passing (flying_ticket); each cycle, before the set point.
void WatchFlying(const Context& c, State& s) noexcept;
// Returns true if this state or edge of a switch ends the search.
bool EndsSearch(SwitchMode mode, bool on, bool before, int sense) noexcept;
// Returns true while limit switches are part of the search, so that they are no fault.
bool OwnsLimitSwitches(const State& s) noexcept;
// Returns true while the axis is meant to lag, as it pushes against an end stop, so that the lag is no fault.
bool OwnsLag(const State& s) noexcept;

Status CarryOut(const Context& c, Ticket ticket, const StepRefFlyingSwitch& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const StepRefFlyingRefPulse& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const AbortPassiveHoming& command, State& s) noexcept;
// Ends a reference in passing that a halt or stop ends (`until_halt`).
void EndFlyingByHalt(const Context& c, State& s) noexcept;

void describe(Enumeration<HomingStage>&);
void describe(Enumeration<HomingEvent>&);
void describe(Enumeration<HomingAction>&);
void describe(Enumeration<HomingScope>&);
void describe(Description<HomingState>&);

}  // namespace takt::axis
