#include "takt/axis/correction.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/axis.h"
#include "takt/core/describe.h"

namespace takt::axis {

namespace {

// Share of the velocity limit below which a velocity counts as standstill.
constexpr double kStandingShare = 1e-9;

// Returns the displacement [u] of the load relative to the encoder on the motor, linear between two entries.
double ScrewError(const std::vector<ScrewPoint>& table, double position) noexcept {
  if (table.empty()) return 0;
  const auto above = std::upper_bound(table.begin(), table.end(), position,
                                      [](double at, const ScrewPoint& point) { return at < point.position; });
  if (above == table.begin()) return table.front().error;
  if (above == table.end()) return table.back().error;
  const ScrewPoint& low = *(above - 1);
  return low.error + (above->error - low.error) * (position - low.position) / (above->position - low.position);
}

// Returns the highest velocity from which steps of `step` per cycle come to rest within `left` exactly: in n cycles,
// each slower than the previous one by one step, so n (left / n period + (n - 1) step / 2) reach it.
double LandingSpeed(double left, double step, double period_s) noexcept {
  if (left == 0) return 0;
  const double cycles = std::max(1.0, std::ceil(std::sqrt(0.25 + 2 * left / (step * period_s)) - 0.5));
  return left / (cycles * period_s) + 0.5 * (cycles - 1) * step;
}

// Moves the correction towards the target with limited velocity and acceleration, without overshoot.
void Approach(double target, double velocity, double acceleration, double period_s, CorrectionState& k) noexcept {
  const double left = target - k.now;
  const double step = acceleration * period_s;
  const double wanted = std::copysign(std::min(velocity, LandingSpeed(std::abs(left), step, period_s)), left);
  k.rate += std::clamp(wanted - k.rate, -step, step);
  k.now += k.rate * period_s;
}

}  // namespace

void SenseLoad(const Context& c, const ServoInputs& in, std::uint32_t cycles, double largest_step,
               EncoderOutputs& motor, State& s) noexcept {
  CorrectionState& k = s.correction;
  EncoderOutputs load;
  Step(*c.params.load_encoder, {in.load_counts, in.load_encoder_error, largest_step, cycles}, c.cycle, k.load, load);
  const bool error = motor.error || load.error;
  if (!error) {
    k.now = motor.position - load.position;
    k.rate = motor.velocity - load.velocity;
    if (!k.load_known) k.load_offset = k.now;
    k.load_known = true;
    const std::optional<double>& most = c.params.supervision.encoders_apart;
    const bool loose = most && std::abs(k.now - k.load_offset) > *most;
    if (loose) Fail(c, ErrorId::kEncodersApart, true, s);
  }
  motor.error = error;
}

void Correct(const Context& c, State& s) noexcept {
  const Compensation& p = c.params.compensation;
  CorrectionState& k = s.correction;
  const double standing = kStandingShare * c.params.limits.velocity;
  const double velocity = s.setpoint.velocity;
  if (s.loop_closed && !s.torque.engaged && std::abs(velocity) > standing) k.sense = velocity > 0 ? 1 : -1;
  // The table refers to positions as the reference defines them, which an axis without reference does not know.
  const double place = Reported(c.params, s.setpoint.position - s.homing.renamed);
  const double screw = s.homing.homed ? ScrewError(p.screw, place) : 0;
  const double target = k.sense * p.backlash / 2 - screw;
  if (s.loop_closed) {
    const trajectory::Limits limits = c.params.planner_limits();
    const double fastest = p.velocity.value_or(kCorrectionShare * limits.velocity);
    return Approach(target, fastest, std::min(limits.acceleration, limits.deceleration), c.cycle.period_s, k);
  }
  k.now = target;
  k.rate = 0;
}

void describe(Description<CorrectionState>& d) {
  using K = CorrectionState;
  d.about("Difference between the encoder on the motor and the axis.");
  d.internal<&K::now>(unit::u, "Motor minus axis.");
  d.internal<&K::rate>(unit::u_s, "Rate of change of the difference.");
  d.internal<&K::sense>("Sense of the last motion.");
  d.internal<&K::load>("Encoder on the load.");
  d.internal<&K::load_known>("Motor and load have both been measured.");
  d.internal<&K::load_offset>(unit::u, "Motor minus load when both were first measured.");
}

}  // namespace takt::axis
