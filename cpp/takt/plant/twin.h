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

// The mechanism of a group of axes.
struct TwinMechanism {
  std::string group;                      // name of the group
  std::optional<double> platform_mass{};  // kg, Delta
  std::optional<double> rod_mass{};       // kg, Delta, of each of the six rods
  double payload = 0;                     // kg, a point at the tool
  std::string tool{};                     // site or body of the model that is given
};

struct TwinParams {
  std::string model{};     // file of MJCF or URDF, seen from the machine file; empty: made from the kinematics
  double step_s = 0.0005;  // s, of the physics
  std::vector<TwinAxis> axes;
  std::vector<TwinMechanism> mechanisms;
};

void describe(Enumeration<TwinDirection>&);
void describe(Description<TwinAxis>&);
void describe(Description<TwinMechanism>&);
void describe(Description<TwinParams>&);

}  // namespace takt::plant
