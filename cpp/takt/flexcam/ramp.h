// What is left of an old offset, factor or place once a new one is in force: a shift on its way to zero, added to what
// is in force. At its begin it makes up for the difference in position, velocity and acceleration, so that nothing
// jumps.
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
  kProfile,     // with limits of its own
  kTime,        // a quintic over a time
  kWithMaster,  // with limits of its own, and never against a master
};

// A profile with a master runs on a clock of its own: the clock stands while the master stands, and goes back with it.
// With the master's speed v, and f > 0 the factor of what the shift is added to (it moves at f v):
//
//   rate of the clock = share * G(v), 0 <= share <= 1, G(v) = q (1 - q / 4) with q = v / reference up to q = 2, then 1
//
// - Never against the master: no speed on the profile is more than kShare * f * reference, and G(v) <= v / reference,
//   so the shift is never faster than kShare * f v.
// - Its own velocity: the rate is at most 1, so the shift is never faster than on the profile.
// - Its own acceleration a: while the master gets faster, the rate grows by a / velocity * (1 - rate^2) per second at
//   most; with the profile's own part, rate^2 a, the sum is at most a. While the master gets slower the share stays:
//   what has to stop with the master slows down with it.
// - G is smooth, and so is the rate: nothing has a step in velocity or acceleration.
struct RampClock {
  double time_s = 0;       // on the profile
  double rate = 0;         // of it; negative while it goes back
  double rate_change = 0;  // 1/s
  double share = 1;
  double reference = 1;  // a speed of the master
  double sense = 1;      // of the master in which the clock goes on
  double velocity = 1;   // of the ramp's own ...
  double acceleration = 1;
  double jerk = 1;
};

struct Ramp {
  RampKind kind = RampKind::kNone;
  trajectory::Profile profile;    // over s
  trajectory::Quintic curve;      // over s
  std::uint64_t start_cycle = 0;  // its time counts from
  RampClock clock;
};

// The shift in this cycle; with a master: where Advance has brought it.
KinematicState At(const Ramp& ramp, const Cycle& cycle) noexcept;
bool IsOver(const Ramp& ramp, const Cycle& cycle) noexcept;

// From `shift` (of the cycle before) to zero. False: there is no such plan, `out` stays.
bool BeginProfile(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                  trajectory::Planner& planner, Ramp& out) noexcept;
// The same for what has no place to get to, only a speed to lose. The place where that ends is zero: what the shift is
// at its begin comes back in `begin`.
bool BeginSpeed(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                trajectory::Planner& planner, double& begin, Ramp& out) noexcept;
void BeginTime(const KinematicState& shift, double duration_s, const Cycle& cycle, Ramp& out) noexcept;

// What a ramp with a master goes by. The shift is added to something that moves at `factor` times `base_velocity`, a
// velocity with the size of the master's; the sum must not move against that as it is.
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
// Moves the zero of a ramp with a master by `distance`, at the rate it has.
bool MoveZero(double distance, trajectory::Planner& planner, Ramp& ramp) noexcept;
// Each cycle: the clock of a ramp with a master, which has moved by `displacement`. Other kinds need none.
void Advance(const KinematicState& master_before, const KinematicState& master, double displacement, const Cycle& cycle,
             trajectory::Planner& planner, Ramp& ramp) noexcept;

void describe(Enumeration<RampKind>&);
void describe(Description<RampClock>&);
void describe(Description<Ramp>&);

}  // namespace takt::flexcam
