// All memory of a belt: plain, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/kinematics/frames.h"
#include "takt/trajectory/tracking_filter.h"

namespace takt::conveyor {

inline constexpr std::size_t kObjects = 30;  // a belt holds at most

enum class ObjectState : std::uint8_t {
  kDetected,  // it was latched; where it lies is not known yet
  kVisible,   // it is known where it lies
  kTaken,     // and somebody is to fetch it: nobody else may, and it is not lost
};

// What people know of an object, from its detection to where it is put. The numbers are theirs.
struct Attributes {
  std::uint32_t kind = 0;
  std::uint32_t colour = 0;
  double quality = 1;

  bool operator==(const Attributes&) const = default;
};

struct Object {
  std::uint32_t number = 0;  // from 1 in the order of their detection, never used again; 0: none
  ObjectState state = ObjectState::kDetected;
  double latch = 0;       // mm or deg: the belt's travel when it was detected
  kinematics::Pose pose;  // as it lay then, seen from the belt's origin
  Attributes attributes;

  bool operator==(const Object&) const = default;
};

// What the belt has lost.
struct LostObject {
  std::uint32_t number = 0;
  Attributes attributes;

  bool operator==(const LostObject&) const = default;
};

struct State {
  // mm or deg from the origin's own place, over all turns: at the instant for which the axes get their set points.
  KinematicState travel;
  trajectory::TrackingFilterState filter;
  bool known = false;     // the axis says where it is; else the belt is taken to go on as it went
  bool started = false;   // it has seen its axis
  std::int8_t sense = 1;  // in which it moved last
  std::array<Object, kObjects> objects;
  std::uint32_t count = 0;  // so many of them, in the order of their numbers
  std::uint32_t last_number = 0;
  std::uint32_t lost = 0;                      // left the range without being taken
  std::array<LostObject, kObjects> last_lost;  // the n-th, from 0, is at n % kObjects
  std::uint32_t refused = 0;                   // did not find room
};

void describe(Enumeration<ObjectState>&);
void describe(Description<Attributes>&);
void describe(Description<Object>&);
void describe(Description<LostObject>&);
void describe(Description<State>&);

}  // namespace takt::conveyor
