// The objects on a belt: users of workpieces find, take and delete them here. All functions are fit for the cycle.
#pragma once

#include <cstdint>
#include <span>

#include "takt/conveyor/params.h"
#include "takt/conveyor/state.h"
#include "takt/core/status.h"
#include "takt/kinematics/carrier.h"

namespace takt::conveyor {

// Returns a length of the belt in the unit of its carrier: [mm], or [rad].
double InCarrier(const BeltParams& params, double length) noexcept;
// Returns the belt as a carrier in this cycle.
kinematics::Carrier CarrierOf(const BeltParams& params, const KinematicState& travel) noexcept;

// Returns all objects in the order of their numbers, including those that are not visible yet.
std::span<const Object> ObjectsOf(const State& state) noexcept;
// Return null if there is no object of that number.
const Object* Find(const State& state, std::uint32_t number) noexcept;
Object* Find(State& state, std::uint32_t number) noexcept;

// Returns the present position of an object along the belt, [mm] from the origin. On a table: its angle [deg], which
// counts on from turn to turn, so that each object passes the range once. Not valid before the object is visible.
double PlaceOf(const BeltParams& params, const State& state, const Object& object) noexcept;
// Returns the object's pose with velocity and acceleration, in the world.
kinematics::MovingFrame PoseOf(const BeltParams& params, const State& state, const Object& object) noexcept;

// Position and pose as they are published; nan before the object is visible.
struct Seen {
  double place = 0;       // [mm] or [deg]
  kinematics::Pose pose;  // in the world
  bool in_range = false;
};
Seen See(const BeltParams& params, const State& state, const Object& object) noexcept;

// Returns true if this position is within the work range, limits included.
bool IsWithin(const BeltParams& params, double place) noexcept;
// Returns true if the object is visible (or taken) and within the work range.
bool InRange(const BeltParams& params, const State& state, const Object& object) noexcept;
// Returns true if the object is InRange and not taken.
bool IsFree(const BeltParams& params, const State& state, const Object& object) noexcept;
// Returns the free object that leaves the range first, by the direction of the belt's last motion; null if there is
// none.
const Object* FirstFree(const BeltParams& params, const State& state) noexcept;

// Returns the time [s] until the object is at position x, at the present belt speed; 0: it is there. NaN: never.
double TimeTo(const BeltParams& params, const State& state, const Object& object, double x) noexcept;
// Returns its position after a time, at the present belt speed.
double PlaceIn(const BeltParams& params, const State& state, const Object& object, double time_s) noexcept;
// Returns the time [s] until it leaves the work range, at the present belt speed. Infinite: the belt is at rest, or has
// no limit in this direction; 0: it is outside the range.
double TimeLeft(const BeltParams& params, const State& state, const Object& object) noexcept;

// Takes a visible object. kNoWorkpiece: no object of that number is visible and not taken.
Status Take(std::uint32_t number, State& state) noexcept;
// Makes a taken object available again. kNoWorkpiece: it is not taken.
Status GiveBack(std::uint32_t number, State& state) noexcept;
// Deletes an object in any state. kNoWorkpiece: no such object.
Status Remove(std::uint32_t number, State& state) noexcept;
// The same, and counts it as lost.
Status Lose(std::uint32_t number, State& state) noexcept;

}  // namespace takt::conveyor
