// The chain from the master's position to the slave's, stage by stage: master -> X -> cam -> Y -> slave.
#pragma once

#include "takt/cam/table.h"
#include "takt/flexcam/conversion.h"
#include "takt/flexcam/profiler.h"

namespace takt::flexcam {

struct Way {
  Conversion to_x;
  ProfilerState profiler;
  Conversion to_slave;
};

// Returns position, slope and curvature of the slave over the master's position (per master's u), with all ramps at
// their end.
inline KinematicState PlaceAt(const Way& way, const cam::Table& table, double master) noexcept {
  Conversion to_x = way.to_x;
  Conversion to_slave = way.to_slave;
  to_x.ramp.kind = to_slave.ramp.kind = RampKind::kNone;
  const KinematicState x = Convert(to_x, {}, {master, 1, 0});
  const ProfilerValue y = ValueAt(table, way.profiler, x.position);
  return Convert(to_slave, {}, {y.y, y.dy * x.velocity, y.ddy * x.velocity * x.velocity});
}

void describe(Description<Way>&);

}  // namespace takt::flexcam
