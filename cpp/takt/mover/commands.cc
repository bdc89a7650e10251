#include "takt/mover/commands.h"

#include <array>
#include <utility>

#include "takt/mover/texts.h"

namespace takt::mover {

namespace {

template <typename T>
void DescribeDynamics(Description<T>& d, Unit speed, Unit acceleration, Unit jerk) {
  d.template defaulted<&T::velocity>(speed, kSpeeds,
                                     "Largest speed. Unset, as with the other dynamics: the mover's standard.");
  d.template defaulted<&T::acceleration>(acceleration, kAccelerations, "Largest acceleration.");
  d.template defaulted<&T::deceleration>(acceleration, kAccelerations, "Largest deceleration.");
  d.template defaulted<&T::jerk>(jerk, kJerks, "Largest jerk.");
  if constexpr (requires { &T::buffer_mode; }) {
    d.template defaulted<&T::buffer_mode>("Whether the command begins at once or after all commands given before it.");
  }
}

template <typename T>
void DescribeReference(Description<T>& d) {
  d.template defaulted<&T::reference>(
      "Name of the part or coordinate system of X and Y. Required with several coordinate systems, or with parts that "
      "can move.");
}

template <typename T>
void DescribeAngle(Description<T>& d) {
  d.template required<&T::position>(unit::deg, kAngles, "Target angle.");
  DescribeDynamics(d, unit::deg_s, unit::deg_s2, unit::deg_s3);
}

}  // namespace

const Type& TypeOfCommand(std::size_t index) {
  static const auto types = []<std::size_t... i>(std::index_sequence<i...>) {
    return std::array{&TypeOf<std::variant_alternative_t<i, Command>>()...};
  }
  (std::make_index_sequence<std::variant_size_v<Command>>());
  return *types.at(index);
}

void describe(Enumeration<TurnDirection>& e) {
  using D = TurnDirection;
  e.about(
      "Which of the equivalent targets is meant where positions repeat: after a full turn of C, or after the length of "
      "a closed track.");
  e.value(D::kNonModulo, "non_modulo", "The absolute position, over as many turns as needed.");
  e.value(D::kPositive, "positive", "Upwards to the next equivalent position.");
  e.value(D::kShortestWay, "shortest_way", "To the nearest equivalent position.");
  e.value(D::kNegative, "negative", "Downwards to the next equivalent position.");
}

void describe(Enumeration<SetpointMode>& e) {
  e.about("Effect of external set points on a mover.");
  e.value(SetpointMode::kNone, "none", "No external set points.");
  e.value(SetpointMode::kAbsolute, "absolute", "The mover follows the external set points alone.");
  e.value(SetpointMode::kRelative, "relative", "External set points are added to the motion of other commands.");
}

void describe(Enumeration<Buffering>& e) {
  e.about("When a command of a mover begins.");
  e.value(Buffering::kAborting, "aborting", "At once. Buffered commands are aborted if the command takes over X or Y.");
  e.value(Buffering::kBuffered, "buffered", "After all commands given before it.");
}

void describe(Description<Enable>& d) {
  d.named("MoverEnable");
  d.about("Enables the mover, also while it is being disabled.");
}
void describe(Description<Disable>& d) {
  d.named("MoverDisable");
  d.about(
      "Disables the mover after it has come to rest with its maximum dynamics. After a fault: a reset leads to "
      "Disabled.");
}
void describe(Description<Reset>& d) {
  d.named("MoverReset");
  d.about(
      "Leads the mover out of Error: back to Enabled, or to Disabled if it was disabled before or after the fault, or "
      "if its part cannot be enabled.");
}

void describe(Description<Halt>& d) {
  d.named("MoverHalt");
  d.about(
      "Brings all coordinates to rest, X and Y on their present line. Aborts buffered commands and ends external set "
      "points. A planet brings its whole formation to rest, with the maximum dynamics.");
  d.defaulted<&Halt::deceleration>(unit::mm_s2, kAccelerations,
                                   "Deceleration of X and Y. Unset: the mover's standard.");
  d.defaulted<&Halt::jerk>(unit::mm_s3, kJerks, "Jerk of X and Y. Unset: the mover's standard.");
}

void describe(Description<SetPosition>& d) {
  using S = SetPosition;
  d.named("MoverSetPosition");
  d.about("Sets the position of a disabled mover. Refused if it would collide there.");
  d.required<&S::x>(unit::mm, kPlaces, "X of the centre of the mover.");
  d.required<&S::y>(unit::mm, kPlaces, "Y of the centre of the mover.");
  d.defaulted<&S::c>(unit::deg, kAngles, "Angle of the mover about Z.");
  DescribeReference(d);
}

void describe(Description<MoveToPosition>& d) {
  using M = MoveToPosition;
  d.about(
      "Moves X and Y on a straight line, as fast as the dynamics allow. A motion in progress is led onto the line to "
      "the target, or stopped first if that is faster.");
  d.required<&M::x>(unit::mm, kPlaces, "X of the target.");
  d.required<&M::y>(unit::mm, kPlaces, "Y of the target.");
  d.defaulted<&M::c>(unit::deg, kAngles,
                     "C of the target. If X, Y and C begin at rest, they arrive at the same time. Unset: C stays.");
  d.defaulted<&M::use_orientation>("False: C stays in any case.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  DescribeReference(d);
  d.defaulted<&M::blending>(
      unit::mm, between(0, 1e5),
      "Largest distance from the target of the preceding move at which a buffered move takes over without a stop.");
  d.rule<&M::blending>("must be 0 unless buffered",
                       [](const M& m) { return m.blending == 0 || m.buffer_mode == Buffering::kBuffered; });
}

void describe(Description<MoveZ>& d) {
  d.about("Moves Z, independently of the other coordinates.");
  d.required<&MoveZ::position>(unit::mm, kPlaces, "Target position.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveA>& d) {
  d.about("Tilts the mover about X, independently of the other coordinates.");
  DescribeAngle(d);
}
void describe(Description<MoveB>& d) {
  d.about("Tilts the mover about Y, independently of the other coordinates.");
  DescribeAngle(d);
}
void describe(Description<MoveC>& d) {
  d.about(
      "Turns the mover about Z. Within a window of C this is independent of the other coordinates. Beyond it X and Y "
      "must be at rest, and are locked until C rests within a window.");
  DescribeAngle(d);
  d.defaulted<&MoveC::direction>("Direction of the turn; positions repeat after the mover's c_modulus.");
  d.defaulted<&MoveC::additional_turns>(between(0, 1000), "Number of additional turns; positive and negative only.");
  d.rule<&MoveC::additional_turns>("must be 0 unless the direction is positive or negative", [](const MoveC& c) {
    return c.additional_turns == 0 || c.direction == TurnDirection::kPositive ||
           c.direction == TurnDirection::kNegative;
  });
}

namespace {

template <typename T>
void DescribeHalt(Description<T>& d, Unit acceleration, Unit jerk) {
  d.template defaulted<&T::deceleration>(acceleration, kAccelerations, "Deceleration. Unset: the mover's standard.");
  d.template defaulted<&T::jerk>(jerk, kJerks, "Jerk. Unset: the mover's standard.");
}

// Arguments of a move of X or Y by itself.
template <typename T>
void DescribeEach(Description<T>& d) {
  d.template required<&T::position>(unit::mm, kPlaces, "Target position.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  DescribeReference(d);
}

template <typename T>
void DescribeRelative(Description<T>& d, Unit distance, const Range& range, Unit speed, Unit acceleration, Unit jerk) {
  d.template required<&T::distance>(distance, range, "Distance from the position at the beginning of the command.");
  DescribeDynamics(d, speed, acceleration, jerk);
}

template <typename T>
void DescribeVelocity(Description<T>& d, Unit speed, Unit acceleration, Unit jerk) {
  d.template required<&T::velocity>(speed, between(-1e9, 1e9),
                                    "Velocity; negative: towards smaller values; 0: the coordinate stops.");
  d.template defaulted<&T::acceleration>(
      acceleration, kAccelerations, "Largest acceleration. Unset, as with the other dynamics: the mover's standard.");
  d.template defaulted<&T::deceleration>(acceleration, kAccelerations, "Largest deceleration.");
  d.template defaulted<&T::jerk>(jerk, kJerks, "Largest jerk.");
  d.template defaulted<&T::buffer_mode>("Whether the command begins at once or after all commands given before it.");
}

}  // namespace

void describe(Description<MoveX>& d) {
  d.about(
      "Moves X, independently of Y and the other coordinates, with at most 0.707 of the maximum dynamics of X and Y.");
  DescribeEach(d);
}
void describe(Description<MoveY>& d) {
  d.about(
      "Moves Y, independently of X and the other coordinates, with at most 0.707 of the maximum dynamics of X and Y.");
  DescribeEach(d);
}
void describe(Description<MoveRelativeX>& d) {
  d.about("Moves X by a distance, with the limits of move_x.");
  DescribeRelative(d, unit::mm, kPlaces, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveRelativeY>& d) {
  d.about("Moves Y by a distance, with the limits of move_y.");
  DescribeRelative(d, unit::mm, kPlaces, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveRelativeC>& d) {
  d.about("Turns the mover by an angle, with the limits of move_c.");
  DescribeRelative(d, unit::deg, kAngles, unit::deg_s, unit::deg_s2, unit::deg_s3);
}
void describe(Description<MoveVelocityX>& d) {
  d.about(
      "Moves X at a velocity, with the limits of move_x, until another command of X or a halt. At the end of the room "
      "that there was when the command began, X comes to rest, and the command ends with the reason as its error.");
  DescribeVelocity(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveVelocityY>& d) {
  d.about(
      "Moves Y at a velocity, with the limits of move_y, until another command of Y or a halt. At the end of the room "
      "that there was when the command began, Y comes to rest, and the command ends with the reason as its error.");
  DescribeVelocity(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveVelocityC>& d) {
  d.about("Turns the mover at a velocity until another command of C or a halt. X and Y must be at rest.");
  DescribeVelocity(d, unit::deg_s, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltX>& d) {
  d.about(
      "Brings X to rest; Y and all other coordinates continue. A move of both X and Y is aborted, and both come to "
      "rest on their line, with the C that belongs to the move.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}
void describe(Description<HaltY>& d) {
  d.about(
      "Brings Y to rest; X and all other coordinates continue. A move of both X and Y is aborted, and both come to "
      "rest on their line, with the C that belongs to the move.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}
void describe(Description<HaltZ>& d) {
  d.about("Brings Z to rest; the other coordinates continue.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}
void describe(Description<HaltA>& d) {
  d.about("Brings A to rest; the other coordinates continue.");
  DescribeHalt(d, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltB>& d) {
  d.about("Brings B to rest; the other coordinates continue.");
  DescribeHalt(d, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltC>& d) {
  d.about("Brings C to rest; the other coordinates continue. Refused while C belongs to a move of X and Y.");
  DescribeHalt(d, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltOnTrack>& d) {
  d.about("Brings the mover to rest along its track and keeps it there; Z, A, B and C continue.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}

void describe(Enumeration<DynamicsReduction>& e) {
  using D = DynamicsReduction;
  e.about("How the limits of a move along tracks are applied in curves.");
  e.value(D::kAccelerationLimitedVelocity, "acceleration_limited_velocity",
          "The speed is reduced so that the mover's lateral_acceleration is kept.");
  e.value(D::kNone, "none",
          "As fast as the maxima of X and Y, applied to velocity, acceleration and jerk as vectors, allow.");
}

void describe(Description<JoinTrack>& d) {
  using J = JoinTrack;
  d.about(
      "Moves X and Y straight to the nearest point of a track. The mover must be at rest; afterwards it is on the "
      "track.");
  d.required<&J::track>("Name of the track, which must be Enabled and not Moving.");
  d.defaulted<&J::use_orientation>("True: C turns to the orientation of the track, which is 0. False: C stays.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<LeaveTrack>& d) {
  using L = LeaveTrack;
  d.about("Leaves the track: moves X and Y straight to a position. The mover must be at rest.");
  d.required<&L::x>(unit::mm, kPlaces, "X of the target.");
  d.required<&L::y>(unit::mm, kPlaces, "Y of the target.");
  d.defaulted<&L::c>(unit::deg, kAngles, "C of the target; used with use_orientation only.");
  d.defaulted<&L::use_orientation>("True: C turns meanwhile. False: C stays.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  DescribeReference(d);
}
void describe(Description<MoveOnTrack>& d) {
  using M = MoveOnTrack;
  d.about(
      "Moves along the track, or on the shortest route through a network of tracks, and keeps the gap to the mover "
      "ahead. It passes from track to track forwards only. It waits for movers in its way and continues by itself.");
  d.required<&M::position>(unit::mm, kPlaces,
                           "Target position along the track, within its length; any on a closed loop with non_modulo.");
  d.defaulted<&M::track>("Name of the track of the target; unset: the present track of the mover.");
  d.defaulted<&M::gap>(
      unit::mm, between(0, 1e5),
      "Gap to the mover ahead, from centre to centre along the track, from this command on; refused if movers could "
      "touch. Unset: the mover's gap, or the least gap without contact if that is larger.");
  d.defaulted<&M::direction>(
      "On a closed loop: non_modulo counts turns, shortest_way takes the nearest equivalent target. Elsewhere both "
      "lead forwards, or back on the present track. positive and negative: only in this direction.");
  d.defaulted<&M::additional_turns>(between(0, 1000),
                                    "Number of additional turns; on a closed loop with positive or negative only.");
  d.defaulted<&M::modulo_tolerance>(
      unit::mm, between(0, 1e5),
      "On a closed loop: a target within this distance is reached directly, whatever the direction.");
  d.defaulted<&M::dynamics_reduction>("How the speed is limited in curves.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  d.rule<&M::additional_turns>("must be 0 unless the direction is positive or negative", [](const M& m) {
    return m.additional_turns == 0 || m.direction == TurnDirection::kPositive ||
           m.direction == TurnDirection::kNegative;
  });
  d.rule<&M::modulo_tolerance>("must be 0 where the direction is non_modulo", [](const M& m) {
    return m.modulo_tolerance == 0 || m.direction != TurnDirection::kNonModulo;
  });
}
void describe(Enumeration<SyncDirections>& e) {
  e.about("Directions in which a slave may move until it has been in sync.");
  e.value(SyncDirections::kPositive, "positive", "Forwards only.");
  e.value(SyncDirections::kNegative, "negative", "Backwards only.");
  e.value(SyncDirections::kBoth, "both", "Either direction.");
}

namespace {

// Arguments that both gears have in common.
template <typename G>
void DescribeSlave(Description<G>& d) {
  d.template required<&G::slave_sync_position>(
      unit::mm, kPlaces, "Position of this mover along the track while the master is at its sync position.");
  d.template defaulted<&G::slave_sync_track>(
      "Name of the track of the sync position, on the trail or just passed; unset: the present track of the mover.");
  d.template defaulted<&G::trail>(
      "Names of consecutive tracks along which the mover may move, its present track among them; unset: that one "
      "alone.");
  d.template defaulted<&G::gap>(
      unit::mm, between(0, 1e5),
      "Gap to the mover ahead, from centre to centre along the track, from this command on; refused if movers could "
      "touch. Unset: the mover's gap, or the least gap without contact if that is larger.");
  d.template defaulted<&G::in_sync_tolerance>(unit::mm, between(0, 1e5),
                                              "Largest position error that counts as in sync.");
  d.template defaulted<&G::direction_slave_sync_position>(
      "On a closed loop: which of the equivalent sync positions is meant. Elsewhere non_modulo.");
  d.template defaulted<&G::modulo_tolerance_slave_sync_position>(
      unit::mm, between(0, 1e5),
      "On a closed loop: an equivalent position within this distance is used, whatever the direction.");
  d.template defaulted<&G::allowed_slave_sync_directions>(
      "Directions in which the mover may move until it has been in sync.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  d.template rule<&G::modulo_tolerance_slave_sync_position>(
      "must be 0 where the direction is non_modulo", [](const G& g) {
        return g.modulo_tolerance_slave_sync_position == 0 ||
               g.direction_slave_sync_position != TurnDirection::kNonModulo;
      });
}

}  // namespace

void describe(Description<GearInPosOnTrack>& d) {
  using G = GearInPosOnTrack;
  d.about(
      "Couples the mover to an axis, 1 mm for each unit of the axis, along the tracks of a trail. It synchronizes as "
      "soon as its limits allow, and again after a loss. Active until another command or an error ends it.");
  d.required<&G::master>("Name of the axis.");
  d.required<&G::master_sync_position>(unit::u, kPlaces,
                                       "Position of the master at which both are in sync; of a periodic axis, the "
                                       "equivalent one nearest to its present position.");
  DescribeSlave(d);
}
void describe(Description<GearInPosOnTrackWithMasterMover>& d) {
  using G = GearInPosOnTrackWithMasterMover;
  d.about(
      "Couples the mover to another mover on tracks; positions are counted over all tracks that each passes. It "
      "synchronizes as soon as its limits allow, and again after a loss. Active until another command or an error ends "
      "it.");
  d.required<&G::master>("Name of the master, a mover on a track.");
  d.required<&G::master_sync_position>(unit::mm, kPlaces,
                                       "Position of the master along its track at which both are in sync.");
  d.defaulted<&G::master_sync_track>(
      "Name of the track of that position, on the master's route or just passed; unset: the master's present track.");
  d.defaulted<&G::direction_master_sync_position>(
      "On a closed loop: which of the equivalent sync positions is meant. Elsewhere non_modulo.");
  d.defaulted<&G::modulo_tolerance_master_sync_position>(
      unit::mm, between(0, 1e5),
      "On a closed loop: an equivalent position within this distance is used, whatever the direction.");
  d.defaulted<&G::follow_mover>(
      "True: from the track of the master's sync position on, the mover takes the route of the master; up to that "
      "track, the trail, continued by the shortest route.");
  DescribeSlave(d);
  d.rule<&G::modulo_tolerance_master_sync_position>("must be 0 where the direction is non_modulo", [](const G& g) {
    return g.modulo_tolerance_master_sync_position == 0 ||
           g.direction_master_sync_position != TurnDirection::kNonModulo;
  });
}

void describe(Description<AdoptTrackOrientation>& d) {
  using A = AdoptTrackOrientation;
  d.about("Turns the mover to the orientation of its track: C = 0 but for whole turns.");
  d.defaulted<&A::direction>("Direction of the turn; positions repeat after the mover's c_modulus.");
  d.defaulted<&A::additional_turns>(between(0, 1000), "Number of additional turns; positive and negative only.");
  DescribeDynamics(d, unit::deg_s, unit::deg_s2, unit::deg_s3);
  d.rule<&A::additional_turns>("must be 0 unless the direction is positive or negative", [](const A& a) {
    return a.additional_turns == 0 || a.direction == TurnDirection::kPositive ||
           a.direction == TurnDirection::kNegative;
  });
}

void describe(Description<Wait>& d) {
  d.named("MoverWait");
  d.about(
      "Delays the commands buffered behind it. It is always buffered: it begins after all commands given before it.");
  d.defaulted<&Wait::duration>(unit::s, between(0, 1e6), "Least duration.");
  d.defaulted<&Wait::for_release>("True: also waits for a release, and consumes it.");
}
void describe(Description<Release>& d) {
  d.named("MoverRelease");
  d.about(
      "Adds one release, at once. A current or later wait for a release consumes it; a halt, a fault or disabling "
      "discards the unused ones.");
}

void describe(Description<StartExternalSetpointGeneration>& d) {
  using S = StartExternalSetpointGeneration;
  d.about(
      "Starts external set points: one is required in every cycle from this one on; fewer than missing_setpoints may "
      "be missing in a row. Active until they are stopped.");
  d.defaulted<&S::mode>(
      "absolute: the mover, at rest before, follows them alone; relative: they are added to other motions.");
  d.rule<&S::mode>("must be absolute or relative", [](const S& s) { return s.mode != SetpointMode::kNone; });
}

void describe(Description<SetExternalSetpoint>& d) {
  using S = SetExternalSetpoint;
  d.about(
      "External set point for the end of this cycle. If it is missing, or cannot be followed within the maximum "
      "dynamics and limits, the mover comes to rest with an error.");
  d.defaulted<&S::x>(unit::mm, kPlaces, "Position of X.");
  d.defaulted<&S::y>(unit::mm, kPlaces, "Position of Y.");
  d.defaulted<&S::z>(unit::mm, kPlaces, "Position of Z.");
  d.defaulted<&S::a>(unit::deg, kAngles, "Position of A.");
  d.defaulted<&S::b>(unit::deg, kAngles, "Position of B.");
  d.defaulted<&S::c>(unit::deg, kAngles, "Position of C.");
  d.defaulted<&S::velocity_x>(unit::mm_s, kPlaces, "Velocity of X. It must match the positions.");
  d.defaulted<&S::velocity_y>(unit::mm_s, kPlaces, "Velocity of Y.");
  d.defaulted<&S::velocity_z>(unit::mm_s, kPlaces, "Velocity of Z.");
  d.defaulted<&S::velocity_a>(unit::deg_s, kPlaces, "Velocity of A.");
  d.defaulted<&S::velocity_b>(unit::deg_s, kPlaces, "Velocity of B.");
  d.defaulted<&S::velocity_c>(unit::deg_s, kPlaces, "Velocity of C.");
  d.defaulted<&S::acceleration_x>(unit::mm_s2, kPlaces, "Acceleration of X.");
  d.defaulted<&S::acceleration_y>(unit::mm_s2, kPlaces, "Acceleration of Y.");
  d.defaulted<&S::acceleration_z>(unit::mm_s2, kPlaces, "Acceleration of Z.");
  d.defaulted<&S::acceleration_a>(unit::deg_s2, kPlaces, "Acceleration of A.");
  d.defaulted<&S::acceleration_b>(unit::deg_s2, kPlaces, "Acceleration of B.");
  d.defaulted<&S::acceleration_c>(unit::deg_s2, kPlaces, "Acceleration of C.");
  DescribeReference(d);
}

void describe(Description<StopExternalSetpointGeneration>& d) {
  d.about(
      "Stops external set points and aborts all other commands: the mover comes to rest with its maximum dynamics.");
}

void describe(Description<AddToGroup>& d) {
  d.about(
      "Adds the mover to a group. If the group is enabled, the mover must be at rest and clear of everything in it.");
  d.required<&AddToGroup::group>("Name of the group.");
}

void describe(Description<RemoveFromGroup>& d) {
  d.about("Removes the mover from its group, which then no longer checks it for collisions.");
}

void describe(Description<JoinFormation>& d) {
  d.about(
      "Couples the mover rigidly to another mover, the star: it keeps its present pose relative to the star, whatever "
      "moves its X, Y and C. Both must be enabled, at rest and in free movement. The star keeps the limits of all "
      "its planets. Active until the formation is left.");
  d.required<&JoinFormation::star>("Name of the star.");
}

void describe(Description<LeaveFormation>& d) {
  d.about("Leaves the formation, which must be at rest: the mover stays at its position.");
}

void describe(Description<Visit>& d) {
  using V = Visit;
  d.about(
      "A place on a route over the free surface. Planned times count from start_routes; they are given for all "
      "straight motions of a route, or for none.");
  d.required<&V::x>(unit::mm, kPlaces, "X of the centre of the place.");
  d.required<&V::y>(unit::mm, kPlaces, "Y of the centre of the place.");
  d.defaulted<&V::after>("Number of the mover, from 1, that visits the place before this one; 0: none.");
  d.defaulted<&V::after_visit>(kVisits, "Number of the visit of that mover that has to be over.");
  d.defaulted<&V::entry_time>(unit::s, kTimes,
                              "Time from which on the mover cannot come to rest before the place any more.");
  d.defaulted<&V::exit_time>(unit::s, kTimes, "Time at which the mover covers no part of the place any more.");
  d.defaulted<&V::departure_time>(unit::s, kTimes, "Start of a straight motion from rest at this place.");
  d.defaulted<&V::arrival_time>(unit::s, kTimes, "End of a straight motion at this place.");
}

void describe(Description<SetRoute>& d) {
  using S = SetRoute;
  d.about(
      "Gives the mover a route of places on the free surface, each beside the one before along X or Y. It begins with "
      "start_routes. Without visits: discards the route received and not started. Visits are numbered consecutively "
      "over all routes of a mover; up to 512 in one route, up to 48 in one command.");
  d.required<&S::first>(
      kVisits,
      "Number of the first visit. At rest: the mover's route_visit, or, off its route, the further visit of it where "
      "the mover is. On a route: a visit of it, at most 32 ahead and at the same place, where the mover can still come "
      "to rest. With continues: the number after the last visit.");
  d.defaulted<&S::continues>(
      "True: the visits continue those of the preceding set_route, which must not be started yet.");
  d.required<&S::visits>(
      "Places: x, y [mm]; after and after_visit: number of the mover, from 1, that visits it before, and of its visit; "
      "entry_time, exit_time, departure_time and arrival_time [s], counted from start_routes.");
}

void describe(Description<ContinueRoute>& d) {
  d.about(
      "Resumes the route that a halt, a fault or another command interrupted. The mover must be at rest on the route, "
      "at most 0.05 mm off it.");
}

void describe(Description<StartRoutes>& d) {
  d.about(
      "Machine command: starts the routes given by set_route, all listed ones together, or none. Movers on a route "
      "change over at the first visit of the new one; movers behind them need a new route, too, if they wait for "
      "visits that no longer take place. A place is entered when the mover that visits it before has left it, or moves "
      "ahead in the same direction.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  d.defaulted<&StartRoutes::movers>("Numbers of the movers, from 1; empty: all that have received a route.");
}

void describe(Description<HoldRoutes>& d) {
  d.about(
      "Machine command: brings movers on routes to rest at the next places where they can stop (route_granted), but "
      "none at a place that another mover on its way there needs. The routes continue when the hold ends.");
  d.defaulted<&HoldRoutes::hold>("True: holds; false: the routes continue.");
  d.defaulted<&HoldRoutes::movers>("Numbers of the movers, from 1; empty: all.");
}

}  // namespace takt::mover
