// Textbook methods (Muller, Elementary Functions): the argument is reduced exactly or in two doubles, the rest is a
// short polynomial whose value is small compared with the exact leading term, so that its rounding hardly matters.
#include "takt/core/maths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "takt/core/maths_constants.h"

namespace takt::maths {
namespace {

__extension__ typedef unsigned __int128 Wide;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kToInteger = 0x1.8p52;  // adding and subtracting it rounds to an integer

std::uint64_t Bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}
double Scale(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}
// Returns 2^exponent x, even if 2^exponent is not representable.
double Scaled(double x, int exponent) {
  if (exponent > 1000) return x * 0x1p1000 * Scale(exponent - 1000);
  if (exponent < -1000) return x * Scale(exponent + 1000) * 0x1p-1000;
  return x * Scale(exponent);
}

// Returns a + b exactly. Requires: |a| >= |b|, or a is 0.
Pair FastSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

Pair Sum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

// Returns a * a exactly, for |a| between 2^-450 and 2^500 (Veltkamp, Dekker).
Pair Square(double a) {
  const double split = 0x1.0000002p27 * a;
  const double high = split - (split - a), low = a - high;
  const double square = a * a;
  return {square, ((high * high - square) + 2 * high * low) + low * low};
}

// --- Sine and cosine ---

// x = quadrant * pi/2 + high + low, |high| <= pi/4 within rounding.
struct Reduced {
  double high;
  double low;
  unsigned quadrant;
};

// Payne and Hanek: of 2/pi times a double only the bits after the point and two before it are needed.
Reduced ReduceLarge(double x) {
  const std::uint64_t bits = Bits(x);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1075;  // |x| = mantissa * 2^exponent
  const std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1} << 52;
  // A window of 192 bits, from two bits before the product's point. The bits before it are whole turns.
  const auto begin = static_cast<unsigned>(exponent + 62);
  const unsigned word = begin / 64, shift = begin % 64;
  const auto window = [&](unsigned i) {
    const std::uint64_t first = kTwoOverPiBits[word + i];
    return shift == 0 ? first : first << shift | kTwoOverPiBits[word + i + 1] >> (64 - shift);
  };
  const Wide low = Wide{mantissa} * window(2), middle = Wide{mantissa} * window(1);
  const Wide upper = middle + (low >> 64);
  const std::uint64_t top = mantissa * window(0) + static_cast<std::uint64_t>(upper >> 64);
  unsigned quadrant = static_cast<unsigned>(top >> 62);
  Wide value = (Wide{top} << 66 | Wide{static_cast<std::uint64_t>(upper)} << 2) | static_cast<std::uint64_t>(low) >> 62;
  const bool down = (value >> 127) != 0;  // to the nearest quadrant
  if (down) {
    value = ~value;
    ++quadrant;
  }
  int zeros = 0;
  while (value != 0 && (value >> 127) == 0) {
    value <<= 1;
    ++zeros;
  }
  const Wide angle = Wide{static_cast<std::uint64_t>(value >> 64)} * kHalfPiBits;  // times 2^(-127 - zeros)
  const double high = static_cast<double>(static_cast<std::uint64_t>(angle >> 75));
  const double rest = static_cast<double>(static_cast<std::uint64_t>(angle >> 22) & ((std::uint64_t{1} << 53) - 1));
  const double unit = Scale(75 - 127 - zeros) * (down ? -1 : 1) * (x < 0 ? -1 : 1);
  return {high * unit, rest * unit * 0x1p-53, x < 0 ? 0 - quadrant : quadrant};
}

Reduced Reduce(double x) {
  const double size = std::abs(x);
  if (size <= 0.78539816339744831) return {x, 0, 0};
  if (size < 1600) {  // Cody and Waite
    const double n = (x * kTwoOverPi + kToInteger) - kToInteger;
    const Pair near = Sum(x - n * kHalfPiParts[0], -(n * kHalfPiParts[1]));
    const double rest = near.low - n * kHalfPiParts[2];
    const double high = near.high + rest;
    return {high, (near.high - high) + rest, static_cast<unsigned>(static_cast<int>(n))};
  }
  if (!std::isfinite(x)) return {kNan, 0, 0};
  return ReduceLarge(x);
}

