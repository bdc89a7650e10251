#include "takt/mover/state.h"

#include "takt/core/describe.h"

namespace takt::mover {

State MakeState(const MoverParams& params) {
  State s;
  const Place& p = params.initial;
  const std::array at = {p.x, p.y, p.z, p.a, p.b, p.c};
  for (std::size_t i = 0; i < kCoordinates; ++i) s.set_point[i].position = at[i];
  s.plane.motion = StandingAt(p.x, p.y);
  for (std::size_t i = 0; i < kOthers.size(); ++i) s.others[i].profile = {s.set_point[kOthers[i]]};
  for (CoordinateMove& other : s.others) other.profile.end_state = other.profile.start_state;
  return s;
}

void describe(Description<Record>& d) {
  using R = Record;
  d.named("MoverRecord");
  d.about("A command of a mover and what became of it.");
  d.internal<&R::ticket>("Of the command; 0: none.");
  d.internal<&R::cycle>("That took the command.");
  d.internal<&R::begun>("Cycle in which it began.");
  d.internal<&R::changed>("Cycle in which it came to be what it is.");
  d.internal<&R::command>("Its place among the mover's commands.");
  d.internal<&R::state>("What it is.");
  d.internal<&R::error>("Why it failed.");
  d.internal<&R::object>("What was in the way.");
  d.internal<&R::limited_by>("What of its dynamics was reduced.");
}

void describe(Description<History>& d) {
  d.named("MoverHistory");
  d.about("The last commands of a mover.");
  d.internal<&History::records>("A ring of them.");
  d.internal<&History::count>("Of all commands so far.");
}

void describe(Description<Goal>& d) {
  d.named("MoverGoal");
  d.about("Where a command leads X or Y by itself.");
  d.internal<&Goal::active>("A command leads to it; else the coordinate comes to rest, or stands.");
  d.internal<&Goal::target>(unit::mm, "The position.");
  d.internal<&Goal::limits>("Of the command.");
}

void describe(Description<PlaneMove>& d) {
  using P = PlaneMove;
  d.about("A motion of X and Y in progress.");
  d.internal<&P::motion>("Where it leads.");
  d.internal<&P::begin>("Cycle in which it began.");
  d.internal<&P::waits>("It only comes to rest, and then goes to next.");
  d.internal<&P::next>("What follows.");
  d.internal<&P::each>("X and Y move each by itself.");
  d.internal<&P::goals>("Where they go then.");
  d.internal<&P::turns>("C belongs to it.");
  d.internal<&P::limits>("Of the command.");
  d.internal<&P::tried>("Whether it can go round a corner has been looked at.");
  d.internal<&P::passes>("What is buffered takes over where it ends.");
  d.internal<&P::share>("Of the limits then, across the second line.");
  d.internal<&P::corner_x>(unit::mm, "The corner it goes round then.");
  d.internal<&P::corner_y>(unit::mm, "Of it.");
  d.internal<&P::hard>("It comes to rest with the greatest dynamics.");
  d.internal<&P::goes>("A command leads it to a target.");
  d.internal<&P::held_by>("The mover in its way.");
  d.internal<&P::held_since>("Cycle since when.");
}

void describe(Description<StopMotion>& d) {
  d.named("MoverEscape");
  d.about("How X and Y come to rest if the mover may not go on.");
  d.internal<&StopMotion::motion>("The way.");
  d.internal<&StopMotion::begin>("Cycle in which it began.");
  d.internal<&StopMotion::cycle>("Cycle from which on it is good.");
}

void describe(Description<CoordinateMove>& d) {
  d.about("A motion of a coordinate in progress.");
  d.internal<&CoordinateMove::profile>("Where it leads.");
  d.internal<&CoordinateMove::begin>("Cycle in which it began.");
}

void describe(Description<VelocityMove>& d) {
  using E = VelocityMove;
  d.named("MoverEndless");
  d.about("A move by velocity.");
  d.internal<&E::on>("There is one.");
  d.internal<&E::reached>("Its velocity, as said.");
  d.internal<&E::velocity>(unit::mm_s, "Its velocity; of C: deg/s.");
  d.internal<&E::end>("Why it ends where it does.");
  d.internal<&E::object>("What is in its way there.");
}

void describe(Description<External>& d) {
  using E = External;
  d.named("MoverExternal");
  d.about("Set points from outside.");
  d.internal<&E::mode>("What they do.");
  d.internal<&E::given>("The last one, or what it went on to.");
  d.internal<&E::fresh>("One has come in this cycle.");
  d.internal<&E::taken>("The last one that the mover followed.");
  d.internal<&E::missing>("So many in a row.");
}

void describe(Description<GearState>& d) {
  d.named("MoverGear");
  d.about("What a mover goes along with.");
  d.internal<&GearState::axis>("Number of the axis.");
  d.internal<&GearState::in_sync>("As last said.");
}

void describe(Description<FormationState>& d) {
  using F = FormationState;
  d.named("MoverFormation");
  d.about("Its place in a formation.");
  d.internal<&F::star>("Number of the mover that it goes along with.");
  d.internal<&F::x>(unit::mm, "Where it is, seen from the star.");
  d.internal<&F::y>(unit::mm, "Of it.");
  d.internal<&F::c>(unit::deg, "How it is turned, seen from the star.");
  d.internal<&F::joined>("As last said.");
  d.internal<&F::whole>("Of a star: what it does may have all of its dynamics.");
  d.internal<&F::share>(unit::one, "Else: what turning has of them.");
  d.internal<&F::brakes>("Of a star: for a planet that cannot go on.");
}

void describe(Description<State>& d) {
  using S = State;
  d.named("MoverState");
  d.about("A planar mover.");
  d.internal<&S::state>("What it can do.");
  d.internal<&S::since>("Cycle in which it came to be so.");
  d.internal<&S::mode>("What it does.");
  d.internal<&S::aborts>("The fault is to lead to Disabled.");
  d.internal<&S::error>("Of the fault.");
  d.internal<&S::limited_by>("What of the last command was reduced.");
  d.internal<&S::tickets>("Of the commands in progress.");
  d.internal<&S::begun>("Cycles in which those began.");
  d.internal<&S::buffer>("Commands that wait for their turn.");
  d.internal<&S::escape>("How it comes to rest if it may not go on.");
  d.internal<&S::plane>("Motion of X and Y.");
  d.internal<&S::track>("Track that it joins, is on, or leaves.");
  d.internal<&S::gear>("What it goes along with.");
  d.internal<&S::formation>("Its place in a formation.");
  d.internal<&S::system>("Coordinate system where it is.");
  d.internal<&S::part>("Part that its middle is on.");
  d.internal<&S::others>("Motions of Z, A, B, C.");
  d.internal<&S::endless>("Moves of X, Y and C by velocity.");
  d.internal<&S::external>("Set points from outside.");
  d.internal<&S::set_point>("Where it is at the end of the last cycle.");
  d.internal<&S::carried>("By parts: its place was put so much further on, without any motion.");
  d.internal<&S::history>("Its last commands.");
}

}  // namespace takt::mover
