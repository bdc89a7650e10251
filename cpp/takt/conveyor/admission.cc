// Commands to a belt: objects are detected, located, taken and deleted.
#include "takt/conveyor/belt.h"
#include "takt/core/describe.h"
#include "takt/core/in_range.h"

namespace takt::conveyor {

namespace {

struct AdmissionResult {
  Status status;
  double value = 0;
};

bool IsLocated(const Detect& d) {
  return d.x || d.y || d.z || d.a || d.b || d.c;
}

AdmissionResult CarryOut(const Context& c, const Detect& d, State& s) {
  double latch = s.travel.position;
  if (d.recorded_position) latch = TravelAt(c, s, *d.recorded_position);
  if (d.latched_with) {
    const Object* other = Find(s, *d.latched_with);
    if (!other) return {Status::Failed(ErrorId::kNoWorkpiece)};
    latch = other->latch;
  }
  if (s.count == kObjects) {
    ++s.refused;
    return {Status::Failed(ErrorId::kTooManyWorkpieces)};
  }
  Object& object = s.objects[s.count++];
  object.number = ++s.last_number;
  object.state = IsLocated(d) ? ObjectState::kVisible : ObjectState::kDetected;
  object.latch = latch;
  object.pose = {d.x.value_or(0), d.y.value_or(0), d.z.value_or(0), d.a.value_or(0), d.b.value_or(0), d.c.value_or(0)};
  object.attributes = {d.kind, d.colour, d.quality};
  return {Status::Ok(), static_cast<double>(object.number)};
}

Object* WaitsForPose(State& s) {
  for (std::uint32_t i = 0; i < s.count; ++i) {
    if (s.objects[i].state == ObjectState::kDetected) return &s.objects[i];
  }
  return nullptr;
}

Object* Named(const Locate& l, State& s) {
  if (!l.number) return WaitsForPose(s);
  Object* found = Find(s, *l.number);
  return found && found->state != ObjectState::kTaken ? found : nullptr;
}

AdmissionResult CarryOut(const Context&, const Locate& l, State& s) {
  Object* object = Named(l, s);
  if (!object) return {Status::Failed(ErrorId::kNoWorkpiece)};
  object->state = ObjectState::kVisible;
  object->pose = {l.x, l.y, l.z, l.a, l.b, l.c};
  Attributes& attributes = object->attributes;
  attributes = {l.kind.value_or(attributes.kind), l.colour.value_or(attributes.colour),
                l.quality.value_or(attributes.quality)};
  return {Status::Ok(), static_cast<double>(object->number)};
}

AdmissionResult CarryOut(const Context&, const TakeObject& command, State& s) {
  return {Take(command.number, s)};
}
AdmissionResult CarryOut(const Context&, const GiveBackObject& command, State& s) {
  return {GiveBack(command.number, s)};
}
AdmissionResult CarryOut(const Context&, const RemoveObject& command, State& s) {
  return {Remove(command.number, s)};
}
AdmissionResult CarryOut(const Context&, const ClearObjects&, State& s) {
  while (s.count > 0) s.objects[--s.count] = Object{};
  return {};
}

}  // namespace

void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept {
  const AdmissionResult answer = std::visit(
      [&](const auto& body) {
        return takt::InRange(body) ? CarryOut(c, body, s) : AdmissionResult{Status::Failed(ErrorId::kParameter)};
      },
      command);
  const auto report = [&](FeedbackState state, double value) {
    c.feedback.Report({ticket, c.cycle.count, state, false, answer.status.error, value});
  };
  if (answer.status.failed()) return report(FeedbackState::kError, 0);
  report(FeedbackState::kActive, 0);
  report(FeedbackState::kDone, answer.value);
}

}  // namespace takt::conveyor
