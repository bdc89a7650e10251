// Identifies another component of the machine in feedback: the one that is in the way.
#pragma once

#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt {

// The numbers must not change: they are part of messages.
enum class ObjectKind : std::uint8_t {
  kNone = 0,
  kMover = 1,
  kTrack = 2,
  kGroup = 3,  // of movers
  kEnvironment = 4,
  kPart = 5,
  kCoordinateSystem = 6,
  kAxis = 7,
};

struct ObjectInfo {
  ObjectKind kind = ObjectKind::kNone;
  std::uint32_t number = 0;  // from 1, in the order of the machine file; 0: none

  bool operator==(const ObjectInfo&) const = default;
  explicit operator bool() const { return kind != ObjectKind::kNone; }
};

// Returns the object with this index, from 0, in the list of its kind.
inline ObjectInfo ObjectAt(ObjectKind kind, std::size_t index) noexcept {
  return {kind, static_cast<std::uint32_t>(index + 1)};
}

void describe(Enumeration<ObjectKind>&);
void describe(Description<ObjectInfo>&);

}  // namespace takt
