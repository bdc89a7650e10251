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
  e.about("Direction of travel or of rotation of an axis without a mechanism.");
  e.value(TwinDirection::kX, "x", "Along or about X.");
  e.value(TwinDirection::kY, "y", "Along or about Y.");
  e.value(TwinDirection::kZ, "z", "Along or about Z.");
}

void describe(Description<TwinAxis>& d) {
  using A = TwinAxis;
  d.about("An axis that the twin moves: its motor and its body.");
  d.required<&A::axis>("Name of the axis.");
  d.required<&A::max_torque>(kMotorTorque, kPositive, "Largest torque of the motor at the axis, gears included.");
  d.defaulted<&A::joint>("Joint of the given model.");
  d.defaulted<&A::mass>(kKilogram, kPositive, "Mass of the body that the axis moves; models made from the kinematics.");
  d.defaulted<&A::radius>(unit::mm, kPositive, "Radius of the disc that a rotary axis without a mechanism turns.");
  d.defaulted<&A::direction>("Direction of an axis without a mechanism; unset: along x, rotary axes about z.");
  d.defaulted<&A::rotor_inertia>(kRotorInertia, kNotNegative, "Inertia of motor and gears at the axis.");
  d.defaulted<&A::coulomb_friction>(kMotorTorque, kNotNegative, "Friction that is independent of the speed.");
  d.defaulted<&A::viscous_friction>(kDamping, kNotNegative, "Friction that is proportional to the speed.");
  d.defaulted<&A::brake_torque>(kMotorTorque, kNotNegative,
                                "Torque of the brake while it is not released; unset: as max_torque; 0: no brake.");
}

void describe(Description<TwinBelt>& d) {
  using B = TwinBelt;
  d.about("A belt of the twin, which carries products by friction.");
  d.required<&B::belt>("Name of the belt.");
  d.defaulted<&B::from>(unit::mm, kTwinPlace, "Begin of the belt, from its origin.");
  d.defaulted<&B::to>(unit::mm, kTwinPlace, "End of the belt, from its origin; products that reach it are removed.");
  d.defaulted<&B::width>(unit::mm, kTwinSize, "Width of the belt.");
  d.defaulted<&B::surface>(unit::mm, kTwinPlace, "Z of the surface of the belt, from its origin.");
  d.defaulted<&B::friction>(between(0.01, 10), "Coefficient of friction between belt and products.");
  d.defaulted<&B::barrier>(unit::mm, kTwinPlace,
                           "Position of a light barrier across the belt, from its origin, wired as the touch probe of "
                           "its axis; unset: none.");
}

void describe(Description<TwinProducts>& d) {
  using P = TwinProducts;
  d.about("Products of the twin: equal boxes.");
  d.defaulted<&P::count>(between(1, 100), "Largest number of products at once.");
  d.required<&P::length>(unit::mm, kTwinSize, "Length along X of the belt.");
  d.required<&P::width>(unit::mm, kTwinSize, "Width along Y.");
  d.required<&P::height>(unit::mm, kTwinSize, "Height along Z.");
  d.required<&P::mass>(kKilogram, kPositive, "Mass of each product.");
  d.defaulted<&P::friction>(between(0.01, 10), "Coefficient of friction between products.");
}

void describe(Description<TwinGripper>& d) {
  using G = TwinGripper;
  d.about("A vacuum gripper at the tool.");
  d.defaulted<&G::reach>(
      unit::mm, kTwinSize,
      "Largest distance from the tool to the middle of a product's top at which the gripper holds it.");
  d.defaulted<&G::force>(kNewton, kPositive, "Force at which the gripper loses the product.");
  d.defaulted<&G::acts_s>(unit::s, between(0, 10), "Time that the gripper takes to close or open.");
  d.defaulted<&G::radius>(unit::mm, kTwinSize, "Radius of its cup.");
  d.defaulted<&G::length>(unit::mm, kTwinSize, "Length of its cup above the tool centre point.");
}

void describe(Description<TwinMechanism>& d) {
  using M = TwinMechanism;
  d.about("The mechanism of a group in the twin.");
  d.required<&M::group>("Name of the group.");
  d.defaulted<&M::platform_mass>(kKilogram, kPositive, "Delta: mass of the platform.");
  d.defaulted<&M::rod_mass>(kKilogram, kPositive, "Delta: mass of each of the six rods.");
  d.defaulted<&M::payload>(kKilogram, kNotNegative, "Mass of a load at the tool.");
  d.defaulted<&M::tool>("Site or body of the given model that is the tool.");
  d.defaulted<&M::gripper>("A gripper at the tool; models made from the kinematics.");
}

void describe(Description<TwinParams>& d) {
  using T = TwinParams;
  d.about("A twin of the machine in a physics engine: takt twin, and Engine(machine, plant=\"mujoco\").");
  d.defaulted<&T::model>(
      "File of a model, MJCF or URDF, relative to the machine file; unset: the model is made from the kinematics.");
  d.defaulted<&T::step_s>(unit::s, between(0.00005, 0.002), "Step of the physics.");
  d.defaulted<&T::axes>("Axes that the twin moves; the others keep their simulated servos.");
  d.defaulted<&T::mechanisms>("Mechanisms of groups whose axes the twin moves.");
  d.defaulted<&T::belts>("Belts whose axes the twin moves.");
  d.defaulted<&T::products>("Products that belts carry and grippers hold.");
}

}  // namespace takt::plant
