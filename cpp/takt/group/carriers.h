// What can carry something, as a group sees it: belts, tables, tools of other groups, poses from elsewhere. Who they
// are the engine knows.
#pragma once

#include <cstdint>
#include <string_view>

#include "takt/kinematics/carrier.h"

namespace takt::group {

struct Carriers {
  // Its number, from 1; 0: there is none of that name.
  std::uint32_t (*find)(void* owner, std::string_view name) noexcept = nullptr;
  // As it is in this cycle: at the instant for which the members get their set points. Seen from the world.
  kinematics::Carrier (*at)(void* owner, std::uint32_t carrier) noexcept = nullptr;
  // Where its travel is when its axis shows this position; of an axis with a modulus: the last time it did. Carriers
  // without an axis: where the travel is now.
  double (*travel_at)(void* owner, std::uint32_t carrier, double position) noexcept = nullptr;
  void* owner = nullptr;
  bool modules = false;  // pick and place modules are there, which want to know how long their orders take

  std::uint32_t Find(std::string_view name) const noexcept { return find ? find(owner, name) : 0; }
  kinematics::Carrier At(std::uint32_t carrier) const noexcept {
    return at && carrier != 0 ? at(owner, carrier) : kinematics::Carrier{};
  }
  double TravelAt(std::uint32_t carrier, double position) const noexcept {
    return travel_at && carrier != 0 ? travel_at(owner, carrier, position) : 0;
  }
};

}  // namespace takt::group
