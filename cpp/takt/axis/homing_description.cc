#include "takt/axis/homing.h"
#include "takt/core/describe.h"

namespace takt::axis {

void describe(Enumeration<HomingStage>& e) {
  e.about("Stage of a homing step.");
  e.value(HomingStage::kNone, "none", "Not homing.");
  e.value(HomingStage::kSearching, "searching", "Moves at the search velocity.");
  e.value(HomingStage::kTurning, "turning", "Brakes, to search in the other direction.");
  e.value(HomingStage::kBraking, "braking", "Found: brakes.");
  e.value(HomingStage::kReturning, "returning", "Returns to the position found.");
  e.value(HomingStage::kLeaving, "leaving", "Finishing: moves away.");
  e.value(HomingStage::kWaiting, "waiting", "Stays in Homing for the next step.");
}

void describe(Enumeration<HomingEvent>& e) {
  e.about("Event in a homing step.");
  e.value(HomingEvent::kFound, "found", "The switch, edge, mark or end stop was found.");
  e.value(HomingEvent::kWrongEdge, "wrong_edge", "The switch changed in the opposite sense.");
  e.value(HomingEvent::kLimit, "limit", "The limit switch ahead is on.");
  e.value(HomingEvent::kNoCode, "no_code", "The distance between the marks is no code.");
  e.value(HomingEvent::kStopped, "stopped", "The motion of the stage is over.");
  e.value(HomingEvent::kTimeOver, "time_over", "TimeLimit was exceeded.");
  e.value(HomingEvent::kTooFar, "too_far",
          "DistanceLimit was exceeded, the search reversed too often, or a limit switch is ahead while followers still "
          "search.");
}

void describe(Enumeration<HomingAction>& e) {
  e.about("Action of a homing step at an event.");
  e.value(HomingAction::kBrake, "brake", "Brakes with the axis' full ramp.");
  e.value(HomingAction::kTurnRound, "turn_round", "Searches in the other direction.");
  e.value(HomingAction::kGoBack, "go_back", "Returns to the captured position.");
  e.value(HomingAction::kPause, "pause", "Done, but the axis stays in Homing.");
  e.value(HomingAction::kFinish, "finish", "Done, Standstill: the axis has its reference.");
  e.value(HomingAction::kGiveUp, "give_up", "Error; brakes to Standstill.");
}

void describe(Enumeration<HomingScope>& e) {
  e.about("Homing steps that a row of the table applies to.");
  e.value(HomingScope::kAll, "all", "All.");
  e.value(HomingScope::kSwitches, "switches", "MC_StepAbsSwitch and MC_StepLimitSwitch.");
  e.value(HomingScope::kBlock, "block", "MC_StepBlock.");
  e.value(HomingScope::kPulse, "pulse", "MC_StepRefPulse and MC_StepDistanceCoded.");
}

void describe(Description<HomingState>& d) {
  using H = HomingState;
  d.about("Homing of an axis and its reference.");
  d.internal<&H::stage>("Stage of the step in control.");
  d.internal<&H::homed>("The axis has its reference.");
  d.internal<&H::sense>("Sense of the search.");
  d.internal<&H::switch_before>("State of the searched switch in the previous cycle.");
  d.internal<&H::captured>(unit::u, "Position found.");
  d.internal<&H::renamed>(unit::u,
                          "Sum of the amounts that MC_SetPosition has added to positions since the reference was set.");
  d.internal<&H::mark>(unit::u, "Position of the coded mark that was passed last, over all turns.");
  d.internal<&H::mark_known>("A coded mark was passed.");
  d.internal<&H::turns>("Number of reversals.");
  d.internal<&H::way>(unit::u, "Distance travelled since the step began.");
  d.internal<&H::begin_cycle>("Cycle in which the step began.");
  d.internal<&H::found>("The axis' own switch was found.");
  d.internal<&H::edge>(unit::u, "Position of the switch, over all turns.");
  d.internal<&H::found_cycle>("Cycle in which the followers had found their switches, too.");
  d.internal<&H::flying_ticket>("Ticket of the command that searches a reference during another motion; 0: none.");
  d.internal<&H::flying_pulse>("That reference is the index pulse.");
  d.internal<&H::flying>("Search for that reference.");
  d.internal<&H::flying_way>(unit::u, "Distance travelled since that search began.");
  d.internal<&H::flying_begin>("Cycle in which that search began.");
  d.internal<&H::reference_before>("REF in the previous cycle.");
}

}  // namespace takt::axis
