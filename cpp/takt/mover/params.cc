#include "takt/mover/params.h"

#include "takt/mover/texts.h"

namespace takt::mover {

void describe(Description<Dynamics>& d) {
  d.named("MoverDynamics");
  d.about("How fast a coordinate of a mover may change; of X and Y together: along the way.");
  d.required<&Dynamics::velocity>(kOwnSpeed, kSpeeds, "Largest speed.");
  d.required<&Dynamics::acceleration>(kOwnAcceleration, kAccelerations, "Largest acceleration.");
  d.defaulted<&Dynamics::deceleration>(kOwnAcceleration, kAccelerations,
                                       "Largest deceleration; unset: as the acceleration.");
  d.required<&Dynamics::jerk>(kOwnJerk, kJerks, "Largest jerk.");
}

void describe(Description<PlaneParams>& d) {
  d.named("MoverPlane");
  d.about("X and Y of a mover.");
  d.defaulted<&PlaneParams::maximum>("What the mover can do; commands that want more get this, with a warning.");
  d.defaulted<&PlaneParams::standard>("Of commands that say nothing; never above the maximum. Unset: the maximum.");
}

void describe(Description<CoordinateParams>& d) {
  d.named("MoverCoordinate");
  d.about("A coordinate of a mover besides X and Y.");
  d.required<&CoordinateParams::maximum>("What the mover can do; commands that want more get this, with a warning.");
  d.defaulted<&CoordinateParams::standard>(
      "Of commands that say nothing; never above the maximum. Unset: the maximum.");
  d.required<&CoordinateParams::lower>(kOwn, kPlaces, "Smallest position.");
  d.required<&CoordinateParams::upper>(kOwn, kPlaces, "Largest position.");
  d.rule<&CoordinateParams::upper>("must not lie below lower",
                                   [](const CoordinateParams& p) { return p.lower <= p.upper; });
}

void describe(Description<Place>& d) {
  d.named("MoverPlace");
  d.about("Where a mover is.");
  d.defaulted<&Place::x>(unit::mm, kPlaces, "X of its middle.");
  d.defaulted<&Place::y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&Place::z>(unit::mm, kPlaces, "How high it floats.");
  d.defaulted<&Place::a>(unit::deg, kAngles, "Tilted about X.");
  d.defaulted<&Place::b>(unit::deg, kAngles, "Tilted about Y.");
  d.defaulted<&Place::c>(unit::deg, kAngles, "Turned about Z.");
}

void describe(Description<MoverParams>& d) {
  using P = MoverParams;
  d.about("A planar mover: it floats over stators and moves in six coordinates.");
  d.required<&P::name>("Of the mover; commands go to it.");
  d.defaulted<&P::width>(unit::mm, between(1, 1e4), "Along X when it is not turned.");
  d.defaulted<&P::height>(unit::mm, between(1, 1e4), "Along Y.");
  d.defaulted<&P::initial>("Where it is at the start.");
  d.defaulted<&P::reference>(
      "Name of the part or coordinate system that this place belongs to; needed where there are several coordinate "
      "systems or parts that move.");
  d.defaulted<&P::xy>("X and Y, along the way.");
  d.defaulted<&P::z>("How high it floats.");
  d.defaulted<&P::a>("Tilted about X.");
  d.defaulted<&P::b>("Tilted about Y.");
  d.defaulted<&P::c>(
      "Turned about Z. lower and upper are a window that is there four times, each turned by 90 deg; beyond them it "
      "turns only where it stands.");
  d.defaulted<&P::c_modulus>(unit::deg, between(1, 36000), "A turn, for the directions of move_c.");
  d.defaulted<&P::c_modulo_tolerance>(unit::deg, between(0, 36000),
                                      "So far move_c goes against its direction instead of nearly a whole turn.");
  d.defaulted<&P::lateral_acceleration>(
      unit::mm_s2, kAccelerations,
      "Largest one in curves of tracks, across the track; not above the largest acceleration of xy. Unset: 5000, or "
      "that where it is less.");
  d.defaulted<&P::gap>(unit::mm, between(0, 1e6),
                       "To the mover ahead on a track, middle to middle, unless a command says otherwise.");
  d.defaulted<&P::deviation>(unit::mm, between(1e-6, 1e6),
                             "So far between set and actual X and Y is an error; unset: they are not watched.");
  d.defaulted<&P::missing_setpoints>(unit::cycles, between(1, 1000),
                                     "So many external set points missing in a row are an error.");
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
