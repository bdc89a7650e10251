#include "takt/plcopen/moves.h"

#include <algorithm>
#include <cmath>

namespace takt::plcopen {

bool HasVelocity(AxisRef axis, double velocity) noexcept {
  const axis::Outputs& o = axis.outputs();
  const bool runs = o.override_factor > 0 || velocity == 0;
  if (o.superimposed) return runs;
  const double scaled = velocity * o.override_factor;
  const double now = std::abs(o.set_velocity);
  const bool clamped = o.limited_by != LimitedBy::kNothing && o.set_acceleration == 0 && now < scaled;
  return clamped || (runs && std::abs(now - scaled) <= 1e-9 * std::max(1.0, scaled));
}

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
