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
  kNone,     // zero
  kProfile,  // with limits of its own
  kTime,     // a quintic over a time
  kWay,      // the same over the way of a master
};

struct Ramp {
  RampKind kind = RampKind::kNone;
  trajectory::Profile profile;    // over s, or over the way in the sense below
  trajectory::Quintic curve;      // over s
  std::uint64_t start_cycle = 0;  // its time counts from
  double way_begin = 0;           // master's u, where it begins
  double sense = 1;               // in which the master goes on it
};

// The shift in this cycle, where the master is at `way`.
KinematicState At(const Ramp& ramp, const Cycle& cycle, const KinematicState& way) noexcept;
// The same over the way of the master: place, slope and bend per its unit. Other kinds: as for a master of that speed.
KinematicState OverWay(const Ramp& ramp, const Cycle& cycle, const KinematicState& way) noexcept;
bool IsOver(const Ramp& ramp, const Cycle& cycle, const KinematicState& way) noexcept;

// From `shift` (of the cycle before) to zero. False: there is no such plan, `out` stays.
bool BeginProfile(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                  trajectory::Planner& planner, Ramp& out) noexcept;
// The same for what has no place to get to, only a speed to lose. The place where that ends is zero: what the shift is
// at its begin comes back in `begin`.
bool BeginSpeed(const KinematicState& shift, const trajectory::Limits& limits, const Cycle& cycle,
                trajectory::Planner& planner, double& begin, Ramp& out) noexcept;
void BeginTime(const KinematicState& shift, double duration_s, const Cycle& cycle, Ramp& out) noexcept;

// Over the way of a master: what lies beneath has the slope `slope` > 0 over it, and the slope of the sum never falls
// below 0, so that it never moves against the master, whatever the master does. `shift` is over the way; the slope of
// the sum has to be >= 0 there. The limits are over time, for a master with the speed `speed` > 0.
struct WayRamp {
  double slope = 1;
  trajectory::Limits limits;
  double speed = 1;
  double sense = 1;  // in which the master goes
};
bool BeginWay(const KinematicState& shift, const WayRamp& ramp, double way, trajectory::Planner& planner,
              Ramp& out) noexcept;
// As BeginSpeed.
bool BeginWaySlope(const KinematicState& shift, const WayRamp& ramp, double way, trajectory::Planner& planner,
                   double& begin, Ramp& out) noexcept;
// A master that turned round before the ramp began goes on it the other way.
void TurnRound(const WayRamp& ramp, double way, trajectory::Planner& planner, Ramp& out) noexcept;

void describe(Enumeration<RampKind>&);
void describe(Description<Ramp>&);

}  // namespace takt::flexcam
