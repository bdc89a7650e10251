// Synchronization of the tool with an object on a carrier that moves (CV-11). The order
// counts: from kSynchronizing on the tool follows the carrier.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt::group {

enum class TrackState : std::uint8_t {
  kNone = 0,             // not synchronized with an object
  kWaiting = 1,          // the object has not reached the start of tracking
  kSynchronizing = 2,    // the tool is getting into sync
  kInSync = 3,           // in sync with the object
  kDesynchronizing = 4,  // the tool is getting out of sync
};

void describe(Enumeration<TrackState>&);

}  // namespace takt::group
