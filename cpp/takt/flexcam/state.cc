#include "takt/flexcam/state.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

void describe(Description<PendingChange>& d) {
  d.about("A change of cam that waits.");
  d.internal<&PendingChange::ticket>("Of the command.");
  d.internal<&PendingChange::change>("What is to change, and when.");
}

void describe(Description<SequenceEntry>& d) {
  using E = SequenceEntry;
  d.about("How X came into the cam of a sequence.");
  d.internal<&E::sense>("Of X then; 0: not at an end.");
  d.internal<&E::has_before>("What was left there is known.");
  d.internal<&E::profiler>("The cam that was left.");
  d.internal<&E::sequencer>("Where the sequence was.");
}

void describe(Description<JogKeys>& d) {
  d.about("Keys of a jog.");
  d.internal<&JogKeys::ticket>("Of the command; 0: none is held.");
  d.internal<&JogKeys::keys>("Which ones are held.");
  d.internal<&JogKeys::lease_s>(unit::s, "Of the dead man; 0: none.");
  d.internal<&JogKeys::lease_end_cycle>("When it runs out.");
}

void describe(Enumeration<Action>& e) {
  e.about("What a change of inputs started.");
  e.value(Action::kNone, "none", "Nothing.");
  e.value(Action::kSyncIn, "sync_in", "The clutch closes.");
  e.value(Action::kSyncOut, "sync_out", "The clutch opens.");
  e.value(Action::kHome, "home", "Homing.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("A cam module.");
  d.internal<&S::inputs>("Levels of this cycle.");
  d.internal<&S::before>("Levels of the cycle before.");
  d.internal<&S::rose>("Levels that rose in this cycle.");
  d.internal<&S::settings>("What is set.");
  d.internal<&S::slots>("Number of the cam in each slot, from 1; 0: none.");
  d.internal<&S::state>("Of the module.");
  d.internal<&S::error>("Why it is in error.");
  d.internal<&S::warning>("What was not done as asked.");
  d.internal<&S::action>("What was started last.");
  d.internal<&S::action_ticket>("Of the command that did.");
  d.internal<&S::request>("What was asked for in this cycle.");
  d.internal<&S::request_ticket>("Of the command that did.");
  d.internal<&S::adjusting>("Tickets of offsets and factors that are ramped.");
  d.internal<&S::holds>("The slave's stop is the module's.");
  d.internal<&S::instant>("The cam that is set is to be taken at once.");
  d.internal<&S::done>("It is done.");
  d.internal<&S::jog>("Jogging.");
  d.internal<&S::master>("What is followed.");
  d.internal<&S::way>("Stages from there to the slave.");
  d.internal<&S::x>("X over all cycles.");
  d.internal<&S::wanted>("Where Y wants the slave, over all turns.");
  d.internal<&S::at>("What the cam says.");
  d.internal<&S::y>("The same over time.");
  d.internal<&S::assigned>("X is the master's position.");
  d.internal<&S::clutch>("The clutch.");
  d.internal<&S::sequencer>("The sequence of cams.");
  d.internal<&S::entry>("How X came into its cam.");
  d.internal<&S::bounds>("Extreme values.");
  d.internal<&S::pending>("Changes of cam that wait.");
  d.internal<&S::pending_count>("How many.");
  d.internal<&S::gap_known>("The gap is known.");
  d.internal<&S::gap>("Between this cam and the next, in the cycle before.");
  d.internal<&S::cam_ends>("How often the end of a cam was passed.");
  d.internal<&S::end_of_profile>("The end is passed next.");
}

}  // namespace takt::flexcam
