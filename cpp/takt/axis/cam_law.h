// A cam laid over a master's way: where it lies, what it asks of the slave, when its end is passed. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/coupling_request.h"
#include "takt/axis/table_request.h"
#include "takt/cam/table.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

// What stays the same while a cam is followed.
struct CamLaw {
  const cam::Table& table;
  double ratio = 1;       // x per master's u, not 0
  bool periodic = false;  // else: outside, its end positions are held
  double scale = 1;       // of y

  double way() const noexcept { return table.length() / ratio; }  // of one cycle, master's u, with its sign
};

// Positions are over all turns.
struct CamState {
  double master = 0;                 // master's u, where cycle 0 of the cam begins
  double slave = 0;                  // u, added to the scaled y
  double share = 0;                  // where the master was, in cycles, when the end was looked for last
  std::uint32_t end_axis = kNoAxis;  // whose cam's end was passed last
  double end_master = 0;             // master's u, exactly there
  double end_slave = 0;              // u, this axis' place there
  bool over = false;                 // it may be followed by a buffered command: at the end, or held beyond it
};

// Where a master is in the cam, in cycles from its beginning; not periodic: 0 to 1.
double ShareOf(const CamLaw& law, const CamState& cam, double master) noexcept;
// How many whole cycles lie between the beginning and a master's position; 0 for a cam that is not periodic.
double WholeCycles(const CamLaw& law, const CamState& cam, double master) noexcept;
// Shifts the beginning by whole cycles such that a master here is in cycle 0.
void BeginCycles(const CamLaw& law, double master, CamState& cam) noexcept;
// The slave's place over the master's position (derivatives, too, over that).
cam::Value ValueAt(const CamLaw& law, const CamState& cam, double master) noexcept;

// The whole number of cycles that lies on the way from one share to the other, where there is one: the end if it goes
// up, the beginning if it goes down. What is left behind does not count, what is reached does; 1e-9 of a cycle is near
// enough.
std::optional<double> EndPassed(double from, double to) noexcept;

void describe(Description<CamState>&);

}  // namespace takt::axis
