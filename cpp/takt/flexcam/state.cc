#include "takt/flexcam/state.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

void describe(Description<PendingChange>& d) {
  d.about("A pending change of cam.");
  d.internal<&PendingChange::ticket>("Ticket of the command.");
  d.internal<&PendingChange::change>("The change and its event.");
}

void describe(Description<SequenceEntry>& d) {
  using E = SequenceEntry;
  d.about("Entry of X into the cam of a sequence.");
  d.internal<&E::sense>("Sense of X at the entry; 0: not at an end.");
  d.internal<&E::has_before>("The state that was left there is known.");
  d.internal<&E::profiler>("The cam that was left.");
  d.internal<&E::sequencer>("State of the sequence before.");
}

void describe(Description<JogKeys>& d) {
  d.about("Keys of a jog.");
  d.internal<&JogKeys::ticket>("Ticket of the command; 0: no key is held.");
  d.internal<&JogKeys::keys>("Keys that are held.");
  d.internal<&JogKeys::lease_s>(unit::s, "Dead man's lease; 0: none.");
  d.internal<&JogKeys::lease_end_cycle>("Cycle in which the lease ends.");
}

void describe(Enumeration<Action>& e) {
  e.about("Action that a change of inputs started.");
  e.value(Action::kNone, "none", "No action.");
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
  d.internal<&S::settings>("Settings in force.");
  d.internal<&S::slots>("Number of the cam in each slot, from 1; 0: none.");
  d.internal<&S::state>("State of the module.");
  d.internal<&S::error>("Error of the module.");
  d.internal<&S::warning>("Warning: a request was not carried out as set.");
  d.internal<&S::action>("Action that was started last.");
  d.internal<&S::action_ticket>("Ticket of the command that started it.");
  d.internal<&S::request>("Action requested in this cycle.");
  d.internal<&S::request_ticket>("Ticket of the command that requested it.");
  d.internal<&S::adjusting>("Tickets of offsets and factors that are being ramped.");
  d.internal<&S::holds>("The stop of the slave belongs to the module.");
  d.internal<&S::instant>("The cam that is set is to be started at once.");
  d.internal<&S::done>("The last request is done.");
  d.internal<&S::jog>("Keys of the jog.");
  d.internal<&S::master>("Master that is followed.");
  d.internal<&S::way>("Stages from the master to the slave.");
  d.internal<&S::x>("X over all cycles.");
  d.internal<&S::wanted>("Demand of Y on the slave, over all turns.");
  d.internal<&S::at>("Value of the cam.");
  d.internal<&S::y>("Y and its derivatives over time.");
  d.internal<&S::assigned>("X is the master's position.");
  d.internal<&S::clutch>("The clutch.");
  d.internal<&S::sequencer>("The sequence of cams.");
  d.internal<&S::entry>("Entry of X into its cam.");
  d.internal<&S::bounds>("Extreme values.");
  d.internal<&S::pending>("Pending changes of cam.");
  d.internal<&S::pending_count>("Number of pending changes.");
  d.internal<&S::gap_known>("The gap is known.");
  d.internal<&S::gap>("Distance between this cam and the next in the previous cycle.");
  d.internal<&S::cam_ends>("Number of ends of a cam that were passed.");
  d.internal<&S::end_of_profile>("The end of the cam is passed next.");
}

}  // namespace takt::flexcam
