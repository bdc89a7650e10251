// What the stages of a pick and place module share. Used by them only.
#pragma once

#include <optional>
#include <utility>

#include "takt/pickplace/module.h"

namespace takt::pickplace {

inline void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error = ErrorId::kNone) noexcept {
  const bool unreachable = error == ErrorId::kUnreachable || error == ErrorId::kSingular;
  if (ticket == 0) return;
  const std::uint64_t detail = unreachable ? std::exchange(c.group.ahead.failures, 0) : 0;
  c.group.feedback.Report({ticket, c.group.cycle.count, feedback, false, error, 0, {}, detail});
}
inline void Enter(PickPlaceState to, State& s) noexcept {
  if (!IsLegal(s.state, to)) ++s.illegal_transitions;
  s.state = to;
}
inline bool Rises(bool now, bool before) noexcept {
  return now && !before;
}
inline bool Jogs(const State& s) noexcept {
  return s.state == PickPlaceState::kJogPos || s.state == PickPlaceState::kJogNeg;
}
inline bool StopIsAsked(const State& s) noexcept {
  return s.inputs.path_stop || s.inputs.path_halt || s.inputs.stop_all;
}

// group.cc: the group as the module sees it.
// Gives the group a command; why it was refused, if it was.
ErrorId Tell(const Context& c, const group::Command& command, group::State& g) noexcept;
// All axes are on and the group takes moves.
bool IsOn(const Context& c, const group::State& g) noexcept;
// Why it is not, by its cause: an axis that is off, or the state of the group. kNone: it is.
ErrorId WhyOff(const Context& c, const group::State& g) noexcept;
// Nothing moves, whether a path is held or not.
bool Stands(const Context& c, const group::State& g) noexcept;
// It stands and has nothing to do.
bool IsFree(const Context& c, const group::State& g) noexcept;
// Each axis brakes by itself; the group is disabled, and enabled again once all stand.
void StopAxes(const Context& c, group::State& g, State& s) noexcept;
// An override of the module, or one that the group was given by itself, is not 1 (PP-21).
bool HasOverride(const group::State& g, const State& s) noexcept;
// The least of the group's override factors, from 1e-3 to 1: no motion takes longer than without it by more than that.
double OverrideOf(const group::State& g) noexcept;
// Where the tool is told to be, and Aux1.
Place PresentPlace(const Context& c, const group::State& g) noexcept;
// The same place with the tool turned about Z alone, where the mechanism cannot tilt it.
Place Levelled(const Context& c, const group::State& g, const Place& place) noexcept;
// Number of Aux1 in the group, from 0; none: kMaxAxes.
std::size_t Aux1Of(const Context& c, const group::State& g) noexcept;
// Index among A1 to A6, Aux1 of the member in a place of the group; none: kRealAxes.
std::size_t RealOf(const Context& c, const group::State& g, std::size_t place) noexcept;
// Why the group ended a move before its time, as far as it says.
ErrorId TroubleOf(const group::State& g) noexcept;

// workpieces.cc
// The workpiece to go to now; null: none. While the order waits a few are tried in each cycle.
const conveyor::Object* ChooseWorkpiece(const Context& c, const group::State& g, const Order& order, State& s) noexcept;
// So long the way to it is thought to take, as its belt goes now.
double TimeToMeet(const Context& c, const group::State& g, const Order& order, const conveyor::Object& object,
                  const State& s) noexcept;
// It is the order's: taken, and given a product coordinate system. Its place for the tool.
ErrorId BindWorkpiece(const Context& c, const conveyor::Object& object, group::State& g, Order& order, Place& place,
                      State& s) noexcept;
// Nobody's again, if it is still there.
void GiveBackWorkpiece(const Context& c, Order& order) noexcept;
// Whether the order's workpiece will be in the range until the tool is up again that leaves it after so long, whatever
// its belt may do.
bool StaysWithin(const Context& c, const group::State& g, const Order& order, double time_s) noexcept;
// Of what it was thought to take a profile may take so many times as much now.
double LongerBy(const group::State& g, const State& s) noexcept;
// It was fetched or missed under the tool, or something was put there: it is deleted, and what lies in the same place
// (PP-66).
void RemoveWorkpiece(const Context& c, Order& order) noexcept;
// The order lets go of its workpiece, which is missed if it leaves the range. `refused`: there is no path to it; else
// the path was stopped. A cause that is noted already stays.
void NoteLeft(const Order& order, bool refused, State& s) noexcept;
// Counts each workpiece that has left the range as missed, once: those that were left behind, and, while the module
// moves, those that the belts have lost and it would have taken.
void CountLost(const Context& c, State& s) noexcept;

