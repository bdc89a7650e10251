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

// A virtual master: a velocity with ramps and jerk.
void FollowVirtual(const axis::Context& c, const Settings& settings, double velocity, MasterState& m) {
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

KinematicState Filtered(const axis::Context& c, const KinematicState& raw, const Settings& settings, MasterState& m) {
  if (settings.master_filter_s == 0) {
    m.filter.running = false;
    const double t = settings.master_dead_time_s;
    return {raw.position + t * (raw.velocity + 0.5 * t * raw.acceleration), raw.velocity + t * raw.acceleration,
            raw.acceleration};
  }
  const trajectory::TrackingFilter filter{.filter_s = settings.master_filter_s,
                                          .dead_time_s = settings.master_dead_time_s};
  return trajectory::Track(filter, c.cycle.period_s, raw.position, raw.velocity, m.filter);
}

const axis::OutsideMaster* Outside(const axis::Context& c, std::uint32_t master) {
  const std::size_t axes = c.machine.states.size();
  return master < axes ? nullptr : &c.machine.outside[master - axes];
}

}  // namespace

MasterSeen SeeMaster(const axis::Context& c, std::uint32_t master, axis::MasterSource source) noexcept {
  if (const axis::OutsideMaster* outside = Outside(c, master)) {
    return {outside->at, outside->origin, 0, outside->known, true};
  }
  const axis::State& s = c.machine.states[master];
  const axis::AxisParams& params = c.machine.params[master];
  const bool measured = source == axis::MasterSource::kActualValue;
  KinematicState at = measured ? s.actual : s.setpoint;
  at.position += s.origin;
  if (measured) at.acceleration = s.loop_closed ? s.setpoint.acceleration : 0;
  return {at, s.origin, params.turn(), axis::IsKnown(s, source), measured};
}

void Follow(const axis::Context& c, std::optional<std::uint32_t> index, axis::MasterSource source,
            const Settings& settings, double virtual_velocity, bool coast, MasterState& m) noexcept {
  m.before = m.now;
  if (!index) {
    m.known = true;
    return FollowVirtual(c, settings, virtual_velocity, m);
  }
  const MasterSeen seen = SeeMaster(c, *index, source);
  m.known = seen.known;
  if (!m.known && coast && !m.coasts) {
    m.coasts = true;
    m.comes_to_rest = m.before.velocity * m.before.acceleration < 0;
    m.velocity = m.before.velocity;
    m.motion = trajectory::Profile{{m.before.position, m.before.velocity, 0}};
    m.start_cycle = c.cycle.count - 1;
  }
  if (m.coasts) {
    m.filter.running = false;
    FollowVirtual(c, settings, m.comes_to_rest ? 0 : m.velocity, m);
  } else {
    m.now = source == axis::MasterSource::kActualValue ? Filtered(c, seen.at, settings, m) : seen.at;
  }
}

double ZeroOf(const axis::Context& c, std::optional<std::uint32_t> master) noexcept {
  if (!master) return 0;
  const axis::OutsideMaster* outside = Outside(c, *master);
  return outside ? outside->origin : c.machine.states[*master].origin;
}

double TurnOf(const axis::Context& c, std::optional<std::uint32_t> master) noexcept {
  return master && Outside(c, *master) == nullptr ? c.machine.params[*master].turn() : 0;
}

double ReportedOf(const axis::Context& c, std::optional<std::uint32_t> master, double position) noexcept {
  if (!master || Outside(c, *master) != nullptr) return position;
  return axis::Reported(c.machine.params[*master], position);
}

void describe(Description<MasterState>& d) {
  using M = MasterState;
  d.about("Master of a cam module.");
  d.internal<&M::now>("State over all turns.");
  d.internal<&M::before>("State in the previous cycle.");
  d.internal<&M::known>("Its position is known.");
  d.internal<&M::coasts>("The position is not known; the last motion continues.");
  d.internal<&M::comes_to_rest>("The master was decelerating when it was lost, and comes to rest.");
  d.internal<&M::filter>("Filter of a measured master.");
  d.internal<&M::motion>("Motion of a virtual master.");
  d.internal<&M::start_cycle>("Cycle from which its time counts.");
  d.internal<&M::velocity>("Target velocity of a virtual master.");
}

}  // namespace takt::flexcam
