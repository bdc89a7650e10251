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
  e.about("Curve between the points of a cam.");
  e.value(Interpolation::kLinear, "linear", "Straight lines; the velocity jumps at the points.");
  e.value(Interpolation::kQuintic, "quintic", "Polynomials of the fifth degree; continuous up to the acceleration.");
  e.value(Interpolation::kCubicSpline, "cubic_spline",
          "Polynomials of the third degree; the acceleration jumps only where a velocity is given. Its ends are "
          "natural, or periodic if the cam is cyclic.");
  e.value(
      Interpolation::kMonotone, "monotone",
      "Polynomials of the fifth degree that rise and fall only as the points do; continuous up to the acceleration.");
}

void describe(Description<CamPoint>& d) {
  d.about("A point of a cam. Unset derivatives are free: the curve becomes as smooth as possible.");
  d.required<&CamPoint::x>(kX, "Position of the master.");
  d.required<&CamPoint::y>(kY, "Position of the slave.");
  d.defaulted<&CamPoint::v>(kV, "Velocity, dy/dx.");
  d.defaulted<&CamPoint::a>(kA, "Acceleration, d2y/dx2; quintic and monotone only.");
}

void describe(Description<CamPlace>& d) {
  d.about("An end of a segment.");
  d.required<&CamPlace::x>(kX, "Position of the master.");
  d.required<&CamPlace::y>(kY, "Position of the slave.");
}

void describe(Description<CamSegment>& d) {
  using S = CamSegment;
  d.about("A section of a cam with one law of motion.");
  d.defaulted<&S::from>("Beginning; unset: the end of the previous segment; 0, 0 for the first one.");
  d.required<&S::to>("End.");
  d.defaulted<&S::law>("The law of motion.");
  d.defaulted<&S::begin_v>(kV,
                           "Velocity at the beginning; unset: for quintic, task, least_acceleration and least_jerk "
                           "that of the previous segment, else 0.");
  d.defaulted<&S::begin_a>(kA, "Acceleration at the beginning; unset: likewise.");
  d.defaulted<&S::end_v>(kV, "Velocity at the end; unset: likewise, that of the next segment.");
  d.defaulted<&S::end_a>(kA, "Acceleration at the end; unset: likewise.");
  d.defaulted<&S::sine_share>(between(0, 1), "Sine-constant-cosine combination: share of the length along the sine.");
  d.defaulted<&S::cosine_share>(
      between(0, 1),
      "Sine-constant-cosine combination: share of the length along the cosine; the rest has constant acceleration.");
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
  d.about("A cam: the position of a slave over the position of its master.");
  d.required<&P::name>("Name of the cam in commands.");
  d.defaulted<&P::x_unit>("The master's unit, for display.");
  d.defaulted<&P::y_unit>("The slave's unit, for display.");
  d.defaulted<&P::cyclic>("True: the end continues at the beginning, raised by the stroke.");
  d.defaulted<&P::interpolation>("Curve between the points.");
  d.defaulted<&P::points>("Points, x increasing: 2 to 100,000.");
  d.defaulted<&P::segments>("Segments, in order, instead of points: up to 20,000.");
  d.defaulted<&P::file>(
      "A CSV file of points instead, with columns x, y and optionally v, a; relative to the machine file.");
  d.rule<&P::points>("must be given, or segments, or a file", [](const P& p) { return Sources(p) > 0; });
  d.rule<&P::file>("must be the only one of points, segments and file", [](const P& p) { return Sources(p) < 2; });
}

}  // namespace takt::cam
