// Selection of the next workpiece, and whether it can be reached in time (PP-44).
#include <algorithm>
#include <cmath>

#include "takt/core/angle.h"
#include "takt/group/systems.h"
#include "takt/kinematics/rotations.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

using conveyor::Object;
using kinematics::Frame;

// Iterations between the position of arrival and the time to reach it.
constexpr int kRounds = 3;
// From the end of the time on a workpiece until the way up begins.
constexpr double kCyclesBetween = 4;
constexpr double kSpeedsUp_s = 0.05;
// Workpieces tried per cycle: one after the other they become reachable, or leave the range.
constexpr std::size_t kTriesWhileWaiting = 2;

const Belt& BeltOf(const Context& c, const Order& order) {
  return c.belts[order.belt - 1];
}

bool IsInside(const BeltSettings& own, double place) {
  return !HasRange(own) || (place >= own.lower_limit && place <= own.upper_limit);
}

// PP-66: returns true if kind, colour and quality are as requested.
bool IsWanted(const BeltSettings& own, const conveyor::Attributes& of) {
  return (own.kind == 0 || of.kind == own.kind) && (own.colour == 0 || of.colour == own.colour) &&
         of.quality >= own.least_quality;
}

// PP-67: returns true if the workpiece belongs to this module by its number.
bool IsOurs(const BeltSettings& own, std::uint32_t number) {
  const std::uint32_t place = (number - 1) % own.every + 1;  // within the round
  return place >= own.turn && place - own.turn < own.turns;
}

// PP-67: returns true if the module may take another workpiece of this belt by now.
bool MayTake(const Context& c, const Order& order, const State& s) {
  const BeltSettings& own = order.own;
  const Belt& belt = c.belts[order.belt - 1];
  const std::uint64_t last = s.taken_cycle[order.belt - 1];
  const double since_s = static_cast<double>(c.group.cycle.count - last) * c.group.cycle.period_s;
  if (own.most_per_minute > 0 && last != 0 && since_s * own.most_per_minute < 60) return false;
  if (own.leave == 0) return true;
  const int sense = belt.state->sense;
  const double end = sense > 0 ? own.upper_limit : own.lower_limit;
  const auto lies_behind = [&](const Object& object) {
    return object.state == conveyor::ObjectState::kVisible &&
           sense * (conveyor::PlaceOf(*belt.params, *belt.state, object) - end) > 0;
  };
  return std::ranges::count_if(conveyor::ObjectsOf(*belt.state), lies_behind) >= static_cast<int>(own.leave);
}

kinematics::Pose GripOn(const BeltSettings& own) {
  return {own.grip_x, own.grip_y, own.grip_z, own.grip_a, own.grip_b, own.grip_c};
}

// Returns the next one of the two systems that workpieces get alternately.
std::uint32_t NextPcs(const State& s) {
  return s.second_pcs ? s.settings.workpiece_pcs2 : s.settings.workpiece_pcs1;
}

// Returns the pose of the object in the MCS after this travel of the belt.
Frame ObjectAfter(const Context& c, const Belt& belt, const Object& object, double travel) {
  conveyor::State later;
  later.travel = belt.state->travel;
  later.travel.position += travel;
  return c.group.mounting.base_inverse * conveyor::PoseOf(*belt.params, later, object).GetFrame();
}

// Returns true if objects lost by belts count as missed: while the module moves.
bool CountsLost(const State& s) {
  return s.state == PickPlaceState::kMovePp || s.state == PickPlaceState::kPreparingPath;
}

void EraseLeft(std::uint32_t index, State& s) {
  std::shift_left(s.left.begin() + index, s.left.begin() + s.left_count, 1);
  s.left[--s.left_count] = {};
}

std::uint32_t FindLeft(std::uint32_t belt, std::uint32_t number, const State& s) {
  std::uint32_t i = 0;
  while (i < s.left_count && (s.left[i].belt != belt || s.left[i].number != number)) ++i;
  return i;
}

void ForgetLeft(std::uint32_t belt, std::uint32_t number, State& s) {
  if (const std::uint32_t i = FindLeft(belt, number, s); i < s.left_count) EraseLeft(i, s);
}

void CountLeft(LeftWorkpiece& left, State& s) {
  if (left.counted) return;
  left.counted = true;
  ++s.counters.missed;
  ++(left.refused ? s.counters.refused : s.counters.interrupted);
}

