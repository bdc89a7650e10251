// CAM-03: errors and warnings, each with its path and its values.
#include "takt/cam/build.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "made.h"

namespace takt::cam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::string> Errors(const CamParams& params) {
  const Built built = Build(params);
  EXPECT_EQ(built.table.has_value(), built.errors.empty());
  return Texts(built.errors);
}

std::vector<std::string> Warnings(const CamParams& params) {
  const Built built = Build(params);
  EXPECT_THAT(Texts(built.errors), IsEmpty());
  return Texts(built.warnings);
}

const auto kQuintic = Interpolation::kQuintic;
const auto kLinear = Interpolation::kLinear;
const auto kSpline = Interpolation::kCubicSpline;

TEST(BuildPoints, RefusesWhatIsNoCam) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Errors(Points(kQuintic, {})), ElementsAre("points: expected 2 to 100,000 points, found 0"));
  EXPECT_THAT(Errors(Points(kQuintic, {{1, 1}})), ElementsAre("points: expected 2 to 100,000 points, found 1"));
  EXPECT_THAT(Errors(Points(kQuintic, std::vector<CamPoint>(100'001))),
              ElementsAre("points: expected 2 to 100,000 points, found 100001"));
  EXPECT_THAT(Errors(Points(kLinear, {{0, 0}, {1, 0}, {1, 0}, {0.5, 0}})),
              ElementsAre("points[2].x: expected x above 1 of the point before, found 1",
                          "points[3].x: expected x above 1 of the point before, found 0.5"));
  EXPECT_THAT(Errors(Points(kQuintic, {{0, kNan, kInf, -kInf}, {kInf, 0}})),
              ElementsAre("points[0].y: expected a finite number, found nan",
                          "points[0].v: expected a finite number, found inf",
                          "points[0].a: expected a finite number, found -inf",
                          "points[1].x: expected a finite number, found inf"));
  EXPECT_THAT(Errors(Points(kLinear, {{0, 0, 1}, {1, 0}})),
              ElementsAre("points[0].v: expected no velocity in a linear cam, found 1"));
  EXPECT_THAT(Errors(Points(kSpline, {{0, 0, 1, 2}, {1, 0}})),
              ElementsAre("points[0].a: expected no acceleration but in a quintic or monotone cam, found 2"));
  EXPECT_THAT(Errors(Points(kLinear, {{0, 0}, {1e-310, 0}})),
              ElementsAre(HasSubstr("a length that a number can hold")));
  EXPECT_THAT(Errors(Points(kLinear, {{-1e308, 0}, {1e308, 0}})),
              ElementsAre(HasSubstr("a length that a number can hold")));
  EXPECT_THAT(Errors(Points(kQuintic, {{0, 0, 0, 0}, {1e-100, 1, 0, 0}, {1, 1, 0, 0}})),
              ElementsAre(HasSubstr("found too little way or too much height from x 0 to 1.0e-100")));
}

TEST(BuildPoints, TakesTheLargestNumber) {
  std::vector<CamPoint> points;
  for (std::size_t i = 0; i < kMaxPoints; ++i) points.push_back({static_cast<double>(i), 0});
  EXPECT_THAT(Errors(Points(kLinear, points)), IsEmpty());
}

// No more sentences than a user reads.
TEST(BuildPoints, StopsComplaining) {
  EXPECT_THAT(Errors(Points(kLinear, std::vector<CamPoint>(1000))), SizeIs(20));
}

// A cyclic cam is closed up to the acceleration.
TEST(BuildPoints, ClosesCyclicCams) {
  EXPECT_THAT(
      Errors(Points(kQuintic, {{0, 0, 1}, {5, 8}, {10, 3, 2}}, true)),
      ElementsAre(
          "points[2]: expected the velocity at the end of a cyclic cam as at its beginning, 1 at x 10, found 2"));
  EXPECT_THAT(
      Errors(Points(kQuintic, {{0, 0, 1, 0}, {5, 8}, {10, 3, 1, -4}}, true)),
      ElementsAre(
          "points[2]: expected the acceleration at the end of a cyclic cam as at its beginning, 0 at x 10, found -4"));
  EXPECT_THAT(Warnings(Points(kQuintic, {{0, 0}, {5, 8}, {10, 3}}, true)), IsEmpty());
  // A value given at one end holds for both.
  for (const bool at_end : {false, true}) {
    CamParams params = Points(kQuintic, {{0, 0}, {5, 8}, {10, 3}}, true);
    (at_end ? params.points.back() : params.points.front()).v = 2;
    const Table table = Made(params);
    EXPECT_NEAR(table.At(0).dy, 2, 1e-12);
    EXPECT_NEAR(table.At(10).dy, 2, 1e-12);
    EXPECT_NEAR(table.At(0).ddy, table.At(10).ddy, 1e-12);
  }
  EXPECT_THAT(Warnings(Points(kSpline, {{0, 0}, {3, 7}, {10, 3}}, true)), IsEmpty());
  EXPECT_THAT(Errors(Points(kSpline, {{0, 0, 1}, {3, 7}, {10, 3}}, true)),
              ElementsAre(HasSubstr("points[2]: expected the acceleration at the end of a cyclic cam")));
}

TEST(BuildPoints, WarnsOfJumpsInLinearCams) {
  EXPECT_THAT(Warnings(Points(kLinear, {{0, 0}, {1, 1}, {2, 2}})), IsEmpty());
  EXPECT_THAT(
      Warnings(Points(kLinear, {{0, 0}, {1, 1}, {2, 1}, {3, 3}})),
      ElementsAre(
          "points[2]: straight lines meet with a jump of velocity at 2 places, the largest at x 2, from 0 to 2; "
          "the slave follows there as its limits allow"));
  EXPECT_THAT(Warnings(Points(kLinear, {{0, 0}, {1, 1}, {2, 0}}, true)), ElementsAre(HasSubstr("at 2 places")));
}

TEST(BuildSegments, RefusesWhatIsNoCam) {
  CamSegment gap = To(20, 5, Law::kLine);
  gap.from = CamPlace{11, 5};
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kLine), gap})),
              ElementsAre("segments[1].from.x: expected x 10 where the segment before ends, found 11"));
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kLine), To(10, 6, Law::kLine)})),
              ElementsAre("segments[1].to.x: expected x above 10 of its beginning, found 10"));
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kDwell)})),
              ElementsAre("segments[0].to.y: expected y 0 of its beginning in a dwell, found 5"));
  CamSegment given = To(10, 5, Law::kParabola);
  given.end_v = 1;
  EXPECT_THAT(Errors(Segments({given})),
              ElementsAre(HasSubstr("segments[0].law: expected a law that takes velocities")));
  EXPECT_THAT(Errors(Segments(std::vector<CamSegment>(20'001))), ElementsAre(HasSubstr("20,000 segments at most")));
}

TEST(BuildSegments, RefusesJumps) {
  CamSegment step = To(20, 9, Law::kCycloid);
  step.from = CamPlace{10, 6};
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kCycloid), step})),
              ElementsAre("segments[1]: expected the position of the segment before, 5 at x 10, found 6"));
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kCycloid), To(20, 10, Law::kLine)})),
              ElementsAre("segments[1]: expected the velocity of the segment before, 0 at x 10, found 0.5"));
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kQuintic), To(20, 10, Law::kLine)}, true)),
              IsEmpty());  // the quintic joins the line at both ends
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kCycloid), To(20, 10, Law::kQuintic)}, true)), IsEmpty());
  EXPECT_THAT(Errors(Segments({To(10, 5, Law::kLine), To(20, 10, Law::kQuintic), To(30, 10, Law::kDwell)}, true)),
              ElementsAre());  // lines that meet at the seam: a warning
}

