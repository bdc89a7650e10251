// The state of a belt: plain data, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/kinematics/frames.h"
#include "takt/trajectory/tracking_filter.h"

namespace takt::conveyor {

inline constexpr std::size_t kObjects = 30;  // maximum number of objects on a belt

enum class ObjectState : std::uint8_t {
  kDetected,  // detected; its pose is not known yet
  kVisible,   // its pose is known
  kTaken,     // reserved: it cannot be taken again, and is not lost
};

// User data of an object, from its detection until it is placed. The meaning of the numbers is up to the user.
struct Attributes {
  std::uint32_t kind = 0;
  std::uint32_t colour = 0;
  double quality = 1;

  bool operator==(const Attributes&) const = default;
};

struct Object {
  std::uint32_t number = 0;  // from 1 in the order of detection, never reused; 0: none
  ObjectState state = ObjectState::kDetected;
  double latch = 0;       // [mm] or [deg] the belt's travel when it was detected
  kinematics::Pose pose;  // at that time, relative to the belt's origin
  Attributes attributes;

  bool operator==(const Object&) const = default;
};

// An object that the belt has lost.
struct LostObject {
  std::uint32_t number = 0;
  Attributes attributes;

  bool operator==(const LostObject&) const = default;
};

struct State {
  // [mm] or [deg] relative to the origin, over all turns, at the instant for which the axes get their set points.
  KinematicState travel;
  trajectory::TrackingFilterState filter;
  bool known = false;     // the axis' position is known; otherwise the belt is assumed to continue at its last velocity
  bool started = false;   // it has read its axis at least once
  std::int8_t sense = 1;  // direction of the last motion
  std::array<Object, kObjects> objects;
  std::uint32_t count = 0;  // number of objects, which are in the order of their numbers
  std::uint32_t last_number = 0;
  std::uint32_t lost = 0;                      // objects that left the range without being taken
  std::array<LostObject, kObjects> last_lost;  // the n-th lost object, from 0, is at n % kObjects
  std::uint32_t refused = 0;                   // objects for which there was no room
};

void describe(Enumeration<ObjectState>&);
void describe(Description<Attributes>&);
void describe(Description<Object>&);
void describe(Description<LostObject>&);
void describe(Description<State>&);

}  // namespace takt::conveyor