void CountLostObject(std::uint32_t belt, const conveyor::LostObject& lost, State& s) {
  if (const std::uint32_t i = FindLeft(belt, lost.number, s); i < s.left_count) {
    CountLeft(s.left[i], s);
    return EraseLeft(i, s);
  }
  // Only belts of the tracking mode count.
  const bool of_mode = !s.loop.active || s.loop.pick_belt == belt || s.loop.place_belt == belt;
  const bool goes_there = s.order_count > 0 && s.orders[0].belt == belt;
  const BeltSettings& own = goes_there ? s.orders[0].own : s.belts[belt - 1];
  if (!CountsLost(s) || !of_mode || !IsWanted(own, lost.attributes) || !IsOurs(own, lost.number)) return;
  ++s.counters.too_late;
  ++s.counters.missed;
}

// Returns the range of speeds of a belt from now on. Within it the speed may change arbitrarily.
std::array<double, 2> SpeedsOf(const Belt& belt, const BeltSettings& own) {
  // A belt that speeds up continues to do so for a while.
  const KinematicState& travel = belt.state->travel;
  const bool speeds_up = travel.velocity * travel.acceleration >= 0;
  const double now = travel.velocity + (speeds_up ? kSpeedsUp_s * travel.acceleration : 0);
  return {std::min(now, own.lowest_speed), std::max(now, own.highest_speed)};
}

// Returns the time [s] from the end of the time on a workpiece until the tool is up.
double TimeUp(const Context& c, const group::State& g, const Order& order, const BeltSettings& own) {
  // From rest to rest: the tool does not stop up there, so there is a margin.
  const double lift_s = own.z_distance > 0 ? TimeFor(own.z_distance, order.ramps) : 0;
  return kCyclesBetween * c.group.cycle.period_s + lift_s / OverrideOf(g);
}

bool IsInside(const Belt& belt, const BeltSettings& own, double place) {
  return IsInside(own, place) && conveyor::IsWithin(*belt.params, place);
}

// Returns true if a place of the workpiece is within the range and stays there while a tool on its way down is braked
// and goes up again, even if the belt changes its speed with the assumed acceleration. While that holds for the place
// at which the pick is expected to end, it can be given up within the range (PP-61): in the time T of that the belt
// moves at most v T + a T²/2.
bool IsSafe(const Context& c, const group::State& g, const Order& order, double place, double speed) {
  const BeltSettings& own = order.own;
  const Belt& belt = BeltOf(c, order);
  const double brake_s = own.z_distance > 0 ? 0.5 * TimeFor(2 * own.z_distance, order.ramps) / OverrideOf(g) : 0;
  const double time_s = brake_s + TimeUp(c, g, order, own);
  const double travel = 0.5 * own.sudden_acceleration * time_s * time_s;
  const double ahead = own.highest_speed > 0 ? 0 : std::max(0.0, travel - std::max(0.0, -speed) * time_s);
  const double back = own.lowest_speed < 0 ? 0 : std::max(0.0, travel - std::max(0.0, speed) * time_s);
  return IsInside(belt, own, place - back) && IsInside(belt, own, place + ahead);
}

double Apart(const Belt& belt, const Object& object, const Object& other) {
  const auto place = [&](const Object& of) { return conveyor::PoseOf(*belt.params, *belt.state, of).GetFrame().p; };
  return (place(object) - place(other)).Norm();
}

// PP-66: returns true if the object is a workpiece that was taken, detected twice.
bool IsTaken(const Belt& belt, const BeltSettings& own, const Object& object) {
  return own.same_within > 0 && std::ranges::any_of(conveyor::ObjectsOf(*belt.state), [&](const Object& other) {
           return other.state == conveyor::ObjectState::kTaken && Apart(belt, object, other) <= own.same_within;
         });
}

// Returns true if the tool can reach the object, and the point above it.
bool CanBeAt(const Context& c, const group::State& g, const Order& order, const Frame& object) {
  const BeltSettings& own = order.own;
  const group::End present = group::Present(c.group, g);
  kinematics::Pose grip = GripOn(own);
  for (const double height : {0.0, own.z_distance}) {
    grip.z = own.grip_z + height;
    Frame at = object * kinematics::ToFrame(grip);
    if (order.shape.keep_orientation) {
      at.M = present.tool.M;
    } else {
      at = kinematics::ToFrame(Levelled(c, g, {.pose = kinematics::ToPose(at)}).pose);
    }
    kinematics::Joints joints = present.joints;
    if (group::JointsAt(c.group, at, present.joints, joints) != kinematics::Reason::kNone) return false;
    if (!group::WithinRanges(c.group, g, joints)) return false;
  }
  return true;
}

// The pose at which tool and object meet if the belt runs at this speed, and the estimated time to reach it.
struct Meeting {
  ErrorId error = ErrorId::kNone;
  Frame object;
  double time_s = 0;
};

