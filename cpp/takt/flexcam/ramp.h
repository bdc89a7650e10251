// The remainder of an old offset, factor or position once a new one is in force: a shift that is ramped to zero, added
// to the new value. At its begin it compensates the difference in position, velocity and acceleration, so that nothing
// steps.
#pragma once

#include <cstdint>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/profile.h"
#include "takt/trajectory/quintic.h"

namespace takt::flexcam {

enum class RampKind : std::uint8_t {
  kNone,        // zero
  kProfile,     // with its own limits
  kTime,        // a quintic over a time
  kWithMaster,  // with its own limits, and never against a master
};

// A profile with a master runs on its own clock, which stops while the master is at rest and runs backwards with it.
// With the master's speed v, and f > 0 the factor of the motion to which the shift is added (it moves at f v):
//
//   rate of the clock = share * G(v), 0 <= share <= 1, G(v) = q (1 - q / 4) with q = v / reference up to q = 2, then 1
//
// - Never against the master: no speed on the profile exceeds kShare * f * reference, and G(v) <= v / reference, so the
//   shift is never faster than kShare * f v.
// - Its own velocity: the rate is at most 1, so the shift is never faster than on the profile.
// - Its own acceleration a: while the master accelerates, the rate grows by at most a / velocity * (1 - rate^2) per
//   second; with the profile's own part, rate^2 a, the sum is at most a. While the master decelerates the share is
//   kept: a motion that must stop with the master slows down with it.
// - G is smooth, and so is the rate: nothing has a step in velocity or acceleration.
struct RampClock {
  double time_s = 0;       // [s] on the profile
  double rate = 0;         // of the clock; negative while it runs backwards
  double rate_change = 0;  // [1/s]
  double share = 1;
  double reference = 1;  // a speed of the master
  double sense = 1;      // sense of the master in which the clock runs forwards
  double velocity = 1;   // limits of the ramp itself ...
  double acceleration = 1;
  double jerk = 1;
};

struct Ramp {
  RampKind kind = RampKind::kNone;
  trajectory::Profile profile;    // over s
  trajectory::Quintic curve;      // over s
  std::uint64_t start_cycle = 0;  // start of its time
  RampClock clock;
};

// Returns the shift in this cycle; with a master: at the time to which Advance has brought the clock.
KinematicState At(const Ramp& ramp, const Cycle& cycle) noexcept;
bool IsOver(const Ramp& ramp, const Cycle& cycle) noexcept;

// Begins a ramp from `shift` (in the previous cycle) to zero. Returns false, and leaves `out` unchanged, if planning
// fails.
bool BeginProfile(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                  trajectory::Planner& planner, Ramp& out) noexcept;
// The same if only a velocity must be ramped to zero, and the position is free. The position at its end is defined as
// zero; `begin` returns the shift at its begin.
bool BeginSpeed(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                trajectory::Planner& planner, double& begin, Ramp& out) noexcept;
// Begins a quintic from `shift` (in the previous cycle) to zero over the given time.
void BeginTime(const KinematicState& shift, double duration_s, const Cycle& cycle, Ramp& out) noexcept;

// The master of a ramp. The shift is added to a motion at `factor` times `base_velocity`, a velocity of the same
// magnitude as the master's; the sum must not move against the present sense of that motion.
struct RampMaster {
  KinematicState master;
  double base_velocity = 0;
  double factor = 1;  // > 0
  trajectory::Limits limits;
};
bool BeginWithMaster(const KinematicState& shift, const RampMaster& ride, trajectory::Planner& planner,
                     Ramp& out) noexcept;
// As BeginSpeed.
bool BeginSpeedWithMaster(const KinematicState& shift, const RampMaster& ride, trajectory::Planner& planner,
                          double& begin, Ramp& out) noexcept;
// Moves the zero of a ramp with a master by `distance`, at its present rate. Returns false if planning fails.
bool MoveZero(double distance, trajectory::Planner& planner, Ramp& ramp) noexcept;
// Each cycle: advances the clock of a ramp with a master that has moved by `displacement`. No effect on other kinds.
void Advance(const KinematicState& master_before, const KinematicState& master, double displacement, const Cycle& cycle,
             trajectory::Planner& planner, Ramp& ramp) noexcept;

void describe(Enumeration<RampKind>&);
void describe(Description<RampClock>&);
void describe(Description<Ramp>&);

}  // namespace takt::flexcam
