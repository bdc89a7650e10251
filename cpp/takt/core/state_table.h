// State machines as tables: every legal transition is in one constexpr array beside the enum of the states.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace takt {

template <typename State>
struct Transition {
  State from, to;
  const char* by;  // the commands or events that cause it
};

// Staying in a state is always legal.
template <typename State, std::size_t kCount>
constexpr bool IsLegal(const std::array<Transition<State>, kCount>& table, State from, State to) {
  const auto leads = [&](const Transition<State>& t) { return t.from == from && t.to == to; };
  return from == to || std::any_of(table.begin(), table.end(), leads);
}

}  // namespace takt
