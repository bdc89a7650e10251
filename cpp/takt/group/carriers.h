// Carriers as a group sees them: belts, tables, tools of other groups, poses from elsewhere. The engine knows what they
// are.
#pragma once

#include <cstdint>
#include <string_view>

#include "takt/kinematics/carrier.h"

namespace takt::group {

struct Carriers {
  // Returns the number of the carrier of this name, from 1; 0 if there is none.
  std::uint32_t (*find)(void* owner, std::string_view name) noexcept = nullptr;
  // Returns its state in this cycle, at the instant for which the members get their set points; in the world.
  kinematics::Carrier (*at)(void* owner, std::uint32_t carrier) noexcept = nullptr;
  // Returns its travel [mm or rad] at which its axis shows this position; with a modulus: the last time that it did.
  // Carriers without an axis: the present travel.
  double (*travel_at)(void* owner, std::uint32_t carrier, double position) noexcept = nullptr;
  void* owner = nullptr;
  bool modules = false;  // pick and place modules exist, which need the durations of their orders in advance

  std::uint32_t Find(std::string_view name) const noexcept { return find ? find(owner, name) : 0; }
  kinematics::Carrier At(std::uint32_t carrier) const noexcept {
    return at && carrier != 0 ? at(owner, carrier) : kinematics::Carrier{};
  }
  double TravelAt(std::uint32_t carrier, double position) const noexcept {
    return travel_at && carrier != 0 ? travel_at(owner, carrier, position) : 0;
  }
};

}  // namespace takt::group
