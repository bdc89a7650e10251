#include "takt/axis/coupling_request.h"

#include "takt/axis/request_maker.h"

namespace takt::axis {

void describe(Description<CouplingRequest>& d) {
  d.about("What a coupling command carries.");
  d.internal<&CouplingRequest::placeholder>("Nothing yet.");
}

}  // namespace takt::axis
