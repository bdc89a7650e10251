#include "takt/plant/twin.h"

#include "takt/core/describe.h"

namespace takt::plant {

namespace {

constexpr Unit kKilogram{"kg", ""};
constexpr Unit kMotorTorque{"Nm", "N on linear axes"};
constexpr Unit kRotorInertia{"kg m2", "kg on linear axes"};
constexpr Unit kDamping{"Nm s/rad", "N s/m on linear axes"};
constexpr Range kPositive{.min = 0, .max = 1e9, .without_min = true};
constexpr Range kNotNegative = between(0, 1e9);

}  // namespace

void describe(Enumeration<TwinDirection>& e) {
  e.about("Where an axis by itself moves, or what it turns about.");
  e.value(TwinDirection::kX, "x", "Along or about X.");
  e.value(TwinDirection::kY, "y", "Along or about Y.");
  e.value(TwinDirection::kZ, "z", "Along or about Z.");
}

void describe(Description<TwinAxis>& d) {
  using A = TwinAxis;
  d.about("An axis that the twin moves: its motor, and what it moves.");
  d.required<&A::axis>("Name of the axis.");
  d.required<&A::max_torque>(kMotorTorque, kPositive, "Largest torque of the motor, gears included.");
  d.defaulted<&A::joint>("Joint of the model that is given.");
  d.defaulted<&A::mass>(kKilogram, kPositive, "Mass of the body that the axis itself moves, where the model is made.");
  d.defaulted<&A::radius>(unit::mm, kPositive, "Of the disc that a rotary axis without a mechanism turns.");
  d.defaulted<&A::direction>("Of an axis without a mechanism; unset: along x, rotary ones about z.");
  d.defaulted<&A::rotor_inertia>(kRotorInertia, kNotNegative, "Of motor and gears, at the axis.");
  d.defaulted<&A::coulomb_friction>(kMotorTorque, kNotNegative, "Friction that does not depend on the speed.");
  d.defaulted<&A::viscous_friction>(kDamping, kNotNegative, "Friction that grows with the speed.");
  d.defaulted<&A::brake_torque>(kMotorTorque, kNotNegative,
                                "Of the brake while it is not released; unset: as max_torque; 0: no brake.");
}

void describe(Description<TwinMechanism>& d) {
  using M = TwinMechanism;
  d.about("The mechanism of a group in the twin.");
  d.required<&M::group>("Name of the group.");
  d.defaulted<&M::platform_mass>(kKilogram, kPositive, "Delta: mass of the platform.");
  d.defaulted<&M::rod_mass>(kKilogram, kPositive, "Delta: mass of each of the six rods.");
  d.defaulted<&M::payload>(kKilogram, kNotNegative, "Mass of a load at the tool.");
  d.defaulted<&M::tool>("Site or body of the model that is given, where the tool is.");
}

void describe(Description<TwinParams>& d) {
  using T = TwinParams;
  d.about("A twin of the machine in a physics engine: takt twin, and Engine(machine, plant=\"mujoco\").");
  d.defaulted<&T::model>(
      "File of a model, MJCF or URDF, seen from the machine file; unset: the model is made from the kinematics.");
  d.defaulted<&T::step_s>(unit::s, between(0.00005, 0.002), "Step of the physics.");
  d.defaulted<&T::axes>("Axes that the twin moves; the others have their simulated servos.");
  d.defaulted<&T::mechanisms>("Mechanisms of groups whose axes the twin moves.");
}

}  // namespace takt::plant
