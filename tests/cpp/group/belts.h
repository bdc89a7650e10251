// Belts and tables for a group to ride on: they move as they are told, exactly.
#pragma once

#include <functional>
#include <memory>
#include <numbers>

#include "machines.h"
#include "watch.h"

namespace takt::group {

using kinematics::Carrier;
using kinematics::CarrierKind;

struct Belt {
  std::string name;
  Carrier carrier;
  std::function<KinematicState(double t)> travel;
};

struct Belts {
  std::vector<Belt> all;
  const Cycle* cycle = nullptr;

  Carrier At(std::size_t i) const {
    Carrier carrier = all[i].carrier;
    carrier.travel = all[i].travel(static_cast<double>(cycle->count) * cycle->period_s);
    return carrier;
  }
};

inline KinematicState Steady(double t, double speed) {
  return {speed * t, speed, 0};
}

// A belt along X of a frame.
inline Belt BeltAt(const std::string& name, const Pose& origin, std::function<KinematicState(double)> travel,
                   CarrierKind kind = CarrierKind::kStraight) {
  Carrier carrier;
  carrier.kind = kind;
  carrier.origin = kinematics::ToFrame(origin);
  return {name, carrier, std::move(travel)};
}

inline constexpr double kOnObject = 1e-9;  // mm

// The same on an object, and in another buffer mode; with a radius round the corner before it.
template <typename Move>
Move On(Move m, std::uint32_t pcs, BufferMode buffer, double radius) {
  if (pcs != 0) {
    m.coordinate_system = CoordinateSystem::kPcs;
    m.pcs = pcs;
  }
  m.buffer_mode = buffer;
  if (radius > 0) {
    m.transition_mode = TransitionMode::kCornerDistance;
    m.transition_parameter = radius;
  }
  return m;
}

inline MoveLinearAbsolute Line(double x, double y, double z, std::uint32_t pcs = 0,
                               BufferMode buffer = BufferMode::kAborting, double radius = 0) {
  return On(MoveLinearAbsolute{.x = x, .y = y, .z = z}, pcs, buffer, radius);
}

// Puts belts into the rig's machine; they live as long as what is returned.
inline std::unique_ptr<Belts> Put(Rig& rig, std::vector<Belt> all) {
  auto belts = std::make_unique<Belts>(Belts{std::move(all), &rig.cycle});
  rig.carriers = {[](void* owner, std::string_view name) noexcept -> std::uint32_t {
                    const auto& all = static_cast<Belts*>(owner)->all;
                    for (std::size_t i = 0; i < all.size(); ++i) {
                      if (all[i].name == name) return static_cast<std::uint32_t>(i + 1);
                    }
                    return 0;
                  },
                  [](void* owner, std::uint32_t i) noexcept { return static_cast<Belts*>(owner)->At(i - 1); },
                  [](void*, std::uint32_t, double position) noexcept { return position; }, belts.get()};
  return belts;
}

// An object on a belt in the cycle last recorded.
inline Frame ObjectOn(const Belts& belts, std::size_t belt, double from, const Pose& on, std::uint64_t cycle) {
  Carrier carrier = belts.all[belt].carrier;
  carrier.travel = belts.all[belt].travel(static_cast<double>(cycle) * belts.cycle->period_s);
  return kinematics::PoseOn(carrier, from, kinematics::ToFrame(on)).GetFrame();
}

}  // namespace takt::group
