// Finding the reference of an axis (PLCopen Part 5): a search in stages, as one table says.
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
  kSearching,  // on the way, at the search velocity
  kTurning,    // brakes, to search the other way
  kBraking,    // found: brakes
  kReturning,  // goes back to what was found
  kLeaving,    // finishing: moves off
  kWaiting,    // for the next step; the axis stays in Homing
};

enum class HomingEvent : std::uint8_t {
  kFound,      // what the step is looking for
  kWrongEdge,  // the switch changed the other way
  kNoCode,     // marks whose distance is no code (StepDistanceCoded)
  kLimit,      // a limit switch lies ahead (StepAbsSwitch)
  kStopped,    // the motion of the stage is over
  kTimeOver,   // TimeLimit
  kTooFar,     // DistanceLimit
};

enum class HomingAction : std::uint8_t {
  kBrake,      // with the axis' full ramp
  kTurnRound,  // search in the other direction
  kGoBack,     // to the captured position
  kPause,      // done, but the axis stays in Homing
  kFinish,     // done, Standstill, the axis has its reference
  kGiveUp,     // error, brake to Standstill
};

// Which steps a row holds for.
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
  bool switch_before = false;  // the switch that is searched, a cycle ago
  double captured = 0;         // u, where it was found
  double renamed = 0;          // u, what MC_SetPosition has added to positions since the reference got its own
  double mark = 0;             // u, over all turns: the coded mark that was passed last ...
  bool mark_known = false;     // ... if one was
  std::uint8_t turns = 0;      // how often it turned round
  double way = 0;              // u, gone since the step began
  std::uint64_t begin_cycle = 0;
  bool found = false;             // its switch; its followers still look for their own
  double edge = 0;                // u, over all turns: where it was
  std::uint64_t found_cycle = 0;  // in which all switches were found

  // References taken while another motion goes on.
  Ticket flying_ticket = 0;   // 0: none is awaited
  bool flying_pulse = false;  // the index pulse; else the reference switch
  HomingRequest flying;
  double flying_way = 0;
  std::uint64_t flying_begin = 0;
  bool reference_before = false;
};

bool Homes(RequestKind kind) noexcept;
// Between two steps nothing else takes over but a further step, stop and power.
bool MayFollowStep(RequestKind kind) noexcept;
// Begins a step from rest, in Standstill or between two steps; `aborts`: what is in control and what waits is aborted
// first. kState: not from here. kAwayFromLimitOnly: that way is a limit switch, and the step searches none.
Status BeginHoming(const Context& c, const Request& r, bool aborts, State& s) noexcept;
// Each cycle after the set point was made: events of the step in control.
void StepHoming(const Context& c, State& s) noexcept;
// Each cycle in which a reference is awaited in passing (flying_ticket), before the set point is made.
void WatchFlying(const Context& c, State& s) noexcept;
// Whether this state or edge of a switch is what the search is for.
bool EndsSearch(SwitchMode mode, bool on, bool before, int sense) noexcept;
// The limit switches belong to the search for now: no fault.
bool OwnsLimitSwitches(const State& s) noexcept;
// The axis is meant to lag behind, pushing against an end stop: no fault.
bool OwnsLag(const State& s) noexcept;

Status CarryOut(const Context& c, Ticket ticket, const StepRefFlyingSwitch& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const StepRefFlyingRefPulse& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const AbortPassiveHoming& command, State& s) noexcept;
// A halt or stop has been given.
void EndFlyingByHalt(const Context& c, State& s) noexcept;

void describe(Enumeration<HomingStage>&);
void describe(Enumeration<HomingEvent>&);
void describe(Enumeration<HomingAction>&);
void describe(Enumeration<HomingScope>&);
void describe(Description<HomingState>&);

}  // namespace takt::axis
