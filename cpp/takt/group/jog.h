// Jogs (GR-48): the tool or axes move at given speeds as long as a key is held.
//
// A jog is one straight move to the border of what can be reached, found when it begins: the members are within their
// SW limits and the tool within reach all along it. So the planner brakes for the border as for the end of any move,
// and what it checks for moves (limit switches, workspace, zones) it checks for jogs; what is met there makes the move
// shorter instead of refusing it. The speed is that of the keys, held beneath that of the plan.
#pragma once

#include <algorithm>

#include "takt/group/group.h"
#include "takt/group/queue.h"

namespace takt::group {

inline bool IsJog(const Request& move) noexcept {
  return move.kind == MoveKind::kJog;
}
// No key is held.
bool IsReleased(const Request& jog) noexcept;
// A jog is in control, or will be when what went before has come to rest. It is the only move then.
inline bool Jogs(const State& s) noexcept {
  return s.queue.count > 0 && IsJog(MoveAt(s, s.done));
}
inline bool IsJogOf(Ticket ticket, const State& s) noexcept {
  return ticket != 0 && Jogs(s) && MoveAt(s, s.done).ticket == ticket;
}

// Everything else has given way.
void BeginJog(const Context& c, Ticket ticket, const Request& jog, State& s) noexcept;
// The jog in control goes on with another speed. False: it does not go in this direction.
bool ChangeJog(const Context& c, Ticket ticket, const Request& jog, State& s) noexcept;
// The keys are let go of: comes to rest. `ticket` is done then; 0: nothing is told.
void EndJog(const Context& c, Ticket ticket, State& s) noexcept;

// Its way, as the next stretch.
ErrorId MakeJog(const Context& c, const Request& jog, LookAhead& ahead, State& s) noexcept;
// The jog that is planned is to end after so much of its way, before what is in the way. False: it is no jog, or that
// is nothing.
bool ShortenJog(double most, ErrorId border, State& s) noexcept;
// mm/s, or what its way counts: the speed that the keys ask for.
double JogSpeed(const State& s) noexcept;
// At the end of its way. True: at the border, it has ended with an error. False: it goes on from here.
bool AtBorder(const Context& c, State& s) noexcept;

// The furthest that `may` allows of a way up to `most`, as far as doubling steps from `first` on and halves tell; where
// something ends it, `spare` before that.
template <typename May>
double Furthest(double most, double first, double spare, const May& may) {
  constexpr int kHalvings = 24;
  double good = 0;
  double step = std::min(first, most);
  while (good < most && may(step)) {
    good = step;
    step = std::min(2 * step, most);
  }
  double bad = step;
  for (int i = 0; i < kHalvings && good < most; ++i) {
    const double middle = (good + bad) / 2;
    (may(middle) ? good : bad) = middle;
  }
  return good < most ? std::max(0.0, good - spare) : most;
}

}  // namespace takt::group
