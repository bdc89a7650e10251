// What people tell an environment.
#pragma once

#include <cstdint>
#include <variant>

#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"
#include "takt/planar/environment.h"

namespace takt::environment {

struct AddStator {
  double lower_x = 0, lower_y = 0;  // mm
};
struct CreateBoundary {};  // of the stators that there are; made outside the cycle
struct Clear {};
struct AddToGroup {
  Name group{};
};
struct RemoveFromGroup {};

// The answer to a question (build_queues.h); no command of people.
struct BoundaryMade {
  std::uint64_t number = 0;  // of the question
  planar::StatorProblem problem = planar::StatorProblem::kNone;
  std::uint32_t stator = 0;  // with which it is, from 1; 0: with none
};

using Command = std::variant<AddStator, CreateBoundary, Clear, AddToGroup, RemoveFromGroup, BoundaryMade>;

void describe(Description<AddStator>&);
void describe(Description<CreateBoundary>&);
void describe(Description<Clear>&);
void describe(Description<AddToGroup>&);
void describe(Description<RemoveFromGroup>&);
void describe(Description<BoundaryMade>&);

}  // namespace takt::environment
