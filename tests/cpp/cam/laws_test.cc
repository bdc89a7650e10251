// CAM-02: peak factors against VDI 2143 and the closed forms of the textbooks (Norton, "Cam Design and Manufacturing
// Handbook", tables of the SCCA family and of the polynomials).
#include "takt/cam/laws.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "made.h"
#include "takt/core/describe.h"

namespace takt::cam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kClosedForm = 1e-6;  // relative

struct Case {
  Law law;
  double velocity, acceleration, jerk;    // closed forms
  double vdi_velocity, vdi_acceleration;  // as printed, two decimals
};

const Case kCases[] = {
    {Law::kParabola, 2, 4, kInfinite, 2.00, 4.00},
    {Law::kHarmonic, kPi / 2, kPi* kPi / 2, kInfinite, 1.57, 4.93},
    {Law::kCycloid, 2, 2 * kPi, 4 * kPi* kPi, 2.00, 6.28},
    {Law::kModifiedTrapezoid, 2, 8 * kPi / (2 + kPi), 32 * kPi* kPi / (2 + kPi), 2.00, 4.89},
    {Law::kModifiedSine, 4 * kPi / (4 + kPi), 4 * kPi* kPi / (4 + kPi), 16 * kPi* kPi* kPi / (4 + kPi), 1.76, 5.53},
    {Law::kPolynomial345, 15.0 / 8, 10 / std::sqrt(3.0), 60, 1.88, 5.77},
    {Law::kPolynomial4567, 35.0 / 16, 84 * std::sqrt(5.0) / 25, 52.5, 2.19, 7.51},
};

TEST(Laws, HaveTheirPeakFactors) {
  for (const Case& c : kCases) {
    const std::string name(TypeOf<Law>().FindEnumerator(static_cast<std::int64_t>(c.law))->name);
    SCOPED_TRACE(name);
    const PeakFactors f = PeakFactorsOf(c.law);
    EXPECT_NEAR(f.velocity, c.velocity, kClosedForm * c.velocity);
    EXPECT_NEAR(f.acceleration, c.acceleration, kClosedForm * c.acceleration);
    if (std::isinf(c.jerk)) {
      EXPECT_TRUE(std::isinf(f.jerk));
    } else {
      EXPECT_NEAR(f.jerk, c.jerk, kClosedForm * c.jerk);
    }
    EXPECT_NEAR(f.velocity, c.vdi_velocity, 0.0051);
    EXPECT_NEAR(f.acceleration, c.vdi_acceleration, 0.0051);
  }
  EXPECT_EQ(PeakFactorsOf(Law::kLine).velocity, 1);
  EXPECT_EQ(PeakFactorsOf(Law::kLine).acceleration, 0);
}

// The whole family: Norton's closed forms for any shares.
TEST(Laws, SineConstantCosineHasItsFactors) {
  Dice dice(1);
  for (int run = 0; run < 500; ++run) {
    const double b = dice.Real(0.01, 1), d = dice.Real(0, 1 - b), c = 1 - b - d;
    const PeakFactors f = PeakFactorsOf(Law::kSineConstantCosine, b, d);
    const double a = 4 * kPi * kPi / ((kPi * kPi - 8) * (b * b - d * d) - 2 * kPi * (kPi - 2) * b + kPi * kPi);
    EXPECT_NEAR(f.acceleration, a, kClosedForm * a);
    EXPECT_NEAR(f.velocity, a * (b / kPi + c / 2 + d / kPi), kClosedForm * f.velocity);
    EXPECT_NEAR(f.jerk, a * kPi / std::min(b, d), kClosedForm * f.jerk) << b << " " << d;
  }
}

// Each law leads from (0, 0) to (1, 1) from rest to rest, is point-symmetric, and has no jump in y and y'.
TEST(Laws, GoFromRestToRest) {
  for (const Case& c : kCases) {
    const Table table = Made(Segments({To(1, 1, c.law)}));
    EXPECT_NEAR(table.At(0).y, 0, 1e-15);
    EXPECT_NEAR(table.At(1).y, 1, 1e-14);
    EXPECT_NEAR(table.At(0).dy, 0, 1e-14);
    EXPECT_NEAR(table.At(1).dy, 0, 1e-13);
    EXPECT_NEAR(table.At(0.5).y, 0.5, 1e-14);
    for (double x = 0; x <= 0.5; x += 1.0 / 64) {
      EXPECT_NEAR(table.At(x).y + table.At(1 - x).y, 1, 1e-14);
      EXPECT_NEAR(table.At(x).dy, table.At(1 - x).dy, 1e-13);
    }
    for (std::size_t i = 1; i < table.size(); ++i) {
      const double h = table.EndOf(i - 1) - table.BeginOf(i - 1);
      const Value before = ValueOf(table.CurveOf(i - 1), h), behind = ValueOf(table.CurveOf(i), 0);
      EXPECT_NEAR(before.y, behind.y, 1e-14);
      EXPECT_NEAR(before.dy, behind.dy, 1e-13);
    }
  }
}

// Intermediate positions, from the formulas as printed (not by integration).
TEST(Laws, FollowThePrintedFormulas) {
  const Table cycloid = Made(Segments({To(1, 1, Law::kCycloid)}));
  const Table harmonic = Made(Segments({To(1, 1, Law::kHarmonic)}));
  const Table parabola = Made(Segments({To(1, 1, Law::kParabola)}));
  const Table trapezoid = Made(Segments({To(1, 1, Law::kModifiedTrapezoid)}));
  const Table sine = Made(Segments({To(1, 1, Law::kModifiedSine)}));
  for (double z = 0; z <= 0.5; z += 1.0 / 128) {
    EXPECT_NEAR(cycloid.At(z).y, z - std::sin(2 * kPi * z) / (2 * kPi), 1e-14);
    EXPECT_NEAR(harmonic.At(z).y, (1 - std::cos(kPi * z)) / 2, 1e-14);
    EXPECT_NEAR(parabola.At(z).y, 2 * z * z, 1e-14);
    if (z <= 0.125) {
      EXPECT_NEAR(trapezoid.At(z).y, 1 / (2 + kPi) * (2 * z - std::sin(4 * kPi * z) / (2 * kPi)), 1e-14);
      EXPECT_NEAR(sine.At(z).y, 1 / (4 + kPi) * (kPi * z - std::sin(4 * kPi * z) / 4), 1e-14);
    } else {
      EXPECT_NEAR(sine.At(z).y, 1 / (4 + kPi) * (2 + kPi * z - 9.0 / 4 * std::sin((4 * kPi * z + kPi) / 3)), 1e-14);
    }
  }
}

}  // namespace
}  // namespace takt::cam