double Sine(const Reduced& r) {
  if (r.high == 0) return r.high;  // -0 as well
  const double x = r.high, z = x * x;
  const double s = z * (kSine[1] + z * (kSine[2] + z * (kSine[3] + z * (kSine[4] + z * kSine[5]))));
  return x + (x * z * (kSine[0] + s) + r.low * (1 - 0.5 * z));
}

double Cosine(const Reduced& r) {
  const double z = r.high * r.high, half = 0.5 * z, w = 1 - half;
  const double c =
      kCosine[0] + z * (kCosine[1] + z * (kCosine[2] + z * (kCosine[3] + z * (kCosine[4] + z * kCosine[5]))));
  return w + (((1 - w) - half) + (z * z * c - r.high * r.low));
}

// --- Arc tangent ---

// Returns atan((n + n_low) / (d + d_low)), 0 <= n <= d: near a step c it is atan(c) + atan((n - c d) / (d + c n)).
Pair Angle(double n, double n_low, double d, double d_low) {
  const double quotient = n / d;
  if (quotient < 0.125) {
    const double z = quotient * quotient;
    double rest = 1.0 / 17;
    for (int i = 15; i > 1; i -= 2) rest = 1.0 / i - z * rest;
    return {quotient, (n_low - quotient * d_low) / d - quotient * z * rest};
  }
  const int k = static_cast<int>(quotient * kArcTangentSteps + 0.5);
  const double c = static_cast<double>(k) / kArcTangentSteps;
  const double upper = std::bit_cast<double>(Bits(d) & ~std::uint64_t{63});  // products with c are exact
  const double t = (((n - c * upper) - c * (d - upper)) + (n_low - c * d_low)) / (d + c * n);
  const double z = t * t;
  const double rest = t * z * (-1.0 / 3 + z * (1.0 / 5 + z * (-1.0 / 7 + z * (1.0 / 9))));
  return {kArcTangents[k].high, t + (rest + kArcTangents[k].low)};
}

// Returns the angle of (x, y) with x = x_high + x_low and so on, none of them nan, of moderate magnitude and not both
// 0.
double AngleOf(Pair y, Pair x) {
  const bool behind = std::signbit(x.high), below = std::signbit(y.high);
  if (behind) x = {-x.high, -x.low};
  if (below) y = {-y.high, -y.low};
  const bool steep = y.high > x.high;
  const Pair a = steep ? Angle(x.high, x.low, y.high, y.low) : Angle(y.high, y.low, x.high, x.low);
  double angle = a.high + a.low;
  if (steep || behind) {
    const double times = steep ? 1 : 2, sign = steep == behind ? 1 : -1;
    const Pair sum = FastSum(times * kHalfPi.high, sign * a.high);
    angle = sum.high + ((sum.low + times * kHalfPi.low) + sign * a.low);
  }
  return below ? -angle : angle;
}

// Returns sqrt(1 - x^2) for |x| < 1, in two doubles.
Pair OtherLeg(double x) {
  const Pair square = std::abs(x) > 0x1p-400 ? Square(x) : Pair{0, 0};
  const Pair rest = FastSum(1, -square.high);
  const double low = rest.low - square.low;
  const double root = std::sqrt(rest.high + low);
  if (root == 0) return {0, 0};
  const Pair again = Square(root);
  return {root, ((rest.high - again.high) - again.low + low) / (2 * root)};
}

// --- Exponentials ---

// exp(x) = 2^power (high + low) for |x| < 800.
struct Exponential {
  int power;
  double high;
  double low;
};

