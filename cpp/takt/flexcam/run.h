// The chain from the master to Y, cycle by cycle, its changes of cam, and helpers that the stages of a module share.
// Internal to the module.
#pragma once

#include "takt/flexcam/module.h"

namespace takt::flexcam {

const cam::Table& TableOf(const Context& c, const State& s) noexcept;
// Starts the cam anew, from the positions of the previous cycle.
void TakeUp(const Context& c, const axis::State& slave, State& s) noexcept;
// With the clutch open: computes X and Y as they would be if the cam were started now.
void ShowWay(const Context& c, const axis::State& slave, State& s) noexcept;
// Computes the next X, Y and position of the slave.
void RunWay(const Context& c, State& s) noexcept;

// Queues a change of cam; returns false if the queue is full.
bool Enqueue(Ticket ticket, const ChangeCam& change, State& s) noexcept;
void AbortChanges(const Context& c, State& s) noexcept;

// Returns true if the set offset or factor is in force.
bool IsSettled(const State& s, Adjustment what) noexcept;
// Returns true if it cannot come into force: it waits for further motion, or the end, of a cam that is over (CAM-82).
bool IsStuck(const State& s, Adjustment what) noexcept;

void AbortAdjustments(const Context& c, State& s) noexcept;
// Reports the ends of ramps.
void EndAdjustments(const Context& c, State& s) noexcept;

SequencerInputs SequencerOf(const Context& c, const State& s) noexcept;
// Returns true if the slave is powered and accepts commands.
bool IsOn(const axis::State& slave) noexcept;
void EndJog(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error = ErrorId::kNone) noexcept;

}  // namespace takt::flexcam
