#include "takt/pickplace/state.h"

#include "takt/core/describe.h"

namespace takt::pickplace {

void describe(Enumeration<Phase>& e) {
  e.about("Where an order has got to.");
  e.value(Phase::kNew, "new", "Nothing of it is given to the group.");
  e.value(Phase::kWaiting, "waiting", "It waits for a workpiece.");
  e.value(Phase::kGoing, "going", "Its moves are given.");
  e.value(Phase::kStaying, "staying", "On the workpiece.");
  e.value(Phase::kHeld, "held", "Its path was left.");
}

void describe(Description<Order>& d) {
  d.named("PickPlaceOrder");
  d.about("A target that was accepted.");
  d.internal<&Order::ticket>("Of the command.");
  d.internal<&Order::belt>("Which one; 0: static.");
  d.internal<&Order::picks>("A workpiece is picked there.");
  d.internal<&Order::target>("Static.");
  d.internal<&Order::start>("Where it began.");
  d.internal<&Order::shape>("How its profile runs.");
  d.internal<&Order::own>("Of the belt.");
  d.internal<&Order::ramps>("Limits along it.");
  d.internal<&Order::rule>("Which workpiece.");
  d.internal<&Order::gripper_time>("Before its end.");
  d.internal<&Order::phase>("Where it has got to.");
  d.internal<&Order::profile>("Its moves.");
  d.internal<&Order::next_leg>("The first one given.");
  d.internal<&Order::first>("Number of its first move.");
  d.internal<&Order::last>("Number of its last one.");
  d.internal<&Order::workpiece>("That is taken; 0: none.");
  d.internal<&Order::attributes>("Of it.");
  d.internal<&Order::from_belt>("It began on a workpiece, or low over a belt.");
  d.internal<&Order::begin_cycle>("When it began.");
  d.internal<&Order::stay_cycle>("When it arrived.");
  d.internal<&Order::expected_s>("So long the way was thought to take.");
  d.internal<&Order::gripper_off>("It was stopped, or the override changed.");
  d.internal<&Order::pulse_at_end>("It was interrupted.");
  d.internal<&Order::pulsed>("The gripper has got its pulse.");
}

void describe(Description<LeftWorkpiece>& d) {
  d.named("PickPlaceLeftWorkpiece");
  d.about("A workpiece that was taken and left behind.");
  d.internal<&LeftWorkpiece::belt>("Its belt, from 1.");
  d.internal<&LeftWorkpiece::number>("Its number there.");
  d.internal<&LeftWorkpiece::refused>("There was no path to it; else the path was stopped.");
  d.internal<&LeftWorkpiece::counted>("As missed.");
}

void describe(Description<Loop>& d) {
  d.named("PickPlaceLoop");
  d.about("A tracking mode that goes round and round.");
  d.internal<&Loop::active>("It does.");
  d.internal<&Loop::ends>("Behind the order that is gone.");
  d.internal<&Loop::places>("The next order is to place.");
  d.internal<&Loop::ticket>("Of the command.");
  d.internal<&Loop::mode>("Which one.");
  d.internal<&Loop::pick_belt>("0: static.");
  d.internal<&Loop::place_belt>("0: static.");
}

void describe(Description<JogKeys>& d) {
  d.named("PickPlaceJogKeys");
  d.about("Keys of a jog.");
  d.internal<&JogKeys::ticket>("Of the command; 0: none is held.");
  d.internal<&JogKeys::keys>("Which ones are held.");
  d.internal<&JogKeys::lease_s>("Of the dead man; 0: none.");
  d.internal<&JogKeys::lease_end_cycle>("When it runs out.");
}

void describe(Description<Hold>& d) {
  d.named("PickPlaceHold");
  d.about("A path that was left.");
  d.internal<&Hold::held>("It can be gone on with.");
  d.internal<&Hold::off>("The tool was moved away.");
  d.internal<&Hold::returning>("It moves back.");
  d.internal<&Hold::ticket>("Of the way back.");
  d.internal<&Hold::pose>("Where it was left, in the MCS.");
  d.internal<&Hold::aux1>("Of the auxiliary axis there.");
  d.internal<&Hold::legs>("Legs of the order that were done there.");
  d.internal<&Hold::move>("Number of the way back.");
}

void describe(Description<HomingState>& d) {
  d.named("PickPlaceHomingState");
  d.about("Homing in order.");
  d.internal<&HomingState::ticket>("Of the command.");
  d.internal<&HomingState::place>("In the order: these look.");
}

void describe(Description<EndPredictor>& d) {
  d.named("PickPlaceScout");
  d.about("Goes ahead of the group.");
  d.internal<&EndPredictor::known>("When the profile ends.");
  d.internal<&EndPredictor::end_cycle>("Then.");
  d.internal<&EndPredictor::running>("It goes.");
  d.internal<&EndPredictor::order_last>("Number of the move that it looks for.");
  d.internal<&EndPredictor::cycle>("Where it has got to.");
  d.internal<&EndPredictor::pace>("Along the path.");
}

void describe(Description<State>& d) {
  d.named("PickPlaceState");
  d.about("A pick and place module.");
  d.internal<&State::inputs>("Levels of this cycle.");
  d.internal<&State::before>("Levels of the cycle before.");
  d.internal<&State::settings>("What is set.");
  d.internal<&State::belts>("What is set of belts.");
  d.internal<&State::state>("Of the module.");
  d.internal<&State::back>("From a jog.");
  d.internal<&State::error>("Why it is in error.");
  d.internal<&State::warning>("What was not done as asked.");
  d.internal<&State::error_axes>("Axes that the module stopped for, a mask.");
  d.internal<&State::reset>("Edge of this cycle.");
  d.internal<&State::abort>("Edge of this cycle.");
  d.internal<&State::ack>("Edge of this cycle.");
  d.internal<&State::done>("What was asked for last.");
  d.internal<&State::halting>("The group comes to rest because of the module.");
  d.internal<&State::enables>("The group, once its axes stand.");
  d.internal<&State::powers>("The group, once it is no longer being switched off.");
  d.internal<&State::orders>("The first one is gone.");
  d.internal<&State::order_count>("How many.");
  d.internal<&State::loop>("A tracking mode.");
  d.internal<&State::at_known>("Where the moves given end.");
  d.internal<&State::at>("There.");
  d.internal<&State::at_distance>("Up from there.");
  d.internal<&State::at_belt>("On a workpiece of that belt.");
  d.internal<&State::low>("The next profile rises first.");
  d.internal<&State::over>("As high as this.");
  d.internal<&State::may_be_low>("The tool is low over a belt, or will be at rest.");
  d.internal<&State::over_now>("Lower than this.");
  d.internal<&State::parked_at>("The parking position of that belt.");
  d.internal<&State::parking>("On the way there.");
  d.internal<&State::parking_move>("Number of the move.");
  d.internal<&State::parking_lifts>("It begins on a belt.");
  d.internal<&State::parking_over>("Up to here.");
  d.internal<&State::lifting>("In step, before the tool leaves the belt.");
  d.internal<&State::rises>("While it is still braked.");
  d.internal<&State::lifting_ramps>("Of the rest of the way up.");
  d.internal<&State::given>("Number of the next move.");
  d.internal<&State::second_pcs>("The second one is next.");
  d.internal<&State::hold>("A path that was left.");
  d.internal<&State::jog>("Keys.");
  d.internal<&State::jog_sense>("1 or -1.");
  d.internal<&State::jog_axis>("That moves.");
  d.internal<&State::jog_end>("SW limits at which it ends.");
  d.internal<&State::jog_released>("Its move was halted because its key was released.");
  d.internal<&State::homing>("Homing.");
  d.internal<&State::override_given>("To the group.");
  d.internal<&State::pulse>("Of the gripper.");
  d.internal<&State::scout>("Ahead of the group.");
  d.internal<&State::next_scout>("Ahead of that, on the next profile.");
  d.internal<&State::profile_time>("Of the profile.");
  d.internal<&State::preparation_time>("Of the path.");
  d.internal<&State::prepare_cycle>("When it began.");
  d.internal<&State::slowness>("The real time of profiles to the expected one.");
  d.internal<&State::searched>("The workpiece that was tried last.");
  d.internal<&State::out_of_window>("Cycles left.");
  d.internal<&State::in_target>("The target is reached.");
  d.internal<&State::counters>("Of workpieces.");
  d.internal<&State::held>("Of what was picked and is not placed yet.");
  d.internal<&State::held_count>("How many.");
  d.internal<&State::warning_belt>("That the warning is about; 0: none.");
  d.internal<&State::left>("Workpieces that were taken and left behind.");
  d.internal<&State::left_count>("How many.");
  d.internal<&State::refused_before>("Of the belts.");
  d.internal<&State::pick_cycles>("Of the last picks.");
  d.internal<&State::pick_count>("So many.");
  d.internal<&State::lost_before>("Of the belts.");
  d.internal<&State::taken_cycle>("When a workpiece of each belt was taken last.");
  d.internal<&State::illegal_transitions>("Always 0: the state table holds.");
}

}  // namespace takt::pickplace
