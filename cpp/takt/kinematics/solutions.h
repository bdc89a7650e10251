// All positions of the axes for one pose: one in each configuration of the mechanism (GR-44).
#pragma once

#include "takt/kinematics/kinematics.h"

namespace takt::kinematics {

inline constexpr std::size_t kMostSolutions = 8;

struct Solutions {
  std::array<Joints, kMostSolutions> of{};
  std::array<Configuration, kMostSolutions> in{};
  std::size_t count = 0;
  std::array<Configuration, kMostSolutions> failed{};  // those in which there is none, and
  std::array<Reason, kMostSolutions> failed_for{};     // why
  std::size_t failed_count = 0;
  Reason reason = Reason::kOutOfReach;  // why there is none, of that which comes nearest to one
};

// In u, each rotary axis within half a turn of `near`; ranges are not looked at. `wanted`: only those; kKeep: any.
// Mechanisms without configurations, and chains for which no closed form is known: that which `near` runs into.
Solutions SolutionsOf(const Kinematics& k, const Frame& tool, const Configuration& wanted, const Joints& near) noexcept;

}  // namespace takt::kinematics
