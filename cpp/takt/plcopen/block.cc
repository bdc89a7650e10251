#include "takt/plcopen/block.h"

namespace takt::plcopen {

bool ExecuteBlock::Rises() noexcept {
  const bool rises = Execute && !edge_;
  edge_ = Execute;
  return rises;
}

void ExecuteBlock::Start(std::uint32_t target, const engine::CommandBody& body, bool may_wait) noexcept {
  feedback_.Give(target, body);
  may_wait_ = may_wait;
  end_ = {};
  end_seen_ = reached_seen_ = false;
}

void ExecuteBlock::Show(End end) noexcept {
  busy_ = active_ = reached_ = false;
  end_shown_ = FeedbackState::kBusy;
  if (!feedback_.given()) return;
  if (!IsFinal(end_.state)) end_ = end;
  if (!IsFinal(end_.state)) {
    busy_ = true;
    active_ = feedback_.active() || !may_wait_;
    reached_ = feedback_.reached() && IsDue(reached_seen_);
  } else if (IsDue(end_seen_)) {
    end_shown_ = end_.state;
    end_error_ = end_.error;
  }
}

ExecuteBlock::End ExecuteBlock::EndOf(const Feedback& feedback) noexcept {
  return feedback.busy() ? End{} : End{feedback.state(), feedback.error()};
}

bool ExecuteBlock::IsDue(bool& seen) const noexcept {
  const bool due = edge_ || !seen;
  seen = true;
  return due;
}

}  // namespace takt::plcopen
