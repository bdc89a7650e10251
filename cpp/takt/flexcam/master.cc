#include "takt/flexcam/master.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/coupling.h"
#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

double Elapsed(const Cycle& cycle, const MasterState& m) {
  return static_cast<double>(cycle.count - m.start_cycle) * cycle.period_s;
}

// A master without an axis: a velocity, with ramps and jerk.
void FollowVirtual(const axis::Context& c, const Settings& settings, double velocity, MasterState& m) {
  m.known = true;
  if (velocity != m.velocity) {
    const trajectory::Limits limits = {std::max({std::abs(velocity), std::abs(m.now.velocity), 1e-9}),
                                       settings.virtual_acceleration, settings.virtual_acceleration,
                                       settings.virtual_jerk};
    if (c.planner.ToVelocity(m.now, velocity, limits, m.motion).ok()) {
      m.velocity = velocity;
      m.start_cycle = c.cycle.count - 1;
    }
  }
  m.now = m.motion.At(Elapsed(c.cycle, m));
}

KinematicState Measured(const axis::Context& c, const axis::State& master, const Settings& settings, MasterState& m) {
  const KinematicState raw = {master.actual.position + master.origin, master.actual.velocity,
                              master.loop_closed ? master.setpoint.acceleration : 0};
  if (settings.master_filter_s == 0) {
    m.filter.running = false;
    const double t = settings.master_dead_time_s;
    return {raw.position + t * (raw.velocity + 0.5 * t * raw.acceleration), raw.velocity + t * raw.acceleration,
            raw.acceleration};
  }
  return trajectory::Track(settings.master_filter_s, settings.master_dead_time_s, c.cycle.period_s, raw.position,
                           raw.velocity, m.filter);
}

}  // namespace

void Follow(const axis::Context& c, std::optional<std::uint32_t> index, axis::MasterSource source,
            const Settings& settings, double virtual_velocity, bool coast, MasterState& m) noexcept {
  m.before = m.now;
  if (!index) return FollowVirtual(c, settings, virtual_velocity, m);
  const axis::State& master = c.machine.states[*index];
  m.known = axis::IsKnown(master, source);
  if (!m.known) m.coasts = coast;
  if (m.coasts) {
    m.filter.running = false;
    m.now = {m.before.position + c.cycle.period_s * m.before.velocity, m.before.velocity, 0};
  } else if (source == axis::MasterSource::kActualValue) {
    m.now = Measured(c, master, settings, m);
  } else {
    m.now = {master.setpoint.position + master.origin, master.setpoint.velocity, master.setpoint.acceleration};
  }
}

double ZeroOf(const axis::Context& c, std::optional<std::uint32_t> master) noexcept {
  return master ? c.machine.states[*master].origin : 0;
}

double TurnOf(const axis::Context& c, std::optional<std::uint32_t> master) noexcept {
  return master && c.machine.params[*master].rotary() ? c.machine.params[*master].modulus : 0;
}

void describe(Description<MasterState>& d) {
  using M = MasterState;
  d.about("What a cam module follows.");
  d.internal<&M::now>("Over all turns.");
  d.internal<&M::before>("In the cycle before.");
  d.internal<&M::known>("Its position is known.");
  d.internal<&M::coasts>("It goes on as it was.");
  d.internal<&M::filter>("Of what is measured.");
  d.internal<&M::motion>("Of a virtual master.");
  d.internal<&M::start_cycle>("Cycle its time counts from.");
  d.internal<&M::velocity>("That a virtual master gets to.");
}

}  // namespace takt::flexcam
