// Paths on moving carriers.
//
// A path is made in a planning frame that does not move (the still world): lines, arcs, joints and blends are fixed in
// it. A carrier binding ("ride" in names) displaces it with a carrier: D(t) = X(t) inverse(R), with X the pose of the
// object in the MCS and R its pose in the planning frame. On a stretch p(s) from one binding to the next the tool is at
//
//     (1 - w(s)) D_from(t) p(s) + w(s) D_to(t) p(s)
//
// with w a quintic from 0 to 1 (orientations likewise, about one axis). So no prediction of a belt is needed: at the
// end of the stretch the tool is exactly on the object, whatever the belt did. R is chosen such that both displacements
// agree at the instant at which the tool is expected there: then the path is as straight as it was meant. Before the
// first binding the planning frame is the machine coordinate system.
#pragma once

#include "takt/group/group.h"
#include "takt/kinematics/carrier.h"

namespace takt::group {

using kinematics::MovingFrame;

// Returns the carrier of `cargo` relative to the MCS, extrapolated by `ahead_s` [s] as it moves now.
kinematics::Carrier CarrierOf(const Context& c, const CarriedTarget& cargo, double ahead_s = 0) noexcept;
// Returns the pose of the object in the MCS, extrapolated likewise.
MovingFrame PlaceOf(const Context& c, const CarriedTarget& cargo, double ahead_s = 0) noexcept;

// Returns the number of the binding for a move onto `cargo` (carrier 0: at rest in the MCS): end_ride if that has the
// same target, else a new one, prepared in slot rides_end and not in use before the move is joined. `arrival_s`: time
// until the tool is expected there [s].
std::uint64_t BindTo(const Context& c, const CarriedTarget& cargo, double arrival_s) noexcept;
// Returns a binding for which the planning frame is the MCS with the carrier at this travel [mm or rad].
CarrierBinding BindingAtRest(const Context& c, const CarriedTarget& cargo, double travel) noexcept;
// Returns the pose of its object in the planning frame.
Frame ReferenceOf(const CarrierBinding& ride) noexcept;

// Returns true if a binding of the stretch displaces the tool from its segment.
bool IsCarried(const LookAhead& ahead, const Stretch& stretch) noexcept;
// Returns true if the binding has a carrier.
bool Moves(const CarrierBinding& ride) noexcept;
// Returns the present velocity of the carrier: of belts [mm/s] and tables [rad/s] signed, of free carriers the norm
// [mm/s]; 0 without a carrier.
double SpeedOf(const Context& c, const CarriedTarget& cargo) noexcept;
// Returns the displacement D from the planning frame to the MCS `ahead_s` from now [s], for stretches on one binding.
MovingFrame DisplacementOf(const Context& c, const CarrierBinding& ride, double ahead_s) noexcept;

// Returns the weight w of the second binding (0 to 1) at the arc length `way` [mm] of the segment, with its first and
// second derivative by arc length.
KinematicState ShareAt(const LookAhead& ahead, const Stretch& stretch, double way) noexcept;
// Returns the tool on a stretch for a motion along its segment, with the carriers as they are now, clutches included.
MovingFrame ToolNow(const Context& c, const State& s, const Stretch& stretch, const KinematicState& way) noexcept;
// Returns the tool likewise, without clutches, with carriers extrapolated to the expected arrival at `way.position`.
// `still`: their velocities set to 0.
MovingFrame PredictedTool(const Context& c, const Stretch& stretch, const KinematicState& way, bool still) noexcept;
// Updates LookAhead::unsteady; once per cycle.
void WatchCarriers(const Context& c, const State& s) noexcept;
// Returns true if a carrier of the stretch has accelerated within the last 3 s (WatchCarriers).
bool IsUnsteady(const Context& c, const Stretch& stretch) noexcept;

// Returns the tool likewise, with carriers extrapolated by `ahead_s` [s] and their boarding.
MovingFrame ToolIn(const Context& c, const Stretch& stretch, const KinematicState& way, double ahead_s) noexcept;

using SeeCarrier = kinematics::Carrier (*)(const void* owner, std::uint64_t ride, const kinematics::Carrier& carrier);
MovingFrame ToolSeen(const Context& c, const Stretch& stretch, const KinematicState& way, SeeCarrier see,
                     const void* owner) noexcept;
// Returns the tool likewise, with each carrier replaced by see(ride, carrier).
template <typename See>
MovingFrame ToolWith(const Context& c, const Stretch& stretch, const KinematicState& way, const See& see) noexcept {
  const auto seen = [](const void* owner, std::uint64_t ride, const kinematics::Carrier& carrier) {
    return (*static_cast<const See*>(owner))(ride, carrier);
  };
  return ToolSeen(c, stretch, way, seen, &see);
}

// Returns the time since the start of the engine [s], as in eta_begin and eta_end.
double Now(const Context& c) noexcept;
// Returns the duration of a motion from rest to rest over `length`, without regard to bends [s]; 0 if it cannot be
// planned.
double TimeFor(const Context& c, double length, const trajectory::AlongPath& limits) noexcept;

}  // namespace takt::group
