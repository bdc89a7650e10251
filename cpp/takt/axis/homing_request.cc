#include "takt/axis/homing_request.h"

#include "takt/axis/request_maker.h"

namespace takt::axis {

void describe(Description<HomingRequest>& d) {
  d.about("What a homing command carries.");
  d.internal<&HomingRequest::placeholder>("Nothing yet.");
}

}  // namespace takt::axis
