#include "takt/engine/carriers.h"

#include <algorithm>
#include <variant>

#include "takt/group/queue.h"
#include "takt/kinematics/kinematics.h"

namespace takt::engine {

namespace {

std::uint32_t FindCarrier(void* owner, std::string_view name) noexcept {
  const auto& [world, rider] = *static_cast<Rider*>(owner);
  std::uint32_t number = 0;
  for (const Belt& belt : world->belts) {
    ++number;
    if (belt.params.name == name) return number;
  }
  for (const AxesGroup& group : world->groups) {
    ++number;
    if (group.params.name == name) return &group == &world->groups[rider] ? 0 : number;
  }
  for (const conveyor::PoseParams& pose : world->poses) {
    ++number;
    if (pose.name == name) return number;
  }
  return 0;
}

// Returns the commanded pose of the tool of a group as a carrier; kNone if it has none.
kinematics::Carrier ToolOf(const World& w, std::size_t index) {
  const AxesGroup& group = w.groups[index];
  const group::State& s = w.group_states[index];
  kinematics::Carrier carrier;
  if (!group.kinematics || !s.kinematics_on) return carrier;
  kinematics::JointMotion motion;
  for (std::size_t k = 0; k < group.kinematics->count; ++k) {
    if (s.members[k] == 0) return carrier;
    const KinematicState& set = w.axis_states[s.members[k] - 1].setpoint;
    motion.position[k] = set.position;
    motion.velocity[k] = set.velocity;
    motion.acceleration[k] = set.acceleration;
  }
  kinematics::MovingFrame flange;
  if (kinematics::Forward(*group.kinematics, motion, flange) != kinematics::Reason::kNone) return carrier;
  carrier.kind = kinematics::CarrierKind::kFree;
  carrier.pose = group.mounting.base * flange * group.mounting.tool;
  return carrier;
}

kinematics::Carrier CarrierAt(void* owner, std::uint32_t number) noexcept {
  const World& w = *static_cast<Rider*>(owner)->world;
  std::size_t i = number - 1;
  if (i < w.belts.size()) return conveyor::CarrierOf(w.belts[i].params, w.belt_states[i].travel);
  i -= w.belts.size();
  if (i < w.groups.size()) return ToolOf(w, i);
  i -= w.groups.size();
  return i < w.poses.size() ? conveyor::CarrierOf(w.poses[i], w.cycle, w.pose_states[i]) : kinematics::Carrier{};
}

double CarrierTravelAt(void* owner, std::uint32_t number, double position) noexcept {
  World& w = *static_cast<Rider*>(owner)->world;
  const std::size_t i = number - 1;
  if (i >= w.belts.size()) return 0;
  const Belt& belt = w.belts[i];
  const conveyor::Context context{belt.params, w.axis_states[belt.axis], w.axis_params[belt.axis], w.cycle, w.feedback};
  const double travel = conveyor::TravelAt(context, w.belt_states[i], position);
  return conveyor::InCarrier(belt.params, travel);
}

}  // namespace

bool TakesToolAway(const group::Command& command) noexcept {
  if (const auto* transform = std::get_if<group::SetKinTransform>(&command)) return !transform->enable;
  return std::holds_alternative<group::RemoveAxis>(command) || std::holds_alternative<group::UngroupAllAxes>(command) ||
         std::holds_alternative<group::SetTool>(command) || std::holds_alternative<group::SetPosition>(command);
}

bool IsRidden(const World& w, std::size_t group) noexcept {
  const std::size_t number = w.belts.size() + group + 1;
  return std::ranges::any_of(w.group_states, [&](const group::State& rider) {
    bool rides = std::ranges::find(rider.ridden, number) != rider.ridden.end();
    for (std::size_t i = 0; i < rider.queue.count; ++i) {
      rides = rides || group::MoveAt(rider, rider.done + i).cargo.carrier == number;
    }
    return rides;
  });
}

group::Carriers CarriersFor(Rider& rider) noexcept {
  return {FindCarrier, CarrierAt, CarrierTravelAt, &rider, !rider.world->pick_places.empty()};
}

}  // namespace takt::engine
