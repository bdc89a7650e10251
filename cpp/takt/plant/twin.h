// The section `twin` of a machine file: the data that a physics engine needs about a machine (takt.twin in Python,
// MuJoCo). Only the values and their ranges are defined here; whether a model fits the machine is checked with the
// model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"

namespace takt::plant {

enum class TwinDirection : std::uint8_t { kX, kY, kZ };

// An axis that the twin moves: its motor, and, if the model is generated, the body that it moves.
struct TwinAxis {
  std::string axis;                          // name of the axis
  double max_torque = 0;                     // [Nm] or [N] of the motor at the axis
  std::string joint{};                       // of the given model
  std::optional<double> mass{};              // [kg] of the body that the axis itself moves; for generated models
  double radius = 100;                       // [mm] of the disc that a rotary axis without a mechanism turns
  std::optional<TwinDirection> direction{};  // of an axis without a mechanism
  double rotor_inertia = 0;                  // [kg m²] or [kg] of motor and gear at the axis
  double coulomb_friction = 0;               // [Nm] or [N]
  double viscous_friction = 0;               // [Nm s/rad] or [N s/m]
  std::optional<double> brake_torque{};      // [Nm] or [N]; unset: max_torque
};

// A belt that carries products by friction: a plate with a moving surface, its top level with the belt's origin.
struct TwinBelt {
  std::string belt;                 // name of the belt
  double from = -200;               // [mm] from its origin: begin ...
  double to = 1000;                 // ... and end
  double width = 200;               // [mm]
  double surface = 0;               // [mm] along Z of its origin
  double friction = 0.8;            // coefficient, for products on it
  std::optional<double> barrier{};  // [mm] from its origin: a light barrier, wired as touch probe of the belt's axis
};

// Identical products: boxes that belts carry and grippers hold.
struct TwinProducts {
  int count = 12;         // maximum number at a time
  double length = 0;      // [mm] along X
  double width = 0;       // [mm]
  double height = 0;      // [mm]
  double mass = 0;        // [kg]
  double friction = 0.6;  // coefficient, between products
};

// A vacuum gripper at the tool: a cup above the tool's point.
struct TwinGripper {
  double reach = 2;      // [mm] largest distance from the tool to the centre of a product's top at which it can hold it
  double force = 30;     // [N] at which it loses the product
  double acts_s = 0.03;  // [s] to close and to open
  double radius = 10;    // [mm] of its cup
  double length = 30;    // [mm] of its cup
};

// The mechanism of a group of axes.
struct TwinMechanism {
  std::string group;                      // name of the group
  std::optional<double> platform_mass{};  // [kg] Delta
  std::optional<double> rod_mass{};       // [kg] Delta, of each of the six rods
  double payload = 0;                     // [kg] a point mass at the tool
  std::string tool{};                     // site or body of the given model
  std::optional<TwinGripper> gripper{};   // at the tool
};

struct TwinParams {
  std::string model{};     // MJCF or URDF file, relative to the machine file; empty: generated from the kinematics
  double step_s = 0.0005;  // [s] of the physics
  std::vector<TwinAxis> axes;
  std::vector<TwinMechanism> mechanisms;
  std::vector<TwinBelt> belts;
  std::optional<TwinProducts> products{};
};

void describe(Enumeration<TwinDirection>&);
void describe(Description<TwinAxis>&);
void describe(Description<TwinBelt>&);
void describe(Description<TwinProducts>&);
void describe(Description<TwinGripper>&);
void describe(Description<TwinMechanism>&);
void describe(Description<TwinParams>&);

}  // namespace takt::plant
