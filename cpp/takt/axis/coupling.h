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

// How far the way into step has come (GearInPos, CamIn).
enum class Joining : std::uint8_t {
  kWaiting,  // the master is not yet where it begins
  kOnCurve,  // on a curve over the master's position that ends in step
  kJoined,
};

// A cam on top of that of the coupling (CAM-90).
struct AddedCam {
  std::uint32_t table = kNoTable;  // index among the machine's cams; kNoTable: there is none
  double ratio = 1;                // x per master's u
  double scale = 1;                // of y
  bool periodic = false;
  CamState cam;
};
inline constexpr std::size_t kAddedCams = 3;

struct CouplingState {
  CouplingRequest law;  // in force
  trajectory::DemandFollowerState chase;
  bool filtered = false;  // a master is measured and has a filter
  bool in_step = false;   // with the masters, as far as they are known
  bool locked = false;    // followed by place: gears and sums are from when they were in step first
  Joining joining = Joining::kJoined;
  double master_sync = 0;     // master's u over all turns, where both are in step ...
  double slave_sync = 0;      // ... with the slave here (u over all turns)
  double turn = 0;            // after so far there is the next such place of the master; 0: there is none
  double curve_begin = 0;     // master's u, where the curve begins
  double begin_side = 0;      // on which side of that the master was when it was last looked at
  trajectory::Quintic curve;  // u, over the master's way from there on
  CamState cam;
  std::array<AddedCam, kAddedCams> added;

  // The phase: a motion in the master's unit on top of its position.
  trajectory::Profile phase;
  std::uint64_t phase_start = 0;
  double phase_now = 0;    // master's u, what has been added by now ...
  double phase_begin = 0;  // ... and had been when the last shift by an amount began; to an amount: 0
  Ticket phase_ticket = 0;
  bool phase_moves = false;

  std::array<MasterFilter, 2> filters;  // of the masters that are measured
};

inline bool Couples(RequestKind kind) noexcept {
  return kind == RequestKind::kGearIn || kind == RequestKind::kGearInPos || kind == RequestKind::kCombineAxes ||
         kind == RequestKind::kCamIn;
}
// Whether that position of a master is known. What is measured does without power, but not with a fault until it was
// reset: how far the master moves meanwhile is not known.
bool IsKnown(const State& master, MasterSource source) noexcept;
// The number of an axis, or of what else can be followed; kNoAxis: there is none of that name.
std::uint32_t FindMaster(const MachineView& machine, std::string_view name) noexcept;
// Whether the command in control or a buffered one follows this table.
bool UsesTable(const State& state, std::uint32_t index) noexcept;
// Finds the masters and the table of a request. kUnknownTarget: there is no such axis, or no such table.
Status FindNamed(const Context& c, Request& r) noexcept;
// kNoReference: positions of this axis mean nothing yet.
Status MayCouple(const Context& c, const Request& r, const State& s) noexcept;
// Puts a request that couples in control. What was in control must have been ended.
void Couple(const Context& c, const Request& r, State& s) noexcept;
// Couples anew in place of the coupling in control (AX-111). Its phase stays, and continues once in step; so do the
// cams that have been added to a cam.
void CoupleAgain(const Context& c, const Request& r, State& s) noexcept;
// Takes over from the cam in control, of the same table and master, with other scales and offsets (AX-111): a relative
// one stays where it is in the cam. What has been put on top of it, and its phase, stay.
void UpdateCam(const Context& c, const Request& r, State& s) noexcept;
// The next set point of a coupled axis; false: it is not (any more) coupled.
bool FollowMasters(const Context& c, State& s) noexcept;
// Whether it is coupled to a master that was switched off or has failed: it cannot follow any more (AX-55).
bool LostMasters(const Context& c, const State& s) noexcept;
// Shifts what the axis takes for its master's position. kState: not coupled to one master.
Status CarryOut(const Context& c, Ticket ticket, const PhasingAbsolute& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const PhasingRelative& command, State& s) noexcept;
// Puts another cam on top of that of cam_in, or takes it off again. kState: the axis follows no cam, or has no
// such cam on top; kBufferFull: there is no room.
Status CarryOut(const Context& c, Ticket ticket, const CamAdd& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const CamRemove& command, State& s) noexcept;
// GearOut, CamOut: on with the velocity there is.
Status LetGo(const Context& c, const Request& r, State& s) noexcept;
// The coupling is over, and its phase with it. After a fault its masters are kept until they were stopped, too (AX-55).
void Uncouple(const Context& c, bool after_fault, State& s) noexcept;
// The masters that a command for this axis asks for. False: it asks for none, or is refused anyway.
bool CouplingOf(const Context& c, const Command& command, CouplingRequest& out) noexcept;

void describe(Enumeration<Joining>&);
void describe(Description<AddedCam>&);
void describe(Description<CouplingState>&);

}  // namespace takt::axis
