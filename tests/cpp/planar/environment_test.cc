// PL-31: the surface of stators and its border: by hand, and against sampling points.
#include "takt/planar/environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <vector>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "areas.h"

namespace takt::planar {

void PrintTo(StatorProblem problem, std::ostream* stream) {
  *stream << '"' << (problem == StatorProblem::kNone ? "none" : Text(problem)) << '"';
}

namespace {

using testing::Random;
using testing::Surface;

// On a grid, rows from the top: one stator for each '#'.
std::vector<Place> Grid(const std::vector<std::string>& rows) {
  std::vector<Place> stators;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      if (rows[r][c] == '#') {
        stators.push_back({240 * static_cast<double>(c), 240 * static_cast<double>(rows.size() - 1 - r)});
      }
    }
  }
  return stators;
}

std::vector<std::pair<double, double>> CornersOf(const Outline& outline) {
  std::vector<std::pair<double, double>> corners;
  for (const Place& p : outline.corners) corners.emplace_back(p.x, p.y);
  return corners;
}
using Corners = std::vector<std::pair<double, double>>;

Area StandingAt(double x, double y, double c = 0, const Footprint& mover = {155, 155}) {
  return testing::Standing({x, y}, mover, c);
}

// PL-31: the manual's program 6.4.2: four stators have a border of four sides, each two stators long.
TEST(Environments, HaveABorder) {
  const Environment e = Surface({{0, 0}, {240, 0}, {0, 240}, {240, 240}});
  ASSERT_EQ(e.outlines.size(), 1u);
  EXPECT_FALSE(e.outlines[0].hole);
  EXPECT_EQ(CornersOf(e.outlines[0]), (Corners{{0, 0}, {480, 0}, {480, 480}, {0, 480}}));
  EXPECT_TRUE(Carries(e, StandingAt(240, 240)));
  // Flush with the border, and beyond it.
  EXPECT_TRUE(Carries(e, StandingAt(77.5, 77.5)));
  EXPECT_TRUE(Carries(e, StandingAt(402.5, 402.5)));
  EXPECT_FALSE(Carries(e, StandingAt(77.49, 240)));
  EXPECT_FALSE(Carries(e, StandingAt(240, 402.51)));
  EXPECT_FALSE(Carries(e, StandingAt(1000, 240)));
  // Turned, it needs more room: 155 / sqrt(2) to each side.
  const double corner = 155 / std::sqrt(2);
  EXPECT_TRUE(Carries(e, StandingAt(corner + 1e-9, 240, 45)));
  EXPECT_FALSE(Carries(e, StandingAt(corner - 0.01, 240, 45)));
}

// PL-31: the manual's program 6.7.2: on one stator about the origin a mover cannot reach (100, 100).
TEST(Environments, EndWhereStatorsEnd) {
  const Environment e = Surface({{-120, -120}});
  EXPECT_TRUE(Carries(e, StandingAt(0, 0)));
  EXPECT_FALSE(Carries(e, StandingAt(100, 100)));
  // It can rotate there: a circle of 109.6 mm.
  Area turning = StandingAt(0, 0);
  turning.most_c = 90;
  EXPECT_TRUE(Carries(e, turning));
  turning.places[0] = {11, 0};
  EXPECT_FALSE(Carries(e, turning));
}

