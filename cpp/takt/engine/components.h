// The kinds of components a machine is made of: one list, by which they are named, described, recorded and told apart
// in commands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/engine/machine.h"

namespace takt::engine {

struct ComponentKind {
  std::string_view name;     // as in Verb::target_kind; states are published on takt/NAME/...
  std::string_view section;  // of the machine file
  std::string_view one;      // for people: "an axis" ...
  std::string_view many;     // ... "axes"
  const Type* outputs;       // what each publishes every cycle
  std::size_t (*count)(const Machine& machine);
  std::string_view (*name_of)(const Machine& machine, std::size_t index);
};
// In the order of their numbers. The first call takes memory.
std::span<const ComponentKind> ComponentKinds();

// Components are numbered through: those of the first kind in the order of the machine file, then those of the next.
struct ComponentPlace {
  const ComponentKind* kind = nullptr;  // null: there is no such component
  std::size_t index = 0;                // among those of its kind
};
ComponentPlace PlaceOf(const Machine& machine, std::size_t component);
// Of each kind the number of its first component; behind them all how many there are.
std::vector<std::uint32_t> FirstNumbers(const Machine& machine);
std::optional<std::uint32_t> FindComponent(const Machine& machine, std::string_view name);
std::vector<std::string_view> ComponentNames(const Machine& machine);

}  // namespace takt::engine
