#include "takt/environment/build_queues.h"

#include <memory>

namespace takt::environment {

namespace {

void FreeRetired(BuildQueues& desk) {
  for (const planar::Environment* surface = nullptr; desk.retired.TryPop(surface);) delete surface;
}

}  // namespace

BuildQueues::~BuildQueues() {
  FreeRetired(*this);
  for (Delivery delivery; deliveries.TryPop(delivery);) delete delivery.surface;
}

std::optional<BuiltBoundary> Make(BuildQueues& desk) {
  FreeRetired(desk);
  BuildRequest question;
  if (!desk.questions.TryPop(question)) return std::nullopt;
  auto surface = std::make_unique<planar::Environment>();
  const planar::SurfaceResult surfacing = planar::MakeEnvironment(*question.stators, *surface);
  BuiltBoundary answer{question.environment, {question.number, surfacing.problem, 0}};
  if (surfacing.problem != planar::StatorProblem::kNone) {
    if (surfacing.problem != planar::StatorProblem::kEmpty) {
      answer.made.stator = static_cast<std::uint32_t>(surfacing.stator + 1);
    }
  } else if (desk.deliveries.TryPush({question.number, surface.get()})) {
    static_cast<void>(surface.release());  // now owned by the cycle
  }
  return answer;
}

}  // namespace takt::environment
