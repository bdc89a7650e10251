#include "takt/mover/commands.h"

#include <array>
#include <utility>

#include "takt/mover/texts.h"

namespace takt::mover {

namespace {

template <typename T>
void DescribeDynamics(Description<T>& d, Unit speed, Unit acceleration, Unit jerk) {
  d.template defaulted<&T::velocity>(speed, kSpeeds,
                                     "Largest speed; unset, as all that follows: the mover's standard.");
  d.template defaulted<&T::acceleration>(acceleration, kAccelerations, "Largest acceleration.");
  d.template defaulted<&T::deceleration>(acceleration, kAccelerations, "Largest deceleration.");
  d.template defaulted<&T::jerk>(jerk, kJerks, "Largest jerk.");
  if constexpr (requires { &T::buffer_mode; }) {
    d.template defaulted<&T::buffer_mode>("Whether it waits until all that were given before it are done.");
  }
}

template <typename T>
void DescribeReference(Description<T>& d) {
  d.template defaulted<&T::reference>(
      "Name of the part or coordinate system that X and Y belong to; needed where there are several coordinate systems "
      "or parts that move.");
}

template <typename T>
void DescribeAngle(Description<T>& d) {
  d.template required<&T::position>(unit::deg, kAngles, "Where to stop.");
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
  e.about("Which way a mover turns.");
  e.value(D::kNonModulo, "non_modulo", "To the very position, over as many turns as it takes.");
  e.value(D::kPositive, "positive", "Upwards to the next place that is the same but for whole turns.");
  e.value(D::kShortestWay, "shortest_way", "To the nearest of them.");
  e.value(D::kNegative, "negative", "Downwards to the next.");
}

void describe(Enumeration<SetpointMode>& e) {
  e.about("How set points from outside move a mover.");
  e.value(SetpointMode::kNone, "none", "Not at all.");
  e.value(SetpointMode::kAbsolute, "absolute", "It follows them alone.");
  e.value(SetpointMode::kRelative, "relative", "They come on top of whatever else it does.");
}

void describe(Enumeration<Buffering>& e) {
  e.about("When a command of a mover begins.");
  e.value(Buffering::kAborting, "aborting", "At once.");
  e.value(Buffering::kBuffered, "buffered", "When all that were given before it are done.");
}

void describe(Description<Enable>& d) {
  d.named("MoverEnable");
  d.about("Enables the mover; while it is being disabled, too.");
}
void describe(Description<Disable>& d) {
  d.named("MoverDisable");
  d.about(
      "Disables the mover: it comes to rest with its maximum dynamics first. After a fault: a reset leads to "
      "Disabled.");
}
void describe(Description<Reset>& d) {
  d.named("MoverReset");
  d.about("Takes the mover out of Error: back to Enabled, or to Disabled if it was disabled after the fault.");
}

void describe(Description<Halt>& d) {
  d.named("MoverHalt");
  d.about("Brings all coordinates to rest; X and Y on the line that they are on. Ends external set points, too.");
  d.defaulted<&Halt::deceleration>(unit::mm_s2, kAccelerations, "Of X and Y; unset: the mover's standard.");
  d.defaulted<&Halt::jerk>(unit::mm_s3, kJerks, "Of X and Y; unset: the mover's standard.");
}

void describe(Description<SetPosition>& d) {
  using S = SetPosition;
  d.named("MoverSetPosition");
  d.about("Tells a mover that is disabled where it is.");
  d.required<&S::x>(unit::mm, kPlaces, "X of its middle.");
  d.required<&S::y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&S::c>(unit::deg, kAngles, "How it is turned.");
  DescribeReference(d);
}

void describe(Description<MoveToPosition>& d) {
  using M = MoveToPosition;
  d.about("Moves X and Y on a straight line, as fast as the dynamics allow; from a motion in progress it goes on.");
  d.required<&M::x>(unit::mm, kPlaces, "X of the target.");
  d.required<&M::y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&M::c>(
      unit::deg, kAngles,
      "C of it; it moves along, and is there at the same time where both begin at rest. Unset: it stays.");
  d.defaulted<&M::use_orientation>("False: C stays in any case.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  DescribeReference(d);
  d.defaulted<&M::blending>(unit::mm, between(0, 1e5),
                            "Buffered behind another one: it begins that far before the end of that, without a stop.");
  d.rule<&M::blending>("must be 0 unless buffered",
                       [](const M& m) { return m.blending == 0 || m.buffer_mode == Buffering::kBuffered; });
}

void describe(Description<MoveZ>& d) {
  d.about("Moves Z, whatever the other coordinates do.");
  d.required<&MoveZ::position>(unit::mm, kPlaces, "Where to stop.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveA>& d) {
  d.about("Tilts the mover about X, whatever the other coordinates do.");
  DescribeAngle(d);
}
void describe(Description<MoveB>& d) {
  d.about("Tilts the mover about Y, whatever the other coordinates do.");
  DescribeAngle(d);
}
void describe(Description<MoveC>& d) {
  d.about(
      "Turns the mover. Within a window of C whatever the other coordinates do; out of it only where it stands, and X "
      "and Y are locked until it rests within a window.");
  DescribeAngle(d);
  d.defaulted<&MoveC::direction>("Which way, by the mover's c_modulus.");
  d.defaulted<&MoveC::additional_turns>(between(0, 1000), "So many turns more; positive and negative only.");
  d.rule<&MoveC::additional_turns>("must be 0 unless the direction is positive or negative", [](const MoveC& c) {
    return c.additional_turns == 0 || c.direction == TurnDirection::kPositive ||
           c.direction == TurnDirection::kNegative;
  });
}

namespace {

template <typename T>
void DescribeHalt(Description<T>& d, Unit acceleration, Unit jerk) {
  d.template defaulted<&T::deceleration>(acceleration, kAccelerations, "Unset: the mover's standard.");
  d.template defaulted<&T::jerk>(jerk, kJerks, "Unset: the mover's standard.");
}

// Arguments of a move of X or Y by itself.
template <typename T>
void DescribeEach(Description<T>& d) {
  d.template required<&T::position>(unit::mm, kPlaces, "Where to stop.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  DescribeReference(d);
}

template <typename T>
void DescribeRelative(Description<T>& d, Unit distance, const Range& range, Unit speed, Unit acceleration, Unit jerk) {
  d.template required<&T::distance>(distance, range, "From where it is when the command begins.");
  DescribeDynamics(d, speed, acceleration, jerk);
}

template <typename T>
void DescribeVelocity(Description<T>& d, Unit speed, Unit acceleration, Unit jerk) {
  d.template required<&T::velocity>(speed, between(-1e9, 1e9),
                                    "Negative: towards smaller values; 0: the coordinate stops.");
  d.template defaulted<&T::acceleration>(acceleration, kAccelerations,
                                         "Largest acceleration; unset, as all that follows: the mover's standard.");
  d.template defaulted<&T::deceleration>(acceleration, kAccelerations, "Largest deceleration.");
  d.template defaulted<&T::jerk>(jerk, kJerks, "Largest jerk.");
  d.template defaulted<&T::buffer_mode>("Whether it waits until all that were given before it are done.");
}

}  // namespace

void describe(Description<MoveX>& d) {
  d.about("Moves X, whatever Y and the other coordinates do; with at most 0.707 of the maximum dynamics of both.");
  DescribeEach(d);
}
void describe(Description<MoveY>& d) {
  d.about("Moves Y, whatever X and the other coordinates do; with at most 0.707 of the maximum dynamics of both.");
  DescribeEach(d);
}
void describe(Description<MoveRelativeX>& d) {
  d.about("Moves X by a distance, as move_x does.");
  DescribeRelative(d, unit::mm, kPlaces, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveRelativeY>& d) {
  d.about("Moves Y by a distance, as move_y does.");
  DescribeRelative(d, unit::mm, kPlaces, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveRelativeC>& d) {
  d.about("Turns the mover by an angle, as move_c does.");
  DescribeRelative(d, unit::deg, kAngles, unit::deg_s, unit::deg_s2, unit::deg_s3);
}
void describe(Description<MoveVelocityX>& d) {
  d.about(
      "Moves X at a velocity, as move_x does. Active until another command of X or a halt ends it; where there is no "
      "more "
      "room, as it was when the command began, X comes to rest, and the command ends with the reason as its error.");
  DescribeVelocity(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveVelocityY>& d) {
  d.about(
      "Moves Y at a velocity, as move_y does. Active until another command of Y or a halt ends it; where there is no "
      "more "
      "room, as it was when the command began, Y comes to rest, and the command ends with the reason as its error.");
  DescribeVelocity(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<MoveVelocityC>& d) {
  d.about(
      "Turns the mover at a velocity; X and Y must be at rest. Active until another command of C or a halt ends it.");
  DescribeVelocity(d, unit::deg_s, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltX>& d) {
  d.about(
      "Brings X to rest; Y and all others go on. A move of both, or of C with them, ends: all of it comes to rest.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}
void describe(Description<HaltY>& d) {
  d.about(
      "Brings Y to rest; X and all others go on. A move of both, or of C with them, ends: all of it comes to rest.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}
void describe(Description<HaltZ>& d) {
  d.about("Brings Z to rest; the others go on.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}
void describe(Description<HaltA>& d) {
  d.about("Brings A to rest; the others go on.");
  DescribeHalt(d, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltB>& d) {
  d.about("Brings B to rest; the others go on.");
  DescribeHalt(d, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltC>& d) {
  d.about("Brings C to rest; the others go on.");
  DescribeHalt(d, unit::deg_s2, unit::deg_s3);
}
void describe(Description<HaltOnTrack>& d) {
  d.about("Brings the mover to rest along its track, on which it stays; Z, A, B and C go on.");
  DescribeHalt(d, unit::mm_s2, unit::mm_s3);
}

void describe(Enumeration<DynamicsReduction>& e) {
  using D = DynamicsReduction;
  e.about("How the limits of a move along tracks count in curves.");
  e.value(D::kAccelerationLimitedVelocity, "acceleration_limited_velocity",
          "It slows down, so that the mover's lateral_acceleration is kept.");
  e.value(D::kNone, "none", "As fast as velocity, acceleration and jerk of X and Y, as vectors, keep their maxima.");
}

void describe(Description<JoinTrack>& d) {
  using J = JoinTrack;
  d.about("Moves X and Y straight to the nearest place of a track, and is on it then. The mover must be at rest.");
  d.required<&J::track>("Name of the track; it is enabled, and no mover moves along it.");
  d.defaulted<&J::use_orientation>("True: C turns to that of the track, 0, meanwhile. False: it stays.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
}
void describe(Description<LeaveTrack>& d) {
  using L = LeaveTrack;
  d.about("Leaves the track and moves X and Y straight to a place. The mover must be at rest.");
  d.required<&L::x>(unit::mm, kPlaces, "X of the target.");
  d.required<&L::y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&L::c>(unit::deg, kAngles, "C of it; counts with use_orientation.");
  d.defaulted<&L::use_orientation>("True: C moves along. False: it stays.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  DescribeReference(d);
}
void describe(Description<MoveOnTrack>& d) {
  using M = MoveOnTrack;
  d.about(
      "Moves along the track, or over a network of tracks on the shortest way, and keeps its gap to the mover ahead. "
      "From one track to the next it goes only forwards. It waits where others are in its way, and goes on by itself.");
  d.required<&M::position>(unit::mm, kPlaces, "Where to stop, along the track.");
  d.defaulted<&M::track>("Name of the track on which the target lies; unset: that where the mover is.");
  d.defaulted<&M::gap>(unit::mm, between(0, 1e5),
                       "From its centre to that of the mover ahead, along the track, from now on; unset: the mover's, "
                       "or the least at which the two do not touch where that is more.");
  d.defaulted<&M::direction>(
      "non_modulo: on a closed loop turns count, elsewhere forwards, or back on its own track; positive and negative: "
      "only that way; shortest_way: on a closed loop.");
  d.defaulted<&M::additional_turns>(between(0, 1000), "Of a closed loop; positive and negative only.");
  d.defaulted<&M::modulo_tolerance>(unit::mm, between(0, 1e5),
                                    "Of a closed loop: to a target as near as that it goes the shortest way.");
  d.defaulted<&M::dynamics_reduction>("What bounds its speed in curves.");
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
  e.about("Which way a slave may go until it has been in step.");
  e.value(SyncDirections::kPositive, "positive", "Forwards.");
  e.value(SyncDirections::kNegative, "negative", "Back.");
  e.value(SyncDirections::kBoth, "both", "Either.");
}

namespace {

// Arguments that both gears have in common.
template <typename G>
void DescribeSlave(Description<G>& d) {
  d.template required<&G::slave_sync_position>(
      unit::mm, kPlaces, "Where this mover is when the master is at its own sync position, along the track.");
  d.template defaulted<&G::slave_sync_track>("Name of that track; unset: that where the mover is.");
  d.template defaulted<&G::trail>("Tracks along which it goes, one behind the other; unset: that where it is.");
  d.template defaulted<&G::gap>(
      unit::mm, between(0, 1e5),
      "From its centre to that of the mover ahead, along the track, from now on; unset: the mover's.");
  d.template defaulted<&G::in_sync_tolerance>(unit::mm, between(0, 1e5), "So near to its place it is in step.");
  d.template defaulted<&G::direction_slave_sync_position>(
      "On a closed loop: which of the places that are the same but for whole turns.");
  d.template defaulted<&G::modulo_tolerance_slave_sync_position>(
      unit::mm, between(0, 1e5), "Of a closed loop: a place as near as that is the nearest one.");
  d.template defaulted<&G::allowed_slave_sync_directions>("Which way it may go until it has been in step.");
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
      "Goes along with an axis, 1 mm for each of its units, over the tracks of a trail: into step as soon as its "
      "limits "
      "allow, and again where it was lost. Active until another command or an error ends it.");
  d.required<&G::master>("Name of the axis.");
  d.required<&G::master_sync_position>(unit::u, kPlaces, "Where the master is when both are in step.");
  DescribeSlave(d);
}
void describe(Description<GearInPosOnTrackWithMasterMover>& d) {
  using G = GearInPosOnTrackWithMasterMover;
  d.about(
      "Goes along with another mover on tracks, whose way is counted over all tracks that it goes along: into step as "
      "soon as its limits allow, and again where it was lost. Active until another command or an error ends it.");
  d.required<&G::master>("Name of the mover.");
  d.required<&G::master_sync_position>(unit::mm, kPlaces, "Where the master is when both are in step.");
  d.defaulted<&G::master_sync_track>(
      "Name of the track on which that is, on the master's way; unset: that where it is now.");
  d.defaulted<&G::direction_master_sync_position>(
      "On a closed loop: which of the places that are the same but for whole turns.");
  d.defaulted<&G::modulo_tolerance_master_sync_position>(
      unit::mm, between(0, 1e5), "Of a closed loop: a place as near as that is the nearest one.");
  d.defaulted<&G::follow_mover>(
      "True: from the track of the master's sync position on it goes where the master goes; the trail, and the "
      "shortest "
      "way behind it, lead there.");
  DescribeSlave(d);
  d.rule<&G::modulo_tolerance_master_sync_position>("must be 0 where the direction is non_modulo", [](const G& g) {
    return g.modulo_tolerance_master_sync_position == 0 ||
           g.direction_master_sync_position != TurnDirection::kNonModulo;
  });
}

void describe(Description<AdoptTrackOrientation>& d) {
  using A = AdoptTrackOrientation;
  d.about("Turns the mover as its track is turned, which is C = 0 but for whole turns.");
  d.defaulted<&A::direction>("Which way, by the mover's c_modulus.");
  d.defaulted<&A::additional_turns>(between(0, 1000), "So many turns more; positive and negative only.");
  DescribeDynamics(d, unit::deg_s, unit::deg_s2, unit::deg_s3);
  d.rule<&A::additional_turns>("must be 0 unless the direction is positive or negative", [](const A& a) {
    return a.additional_turns == 0 || a.direction == TurnDirection::kPositive ||
           a.direction == TurnDirection::kNegative;
  });
}

void describe(Description<Wait>& d) {
  d.named("MoverWait");
  d.about("Holds back what is buffered behind it. It begins when all that were given before it are done.");
  d.defaulted<&Wait::duration>(unit::s, between(0, 1e6), "At least so long.");
  d.defaulted<&Wait::for_release>("Until a release, which it takes.");
}
void describe(Description<Release>& d) {
  d.named("MoverRelease");
  d.about(
      "Lets a wait of the mover go on that waits for it. They count: one that comes first is there for a later wait.");
}

void describe(Description<StartExternalSetpointGeneration>& d) {
  using S = StartExternalSetpointGeneration;
  d.about(
      "The mover follows set points from outside, from the first one on in every cycle; active until that is stopped.");
  d.defaulted<&S::mode>("absolute: alone, beginning at rest; relative: on top of whatever else it does.");
  d.rule<&S::mode>("must be absolute or relative", [](const S& s) { return s.mode != SetpointMode::kNone; });
}

void describe(Description<SetExternalSetpoint>& d) {
  using S = SetExternalSetpoint;
  d.about(
      "The set point for the end of this cycle. One that the mover cannot follow by its maximum dynamics, or none, is "
      "an error, and it comes to rest.");
  d.defaulted<&S::x>(unit::mm, kPlaces, "X.");
  d.defaulted<&S::y>(unit::mm, kPlaces, "Y.");
  d.defaulted<&S::z>(unit::mm, kPlaces, "Z.");
  d.defaulted<&S::a>(unit::deg, kAngles, "A.");
  d.defaulted<&S::b>(unit::deg, kAngles, "B.");
  d.defaulted<&S::c>(unit::deg, kAngles, "C.");
  d.defaulted<&S::velocity_x>(unit::mm_s, kPlaces, "Velocity of X; as the positions say, else they are wrong.");
  d.defaulted<&S::velocity_y>(unit::mm_s, kPlaces, "Of Y.");
  d.defaulted<&S::velocity_z>(unit::mm_s, kPlaces, "Of Z.");
  d.defaulted<&S::velocity_a>(unit::deg_s, kPlaces, "Of A.");
  d.defaulted<&S::velocity_b>(unit::deg_s, kPlaces, "Of B.");
  d.defaulted<&S::velocity_c>(unit::deg_s, kPlaces, "Of C.");
  d.defaulted<&S::acceleration_x>(unit::mm_s2, kPlaces, "Acceleration of X.");
  d.defaulted<&S::acceleration_y>(unit::mm_s2, kPlaces, "Of Y.");
  d.defaulted<&S::acceleration_z>(unit::mm_s2, kPlaces, "Of Z.");
  d.defaulted<&S::acceleration_a>(unit::deg_s2, kPlaces, "Of A.");
  d.defaulted<&S::acceleration_b>(unit::deg_s2, kPlaces, "Of B.");
  d.defaulted<&S::acceleration_c>(unit::deg_s2, kPlaces, "Of C.");
  DescribeReference(d);
}

void describe(Description<StopExternalSetpointGeneration>& d) {
  d.about("Ends external set points: the mover comes to rest with its maximum dynamics.");
}

void describe(Description<AddToGroup>& d) {
  d.about(
      "Puts the mover into a group. If that is enabled the mover has to rest, and to stand where it meets nothing.");
  d.required<&AddToGroup::group>("Its name.");
}

void describe(Description<RemoveFromGroup>& d) {
  d.about("Takes the mover out of its group: nobody looks any more what it collides with.");
}

void describe(Description<JoinFormation>& d) {
  d.about(
      "Goes along with another mover, the star, as one body: whatever moves X, Y and C of that carries this one with "
      "it, in the place relative to it and turned to it as now. Both must rest, enabled and in free movement. The star "
      "keeps the limits of all its planets. Active until the formation is left.");
  d.required<&JoinFormation::star>("Name of the mover that leads.");
}

void describe(Description<LeaveFormation>& d) {
  d.about("Leaves the formation, which must rest: the mover stays where it is.");
}

void describe(Description<Visit>& d) {
  using V = Visit;
  d.about("A place on a route over the free surface. Times as planned, from the start of the routes on; all, or none.");
  d.required<&V::x>(unit::mm, kPlaces, "X of its middle.");
  d.required<&V::y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&V::after>("Number of the mover, from 1, that visits the place before this one; 0: none.");
  d.defaulted<&V::after_visit>(kVisits, "The visit of that mover which has to be over.");
  d.defaulted<&V::entry_time>(unit::s, kTimes, "From when on it cannot come to rest before the place any more.");
  d.defaulted<&V::exit_time>(unit::s, kTimes, "When no part of it covers the place any more.");
  d.defaulted<&V::departure_time>(unit::s, kTimes, "Where a straight motion from rest begins: when.");
  d.defaulted<&V::arrival_time>(unit::s, kTimes, "Where one ends: when.");
}

void describe(Description<SetRoute>& d) {
  using S = SetRoute;
  d.about(
      "Tells the mover which places of the free surface it is to visit one after the other, each beside the one before "
      "along X or Y. It begins with start_routes. Without visits: takes back what it was told and has not begun. "
      "Visits are numbered through over all routes of a mover; up to 512 in one route, of which a command has up to "
      "48.");
  d.required<&S::first>(
      kVisits,
      "Number of the first one, where the mover is at rest: its route_visit, or, if it was taken off its route, a "
      "further one of that; of one on its way, a visit of its route so far where it can still come to rest.");
  d.defaulted<&S::continues>("These follow on those of the command before.");
  d.required<&S::visits>(
      "The places: x, y [mm]; after and after_visit: number of the mover, from 1, that visits it before, and of that "
      "visit; entry_time, exit_time, departure_time and arrival_time [s] as planned, from the start of the routes on.");
}

void describe(Description<ContinueRoute>& d) {
  d.about(
      "Resumes the route from which a halt, a fault or another command has taken the mover. It must rest on the "
      "route.");
}

void describe(Description<StartRoutes>& d) {
  d.about(
      "Lets movers begin the routes that they were told by set_route, all of them at once, or none. Those on their way "
      "change over; those behind them must do so, too, and what they are bound for already comes first. A place is "
      "entered when the mover that visits it before has left it, or moves ahead in the same direction.");
  DescribeDynamics(d, unit::mm_s, unit::mm_s2, unit::mm_s3);
  d.defaulted<&StartRoutes::movers>("Numbers of the movers, from 1; none: all that were told a route.");
}

void describe(Description<HoldRoutes>& d) {
  d.about(
      "Lets movers on routes come to rest in the next places where they can, and none in the way of another one: "
      "route_granted. They go on when it is taken back.");
  d.defaulted<&HoldRoutes::hold>("False: takes it back.");
  d.defaulted<&HoldRoutes::movers>("Numbers of the movers, from 1; none: all.");
}

}  // namespace takt::mover