TEST(BuildSegments, WarnsOfWhatLawsCannotHelp) {
  EXPECT_THAT(Warnings(Segments({To(10, 5, Law::kLine), To(20, 5, Law::kDwell)})),
              ElementsAre(HasSubstr("segments[1]: straight lines meet with a jump of velocity at 1 place")));
  CamSegment step = To(20, 6, Law::kDwell);
  step.from = CamPlace{10, 6};
  EXPECT_THAT(Warnings(Segments({To(10, 5, Law::kLine), step})),
              ElementsAre("segments[1]: expected the position of the segment before, 5 at x 10, found 6",
                          HasSubstr("straight lines meet")));
  EXPECT_THAT(Warnings(Segments({To(10, 5, Law::kParabola), To(20, 5, Law::kDwell)})), IsEmpty());
  EXPECT_THAT(Warnings(Segments({To(10, 5, Law::kParabola), To(20, 0, Law::kParabola)}, true)), IsEmpty());
  EXPECT_THAT(Warnings(Segments({To(10, 5, Law::kParabola), To(20, 5, Law::kDwell)}, true)),
              ElementsAre(HasSubstr("segments[1]: expected the acceleration at the end of a cyclic cam")));
  CamSegment hard = To(10, 5, Law::kQuintic);
  hard.end_a = 3;
  EXPECT_THAT(Warnings(Segments({hard, To(20, 0, Law::kCycloid)})),
              ElementsAre("segments[1]: expected the acceleration of the segment before, 3 at x 10, found 0"));
}