// PL-31: the surface is to the left of its outlines: outer ones are counterclockwise, holes clockwise.
TEST(Environments, HaveHolesAndIslands) {
  const Environment e = Surface(Grid({"###..##",  //
                                      "#.#...#",  //
                                      "###...."}));
  ASSERT_EQ(e.outlines.size(), 3u);
  EXPECT_EQ(CornersOf(e.outlines[0]), (Corners{{0, 0}, {720, 0}, {720, 720}, {0, 720}}));
  EXPECT_TRUE(e.outlines[1].hole || e.outlines[2].hole);
  const Outline& hole = e.outlines[e.outlines[1].hole ? 1 : 2];
  const Outline& island = e.outlines[e.outlines[1].hole ? 2 : 1];
  EXPECT_EQ(CornersOf(hole), (Corners{{240, 480}, {480, 480}, {480, 240}, {240, 240}}));
  EXPECT_EQ(CornersOf(island), (Corners{{1440, 240}, {1680, 240}, {1680, 720}, {1200, 720}, {1200, 480}, {1440, 480}}));
  EXPECT_TRUE(Carries(e, StandingAt(120, 120)));
  EXPECT_FALSE(Carries(e, StandingAt(360, 360)));
  EXPECT_FALSE(Carries(e, StandingAt(360, 360, 0, {20, 20})));
  EXPECT_FALSE(Carries(e, StandingAt(200, 360)));
  // A hole inside the surface, a path across it, a path around it.
  EXPECT_FALSE(Carries(e, StandingAt(360, 360, 0, {400, 400})));
  const auto way = [](const Place& from, const Place& to) {
    return Area{.places = {from, to}, .count = 2, .mover = {155, 155}};
  };
  EXPECT_FALSE(Carries(e, way({120, 360}, {600, 360})));
  EXPECT_TRUE(Carries(e, way({120, 120}, {600, 120})));
  // No path from one island to another.
  EXPECT_TRUE(Carries(e, StandingAt(1320, 600)));
  EXPECT_FALSE(Carries(e, way({600, 600}, {1320, 600})));
}

// PL-31: stators that meet in a corner only are not connected; outlines that touch there do not cross.
TEST(Environments, DoNotMeetInCorners) {
  const Environment apart = Surface(Grid({".#", "#."}));
  ASSERT_EQ(apart.outlines.size(), 2u);
  for (const Outline& outline : apart.outlines) EXPECT_EQ(outline.corners.size(), 4u);
  EXPECT_FALSE(Carries(apart, {.places = {{{120, 120}, {360, 360}}}, .count = 2, .mover = {10, 10}}));
  const Environment holes = Surface(Grid({"####", "##.#", "#.##", "####"}));
  ASSERT_EQ(holes.outlines.size(), 2u);
  EXPECT_TRUE(holes.outlines[1].hole);
  EXPECT_EQ(holes.outlines[1].corners.size(), 8u);
}

// PL-31: stators need no grid. Shifted by half a stator, and in steps without an exact binary representation.
TEST(Environments, NeedNoGrid) {
  const Environment e = Surface({{0, 0}, {240, 0}, {120, 240}});
  ASSERT_EQ(e.outlines.size(), 1u);
  EXPECT_EQ(CornersOf(e.outlines[0]),
            (Corners{{0, 0}, {480, 0}, {480, 240}, {360, 240}, {360, 480}, {120, 480}, {120, 240}, {0, 240}}));
  std::vector<Place> row;
  for (int i = 0; i < 100; ++i) row.push_back({0.1 + 240 * i * (1 + 1e-13), 0.1 * 3});
  EXPECT_EQ(Surface(row).outlines.at(0).corners.size(), 4u);
}

// PL-31: problems are reported.
TEST(Environments, NameWhatIsWrong) {
  Environment e = Surface({{0, 0}});
  const auto problem = [&](const std::vector<Place>& stators) { return MakeEnvironment(stators, e); };
  EXPECT_EQ(problem({}).problem, StatorProblem::kEmpty);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), double{INFINITY}, 2e6}) {
    for (const Place& p : {Place{bad, 0}, Place{0, -bad}}) {
      const SurfaceResult made = problem({{480, 480}, p});
      EXPECT_EQ(made.problem, StatorProblem::kNotFinite);
      EXPECT_EQ(made.stator, 1u);
    }
  }
  const SurfaceResult overlap = problem({{0, 0}, {240, 0}, {100, 100}});
  EXPECT_EQ(overlap.problem, StatorProblem::kOverlap);
  EXPECT_EQ(overlap.stator, 2u);
  EXPECT_EQ(overlap.other, 0u);
  EXPECT_EQ(problem({{0, 0}, {0, 0}}).problem, StatorProblem::kOverlap);
  EXPECT_EQ(problem({{0, 0}, {239.99, 0}}).problem, StatorProblem::kOverlap);
  EXPECT_EQ(problem(std::vector<Place>(kMostStators + 1)).problem, StatorProblem::kTooMany);
  // The old surface is unchanged.
  EXPECT_EQ(CornersOf(e.outlines.at(0)), (Corners{{0, 0}, {240, 0}, {240, 240}, {0, 240}}));
}

