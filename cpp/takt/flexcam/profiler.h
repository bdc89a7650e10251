// The cam on the X axis: which cam, its position on X, the cycle that X is in, and its value for Y (the manual's 3.9,
// 3.10 and 3.13). Pure functions.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/cam/table.h"
#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::flexcam {

// Positions of X count over all cycles; cycle n of the cam begins at laid + n * its length, so that errors do not
// accumulate over cycles (CAM-21).
struct ProfilerState {
  std::uint32_t cam = 0;   // index among the machine's cams
  std::uint32_t slot = 1;  // slot of that cam
  double laid = 0;         // [x] over all cycles: begin of cycle 0
  double base = 0;         // [y] added to the value of the cam and the strokes of its cycles
  std::int64_t cycle = 0;  // the cycle that X is in
  bool once = false;       // outside cycle 0 the end of the cam is held
  bool held = false;       // the end is being held
  bool announced = false;  // the end ahead has been announced
  std::int8_t announced_sense = 1;
};

// The value of the cam at a position of X.
struct ProfilerValue {
  double x = 0;         // in the cycle of the cam
  double y_in_cam = 0;  // value of the cam there ...
  double y = 0;         // ... with strokes and base added
  double dy = 0;        // over x
  double ddy = 0;
};
ProfilerValue ValueAt(const cam::Table& table, const ProfilerState& state, double x_total) noexcept;

// Places a cam so that X is at `x` in its cycle 0.
void Lay(const cam::Table& table, double x_total, double x, bool once, ProfilerState& state) noexcept;

// The end (beginning, if X moves backwards) that X has passed in this cycle, as x over all cycles; nothing if none.
// Tolerance: 1e-9 of a cycle. Requires: `state` is not yet beyond it.
struct Passed {
  double x_total = 0;
  std::int8_t sense = 1;
};
std::optional<Passed> PassedEnd(const cam::Table& table, const ProfilerState& state, double x_total) noexcept;
// Continues with the same cam, in the cycle that X is in.
void GoOn(const cam::Table& table, double x_total, ProfilerState& state) noexcept;
// Begins another cam (X moving backwards: at its end) where this one was left. `relative`: its y continues from the
// value of the old one; otherwise its zero is that of the old one's cycle.
void Change(const cam::Table& from, const cam::Table& to, const Passed& at, bool relative, bool once,
            ProfilerState& state) noexcept;

// Returns true in the last cycle before the end of the cam, by extrapolation, once for each end.
bool AnnouncesEnd(const cam::Table& table, const Cycle& cycle, const KinematicState& x_total, bool passed,
                  ProfilerState& state) noexcept;

void describe(Description<ProfilerState>&);
void describe(Description<ProfilerValue>&);

}  // namespace takt::flexcam
