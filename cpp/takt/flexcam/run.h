// The way from the master to Y, cycle by cycle, and the changes of cam on it. Used by the stages of the module only.
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

SequencerInputs SequencerOf(const State& s) noexcept;
void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error = ErrorId::kNone) noexcept;

}  // namespace takt::flexcam
