// The cam on the X axis: which one, where it lies, in which of its cycles X is, and what it says for Y (the
// manual's 3.9, 3.10 and 3.13). Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/cam/table.h"
#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::flexcam {

// Positions of X count over all cycles; cycle n of the cam begins at laid + n * its length. So no cycle adds to an
// error of those before it (CAM-21).
struct ProfilerState {
  std::uint32_t cam = 0;   // index among the machine's cams
  std::uint32_t slot = 1;  // it came from
  double laid = 0;         // x over all cycles, where cycle 0 begins
  double base = 0;         // y, added to the cam's and to the strokes of its cycles
  std::int64_t cycle = 0;  // in which X is
  bool once = false;       // outside cycle 0 the cam holds its end
  bool held = false;       // and does so
  bool announced = false;  // the end ahead was announced
  std::int8_t announced_sense = 1;
};

// What the cam says at a place.
struct ProfilerValue {
  double x = 0;         // in the cycle of the cam
  double y_in_cam = 0;  // what the cam says there ...
  double y = 0;         // ... strokes and base added
  double dy = 0;        // over x
  double ddy = 0;
};
ProfilerValue ValueAt(const cam::Table& table, const ProfilerState& state, double x_total) noexcept;

// Lays a cam such that X is in its cycle 0 at its place `x`.
void Lay(const cam::Table& table, double x_total, double x, bool once, ProfilerState& state) noexcept;

// The end (beginning, if X goes back) that X has passed with this cycle, as x over all cycles; nothing: none. 1e-9 of a
// cycle is near enough. `state` is not yet beyond it.
struct Passed {
  double x_total = 0;
  std::int8_t sense = 1;
};
std::optional<Passed> PassedEnd(const cam::Table& table, const ProfilerState& state, double x_total) noexcept;
// Goes on with the same cam, in the cycle in which X is.
void GoOn(const cam::Table& table, double x_total, ProfilerState& state) noexcept;
// Another cam begins (X going back: ends) where this one was left. `relative`: its y begins where that of the old one
// was, else its own zero is that of the cycle.
void Change(const cam::Table& from, const cam::Table& to, const Passed& at, bool relative, bool once,
            ProfilerState& state) noexcept;

// Whether this is the last cycle before the end of the cam, by extrapolation; true once for each end.
bool AnnouncesEnd(const cam::Table& table, const Cycle& cycle, const KinematicState& x_total, bool passed,
                  ProfilerState& state) noexcept;

void describe(Description<ProfilerState>&);
void describe(Description<ProfilerValue>&);

}  // namespace takt::flexcam
