#include "takt/axis/control_loop.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::axis {

namespace {

double WithDeadBand(const ControlLoop& p, double volts) noexcept {
  if (volts >= kVoltageStep / 2) return volts + p.dead_band_plus_mv / 1000;
  if (volts <= -kVoltageStep / 2) return volts - p.dead_band_minus_mv / 1000;
  return volts;
}

}  // namespace

double InConverterSteps(double volts) noexcept {
  constexpr auto kLargestCode = kVoltageSteps / 2 - 1;
  return std::min(std::round(volts / kVoltageStep), double{kLargestCode}) * kVoltageStep;
}

void Step(const ControlLoop& p, const ControlLoopInputs& in, Cycle cycle, ControlLoopState& s,
          ControlLoopOutputs& out) noexcept {
  out = {};
  if (!in.closed) {
    s = {};
    return;
  }
  const bool analogue = in.mode == DriveMode::kAnalog;
  const double largest_speed = p.velocity_at_10v;                          // [u/s]
  const double largest_output = analogue ? kVoltageLimit : largest_speed;  // [V] or [u/s]
  const double sense = in.invert ? -1 : 1;
  const double output_per_speed = sense * (analogue ? kVoltageLimit / largest_speed : 1);
  const double output_per_sum = output_per_speed / cycle.period_s;
  const double largest_sum = largest_speed * cycle.period_s;  // [u]

  const double last_error = s.error;
  s.error = in.model_position - in.feedback;
  s.p = p.kp * s.error;
  s.i = p.ki > 0 ? s.integral + p.ki * s.error : 0;  // without integration I is 0
  s.d = s.closed ? p.kd * (s.error - last_error) : 0;

  s.sum = s.p + s.i + s.d;
  s.limited = std::clamp(s.sum, -largest_sum, largest_sum);

  s.converted = s.limited * output_per_sum;
  s.feed_forward = p.ff * in.model_velocity * output_per_speed;
  s.compensated = s.converted + s.feed_forward;
  if (analogue) s.compensated = WithDeadBand(p, s.compensated) + p.offset_mv / 1000;
  s.output = std::clamp(s.compensated, -largest_output, largest_output);

  const double cut_off = s.sum - s.limited + (s.compensated - s.output) / output_per_sum;
  s.integral = s.i - std::clamp(p.kc * cut_off, std::min(s.i, 0.0), std::max(s.i, 0.0));

  if (analogue) s.output = InConverterSteps(s.output);
  (analogue ? out.voltage_v : out.velocity) = s.output;
  s.closed = true;
}

void describe(Description<ControlLoop>& d) {
  using P = ControlLoop;
  d.about(
      "The position loop: a sampled PID with velocity feed-forward. P, I and D are positions; their sum is the "
      "displacement to be made up for within one cycle of T seconds.");
  d.defaulted<&P::kp>(between(0, 1e6), "Proportional gain: P = kp e. In a speed gain Kv: kp = T Kv.");
  d.defaulted<&P::ki>(between(0, 1e6), "Integral gain: ki e is added to I each cycle. T / Ti.");
  d.defaulted<&P::kd>(between(0, 1e6), "Derivative gain: D = kd (e - e of the cycle before). Td / T.");
  d.defaulted<&P::kc>(
      between(0, 1),
      "Share of the part cut off by the limiters that is subtracted from I, at most down to 0; 0: I may wind up.");
  d.defaulted<&P::ff>(between(0, 10), "Share of the set velocity that is fed forward.");
  d.defaulted<&P::velocity_at_10v>(unit::u_s, Range{.min = 0, .max = 1e9, .without_min = true},
                                   "Velocity limit of the loop; analogue drives: the speed at 10 V.");
  constexpr Unit kMillivolt{"mV", ""};
  d.defaulted<&P::offset_mv>(kMillivolt, between(-10000, 10000),
                             "Analogue drives: voltage that is always added, against the drive's own offset.");
  d.defaulted<&P::dead_band_plus_mv>(
      kMillivolt, between(0, 10000),
      "Analogue drives: voltage added to positive voltages, against the dead band of the drive.");
  d.defaulted<&P::dead_band_minus_mv>(kMillivolt, between(0, 10000),
                                      "Analogue drives: voltage subtracted from negative voltages.");
}

void describe(Description<ControlLoopState>& d) {
  using S = ControlLoopState;
  d.about("Signals of the position loop in the order of its block diagram, and its memory.");
  d.internal<&S::error>(unit::u, "Set point minus measured position.");
  d.internal<&S::p>(unit::u, "Proportional term.");
  d.internal<&S::i>(unit::u, "Integral term.");
  d.internal<&S::d>(unit::u, "Derivative term.");
  d.internal<&S::sum>(unit::u, "Sum of the terms.");
  d.internal<&S::limited>(unit::u, "Sum, limited to Vmax.");
  d.internal<&S::converted>("Limited sum in V, or u/s on csv drives.");
  d.internal<&S::feed_forward>("Velocity feed-forward in V, or u/s on csv drives.");
  d.internal<&S::compensated>("Sum of both with dead band and offset compensated, in V; or u/s on csv drives.");
  d.internal<&S::output>("Command to the drive in V, or u/s on csv drives.");
  d.internal<&S::integral>(unit::u, "Start value of the integral term in the next cycle.");
  d.internal<&S::closed>("The loop was closed in the previous cycle.");
}

}  // namespace takt::axis
