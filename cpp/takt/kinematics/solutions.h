// All positions of the axes for one pose: one in each configuration of the mechanism (GR-44).
#pragma once

#include "takt/kinematics/kinematics.h"

namespace takt::kinematics {

inline constexpr std::size_t kMostSolutions = 8;

struct Solutions {
  std::array<Joints, kMostSolutions> of{};
  std::array<Configuration, kMostSolutions> in{};
  std::size_t count = 0;
  std::array<Configuration, kMostSolutions> failed{};  // configurations without a solution, and
  std::array<Reason, kMostSolutions> failed_for{};     // the reasons
  std::size_t failed_count = 0;
  Reason reason = Reason::kOutOfReach;  // if there is no solution: the most specific reason; kNone otherwise
};

// Returns all solutions [u], each rotary axis within half a turn of `near`; ranges are not checked. `wanted`: only
// these configurations; kKeep: any. For mechanisms without configurations, and chains without a known closed form: the
// solution to which the iteration from `near` converges.
Solutions SolutionsOf(const Kinematics& k, const Frame& tool, const Configuration& wanted, const Joints& near) noexcept;

}  // namespace takt::kinematics
