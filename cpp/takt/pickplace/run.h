// Shared by the stages of a pick and place module; internal.
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
// Gives the group a command; returns the reason if it was refused.
ErrorId Tell(const Context& c, const group::Command& command, group::State& g) noexcept;
// Returns true if all axes are on and the group accepts moves.
bool IsOn(const Context& c, const group::State& g) noexcept;
// Returns why it is not on: an axis that is off, or the state of the group. kNone: it is on.
ErrorId WhyOff(const Context& c, const group::State& g) noexcept;
// Returns true if nothing moves, whether a path is held or not.
bool Stands(const Context& c, const group::State& g) noexcept;
// Returns true if the group is at rest and has nothing to do.
bool IsFree(const Context& c, const group::State& g) noexcept;
// Stops each axis by itself; the group is disabled, and enabled again once all axes are at rest.
void StopAxes(const Context& c, group::State& g, State& s) noexcept;
// Returns true if an override of the module, or one given to the group directly, is not 1 (PP-21).
bool HasOverride(const group::State& g, const State& s) noexcept;
// Returns the least override factor of the group, clamped to 1e-3 to 1: motions take at most 1 / factor times as long.
double OverrideOf(const group::State& g) noexcept;
// Returns the commanded pose of the tool, and the position of Aux1.
Place PresentPlace(const Context& c, const group::State& g) noexcept;
// Returns the same place with the tool only turned about Z, if the mechanism cannot tilt it.
Place Levelled(const Context& c, const group::State& g, const Place& place) noexcept;
// Returns the index of Aux1 in the group; none: kMaxAxes.
std::size_t Aux1Of(const Context& c, const group::State& g) noexcept;
// Returns the index among A1 to A6, Aux1 of the member with an index in the group; none: kRealAxes.
std::size_t RealOf(const Context& c, const group::State& g, std::size_t place) noexcept;
// Returns why the group ended a move early, as far as the group reports it.
ErrorId TroubleOf(const group::State& g) noexcept;

// workpieces.cc
// Returns the workpiece to approach now; null: none. While the order waits only a few candidates are tried in each
// cycle.
const conveyor::Object* ChooseWorkpiece(const Context& c, const group::State& g, const Order& order, State& s) noexcept;
// Returns the estimated time [s] to reach the workpiece at the present speed of its belt.
double TimeToMeet(const Context& c, const group::State& g, const Order& order, const conveyor::Object& object,
                  const State& s) noexcept;
// Assigns the workpiece to the order: it is taken and gets a product coordinate system. `place`: the pose of the tool
// on it.
ErrorId BindWorkpiece(const Context& c, const conveyor::Object& object, group::State& g, Order& order, Place& place,
                      State& s) noexcept;
// Frees the order's workpiece, if it still exists.
void GiveBackWorkpiece(const Context& c, Order& order) noexcept;
// Returns true if the order's workpiece stays within the range until the tool is up again, if the tool leaves it after
// `time_s` [s], whatever speed the belt may take.
bool StaysWithin(const Context& c, const group::State& g, const Order& order, double time_s) noexcept;
// Returns the factor by which a profile may take longer now than estimated.
double TimeFactor(const group::State& g, const State& s) noexcept;
// Deletes the order's workpiece, which was fetched, missed under the tool or placed, and objects at the same position
// (PP-66).
void RemoveWorkpiece(const Context& c, Order& order) noexcept;
// Notes that the order gives up its workpiece, which is missed if it leaves the range. `refused`: there is no path to
// it; else the path was stopped. The first cause noted is kept.
void NoteAbandoned(const Order& order, bool refused, State& s) noexcept;
// Counts each workpiece that has left the range as missed, once: those that were left behind, and, while the module
// moves, those that the belts have lost and the module would have taken.
void CountLost(const Context& c, State& s) noexcept;

