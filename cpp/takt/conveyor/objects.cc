#include "takt/conveyor/objects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "takt/core/angle.h"
#include "takt/core/maths.h"

namespace takt::conveyor {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// On a table, from -180 to 180 if that is within the range, or if there is no upper limit; otherwise, if the object is
// less than half a turn before the lower limit, at that angle, even if a later turn is within the range; otherwise in
// the last turn that is not beyond the upper limit: the object reaches the range within a turn of positive travel.
double InitialPlace(const BeltParams& p, const Object& object) {
  if (p.kind != BeltKind::kTurning) return object.pose.x;
  const double angle = maths::Atan2(object.pose.y, object.pose.x) / kDegree;
  if (!p.upper_limit || IsWithin(p, angle)) return angle;
  if (p.lower_limit) {
    const double before = angle + 360 * (std::ceil((*p.lower_limit - angle) / 360) - 1);
    if (*p.lower_limit - before < 180) return before;
  }
  return angle + 360 * std::floor((*p.upper_limit - angle) / 360);
}

template <typename Objects>
auto* Search(Objects& objects, std::uint32_t count, std::uint32_t number) {
  const auto all = std::span(objects).first(count);
  const auto found = std::ranges::lower_bound(all, number, {}, &Object::number);
  return found != all.end() && found->number == number ? &*found : nullptr;
}

bool IsVisible(const Object& object) {
  return object.state != ObjectState::kDetected;
}

}  // namespace

double InCarrier(const BeltParams& p, double length) noexcept {
  return p.kind == BeltKind::kTurning ? length * kDegree : length;
}

kinematics::Carrier CarrierOf(const BeltParams& p, const KinematicState& travel) noexcept {
  kinematics::Carrier carrier;
  carrier.kind = p.kind == BeltKind::kTurning ? kinematics::CarrierKind::kTurning : kinematics::CarrierKind::kStraight;
  carrier.origin = kinematics::ToFrame(p.origin);
  carrier.travel = {InCarrier(p, travel.position), InCarrier(p, travel.velocity), InCarrier(p, travel.acceleration)};
  return carrier;
}

std::span<const Object> ObjectsOf(const State& s) noexcept {
  return std::span(s.objects).first(s.count);
}

const Object* Find(const State& s, std::uint32_t number) noexcept {
  return Search(s.objects, s.count, number);
}

Object* Find(State& s, std::uint32_t number) noexcept {
  return Search(s.objects, s.count, number);
}

double PlaceOf(const BeltParams& p, const State& s, const Object& object) noexcept {
  return s.travel.position - object.latch + InitialPlace(p, object);
}

kinematics::MovingFrame PoseOf(const BeltParams& p, const State& s, const Object& object) noexcept {
  KinematicState since = s.travel;
  since.position -= object.latch;
  return kinematics::PoseOn(CarrierOf(p, since), 0, kinematics::ToFrame(object.pose));
}

Seen See(const BeltParams& p, const State& s, const Object& object) noexcept {
  if (!IsVisible(object)) return {kNone, {kNone, kNone, kNone, kNone, kNone, kNone}, false};
  return {PlaceOf(p, s, object), kinematics::ToPose(PoseOf(p, s, object).GetFrame()), InRange(p, s, object)};
}

bool IsWithin(const BeltParams& p, double place) noexcept {
  return (!p.lower_limit || place >= *p.lower_limit) && (!p.upper_limit || place <= *p.upper_limit);
}

bool InRange(const BeltParams& p, const State& s, const Object& object) noexcept {
  return IsVisible(object) && IsWithin(p, PlaceOf(p, s, object));
}

bool IsFree(const BeltParams& p, const State& s, const Object& object) noexcept {
  return object.state == ObjectState::kVisible && InRange(p, s, object);
}

const Object* FirstFree(const BeltParams& p, const State& s) noexcept {
  const Object* first = nullptr;
  double furthest = 0;
  for (const Object& object : ObjectsOf(s)) {
    if (object.state != ObjectState::kVisible) continue;
    const double place = PlaceOf(p, s, object), along = s.sense * place;
    if (!IsWithin(p, place) || (first && along <= furthest)) continue;
    first = &object;
    furthest = along;
  }
  return first;
}

double TimeTo(const BeltParams& p, const State& s, const Object& object, double x) noexcept {
  const double way = x - PlaceOf(p, s, object);
  if (way == 0) return 0;
  const double time = way / s.travel.velocity;
  return time > 0 && std::isfinite(time) ? time : kNone;
}

double PlaceIn(const BeltParams& p, const State& s, const Object& object, double time_s) noexcept {
  return PlaceOf(p, s, object) + s.travel.velocity * time_s;
}

double TimeLeft(const BeltParams& p, const State& s, const Object& object) noexcept {
  if (!InRange(p, s, object)) return 0;
  const std::optional<double>& end = s.travel.velocity < 0 ? p.lower_limit : p.upper_limit;
  const double time = end ? TimeTo(p, s, object, *end) : kNone;
  return std::isnan(time) ? std::numeric_limits<double>::infinity() : time;
}

Status Take(std::uint32_t number, State& s) noexcept {
  Object* object = Find(s, number);
  if (!object || object->state != ObjectState::kVisible) return Status::Failed(ErrorId::kNoWorkpiece);
  object->state = ObjectState::kTaken;
  return Status::Ok();
}

Status GiveBack(std::uint32_t number, State& s) noexcept {
  Object* object = Find(s, number);
  if (!object || object->state != ObjectState::kTaken) return Status::Failed(ErrorId::kNoWorkpiece);
  object->state = ObjectState::kVisible;
  return Status::Ok();
}

Status Remove(std::uint32_t number, State& s) noexcept {
  Object* object = Find(s, number);
  if (!object) return Status::Failed(ErrorId::kNoWorkpiece);
  std::move(object + 1, s.objects.data() + s.count, object);
  s.objects[--s.count] = Object{};
  return Status::Ok();
}

Status Lose(std::uint32_t number, State& s) noexcept {
  const Object* object = Find(s, number);
  if (!object) return Status::Failed(ErrorId::kNoWorkpiece);
  s.last_lost[s.lost++ % kObjects] = {number, object->attributes};
  return Remove(number, s);
}

}  // namespace takt::conveyor
