// Which workpiece is next, and whether it can be reached in time (PP-44).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/group/systems.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

using conveyor::Object;
using kinematics::Frame;

// So often the place of arrival is worked out anew from the time that the way there takes.
constexpr int kRounds = 3;

const Belt& BeltOf(const Context& c, const Order& order) {
  return c.belts[order.belt - 1];
}
const BeltSettings& SettingsFor(const Order& order, const State& s) {
  return s.belts[order.belt - 1];
}

bool IsInside(const BeltSettings& own, double place) {
  return own.lower_limit >= own.upper_limit || (place >= own.lower_limit && place <= own.upper_limit);
}
bool IsInside(const conveyor::BeltParams& p, double place) {
  return (!p.lower_limit || place >= *p.lower_limit) && (!p.upper_limit || place <= *p.upper_limit);
}

kinematics::Pose GripOn(const BeltSettings& own) {
  return {own.grip_x, own.grip_y, own.grip_z, own.grip_a, own.grip_b, own.grip_c};
}

// Seen from the MCS, a time later.
Frame ObjectIn(const Context& c, const Belt& belt, const Object& object, double time_s) {
  conveyor::State later;
  later.travel = belt.state->travel;
  later.travel.position += later.travel.velocity * time_s;
  return c.group.mounting.base_inverse * conveyor::PoseOf(*belt.params, later, object).GetFrame();
}

// How long it takes to get there, and whether tool and workpiece meet within the range and within reach.
bool IsReachable(const Context& c, const group::State& g, const Order& order, const Object& object, const State& s) {
  const Belt& belt = BeltOf(c, order);
  const BeltSettings& own = SettingsFor(order, s);
  const Place from = s.at_known ? s.at : PresentPlace(c, g);
  const Frame start = group::SystemFrame(c.group, g, from.system, from.pcs - 1);
  Place to{.system = group::CoordinateSystem::kPcs, .pcs = 1, .pose = GripOn(own), .aux1 = own.aux1_target};
  Frame target;
  double time_s = 0;
  for (int i = 0; i < kRounds; ++i) {
    target = ObjectIn(c, belt, object, time_s * s.slowness);
    const Systems systems{c.group.mounting.base, start, target};
    const Profile profile = MakeProfile(from, to, order.shape, systems);
    if (profile.error != ErrorId::kNone) return false;
    time_s = TimeAlong(profile, from, order.ramps, systems);
  }
  const double end = conveyor::PlaceIn(*belt.params, *belt.state, object, time_s * s.slowness + own.sync_time);
  if (!IsInside(own, end) || !IsInside(*belt.params, end)) return false;
  const Frame tool = target * kinematics::ToFrame(to.pose);
  const Frame above = target * kinematics::ToFrame({own.grip_x, own.grip_y, own.grip_z + own.z_distance, own.grip_a,
                                                    own.grip_b, own.grip_c});
  const group::End present = group::Present(c.group, g);
  for (Frame at : {tool, above}) {
    if (s.settings.keep_orientation) at.M = present.tool.M;
    kinematics::Joints joints = present.joints;
    if (group::JointsAt(c.group, at, present.joints, joints) != kinematics::Reason::kNone) return false;
    if (!group::WithinRanges(c.group, g, joints)) return false;
  }
  return true;
}

}  // namespace

const Object* ChooseWorkpiece(const Context& c, const group::State& g, const Order& order, const State& s) noexcept {
  const Belt& belt = BeltOf(c, order);
  const BeltSettings& own = SettingsFor(order, s);
  const auto objects = conveyor::ObjectsOf(*belt.state);
  const double sense = belt.state->sense;
  const KDL::Vector tool = group::Present(c.group, g).tool.p;
  const auto rank = [&](const Object& object) {
    const double place = sense * conveyor::PlaceOf(*belt.params, *belt.state, object);
    switch (s.settings.workpiece_rule) {
      case WorkpieceRule::kFirst:
        return place;
      case WorkpieceRule::kLatest:
        return -place;
      default:
        return -(ObjectIn(c, belt, object, 0).p - tool).Norm();
    }
  };
  std::array<bool, conveyor::kObjects> tried{};
  while (true) {
    std::size_t best = objects.size();
    double best_rank = 0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Object& object = objects[i];
      if (tried[i] || !conveyor::IsFree(*belt.params, *belt.state, object)) continue;
      if (!IsInside(own, conveyor::PlaceOf(*belt.params, *belt.state, object))) continue;
      const double r = rank(object);
      if (best < objects.size() && r <= best_rank) continue;
      best = i;
      best_rank = r;
    }
    if (best == objects.size()) return nullptr;
    if (IsReachable(c, g, order, objects[best], s)) return &objects[best];
    tried[best] = true;
  }
}

ErrorId BindWorkpiece(const Context& c, const Object& object, group::State& g, Order& order, Place& place,
                      State& s) noexcept {
  const Belt& belt = BeltOf(c, order);
  const BeltSettings& own = SettingsFor(order, s);
  const std::uint32_t pcs = s.second_pcs ? s.settings.workpiece_pcs2 : s.settings.workpiece_pcs1;
  // Where it is now: then it does not matter what the belt's axis counts.
  const double since = belt.state->travel.position - object.latch;
  Frame moved = kinematics::ToFrame(object.pose);
  if (belt.params->kind == conveyor::BeltKind::kTurning) {
    moved = Frame(KDL::Rotation::RotZ(since * std::numbers::pi / 180)) * moved;
  } else {
    moved.p.x(moved.p.x() + since);
  }
  const kinematics::Pose on = kinematics::ToPose(moved);
  const group::SetDynCoordTransform bind{.pcs = pcs,
                                         .carrier = Name::Of(belt.params->name),
                                         .x = on.x,
                                         .y = on.y,
                                         .z = on.z,
                                         .a = on.a,
                                         .b = on.b,
                                         .c = on.c};
  if (const ErrorId error = Tell(c, bind, g); error != ErrorId::kNone) return error;
  const std::uint32_t number = object.number;
  if (const Status taken = conveyor::Take(number, *belt.state); taken.failed()) return taken.error;
  order.workpiece = number;
  s.second_pcs = !s.second_pcs;
  place = {.system = group::CoordinateSystem::kPcs, .pcs = pcs, .pose = GripOn(own), .aux1 = own.aux1_target};
  return ErrorId::kNone;
}

void GiveBackWorkpiece(const Context& c, Order& order) noexcept {
  if (order.workpiece != 0) conveyor::GiveBack(order.workpiece, *BeltOf(c, order).state);
  order.workpiece = 0;
}

bool IsWithin(const Context& c, const Order& order, const State& s) noexcept {
  if (order.belt == 0 || order.workpiece == 0) return true;
  const Belt& belt = BeltOf(c, order);
  const Object* object = conveyor::Find(*belt.state, order.workpiece);
  if (!object) return false;
  const double place = conveyor::PlaceOf(*belt.params, *belt.state, *object);
  return IsInside(SettingsFor(order, s), place) && conveyor::InRange(*belt.params, *belt.state, *object);
}

void CountLost(const Context& c, State& s) noexcept {
  const bool counts = s.state == PickPlaceState::kMovePp || s.state == PickPlaceState::kPreparingPath;
  for (std::size_t i = 0; i < c.params.belts.size(); ++i) {
    const std::uint32_t lost = c.belts[i].state->lost;
    if (counts) {
      s.counters.too_late += lost - s.lost_before[i];
      s.counters.missed += lost - s.lost_before[i];
    }
    s.lost_before[i] = lost;
  }
}

}  // namespace takt::pickplace
