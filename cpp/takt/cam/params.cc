#include "takt/cam/params.h"

#include "takt/core/describe.h"

namespace takt::cam {

namespace {

constexpr Unit kX{"x", "the master's unit"};
constexpr Unit kY{"y", "the slave's unit"};
constexpr Unit kV{"y/x", "the slave's unit per master's unit"};
constexpr Unit kA{"y/x2", "the slave's unit per master's unit squared"};

}  // namespace

void describe(Enumeration<Interpolation>& e) {
  e.about("What lies between the points of a cam.");
  e.value(Interpolation::kLinear, "linear", "Straight lines; the velocity jumps at the points.");
  e.value(Interpolation::kQuintic, "quintic", "Polynomials of the fifth degree; nothing up to the acceleration jumps.");
  e.value(Interpolation::kCubicSpline, "cubic_spline",
          "Polynomials of the third degree; nothing up to the acceleration jumps. Its ends are natural, or periodic "
          "where the cam is cyclic.");
}

void describe(Description<CamPoint>& d) {
  d.about("A point of a cam. What is not given is free: the curve becomes as smooth as it can.");
  d.required<&CamPoint::x>(kX, "Where the master is.");
  d.required<&CamPoint::y>(kY, "Where the slave is then.");
  d.defaulted<&CamPoint::v>(kV, "Velocity, dy/dx.");
  d.defaulted<&CamPoint::a>(kA, "Acceleration, d2y/dx2; quintic only.");
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
  d.defaulted<&P::file>("A CSV file of points instead, with columns x, y and perhaps v, a; beside the machine file.");
  d.rule<&P::points>("must be given, or a file", [](const P& p) { return !p.points.empty() || !p.file.empty(); });
  d.rule<&P::file>("must not be given together with points",
                   [](const P& p) { return p.points.empty() || p.file.empty(); });
}

}  // namespace takt::cam
