#include "takt/group/state.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Description<Queue>& d) {
  d.about("Moves that wait.");
  d.internal<&Queue::moves>("A ring.");
  d.internal<&Queue::first>("The oldest one.");
  d.internal<&Queue::count>("How many.");
}

void describe(Enumeration<Stage>& e) {
  e.about("How far the planning of a move is.");
  e.value(Stage::kIdle, "idle", "Nothing is planned.");
  e.value(Stage::kVerify, "verify", "Whether it can be gone.");
  e.value(Stage::kCheck, "check", "Whether it is free: asked outside the cycle.");
  e.value(Stage::kJoin, "join", "How it is joined to the path before.");
  e.value(Stage::kSample, "sample", "Nodes are made.");
  e.value(Stage::kSweep, "sweep", "Ceilings are worked out.");
  e.value(Stage::kEnter, "enter", "Whether its zones are free.");
}

void describe(Description<Planning>& d) {
  d.about("Planning in portions.");
  d.internal<&Planning::stage>("Where it is.");
  d.internal<&Planning::move>("Number of the move.");
  d.internal<&Planning::element>("Of a path.");
  d.internal<&Planning::tried>("All elements are good.");
  d.internal<&Planning::verifying>("The beginning is good.");
  d.internal<&Planning::verified>("So far it is good.");
  d.internal<&Planning::step>("To the next place tried.");
  d.internal<&Planning::question>("Number of the last question about a path.");
  d.internal<&Planning::joined>("Cycle in which the last stretch was joined.");
  d.internal<&Planning::nodes>("Nodes made so far.");
}

void describe(Description<SyncedAxis>& d) {
  d.about("An axis that follows the way along the path.");
  d.internal<&SyncedAxis::ticket>("Of the command.");
  d.internal<&SyncedAxis::axis>("From 1; 0: none.");
  d.internal<&SyncedAxis::ratio>("Units per mm.");
  d.internal<&SyncedAxis::offset>("Its place where the way is 0, over all turns.");
  d.internal<&SyncedAxis::reached>("It was in step once.");
}

void describe(Description<MasterState>& d) {
  d.about("What a synchronised path follows.");
  d.internal<&MasterState::axis>("From 1; 0: none.");
  d.internal<&MasterState::move>("Number of the move that is gone so.");
  d.internal<&MasterState::begin>("Where the path begins, over all turns.");
  d.internal<&MasterState::ratio>("mm per unit.");
  d.internal<&MasterState::before>(unit::mm_s2, "Acceleration that it asked for in the cycle before.");
  d.internal<&MasterState::in_step>("The tool is where the master wants it.");
  d.internal<&MasterState::reached>("It was once.");
}

void describe(Description<Clutch>& d) {
  d.about("Between a carrier and the tool.");
  d.internal<&Clutch::used>("The tool is carried.");
  d.internal<&Clutch::coupled>("It goes with the carrier itself.");
  d.internal<&Clutch::ride>("Number of the ride.");
  d.internal<&Clutch::travel>("Of the carrier, as far as the tool is concerned.");
  d.internal<&Clutch::catches_up>("The tool is on its way into step.");
  d.internal<&Clutch::boards>("From rest, and the path goes on meanwhile.");
  d.internal<&Clutch::reserved>("The limits are not shared with the path.");
  d.internal<&Clutch::apart>("Of its travel from the carrier's, on that way.");
  d.internal<&Clutch::velocity>("Largest, of the travel.");
  d.internal<&Clutch::acceleration>("The same.");
  d.internal<&Clutch::deceleration>("The same.");
  d.internal<&Clutch::jerk>("The same.");
  d.internal<&Clutch::law_length>("Travel in which the tool gets into step or out of it.");
  d.internal<&Clutch::law_begin>("Where that begins.");
  d.internal<&Clutch::law_from>("Where the tool is there.");
  d.internal<&Clutch::law_way>("How far it goes meanwhile.");
}

void describe(Enumeration<TrackState>& e) {
  e.about("How the tool goes along with an object (TrackState).");
  e.value(TrackState::kNone, "none", "It does not.");
  e.value(TrackState::kWaiting, "waiting", "The object is not yet where tracking begins.");
  e.value(TrackState::kSynchronizing, "synchronizing", "The tool gets into step.");
  e.value(TrackState::kInSync, "in_sync", "It goes along.");
  e.value(TrackState::kDesynchronizing, "desynchronizing", "It gets out of step.");
}

