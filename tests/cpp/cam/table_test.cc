#include "takt/cam/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "takt/cam/build.h"
#include "takt/core/describe.h"
#include "takt/core/verify.h"

namespace takt::cam {
namespace {

Table Made(const CamParams& params) {
  Built built = Build(params);
  for (const Finding& error : built.errors) ADD_FAILURE() << error.path << ": " << error.message;
  return std::move(built.table.value());
}

CamParams Points(Interpolation interpolation, std::vector<CamPoint> points, bool cyclic = false) {
  CamParams params;
  params.name = "cam";
  params.interpolation = interpolation;
  params.cyclic = cyclic;
  params.points = std::move(points);
  return params;
}

TEST(CamParams, AreDescribed) {
  EXPECT_THAT(Verify(TypeOf<CamParams>()), testing::IsEmpty());
}

// CAM-01: straight lines.
TEST(Table, ConnectsPointsWithStraightLines) {
  const Table table = Made(Points(Interpolation::kLinear, {{0, 1}, {10, 21}, {30, 11}}));
  EXPECT_EQ(table.begin(), 0);
  EXPECT_EQ(table.end(), 30);
  EXPECT_EQ(table.stroke(), 10);
  EXPECT_EQ(table.At(5), (Value{11, 2, 0, 0}));
  EXPECT_EQ(table.At(20), (Value{16, -0.5, 0, 0}));
  EXPECT_EQ(table.At(10), (Value{21, -0.5, 0, 0}));  // the piece behind the joint
  EXPECT_EQ(table.At(-1), (Value{1, 2, 0, 0}));
  EXPECT_EQ(table.At(31), (Value{11, -0.5, 0, 0}));
  EXPECT_EQ(table.At(NAN), table.At(0));
}

// CAM-01: a polynomial of the fifth degree through given positions, velocities and accelerations is that polynomial.
TEST(Table, MeetsGivenVelocitiesAndAccelerations) {
  const auto y = [](double x) {
    return Value{x * x * x * x * x - 2 * x * x, 5 * x * x * x * x - 4 * x, 20 * x * x * x - 4, 60 * x * x};
  };
  std::vector<CamPoint> points;
  for (const double x : {-1.0, 0.0, 0.5, 2.0}) points.push_back({x, y(x).y, y(x).dy, y(x).ddy});
  const Table table = Made(Points(Interpolation::kQuintic, points));
  for (double x = -1; x <= 2; x += 0.01) {
    const Value value = table.At(x);
    EXPECT_NEAR(value.y, y(x).y, 1e-12);
    EXPECT_NEAR(value.dy, y(x).dy, 1e-11);
    EXPECT_NEAR(value.ddy, y(x).ddy, 1e-10);
    EXPECT_NEAR(value.dddy, y(x).dddy, 1e-9);
  }
}

}  // namespace
}  // namespace takt::cam
