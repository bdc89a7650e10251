#include "takt/pickplace/state.h"

#include "takt/core/describe.h"

namespace takt::pickplace {

void describe(Enumeration<Phase>& e) {
  e.about("Progress of an order.");
  e.value(Phase::kNew, "new", "No moves have been given to the group.");
  e.value(Phase::kWaiting, "waiting", "Waiting for a workpiece.");
  e.value(Phase::kGoing, "going", "The moves have been given.");
  e.value(Phase::kStaying, "staying", "On the workpiece.");
  e.value(Phase::kHeld, "held", "The path was left.");
}

void describe(Description<Order>& d) {
  d.named("PickPlaceOrder");
  d.about("A target that was accepted.");
  d.internal<&Order::ticket>("Ticket of the command.");
  d.internal<&Order::belt>("Number of the belt; 0: static target.");
  d.internal<&Order::picks>("A workpiece is picked at the target.");
  d.internal<&Order::target>("Static target.");
  d.internal<&Order::start>("Start of the profile.");
  d.internal<&Order::shape>("Parameters of the profile.");
  d.internal<&Order::own>("Settings of the belt.");
  d.internal<&Order::ramps>("Limits along the profile.");
  d.internal<&Order::rule>("Choice of the workpiece.");
  d.internal<&Order::gripper_time>("Time from the gripper's pulse to the end.");
  d.internal<&Order::phase>("Progress.");
  d.internal<&Order::profile>("Moves of the profile.");
  d.internal<&Order::next_leg>("First leg that was given.");
  d.internal<&Order::first>("Number of the first move.");
  d.internal<&Order::last>("Number of the last move.");
  d.internal<&Order::workpiece>("Number of the taken workpiece; 0: none.");
  d.internal<&Order::attributes>("Attributes of the workpiece.");
  d.internal<&Order::from_belt>("It began on a workpiece, or low over a belt.");
  d.internal<&Order::begin_cycle>("Cycle of the beginning.");
  d.internal<&Order::stay_cycle>("Cycle of the arrival.");
  d.internal<&Order::expected_s>("Estimated duration.");
  d.internal<&Order::gripper_off>("Stopped, or changed by the override: no pulse for the gripper.");
  d.internal<&Order::pulse_at_end>("Interrupted: the pulse for the gripper follows at the end.");
  d.internal<&Order::pulsed>("The gripper has received its pulse.");
}

void describe(Description<LeftWorkpiece>& d) {
  d.named("PickPlaceLeftWorkpiece");
  d.about("A workpiece that was taken and left behind.");
  d.internal<&LeftWorkpiece::belt>("Number of its belt, from 1.");
  d.internal<&LeftWorkpiece::number>("Number on the belt.");
  d.internal<&LeftWorkpiece::refused>("There was no path to it; else the path was stopped.");
  d.internal<&LeftWorkpiece::counted>("It has been counted as missed.");
}

void describe(Description<Loop>& d) {
  d.named("PickPlaceLoop");
  d.about("A tracking mode that repeats.");
  d.internal<&Loop::active>("The mode is active.");
  d.internal<&Loop::ends>("It ends after the current order.");
  d.internal<&Loop::places>("The next order places.");
  d.internal<&Loop::ticket>("Ticket of the command.");
  d.internal<&Loop::mode>("Tracking mode.");
  d.internal<&Loop::pick_belt>("Belt to pick from; 0: static target.");
  d.internal<&Loop::place_belt>("Belt to place on; 0: static target.");
}

void describe(Description<JogKeys>& d) {
  d.named("PickPlaceJogKeys");
  d.about("Keys of a jog.");
  d.internal<&JogKeys::ticket>("Ticket of the command; 0: no key is held.");
  d.internal<&JogKeys::keys>("Held keys.");
  d.internal<&JogKeys::lease_s>("Lease of a dead man's key; 0: none.");
  d.internal<&JogKeys::lease_end_cycle>("Cycle in which the lease ends.");
}

void describe(Description<Hold>& d) {
  d.named("PickPlaceHold");
  d.about("A path that was left.");
  d.internal<&Hold::held>("The path can be continued.");
  d.internal<&Hold::off>("The tool was moved away from the path.");
  d.internal<&Hold::returning>("The tool returns to the path.");
  d.internal<&Hold::ticket>("Ticket of the return.");
  d.internal<&Hold::pose>("Pose where the path was left, in the MCS.");
  d.internal<&Hold::aux1>("Position of the auxiliary axis there.");
  d.internal<&Hold::legs>("Legs of the order that were done there.");
  d.internal<&Hold::move>("Number of the move that returns.");
}

void describe(Description<HomingState>& d) {
  d.named("PickPlaceHomingState");
  d.about("State of homing in the given order.");
  d.internal<&HomingState::ticket>("Ticket of the command.");
  d.internal<&HomingState::place>("Number in the homing order of the axes that are homing.");
}

void describe(Description<EndPredictor>& d) {
  d.named("PickPlaceScout");
  d.about("Prediction of the end of a profile, ahead of the group.");
  d.internal<&EndPredictor::known>("The end of the profile is known.");
  d.internal<&EndPredictor::end_cycle>("Cycle of that end.");
  d.internal<&EndPredictor::running>("The prediction is running.");
  d.internal<&EndPredictor::order_last>("Number of the move whose end is predicted.");
  d.internal<&EndPredictor::cycle>("Cycle that the prediction has reached.");
  d.internal<&EndPredictor::pace>("Predicted motion along the path.");
}

void describe(Description<State>& d) {
  d.named("PickPlaceState");
  d.about("State of a pick and place module.");
  d.internal<&State::inputs>("Inputs of this cycle.");
  d.internal<&State::before>("Inputs of the previous cycle.");
  d.internal<&State::settings>("Settings of the module.");
  d.internal<&State::belts>("Settings of the belts.");
  d.internal<&State::state>("State of the module.");
  d.internal<&State::back>("State after a jog.");
  d.internal<&State::error>("Reason for the error state.");
  d.internal<&State::warning>("Reason why a request was not carried out as given.");
  d.internal<&State::error_axes>("Axes for which the module stopped, a mask.");
  d.internal<&State::reset>("Rising edge of reset_error in this cycle.");
  d.internal<&State::abort>("Rising edge of abort in this cycle.");
  d.internal<&State::ack>("Rising edge of ack_gripper in this cycle.");
  d.internal<&State::done>("The last request is done.");
  d.internal<&State::halting>("The group comes to rest by command of the module.");
  d.internal<&State::enables>("The group will be enabled once its axes are on and at rest.");
  d.internal<&State::powers>("The group will be powered once it is no longer being switched off.");
  d.internal<&State::orders>("Accepted targets; the first one is current.");
  d.internal<&State::order_count>("Number of accepted targets.");
  d.internal<&State::loop>("Tracking mode.");
  d.internal<&State::at_known>("The end of the moves given so far is known.");
  d.internal<&State::at>("End of the moves given so far.");
  d.internal<&State::at_distance>("Distance up from there.");
  d.internal<&State::at_belt>("Belt of the workpiece there; 0: static target.");
  d.internal<&State::low>("The next profile has to rise first.");
  d.internal<&State::over>("Position to which it rises.");
  d.internal<&State::may_be_low>("The tool is low over a belt, or will be at rest.");
  d.internal<&State::over_now>("Position below which it is low.");
  d.internal<&State::parked_at>("Belt whose parking position is taken; 0: none.");
  d.internal<&State::parking>("The tool moves to the parking position.");
  d.internal<&State::parking_move>("Number of the move to the parking position.");
  d.internal<&State::parking_lifts>("The move to the parking position begins on a belt.");
  d.internal<&State::parking_over>("Position up to which it lifts.");
  d.internal<&State::lifting>("The tool lifts in sync, before it leaves the belt.");
  d.internal<&State::rises>("The tool lifts while it is still being braked.");
  d.internal<&State::lifting_ramps>("Limits of the rest of the lift.");
  d.internal<&State::given>("Number of the next move.");
  d.internal<&State::second_pcs>("The second product coordinate system is assigned next.");
  d.internal<&State::hold>("Path that was left.");
  d.internal<&State::jog>("Keys of a jog.");
  d.internal<&State::jog_sense>("Direction of the jog: 1 or -1.");
  d.internal<&State::jog_axis>("Axis that the jog moves.");
  d.internal<&State::jog_end>("SW limits at which the jog ends.");
  d.internal<&State::jog_released>("The move was halted because its key was released.");
  d.internal<&State::homing>("State of homing.");
  d.internal<&State::override_given>("Override given to the group.");
  d.internal<&State::pulse>("Pulse of the gripper.");
  d.internal<&State::scout>("Prediction of the current profile.");
  d.internal<&State::next_scout>("Prediction of the next profile.");
  d.internal<&State::profile_time>("Duration of the profile.");
  d.internal<&State::preparation_time>("Time of preparation of the path.");
  d.internal<&State::prepare_cycle>("Cycle in which the preparation began.");
  d.internal<&State::slowness>("Ratio of the real duration of profiles to the estimated one.");
  d.internal<&State::searched>("Number of the workpiece that was tried last.");
  d.internal<&State::out_of_window>("Cycles left until the actual tool counts as in position.");
  d.internal<&State::in_target>("The target is reached.");
  d.internal<&State::counters>("Counts of workpieces.");
  d.internal<&State::held>("Attributes of products picked and not placed yet.");
  d.internal<&State::held_count>("Number of products picked and not placed yet.");
  d.internal<&State::warning_belt>("Belt that the warning refers to; 0: none.");
  d.internal<&State::left>("Workpieces that were taken and left behind.");
  d.internal<&State::left_count>("Number of workpieces left behind.");
  d.internal<&State::refused_before>("Objects refused by each belt so far.");
  d.internal<&State::pick_cycles>("Cycles of the last picks.");
  d.internal<&State::pick_count>("Number of picks.");
  d.internal<&State::lost_before>("Objects lost by each belt so far.");
  d.internal<&State::taken_cycle>("Cycle in which a workpiece of each belt was last taken.");
  d.internal<&State::illegal_transitions>("Always 0: the state table holds.");
}

}  // namespace takt::pickplace
