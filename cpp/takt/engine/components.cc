#include "takt/engine/components.h"

#include <array>

#include "takt/axis/outputs.h"
#include "takt/conveyor/outputs.h"
#include "takt/conveyor/pose.h"
#include "takt/core/describe.h"
#include "takt/environment/outputs.h"
#include "takt/flexcam/outputs.h"
#include "takt/group/outputs.h"
#include "takt/mover/outputs.h"
#include "takt/part/outputs.h"
#include "takt/pickplace/outputs.h"
#include "takt/planargroup/outputs.h"
#include "takt/track/outputs.h"

namespace takt::engine {

namespace {

template <typename Outputs, auto List>
ComponentKind Make(std::string_view name, std::string_view section, std::string_view one, std::string_view many) {
  return {name,
          section,
          one,
          many,
          &TypeOf<Outputs>(),
          [](const Machine& machine) { return (machine.*List).size(); },
          [](const Machine& machine, std::size_t index) -> std::string_view { return (machine.*List)[index].name; }};
}

}  // namespace

std::span<const ComponentKind> ComponentKinds() {
  static const std::array kinds = {
      Make<axis::Outputs, &Machine::axes>("axis", "axes", "an axis", "axes"),
      Make<flexcam::Outputs, &Machine::flex_cams>("flex_cam", "flex_cams", "a cam module", "cam modules"),
      Make<group::Outputs, &Machine::groups>("group", "groups", "a group of axes", "groups of axes"),
      Make<conveyor::Outputs, &Machine::belts>("belt", "belts", "a belt", "belts"),
      Make<conveyor::PoseOutputs, &Machine::poses>("pose", "poses", "a pose", "poses"),
      Make<pickplace::Outputs, &Machine::pick_and_place>("pick_place", "pick_and_place", "a pick and place module",
                                                         "pick and place modules"),
      Make<mover::Outputs, &Machine::movers>("mover", "movers", "a mover", "movers"),
      Make<track::Outputs, &Machine::tracks>("track", "tracks", "a track", "tracks"),
      Make<planargroup::Outputs, &Machine::planar_groups>("planar_group", "planar_groups", "a group of movers",
                                                          "groups of movers"),
      Make<environment::Outputs, &Machine::environments>("environment", "environments", "an environment",
                                                         "environments"),
      Make<part::Outputs, &Machine::parts>("part", "parts", "a part", "parts"),
  };
  return kinds;
}

ComponentPlace PlaceOf(const Machine& machine, std::size_t component) {
  for (const ComponentKind& kind : ComponentKinds()) {
    const std::size_t count = kind.count(machine);
    if (component < count) return {&kind, component};
    component -= count;
  }
  return {};
}

std::vector<std::uint32_t> FirstNumbers(const Machine& machine) {
  std::vector<std::uint32_t> numbers{0};
  for (const ComponentKind& kind : ComponentKinds()) {
    numbers.push_back(numbers.back() + static_cast<std::uint32_t>(kind.count(machine)));
  }
  return numbers;
}

std::optional<std::uint32_t> FindComponent(const Machine& machine, std::string_view name) {
  std::uint32_t before = 0;
  for (const ComponentKind& kind : ComponentKinds()) {
    const auto count = static_cast<std::uint32_t>(kind.count(machine));
    for (std::uint32_t i = 0; i < count; ++i) {
      if (kind.name_of(machine, i) == name) return before + i;
    }
    before += count;
  }
  return std::nullopt;
}

std::vector<std::string_view> ComponentNames(const Machine& machine) {
  std::vector<std::string_view> names;
  for (const ComponentKind& kind : ComponentKinds()) {
    for (std::size_t i = 0; i < kind.count(machine); ++i) names.push_back(kind.name_of(machine, i));
  }
  return names;
}

}  // namespace takt::engine
