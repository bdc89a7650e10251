#include "example.h"

#include "takt/core/describe.h"

namespace example {

using namespace takt;

void describe(Enumeration<Direction>& e) {
  e.about("Sense of travel of a rotary axis.");
  e.value(Direction::kCurrent, "current", "As the last move.");
  e.value(Direction::kPositive, "positive", "Only upwards.");
  e.value(Direction::kShortest, "shortest", "The shorter way.");
  e.value(Direction::kNegative, "negative", "Only downwards.");
}

void describe(Enumeration<DriveMode>& e) {
  e.about("Who closes the loop.");
  e.value(DriveMode::kPosition, "csp", "The drive.");
  e.value(DriveMode::kVelocity, "csv", "The engine.");
}

void describe(Description<Homing>& d) {
  d.about("How an axis finds its reference.");
  d.required<&Homing::velocity>(unit::u_s, positive, "Speed towards the switch.");
  d.defaulted<&Homing::direction>("Where the switch is.");
  d.defaulted<&Homing::timeout_s>(unit::s, positive, "Longest time; none: no limit.");
}

void describe(Description<Drive>& d) {
  d.about("The drive of an axis.");
  d.required<&Drive::mode>("Who closes the loop.");
  d.defaulted<&Drive::station>("Number on the bus.");
  d.defaulted<&Drive::offset>(unit::count, "Added to its counts.");
}

void describe(Description<Limits>& d) {
  d.about("Software limits.");
  d.defaulted<&Limits::lower>(unit::u, "Lower end.");
  d.defaulted<&Limits::upper>(unit::u, "Upper end.");
  d.rule<&Limits::upper>("must lie above lower", [](const Limits& l) { return l.lower < l.upper; });
}

void describe(Description<Axis>& d) {
  d.about("A servo axis.");
  d.required<&Axis::name>("Its name.");
  d.required<&Axis::velocity>(unit::u_s, positive, "Largest speed.");
  d.defaulted<&Axis::mounting_angle>(unit::deg_as_rad, between(-360, 360), "Turned by.");
  d.defaulted<&Axis::inverted>("Counts downwards.");
  d.defaulted<&Axis::serial>("Serial number.");
  d.defaulted<&Axis::shift>("A signed whole number.");
  d.defaulted<&Axis::gains>(unit::one_s, not_negative, "P, I, D.");
  d.required<&Axis::drive>("Its drive.");
  d.defaulted<&Axis::homing>("Homing; none: absolute encoder.");
  d.defaulted<&Axis::limits>("Software limits.");
  d.internal<&Axis::counter>("Counts something.");
}

void describe(Description<Machine>& d) {
  d.about("A machine.");
  d.defaulted<&Machine::title>("What people call it.");
  d.required<&Machine::axes>("Its axes.");
  d.defaulted<&Machine::table>(unit::mm, at_most(1000), "Some lengths.");
  d.defaulted<&Machine::tags>("Some words.");
  d.defaulted<&Machine::points>(unit::mm, "Some places.");
  d.defaulted<&Machine::spare>(between(1, 10), "Number of a spare.");
}

void describe(Description<MoveAbsolute>& d) {
  using M = MoveAbsolute;
  d.about("Moves an axis to an absolute position.");
  d.required<&M::position>(unit::u, "Where to stop.");
  d.required<&M::velocity>(unit::u_s, positive, "Largest speed on the way.");
  d.defaulted<&M::jerk>(unit::u_s3, not_negative, "Largest jerk; 0: trapezoid.");
  d.defaulted<&M::direction>("Sense of travel.");
}

const std::string_view kMachineYaml = R"(# A machine with two axes.
title: "Press 5"
axes:
  - name: x
    velocity: 500.0          # u/s
    mounting_angle: 30
    inverted: true
    serial: 18446744073709551615
    shift: -9223372036854775808
    gains: [20.0, 0.5, 0]
    drive: {mode: csp, station: 3, offset: -7}
    homing:
      velocity: 2.5e1
      direction: negative
      timeout_s: 10
    limits:
      lower: -5
      upper: 1200
  - name: y
    velocity: 1.0e-03
    drive:
      mode: csv
    homing: null
table: [1, 2.5, -3]
tags: [a, 'no', "5"]
points: [[1, 2], [3, 4]]
spare: 4
)";

}  // namespace example
