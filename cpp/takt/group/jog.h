// Jogs (GR-48): the tool or axes move at given velocities as long as a key is held.
//
// A jog is one straight move to the border of what can be reached, found when it begins: all along it the members are
// within their SW limits and the tool within reach. So the planner brakes for the border as for the end of any move,
// and checks jogs as it checks moves (limit switches, workspace, zones); an obstacle makes a jog shorter instead of
// refusing it. The speed is that of the keys, limited by that of the plan.
#pragma once

#include <algorithm>

#include "takt/group/group.h"
#include "takt/group/queue.h"

namespace takt::group {

inline bool IsJog(const Request& move) noexcept {
  return move.kind == MoveKind::kJog;
}
// Returns true if no key is held.
bool IsReleased(const Request& jog) noexcept;
// Returns true if a jog is in control, or will be once the motion before it is at rest. It is the only move then.
inline bool Jogs(const State& s) noexcept {
  return s.queue.count > 0 && IsJog(MoveAt(s, s.done));
}
inline bool IsJogOf(Ticket ticket, const State& s) noexcept {
  return ticket != 0 && Jogs(s) && MoveAt(s, s.done).ticket == ticket;
}

// Begins a jog. Requires: everything else has been aborted.
void BeginJog(const Context& c, Ticket ticket, const Request& jog, State& s) noexcept;
// Changes the speed of the jog in control. Returns false, with nothing changed, if the direction is another one.
bool ChangeJog(const Context& c, Ticket ticket, const Request& jog, State& s) noexcept;
// The keys are released: comes to rest, then reports `ticket` as done; 0: no report.
void EndJog(const Context& c, Ticket ticket, State& s) noexcept;

// Makes the path of a jog as the next stretch.
ErrorId MakeJog(const Context& c, const Request& jog, LookAhead& ahead, State& s) noexcept;
// Ends the jog that is planned after `most` of its path, before an obstacle. Returns false if it is no jog, or if
// hardly any path is left.
bool ShortenJog(double most, ErrorId border, State& s) noexcept;
// Returns the path speed that the keys ask for, in mm/s or the unit of the length per s.
double JogSpeed(const State& s) noexcept;
// At the end of its path. Returns true if that is the border: it has ended with an error; false if it continues from
// here.
bool AtBorder(const Context& c, State& s) noexcept;

// Returns the largest value up to `most` that `may` allows, as far as doubling steps from `first` on and bisection find
// it; `spare` less if it is below `most`.
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