Exponential ExponentialOf(double x) {
  const double steps = (x * kPerStep + kToInteger) - kToInteger;
  const int k = static_cast<int>(steps), power = k >= 0 ? k / kPowerSteps : -((kPowerSteps - 1 - k) / kPowerSteps);
  const Pair& root = kPowersOfTwo[k - power * kPowerSteps];
  const double near = x - steps * kStepHigh, low = steps * kStepLow;
  const double r = near - low, rest = (near - r) - low;
  const double p = r + (r * r * (0.5 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 + r * (1.0 / 720))))) + rest);
  return {power, root.high, root.low + root.high * p};
}

// Returns log(2^k (1 + f + low)), with 1 + f from sqrt(1/2) to sqrt(2). With s = f / (2 + f): log(1 + f) = f - (f^2/2 -
// s (f^2/2 + z R)).
double LogarithmOf(int k, double f, double low) {
  const double s = f / (2 + f), z = s * s, half = 0.5 * f * f;
  double rest = kLogarithm[6];
  for (int i = 6; i-- > 0;) rest = kLogarithm[i] + z * rest;
  const double n = k;
  const Pair sum = Sum(n * kLn2High, f);
  return sum.high + (sum.low - (half - (s * (half + z * rest) + (n * kLn2Low + low))));
}

// For positive, finite x: returns the exponent and f, with x = 2^exponent (1 + f), 1 + f from sqrt(1/2) to sqrt(2).
std::pair<int, double> Split(double x) {
  int exponent = 0;
  if (x < 0x1p-1000) {
    x *= 0x1p54;
    exponent = -54;
  }
  const std::uint64_t bits = Bits(x);
  exponent += static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1023} << 52);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++exponent;
  }
  return {exponent, m - 1};
}

}  // namespace

