// A cam laid over the position of a master: its beginning, the slave position it yields, and when its end is passed.
// Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/coupling_request.h"
#include "takt/axis/table_request.h"
#include "takt/cam/table.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

// Constant while a cam is followed.
struct CamLaw {
  const cam::Table& table;
  double ratio = 1;       // [x per master's u] not 0
  bool periodic = false;  // false: outside the cam its end positions are held
  double scale = 1;       // of y

  double way() const noexcept { return table.length() / ratio; }  // [master's u] of one cycle, with its sign
};

// Positions are over all turns.
struct CamState {
  double master = 0;                 // [master's u] where cycle 0 of the cam begins
  double slave = 0;                  // [u] added to the scaled y
  double share = 0;                  // [cycles] the master in the cam at the last check for the end
  std::uint32_t end_axis = kNoAxis;  // master of the cam whose end was passed last
  double end_master = 0;             // [master's u] position of the master at exactly that end
  double end_slave = 0;              // [u] position of this axis at that end
  bool over = false;                 // a buffered command may take over: at the end, or held beyond it
};

// Returns the position of a master in the cam [cycles from its beginning], limited to 0 to 1 unless the cam is
// periodic.
double ShareOf(const CamLaw& law, const CamState& cam, double master) noexcept;
// Returns the number of whole cycles from the beginning to a master's position; 0 for a cam that is not periodic.
double WholeCycles(const CamLaw& law, const CamState& cam, double master) noexcept;
// Shifts the beginning by whole cycles so that `master` is in cycle 0.
void BeginCycles(const CamLaw& law, double master, CamState& cam) noexcept;
// Returns the position of the slave at a master's position, with its derivatives over the master's position.
cam::Value ValueAt(const CamLaw& law, const CamState& cam, double master) noexcept;

// Returns the last whole number of cycles passed between two shares: an end if the share increases, a beginning if it
// decreases; empty if none was passed. A number equal to `from` does not count, one equal to `to` does; tolerance: 1e-9
// of a cycle.
std::optional<double> EndPassed(double from, double to) noexcept;

void describe(Description<CamState>&);

}  // namespace takt::axis
