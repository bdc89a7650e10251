#include "takt/cam/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "../core/allocations.h"
#include "made.h"
#include "takt/core/describe.h"
#include "takt/core/verify.h"

namespace takt::cam {
namespace {

TEST(CamParams, AreDescribed) {
  EXPECT_THAT(Verify(TypeOf<CamParams>()), testing::IsEmpty());
}

// CAM-01: straight lines.
TEST(Table, ConnectsPointsWithStraightLines) {
  const Table table = Made(Points(Interpolation::kLinear, {{0, 1}, {10, 21}, {30, 11}}));
  EXPECT_EQ(table.begin(), 0);
  EXPECT_EQ(table.end(), 30);
  EXPECT_EQ(table.length(), 30);
  EXPECT_EQ(table.stroke(), 10);
  EXPECT_EQ(table.At(5), (Value{11, 2, 0, 0}));
  EXPECT_EQ(table.At(20), (Value{16, -0.5, 0, 0}));
  EXPECT_EQ(table.At(10), (Value{21, -0.5, 0, 0}));  // the piece after the joint
  EXPECT_EQ(table.At(-1), (Value{1, 2, 0, 0}));
  EXPECT_EQ(table.At(31), (Value{11, -0.5, 0, 0}));
  EXPECT_EQ(table.At(NAN), table.At(0));
}

// CAM-71: a table keeps its source.
TEST(Table, KeepsItsSource) {
  const Table table = Made(Points(Interpolation::kLinear, {{0, 1}, {10, 21}}, true));
  EXPECT_EQ(table.name(), "cam");
  EXPECT_TRUE(table.cyclic());
  EXPECT_EQ(table.source().points.size(), 2u);
  EXPECT_EQ(table.size(), 1u);
  EXPECT_EQ(table.CurveOf(0), (Curve{.c = {1, 2}}));
  const CamParams segments = Segments({To(10, 5, Law::kCycloid)});
  EXPECT_EQ(Made(segments).source().segments.front().law, Law::kCycloid);
}

// CAM-21: rounding inside the last piece does not enter the stroke, which accumulates over turns.
TEST(Table, HasTheStrokeOfItsSource) {
  Dice dice(4);
  for (int run = 0; run < 200; ++run) {
    CamParams params = RandomCam(dice);
    double& last = params.segments.empty() ? params.points.back().y : params.segments.back().to.y;
    if (!params.segments.empty() && params.segments.back().law == Law::kDwell) continue;
    const double first = Made(params).At(-1e300).y;
    last = first + 0.1;
    const Built built = Build(params);
    if (!built.table) continue;
    ASSERT_EQ(built.table->stroke(), last - first);
  }
}

// CAM-04: the piece is found for any distribution of points: even, clustered, at distances a million times apart.
TEST(Table, FindsThePieceOfEveryX) {
  Dice dice(1);
  for (int run = 0; run < 200; ++run) {
    std::vector<CamPoint> points;
    double x = dice.Real(-1e4, 1e4);
    const double spread = dice.Real(0, 6);
    const std::size_t n = 2 + dice.Whole(300);
    for (std::size_t i = 0; i < n; ++i) {
      points.push_back({x, dice.Real(-1, 1)});
      x = std::max(std::nextafter(x, 1e9), x + std::pow(10, dice.Real(-spread, 0)));
    }
    const Table table = Made(Points(Interpolation::kLinear, points));
    ASSERT_EQ(table.size(), n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double begin = points[i].x, end = points[i + 1].x;
      ASSERT_EQ(table.PieceAt(begin), i);
      ASSERT_EQ(table.PieceAt(std::nextafter(end, begin)), i);
      ASSERT_EQ(table.PieceAt(std::clamp(dice.Real(begin, end), begin, std::nextafter(end, begin))), i);
      ASSERT_EQ(table.At(begin).y, points[i].y);
    }
    ASSERT_EQ(table.PieceAt(points.back().x), n - 2);
  }
}

// EN-06: a look-up allocates nothing, with any law.
TEST(Table, AllocatesNothing) {
  Dice dice(2);
  for (int run = 0; run < 20; ++run) {
    const Table table = Made(RandomCam(dice));
    const long before = AllocationsOfThisThread();
    double sum = 0;
    for (int i = 0; i <= 100; ++i) sum += table.At(table.begin() + table.length() * i / 100).y;
    EXPECT_EQ(AllocationsOfThisThread(), before);
    EXPECT_TRUE(std::isfinite(sum));
  }
}

// At agrees with the pieces, in value and all derivatives.
TEST(Table, AgreesWithItsPieces) {
  Dice dice(3);
  for (int run = 0; run < 200; ++run) {
    const Table table = Made(RandomCam(dice));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double d = dice.Real(0, 0.999) * (table.EndOf(i) - table.BeginOf(i));
      const double x = table.BeginOf(i) + d;
      const Value expected = ValueOf(table.CurveOf(i), x - table.BeginOf(i));
      const Value found = table.At(x);
      ASSERT_NEAR(found.y, expected.y, 1e-11 * (1 + std::abs(expected.y)));
      ASSERT_NEAR(found.dy, expected.dy, 1e-10 * (1 + std::abs(expected.dy)));
      ASSERT_NEAR(found.ddy, expected.ddy, 1e-9 * (1 + std::abs(expected.ddy)));
      ASSERT_NEAR(found.dddy, expected.dddy, 1e-8 * (1 + std::abs(expected.dddy)));
    }
  }
}

}  // namespace
}  // namespace takt::cam
