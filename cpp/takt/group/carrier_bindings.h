// How a path comes to lie on what moves.
//
// A path is made in a still world: lines, arcs, joints and blends are fixed in it. A ride says how something that
// carries moves against that world: D(t) = X(t) inverse(R), X being where the object is and R where it lies in the
// still world. On a stretch p(s) from one ride to the next the tool is at
//
//     (1 - w(s)) D_from(t) p(s) + w(s) D_to(t) p(s)
//
// with w a quintic from 0 to 1 (orientations likewise, about one axis). So nothing has to be known about where a belt
// will be: at the end of the stretch the tool is on the object exactly, whatever the belt did. R is chosen such that
// both displacements agree at the instant at which the tool is expected there: then the path is as straight as it was
// meant. Before the first ride the still world is the machine coordinate system.
#pragma once

#include "takt/group/group.h"
#include "takt/kinematics/carrier.h"

namespace takt::group {

using kinematics::MovingFrame;

// Returns the carrier of `cargo` relative to the MCS, extrapolated by `ahead_s` [s] as it moves now.
kinematics::Carrier CarrierOf(const Context& c, const CarriedTarget& cargo, double ahead_s = 0) noexcept;
// Returns the pose of the object in the MCS, extrapolated likewise.
MovingFrame PlaceOf(const Context& c, const CarriedTarget& cargo, double ahead_s = 0) noexcept;

// Returns the number of the ride for a move onto `cargo` (carrier 0: at rest in the MCS): end_ride if that is the same,
// else a new one, prepared in slot rides_end and not in use before the move is joined. `arrival_s`: time until the tool
// is expected there [s].
std::uint64_t RideTo(const Context& c, const CarriedTarget& cargo, double arrival_s) noexcept;
// Returns a ride on which the still world is the MCS with the carrier at this travel [mm or rad].
CarrierBinding RideAtRest(const Context& c, const CarriedTarget& cargo, double travel) noexcept;
// Where its object lies in the still world.
Frame ReferenceOf(const CarrierBinding& ride) noexcept;

// A stretch whose tool is not simply where its segment says.
bool IsCarried(const LookAhead& ahead, const Stretch& stretch) noexcept;
bool Moves(const CarrierBinding& ride) noexcept;
// Returns the present velocity of the carrier: of belts [mm/s] and tables [rad/s] signed, of free carriers the norm
// [mm/s]; 0 without one.
double SpeedOf(const Context& c, const CarriedTarget& cargo) noexcept;
// From a place of the still world to where it is, for a stretch that is on one ride only.
MovingFrame DisplacementOf(const Context& c, const CarrierBinding& ride, double ahead_s) noexcept;

// Returns the weight w of the second ride (0 to 1) at the arc length `way` [mm] of the segment, with its first and
// second derivative by arc length.
KinematicState ShareAt(const LookAhead& ahead, const Stretch& stretch, double way) noexcept;
// The tool on a stretch for a motion along its segment, with what carries it as it is now; clutches included.
MovingFrame ToolNow(const Context& c, const State& s, const Stretch& stretch, const KinematicState& way) noexcept;
// The same with carriers extrapolated to the expected arrival at `way.position`. `still`: their velocities set to 0.
MovingFrame PredictedTool(const Context& c, const Stretch& stretch, const KinematicState& way, bool still) noexcept;
// Updates LookAhead::unsteady; once per cycle.
void WatchCarriers(const Context& c, const State& s) noexcept;
// Returns whether a carrier of the stretch has accelerated within the last 3 s (WatchCarriers).
bool IsUnsteady(const Context& c, const Stretch& stretch) noexcept;

// The same with carriers extrapolated by `ahead_s` [s].
MovingFrame ToolIn(const Context& c, const Stretch& stretch, const KinematicState& way, double ahead_s) noexcept;

using SeeCarrier = kinematics::Carrier (*)(const void* owner, std::uint64_t ride, const kinematics::Carrier& carrier);
MovingFrame ToolSeen(const Context& c, const Stretch& stretch, const KinematicState& way, SeeCarrier see,
                     const void* owner) noexcept;
// The same with each carrier replaced by see(ride, carrier).
template <typename See>
MovingFrame ToolWith(const Context& c, const Stretch& stretch, const KinematicState& way, const See& see) noexcept {
  const auto seen = [](const void* owner, std::uint64_t ride, const kinematics::Carrier& carrier) {
    return (*static_cast<const See*>(owner))(ride, carrier);
  };
  return ToolSeen(c, stretch, way, seen, &see);
}

// Returns the time since the start of the engine [s], as in eta_begin and eta_end.
double Now(const Context& c) noexcept;
// Returns how long a motion from rest to rest over `length` takes without regard to bends [s]; 0 if it cannot be
// planned.
double TimeFor(const Context& c, double length, const trajectory::AlongPath& limits) noexcept;

}  // namespace takt::group
