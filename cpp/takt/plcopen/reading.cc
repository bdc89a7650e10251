#include "takt/plcopen/reading.h"

namespace takt::plcopen {

void MC_ReadParameter::operator()() noexcept {
  if (!Enable) {
    feedback_.Forget();
    answer_ = FeedbackState::kBusy;
    error_ = ErrorId::kNone;
    return;
  }
  if (feedback_.busy()) return;
  if (feedback_.given()) {
    answer_ = feedback_.state();
    error_ = feedback_.error();
    value_ = feedback_.value();
  }
  feedback_.Give(axis_.target(), axis::Command(axis::ReadParameter{ParameterNumber}));
}

}  // namespace takt::plcopen
