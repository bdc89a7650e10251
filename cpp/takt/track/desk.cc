#include "takt/track/desk.h"

#include <memory>

#include "takt/track/on_parts.h"

namespace takt::track {

namespace {

void FreeRetired(Desk& desk) {
  for (const planar::Track* way = nullptr; desk.retired.TryPop(way);) delete way;
}

}  // namespace

Desk::~Desk() {
  FreeRetired(*this);
  for (Delivery delivery; deliveries.TryPop(delivery);) delete delivery.way;
}

std::optional<Answer> Make(Desk& desk) {
  FreeRetired(desk);
  Question question;
  if (!desk.questions.TryPop(question)) return std::nullopt;
  auto way = std::make_unique<planar::Track>();
  const planar::Layout layout = ToLayout(question.sketch);
  const planar::Making making = MakeWay(layout, *way);
  Answer answer{question.track, {question.number, making.problem, 0}};
  if (making.problem != planar::Problem::kNone) {
    if (making.element < layout.elements.size()) answer.made.element = static_cast<std::uint32_t>(making.element + 1);
  } else if (!LiesOn(desk.parts, question.part, *way)) {
    answer.made.problem = planar::Problem::kOffPart;
  } else if (desk.deliveries.TryPush({question.number, way.get()})) {
    way.release();
  }
  return answer;
}

}  // namespace takt::track
