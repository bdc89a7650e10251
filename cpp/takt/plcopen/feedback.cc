#include "takt/plcopen/feedback.h"

namespace takt::plcopen {

Feedback::Feedback(Program& program) : program_(program) {
  program_.waiting_.reserve(++program_.feedbacks_);
}

Feedback::~Feedback() {
  Forget();
  --program_.feedbacks_;
}

void Feedback::Give(std::uint32_t target, const engine::CommandBody& body) noexcept {
  Forget();
  engine::Command command;
  command.target = target;
  command.body = body;
  last_.ticket = program_.engine_.Submit(command);
  given_ = true;
  if (last_.ticket != 0) {
    program_.Add(last_.ticket, *this);
  } else {
    last_.state = FeedbackState::kError;
    last_.error = ErrorId::kQueueFull;
  }
}

void Feedback::Release() noexcept {
  if (released_ || last_.ticket == 0) return;
  engine::Command release;
  release.body = engine::MachineCommand(engine::Release{last_.ticket});
  released_ = program_.engine_.Submit(release) != 0;
}

void Feedback::Forget() noexcept {
  program_.Remove(last_.ticket);
  last_ = {};
  given_ = reached_ = released_ = false;
}

void Feedback::Take(const FeedbackEvent& event) noexcept {
  reached_ = reached_ || event.reached;
  last_ = event;
}

}  // namespace takt::plcopen
