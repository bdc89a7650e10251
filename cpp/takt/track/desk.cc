#include "takt/track/desk.h"

#include <memory>

#include "takt/track/on_parts.h"

namespace takt::track {

namespace {

void Free(SpscQueue<Delivery>& queue) {
  for (Delivery delivery; queue.TryPop(delivery);) {
    delete delivery.way;
    delete delivery.area;
  }
}

}  // namespace

Desk::~Desk() {
  Free(retired);
  Free(deliveries);
}

std::optional<Answer> Make(Desk& desk) {
  Free(desk.retired);
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
  } else {
    auto area = std::make_unique<planar::TrackArea>(planar::MakeTrackArea(*way, question.mover, 0));
    if (desk.deliveries.TryPush({question.number, way.get(), area.get()})) {
      static_cast<void>(way.release());  // the cycle has both
      static_cast<void>(area.release());
    }
  }
  return answer;
}

}  // namespace takt::track