Meeting Meet(const Context& c, const group::State& g, const Order& order, const Object& object, double speed,
             const State& s) {
  const BeltSettings& own = order.own;
  const Place from = s.at_known ? s.at : PresentPlace(c, g);
  const Frame start = group::SystemFrame(c.group, g, from.system, from.pcs - 1);
  const Shape shape = ShapeFromHere(c, g, order.shape, s);
  const Place to{.system = group::CoordinateSystem::kPcs, .pcs = 1, .pose = GripOn(own), .aux1 = own.aux1_target};
  Meeting meeting;
  for (int i = 0; i < kRounds && meeting.error == ErrorId::kNone; ++i) {
    meeting.object = ObjectAfter(c, BeltOf(c, order), object, speed * TimeFactor(g, s) * meeting.time_s);
    const Systems systems{c.group.mounting.base, start, meeting.object};
    const Profile profile = MakeProfile(from, to, shape, systems);
    meeting.error = profile.error;
    meeting.time_s = TimeAlong(profile, from, order.ramps, systems);
  }
  return meeting;
}

// Returns true if they meet, and part, within the range and within reach.
bool IsReachableAt(double speed, const Context& c, const group::State& g, const Order& order, const Object& object,
                   const State& s) {
  const Belt& belt = BeltOf(c, order);
  const BeltSettings& own = order.own;
  const Meeting meeting = Meet(c, g, order, object, speed, s);
  if (meeting.error != ErrorId::kNone) return false;
  const double travel = speed * (TimeFactor(g, s) * meeting.time_s + own.sync_time + TimeUp(c, g, order, own));
  const double end = conveyor::PlaceOf(*belt.params, *belt.state, object) + travel;
  return IsSafe(c, g, order, end, speed) && CanBeAt(c, g, order, meeting.object) &&
         CanBeAt(c, g, order, ObjectAfter(c, belt, object, travel));
}

// Any position that the belt may reach meanwhile lies between those at its two extreme speeds.
bool IsReachable(const Context& c, const group::State& g, const Order& order, const Object& object, const State& s) {
  const auto [lowest, highest] = SpeedsOf(BeltOf(c, order), order.own);
  return IsReachableAt(highest, c, g, order, object, s) &&
         (lowest == highest || IsReachableAt(lowest, c, g, order, object, s));
}

}  // namespace

double TimeFactor(const group::State& g, const State& s) noexcept {
  return s.slowness / OverrideOf(g);
}

const Object* ChooseWorkpiece(const Context& c, const group::State& g, const Order& order, State& s) noexcept {
  const Belt& belt = BeltOf(c, order);
  const BeltSettings& own = order.own;
  if (!MayTake(c, order, s)) return nullptr;
  const auto objects = conveyor::ObjectsOf(*belt.state);
  const KDL::Vector tool = group::Present(c.group, g).tool.p;
  const auto rank = [&](const Object& object) {
    const double place = belt.state->sense * conveyor::PlaceOf(*belt.params, *belt.state, object);
    switch (order.rule) {
      case WorkpieceRule::kFirst:
        return place;
      case WorkpieceRule::kLatest:
        return -place;
      default:
        return -(ObjectAfter(c, belt, object, 0).p - tool).Norm();
    }
  };
  std::array<double, conveyor::kObjects> ranks{};
  for (std::size_t i = 0; i < objects.size(); ++i) ranks[i] = rank(objects[i]);
  const auto is_behind = [&](std::size_t i, std::size_t other) {
    return ranks[i] != ranks[other] ? ranks[i] < ranks[other] : i > other;
  };
  const bool waits = order.phase == Phase::kWaiting;
  std::size_t tried = objects.size();
  if (const Object* last = conveyor::Find(*belt.state, waits ? s.searched : 0)) {
    tried = static_cast<std::size_t>(last - objects.data());
  }
  for (std::size_t tries = waits ? kTriesWhileWaiting : objects.size(); tries > 0; --tries) {
    std::size_t best = objects.size();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Object& object = objects[i];
      if (tried < objects.size() && !is_behind(i, tried)) continue;
      if (best < objects.size() && is_behind(i, best)) continue;
      if (!conveyor::IsFree(*belt.params, *belt.state, object) || !IsWanted(own, object.attributes) ||
          !IsOurs(own, object.number))
        continue;
      if (IsInside(own, conveyor::PlaceOf(*belt.params, *belt.state, object))) best = i;
    }
    const bool found =
        best < objects.size() && !IsTaken(belt, own, objects[best]) && IsReachable(c, g, order, objects[best], s);
    s.searched = best == objects.size() || found ? 0 : objects[best].number;
    if (found) return &objects[best];
    if (s.searched == 0) return nullptr;
    tried = best;
  }
  return nullptr;
}

