// How the tool goes along with an object (the manual's parameter TrackState, CV-11).
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt::group {

enum class TrackState : std::uint8_t {
  kNone = 0,             // it does not
  kWaiting = 1,          // the object is not yet where tracking begins
  kSynchronizing = 2,    // the tool gets into step
  kInSync = 3,           // it goes along
  kDesynchronizing = 4,  // it gets out of step
};

void describe(Enumeration<TrackState>&);

}  // namespace takt::group
