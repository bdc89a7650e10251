#include "takt/plcopen/moves.h"

namespace takt::plcopen {

void MC_Stop::operator()() noexcept {
  hold = true;
  Block::operator()();
  if (!Execute) feedback().Release();
}

void GT_Jog::operator()() noexcept {
  const bool up = Enable && JogPos;
  const bool down = Enable && JogNeg;
  const bool changed = up != forward || down != backward;
  const bool unsettled = (current().busy() && !current().answered()) || (before().busy() && !before().released());
  const bool waits = changed && (up || down) && unsettled;
  if (changed && !waits) {
    forward = up;
    backward = down;
    Press();
  }
  if (!waits) up_ = !JogPos && !JogNeg;

  const bool failed = current().failed();
  if (failed || (!up && !down)) {
    for (Feedback& jog : feedbacks_) {
      if (jog.busy()) jog.Release();
    }
  }
  error_ = failed && (up || down || !seen_) ? current().error() : ErrorId::kNone;
  seen_ = seen_ || failed;
}

void GT_Jog::Press() noexcept {
  const bool jogs = current().busy() && !current().released();
  if ((!forward && !backward) || !(jogs || up_)) return;
  current_ = 1 - current_;
  current().Give(axis_.target(), axis::Command(static_cast<const axis::Jog&>(*this)));
  seen_ = false;
}

void GT_Touch::operator()() noexcept {
  if (Rises()) {
    slows_ = mode == axis::TouchMode::kSlow;
    StartWith(*this);
  }
  Show();
  if (slows_ && !Execute && feedback().busy()) feedback().Release();
}

void MC_CamIn::operator()() noexcept {
  if (Execute && !level_) ends_.reset();
  level_ = Execute;
  CouplingBlock::operator()();
  const std::uint32_t ends = axis().outputs().profile_ends;
  end_of_profile_ = ends_ && *ends_ != ends;
  if (feedback().active() || (ends_ && feedback().busy())) {
    ends_ = ends;
  } else {
    ends_.reset();
  }
}

}  // namespace takt::plcopen
