#include "takt/axis/homing.h"
#include "takt/core/describe.h"

namespace takt::axis {

void describe(Enumeration<HomingStage>& e) {
  e.about("How far a homing step has come.");
  e.value(HomingStage::kNone, "none", "Not homing.");
  e.value(HomingStage::kSearching, "searching", "On the way at the search velocity.");
  e.value(HomingStage::kTurning, "turning", "Brakes to search the other way.");
  e.value(HomingStage::kBraking, "braking", "Found: brakes.");
  e.value(HomingStage::kReturning, "returning", "Goes back to what was found.");
  e.value(HomingStage::kLeaving, "leaving", "Finishing: moves off.");
  e.value(HomingStage::kWaiting, "waiting", "Stays in Homing for the next step.");
}

void describe(Enumeration<HomingEvent>& e) {
  e.about("What can happen in a homing step.");
  e.value(HomingEvent::kFound, "found", "What it looks for.");
  e.value(HomingEvent::kWrongEdge, "wrong_edge", "The switch changed the other way.");
  e.value(HomingEvent::kLimit, "limit", "A limit switch lies ahead.");
  e.value(HomingEvent::kNoCode, "no_code", "Marks whose distance is no code.");
  e.value(HomingEvent::kStopped, "stopped", "The motion of the stage is over.");
  e.value(HomingEvent::kTimeOver, "time_over", "TimeLimit.");
  e.value(HomingEvent::kTooFar, "too_far", "DistanceLimit.");
}

void describe(Enumeration<HomingAction>& e) {
  e.about("What a homing step does then.");
  e.value(HomingAction::kBrake, "brake", "Brakes with the axis' full ramp.");
  e.value(HomingAction::kTurnRound, "turn_round", "Searches in the other direction.");
  e.value(HomingAction::kGoBack, "go_back", "Goes to the captured position.");
  e.value(HomingAction::kPause, "pause", "Done, but the axis stays in Homing.");
  e.value(HomingAction::kFinish, "finish", "Done, Standstill: the axis has its reference.");
  e.value(HomingAction::kGiveUp, "give_up", "Error; brakes to Standstill.");
}

void describe(Enumeration<HomingScope>& e) {
  e.about("Which homing steps a row of the table holds for.");
  e.value(HomingScope::kAll, "all", "All.");
  e.value(HomingScope::kSwitches, "switches", "MC_StepAbsSwitch and MC_StepLimitSwitch.");
  e.value(HomingScope::kBlock, "block", "MC_StepBlock.");
  e.value(HomingScope::kPulse, "pulse", "MC_StepRefPulse and MC_StepDistanceCoded.");
}

void describe(Description<HomingState>& d) {
  using H = HomingState;
  d.about("An axis and its reference.");
  d.internal<&H::stage>("Of the step in control.");
  d.internal<&H::homed>("It has its reference.");
  d.internal<&H::sense>("Of the search.");
  d.internal<&H::switch_before>("The switch that is searched, a cycle ago.");
  d.internal<&H::captured>(unit::u, "Where it was found.");
  d.internal<&H::renamed>(unit::u, "What MC_SetPosition has added to positions since the reference got its own.");
  d.internal<&H::mark>(unit::u, "Coded mark that was passed last, over all turns.");
  d.internal<&H::mark_known>("One was passed.");
  d.internal<&H::turns>("How often it turned round.");
  d.internal<&H::way>(unit::u, "Gone since the step began.");
  d.internal<&H::begin_cycle>("When it began.");
  d.internal<&H::found>("Its switch was found.");
  d.internal<&H::edge>(unit::u, "Where, over all turns.");
  d.internal<&H::found_cycle>("When the followers had found their switches, too.");
  d.internal<&H::flying_ticket>("Of the reference awaited in passing.");
  d.internal<&H::flying_pulse>("From the index pulse.");
  d.internal<&H::flying>("What is awaited.");
  d.internal<&H::flying_way>(unit::u, "Gone since then.");
  d.internal<&H::flying_begin>("Since when.");
  d.internal<&H::reference_before>("REF a cycle ago.");
}

}  // namespace takt::axis
