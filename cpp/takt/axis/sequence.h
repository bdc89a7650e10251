// Which command is in control, and how control passes from one to the next. Used by the stages of the axis only.
#pragma once

#include <span>

#include "takt/axis/axis.h"
#include "takt/axis/planning.h"

namespace takt::axis {

// From which cycle a new motion counts its time.
struct MotionStart {
  std::uint64_t cycle = 0;
  double offset_s = 0;
};
// From the set point of the cycle before (commands, faults: the first new set point is this cycle's) ...
inline MotionStart FromCycleBefore(const Context& c) {
  return {c.cycle.count - 1, 0};
}
// ... or from this cycle's set point, which is already out.
inline MotionStart FromThisCycle(const Context& c) {
  return {c.cycle.count, 0};
}

// Whether a positioning command may call itself done although the set point has arrived already.
bool InPosition(const AxisParams& params, const State& s) noexcept;
void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error = ErrorId::kNone,
            bool reached = false, double value = 0) noexcept;
// The end of a command; a fault of another axis is told with its name.
void ReportEnd(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error, const State& s) noexcept;
void Enter(State& s, PlcState to) noexcept;
// What a plan has to know besides. For what goes on beneath another motion ...
PlanningContext SurroundingsOf(const Context& c, const State& s) noexcept;
// ... and for what takes over from both.
PlanningContext SurroundingsOfBoth(const Context& c, const State& s) noexcept;
// Returns the commands behind the one in control, as far as they blend.
std::span<const Request> BlendingQueue(const State& s) noexcept;
// Seconds of the motion in progress at this cycle.
inline double Elapsed(const Context& c, const State& s) noexcept {
  return static_cast<double>(c.cycle.count - s.motion.start_cycle) * c.cycle.period_s + s.motion.start_offset_s;
}

void StartMotion(const trajectory::Profile& profile, double target, const MotionStart& start, State& s) noexcept;
void StartMotion(const Plan& plan, const MotionStart& start, State& s) noexcept;
// Holds an axis at rest at its present set point, which may come from a coupling, a stream or a superimposed motion.
void StandStill(const Context& c, State& s) noexcept;

// Puts a request in control of the motion there is ...
void Grant(const Context& c, const Request& request, State& s, double travel_s = 0) noexcept;
// ... or with a motion of its own.
void TakeControl(const Context& c, const Request& request, const Plan& plan, const MotionStart& start,
                 State& s) noexcept;
// What follows something that moves, a master, a table over time, another component, instead of a plan.
inline bool FollowsDemand(RequestKind kind) noexcept {
  return Couples(kind) || FollowsTable(kind) || Streams(kind) || kind == RequestKind::kGuided;
}
// Whether such a command may take control now: MayCouple, MayFollowTable.
Status MayFollow(const Context& c, const Request& request, const State& s) noexcept;
// Puts it in control. What was in control must have been ended.
void BeginFollowing(const Context& c, const Request& request, const MotionStart& start, State& s) noexcept;
// Ends the command in control; the motion goes on until something replaces it.
void EndActive(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
void AbortBuffer(const Context& c, State& s) noexcept;
void AbortAll(const Context& c, State& s) noexcept;
// Brakes as `limits` say, and no further than `furthest` where the axis can. Never fails.
void Brake(const Context& c, const trajectory::Limits& limits, const MotionStart& start, State& s,
           std::optional<double> furthest = {}) noexcept;
// The same, with no command in control, to Standstill.
void ComeToRest(const Context& c, const trajectory::Limits& limits, const MotionStart& start, State& s,
                std::optional<double> furthest = {}) noexcept;
// Power off has come to its end.
void SwitchedOff(const Context& c, State& s) noexcept;
// Makes the axis stand where it is measured: loops open, nothing in motion.
void OpenLoop(State& s) noexcept;
// Gives control to the next buffered command, `late_s` after the motion in progress ended; with none, the axis is in
// Standstill. `committed`: the motion was left towards that command's target.
void StartNext(const Context& c, double late_s, State& s, bool committed = false) noexcept;
// Plans the positioning command in control anew because what follows it changed. Not to be called within a ScopedBaseMotion.
void ReplanActive(const Context& c, State& s) noexcept;
// Plans the motion in progress anew because its limits changed: a positioning command to where it was promised to end,
// a velocity or jog to its velocity. Other motions go on as they are. Not to be called within a ScopedBaseMotion.
void PlanAgain(const Context& c, State& s) noexcept;
// What to do once the motion in progress is over, each cycle until its command ends.
void Conclude(const Context& c, double late_s, State& s) noexcept;
// The motion of a jog whose one key is held.
Status PlanJog(const Context& c, const Request& jog, const State& s, Plan& plan) noexcept;
// Follows the keys of a jog.
void FollowKeys(const Context& c, State& s) noexcept;

}  // namespace takt::axis
