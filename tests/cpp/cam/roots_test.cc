#include "takt/cam/roots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "made.h"

namespace takt::cam {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<double> All(const Curve& curve, double h) {
  const Roots roots = RootsOf(curve, h);
  return {roots.begin(), roots.end()};
}

// Returns the polynomial with these zeros.
Curve Product(const std::vector<double>& zeros, double factor) {
  Curve curve{.c = {factor}};
  for (const double zero : zeros) {
    for (std::size_t i = 7; i > 0; --i) curve.c[i] = curve.c[i - 1] - zero * curve.c[i];
    curve.c[0] *= -zero;
  }
  return curve;
}

TEST(Roots, OfSimpleCurves) {
  EXPECT_THAT(All({.c = {1}}, 5), IsEmpty());
  EXPECT_THAT(All({}, 5), ElementsAre(0, 5));  // zero everywhere
  EXPECT_THAT(All({.c = {-2, 1}}, 5), ElementsAre(2));
  EXPECT_THAT(All({.c = {-2, 1}}, 1), IsEmpty());
  EXPECT_THAT(All({.c = {-4, 0, 1}}, 5), ElementsAre(DoubleEq(2)));
  EXPECT_THAT(All({.c = {4, -4, 1}}, 5), ElementsAre(2));  // touches only
  EXPECT_THAT(All({.c = {0, -1, 1}}, 1), ElementsAre(0, 1));
  const double pi = std::numbers::pi;
  EXPECT_THAT(All({{}, 2, 1, 0}, 7), ElementsAre(0, DoubleEq(pi), DoubleEq(2 * pi)));
  EXPECT_THAT(All({.c = {-1}, .amplitude = 2, .frequency = 1, .phase = 0}, 6),
              ElementsAre(DoubleEq(pi / 6), DoubleEq(5 * pi / 6)));
}

// Every zero of a polynomial is found, and nothing else: random zeros at least 0.02 apart.
TEST(Roots, FindAllOfAPolynomial) {
  Dice dice(1);
  for (int run = 0; run < 3000; ++run) {
    std::vector<double> zeros;
    const std::size_t n = 1 + dice.Whole(7);
    while (zeros.size() < n) {
      const double zero = dice.Real(-0.3, 1.3);
      const auto near = [&](double other) { return std::abs(other - zero) < 0.02; };
      if (std::none_of(zeros.begin(), zeros.end(), near)) zeros.push_back(zero);
    }
    std::sort(zeros.begin(), zeros.end());
    std::vector<double> inside;
    std::copy_if(zeros.begin(), zeros.end(), std::back_inserter(inside), [](double z) { return z >= 0 && z <= 1; });
    const std::vector<double> found = All(Product(zeros, dice.Real(-5, 5)), 1);
    ASSERT_EQ(found.size(), inside.size()) << run;
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], inside[i], 1e-7);
  }
}

// A sine with a parabola: each change of sign in a dense sampling is found.
TEST(Roots, FindAllOfASine) {
  Dice dice(2);
  for (int run = 0; run < 500; ++run) {
    const Curve curve{
        {dice.Real(-1, 1), dice.Real(-1, 1), dice.Real(-1, 1)}, dice.Real(-2, 2), dice.Real(0.1, 6), dice.Real(-4, 4)};
    const std::vector<double> found = All(curve, 1);
    for (const double x : found) ASSERT_NEAR(curve.At(x), 0, 1e-13);
    double before = curve.At(0);
    for (int i = 1; i <= 1000; ++i) {
      const double x = i / 1000.0, f = curve.At(x);
      if (f * before < 0) {
        const auto between = [&](double root) { return root >= x - 0.001 && root <= x; };
        ASSERT_TRUE(std::any_of(found.begin(), found.end(), between)) << run << " " << x;
      }
      before = f;
    }
  }
}

}  // namespace
}  // namespace takt::cam
