// Elementary functions whose results have the same bits on every processor. The C library chooses among several
// implementations by the processor's features, and their last bits differ; these functions use only additions,
// multiplications, divisions and square roots, whose rounding IEEE 754 defines, and are compiled without fused
// operations. The engine and Ruckig use no others (tests/python/test_processors.py).
//
// Errors are below 1.1 ulp unless a function says more (tests/cpp/core/maths_test.cc). Special values are those of C.
// Functions that round exactly in any library stay std::: sqrt, abs, floor, ceil, round, trunc, fmod, remainder, ldexp.
#pragma once

namespace takt::maths {

struct SineCosine {
  double sine;
  double cosine;
};

[[gnu::const]] double Sin(double x) noexcept;         // x in [rad], of any size
[[gnu::const]] double Cos(double x) noexcept;         // x in [rad], of any size
[[gnu::const]] SineCosine SinCos(double x) noexcept;  // the same bits as Sin and Cos; one reduction of x
[[gnu::const]] double Tan(double x) noexcept;         // below 2 ulp
[[gnu::const]] double Asin(double x) noexcept;        // [rad]; nan beyond [-1, 1]
[[gnu::const]] double Acos(double x) noexcept;        // [rad]; nan beyond [-1, 1]
[[gnu::const]] double Atan(double x) noexcept;        // [rad]
[[gnu::const]] double Atan2(double y, double x) noexcept;
[[gnu::const]] double Exp(double x) noexcept;
[[gnu::const]] double Expm1(double x) noexcept;  // exp(x) - 1
[[gnu::const]] double Log(double x) noexcept;
[[gnu::const]] double Log1p(double x) noexcept;  // log(1 + x)
[[gnu::const]] double Sinh(double x) noexcept;   // below 3 ulp
[[gnu::const]] double Cosh(double x) noexcept;   // below 3 ulp
[[gnu::const]] double Atanh(double x) noexcept;  // below 3 ulp
[[gnu::const]] double Cbrt(double x) noexcept;
[[gnu::const]] double Hypot(double x, double y) noexcept;              // below 1.5 ulp
[[gnu::const]] double Power(double base, unsigned exponent) noexcept;  // by repeated multiplication

}  // namespace takt::maths
