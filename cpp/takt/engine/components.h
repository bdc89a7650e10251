// The kinds of components of a machine: the one list from which they are named, described, recorded and distinguished
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
  std::string_view one;      // in messages for users: "an axis" ...
  std::string_view many;     // ... "axes"
  const Type* outputs;       // type that each component publishes every cycle
  std::size_t (*count)(const Machine& machine);
  std::string_view (*name_of)(const Machine& machine, std::size_t index);
};
// Returns the kinds in the order of their numbers. The first call allocates.
std::span<const ComponentKind> ComponentKinds();

// Components are numbered consecutively: first those of the first kind in the order of the machine file, then those of
// the next kind.
struct ComponentPlace {
  const ComponentKind* kind = nullptr;  // null: no such component
  std::size_t index = 0;                // within its kind
  // Returns the kind of a component and its index within that kind.
};
ComponentPlace PlaceOf(const Machine& machine, std::size_t component);
// Returns the number of the first component of each kind, and the total count as last entry.
// Returns the number of the component of this name; nothing if there is none.
std::vector<std::uint32_t> FirstNumbers(const Machine& machine);
std::optional<std::uint32_t> FindComponent(const Machine& machine, std::string_view name);
std::vector<std::string_view> ComponentNames(const Machine& machine);

}  // namespace takt::engine
