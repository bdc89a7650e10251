// Movers that move as one rigid body (PL-73): a star, and planets that keep the pose relative to it that they had when
// they joined. Whatever moves X, Y and C of the star moves all of them; the set point of a planet follows from that of
// the star:
//
//   p' = p + r         v' = v + w Q r         a' = a + u Q r - w² r         j' = j + (g - w³) Q r - 3 w u r
//
// with r its position relative to the star, turned by C; Q a quarter turn; w, u and g the derivatives of C. No member
// may ever exceed its own limits V, A and J in the plane, so a share s of them is for turning, and 1 - s for X and Y.
// The length of a sum of vectors is at most the sum of their lengths, so it is enough that
//
//   |v| <= (1-s) V     |a| <= (1-s) A     |j| <= (1-s) J     and
//   |w Q r| <= s V                    if |w| <= s V / |r|
//   |u Q r - w² r| <= s A             if w² and |u| are both <= s A / (√2 |r|)
//   |(g - w³) Q r - 3 w u r| <= s J   if |w|³ and |g| are both <= G = √(3/20) s J / |r|: a profile that begins and
//                                     ends without acceleration, w within ±∛G, has u² <= 2 G (∛G - |w|), so
//                                     w² u² <= 8/27 G², most at |w| = ⅔ ∛G, and (G + G)² + 9 * 8/27 G² = 20/3 G²
//
// for each member; the star itself has no r. While X and Y move alone s is 0, while C moves alone it is 1. If both
// begin at once, s is the value with the shortest duration, and it is kept until one of them is over. A motion that
// began alone, with all of the dynamics, has to be over before the other begins: until then the other is refused.
// Motions that began together stay within their shares, even after a halt, a fault or the loss of a planet.
//
// The parameters of the star are those of the body, so every motion planned with them keeps the limits of all members.
// A planet that cannot continue first brings the whole body to rest, and drops out there.
#pragma once

#include "takt/mover/mover.h"
#include "takt/planar/arm.h"

namespace takt::mover {

inline bool IsPlanet(const State& s) noexcept {
  return s.formation.star != kNoStar;
}
inline bool IsStar(const Context& c) noexcept {
  return c.index < c.fleet.bodies.size() && !c.fleet.bodies[c.index].planets.empty();
}
// Returns the number, from 1, of the star of the mover's formation; 0: none.
inline std::uint32_t BodyOf(const Context& c, const State& s) noexcept {
  if (IsPlanet(s)) return s.formation.star + 1;
  return IsStar(c) ? c.index + 1 : 0;
}
// Returns the context of the star of a planet.
Context StarOf(const Context& c, const State& s) noexcept;
inline const State& StateOfStar(const Context& c, const State& s) noexcept {
  return c.fleet.states[s.formation.star];
}
planar::Arm ArmOf(const MoverParams& params, const FormationState& formation) noexcept;

// Calls `what` with the index of each planet of a star.
template <typename What>
void EachPlanet(const Context& c, What what) noexcept {
  if (!IsStar(c)) return;
  for (const std::uint32_t i : c.fleet.bodies[c.index].planets) what(i);
}

// Returns the parameters of the mover with this index; for a star, those of its formation.
const MoverParams& ParamsIn(const Fleet& fleet, const Cycle& cycle, std::uint32_t index) noexcept;
inline Context With(const Context& c, const MoverParams& params) noexcept {
  return {params, c.cycle, c.planner, c.feedback, c.streets, c.grounds, c.index, c.fleet};
}

// The terms on which a star begins a command, or why it does not.
struct Terms {
  const MoverParams& params;  // of the formation
  bool sets = false;          // the command moves X, Y or C ...
  bool whole = false;         // ... and not X, Y and C at once
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};
};
Terms TermsOf(const Context& c, const Command& command, State& s) noexcept;

// Sets the share of the dynamics that turning has from now on while X, Y and C move at once.
void ShareOut(const Context& c, double turning, State& s) noexcept;

// Computes X, Y and C of a planet from the set point of its star.
void Compose(const SetPoint& star, const FormationState& formation, SetPoint& at) noexcept;

// For a star, before it moves: brings it to rest if a planet cannot continue.
void CheckPlanets(const Context& c, State& s) noexcept;
// For a planet, after its star has moved: reports that it has joined; drops out at rest if one of the two cannot
// continue.
void CheckStar(const Context& c, State& s) noexcept;

}  // namespace takt::mover
