#include "takt/axis/commands/coupling.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

namespace {

constexpr const char* kMasterFilter =
    "Time constant of the filter of a measured master, which has no lag at constant velocity; 0: none; unset: the "
    "encoder.velocity_filter_s of the master.";

}  // namespace

void describe(Enumeration<MasterSource>& e) {
  e.about("Which position of a master counts.");
  e.value(MasterSource::kSetValue, "set_value", "Its set point of the same cycle.");
  e.value(MasterSource::kActualValue, "actual_value", "Its measured position of the same cycle.");
}

void describe(Enumeration<SyncMode>& e) {
  e.about("How a rotary axis reaches its place in a coupling.");
  e.value(SyncMode::kShortest, "shortest", "Whichever way is shorter.");
  e.value(SyncMode::kCatchUp, "catch_up", "By going faster.");
  e.value(SyncMode::kSlowDown, "slow_down", "By going slower.");
}

void describe(Enumeration<CombineMode>& e) {
  e.about("What becomes of two masters.");
  e.value(CombineMode::kAdd, "add", "Their sum.");
  e.value(CombineMode::kSubtract, "subtract", "The first less the second.");
}

void describe(Description<GearIn>& d) {
  using C = GearIn;
  d.about(
      "Follows a master's velocity times a ratio (MC_GearIn). What is lost on the way to that velocity is not made up. "
      "Reached when it is, and locked from there: what the axis' limits make it lose later is made up. Given again it "
      "changes the ratio. Nothing can be buffered behind it.");
  d.required<&C::master>("Name of the master axis.");
  d.defaulted<&C::ratio_numerator>("Own units ...");
  d.defaulted<&C::ratio_denominator>(positive, "... per so many of the master's.");
  d.defaulted<&C::source>("Which of the master's positions is followed.");
  d.defaulted<&C::master_filter>(unit::s, between(0, 10), kMasterFilter);
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kChange);
}

void describe(Description<GearOut>& d) {
  d.about("Lets go of the master; the axis goes on with the velocity it has (MC_GearOut).");
}

void describe(Description<GearInPos>& d) {
  using C = GearInPos;
  d.about(
      "Follows a master's position times a ratio, in step from a given pair of positions on (MC_GearInPos). Reached "
      "when it is in step. A master that is already past where getting into step begins leaves less way for it. With "
      "master_start_distance one that has passed the place has to come back (on rotary axes: to come round again); "
      "without it the axis gets into step at once. Error 3110: a linear master has moved away from the place instead, "
      "by more than master_start_distance and than it can in 1 s.");
  d.required<&C::master>("Name of the master axis.");
  d.defaulted<&C::ratio_numerator>("Own units ...");
  d.defaulted<&C::ratio_denominator>(positive, "... per so many of the master's.");
  d.defaulted<&C::source>("Which of the master's positions is followed.");
  d.defaulted<&C::master_filter>(unit::s, between(0, 10), kMasterFilter);
  d.required<&C::master_sync_position>("Where the master is, in its own unit, when both are in step.");
  d.required<&C::slave_sync_position>(unit::u, "Where this axis is then.");
  d.defaulted<&C::sync_mode>("How a rotary axis gets there.");
  d.defaulted<&C::master_start_distance>(
      not_negative, "How far before that, in the master's unit, getting into step begins; unset: at once.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity of the catching up; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
}

void describe(Description<PhasingAbsolute>& d) {
  using C = PhasingAbsolute;
  d.about("Shifts what this axis takes for its master's position to a given amount (MC_PhasingAbsolute).");
  d.required<&C::phase_shift>("The whole shift, in the master's unit.");
  d.defaulted<&C::velocity>(
      positive, "Largest speed of the shift, in the master's unit per second; unset: as fast as this axis can.");
  DescribeRamps(d);
}

void describe(Description<PhasingRelative>& d) {
  using C = PhasingRelative;
  d.about("Shifts what this axis takes for its master's position by an amount (MC_PhasingRelative).");
  d.required<&C::phase_shift>("Added to the shift there is, in the master's unit.");
  d.defaulted<&C::velocity>(
      positive, "Largest speed of the shift, in the master's unit per second; unset: as fast as this axis can.");
  DescribeRamps(d);
}

void describe(Description<CombineAxes>& d) {
  using C = CombineAxes;
  d.about(
      "Follows the sum or the difference of two masters' positions, each times a ratio (MC_CombineAxes). Reached when "
      "it is in step.");
  d.required<&C::master1>("Name of the first master axis.");
  d.required<&C::master2>("Name of the second one.");
  d.defaulted<&C::mode>("Sum or difference.");
  d.defaulted<&C::ratio_numerator1>("Own units ...");
  d.defaulted<&C::ratio_denominator1>(positive, "... per so many of the first master's.");
  d.defaulted<&C::ratio_numerator2>("Own units ...");
  d.defaulted<&C::ratio_denominator2>(positive, "... per so many of the second one's.");
  d.defaulted<&C::source1>("Which of the first master's positions is followed.");
  d.defaulted<&C::source2>("The same for the second one.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity of the catching up; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kChange);
}

}  // namespace takt::axis