void describe(Description<Track>& d) {
  d.about("Tracking of an object.");
  d.internal<&Track::ticket>("Of the command.");
  d.internal<&Track::behind>("The move that it waits for.");
  d.internal<&Track::active>("It waits for the object.");
  d.internal<&Track::started>("The tool is taken along.");
  d.internal<&Track::boarded>("It is on its way with the object.");
  d.internal<&Track::ends>("The object has left.");
  d.internal<&Track::in_sync>("The tool goes along.");
  d.internal<&Track::near_cycles>("For so long.");
  d.internal<&Track::cargo>("The object.");
  d.internal<&Track::kind>("Of the carrier.");
  d.internal<&Track::sense>("Of the travel.");
  d.internal<&Track::begin>("Where it begins.");
  d.internal<&Track::end>("Where it ends.");
  d.internal<&Track::in_distance>("To get into step.");
  d.internal<&Track::in_tool>("The tool goes so far meanwhile.");
  d.internal<&Track::out_distance>("To get out of step.");
  d.internal<&Track::out_tool>("The tool goes so far meanwhile.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("Memory of an axes group.");
  d.internal<&S::state>("State.");
  d.internal<&S::error>("Why it is in ErrorStop.");
  d.internal<&S::members>("Axes, from 1; 0: none.");
  d.internal<&S::kinematics_on>("It has a tool.");
  d.internal<&S::product_systems>("Product coordinate systems in that of the machine.");
  d.internal<&S::cargoes>("What those lie on that move.");
  d.internal<&S::tool_changed>("Since the machine was made.");
  d.internal<&S::tool>("On the flange, then.");
  d.internal<&S::velocity_factor>("Override.");
  d.internal<&S::acceleration_factor>("Override.");
  d.internal<&S::jerk_factor>("Override.");
  d.internal<&S::queue>("Moves.");
  d.internal<&S::done>("Moves that are over.");
  d.internal<&S::failed>("Number of the last move that was aborted or failed; 0: none.");
  d.internal<&S::active>("Ticket of the move in execution.");
  d.internal<&S::boards>("Ticket of the move for which the tool boards.");
  d.internal<&S::goes_over>("Ticket of a move for which it does not.");
  d.internal<&S::planning>("Planning.");
  d.internal<&S::pace>("Motion along the path.");
  d.internal<&S::guides>("In control of its members.");
  d.internal<&S::begun>("Moves along the path.");
  d.internal<&S::interrupted>("Rests on the path.");
  d.internal<&S::ends>("Comes to rest and forgets the path.");
  d.internal<&S::brake>("How strongly.");
  d.internal<&S::weighed>("Members whose way to rest was held against their own.");
  d.internal<&S::lets_go>("Of what carries it.");
  d.internal<&S::clutches>("Between carriers and the tool.");
  d.internal<&S::ridden>("Carriers that take part now.");
  d.internal<&S::rise>("Above the path, while it is braked.");
  d.internal<&S::track>("Tracking of an object.");
  d.internal<&S::holds>("Stops that hold it until they are released.");
  d.internal<&S::ticket>("Of stop, halt, interrupt, home or power.");
  d.internal<&S::task>("Which of them.");
  d.internal<&S::lease_s>("Dead man's lease; 0: none.");
  d.internal<&S::lease_end_cycle>("When it ends.");
  d.internal<&S::joints>("Where the members are told to be.");
  d.internal<&S::origins>("Whole turns and zeros taken out of that.");
  d.internal<&S::reset_ticket>("Of a reset that waits.");
  d.internal<&S::resetting>("A reset waits.");
  d.internal<&S::reset_asked>("The members were told.");
  d.internal<&S::stop_reported>("The stop is done.");
  d.internal<&S::power_on>("What power asked for.");
  d.internal<&S::synced>("Axes that follow the path.");
  d.internal<&S::way_before>("Way along all paths before this one.");
  d.internal<&S::master>("What the path follows.");
  d.internal<&S::jog>("A jog as it was planned.");
  d.internal<&S::stream>("Set points from outside.");
  d.internal<&S::reason>("Why there was no position of the axes.");
  d.internal<&S::problem>("Why there was no path.");
  d.internal<&S::blocked_at>("How far it could be gone.");
  d.internal<&S::blocked_element>("On which element of a path.");
  d.internal<&S::closed>("Nothing moves so: switches of a module.");
  d.internal<&S::refused>("Closed directions that the last move wanted.");
  d.internal<&S::answer>("To the last question about a path.");
  d.internal<&S::zones>("Zones that it has, a mask.");
  d.internal<&S::zones_claimed>("Of those: for the move that is planned.");
  d.internal<&S::claimed_for>("Number of that move.");
  d.internal<&S::zones_wanted>("Zones that it waits for, a mask.");
  d.internal<&S::waits_for>("Number of the group that it waits for, from 1; 0: none.");
  d.internal<&S::waits_zone>("For this zone, from 1.");
  d.internal<&S::waits_since>("Cycle.");
  d.internal<&S::zone_circle>("The last move was refused, for groups would have waited for one another.");
  d.internal<&S::zone_near>("What carries the tool takes it soon into a zone of another group.");
  d.internal<&S::gets_off>("It is braked for such a zone, to wait there.");
  d.internal<&S::illegal_transitions>("Always 0.");
}

void describe(Description<Rise>& d) {
  d.about("The tool above its path.");
  d.internal<&Rise::used>("It rises.");
  d.internal<&Rise::height>("In the end.");
  d.internal<&Rise::target>("Of the offset.");
  d.internal<&Rise::offset>("From the path.");
  d.internal<&Rise::velocity>("Largest.");
  d.internal<&Rise::acceleration>("Largest.");
  d.internal<&Rise::jerk>("Largest.");
}

void describe(Description<Directions>& d) {
  d.about("Directions of axes and tool, as masks: bits 0 to 7 axes, 8 to 13 the tool along and about X, Y, Z.");
  d.internal<&Directions::positive>("Positive ones.");
  d.internal<&Directions::negative>("Negative ones.");
}

void describe(Description<Jogging>& d) {
  d.about("A jog as it was planned.");
  d.internal<&Jogging::speed>("Of the speeds given.");
  d.internal<&Jogging::border>("What its way ends at.");
  d.internal<&Jogging::reason>("The same.");
  d.internal<&Jogging::met>("The same, of the workspace.");
}

void describe(Enumeration<Task>& e) {
  e.about("What a group is doing besides moves.");
  e.value(Task::kNone, "none", "Nothing.");
  e.value(Task::kStop, "stop", "Stop.");
  e.value(Task::kHalt, "halt", "Halt.");
  e.value(Task::kInterrupt, "interrupt", "Interrupt.");
  e.value(Task::kHome, "home", "Home.");
  e.value(Task::kPower, "power", "Power.");
}

}  // namespace takt::group
