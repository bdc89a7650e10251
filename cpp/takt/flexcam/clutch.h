// The clutch between Y and the slave (the manual's 3.14 to 3.16, 3.20, 3.21).
//
// Closing over the master's way the slave goes on a quintic from where it is to where the cam wants it at the sync
// position; over time, or with limits of its own, what lies between the slave and Y is brought to zero while Y moves as
// it likes. Opening it goes to its sync-out position in the same ways. None of that makes the slave's position,
// velocity or acceleration jump; what is asked to happen at once is chased within the slave's limits (axis/guidance.h).
//
// Without reversing (PositionControl::kMasterDirection) a curve over the master's way is only taken if its slope keeps
// one sign; else the next turn of a rotary slave is tried, then a later begin: a shorter way is steeper but does not
// turn round. If none serves, the closing is refused, and the opening waits on the cam until one does.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/params.h"
#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/flexcam/ramp.h"
#include "takt/flexcam/settings.h"
#include "takt/flexcam/way.h"
#include "takt/trajectory/quintic.h"

namespace takt::flexcam {

enum class ClutchPhase : std::uint8_t {
  kOpen,
  kWaitingIn,  // the master is not yet where it begins to close
  kClosing,
  kClosed,
  kWaitingOut,  // still on the cam: the master stands, or the slave would reverse
  kOpening,
  kReleased,  // opened at once; the slave comes to rest by itself
};

// What the slave was on when a curve over the master's way began.
enum class CurveOrigin : std::uint8_t { kRest, kCam, kCurve };

struct ClutchState {
  ClutchPhase phase = ClutchPhase::kOpen;
  ClutchMode mode = ClutchMode::kAbsolute;  // in which it closes or opens
  Ramp ramp;                                // of the modes over time
  trajectory::Quintic curve;                // of the mode over the master's way
  double curve_begin = 0;                   // master's u, where the curve begins
  double sense = 1;                         // in which the master goes on it
  KinematicState end;                       // of the curve, over the master's way
  double distance = 0;                      // master's u, before the sync position: where it begins
  double planned_sense = 0;                 // for which that was planned; 0: not yet
  double looked_from = 0;                   // waiting: where the master was before it was looked at last
  double out = 0;                           // u over all turns, where the slave is to rest
  ClutchMode next = ClutchMode::kAbsolute;  // waiting: in which it is to close; `mode` is that of an opening still
  bool opens_still = false;                 // waiting: it had not come to its end when it was told to close
  double waits_since = 0;                   // waiting to open: master's u, where that began
  bool leaves = false;                      // closing: it is to open as soon as it can
  // What the slave did before the curve: where a master that goes back behind its begin finds it.
  CurveOrigin origin = CurveOrigin::kRest;
  trajectory::Quintic before;
  double before_begin = 0;
  double before_sense = 1;
  CurveOrigin before_origin = CurveOrigin::kRest;
};

// All that is not the clutch's own. Positions are over all turns.
struct ClutchContext {
  const Cycle& cycle;
  trajectory::Planner& planner;
  const Settings& settings;
  const axis::AxisParams& slave;
  const cam::Table& table;
  double master_turn = 0;  // master's u; 0: it has none
  double master_zero = 0;  // where the master's own position is 0
  double slave_zero = 0;
  KinematicState master, master_before;  // in this cycle and the one before
  KinematicState own_before;             // set point of the slave in the cycle before
  KinematicState wanted_before;          // by Y, in the cycle before
  bool in_step = false;                  // the slave's set point was what was wanted of it
  bool at_rest = false;
};

bool IsCoupled(const ClutchState& state) noexcept;  // the slave goes by the clutch
bool IsFrozen(const ClutchState& state) noexcept;   // scaling and offset of the slave stay (CAM-38)
// On the way to a place that was foreseen, or back to where that way began: the cam, and scaling and offset of the
// master, stay, too.
bool IsOnCurve(const ClutchState& state) noexcept;

// Whether a curve over the master's way can be found at all; the turn of a rotary slave and the way it needs are chosen
// then. Without a sense of the master there is nothing to say yet.
void BeginClosing(const ClutchContext& c, Way& way, ClutchState& state) noexcept;
void BeginOpening(const ClutchContext& c, ClutchState& state) noexcept;

// Each cycle: what the slave is to do, `wanted` being what Y says. Answers kWouldReverse where the closing is refused,
// and where the opening found no way within a whole cycle of the cam: then the slave stays on the cam.
Status StepClutch(const ClutchContext& c, const KinematicState& wanted, Way& way, ClutchState& state,
                  KinematicState& demand) noexcept;

void describe(Enumeration<ClutchPhase>&);
void describe(Enumeration<CurveOrigin>&);
void describe(Description<ClutchState>&);

}  // namespace takt::flexcam
