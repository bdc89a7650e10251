#include "takt/axis/commands/coupling.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

namespace {

constexpr const char* kMasterFilter =
    "Time constant of the filter of a measured master, which has no lag at constant velocity; 0: none; unset: "
    "encoder.velocity_filter_s of the master.";

}  // namespace

void describe(Enumeration<MasterSource>& e) {
  e.about("Position of a master that a slave follows.");
  e.value(MasterSource::kSetValue, "set_value", "Set point of the master in the same cycle.");
  e.value(MasterSource::kActualValue, "actual_value", "Measured position of the master in the same cycle.");
}

void describe(Enumeration<SyncMode>& e) {
  e.about("How a rotary axis reaches the slave position of a coupling.");
  e.value(SyncMode::kShortest, "shortest", "In the sense of the smaller shift.");
  e.value(SyncMode::kCatchUp, "catch_up", "By running faster.");
  e.value(SyncMode::kSlowDown, "slow_down", "By running slower.");
}

void describe(Enumeration<CombineMode>& e) {
  e.about("How the positions of two masters are combined.");
  e.value(CombineMode::kAdd, "add", "Sum.");
  e.value(CombineMode::kSubtract, "subtract", "First minus second.");
}

void describe(Description<GearIn>& d) {
  using C = GearIn;
  d.about(
      "Follows a master's velocity times a ratio (MC_GearIn). Distance lost until that velocity is reached is not made "
      "up. Reached when it is reached, and locked to the position from there: distance lost later to the axis' limits "
      "is made up. Repeated, it changes the ratio. No command can be buffered behind it.");
  d.required<&C::master>("Name of the master axis.");
  d.defaulted<&C::ratio_numerator>("Numerator of the ratio, in units of this axis.");
  d.defaulted<&C::ratio_denominator>(positive, "Denominator of the ratio, in units of the master.");
  d.defaulted<&C::source>("Position of the master that is followed.");
  d.defaulted<&C::master_filter>(unit::s, between(0, 10), kMasterFilter);
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kChange);
}

void describe(Description<GearOut>& d) {
  d.about("Releases the axis from the master; it keeps its velocity (MC_GearOut).");
}

void describe(Description<GearInPos>& d) {
  using C = GearInPos;
  d.about(
      "Follows a master's position times a ratio, in step from a given pair of positions on (MC_GearInPos). Reached "
      "when it is in step. If the master is already beyond the start of synchronisation, less distance is left for it. "
      "With master_start_distance, a master beyond the synchronous position must come back (rotary axes: reach it "
      "again in a later turn); without it the axis synchronises at once. Error 3110: a linear master has moved away "
      "from that position by more than master_start_distance and by more than it can move in 1 s.");
  d.required<&C::master>("Name of the master axis.");
  d.defaulted<&C::ratio_numerator>("Numerator of the ratio, in units of this axis.");
  d.defaulted<&C::ratio_denominator>(positive, "Denominator of the ratio, in units of the master.");
  d.defaulted<&C::source>("Position of the master that is followed.");
  d.defaulted<&C::master_filter>(unit::s, between(0, 10), kMasterFilter);
  d.required<&C::master_sync_position>("Position of the master, in its own unit, at which both are in step.");
  d.required<&C::slave_sync_position>(unit::u, "Position of this axis at which both are in step.");
  d.defaulted<&C::sync_mode>("How a rotary axis reaches that position.");
  d.defaulted<&C::master_start_distance>(not_negative,
                                         "Distance of the master, in its own unit, before master_sync_position at "
                                         "which synchronisation begins; unset: it begins at once.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity of synchronisation; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
}

void describe(Description<PhasingAbsolute>& d) {
  using C = PhasingAbsolute;
  d.about("Shifts the master's position as seen by this axis to a given shift (MC_PhasingAbsolute).");
  d.required<&C::phase_shift>("Total shift, in the master's unit.");
  d.defaulted<&C::velocity>(
      positive, "Largest speed of the shift, in the master's unit per second; unset: as fast as this axis can.");
  DescribeRamps(d);
}

void describe(Description<PhasingRelative>& d) {
  using C = PhasingRelative;
  d.about("Shifts the master's position as seen by this axis by a given amount (MC_PhasingRelative).");
  d.required<&C::phase_shift>("Amount added to the present shift, in the master's unit.");
  d.defaulted<&C::velocity>(
      positive, "Largest speed of the shift, in the master's unit per second; unset: as fast as this axis can.");
  DescribeRamps(d);
}

void describe(Description<CombineAxes>& d) {
  using C = CombineAxes;
  d.about(
      "Follows the sum or the difference of two masters' positions, each times a ratio (MC_CombineAxes). Reached when "
      "in step.");
  d.required<&C::master1>("Name of the first master axis.");
  d.required<&C::master2>("Name of the second master axis.");
  d.defaulted<&C::mode>("Sum or difference.");
  d.defaulted<&C::ratio_numerator1>("Numerator of the first ratio, in units of this axis.");
  d.defaulted<&C::ratio_denominator1>(positive, "Denominator of the first ratio, in units of the first master.");
  d.defaulted<&C::ratio_numerator2>("Numerator of the second ratio, in units of this axis.");
  d.defaulted<&C::ratio_denominator2>(positive, "Denominator of the second ratio, in units of the second master.");
  d.defaulted<&C::source1>("Position of the first master that is followed.");
  d.defaulted<&C::source2>("Position of the second master that is followed.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity of synchronisation; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kChange);
}

}  // namespace takt::axis
