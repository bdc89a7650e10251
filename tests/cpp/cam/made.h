// Cams for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "takt/cam/build.h"

namespace takt::cam {

inline CamParams Points(Interpolation interpolation, std::vector<CamPoint> points, bool cyclic = false) {
  CamParams params;
  params.name = "cam";
  params.interpolation = interpolation;
  params.cyclic = cyclic;
  params.points = std::move(points);
  return params;
}

inline CamParams Segments(std::vector<CamSegment> segments, bool cyclic = false) {
  CamParams params;
  params.name = "cam";
  params.cyclic = cyclic;
  params.segments = std::move(segments);
  return params;
}

inline CamSegment To(double x, double y, Law law) {
  CamSegment segment;
  segment.to = {x, y};
  segment.law = law;
  return segment;
}

inline Table Made(const CamParams& params) {
  Built built = Build(params);
  for (const Finding& error : built.errors) ADD_FAILURE() << error.path << ": " << error.message;
  return std::move(built.table.value());
}

// Returns "path: message" of each.
inline std::vector<std::string> Texts(const std::vector<Finding>& findings) {
  std::vector<std::string> texts;
  for (const Finding& finding : findings) texts.push_back(finding.path + ": " + finding.message);
  return texts;
}

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double Real(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  std::size_t Whole(std::size_t below) { return std::uniform_int_distribution<std::size_t>(0, below - 1)(engine_); }
  bool Flip() { return Whole(2) == 0; }

 private:
  std::mt19937 engine_;
};

// Points whose distances differ by a factor of a hundred; some velocities and accelerations given.
inline CamParams RandomPoints(Dice& dice, Interpolation interpolation) {
  std::vector<CamPoint> points;
  double x = dice.Real(-500, 500);
  const std::size_t n = 2 + dice.Whole(30);
  const bool cyclic = dice.Flip();
  for (std::size_t i = 0; i < n; ++i) {
    CamPoint point{x, dice.Real(-100, 100)};
    const bool inside = i + 1 < n || !cyclic;  // a cyclic cam uses its first point's for both
    const bool seam = cyclic && i == 0 && interpolation == Interpolation::kCubicSpline;  // its acceleration would jump
    if (interpolation != Interpolation::kLinear && inside && !seam && dice.Whole(4) == 0) point.v = dice.Real(-5, 5);
    if (interpolation == Interpolation::kQuintic && inside && dice.Whole(4) == 0) point.a = dice.Real(-1, 1);
    points.push_back(point);
    x += std::pow(10, dice.Real(-0.5, 1.5));
  }
  return Points(interpolation, points, cyclic);
}

// Laws of all kinds, with lines only where a quintic leads into them.
inline CamParams RandomSegments(Dice& dice) {
  constexpr Law kLaws[] = {
      Law::kDwell,   Law::kLine,     Law::kParabola,      Law::kModifiedTrapezoid, Law::kModifiedSine,
      Law::kCycloid, Law::kHarmonic, Law::kPolynomial345, Law::kPolynomial4567,    Law::kSineConstantCosine};
  std::vector<CamSegment> segments;
  double x = 0, y = 0;
  const std::size_t n = 1 + dice.Whole(6);
  for (std::size_t i = 0; i < n; ++i) {
    for (const bool quintic : {true, false}) {
      CamSegment s;
      s.law = quintic ? Law::kQuintic : kLaws[dice.Whole(std::size(kLaws))];
      x += dice.Real(1, 50);
      if (s.law != Law::kDwell) y += dice.Real(-100, 100);
      s.to = {x, y};
      if (s.law == Law::kSineConstantCosine) {
        s.sine_share = dice.Real(0, 1);
        s.cosine_share = dice.Real(0, 1 - s.sine_share);
      }
      segments.push_back(s);
    }
  }
  return Segments(segments);
}

inline CamParams RandomCam(Dice& dice) {
  switch (dice.Whole(4)) {
    case 0:
      return RandomPoints(dice, Interpolation::kLinear);
    case 1:
      return RandomPoints(dice, Interpolation::kQuintic);
    case 2:
      return RandomPoints(dice, Interpolation::kCubicSpline);
    default:
      return RandomSegments(dice);
  }
}

}  // namespace takt::cam