// CAM-01: a quintic takes values that are not given from its neighbours.
TEST(BuildSegments, FitsQuinticsIn) {
  CamSegment middle = To(30, 20, Law::kQuintic);
  const Table table = Made(Segments({To(10, 5, Law::kLine), middle, To(40, 30, Law::kLine)}));
  EXPECT_NEAR(table.At(10).dy, 0.5, 1e-14);
  EXPECT_NEAR(table.At(std::nextafter(30.0, 0.0)).dy, 1, 1e-12);
  middle.begin_v = 0.5;
  middle.end_v = 1;
  middle.begin_a = middle.end_a = 0;
  const Table given = Made(Segments({To(10, 5, Law::kLine), middle, To(40, 30, Law::kLine)}));
  for (double x = 0; x < 40; x += 0.5) EXPECT_EQ(table.At(x), given.At(x));
  CamSegment first = To(10, 5, Law::kQuintic), second = To(20, 0, Law::kQuintic);
  first.end_v = 0.25;
  second.begin_a = -0.1;
  const Table joined = Made(Segments({first, second}));
  EXPECT_NEAR(joined.At(10).dy, 0.25, 1e-14);
  EXPECT_NEAR(joined.At(std::nextafter(10.0, 0.0)).ddy, -0.1, 1e-12);
}

// Property: a cam that Build accepts without warnings has no jump in y and y', nor over the seam.
TEST(Build, LeavesNoJump) {
  Dice dice(7);
  int smooth = 0;
  for (int run = 0; run < 500; ++run) {
    const Built built = Build(RandomCam(dice));
    ASSERT_TRUE(built.table) << run;
    if (!built.warnings.empty()) continue;
    ++smooth;
    const Table& table = *built.table;
    double y = 0, dy = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
      y = std::max(y, std::abs(table.At(table.BeginOf(i)).y));
      dy = std::max(dy, std::abs(table.At(table.BeginOf(i)).dy));
    }
    for (std::size_t i = 1; i < table.size(); ++i) {
      const Value before = ValueOf(table.CurveOf(i - 1), table.BeginOf(i) - table.BeginOf(i - 1));
      const Value behind = ValueOf(table.CurveOf(i), 0);
      ASSERT_NEAR(before.y, behind.y, 1e-8 * (1 + y)) << run << " " << i;
      ASSERT_NEAR(before.dy, behind.dy, 1e-5 * (1 + dy)) << run << " " << i;
    }
    if (table.cyclic()) {
      ASSERT_NEAR(table.At(table.end()).dy, table.At(table.begin()).dy, 1e-5 * (1 + dy));
      ASSERT_NEAR(table.At(table.end()).ddy, table.At(table.begin()).ddy, 1e-5 * (1 + std::abs(table.At(0).ddy)));
    }
  }
  EXPECT_GT(smooth, 200);
}

}  // namespace
}  // namespace takt::cam
