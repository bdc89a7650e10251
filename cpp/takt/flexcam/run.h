// The way from the master to Y, cycle by cycle, the changes of cam on it, and what else the stages of a module share.
// Used by them only.
#pragma once

#include "takt/flexcam/module.h"

namespace takt::flexcam {

const cam::Table& TableOf(const Context& c, const State& s) noexcept;
// Takes the cam up anew, as it lies for the positions of the cycle before.
void TakeUp(const Context& c, const axis::State& slave, State& s) noexcept;
// With the clutch open: X and Y as they would be if it were taken up now.
void ShowWay(const Context& c, const axis::State& slave, State& s) noexcept;
// The next X, Y and place of the slave.
void RunWay(const Context& c, State& s) noexcept;

// Changes of cam that wait. False: too many.
bool Enqueue(Ticket ticket, const ChangeCam& change, State& s) noexcept;
void AbortChanges(const Context& c, State& s) noexcept;

// Whether the offset or factor that is set is in force.
bool IsSettled(const State& s, Adjustment what) noexcept;
// Whether it cannot come into force as things stand: it waits for a way on, or an end of, a cam that is over (CAM-82).
bool IsStuck(const State& s, Adjustment what) noexcept;

void AbortAdjustments(const Context& c, State& s) noexcept;
// Tells the ends of ramps.
void EndAdjustments(const Context& c, State& s) noexcept;

SequencerInputs SequencerOf(const Context& c, const State& s) noexcept;
// The slave is powered and takes commands.
bool IsOn(const axis::State& slave) noexcept;
void EndJog(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error = ErrorId::kNone) noexcept;

}  // namespace takt::flexcam
