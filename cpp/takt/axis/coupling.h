// Axes coupled at run time: gears, their phase, sums of two masters, cams.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "takt/axis/cam_law.h"
#include "takt/axis/master_filter.h"
#include "takt/axis/request.h"
#include "takt/core/cycle.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"
#include "takt/trajectory/demand_follower.h"
#include "takt/trajectory/profile.h"
#include "takt/trajectory/quintic.h"

namespace takt::axis {

struct Context;
struct State;
struct MachineView;

// Progress of synchronisation (GearInPos, CamIn).
enum class Joining : std::uint8_t {
  kWaiting,  // the master has not yet reached the start of synchronisation
  kOnCurve,  // on a curve over the master's position that ends in step
  kJoined,
};

// A cam added to that of the coupling (CAM-90).
struct AddedCam {
  std::uint32_t table = kNoTable;  // index among the machine's cams; kNoTable: none
  double ratio = 1;                // [x per master's u]
  double scale = 1;                // of y
  bool periodic = false;
  CamState cam;
};
inline constexpr std::size_t kAddedCams = 3;

struct CouplingState {
  CouplingRequest law;  // in force
  trajectory::DemandFollowerState chase;
  bool filtered = false;  // a measured master has a filter
  bool in_step = false;   // in step with the masters, as far as their positions are known
  bool locked = false;    // follows the position; gears and sums: only once they have been in step
  Joining joining = Joining::kJoined;
  double master_sync = 0;     // [master's u] over all turns: where synchronisation ends, ...
  double slave_sync = 0;      // [u] ... and the slave position there, over all turns
  double turn = 0;            // [master's u] distance to the next such master position; 0: there is only one
  double curve_begin = 0;     // [master's u] where the curve begins
  double begin_side = 0;      // [master's u] distance of the master from there when the wait began
  trajectory::Quintic curve;  // [u] over the master's displacement from there
  CamState cam;
  std::array<AddedCam, kAddedCams> added;

  // The phase: a motion in the master's unit that is added to its position.
  trajectory::Profile phase;
  std::uint64_t phase_start = 0;
  double phase_now = 0;    // [master's u] added by now
  double phase_begin = 0;  // [master's u] added when the last relative shift began; 0 for an absolute one
  Ticket phase_ticket = 0;
  bool phase_moves = false;

  std::array<MasterFilter, 2> filters;  // of measured masters
};

// Returns true for commands that couple the axis to masters.
inline bool Couples(RequestKind kind) noexcept {
  return kind == RequestKind::kGearIn || kind == RequestKind::kGearInPos || kind == RequestKind::kCombineAxes ||
         kind == RequestKind::kCamIn;
}
// Returns true if this position of a master is known. A set point requires a closed loop. An actual position does not;
// it is unknown with an encoder error, while the drive is not heard during a stop (`blind`), and with an open loop from
// a fault until its reset: how far the master moves meanwhile is not known.
bool IsKnown(const State& master, MasterSource source) noexcept;
// Returns the number of an axis, or of an outside master; kNoAxis if there is none of that name.
std::uint32_t FindMaster(const MachineView& machine, std::string_view name) noexcept;
// Returns true if the command in control, a buffered one or an added cam uses this table.
bool UsesTable(const State& state, std::uint32_t index) noexcept;
// Looks up the masters and the table of a request. Returns kUnknownTarget if an axis or the table does not exist.
Status FindNamed(const Context& c, Request& r) noexcept;
// Returns kMasterOff if the position of a master is not known, kTargetBehindLimit for a slave position beyond the SW
// limits, kNoReference if an absolute position needs a reference that the axis does not have.
Status MayCouple(const Context& c, const Request& r, const State& s) noexcept;
// Puts a request that couples in control. Requires: the command that was in control has been ended.
void Couple(const Context& c, const Request& r, State& s) noexcept;
// Couples anew in place of the coupling in control (AX-111). Its phase stays, and continues once in step; so do the
// cams that were added.
void CoupleAgain(const Context& c, const Request& r, State& s) noexcept;
// Takes over from the cam in control, with the same table and master but other scales and offsets (AX-111); a relative
// cam keeps its position in the table. Added cams and the phase stay.
void UpdateCam(const Context& c, const Request& r, State& s) noexcept;
// Computes the next set point of a coupled axis. Returns false if it is not, or no longer, coupled.
bool FollowMasters(const Context& c, State& s) noexcept;
// Returns true if the axis is coupled to a master that was switched off or has failed, so that it cannot be followed
// (AX-55).
bool LostMasters(const Context& c, const State& s) noexcept;
// Shifts the master's position as this axis sees it. Returns kState unless the axis is coupled to exactly one master.
Status CarryOut(const Context& c, Ticket ticket, const PhasingAbsolute& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const PhasingRelative& command, State& s) noexcept;
// Adds another cam to that of cam_in, or removes it. Returns kState if the axis follows no cam or the one to remove was
// not added, kBufferFull if there is no room.
Status CarryOut(const Context& c, Ticket ticket, const CamAdd& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const CamRemove& command, State& s) noexcept;
// GearOut, CamOut: ends the coupling; the axis keeps its velocity.
Status LetGo(const Context& c, const Request& r, State& s) noexcept;
// Ends the coupling and its phase. After a fault `law` keeps the masters until they were stopped, too (AX-55).
void Uncouple(const Context& c, bool after_fault, State& s) noexcept;
// Gets the masters that a command for this axis couples to. Returns false if it couples to none, or would be rejected.
bool CouplingOf(const Context& c, const Command& command, CouplingRequest& out) noexcept;

void describe(Enumeration<Joining>&);
void describe(Description<AddedCam>&);
void describe(Description<CouplingState>&);

}  // namespace takt::axis
