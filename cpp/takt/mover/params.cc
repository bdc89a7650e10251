#include "takt/mover/params.h"

#include "takt/mover/texts.h"

namespace takt::mover {

void describe(Description<Dynamics>& d) {
  d.named("MoverDynamics");
  d.about("Dynamic limits of a coordinate of a mover, or of X and Y together along the path.");
  d.required<&Dynamics::velocity>(kOwnSpeed, kSpeeds, "Largest speed.");
  d.required<&Dynamics::acceleration>(kOwnAcceleration, kAccelerations, "Largest acceleration.");
  d.defaulted<&Dynamics::deceleration>(kOwnAcceleration, kAccelerations,
                                       "Largest deceleration; unset: equal to the acceleration.");
  d.required<&Dynamics::jerk>(kOwnJerk, kJerks, "Largest jerk.");
}

void describe(Description<PlaneParams>& d) {
  d.named("MoverPlane");
  d.about("Dynamics of X and Y of a mover.");
  d.defaulted<&PlaneParams::maximum>("Maximum dynamics; commands that ask for more are reduced to it, with a warning.");
  d.defaulted<&PlaneParams::standard>("Dynamics of commands that give none, at most the maximum. Unset: the maximum.");
}

void describe(Description<CoordinateParams>& d) {
  d.named("MoverCoordinate");
  d.about("A coordinate of a mover other than X and Y.");
  d.required<&CoordinateParams::maximum>(
      "Maximum dynamics; commands that ask for more are reduced to it, with a warning.");
  d.defaulted<&CoordinateParams::standard>(
      "Dynamics of commands that give none, at most the maximum. Unset: the maximum.");
  d.required<&CoordinateParams::lower>(kOwn, kPlaces, "Smallest position.");
  d.required<&CoordinateParams::upper>(kOwn, kPlaces, "Largest position.");
  d.rule<&CoordinateParams::upper>("must not lie below lower",
                                   [](const CoordinateParams& p) { return p.lower <= p.upper; });
}

void describe(Description<Place>& d) {
  d.named("MoverPlace");
  d.about("Pose of a mover.");
  d.defaulted<&Place::x>(unit::mm, kPlaces, "X of the centre.");
  d.defaulted<&Place::y>(unit::mm, kPlaces, "Y of the centre.");
  d.defaulted<&Place::z>(unit::mm, kPlaces, "Height above the stators.");
  d.defaulted<&Place::a>(unit::deg, kAngles, "Tilt about X.");
  d.defaulted<&Place::b>(unit::deg, kAngles, "Tilt about Y.");
  d.defaulted<&Place::c>(unit::deg, kAngles, "Angle about Z.");
}

void describe(Description<MoverParams>& d) {
  using P = MoverParams;
  d.about("A planar mover: it floats over stators and moves in six coordinates.");
  d.required<&P::name>("Name of the mover, to which commands are addressed.");
  d.defaulted<&P::width>(unit::mm, between(1, 1e4), "Size along X when C is 0.");
  d.defaulted<&P::height>(unit::mm, between(1, 1e4), "Size along Y when C is 0.");
  d.defaulted<&P::initial>("Pose at the start.");
  d.defaulted<&P::reference>(
      "Name of the part or coordinate system of the initial pose. Required with several coordinate systems, or with "
      "parts that can move.");
  d.defaulted<&P::xy>("Dynamics of X and Y along the path.");
  d.defaulted<&P::z>("Height above the stators.");
  d.defaulted<&P::a>("Tilt about X.");
  d.defaulted<&P::b>("Tilt about Y.");
  d.defaulted<&P::c>(
      "Angle about Z. lower and upper limit a window, which exists four times, each turned by 90 deg; beyond the "
      "windows C turns only with X and Y at rest.");
  d.defaulted<&P::c_modulus>(unit::deg, between(1, 36000),
                             "Full turn of C, after which its positions repeat for the directions of move_c.");
  d.defaulted<&P::c_modulo_tolerance>(
      unit::deg, between(0, 36000),
      "Largest angle by which move_c turns against its direction instead of nearly a full turn.");
  d.defaulted<&P::lateral_acceleration>(unit::mm_s2, kAccelerations,
                                        "Largest lateral acceleration in curves of tracks, at most the acceleration of "
                                        "xy. Unset: 5000, or the acceleration of xy if that is less.");
  d.defaulted<&P::gap>(unit::mm, between(0, 1e6),
                       "Gap to the mover ahead on a track, from centre to centre, unless a command gives one.");
  d.defaulted<&P::deviation>(
      unit::mm, between(1e-6, 1e6),
      "Distance between set and actual position in X and Y above which the mover has a fault; unset: not checked.");
  d.defaulted<&P::missing_setpoints>(unit::cycles, between(1, 1000),
                                     "Number of consecutive missing external set points that is a fault.");
  d.rule<&P::c_modulo_tolerance>("must be less than half of c_modulus",
                                 [](const P& p) { return 2 * p.c_modulo_tolerance < p.c_modulus; });
  d.rule<&P::lateral_acceleration>("must not be above xy.maximum.acceleration",
                                   [](const P& p) { return p.lateral() <= p.xy.maximum.acceleration; });
  d.rule<&P::initial>("must lie within the limits of z, a and b", [](const P& p) {
    const auto holds = [](const CoordinateParams& limits, double at) {
      return limits.lower <= at && at <= limits.upper;
    };
    return holds(p.z, p.initial.z) && holds(p.a, p.initial.a) && holds(p.b, p.initial.b);
  });
}

}  // namespace takt::mover