SineCosine SinCos(double x) noexcept {
  if (x == 0) return {x, 1};  // most poses are not rotated about all axes
  const Reduced r = Reduce(x);
  const double s = Sine(r), c = Cosine(r);
  switch (r.quadrant & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double Sin(double x) noexcept {
  const Reduced r = Reduce(x);
  const double value = (r.quadrant & 1) != 0 ? Cosine(r) : Sine(r);
  return (r.quadrant & 2) != 0 ? -value : value;
}

double Cos(double x) noexcept {
  const Reduced r = Reduce(x);
  const double value = (r.quadrant & 1) != 0 ? Sine(r) : Cosine(r);
  return ((r.quadrant + 1) & 2) != 0 ? -value : value;
}

double Tan(double x) noexcept {
  const SineCosine of = SinCos(x);
  return of.sine / of.cosine;
}

double Asin(double x) noexcept {
  if (!(std::abs(x) <= 1)) return kNan;
  return x == 0 ? x : AngleOf({x, 0}, OtherLeg(x));
}

double Acos(double x) noexcept {
  if (!(std::abs(x) <= 1)) return kNan;
  return AngleOf(OtherLeg(x), {x, 0});
}

double Atan(double x) noexcept {
  return Atan2(x, 1);
}

double Atan2(double y, double x) noexcept {
  if (std::isnan(x) || std::isnan(y)) return kNan;
  double more = std::abs(x), less = std::abs(y);
  if (less > more) std::swap(more, less);
  if (more == 0) return std::copysign(std::signbit(x) ? 2 * kHalfPi.high : 0, y);
  if (std::isinf(more)) {
    x = std::copysign(std::isinf(x) ? 1 : 0, x);
    y = std::copysign(std::isinf(y) ? 1 : 0, y);
  } else if (more > 0x1p900) {
    x *= 0x1p-200;
    y *= 0x1p-200;
  } else if (more < 0x1p-800) {
    x *= 0x1p200;
    y *= 0x1p200;
  }
  return AngleOf({y, 0}, {x, 0});
}

double Exp(double x) noexcept {
  if (!(x < 710)) return x >= 710 ? kInfinity : x;
  if (x < -746) return 0;
  const Exponential e = ExponentialOf(x);
  return Scaled(e.high + e.low, e.power);
}

double Expm1(double x) noexcept {
  if (!(x < 710)) return x >= 710 ? kInfinity : x;
  if (x < -50) return -1;
  if (std::abs(x) < 0x1p-60) return x;
  if (std::abs(x) < 0.125) {
    double rest = 1;
    for (int i = 11; i > 2; --i) rest = 1 + x / i * rest;
    return x + 0.5 * x * x * rest;
  }
  const Exponential e = ExponentialOf(x);
  if (e.power > 60) return Scaled(e.high + e.low, e.power);
  const double scale = Scale(e.power);
  const Pair high = Sum(scale * e.high, -1);
  return high.high + (high.low + scale * e.low);
}

double Log(double x) noexcept {
  if (!(x > 0)) return x == 0 ? -kInfinity : kNan;
  if (std::isinf(x)) return x;
  const auto [k, f] = Split(x);
  return LogarithmOf(k, f, 0);
}

double Log1p(double x) noexcept {
  if (!(x > -1)) return x == -1 ? -kInfinity : kNan;
  if (std::isinf(x) || std::abs(x) < 0x1p-60) return x;
  if (x > -0.29 && x < 0.41) return LogarithmOf(0, x, 0);
  const Pair sum = Sum(1, x);
  const auto [k, f] = Split(sum.high);
  return LogarithmOf(k, f, sum.low / sum.high);
}

double Sinh(double x) noexcept {
  if (std::abs(x) < 40) return 0.5 * (Expm1(x) - Expm1(-x));
  const double root = Exp(0.5 * std::abs(x));
  return std::copysign(0.5 * root * root, x);
}

double Cosh(double x) noexcept {
  const double size = std::abs(x);
  if (size < 40) return 0.5 * (Exp(size) + Exp(-size));
  const double root = Exp(0.5 * size);
  return 0.5 * root * root;
}

double Atanh(double x) noexcept {
  const double size = std::abs(x);
  return std::copysign(0.5 * Log1p(2 * size / (1 - size)), x);
}

double Cbrt(double x) noexcept {
  if (x == 0 || !std::isfinite(x)) return x;
  double size = std::abs(x);
  int exponent = 0;
  if (size < 0x1p-1000) {
    size *= 0x1p54;
    exponent = -18;
  }
  const std::uint64_t bits = Bits(size);
  const int binary = static_cast<int>(bits >> 52) - 1023 + 1200, third = binary / 3 - 400, rest = binary % 3;
  const double m = std::bit_cast<double>((bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1023} << 52);
  double root = kCubeRoot[6];
  for (int i = 6; i-- > 0;) root = kCubeRoot[i] + m * root;
  const double radicand = m * Scale(rest);
  // Rounded to 26 bits, whose square is exact; then Halley's step, which leaves the cube of an error of 1e-6.
  const double near = std::bit_cast<double>(Bits(root * kCubeRoots[rest]) & ~((std::uint64_t{1} << 27) - 1));
  const double other = radicand / (near * near);
  const double step = near * ((other - near) / (2 * near + other));
  return std::copysign((near + step) * Scale(third + exponent), x);
}

double Hypot(double x, double y) noexcept {
  const double more = std::max(std::abs(x), std::abs(y)), less = std::min(std::abs(x), std::abs(y));
  if (std::isinf(x) || std::isinf(y)) return kInfinity;
  if (std::isnan(x) || std::isnan(y)) return kNan;
  if (more > 0x1p500)
    return std::sqrt((more * 0x1p-600) * (more * 0x1p-600) + (less * 0x1p-600) * (less * 0x1p-600)) * 0x1p600;
  if (more < 0x1p-450)
    return std::sqrt((more * 0x1p600) * (more * 0x1p600) + (less * 0x1p600) * (less * 0x1p600)) * 0x1p-600;
  return std::sqrt(more * more + less * less);
}

double Power(double base, unsigned exponent) noexcept {
  double power = 1;
  for (double square = base; exponent != 0; exponent >>= 1, square *= square) {
    if ((exponent & 1) != 0) power *= square;
  }
  return power;
}

}  // namespace takt::maths
