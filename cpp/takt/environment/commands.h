// Commands to an environment.
#pragma once

#include <cstdint>
#include <variant>

#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"
#include "takt/planar/environment.h"

namespace takt::environment {

struct AddStator {
  double lower_x = 0, lower_y = 0;  // [mm]
};
struct CreateBoundary {};  // of its stators; built outside the cycle
struct Clear {};
struct AddToGroup {
  Name group{};
};
struct RemoveFromGroup {};

// Answer to a build request (build_queues.h); not a command of users.
struct BoundaryMade {
  std::uint64_t number = 0;  // of the request
  planar::StatorProblem problem = planar::StatorProblem::kNone;
  std::uint32_t stator = 0;  // stator with the problem, from 1; 0: none
};

using Command = std::variant<AddStator, CreateBoundary, Clear, AddToGroup, RemoveFromGroup, BoundaryMade>;

void describe(Description<AddStator>&);
void describe(Description<CreateBoundary>&);
void describe(Description<Clear>&);
void describe(Description<AddToGroup>&);
void describe(Description<RemoveFromGroup>&);
void describe(Description<BoundaryMade>&);

}  // namespace takt::environment
