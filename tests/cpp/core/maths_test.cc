// EN-35: the elementary functions are ours, made of operations whose rounding is defined. Compared with the C library's
// in long double, whose own errors are a thousandth of the tolerance.
#include "takt/core/maths.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

namespace takt::maths {
namespace {

double Errors(double got, long double wanted) {
  const double near = std::abs(static_cast<double>(wanted));
  const double ulp = std::nextafter(near, INFINITY) - near;
  return static_cast<double>(std::abs(static_cast<long double>(got) - wanted) / ulp);
}

struct Function {
  const char* name;
  double (*ours)(double) noexcept;
  long double (*reference)(long double);
  double begin, end;
  double ulp;
};

constexpr Function kFunctions[] = {
    {"sin", Sin, sinl, -4, 4, 1},
    {"sin, large", Sin, sinl, -1e5, 1e5, 1},
    {"sin, huge", Sin, sinl, -1e18, 1e18, 1},
    {"cos", Cos, cosl, -4, 4, 1},
    {"cos, large", Cos, cosl, -1e5, 1e5, 1},
    {"cos, huge", Cos, cosl, -1e18, 1e18, 1},
    {"tan", Tan, tanl, -1.5, 1.5, 2},
    {"asin", Asin, asinl, -1, 1, 1.1},
    {"acos", Acos, acosl, -1, 1, 1.1},
    {"atan", Atan, atanl, -5, 5, 1.1},
    {"atan, small", Atan, atanl, -0.1, 0.1, 1.1},
    {"exp", Exp, expl, -20, 20, 0.6},
    {"exp, far", Exp, expl, -700, 700, 0.6},
    {"expm1", Expm1, expm1l, -0.5, 0.5, 1.1},
    {"expm1, far", Expm1, expm1l, -30, 100, 1.1},
    {"log", Log, logl, 0.3, 3, 1.1},
    {"log, far", Log, logl, 0, 1e6, 1.1},
    {"log1p", Log1p, log1pl, -0.9, 3, 1.1},
    {"sinh", Sinh, sinhl, -3, 3, 3},
    {"cosh", Cosh, coshl, -3, 3, 3},
    {"atanh", Atanh, atanhl, -0.9, 0.9, 3},
    {"cbrt", Cbrt, cbrtl, -30, 30, 0.7},
    {"cbrt, far", Cbrt, cbrtl, -1e200, 1e200, 0.7},
};

TEST(Maths, IsExactToTheLastDigit) {
  std::mt19937_64 random(35);
  for (const Function& f : kFunctions) {
    double most = 0, at = 0;
    for (int i = 0; i < 20000; ++i) {
      const double x = f.begin + (f.end - f.begin) * static_cast<double>(random() >> 11) * 0x1p-53;
      const double error = Errors(f.ours(x), f.reference(x));
      if (!(error <= most)) most = error, at = x;
    }
    EXPECT_LT(most, f.ulp) << f.name << " at " << at;
  }
}

TEST(Maths, OfTwoArgumentsIsExactToTheLastDigit) {
  std::mt19937_64 random(36);
  double angle = 0, length = 0;
  for (int i = 0; i < 50000; ++i) {
    const double x = static_cast<double>(random() >> 11) * 0x1p-52 - 1,
                 y = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
    angle = std::max(angle, Errors(Atan2(y, x), atan2l(y, x)));
    length = std::max(length, Errors(Hypot(x, y), hypotl(x, y)));
    const SineCosine both = SinCos(1e4 * x);
    ASSERT_TRUE(both.sine == Sin(1e4 * x) && both.cosine == Cos(1e4 * x)) << x;
  }
  EXPECT_LT(angle, 1.1);
  EXPECT_LT(length, 1.5);
}

TEST(Maths, KnowsSpecialValues) {
  const double pi = std::numbers::pi;
  EXPECT_EQ(Sin(0), 0);
  EXPECT_EQ(Cos(0), 1);
  EXPECT_EQ(Sin(pi / 2), 1);
  EXPECT_EQ(Cos(pi), -1);
  EXPECT_EQ(Cos(pi / 2), std::cos(pi / 2));
  EXPECT_TRUE(std::isnan(Sin(INFINITY)));
  EXPECT_EQ(Atan2(1, 1), pi / 4);
  EXPECT_EQ(Atan2(1, 0), pi / 2);
  EXPECT_EQ(Atan2(0, -1), pi);
  EXPECT_EQ(Atan2(-0.0, -1), -pi);
  EXPECT_EQ(Atan2(INFINITY, -INFINITY), 3 * pi / 4);
  EXPECT_TRUE(std::signbit(Atan2(-0.0, 1)));
  EXPECT_EQ(Asin(1), pi / 2);
  EXPECT_EQ(Acos(-1), pi);
  EXPECT_EQ(Acos(1), 0);
  EXPECT_TRUE(std::isnan(Acos(1.1)));
  EXPECT_EQ(Exp(0), 1);
  EXPECT_EQ(Exp(1000), INFINITY);
  EXPECT_EQ(Exp(-1000), 0);
  EXPECT_EQ(Log(1), 0);
  EXPECT_EQ(Log(0), -INFINITY);
  EXPECT_TRUE(std::isnan(Log(-1)));
  for (int i = 1; i < 1000; ++i) ASSERT_EQ(Cbrt(i * i * i), i);
  EXPECT_EQ(Hypot(3, 4), 5);
  EXPECT_EQ(Hypot(3e300, 4e300), 5e300);
  for (const double x : {0.0, 1.0, double{INFINITY}, double{NAN}}) {
    EXPECT_EQ(std::isnan(Hypot(x, NAN)), !std::isinf(x)) << x;
    EXPECT_EQ(std::isnan(Hypot(NAN, x)), !std::isinf(x)) << x;
    EXPECT_TRUE(std::isnan(Atan2(x, NAN)) && std::isnan(Atan2(NAN, x))) << x;
  }
  for (const auto of : {Sin, Tan, Asin, Atan, Expm1, Log1p, Sinh, Atanh, Cbrt}) {
    EXPECT_TRUE(of(-0.0) == 0 && std::signbit(of(-0.0)) && !std::signbit(of(0.0)));
    EXPECT_TRUE(std::isnan(of(NAN)));
  }
  for (const auto of : {Cos, Acos, Exp, Log, Cosh}) EXPECT_TRUE(std::isnan(of(NAN)));
}

}  // namespace
}  // namespace takt::maths
