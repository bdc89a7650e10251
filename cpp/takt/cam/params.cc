#include "takt/cam/params.h"

#include "takt/core/describe.h"

namespace takt::cam {

namespace {

constexpr Unit kX{"x", "the master's unit"};
constexpr Unit kY{"y", "the slave's unit"};
constexpr Unit kV{"y/x", "the slave's unit per master's unit"};
constexpr Unit kA{"y/x2", "the slave's unit per master's unit squared"};

int Sources(const CamParams& p) {
  return (p.points.empty() ? 0 : 1) + (p.segments.empty() ? 0 : 1) + (p.file.empty() ? 0 : 1);
}

}  // namespace

void describe(Enumeration<Interpolation>& e) {
  e.about("What lies between the points of a cam.");
  e.value(Interpolation::kLinear, "linear", "Straight lines; the velocity jumps at the points.");
  e.value(Interpolation::kQuintic, "quintic", "Polynomials of the fifth degree; nothing up to the acceleration jumps.");
  e.value(
      Interpolation::kCubicSpline, "cubic_spline",
      "Polynomials of the third degree; the acceleration jumps only where a velocity is given. Its ends are natural, "
      "or periodic where the cam is cyclic.");
  e.value(Interpolation::kMonotone, "monotone",
          "Polynomials of the fifth degree that rise and fall only where the points do; nothing up to the acceleration "
          "jumps.");
}

void describe(Description<CamPoint>& d) {
  d.about("A point of a cam. What is not given is free: the curve becomes as smooth as it can.");
  d.required<&CamPoint::x>(kX, "Where the master is.");
  d.required<&CamPoint::y>(kY, "Where the slave is then.");
  d.defaulted<&CamPoint::v>(kV, "Velocity, dy/dx.");
  d.defaulted<&CamPoint::a>(kA, "Acceleration, d2y/dx2; quintic and monotone only.");
}

void describe(Description<CamPlace>& d) {
  d.about("An end of a segment.");
  d.required<&CamPlace::x>(kX, "Where the master is.");
  d.required<&CamPlace::y>(kY, "Where the slave is then.");
}

void describe(Description<CamSegment>& d) {
  using S = CamSegment;
  d.about("A stretch of a cam under one law of motion.");
  d.defaulted<&S::from>("Where it begins; unset: where the one before ends, the first one at 0, 0.");
  d.required<&S::to>("Where it ends.");
  d.defaulted<&S::law>("The law of motion.");
  d.defaulted<&S::begin_v>(
      kV,
      "Velocity at its beginning; unset: of quintic, task, least_acceleration and least_jerk as the segment before has "
      "it, else 0.");
  d.defaulted<&S::begin_a>(kA, "Acceleration at its beginning; unset: likewise.");
  d.defaulted<&S::end_v>(kV, "Velocity at its end; unset: likewise, as the next segment has it.");
  d.defaulted<&S::end_a>(kA, "Acceleration at its end; unset: likewise.");
  d.defaulted<&S::sine_share>(between(0, 1), "Sine-constant-cosine combination: share of the way along the sine.");
  d.defaulted<&S::cosine_share>(between(0, 1), "Likewise along the cosine; what is left has constant acceleration.");
  d.defaulted<&S::inflection>(between(0.05, 0.95),
                              "Laws with sines and polynomial_8: share of the length before the acceleration changes "
                              "its sign; other than 0.5 the law is asymmetric.");
  d.rule<&S::inflection>("must be from 0.35 to 0.65 for polynomial_8", [](const S& s) {
    return s.law != Law::kPolynomial8 || (s.inflection >= 0.35 && s.inflection <= 0.65);
  });
  d.rule<&S::cosine_share>("must leave sine_share and cosine_share 1 at most together",
                           [](const S& s) { return s.sine_share + s.cosine_share <= 1; });
}

void describe(Description<CamParams>& d) {
  using P = CamParams;
  d.about("A cam: where the slave is for every place of its master.");
  d.required<&P::name>("How commands call it.");
  d.defaulted<&P::x_unit>("The master's unit, for people.");
  d.defaulted<&P::y_unit>("The slave's unit, for people.");
  d.defaulted<&P::cyclic>("Whether the end goes over into the beginning, raised by the stroke.");
  d.defaulted<&P::interpolation>("What lies between the points.");
  d.defaulted<&P::points>("Points, x growing: 2 to 100,000.");
  d.defaulted<&P::segments>("Segments instead, one behind the other: up to 20,000.");
  d.defaulted<&P::file>("A CSV file of points instead, with columns x, y and perhaps v, a; beside the machine file.");
  d.rule<&P::points>("must be given, or segments, or a file", [](const P& p) { return Sources(p) > 0; });
  d.rule<&P::file>("must be the only one of points, segments and file", [](const P& p) { return Sources(p) < 2; });
}

}  // namespace takt::cam
