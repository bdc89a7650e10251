// Movers that move as one body (PL-73): a star, and planets that keep the place relative to it, and turned to it, that
// they had when they joined. What moves X, Y and C of the star moves all of them; a planet is where the star has it:
//
//   p' = p + r         v' = v + w Q r         a' = a + u Q r - w² r         j' = j + (g - w³) Q r - 3 w u r
//
// with r its place seen from the star, turned by C; Q a quarter turn; w, u and g the derivatives of C. So that no
// member ever exceeds its own limits V, A and J in the plane, a share s of them is there for turning, and 1 - s for X
// and Y. As lengths of vectors add up to no less than that of their sum, it is enough that
//
//   |v| <= (1-s) V     |a| <= (1-s) A     |j| <= (1-s) J     and
//   |w Q r| <= s V                    if |w| <= s V / |r|
//   |u Q r - w² r| <= s A             if w² and |u| are both <= s A / (√2 |r|)
//   |(g - w³) Q r - 3 w u r| <= s J   if |w|³ and |g| are both <= G = √(3/20) s J / |r|: what began and ends without
//                                     acceleration, w within ±∛G, has u² <= 2 G (∛G - |w|), so w² u² <= 8/27 G²,
//                                     most at |w| = ⅔ ∛G, and (G + G)² + 9 * 8/27 G² = 20/3 G²
//
// for each of them; the star itself has no r. While X and Y alone move s is 0, while C alone does it is 1. Where both
// begin at once it is what brings them there first, and stays so until one of both is over. So what began alone, with
// all there is, has to be over before the other begins: until then that is refused. What both began together goes on
// within its share, whatever becomes of it: a halt, a fault, a planet that is lost.
//
// The star's parameters are those of the body: all that plans for it keeps the limits by that. A planet that cannot go
// on any more brings the whole body to rest first, and drops out there.
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
// Number of the star, from 1, of the formation that the mover is in; 0: none.
inline std::uint32_t BodyOf(const Context& c, const State& s) noexcept {
  if (IsPlanet(s)) return s.formation.star + 1;
  return IsStar(c) ? c.index + 1 : 0;
}
// As an own one of the star of a planet.
Context StarOf(const Context& c, const State& s) noexcept;
inline const State& StateOfStar(const Context& c, const State& s) noexcept {
  return c.fleet.states[s.formation.star];
}
planar::Arm ArmOf(const MoverParams& params, const FormationState& formation) noexcept;

// Calls this for each planet of a star, with its number.
template <typename What>
void EachPlanet(const Context& c, What what) noexcept {
  if (!IsStar(c)) return;
  for (const std::uint32_t i : c.fleet.bodies[c.index].planets) what(i);
}

// What the mover with this number can do now: a star only what its formation can.
const MoverParams& ParamsIn(const Fleet& fleet, const Cycle& cycle, std::uint32_t index) noexcept;
inline Context With(const Context& c, const MoverParams& params) noexcept {
  return {params, c.cycle, c.planner, c.feedback, c.streets, c.grounds, c.index, c.fleet};
}

// On what terms a star begins a command, or why it does not.
struct Terms {
  const MoverParams& params;  // of the formation
  bool sets = false;          // it is about X, Y or C ...
  bool whole = false;         // ... and only one of both
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};
};
Terms TermsOf(const Context& c, const Command& command, State& s) noexcept;

// Where X, Y and C move at once, turning has this share of the dynamics from now on.
void ShareOut(const Context& c, double turning, State& s) noexcept;

// Where a planet is when its star is there.
void Compose(const SetPoint& star, const FormationState& formation, SetPoint& at) noexcept;

// Of a star, before it moves on: with a planet that cannot go on it comes to rest.
void MindPlanets(const Context& c, State& s) noexcept;
// Of a planet, once it is where its star has it: says so; drops out at rest if one of both cannot go on.
void MindStar(const Context& c, State& s) noexcept;

}  // namespace takt::mover
