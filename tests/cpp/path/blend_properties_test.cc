// GR-22: properties of a blend at every corner.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../core/trials.h"
#include "paths.h"
#include "takt/core/angle.h"
#include "takt/path/blend.h"

namespace takt::path {
namespace {

using testing::Kind;
using testing::kKinds;
using testing::Length;
using testing::MakeCorner;
using testing::PeakCurvature;
using testing::Random;
using testing::RandomCorner;
using testing::StepBetween;

class Corners : public ::testing::TestWithParam<std::pair<Kind, Kind>> {};

std::vector<std::pair<Kind, Kind>> Pairs() {
  std::vector<std::pair<Kind, Kind>> pairs;
  for (const Kind first : kKinds) {
    for (const Kind second : kKinds) pairs.emplace_back(first, second);
  }
  return pairs;
}
INSTANTIATE_TEST_SUITE_P(Kinds, Corners, ::testing::ValuesIn(Pairs()));

// Angles from 0.1 to 179 deg with many near both ends, lengths from 1e-3 to 1e4 mm.
RandomCorner SomeCorner(Random& random, int trial, const std::pair<Kind, Kind>& kinds) {
  const double choice[] = {random.Between(0.1, 179), random.Size(0.1, 10), 180 - random.Size(1, 20)};
  return MakeCorner(random, kinds.first, kinds.second, choice[trial % 3] * kDegree, random.Size(3e-3, 3e3));
}

struct Blended {
  double distance = 0;
  Segment blend;
};

// With the distance for a deviation of that share of the shorter segment.
Blended BlendOf(const RandomCorner& c, double deviation) {
  Blended out;
  out.distance = CornerDistance(c.first, c.second, deviation, HalfOf(c.first, c.second));
  EXPECT_GT(out.distance, 0);
  EXPECT_LE(out.distance, std::min(c.first.length, c.second.length) / 2);
  EXPECT_EQ(Blend(c.first, c.first.length - out.distance, c.second, out.distance, out.blend), Problem::kNone);
  return out;
}

// The distance from a point to a nearby segment, by a fine scan.
double DistanceTo(const Segment& segment, const KDL::Vector& p, double from, double to) {
  const auto at = [&](double s) { return Length(At(segment, s).p.p - p); };
  constexpr int kPlaces = 60;
  double best = from;
  for (int i = 0; i <= kPlaces; ++i) {
    const double s = from + (to - from) * i / kPlaces;
    if (at(s) < at(best)) best = s;
  }
  double lower = std::max(from, best - (to - from) / kPlaces), upper = std::min(to, best + (to - from) / kPlaces);
  for (int i = 0; i < 40; ++i) {
    const double third = (upper - lower) / 3;
    (at(lower + third) < at(upper - third) ? upper -= third : lower += third);
  }
  return at((lower + upper) / 2);
}

// GR-22: the curvature is continuous to 1e-6 of its maximum, and so is the rate of the orientation; nothing else jumps.
TEST_P(Corners, PropertyNothingJumps) {
  Random random(21);
  for (int i = 0; i < Trials(60); ++i) {
    const RandomCorner c = SomeCorner(random, i, GetParam());
    const auto [d, blend] = BlendOf(c, std::min(c.first.length, c.second.length) * random.Size(1e-5, 1));
    const double peak = PeakCurvature(blend);
    double turning = 0, turning_change = 0, rate = 0, change = 0;
    for (int n = 0; n <= 100; ++n) {
      const MovingFrame f = At(blend, blend.length * n / 100);
      const AuxiliaryMotion a = AuxiliariesAt(blend, blend.length * n / 100);
      turning = std::max(turning, Length(f.M.w));
      turning_change = std::max(turning_change, Length(f.M.dw));
      rate = std::max({rate, std::abs(a.velocity[0]), std::abs(a.velocity[2])});
      change = std::max({change, std::abs(a.acceleration[0]), std::abs(a.acceleration[2])});
    }
    const auto in = StepBetween(c.first, c.first.length - d, blend, 0);
    const auto out = StepBetween(blend, blend.length, c.second, d);
    for (const auto& step : {in, out}) {
      ASSERT_LT(step.place, 1e-11) << "trial " << i;
      ASSERT_LT(step.tangent, 1e-11) << "trial " << i;
      ASSERT_LT(step.curvature, 1e-6 * peak) << "trial " << i;
      // Orientations are rounded, by 1e-14 rad at most, seen over the length of the blend.
      ASSERT_LT(step.orientation, 1e-13) << "trial " << i;
      ASSERT_LT(step.turning, 1e-9 * turning + 1e-13 / blend.length) << "trial " << i;
      ASSERT_LT(step.turning_change, 1e-6 * turning_change + 1e-12 / (blend.length * blend.length)) << "trial " << i;
      ASSERT_LT(step.auxiliary, 1e-11) << "trial " << i;
      ASSERT_LT(step.auxiliary_rate, 1e-9 * rate + 1e-12 / blend.length) << "trial " << i;
      ASSERT_LT(step.auxiliary_change, 1e-6 * change + 1e-11 / (blend.length * blend.length)) << "trial " << i;
    }
  }
}

// GR-22: the blend comes as close to the corner as is allowed, and is nowhere further from the path.
TEST_P(Corners, PropertyStaysWithinTheDeviation) {
  Random random(22);
  for (int i = 0; i < Trials(30); ++i) {
    const RandomCorner c = SomeCorner(random, i, GetParam());
    const double deviation = std::min(c.first.length, c.second.length) * random.Size(1e-5, 1);
    const auto [d, blend] = BlendOf(c, deviation);
    const double corner = DistanceTo(blend, c.place.frame.p, 0, blend.length);
    double path = 0;
    for (int n = 0; n <= 200; ++n) {
      const KDL::Vector p = At(blend, blend.length * n / 200).p.p;
      const double before = DistanceTo(c.first, p, c.first.length - std::min(2 * d, c.first.length), c.first.length);
      path = std::max(path, std::min(before, DistanceTo(c.second, p, 0, std::min(2 * d, c.second.length))));
    }
    const double found = Deviation(c.first, c.second, blend);
    ASSERT_LT(corner, deviation * (1 + 1e-9) + 1e-12) << "trial " << i;
    ASSERT_LT(path, deviation * (1 + 1e-9) + 1e-12) << "trial " << i;
    ASSERT_LT(found, deviation * (1 + 1e-9) + 1e-12) << "trial " << i;
    ASSERT_GT(found, std::max(corner, path) * (1 - 0.01)) << "trial " << i;
  }
}

// GR-22: no loop: the curve moves forward along the sum of the tangents of both segments, and turns by no more than it
// has to: the corner, and the turns of the segments themselves.
TEST_P(Corners, PropertyMakesNoLoop) {
  Random random(23);
  for (int i = 0; i < Trials(60); ++i) {
    const RandomCorner c = SomeCorner(random, i, GetParam());
    const auto [d, blend] = BlendOf(c, std::min(c.first.length, c.second.length) * random.Size(1e-5, 1));
    const KDL::Vector on = At(blend, 0).p.v + At(blend, blend.length).p.v;
    double turned = 0;
    KDL::Vector last = At(blend, 0).p.v;
    constexpr int kPlaces = 1000;
    for (int n = 1; n <= kPlaces; ++n) {
      const KDL::Vector tangent = At(blend, blend.length * n / kPlaces).p.v;
      ASSERT_GT(KDL::dot(tangent, on), 0) << "trial " << i;
      turned += Length(tangent - last);
      last = tangent;
    }
    double own = 0;
    for (int n = 0; n < 100; ++n) {
      own += d / 100 * Length(At(c.first, c.first.length - d * n / 100).p.dv);
      own += d / 100 * Length(At(c.second, d * n / 100).p.dv);
    }
    ASSERT_LT(turned, c.angle + 1.5 * own + 0.01) << "trial " << i;
  }
}

}  // namespace
}  // namespace takt::path