// PL-31: random surfaces, on a grid and off it: all points of a carried area are on stators; an area that is not
// carried has a point off them.
TEST(Environments, CarryWhatLiesOnStators) {
  Random random(41);
  int carried = 0, refused = 0, holes = 0, narrow = 0;
  for (int i = 0; i < Trials(100); ++i) {
    std::vector<Place> stators;
    for (int row = 0; row < 6; ++row) {
      const double shift = random.Coin() ? 0 : random.Between(0, 240);
      for (int column = 0; column < 6; ++column) {
        if (random.Below(5) > 0) stators.push_back({shift + 240 * column, 240.0 * row});
      }
    }
    if (stators.empty()) continue;
    const Environment e = Surface(stators);
    for (const Outline& outline : e.outlines) holes += outline.hole ? 1 : 0;
    const auto on_stator = [&](const Place& p, double room) {
      return std::ranges::any_of(stators, [&](const Place& s) {
        return p.x >= s.x - room && p.x <= s.x + 240 + room && p.y >= s.y - room && p.y <= s.y + 240 + room;
      });
    };
    for (int k = 0; k < 20; ++k) {
      Area area = testing::RandomArea(random);
      const Place middle{random.Between(0, 1440), random.Between(0, 1440)};
      for (Place& p : area.places) p = {middle.x + 0.6 * p.x, middle.y + 0.6 * p.y};
      const bool said = Carries(e, area);
      (said ? carried : refused) += 1;
      bool off = false;
      for (double c = area.least_c; c <= area.most_c && !off; c += std::max(0.5, area.most_c - area.least_c) / 16) {
        const testing::Polygon hull = testing::HullAt(area, c, c);
        Extent extent{hull[0], hull[0]};
        for (const Place& p : hull) {
          extent.lower = {std::min(extent.lower.x, p.x), std::min(extent.lower.y, p.y)};
          extent.upper = {std::max(extent.upper.x, p.x), std::max(extent.upper.y, p.y)};
          off = off || !on_stator(p, 1e-9);
        }
        for (int n = 0; n < 500 && !off; ++n) {
          const Place p{random.Between(extent.lower.x, extent.upper.x), random.Between(extent.lower.y, extent.upper.y)};
          off = testing::IsIn(hull, p) && !on_stator(p, 1e-9);
        }
      }
      if (said) {
        EXPECT_FALSE(off);
      } else if (!off) {
        ++narrow;  // the part off the stators is too small to be found
      }
    }
  }
  EXPECT_GT(carried, Trials(200));
  EXPECT_GT(refused, Trials(200));
  EXPECT_GT(holes, Trials(20));
  EXPECT_LT(narrow, refused / 20);
}

// PL-31: fit for the cycle.
TEST(Environments, CarryWithoutAllocating) {
  const Environment e = Surface(Grid({"###", "#.#", "###"}));
  Random random(42);
  std::vector<Area> areas;
  for (int i = 0; i < 100; ++i) areas.push_back(testing::RandomArea(random));
  const long before = AllocationsOfThisThread();
  int carried = 0;
  for (const Area& area : areas) carried += Carries(e, area) ? 1 : 0;
  EXPECT_EQ(AllocationsOfThisThread(), before);
  EXPECT_GT(carried, 0);
}

}  // namespace
}  // namespace takt::planar
