// The touch probe: MC_TouchProbe, GT_Touch and MC_AbortTrigger (AX-49). While they wait they do not take control of the
// axis.
//
// Several MC_TouchProbe can wait at once, each for its own edge and window (AX-109), besides one GT_Touch; a second
// GT_Touch supersedes it. MC_TouchProbe is Active until its edge comes, in every state of the axis. GT_Touch in capture
// mode requires a closed loop: it is Busy until the edge, then ends the motion in progress, moves to the captured
// position and is Done there. In slow mode it is Active from the first time it slows a motion down, and never Done.
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

inline constexpr std::size_t kCaptures = 8;  // waiting MC_TouchProbe of one axis

enum class ProbeWatch : std::uint8_t { kNothing, kTouch, kSlow };

// A waiting MC_TouchProbe.
struct Capture {
  Ticket ticket = 0;
  ProbeEdge edge = ProbeEdge::kRising;
  bool window_only = false;
  double first_position = 0;  // [u]
  double last_position = 0;   // [u]
};

struct ProbeState {
  std::uint8_t waits = 0;  // number of waiting MC_TouchProbe

  // GT_Touch.
  ProbeWatch watch = ProbeWatch::kNothing;
  ProbeEdge edge = ProbeEdge::kRising;
  bool touched = false;       // the edge has come
  double touch_position = 0;  // [u] unwrapped: position at the edge
  Ticket ticket = 0;
  // GT_Touch: its limits [u/s], [u/s²], [u/s³].
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;
  // GT_Touch in slow mode: the motion slowed down, and its own velocity.
  bool slowing = false;
  bool reported = false;  // Active has been reported
  Ticket slowed = 0;
  double own_velocity = 0;

  double position = 0;         // [u] of the last capture; rotary axes: in [0, modulus)
  std::uint32_t captures = 0;  // number of captures, wraps

  // The previous sample.
  bool sampled = false;      // it exists and was good
  bool wire = false;         // the input, before inversion
  std::uint32_t counts = 0;  // raw
  std::uint32_t rises = 0;   // count of the wire's rising edges
  std::uint32_t falls = 0;
  double set_velocity = 0;  // [u/s] of the set point at that sample
  double step = 0;          // [u] from that sample to this one

  std::array<Capture, kCaptures> waiting;  // in the order in which they were given
};

// sense: detects edges and captures; after the position. The position at an edge is interpolated between two samples by
// its time stamp, with the acceleration of the set point; if the samples are not one cycle apart, it is extrapolated
// with the actual velocity.
void SenseProbe(const Context& context, const ServoInputs& inputs, State& state) noexcept;

// Discards the previous sample after a gap: edges since then are ignored.
void ForgetSample(const ServoInputs& inputs, ProbeState& probe) noexcept;

// move: gives control to a GT_Touch whose edge has come, and reports its errors; reduces the velocity of a motion in
// progress, or restores it. Before the set point.
void FollowProbe(const Context& context, State& state) noexcept;

// Ends the command with this ticket that waits for the probe, as aborted. Returns false if there is none.
bool EndProbing(const Context& context, Ticket ticket, State& state) noexcept;

// TouchProbe returns kBufferFull if kCaptures commands wait already. Touch, in capture mode only, returns kErrorStop,
// kPowerOff or kState (the axis follows another one from load on).
Status CarryOut(const Context& context, Ticket ticket, const TouchProbe& command, State& state) noexcept;
Status CarryOut(const Context& context, Ticket ticket, const AbortTrigger& command, State& state) noexcept;
Status CarryOut(const Context& context, Ticket ticket, const Touch& command, State& state) noexcept;

void describe(Enumeration<ProbeWatch>&);
void describe(Description<Capture>&);
void describe(Description<ProbeState>&);

}  // namespace takt::axis
