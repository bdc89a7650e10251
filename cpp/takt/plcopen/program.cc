#include "takt/plcopen/program.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "takt/engine/components.h"
#include "takt/plcopen/feedback.h"

namespace takt::plcopen {

const axis::Outputs& AxisRef::outputs() const noexcept {
  return program().engine().outputs(target() - 1);
}

const group::Outputs& GroupRef::outputs() const noexcept {
  return program().engine().group_outputs(index_);
}

const group::GroupParams& GroupRef::params() const noexcept {
  return program().engine().machine().groups[index_];
}

AxisRef Program::Axis(std::string_view name) {
  const auto& axes = engine_.machine().axes;
  const auto found = std::ranges::find(axes, name, &axis::AxisParams::name);
  if (found == axes.end()) throw std::invalid_argument("the machine has no axis '" + std::string(name) + "'");
  return {*this, static_cast<std::uint32_t>(found - axes.begin()) + 1};
}

GroupRef Program::Group(std::string_view name) {
  const engine::Machine& machine = engine_.machine();
  const auto found = std::ranges::find(machine.groups, name, &group::GroupParams::name);
  if (found == machine.groups.end())
    throw std::invalid_argument("the machine has no group '" + std::string(name) + "'");
  const auto index = static_cast<std::uint32_t>(found - machine.groups.begin());
  return {*this, *engine::FindComponent(machine, name) + 1, index};
}

bool Program::AllDisabled() const noexcept {
  for (std::size_t i = 0; i < engine_.machine().axes.size(); ++i) {
    if (engine_.outputs(i).state != axis::PlcState::kDisabled) return false;
  }
  return true;
}

void Program::Update() noexcept {
  for (FeedbackEvent event; engine_.feedback().TryPop(event);) {
    const auto waiting = Find(event.ticket);
    if (waiting != waiting_.end()) waiting->feedback->Take(event);
  }
}

std::vector<Program::Waiting>::iterator Program::Find(Ticket ticket) noexcept {
  const auto found = std::ranges::lower_bound(waiting_, ticket, {}, &Waiting::ticket);
  return found != waiting_.end() && found->ticket == ticket ? found : waiting_.end();
}

// Tickets only grow, so the newest one is appended; there is room for one per feedback.
void Program::Add(Ticket ticket, Feedback& feedback) noexcept {
  waiting_.push_back({ticket, &feedback});
}

void Program::Remove(Ticket ticket) noexcept {
  if (const auto found = Find(ticket); found != waiting_.end()) waiting_.erase(found);
}

}  // namespace takt::plcopen
