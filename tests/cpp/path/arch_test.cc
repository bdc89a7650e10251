// PP-11: upright half ellipses over two points.
#include "takt/path/arch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "../core/trials.h"
#include "paths.h"

namespace takt::path {
namespace {

using testing::Length;
using testing::Random;
using testing::StepBetween;

constexpr Triple kUp{0, 0, 1};

std::vector<Segment> Arch(const Point& begin, const Point& end, double height, const Triple& up = kUp) {
  std::vector<Segment> pieces;
  const int count = ArchPieces(begin, end, height, up);
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(MakeArchPiece(begin, end, height, up, i, pieces.emplace_back()), Problem::kNone);
  }
  Segment none;
  EXPECT_EQ(MakeArchPiece(begin, end, height, up, count, none), Problem::kOutside);
  return pieces;
}

// Distance of a point from an ellipse with these half axes: the larger error of its equation, as a length.
double OffEllipse(double along, double above, double a, double b) {
  const double radius = std::hypot(along / a, above / b);
  return std::abs(radius - 1) * std::max(a, b);
}

// PP-11: the length of half a circle over 200 mm is 100 pi; its crest lies 100 above both points.
TEST(Arches, HalfACircleByHand) {
  const auto pieces = Arch(testing::At(0, 0, 50), testing::At(200, 0, 50), 100);
  ASSERT_EQ(pieces.size(), 4u);
  double length = 0;
  for (const Segment& piece : pieces) length += piece.length;
  EXPECT_NEAR(length, 100 * std::numbers::pi, 1e-3);
  const KDL::Vector crest = PointAt(pieces[2], 0).frame.p;
  EXPECT_LT(Length(crest - KDL::Vector(100, 0, 150)), 1e-9);
  EXPECT_LT(Length(PointAt(pieces[0], 0).frame.p - KDL::Vector(0, 0, 50)), 1e-12);
  EXPECT_LT(Length(PointAt(pieces[3], pieces[3].length).frame.p - KDL::Vector(200, 0, 50)), 1e-9);
}

// PP-11: the length of half an ellipse with half axes 150 and 25 is half of 4 a E(e): 4 · 150 · 1.0389 / 2 (Abramowitz
// and Stegun give E(m = 1 - 1/36) = 1.03887...). Here from std::comp_ellint_2.
TEST(Arches, LengthOfAnEllipse) {
  const auto pieces = Arch(testing::At(-150, 0), testing::At(150, 0), 25);
  double length = 0;
  for (const Segment& piece : pieces) length += piece.length;
  EXPECT_NEAR(length, 2 * 150 * std::comp_ellint_2(std::sqrt(1 - 25.0 * 25 / (150 * 150))), 150e-4);
}

// PP-11: a straight piece at the lower point, whichever of the two it is.
TEST(Arches, StraightPieceWhereHeightsDiffer) {
  const auto up = Arch(testing::At(0, 0, 0), testing::At(300, 0, 40), 60);
  ASSERT_EQ(up.size(), 5u);
  EXPECT_EQ(up[0].shape, Shape::kLine);
  EXPECT_NEAR(up[0].length, 40, 1e-12);
  EXPECT_LT(Length(PointAt(up[0], 40).frame.p - KDL::Vector(0, 0, 40)), 1e-12);
  EXPECT_LT(Length(PointAt(up[3], 0).frame.p - KDL::Vector(150, 0, 100)), 1e-9);
  const auto down = Arch(testing::At(0, 0, 40), testing::At(300, 0, 0), 60);
  ASSERT_EQ(down.size(), 5u);
  EXPECT_EQ(down[4].shape, Shape::kLine);
  EXPECT_NEAR(down[4].length, 40, 1e-12);
  EXPECT_LT(Length(PointAt(down[2], 0).frame.p - KDL::Vector(150, 0, 100)), 1e-9);
}

// PP-11: properties of any arch: on its ellipse to 1e-4 of its size, upright in its plane, no jump of position,
// tangent, orientation or auxiliaries; curvature jumps at no joint of the ellipse; half of the length, half of the
// turn.
TEST(Arches, AnyArch) {
  Random random(11);
  for (int trial = 0; trial < Trials(300); ++trial) {
    const KDL::Vector up = random.Direction();
    const KDL::Vector across = random.Across(up);
    const double a = random.Size(1, 1000);
    const double b = a * random.Size(0.02, 20);
    const double rise = random.Coin() ? 0 : random.Between(-100, 100);
    const KDL::Vector start(random.Between(-500, 500), random.Between(-500, 500), random.Between(-500, 500));
    const Point begin{{random.Orientation(), start}, random.SomeAuxiliaries()};
    const Point end{{random.Orientation(), start + 2 * a * across + rise * up}, random.SomeAuxiliaries()};
    const auto pieces = Arch(begin, end, b, {up.x(), up.y(), up.z()});
    ASSERT_EQ(pieces.size(), rise == 0 ? 4u : 5u);
    double length = 0;
    for (const Segment& piece : pieces) length += piece.length;
    double way = 0;
    const KDL::Vector centre = start + a * across + std::max(0.0, rise) * up;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (int k = 0; k <= 16; ++k) {
        const double s = pieces[i].length * k / 16;
        const Point point = PointAt(pieces[i], s);
        const KDL::Vector from = point.frame.p - centre;
        if (pieces[i].shape == Shape::kQuintic) {
          EXPECT_LT(OffEllipse(dot(from, across), dot(from, up), a, b), 1e-4 * std::max(a, b));
        }
        EXPECT_NEAR(dot(from, up * across), 0, 1e-9 * std::max(a, b));
        const double share = (way + s) / length;
        EXPECT_NEAR(point.auxiliaries[0], std::lerp(begin.auxiliaries[0], end.auxiliaries[0], share), 1e-9);
        const double whole = kinematics::TurnBetween(begin.frame.M, end.frame.M).Norm();
        EXPECT_NEAR(kinematics::TurnBetween(begin.frame.M, point.frame.M).Norm(), share * whole, 1e-7);
      }
      way += pieces[i].length;
      if (i + 1 == pieces.size()) break;
      const auto step = StepBetween(pieces[i], pieces[i].length, pieces[i + 1], 0);
      EXPECT_LT(step.place, 1e-8 * std::max(a, b));
      EXPECT_LT(step.tangent, 1e-9);
      EXPECT_LT(step.orientation, 1e-9);
      const bool of_ellipse = pieces[i].shape == pieces[i + 1].shape;
      if (of_ellipse) {
        EXPECT_LT(step.curvature, 1e-9 * std::max(a / (b * b), b / (a * a)));
      }
    }
  }
}

// PP-11: no ellipse: flat over two points, or points one above the other.
TEST(Arches, NoEllipse) {
  EXPECT_EQ(Arch(testing::At(0, 0), testing::At(100, 0), 0).size(), 1u);
  const auto beneath = Arch(testing::At(0, 0), testing::At(0, 0, 30), 10);
  ASSERT_EQ(beneath.size(), 1u);
  EXPECT_NEAR(beneath[0].length, 30, 1e-12);
  const auto step = Arch(testing::At(0, 0), testing::At(100, 0, 30), 0);
  ASSERT_EQ(step.size(), 2u);
  EXPECT_NEAR(step[1].length, 100, 1e-12);
  Segment out;
  EXPECT_EQ(MakeArchPiece(testing::At(1, 1), testing::At(1, 1), 10, kUp, 0, out), Problem::kLengthZero);
  EXPECT_EQ(MakeArchPiece(testing::At(1, 1), testing::At(5, 1), 10, {0, 0, 0}, 0, out), Problem::kNoPlane);
  EXPECT_EQ(MakeArchPiece(testing::At(1, 1), testing::At(5, 1), -1, kUp, 0, out), Problem::kOutside);
}

}  // namespace
}  // namespace takt::path
