#include "takt/group/state.h"

#include "takt/core/describe.h"

namespace takt::group {

void describe(Description<Queue>& d) {
  d.about("Moves that wait, a ring buffer.");
  d.internal<&Queue::moves>("The moves.");
  d.internal<&Queue::first>("Index of the oldest move.");
  d.internal<&Queue::count>("Number of moves.");
}

void describe(Enumeration<Stage>& e) {
  e.about("Stage of the planning of a move.");
  e.value(Stage::kIdle, "idle", "Nothing is planned.");
  e.value(Stage::kVerify, "verify", "Reach, ranges and switches are verified along the move.");
  e.value(Stage::kCheck, "check", "A check for collisions is pending, outside the cycle.");
  e.value(Stage::kJoin, "join", "The move is joined to the path before it.");
  e.value(Stage::kSample, "sample", "Nodes are appended.");
  e.value(Stage::kSweep, "sweep", "Speed ceilings are computed.");
  e.value(Stage::kEnter, "enter", "Its zones are requested.");
}

void describe(Description<Planning>& d) {
  d.about("State of planning.");
  d.internal<&Planning::stage>("Stage of planning.");
  d.internal<&Planning::move>("Number of the move.");
  d.internal<&Planning::element>("Element of a path.");
  d.internal<&Planning::tried>("All elements have been verified.");
  d.internal<&Planning::verifying>("The start has been verified.");
  d.internal<&Planning::verified>("Length verified so far.");
  d.internal<&Planning::step>("Distance to the next point to verify.");
  d.internal<&Planning::question>("Number of the last path check request.");
  d.internal<&Planning::joined>("Cycle in which the last stretch was joined.");
  d.internal<&Planning::nodes>("Number of nodes appended so far.");
}

void describe(Description<SyncedAxis>& d) {
  d.about("An axis that follows the path of the group.");
  d.internal<&SyncedAxis::ticket>("Ticket of the command.");
  d.internal<&SyncedAxis::axis>("Number of the axis, from 1; 0: none.");
  d.internal<&SyncedAxis::ratio>("Units of the axis per mm of the path.");
  d.internal<&SyncedAxis::offset>("Position of the axis at arc length 0, over all turns.");
  d.internal<&SyncedAxis::reached>("It has been in sync once.");
}

void describe(Description<MasterState>& d) {
  d.about("Master of a synchronised path.");
  d.internal<&MasterState::axis>("Number of the axis, from 1; 0: none.");
  d.internal<&MasterState::move>("Number of the move that follows it.");
  d.internal<&MasterState::begin>("Position of the master at the start of the path, over all turns.");
  d.internal<&MasterState::ratio>("Path per unit of the master, mm.");
  d.internal<&MasterState::before>(unit::mm_s2, "Acceleration of the path demanded in the previous cycle.");
  d.internal<&MasterState::in_step>("The path is in sync with the master.");
  d.internal<&MasterState::reached>("It has been in sync once.");
}

void describe(Description<Clutch>& d) {
  d.about("Coupling between a carrier and the tool.");
  d.internal<&Clutch::used>("The tool is carried.");
  d.internal<&Clutch::coupled>("The tool moves exactly with the carrier.");
  d.internal<&Clutch::ride>("Number of the carrier binding.");
  d.internal<&Clutch::travel>("Travel of the carrier as the tool takes it.");
  d.internal<&Clutch::catches_up>("The tool is getting into sync.");
  d.internal<&Clutch::boards>("From rest, while the path already runs.");
  d.internal<&Clutch::reserved>("Its limits are not shared with the path.");
  d.internal<&Clutch::apart>("Travel of the tool minus that of the carrier while catching up.");
  d.internal<&Clutch::velocity>("Largest velocity of the travel.");
  d.internal<&Clutch::acceleration>("Largest acceleration of the travel.");
  d.internal<&Clutch::deceleration>("Largest deceleration of the travel.");
  d.internal<&Clutch::jerk>("Largest jerk of the travel.");
  d.internal<&Clutch::law_length>("Travel of the carrier over which the tool gets into sync or out of it.");
  d.internal<&Clutch::law_begin>("Travel of the carrier at the start of that.");
  d.internal<&Clutch::law_from>("Travel of the tool at the start of that.");
  d.internal<&Clutch::law_way>("Displacement of the tool over that length.");
}

void describe(Enumeration<TrackState>& e) {
  e.about("Synchronisation of the tool with an object (TrackState).");
  e.value(TrackState::kNone, "none", "Not synchronised with an object.");
  e.value(TrackState::kWaiting, "waiting", "The object has not reached the start of tracking.");
  e.value(TrackState::kSynchronizing, "synchronizing", "The tool is getting into sync.");
  e.value(TrackState::kInSync, "in_sync", "The tool is in sync.");
  e.value(TrackState::kDesynchronizing, "desynchronizing", "The tool is getting out of sync.");
}

void describe(Description<Track>& d) {
  d.about("Tracking of an object.");
  d.internal<&Track::ticket>("Ticket of the command.");
  d.internal<&Track::behind>("Number of the move after which it starts.");
  d.internal<&Track::active>("The command is active.");
  d.internal<&Track::started>("The tool is coupled to the object, or on the way to it.");
  d.internal<&Track::boarded>("A motion on the object's carrier has begun.");
  d.internal<&Track::ends>("The object has left the range of tracking.");
  d.internal<&Track::in_sync>("The tool is in sync.");
  d.internal<&Track::near_cycles>("Cycles for which the lag has been within the tolerance.");
  d.internal<&Track::cargo>("Object that is tracked.");
  d.internal<&Track::kind>("Kind of the carrier.");
  d.internal<&Track::sense>("Direction of the travel.");
  d.internal<&Track::begin>("Travel at which tracking begins.");
  d.internal<&Track::end>("Travel at which tracking ends.");
  d.internal<&Track::in_distance>("Travel over which the tool gets into sync.");
  d.internal<&Track::in_tool>("Displacement of the tool meanwhile.");
  d.internal<&Track::out_distance>("Travel over which the tool gets out of sync.");
  d.internal<&Track::out_tool>("Displacement of the tool meanwhile.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("State of a group of axes.");
  d.internal<&S::state>("State of the group.");
  d.internal<&S::error>("Reason for GroupErrorStop.");
  d.internal<&S::members>("Numbers of the axes, from 1; 0: none.");
  d.internal<&S::kinematics_on>("The kinematics are switched on.");
  d.internal<&S::product_systems>("Poses of the product coordinate systems in the MCS.");
  d.internal<&S::cargoes>("Targets of the product coordinate systems that move.");
  d.internal<&S::tool_changed>("The tool was changed since the machine was made.");
  d.internal<&S::tool>("Pose of the changed tool on the flange.");
  d.internal<&S::velocity_factor>("Override of velocities.");
  d.internal<&S::acceleration_factor>("Override of accelerations.");
  d.internal<&S::jerk_factor>("Override of jerks.");
  d.internal<&S::queue>("Moves that wait.");
  d.internal<&S::done>("Number of the first move that is not done.");
  d.internal<&S::failed>("Number of the last move that was aborted or failed; 0: none.");
  d.internal<&S::active>("Ticket of the move in execution.");
  d.internal<&S::boards>("Ticket of the move for which the tool has boarded.");
  d.internal<&S::goes_over>("Ticket of a move whose boarding was given up.");
  d.internal<&S::planning>("State of planning.");
  d.internal<&S::pace>("Motion along the path.");
  d.internal<&S::guides>("The members follow the group's set points.");
  d.internal<&S::begun>("A motion along the path is in progress.");
  d.internal<&S::interrupted>("At rest, or coming to rest, on the path.");
  d.internal<&S::ends>("Comes to rest and discards the path.");
  d.internal<&S::brake>("Limits of braking.");
  d.internal<&S::weighed>("Members whose stopping distance along the path was compared with their own, a mask.");
  d.internal<&S::lets_go>("Releases its carriers.");
  d.internal<&S::clutches>("Couplings between carriers and the tool.");
  d.internal<&S::ridden>("Numbers of the carriers that take part in the motion.");
  d.internal<&S::rise>("Offset above the path while the tool is braked.");
  d.internal<&S::track>("Tracking of an object.");
  d.internal<&S::holds>("Stops that hold the group until they are released.");
  d.internal<&S::ticket>("Ticket of stop, halt, interrupt, home or power.");
  d.internal<&S::task>("Task in progress besides moves.");
  d.internal<&S::lease_s>("Dead man's lease; 0: none.");
  d.internal<&S::lease_end_cycle>("Cycle in which the lease ends.");
  d.internal<&S::joints>("Commanded positions of the members.");
  d.internal<&S::origins>("Whole turns and zero offsets subtracted from those positions.");
  d.internal<&S::reset_ticket>("Ticket of a pending reset.");
  d.internal<&S::resetting>("A reset is pending.");
  d.internal<&S::reset_asked>("The members have received the reset.");
  d.internal<&S::stop_reported>("The stop has been reported as done.");
  d.internal<&S::power_on>("State requested by the last power command.");
  d.internal<&S::synced>("Axes that follow the path.");
  d.internal<&S::way_before>("Length of all paths before this one.");
  d.internal<&S::master>("Master of the path.");
  d.internal<&S::jog>("A jog as planned.");
  d.internal<&S::stream>("Streamed set points.");
  d.internal<&S::reason>("Reason why there was no position of the axes.");
  d.internal<&S::problem>("Reason why there was no path.");
  d.internal<&S::blocked_at>("Arc length at which the last move was refused.");
  d.internal<&S::blocked_element>("Element of a path at which the last move was refused.");
  d.internal<&S::closed>("Directions closed by switches of a module.");
  d.internal<&S::refused>("Closed directions that the last motion would have taken.");
  d.internal<&S::answer>("Answer to the last path check request.");
  d.internal<&S::zones>("Zones held by the group, a mask.");
  d.internal<&S::zones_claimed>("Zones of these that were claimed for the move being planned.");
  d.internal<&S::claimed_for>("Number of that move.");
  d.internal<&S::zones_wanted>("Zones for which the group waits, a mask.");
  d.internal<&S::waits_for>("Number of the group for which it waits, from 1; 0: none.");
  d.internal<&S::waits_zone>("Number of the zone for which it waits, from 1.");
  d.internal<&S::waits_since>("Cycle in which the wait began.");
  d.internal<&S::zone_circle>("The last move was refused because groups would have waited for each other.");
  d.internal<&S::zone_near>("A carrier will soon take the tool into a zone of another group.");
  d.internal<&S::gets_off>("The group brakes for such a zone, to wait there.");
  d.internal<&S::illegal_transitions>("Always 0.");
}

void describe(Description<Rise>& d) {
  d.about("Offset of the tool above its path.");
  d.internal<&Rise::used>("The tool rises.");
  d.internal<&Rise::height>("Height of the tool at the end.");
  d.internal<&Rise::target>("Target of the offset.");
  d.internal<&Rise::offset>("Offset from the path.");
  d.internal<&Rise::velocity>("Largest velocity.");
  d.internal<&Rise::acceleration>("Largest acceleration.");
  d.internal<&Rise::jerk>("Largest jerk.");
}

void describe(Description<Directions>& d) {
  d.about("Directions of axes and tool, as masks: bits 0 to 7 axes, 8 to 13 the tool along and about X, Y, Z.");
  d.internal<&Directions::positive>("Positive directions.");
  d.internal<&Directions::negative>("Negative directions.");
}

void describe(Description<Jogging>& d) {
  d.about("A jog as planned.");
  d.internal<&Jogging::speed>("Path speed at the given speeds.");
  d.internal<&Jogging::border>("Obstacle at which the path ends.");
  d.internal<&Jogging::reason>("Reason of kinematics for that end.");
  d.internal<&Jogging::met>("Answer of the path check for that end.");
}

void describe(Enumeration<Task>& e) {
  e.about("Task of a group besides moves.");
  e.value(Task::kNone, "none", "Nothing.");
  e.value(Task::kStop, "stop", "Stop.");
  e.value(Task::kHalt, "halt", "Halt.");
  e.value(Task::kInterrupt, "interrupt", "Interrupt.");
  e.value(Task::kHome, "home", "Home.");
  e.value(Task::kPower, "power", "Power.");
}

}  // namespace takt::group
