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

// What carries it, seen from the machine coordinate system; `ahead_s` later, if it goes on as it does now.
kinematics::Carrier CarrierOf(const Context& c, const Cargo& cargo, double ahead_s = 0) noexcept;
// Where the object is, seen from there.
MovingFrame PlaceOf(const Context& c, const Cargo& cargo, double ahead_s = 0) noexcept;

// The ride that a move to this object, or to a place that stands, begins: another one than that on which the plan
// ends, in which case it is put behind those that are in use. `arrival_s`: from now, when the tool is expected there.
std::uint64_t RideTo(const Context& c, const Cargo& cargo, double arrival_s) noexcept;
// Where its object lies in the still world.
Frame ReferenceOf(const Ride& ride) noexcept;

// A stretch whose tool is not simply where its segment says.
bool IsCarried(const LookAhead& ahead, const Stretch& stretch) noexcept;
bool Moves(const Ride& ride) noexcept;
// How fast what carries it travels now, mm/s or rad/s; 0: nothing does.
double SpeedOf(const Context& c, const Cargo& cargo) noexcept;
// From a place of the still world to where it is, for a stretch that is on one ride only.
MovingFrame DisplacementOf(const Context& c, const Ride& ride, double ahead_s) noexcept;

// How far a stretch has gone over from its first ride to its second one, with its derivatives by the way.
KinematicState ShareAt(const LookAhead& ahead, const Stretch& stretch, double way) noexcept;
// The tool on a stretch for a motion along its segment, with what carries it as it is now; clutches included.
MovingFrame ToolNow(const Context& c, const State& s, const Stretch& stretch, const KinematicState& way) noexcept;
// The same as it is expected when the tool gets there. `still`: as if carriers stood.
MovingFrame ToolThen(const Context& c, const Stretch& stretch, const KinematicState& way, bool still) noexcept;
// Updates LookAhead::unsteady; once per cycle.
void WatchCarriers(const Context& c, const State& s) noexcept;
// Returns whether a carrier of the stretch has changed its speed within the last seconds.
bool IsUnsteady(const Context& c, const Stretch& stretch) noexcept;

// The same after so much time.
MovingFrame ToolIn(const Context& c, const Stretch& stretch, const KinematicState& way, double ahead_s) noexcept;

using SeeCarrier = kinematics::Carrier (*)(const void* owner, std::uint64_t ride, const kinematics::Carrier& carrier);
MovingFrame ToolSeen(const Context& c, const Stretch& stretch, const KinematicState& way, SeeCarrier see,
                     const void* owner) noexcept;
// The same with carriers as somebody else sees them.
template <typename See>
MovingFrame ToolWith(const Context& c, const Stretch& stretch, const KinematicState& way, const See& see) noexcept {
  const auto seen = [](const void* owner, std::uint64_t ride, const kinematics::Carrier& carrier) {
    return (*static_cast<const See*>(owner))(ride, carrier);
  };
  return ToolSeen(c, stretch, way, seen, &see);
}

// Expected times, s from the start of the engine.
double Now(const Context& c) noexcept;
// How long a motion from rest to rest takes, about.
double TimeFor(const Context& c, double length, const trajectory::AlongPath& limits) noexcept;

}  // namespace takt::group
