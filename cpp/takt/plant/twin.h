// The section `twin` of a machine file: what a physics engine has to know of a machine (takt.twin in Python, MuJoCo).
// Here are the numbers and their ranges alone; whether a model fits the machine is judged where the model is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"

namespace takt::plant {

enum class TwinDirection : std::uint8_t { kX, kY, kZ };

// An axis that the twin moves: its motor, and the body that it moves where the model is made.
struct TwinAxis {
  std::string axis;                          // name of the axis
  double max_torque = 0;                     // Nm or N, of the motor at the axis
  std::string joint{};                       // of the model that is given
  std::optional<double> mass{};              // kg, of the body that the axis itself moves; made models
  double radius = 100;                       // mm, of the disc that a rotary axis alone turns
  std::optional<TwinDirection> direction{};  // of an axis alone
  double rotor_inertia = 0;                  // kg m² or kg, of motor and gear at the axis
  double coulomb_friction = 0;               // Nm or N
  double viscous_friction = 0;               // Nm s/rad or N s/m
  std::optional<double> brake_torque{};      // Nm or N; unset: as max_torque
};

// A belt that carries products by friction: a plate whose surface moves, the top of it level with the belt's origin.
struct TwinBelt {
  std::string belt;                 // name of the belt
  double from = -200;               // mm from its origin, where it begins ...
  double to = 1000;                 // ... and ends
  double width = 200;               // mm
  double surface = 0;               // mm, of Z of its origin
  double friction = 0.8;            // coefficient, of products on it
  std::optional<double> barrier{};  // mm from its origin: a light barrier, wired as touch probe of the belt's axis
};

// Products, all alike: boxes that belts carry and grippers hold.
struct TwinProducts {
  int count = 12;         // at once
  double length = 0;      // mm, along X
  double width = 0;       // mm
  double height = 0;      // mm
  double mass = 0;        // kg
  double friction = 0.6;  // coefficient, on one another
};

// A vacuum gripper at the tool: a cup above the tool's point.
struct TwinGripper {
  double reach = 2;      // mm, from the tool to the middle of a product's top at which it holds it
  double force = 30;     // N, at which it loses it
  double acts_s = 0.03;  // s, to close and to open
  double radius = 10;    // mm, of its cup
  double length = 30;    // mm, of its cup
};

// The mechanism of a group of axes.
struct TwinMechanism {
  std::string group;                      // name of the group
  std::optional<double> platform_mass{};  // kg, Delta
  std::optional<double> rod_mass{};       // kg, Delta, of each of the six rods
  double payload = 0;                     // kg, a point at the tool
  std::string tool{};                     // site or body of the model that is given
  std::optional<TwinGripper> gripper{};   // at the tool
};

struct TwinParams {
  std::string model{};     // file of MJCF or URDF, seen from the machine file; empty: made from the kinematics
  double step_s = 0.0005;  // s, of the physics
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
