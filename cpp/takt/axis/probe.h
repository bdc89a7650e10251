// The touch probe: MC_TouchProbe, GT_Touch and MC_AbortTrigger (AX-49). They take no control of the axis while they
// wait.
//
// Several MC_TouchProbe wait at once, each for its own edge and window (AX-109), and beside them one GT_Touch; a second
// GT_Touch supersedes it. MC_TouchProbe is Active until its edge comes, in every state of the axis. GT_Touch needs an
// axis in its loop: capturing, it is Busy until the edge, then ends the motion in progress, brakes and is Done at the
// captured position; slowing, it is Active from the first time it slows a motion down, and never done.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/axis/commands/probe.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/ports.h"
#include "takt/core/status.h"
#include "takt/trajectory/limits.h"

namespace takt::axis {

struct Context;
struct State;

inline constexpr std::size_t kCaptures = 8;  // that wait for one probe

enum class ProbeWatch : std::uint8_t { kNothing, kTouch, kSlow };

// An MC_TouchProbe that waits.
struct Capture {
  Ticket ticket = 0;
  ProbeEdge edge = ProbeEdge::kRising;
  bool window_only = false;
  double first_position = 0;  // [u]
  double last_position = 0;   // [u]
};

struct ProbeState {
  std::uint8_t waits = 0;  // how many MC_TouchProbe wait

  // GT_Touch.
  ProbeWatch watch = ProbeWatch::kNothing;
  ProbeEdge edge = ProbeEdge::kRising;
  bool touched = false;       // the edge came in this cycle ...
  double touch_position = 0;  // [u] unwrapped: ... here
  Ticket ticket = 0;
  // GT_Touch: its limits.
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;
  // GT_Touch, slowing: which motion, and what it had before.
  bool slowing = false;
  bool reported = false;  // Active is out
  Ticket slowed = 0;
  double own_velocity = 0;

  double position = 0;         // [u] of the last capture; rotary axes: in [0, modulus)
  std::uint32_t captures = 0;  // how many there were, wraps

  // The sample before.
  bool sampled = false;      // there is one, and it was good
  bool wire = false;         // the input, before inversion
  std::uint32_t counts = 0;  // raw
  std::uint32_t rises = 0;   // of the wire
  std::uint32_t falls = 0;
  double set_velocity = 0;  // [u/s] of the set point for that sample
  double step = 0;          // [u] from there to this one

  std::array<Capture, kCaptures> waiting;  // in the order in which they were given
};

// Stage sense, after the position: finds edges and captures. The position at an edge is interpolated between two
// samples at its time stamp, with the acceleration of the set point; extrapolated by the actual velocity where the
// samples are not one cycle apart.
void SenseProbe(const Context& context, const ServoInputs& inputs, State& state) noexcept;

// Discards the previous sample after a gap: edges since then are ignored.
void ForgetSample(const ServoInputs& inputs, ProbeState& probe) noexcept;

// Stage move, before the set point: gives control to a GT_Touch once its edge has come, and reports the errors of its
// motion; lowers the velocity of a motion in progress, or restores it.
void FollowProbe(const Context& context, State& state) noexcept;

// Ends the command with this ticket that waits for the probe, as aborted. False: there is none.
bool EndProbing(const Context& context, Ticket ticket, State& state) noexcept;

// Errors. TouchProbe: kBufferFull where kCaptures commands wait. Touch, in capture mode only: kErrorStop, kPowerOff,
// kState (the axis follows another one).
Status CarryOut(const Context& context, Ticket ticket, const TouchProbe& command, State& state) noexcept;
Status CarryOut(const Context& context, Ticket ticket, const AbortTrigger& command, State& state) noexcept;
Status CarryOut(const Context& context, Ticket ticket, const Touch& command, State& state) noexcept;

void describe(Enumeration<ProbeWatch>&);
void describe(Description<Capture>&);
void describe(Description<ProbeState>&);

}  // namespace takt::axis
