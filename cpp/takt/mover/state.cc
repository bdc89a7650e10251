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
  d.about("A command of a mover and its result.");
  d.internal<&R::ticket>("Ticket of the command; 0: none.");
  d.internal<&R::cycle>("Cycle in which the command was received.");
  d.internal<&R::begun>("Cycle in which it began.");
  d.internal<&R::changed>("Cycle of the last change of its state.");
  d.internal<&R::command>("Index of the kind of command.");
  d.internal<&R::state>("State of the command.");
  d.internal<&R::error>("Error of the command.");
  d.internal<&R::object>("Obstacle of the command, if any.");
  d.internal<&R::limited_by>("First value of its dynamics that was reduced.");
}

void describe(Description<History>& d) {
  d.named("MoverHistory");
  d.about("Last commands of a mover.");
  d.internal<&History::records>("Ring buffer of records.");
  d.internal<&History::count>("Number of all commands so far.");
}

void describe(Description<Goal>& d) {
  d.named("MoverGoal");
  d.about("Goal of X or Y by itself.");
  d.internal<&Goal::active>("True: a command moves to the target; false: the coordinate stops, or is at rest.");
  d.internal<&Goal::target>(unit::mm, "Target position.");
  d.internal<&Goal::limits>("Limits of the command.");
}

void describe(Description<PlaneMove>& d) {
  using P = PlaneMove;
  d.about("A motion of X and Y in progress.");
  d.internal<&P::motion>("Planned motion.");
  d.internal<&P::begin>("Cycle in which it began.");
  d.internal<&P::waits>("True: the motion is a stop, after which the next move begins.");
  d.internal<&P::next>("Move after the stop.");
  d.internal<&P::each>("True: X and Y move each by itself.");
  d.internal<&P::goals>("Goals of X and Y by themselves.");
  d.internal<&P::turns>("True: C belongs to the move.");
  d.internal<&P::limits>("Limits of the command.");
  d.internal<&P::tried>("True: a blend of the corner at its end has been tried.");
  d.internal<&P::passes>("True: the corner at its end is blended, and the next buffered command takes over.");
  d.internal<&P::share>("Share of the limits across the second line of the blend.");
  d.internal<&P::corner_x>(unit::mm, "X of the blended corner.");
  d.internal<&P::corner_y>(unit::mm, "Y of the blended corner.");
  d.internal<&P::hard>("True: it stops with the maximum dynamics.");
  d.internal<&P::goes>("True: a command moves it to a target.");
  d.internal<&P::held_by>("Mover in its way, for which it stops.");
  d.internal<&P::held_since>("Cycle since which that mover is in its way.");
}

void describe(Description<StopMotion>& d) {
  d.named("MoverEscape");
  d.about("Stop of X and Y if the mover may not move on.");
  d.internal<&StopMotion::motion>("Planned stop.");
  d.internal<&StopMotion::begin>("Cycle in which it began.");
  d.internal<&StopMotion::cycle>("Cycle from which on it applies.");
}

void describe(Description<CoordinateMove>& d) {
  d.about("A motion of a coordinate in progress.");
  d.internal<&CoordinateMove::profile>("Planned motion.");
  d.internal<&CoordinateMove::begin>("Cycle in which it began.");
}

void describe(Description<VelocityMove>& d) {
  using E = VelocityMove;
  d.named("MoverEndless");
  d.about("A move by velocity.");
  d.internal<&E::on>("True: a move by velocity is in progress.");
  d.internal<&E::reached>("True: the velocity has been reached and reported.");
  d.internal<&E::velocity>(unit::mm_s, "Commanded velocity; of C: deg/s.");
  d.internal<&E::end>("Error with which the move ends at the end of its room.");
  d.internal<&E::object>("Obstacle at the end of its room, if any.");
}

void describe(Description<External>& d) {
  using E = External;
  d.named("MoverExternal");
  d.about("External set points.");
  d.internal<&E::mode>("Effect of external set points.");
  d.internal<&E::given>("Last set point received, extrapolated over missing cycles.");
  d.internal<&E::fresh>("True: a set point was received in this cycle.");
  d.internal<&E::taken>("Last set point that the mover followed.");
  d.internal<&E::missing>("Number of consecutive missing set points.");
}

void describe(Description<GearState>& d) {
  d.named("MoverGear");
  d.about("Master of a mover.");
  d.internal<&GearState::axis>("Index of the axis that is the master.");
  d.internal<&GearState::in_sync>("Synchronization as last reported.");
}

void describe(Description<FormationState>& d) {
  using F = FormationState;
  d.named("MoverFormation");
  d.about("State of a mover in a formation.");
  d.internal<&F::star>("Index of the star.");
  d.internal<&F::x>(unit::mm, "X relative to the star, in its frame.");
  d.internal<&F::y>(unit::mm, "Y relative to the star, in its frame.");
  d.internal<&F::c>(unit::deg, "Angle relative to the star.");
  d.internal<&F::joined>("Membership as last reported.");
  d.internal<&F::whole>("True: the motion of the star in progress may use all of the dynamics.");
  d.internal<&F::share>(unit::one, "Share of the dynamics for turning otherwise.");
  d.internal<&F::brakes>("True: the star stops because of a planet that cannot continue.");
}

void describe(Description<State>& d) {
  using S = State;
  d.named("MoverState");
  d.about("A planar mover.");
  d.internal<&S::state>("State of the mover.");
  d.internal<&S::since>("Cycle in which the state was entered.");
  d.internal<&S::mode>("Kind of command that it executes.");
  d.internal<&S::aborts>("True: a reset of the fault leads to Disabled.");
  d.internal<&S::error>("Error of the fault.");
  d.internal<&S::limited_by>("First value of the dynamics of the last command that was reduced.");
  d.internal<&S::tickets>("Tickets of the commands in progress.");
  d.internal<&S::begun>("Cycles in which those commands began.");
  d.internal<&S::buffer>("Buffered commands.");
  d.internal<&S::escape>("Stop of X and Y if the mover may not move on.");
  d.internal<&S::plane>("Motion of X and Y.");
  d.internal<&S::track>("Track that it joins, is on, or leaves.");
  d.internal<&S::gear>("Master of the mover.");
  d.internal<&S::formation>("State in a formation.");
  d.internal<&S::system>("Index of its coordinate system.");
  d.internal<&S::part>("Index of the part that its centre is on.");
  d.internal<&S::others>("Motions of Z, A, B, C.");
  d.internal<&S::endless>("Moves of X, Y and C by velocity.");
  d.internal<&S::external>("External set points.");
  d.internal<&S::set_point>("Set point at the end of the last cycle.");
  d.internal<&S::carried>("Total displacement by moves of its part, without a motion of its own.");
  d.internal<&S::history>("Last commands.");
}

}  // namespace takt::mover
