// The command in control, and how control passes from one to the next. Used by the stages of the axis only.
#pragma once

#include <span>

#include "takt/axis/axis.h"
#include "takt/axis/planning.h"

namespace takt::axis {

// The time from which a new motion counts.
struct MotionStart {
  std::uint64_t cycle = 0;
  double offset_s = 0;
};
// From the previous set point: commands and faults, whose first new set point is this cycle's.
inline MotionStart FromCycleBefore(const Context& c) {
  return {c.cycle.count - 1, 0};
}
// From this cycle's set point, which is already computed.
inline MotionStart FromThisCycle(const Context& c) {
  return {c.cycle.count, 0};
}

// Returns true if the axis is inside the in-position window, so that a positioning command whose set point has arrived
// is done; always true without a window.
bool InPosition(const AxisParams& params, const State& s) noexcept;
void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error = ErrorId::kNone,
            bool reached = false, double value = 0) noexcept;
// Reports the end of a command; a fault of another axis together with that axis.
void ReportEnd(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error, const State& s) noexcept;
// Changes the state, and counts illegal transitions.
void Enter(State& s, PlcState to) noexcept;
// Returns the input for planning a motion that continues beneath a superimposed one.
PlanningContext BasePlanningContext(const Context& c, const State& s) noexcept;
// Returns the input for planning a motion that takes over from both.
PlanningContext SumPlanningContext(const Context& c, const State& s) noexcept;
// Returns the consecutive blending commands behind the one in control.
std::span<const Request> BlendingQueue(const State& s) noexcept;
// Returns the time [s] of the motion in progress at this cycle.
inline double Elapsed(const Context& c, const State& s) noexcept {
  return static_cast<double>(c.cycle.count - s.motion.start_cycle) * c.cycle.period_s + s.motion.start_offset_s;
}

void StartMotion(const trajectory::Profile& profile, double target, const MotionStart& start, State& s) noexcept;
void StartMotion(const Plan& plan, const MotionStart& start, State& s) noexcept;
// Holds an axis at rest at its present set point, which may come from a coupling, a stream or a superimposed motion.
void StandStill(const Context& c, State& s) noexcept;

// Puts a request in control without changing the motion.
void Grant(const Context& c, const Request& request, State& s, double travel_s = 0) noexcept;
// Puts a request in control with a motion of its own.
void TakeControl(const Context& c, const Request& request, const Plan& plan, const MotionStart& start,
                 State& s) noexcept;
// Returns true for commands that follow something that moves (a master, a table over time, a stream, another component)
// instead of a plan.
inline bool FollowsDemand(RequestKind kind) noexcept {
  return Couples(kind) || FollowsTable(kind) || Streams(kind) || kind == RequestKind::kGuided;
}
// Checks whether such a command may take control now: MayCouple, MayFollowTable.
Status MayFollow(const Context& c, const Request& request, const State& s) noexcept;
// Puts such a command in control. Requires: the command that was in control has been ended.
void BeginFollowing(const Context& c, const Request& request, const MotionStart& start, State& s) noexcept;
// Ends the command in control; its motion continues until it is replaced.
void EndActive(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
void AbortBuffer(const Context& c, State& s) noexcept;
void AbortAll(const Context& c, State& s) noexcept;
// Brakes within `limits`, and no further than `furthest` [u] if the axis can. Never fails.
void Brake(const Context& c, const trajectory::Limits& limits, const MotionStart& start, State& s,
           std::optional<double> furthest = {}) noexcept;
// Brakes in the same way with no command in control; then the axis is in Standstill.
void ComeToRest(const Context& c, const trajectory::Limits& limits, const MotionStart& start, State& s,
                std::optional<double> furthest = {}) noexcept;
// Ends a power off: opens the loop and enters Disabled.
void SwitchedOff(const Context& c, State& s) noexcept;
// Opens the loop: the set point becomes the actual position, at rest.
void OpenLoop(State& s) noexcept;
// Gives control to the next buffered command, `late_s` after the motion in progress ended; without one the axis comes
// to rest in Standstill. `committed`: the motion was left with a velocity towards that command's target.
void StartNext(const Context& c, double late_s, State& s, bool committed = false) noexcept;
// Plans the positioning command in control anew because the commands behind it changed. Must not be called within a
// ScopedBaseMotion.
void ReplanActive(const Context& c, State& s) noexcept;
// Plans the motion in progress anew because its limits changed: a positioning command to its promised end, a velocity
// move or a jog to its velocity. Other motions continue unchanged. Must not be called within a ScopedBaseMotion.
void PlanAgain(const Context& c, State& s) noexcept;
// Handles a motion in progress that is over; each cycle until its command ends.
void Conclude(const Context& c, double late_s, State& s) noexcept;
// Plans the motion of a jog with one key held.
Status PlanJog(const Context& c, const Request& jog, const State& s, Plan& plan) noexcept;
// Starts and stops the motion of a jog by its keys.
void FollowKeys(const Context& c, State& s) noexcept;

}  // namespace takt::axis
