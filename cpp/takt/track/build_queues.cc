#include "takt/track/build_queues.h"

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

BuildQueues::~BuildQueues() {
  Free(retired);
  Free(deliveries);
}

std::optional<BuiltTrack> Make(BuildQueues& desk) {
  Free(desk.retired);
  BuildRequest question;
  if (!desk.questions.TryPop(question)) return std::nullopt;
  auto way = std::make_unique<planar::Track>();
  const planar::Layout layout = ToLayout(question.sketch);
  const planar::Making making = MakeTrackWithoutCrossings(layout, *way);
  BuiltTrack answer{question.track, {question.number, making.problem, 0}};
  if (making.problem != planar::Problem::kNone) {
    if (making.element < layout.elements.size()) answer.made.element = static_cast<std::uint32_t>(making.element + 1);
  } else if (!LiesOn(desk.parts, question.part, *way)) {
    answer.made.problem = planar::Problem::kOffPart;
  } else {
    auto area = std::make_unique<planar::TrackArea>(planar::MakeTrackArea(*way, question.mover, 0));
    if (desk.deliveries.TryPush({question.number, way.get(), area.get()})) {
      static_cast<void>(way.release());  // now owned by the cycle
      static_cast<void>(area.release());
    }
  }
  return answer;
}

}  // namespace takt::track
