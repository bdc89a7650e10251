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
constexpr Unit kNewton{"N", ""};
constexpr Range kTwinPlace = between(-100000, 100000);
constexpr Range kTwinSize = between(0.1, 100000);

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

void describe(Description<TwinBelt>& d) {
  using B = TwinBelt;
  d.about("A belt of the twin, which carries products by friction.");
  d.required<&B::belt>("Name of the belt.");
  d.defaulted<&B::from>(unit::mm, kTwinPlace, "Where it begins, from its origin.");
  d.defaulted<&B::to>(unit::mm, kTwinPlace, "Where it ends; products that get there are taken off.");
  d.defaulted<&B::width>(unit::mm, kTwinSize, "Its width.");
  d.defaulted<&B::surface>(unit::mm, kTwinPlace, "Z of its surface, from its origin.");
  d.defaulted<&B::friction>(between(0.01, 10), "Coefficient of friction between it and products.");
  d.defaulted<&B::barrier>(unit::mm, kTwinPlace,
                           "Where a light barrier crosses it, wired as the touch probe of its axis; unset: none.");
}

void describe(Description<TwinProducts>& d) {
  using P = TwinProducts;
  d.about("Products of the twin, boxes, all alike.");
  d.defaulted<&P::count>(between(1, 100), "How many there can be at once.");
  d.required<&P::length>(unit::mm, kTwinSize, "Along X of the belt.");
  d.required<&P::width>(unit::mm, kTwinSize, "Along Y.");
  d.required<&P::height>(unit::mm, kTwinSize, "Along Z.");
  d.required<&P::mass>(kKilogram, kPositive, "Mass of each.");
  d.defaulted<&P::friction>(between(0.01, 10), "Coefficient of friction between products.");
}

void describe(Description<TwinGripper>& d) {
  using G = TwinGripper;
  d.about("A vacuum gripper at the tool.");
  d.defaulted<&G::reach>(
      unit::mm, kTwinSize,
      "From the tool to the middle of a product's top: how far it may be for the gripper to hold it.");
  d.defaulted<&G::force>(kNewton, kPositive, "At which it loses what it holds.");
  d.defaulted<&G::acts_s>(unit::s, between(0, 10), "Until it is closed or open.");
  d.defaulted<&G::radius>(unit::mm, kTwinSize, "Of its cup.");
  d.defaulted<&G::length>(unit::mm, kTwinSize, "Of its cup, above the tool's point.");
}

void describe(Description<TwinMechanism>& d) {
  using M = TwinMechanism;
  d.about("The mechanism of a group in the twin.");
  d.required<&M::group>("Name of the group.");
  d.defaulted<&M::platform_mass>(kKilogram, kPositive, "Delta: mass of the platform.");
  d.defaulted<&M::rod_mass>(kKilogram, kPositive, "Delta: mass of each of the six rods.");
  d.defaulted<&M::payload>(kKilogram, kNotNegative, "Mass of a load at the tool.");
  d.defaulted<&M::tool>("Site or body of the model that is given, where the tool is.");
  d.defaulted<&M::gripper>("A gripper at the tool, where the model is made.");
}

void describe(Description<TwinParams>& d) {
  using T = TwinParams;
  d.about("A twin of the machine in a physics engine: takt twin, and Engine(machine, plant=\"mujoco\").");
  d.defaulted<&T::model>(
      "File of a model, MJCF or URDF, seen from the machine file; unset: the model is made from the kinematics.");
  d.defaulted<&T::step_s>(unit::s, between(0.00005, 0.002), "Step of the physics.");
  d.defaulted<&T::axes>("Axes that the twin moves; the others have their simulated servos.");
  d.defaulted<&T::mechanisms>("Mechanisms of groups whose axes the twin moves.");
  d.defaulted<&T::belts>("Belts whose axes the twin moves.");
  d.defaulted<&T::products>("Products that belts carry and grippers hold.");
}

}  // namespace takt::plant
