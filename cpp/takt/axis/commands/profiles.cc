#include "takt/axis/commands/profiles.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

namespace {

constexpr std::string_view kTimeScale = "The table takes so many times as long.";

}  // namespace

void describe(Description<PositionProfile>& d) {
  using C = PositionProfile;
  d.about(
      "Follows a table of positions over time (MC_PositionProfile). An axis that is elsewhere, or slower than the "
      "table, catches up within its limits; a table that leaves the SW limits is refused. Done at rest at its end.");
  d.required<&C::profile>("Name of the table among the machine's cams: x is the time in s, y the position.");
  d.defaulted<&C::time_scale>(positive, kTimeScale);
  d.defaulted<&C::position_scale>("The table's positions are multiplied by it.");
  d.defaulted<&C::offset>(unit::u, "And this is added.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

void describe(Description<VelocityProfile>& d) {
  using C = VelocityProfile;
  d.about(
      "Follows a table of velocities over time (MC_VelocityProfile). An axis with another velocity, or with too weak "
      "ramps, catches up within its limits; a table beyond the axis' velocity is refused. Done at its end; the axis "
      "goes on with the last velocity.");
  d.required<&C::profile>("Name of the table among the machine's cams: x is the time in s, y the velocity.");
  d.defaulted<&C::time_scale>(positive, kTimeScale);
  d.defaulted<&C::velocity_scale>("The table's velocities are multiplied by it.");
  d.defaulted<&C::offset>(unit::u_s, "And this is added.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

void describe(Description<AccelerationProfile>& d) {
  using C = AccelerationProfile;
  d.about(
      "Follows a table of accelerations over time (MC_AccelerationProfile), from the velocity there is when it begins. "
      "What the axis' limits do not allow is made up in velocity; a table beyond the axis' acceleration is refused. "
      "Done at its end; the axis goes on with the velocity it then has.");
  d.required<&C::profile>("Name of the table among the machine's cams: x is the time in s, y the acceleration.");
  d.defaulted<&C::time_scale>(positive, kTimeScale);
  d.defaulted<&C::acceleration_scale>("The table's accelerations are multiplied by it.");
  d.defaulted<&C::offset>(unit::u_s2, "And this is added.");
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

}  // namespace takt::axis
