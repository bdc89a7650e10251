// PL-20, PL-21: tracks by arc length: given elements, transitions in the gaps, and their shape.
#include "takt/planar/track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "takt/core/describe.h"
#include "takt/core/verify.h"
#include "tracks.h"

namespace takt::planar {
namespace {

using testing::Arc;
using testing::Distance;
using testing::EndOf;
using testing::kPi;
using testing::LengthTo;
using testing::Line;
using testing::Make;
using testing::Position;
using testing::Random;
using testing::RandomLayout;
using testing::RandomTrack;
using testing::StartOf;

void ExpectPoint(const TrackPoint& p, const Place& place, double direction, double curvature) {
  EXPECT_NEAR(p.place.x, place.x, 1e-10);
  EXPECT_NEAR(p.place.y, place.y, 1e-10);
  EXPECT_NEAR(p.direction, direction, 1e-12);
  EXPECT_NEAR(p.curvature, curvature, 1e-14);
}

TEST(Tracks, AreDescribed) {
  for (const Type* type :
       {&TypeOf<Problem>(), &TypeOf<ElementShape>(), &TypeOf<Element>(), &TypeOf<Place>(), &TypeOf<TrackPoint>()}) {
    EXPECT_EQ(Verify(*type), std::vector<std::string>{});
  }
}

// PL-20: every problem has a text of its own.
TEST(Tracks, ExplainProblems) {
  std::vector<std::string_view> texts;
  for (const Enumerator& e : TypeOf<Problem>().enumerators) {
    const std::string_view text = Text(static_cast<Problem>(e.value));
    EXPECT_EQ(text.empty(), e.value == 0);
    EXPECT_EQ(std::count(texts.begin(), texts.end(), text), 0) << text;
    texts.push_back(text);
  }
}

// PL-20: 3, 4 and 5.
TEST(Tracks, GoStraight) {
  const Track track = Make({.elements = {Line({100, 50}, {400, 450})}});
  EXPECT_NEAR(track.length, 500, 1e-12);
  ExpectPoint(At(track, 250), {250, 250}, std::atan2(4, 3), 0);
}

// PL-20: a full circle in both directions: 2 pi r, at the top after half of it.
TEST(Tracks, GoRoundCircles) {
  for (const bool clockwise : {false, true}) {
    const double side = clockwise ? -1 : 1;
    const Track track = Make({.elements = {Arc({200, 0}, {200, 0}, {0, 0}, clockwise)}, .closed = true});
    EXPECT_NEAR(track.length, 400 * kPi, 1e-10);
    EXPECT_EQ(track.pieces.size(), 1u);
    ExpectPoint(At(track, 100 * kPi), {0, side * 200}, side * kPi, side / 200);
    ExpectPoint(At(track, 300 * kPi), {0, -side * 200}, side * kPi * 2, side / 200);
  }
}

// PL-20: a stadium of lines of 300 mm and half circles of 100 mm, with gaps of 40 mm between them: given elements are
// exact; the length is a little more than without gaps, by much less than the gaps.
TEST(Tracks, GoRoundStadiums) {
  const Track track = Make({.elements = {Line({0, 0}, {300, 0}), Arc({340, 0}, {340, 200}, {340, 100}, false),
                                         Line({300, 200}, {0, 200}), Arc({-40, 200}, {-40, 0}, {-40, 100}, false)},
                            .closed = true});
  ASSERT_EQ(track.pieces.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    const bool line = i % 4 == 0, arc = i % 4 == 2;
    EXPECT_EQ(track.pieces[i].given, line || arc);
    const double length = line ? 300 : arc ? 100 * kPi : 40;
    EXPECT_NEAR(track.pieces[i].segment.length, length, line || arc ? 1e-10 : 0.5);
    EXPECT_GE(track.pieces[i].segment.length, length);
  }
  // Once round.
  EXPECT_NEAR(EndOf(track).direction, 2 * kPi, 1e-9);
}

// PL-20: position, direction and curvature are continuous from piece to piece: steps of the curvature are below a
// millionth of its maximum.
TEST(Tracks, RunSmoothly) {
  Random random(3);
  int made = 0;
  const int trials = Trials(1000);
  for (int i = 0; i < trials; ++i) {
    Track track;
    const Making making = MakeTrack(RandomLayout(random), track);
    if (making.problem != Problem::kNone) {
      EXPECT_TRUE(track.pieces.empty());
      continue;
    }
    ++made;
    const double peak = PeakCurvature(track, 0, track.length);
    for (std::size_t k = 0; k < track.pieces.size(); ++k) {
      const bool last = k + 1 == track.pieces.size();
      if (last && !track.closed) continue;
      const TrackPoint a = At(track.pieces[k], track.pieces[k].segment.length);
      const TrackPoint b = At(track.pieces[last ? 0 : k + 1], 0);
      EXPECT_LT(Distance(a.place, b.place), 1e-9);
      const double turns = last ? std::round((a.direction - b.direction) / (2 * kPi)) : 0;
      EXPECT_NEAR(a.direction, b.direction + turns * 2 * kPi, 1e-9);
      EXPECT_LE(std::abs(a.curvature - b.curvature), 1e-7 * peak);
    }
  }
  EXPECT_GT(made, trials * 2 / 3);
}

// PL-20: s is the arc length everywhere; direction, curvature and its rate agree with differences of points, directions
// and curvatures.
TEST(Tracks, CountArcLength) {
  Random random(4);
  for (int i = 0; i < Trials(30); ++i) {
    const Track track = RandomTrack(random);
    EXPECT_NEAR(LengthTo(track, track.length), track.length, 1e-9);
    for (int k = 0; k < 3; ++k) {
      const double s = random.Between(0, track.length);
      EXPECT_NEAR(LengthTo(track, s), s, 1e-9);
    }
    for (const Piece& piece : track.pieces) {
      const double h = 1e-3;
      const double s = random.Between(h, piece.segment.length - h);
      const TrackPoint p = At(piece, s), a = At(piece, s - h), b = At(piece, s + h);
      EXPECT_NEAR((b.place.x - a.place.x) / (2 * h), std::cos(p.direction), 1e-6);
      EXPECT_NEAR((b.place.y - a.place.y) / (2 * h), std::sin(p.direction), 1e-6);
      EXPECT_NEAR((b.direction - a.direction) / (2 * h), p.curvature, 1e-6);
      EXPECT_NEAR((b.curvature - a.curvature) / (2 * h), p.curvature_rate, 1e-6 + 1e-4 * std::abs(p.curvature_rate));
    }
  }
}

// PL-20: a track passes through its positions, alone or between lines, open or closed.
TEST(Tracks, GoThroughPositions) {
  const std::vector<Place> places{{0, 0}, {200, 50}, {250, 250}, {100, 300}, {-50, 200}};
  for (const bool closed : {false, true}) {
    Layout layout{.closed = closed};
    for (const Place& place : places) layout.elements.push_back(Position(place));
    const Track track = Make(layout);
    ASSERT_EQ(track.pieces.size(), closed ? 5u : 4u);
    for (std::size_t i = 0; i < track.pieces.size(); ++i) {
      EXPECT_LT(Distance(At(track, track.pieces[i].start).place, places[i]), 1e-9);
    }
    EXPECT_LT(Distance(EndOf(track).place, places[closed ? 0 : 4]), 1e-9);
  }
  // The first element of a loop is arbitrary.
  const Track one = Make({.elements = {Position({0, 0}), Position({200, 50}), Position({100, 300})}, .closed = true});
  const Track two = Make({.elements = {Position({100, 300}), Position({0, 0}), Position({200, 50})}, .closed = true});
  EXPECT_NEAR(one.length, two.length, 1e-6);
  // In line with a line, and with nothing else.
  EXPECT_NEAR(Make({.elements = {Line({0, 0}, {100, 0}), Position({250, 0})}}).length, 250, 1e-9);
  EXPECT_NEAR(Make({.elements = {Position({-20, 0}), Line({0, 0}, {100, 0})}}).length, 120, 1e-9);
  EXPECT_NEAR(Make({.elements = {Position({0, 0}), Position({30, 40})}}).length, 50, 1e-9);
}

// PL-20: positions in a loop with lines, for any first element.
TEST(Tracks, GoThroughPositionsWhereALoopBegins) {
  const Element line = Line({0, 0}, {300, 0}), right = Position({400, 150}), left = Position({-100, 150});
  const Element top = Position({150, 300});
  const double length = Make({.elements = {line, right, top, left}, .closed = true}).length;
  EXPECT_NEAR(Make({.elements = {right, top, left, line}, .closed = true}).length, length, 1e-6);
  EXPECT_NEAR(Make({.elements = {top, left, line, right}, .closed = true}).length, length, 1e-6);
  EXPECT_NEAR(Make({.elements = {left, line, right, top}, .closed = true}).length, length, 1e-6);
}

// PL-20: from the end of one track to the start of another: both are taken over exactly.
TEST(Tracks, TakeOverTheirNeighbours) {
  Random random(5);
  int made = 0;
  for (int i = 0; i < Trials(200); ++i) {
    const Track first = RandomTrack(random), second = RandomTrack(random);
    if (first.closed || second.closed) continue;
    Layout layout{.from = EndOf(first), .to = StartOf(second)};
    const TrackPoint end = EndOf(first);
    const Place middle = testing::Ahead(end.place, end.direction + random.Between(-1, 1), random.Between(50, 200));
    if (random.Coin()) layout.elements.push_back(Position(middle));
    Track track;
    if (MakeTrack(layout, track).problem != Problem::kNone) continue;
    ++made;
    const double peak = PeakCurvature(track, 0, track.length);
    for (const auto& [a, b] : {std::pair{StartOf(track), EndOf(first)}, std::pair{EndOf(track), StartOf(second)}}) {
      EXPECT_LT(Distance(a.place, b.place), 1e-9);
      EXPECT_NEAR(std::remainder(a.direction - b.direction, 2 * kPi), 0, 1e-11);
      EXPECT_LE(std::abs(a.curvature - b.curvature), 1e-9 * peak);
    }
  }
  EXPECT_GT(made, Trials(20));
}

// PL-20: an open track ends, a loop is periodic; NaN is the start.
TEST(Tracks, EndOrGoRound) {
  const Track open = Make({.elements = {Line({0, 0}, {100, 0})}});
  const Track loop = Make({.elements = {Arc({100, 0}, {100, 0}, {0, 0}, false)}, .closed = true});
  const double round = loop.length;
  for (const double s : {-1.0, -1e308, std::nan(""), -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(At(open, s).place.x, 0);
  }
  for (const double s : {101.0, 1e308, std::numeric_limits<double>::infinity()}) EXPECT_EQ(At(open, s).place.x, 100);
  EXPECT_NEAR(Within(loop, round + 5), 5, 1e-9);
  EXPECT_NEAR(Within(loop, -5), round - 5, 1e-9);
  EXPECT_NEAR(Within(loop, 7 * round + 5), 5, 1e-9);
  EXPECT_EQ(Within(loop, round), round);
  EXPECT_EQ(Within(loop, std::nan("")), 0);
  EXPECT_EQ(Within(loop, std::numeric_limits<double>::infinity()), 0);
  EXPECT_LT(Distance(At(loop, -1e-12).place, At(loop, 0).place), 1e-9);
}

// PL-21: on a circle of 100 mm, 1000 mm/s² admit 316 mm/s. A straight line has no bound.
TEST(Tracks, BoundTheSpeedInCurves) {
  const Track track = Make({.elements = {Line({0, 0}, {100, 0}), Arc({130, 0}, {130, 200}, {130, 100}, false)}});
  EXPECT_EQ(SpeedBound(At(track, 50), 1000), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(SpeedBound(At(track, track.length - 50), 1000), std::sqrt(1000 * 100.0), 1e-9);
  EXPECT_EQ(PeakCurvature(track, 0, 50), 0);
  EXPECT_NEAR(PeakCurvature(track, track.length - 100, track.length), 0.01, 1e-12);
}

// PL-21: the curvature in a stretch is nowhere larger than reported; and almost reaches it.
TEST(Tracks, KnowWhereTheyBendMost) {
  Random random(6);
  for (int i = 0; i < Trials(200); ++i) {
    const Track track = RandomTrack(random);
    double most = 0;
    for (const Piece& piece : track.pieces) {
      for (int k = 0; k <= 2000; ++k) {
        most = std::max(most, std::abs(At(piece, piece.segment.length * k / 2000).curvature));
      }
    }
    const double said = PeakCurvature(track, 0, track.length);
    EXPECT_LE(most, 1.001 * said + 1e-12);
    EXPECT_GE(most, 0.97 * said - 1e-12);
    const double from = random.Between(0, track.length), to = random.Between(from, track.length);
    const double s = random.Between(from, to);
    EXPECT_LE(std::abs(At(track, s).curvature), 1.001 * PeakCurvature(track, from, to) + 1e-12);
  }
}

// PL-21: the bends that movers slow down for are nowhere less than the curvature. Below 1e-5 / mm it is straight.
TEST(Tracks, BendNoMoreThanTheirBendsSay) {
  Random random(8);
  for (int i = 0; i < Trials(200); ++i) {
    const Track track = RandomTrack(random);
    std::size_t bend = 0;
    double worst = 0;
    for (double s = 0; s < track.length; s += 0.05) {
      while (bend + 1 < track.bends.size() && track.bends[bend + 1].from <= s) ++bend;
      worst = std::max(worst, (std::abs(At(track, s).curvature) - 1e-5) / (track.bends[bend].curvature + 1e-12));
    }
    EXPECT_LE(worst, 1 + 1e-5) << i;
  }
}

// PL-60: evaluation does not allocate.
TEST(Tracks, AllocateNothing) {
  Random random(7);
  const Track track = RandomTrack(random);
  double sum = 0;
  const long before = AllocationsOfThisThread();
  for (int i = 0; i < 100; ++i)
    sum += At(track, track.length * i / 100).place.x + PeakCurvature(track, 0, track.length);
  EXPECT_EQ(AllocationsOfThisThread() - before, 0);
  EXPECT_TRUE(std::isfinite(sum));
}

// PL-20: the element that a problem is at, or the transition before it.
TEST(Tracks, SayWhereTheProblemIs) {
  const double nan = std::nan("");
  struct Case {
    Layout layout;
    Problem problem;
    std::size_t element;
  };
  const Element line = Line({0, 0}, {100, 0});
  const Case cases[] = {
      {{}, Problem::kEmpty, 0},
      {{.elements = {Position({1, 2})}}, Problem::kEmpty, 0},
      {{.elements = {Position({1, 2})}, .closed = true}, Problem::kEmpty, 0},
      {{.elements = {line, Line({150, 0}, {150, nan})}}, Problem::kNotFinite, 1},
      {{.elements = {line, Position({nan, 0})}}, Problem::kNotFinite, 1},
      {{.elements = {line}, .from = TrackPoint{{-50, 0}, nan}}, Problem::kNotFinite, 0},
      {{.elements = {line, Line({150, 0}, {150, 0})}}, Problem::kLengthZero, 1},
      {{.elements = {line, Position({100, 0})}}, Problem::kLengthZero, 1},
      {{.elements = {line, Arc({150, 0}, {200, 0}, {150, 0}, true)}}, Problem::kRadiusZero, 1},
      {{.elements = {line, Arc({150, 0}, {250, 0}, {180, 0}, true)}}, Problem::kNotOnCircle, 1},
      {{.elements = {line, Arc({150, 0}, {150.4, 0}, {150.2, 0}, true)}}, Problem::kTooTight, 1},
      {{.elements = {line, Line({100, 0}, {100, 100})}}, Problem::kKink, 1},
      {{.elements = {line, Arc({100, 0}, {200, 100}, {100, 100}, false)}}, Problem::kCurvatureJump, 1},
      {{.elements = {line, Line({100.1, 0.1}, {100.1, 50})}}, Problem::kTooSharp, 1},
      {{.elements = {line, Line({-100, 0}, {-50, 0})}}, Problem::kReversal, 1},
      {{.elements = {line}, .closed = true}, Problem::kReversal, 1},
      {{.elements = {line}, .from = TrackPoint{{-50, 0}, 0}, .closed = true}, Problem::kLinked, 0},
  };
  for (const Case& c : cases) {
    Track track;
    const Making making = MakeTrack(c.layout, track);
    EXPECT_EQ(making.problem, c.problem);
    EXPECT_EQ(making.element, c.element) << Text(c.problem);
    EXPECT_TRUE(track.pieces.empty());
  }
  // Elements that join smoothly have no transition between them.
  EXPECT_EQ(Make({.elements = {line, Line({100, 0}, {200, 0})}}).pieces.size(), 2u);
}

// PL-20: for any numbers there is a problem, or a track of finite numbers.
TEST(Tracks, StandAnyNumbers) {
  Random random(8);
  const double numbers[] = {0, 1, -1, 1e-9, 100, 200, 1e6, -1e6, 1e9, 1e308, std::nan(""), INFINITY};
  const auto number = [&] { return random.Below(3) > 0 ? random.Between(-500, 500) : numbers[random.Below(12)]; };
  int made = 0;
  for (int i = 0; i < Trials(3000); ++i) {
    Layout layout{.closed = random.Below(4) == 0};
    const auto place = [&] { return Place{number(), number()}; };
    const int count = random.Below(4);
    for (int k = 0; k < count; ++k) {
      layout.elements.push_back({static_cast<ElementShape>(random.Below(3)), place(), place(), place(), random.Coin()});
    }
    if (random.Below(3) == 0) layout.from = TrackPoint{place(), number(), number() / 1000};
    if (random.Below(3) == 0) layout.to = TrackPoint{place(), number(), number() / 1000};
    Track track;
    if (MakeTrack(layout, track).problem != Problem::kNone) continue;
    ++made;
    EXPECT_TRUE(std::isfinite(track.length));
    EXPECT_GT(track.length, 0);
    for (int k = 0; k <= 20; ++k) {
      const TrackPoint p = At(track, track.length * k / 20);
      EXPECT_TRUE(std::isfinite(p.place.x + p.place.y + p.direction + p.curvature + p.curvature_rate));
    }
  }
  EXPECT_GT(made, Trials(100));
}

}  // namespace
}  // namespace takt::planar
