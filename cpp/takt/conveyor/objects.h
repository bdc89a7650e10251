// What lies on a belt: who looks for workpieces finds, takes and deletes them here. All of it is fit for the cycle.
#pragma once

#include <cstdint>
#include <span>

#include "takt/conveyor/params.h"
#include "takt/conveyor/state.h"
#include "takt/core/status.h"
#include "takt/kinematics/carrier.h"

namespace takt::conveyor {

// A length of the belt as its carrier has it: mm, or rad.
double InCarrier(const BeltParams& params, double length) noexcept;
// The belt as something that carries, as it is in this cycle.
kinematics::Carrier CarrierOf(const BeltParams& params, const KinematicState& travel) noexcept;

// All that lie on it, in the order of their numbers, those that are not visible yet, too.
std::span<const Object> ObjectsOf(const State& state) noexcept;
// Null: there is none of that number.
const Object* Find(const State& state, std::uint32_t number) noexcept;
Object* Find(State& state, std::uint32_t number) noexcept;

// Where an object is along the belt now, mm from the origin. On a table: the angle at which it lies, deg; it counts on
// from turn to turn, so that each object passes the range once. Of no meaning before the object is visible.
double PlaceOf(const BeltParams& params, const State& state, const Object& object) noexcept;
// The object's pose with velocity and acceleration, in the world.
kinematics::MovingFrame PoseOf(const BeltParams& params, const State& state, const Object& object) noexcept;

// The same for people, as it is published; nan before the object is visible.
struct Seen {
  double place = 0;       // mm or deg
  kinematics::Pose pose;  // in the world
  bool in_range = false;
};
Seen See(const BeltParams& params, const State& state, const Object& object) noexcept;

// Whether this place is within the work range; limits belong to it.
bool IsWithin(const BeltParams& params, double place) noexcept;
// It is visible (or taken) and lies within the work range.
bool InRange(const BeltParams& params, const State& state, const Object& object) noexcept;
// InRange and not taken.
bool IsFree(const BeltParams& params, const State& state, const Object& object) noexcept;
// Returns the object not taken that leaves the range first, by the direction of the belt's last motion; null: none.
const Object* FirstFree(const BeltParams& params, const State& state) noexcept;

// s until the object is at place x if the belt goes on as fast as now; 0: it is there. NaN: never.
double TimeTo(const BeltParams& params, const State& state, const Object& object, double x) noexcept;
// Where it is a time later, likewise.
double PlaceIn(const BeltParams& params, const State& state, const Object& object, double time_s) noexcept;
// s until it leaves the work range, likewise. Infinite: the belt stands, or there is no limit on its way; 0: it is
// outside already.
double TimeLeft(const BeltParams& params, const State& state, const Object& object) noexcept;

// A visible one becomes somebody's. kNoWorkpiece: there is none of that number that is visible and not taken.
Status Take(std::uint32_t number, State& state) noexcept;
// And anybody's again. kNoWorkpiece: it is not taken.
Status GiveBack(std::uint32_t number, State& state) noexcept;
// Whatever its state. kNoWorkpiece: there is none.
Status Remove(std::uint32_t number, State& state) noexcept;
// The same, and it counts as lost.
Status Lose(std::uint32_t number, State& state) noexcept;

}  // namespace takt::conveyor
