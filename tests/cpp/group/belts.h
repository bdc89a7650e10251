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