// orders.cc
// Takes a target; belt 0: the static one. An error: it was refused, and told.
void Accept(const Context& c, Ticket ticket, std::uint32_t belt, State& s) noexcept;
void BeginLoop(const Context& c, Ticket ticket, State& s) noexcept;
// The tool moves with what carries it, and nothing is left to catch up with.
bool IsInStep(const Context& c, const group::State& g) noexcept;
// It does at the end of the order's profile: on its workpiece.
bool IsOnWorkpiece(const Context& c, const group::State& g, const State& s) noexcept;
// Notes that the moves of the order that is gone have ended as done in this cycle: a static one is done then. False:
// they have not.
bool Arrive(const Context& c, const group::State& g, State& s) noexcept;
// The order that is gone is done. Requires: see the invariant in orders.cc.
void Complete(const Context& c, State& s) noexcept;
// Goes on with what is to be done; MOVE_PP and PREPARING_PATH.
void RunOrders(const Context& c, group::State& g, State& s) noexcept;
// The loop is over behind the order that is gone; at once if that waits.
void EndLoopBehindThis(const Context& c, State& s) noexcept;
// How the profile of an order runs from where the tool will be.
Shape ShapeFromHere(const Context& c, const group::State& g, const Shape& shape, const State& s) noexcept;
// Where the tool will be is not known any more.
void ForgetPlace(State& s) noexcept;
// So long has the tool been on its way.
inline double TimeGone(const Context& c, const Order& order) noexcept {
  return static_cast<double>(c.group.cycle.count - order.begin_cycle) * c.group.cycle.period_s;
}
// So long it takes; for the next ones.
void Learn(double takes_s, const Order& order, State& s) noexcept;
// All are forgotten.
void EndOrders(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
// What was given to the group is lost: orders begin anew, where `kept` from where the path was held (Hold::legs).
void LosePath(const Context& c, bool kept, State& s) noexcept;
// The group comes to rest and forgets its moves.
void HaltGroup(const Context& c, group::State& g, State& s, const group::Halt& halt = {}) noexcept;

// give_up.cc
// The workpiece of the order that is gone will not be reached in time: the tool leaves it, and its belt, upwards.
void GiveUp(const Context& c, group::State& g, State& s) noexcept;
// Notes whether the tool is low over a belt, for the time when its group is not able to say (PP-61).
void NoteHeight(const group::State& g, State& s) noexcept;
// Brings the tool to rest. One that is low over a belt is braked in step, rises in step and only then lets go.
void ComeToRest(const Context& c, const PathRamps& ramps, group::State& g, State& s) noexcept;
// Whether it has to rise for that.
bool IsLow(const Context& c, const group::State& g, const State& s) noexcept;
// Lets go of the belt once the tool is up, outside MOVE_PP.
void StepLift(const Context& c, group::State& g, State& s) noexcept;
// mm that the tool has to rise to be as high as that.
double RiseTo(const Context& c, const group::State& g, const Place& over) noexcept;
// Whether it is up there; from then on the next order may begin.
bool IsLifted(const Context& c, group::State& g, State& s) noexcept;
// s until the group is through with the order's moves.
double TimeToGo(const Context& c, const group::State& g, const Order& order, const State& s) noexcept;

// limits.cc
// The group gets the directions that the module's limit switches close.
void CloseDirections(const Context& c, group::State& g, const State& s) noexcept;
// Stops for a limit switch input that turned on, or that an axis goes towards by itself.
void WatchSwitches(const Context& c, group::State& g, State& s) noexcept;
// The axes of these directions, as a mask of the module.
std::uint32_t AxesOf(const Context& c, const group::State& g, const group::Directions& directions) noexcept;
// Directions towards limit switches that are on, which a profile would take from its leg `first` on.
group::Directions ClosedOn(const Context& c, const group::State& g, const Profile& profile, std::uint32_t first,
                           const Place& start, bool keep_orientation) noexcept;
// In which directions members would be beyond their SW limits, or the ranges of the kinematics.
group::Directions BeyondRanges(const Context& c, const group::State& g, const kinematics::Joints& joints) noexcept;

// gripper.cc
void StepGripper(const Context& c, const group::State& g, State& s) noexcept;

// jog.cc
void BeginJog(const Context& c, group::State& g, State& s) noexcept;
void InJog(const Context& c, group::State& g, State& s) noexcept;
void EndJog(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;

// homing.cc
void BeginHoming(const Context& c, Ticket ticket, group::State& g, State& s) noexcept;
void InHoming(const Context& c, group::State& g, State& s) noexcept;
void EndHoming(const Context& c, FeedbackState feedback, ErrorId error, group::State& g, State& s) noexcept;

// module.cc
// From where the path was held.
void GoOn(const Context& c, group::State& g, State& s) noexcept;
// Into ERROR; the tool comes to rest on its path.
void Fail(const Context& c, ErrorId error, group::State& g, State& s) noexcept;

}  // namespace takt::pickplace