// orders.cc
// Accepts a target; belt 0: the static one. If it is refused, reports the error and sets the warning.
void Accept(const Context& c, Ticket ticket, std::uint32_t belt, State& s) noexcept;
void BeginLoop(const Context& c, Ticket ticket, State& s) noexcept;
// Returns true if the tool moves with its carrier and nothing is left to catch up with.
bool IsInStep(const Context& c, const group::State& g) noexcept;
// Returns true if the tool is in step at the end of the current order's profile, on its workpiece.
bool IsOnWorkpiece(const Context& c, const group::State& g, const State& s) noexcept;
// Notes that the moves of the current order have ended as done in this cycle; a static order is then done. Returns
// false if they have not.
bool Arrive(const Context& c, const group::State& g, State& s) noexcept;
// Completes the current order. Requires: see the invariant in orders.cc.
void Complete(const Context& c, State& s) noexcept;
// Runs the orders; in MOVE_PP and PREPARING_PATH.
void RunOrders(const Context& c, group::State& g, State& s) noexcept;
// Ends the loop after the current order; at once if that is waiting.
void EndLoopBehindThis(const Context& c, State& s) noexcept;
// Returns the parameters of an order's profile from the pose at which the moves given so far end.
Shape ShapeFromHere(const Context& c, const group::State& g, const Shape& shape, const State& s) noexcept;
// Marks the pose at which the moves given end as unknown.
void ForgetPlace(State& s) noexcept;
// Returns the time [s] since the order's profile began.
inline double ElapsedTime(const Context& c, const Order& order) noexcept {
  return static_cast<double>(c.group.cycle.count - order.begin_cycle) * c.group.cycle.period_s;
}
// Learns from the duration of an order's profile for the estimates of the next ones.
void Learn(double takes_s, const Order& order, State& s) noexcept;
// Drops all orders and the loop, and reports them.
void EndOrders(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
// The group has lost its moves: orders begin again, with `kept` from the point where the path was held (Hold::legs).
void LosePath(const Context& c, bool kept, State& s) noexcept;
// The group comes to rest and drops its moves.
void HaltGroup(const Context& c, group::State& g, State& s, const group::Halt& halt = {}) noexcept;

// give_up.cc
// The workpiece of the current order will not be reached in time: the tool leaves it, and its belt, upwards.
void GiveUp(const Context& c, group::State& g, State& s) noexcept;
// Notes whether the tool is low over a belt, for the time when its group cannot tell (PP-61).
void NoteHeight(const group::State& g, State& s) noexcept;
// Brings the tool to rest. A tool that is low over a belt is braked in step, rises in step and only then leaves the
// belt.
void ComeToRest(const Context& c, const PathRamps& ramps, group::State& g, State& s) noexcept;
// Returns true if the tool has to rise for that.
bool IsLow(const Context& c, const group::State& g, const State& s) noexcept;
// Leaves the belt once the tool is up; outside MOVE_PP.
void StepLift(const Context& c, group::State& g, State& s) noexcept;
// Returns the distance [mm] that the tool has to rise to the height of `over`; 0 if it is there or higher.
double RiseTo(const Context& c, const group::State& g, const Place& over) noexcept;
// Returns true if the tool is up; from then on the next order may begin.
bool IsLifted(const Context& c, group::State& g, State& s) noexcept;
// Returns the estimated time [s] until the group has completed the order's moves.
double TimeToGo(const Context& c, const group::State& g, const Order& order, const State& s) noexcept;

// limits.cc
// Passes the directions closed by the module's limit switches to the group.
void CloseDirections(const Context& c, group::State& g, const State& s) noexcept;
// Stops for a limit switch input that has turned on, or towards which an axis moves by itself.
void WatchSwitches(const Context& c, group::State& g, State& s) noexcept;
// Returns the axes of these directions as a mask of the module.
std::uint32_t AxesOf(const Context& c, const group::State& g, const group::Directions& directions) noexcept;
// Returns the directions towards active limit switches in which a profile would move from its leg `first` on.
group::Directions ClosedOn(const Context& c, const group::State& g, const Profile& profile, std::uint32_t first,
                           const Place& start, bool keep_orientation) noexcept;
// Returns the directions in which members would be beyond their SW limits, or the ranges of the kinematics.
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
// Continues the path from where it was held.
void GoOn(const Context& c, group::State& g, State& s) noexcept;
// Enters ERROR; the tool comes to rest on its path.
void Fail(const Context& c, ErrorId error, group::State& g, State& s) noexcept;

}  // namespace takt::pickplace
