// Set points streamed from outside.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct Stream {
  std::int32_t key = 0;
  double delay = 0.02;
  double timeout = 0.1;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
};
struct StreamPoint {
  double position = 0;
  std::optional<double> velocity{};
  std::optional<double> time{};
  std::int32_t key = 0;
};

void describe(Description<Stream>&);
void describe(Description<StreamPoint>&);

}  // namespace takt::axis