double TimeToMeet(const Context& c, const group::State& g, const Order& order, const Object& object,
                  const State& s) noexcept {
  return Meet(c, g, order, object, BeltOf(c, order).state->travel.velocity, s).time_s;
}

ErrorId BindWorkpiece(const Context& c, const Object& object, group::State& g, Order& order, Place& place,
                      State& s) noexcept {
  const Belt& belt = BeltOf(c, order);
  const BeltSettings& own = order.own;
  // Not the system in which the tool is now: that of the previous pick, which was given up.
  const Place& here = s.low ? s.over : s.at;
  const bool in_pcs = (s.low || s.at_known) && here.system == group::CoordinateSystem::kPcs;
  if (in_pcs && here.pcs == NextPcs(s)) s.second_pcs = !s.second_pcs;
  const std::uint32_t pcs = NextPcs(s);
  // Relative to its present position, so that the count of the belt's axis does not matter.
  const double since = belt.state->travel.position - object.latch;
  Frame moved = kinematics::ToFrame(object.pose);
  if (belt.params->kind == conveyor::BeltKind::kTurning) {
    moved = Frame(kinematics::AboutZ(since * kDegree)) * moved;
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
  order.attributes = object.attributes;
  if (const Status taken = conveyor::Take(number, *belt.state); taken.failed()) return taken.error;
  order.workpiece = number;
  ForgetLeft(order.belt, number, s);
  s.taken_cycle[order.belt - 1] = c.group.cycle.count;
  s.second_pcs = !s.second_pcs;
  place = {.system = group::CoordinateSystem::kPcs, .pcs = pcs, .pose = GripOn(own), .aux1 = own.aux1_target};
  return ErrorId::kNone;
}

void GiveBackWorkpiece(const Context& c, Order& order) noexcept {
  if (order.workpiece != 0) conveyor::GiveBack(order.workpiece, *BeltOf(c, order).state);
  order.workpiece = 0;
}

void RemoveWorkpiece(const Context& c, Order& order) noexcept {
  if (order.workpiece == 0) return;
  const Belt& belt = BeltOf(c, order);
  if (const Object* object = conveyor::Find(*belt.state, order.workpiece)) {
    const Object fetched = *object;
    for (std::uint32_t i = belt.state->count; i-- > 0 && order.own.same_within > 0;) {
      const Object& other = belt.state->objects[i];
      if (other.state == conveyor::ObjectState::kDetected) continue;
      if (Apart(belt, fetched, other) <= order.own.same_within) conveyor::Remove(other.number, *belt.state);
    }
    conveyor::Remove(order.workpiece, *belt.state);
  }
  order.workpiece = 0;
}

bool StaysWithin(const Context& c, const group::State& g, const Order& order, double time_s) noexcept {
  const Belt& belt = BeltOf(c, order);
  const BeltSettings& own = order.own;
  const Object* object = conveyor::Find(*belt.state, order.workpiece);
  if (!object) return false;
  const double place = conveyor::PlaceOf(*belt.params, *belt.state, *object);
  const double until_s = time_s + TimeUp(c, g, order, own);
  return std::ranges::all_of(SpeedsOf(belt, own),
                             [&](double speed) { return IsSafe(c, g, order, place + speed * until_s, speed); });
}

void NoteAbandoned(const Order& order, bool refused, State& s) noexcept {
  if (order.workpiece == 0) return;
  if (FindLeft(order.belt, order.workpiece, s) < s.left_count) return;  // the first cause counts
  if (s.left_count == kLeft) EraseLeft(0, s);
  s.left[s.left_count++] = {order.belt, order.workpiece, refused, false};
}

void CountLost(const Context& c, State& s) noexcept {
  for (std::uint32_t i = 0; i < c.params.belts.size(); ++i) {
    const conveyor::State& belt = *c.belts[i].state;
    if (belt.refused != s.refused_before[i]) {
      s.warning = ErrorId::kTooManyWorkpieces;
      s.warning_belt = i + 1;
    }
    s.refused_before[i] = belt.refused;
    for (; s.lost_before[i] != belt.lost; ++s.lost_before[i]) {
      CountLostObject(i + 1, belt.last_lost[s.lost_before[i] % conveyor::kObjects], s);
    }
  }
  for (std::uint32_t i = s.left_count; i-- > 0;) {
    LeftWorkpiece& left = s.left[i];
    const Belt& belt = c.belts[left.belt - 1];
    const Object* object = conveyor::Find(*belt.state, left.number);
    if (!object) {  // fetched by another module
      EraseLeft(i, s);
    } else if (!IsInside(belt, s.belts[left.belt - 1], conveyor::PlaceOf(*belt.params, *belt.state, *object))) {
      CountLeft(left, s);
    }
  }
}

}  // namespace takt::pickplace
