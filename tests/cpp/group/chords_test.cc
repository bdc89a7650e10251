// GR-24: tool paths of short chords run as the curve would that they stand for.
#include <random>

#include "../core/trials.h"
#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

using Points = std::vector<KDL::Vector>;

// Where a contour runs whose direction swings to and fro: radii down to 30 mm, bends to both sides.
Points Contour(double chord, int count, const KDL::Vector& from) {
  constexpr int kSteps = 200;
  Points points{from};
  double direction = 0, way = 0;
  KDL::Vector at = from;
  for (int i = 0; i < count; ++i) {
    for (int n = 0; n < kSteps; ++n) {
      const double step = chord / kSteps;
      direction += step * (1.0 / 60 + std::sin(2 * std::numbers::pi * way / 170) / 60);
      at += KDL::Vector(step * std::cos(direction), step * std::sin(direction), 0);
      way += step;
    }
    points.push_back(at);
  }
  return points;
}

Points Circle(double radius, double chord, int count, const KDL::Vector& from) {
  Points points;
  for (int i = 0; i <= count; ++i) {
    const double angle = i * chord / radius;
    points.push_back(from + radius * KDL::Vector(std::sin(angle), 1 - std::cos(angle), 0));
  }
  return points;
}

PathTable TableOf(const Points& points) {
  PathTable table;
  for (std::size_t i = 1; i < points.size(); ++i) {
    PathPiece piece;
    piece.to.x = points[i].x();
    piece.to.y = points[i].y();
    piece.to.z = points[i].z();
    table.pieces.push_back(piece);
  }
  return table;
}

MoveLinearAbsolute MoveTo(const KDL::Vector& to, double speed, double deviation) {
  return {.x = to.x(),
          .y = to.y(),
          .z = to.z(),
          .velocity = speed,
          .buffer_mode = BufferMode::kBlendingNext,
          .transition_mode = TransitionMode::kMaxCornerDeviation,
          .transition_parameter = deviation};
}

double LengthOf(const Points& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).Norm();
  return length;
}

double FromChords(const KDL::Vector& p, const Points& points) {
  double least = 1e99;
  for (std::size_t i = 1; i < points.size(); ++i) least = std::min(least, FromLine(p, points[i - 1], points[i]));
  return least;
}

// How far the tool was from the chords at most.
double OffChords(const Rig& rig, const Points& points) {
  double worst = 0;
  for (const Sample& sample : rig.trace) worst = std::max(worst, FromChords(ToolOf(rig, sample).p, points));
  return worst;
}

// Where the path is that the motion goes along.
KDL::Vector OnPath(const Rig& rig) {
  const Stretch& stretch = (*rig.ahead)[rig.ahead->first];
  return path::PointAt(stretch.segment, stretch.from + rig.state.pace.now.position - stretch.begin).frame.p;
}

// Once the speed is reached it is kept, but for a share of it, to where the motion brakes for the end; both no further
// than this.
void ExpectNoDip(const Rig& rig, double speed, double length, double ramp, double share = 1e-6) {
  double gone = 0, slowest = 1e99;
  for (const Sample& sample : rig.trace) {
    gone += sample.out.velocity * rig.cycle.period_s;
    if (gone > ramp && gone < length - ramp) slowest = std::min(slowest, sample.out.velocity);
  }
  EXPECT_GE(slowest, speed * (1 - share));
}

// Of all that is planned: tangent and curvature go on from one stretch to the next.
void ExpectSmoothPath(const LookAhead& ahead) {
  for (std::uint64_t i = ahead.first; i + 1 < ahead.end(); ++i) {
    const Stretch& before = ahead[i];
    const Stretch& after = ahead[i + 1];
    if (before.stops) continue;
    const path::MovingFrame a = path::At(before.segment, before.to), b = path::At(after.segment, after.from);
    ASSERT_LE((a.p.p - b.p.p).Norm(), 1e-9);
    ASSERT_LE((a.p.v - b.p.v).Norm(), 1e-9);
    ASSERT_LE((a.p.dv - b.p.dv).Norm(), 1e-6 * std::max(1.0, a.p.dv.Norm()));
  }
}

struct Case {
  bool delta;
  bool circle;
  bool queued;  // with moves that come one after the other, instead of a path of the machine file
};

// GR-24: 500 chords of 1 mm at 150 mm/s, without any dip between the ramps.
TEST(ChordPaths, KeepTheirSpeed) {
  constexpr double kSpeed = 150;
  constexpr double kDeviation = 0.01;
  for (const Case& one :
       {Case{false, true, false}, Case{false, true, true}, Case{false, false, false}, Case{false, false, true},
        Case{true, true, false}, Case{true, true, true}, Case{true, false, false}, Case{true, false, true}}) {
    SCOPED_TRACE(testing::Message() << (one.delta ? "Delta, " : "gantry, ") << (one.circle ? "circle" : "contour")
                                    << (one.queued ? ", queued" : ", path"));
    const KDL::Vector from(-20, -30, one.delta ? -850 : 0);
    const Points points = one.circle ? Circle(30, 1, 500, from) : Contour(1, 500, from);
    Rig rig = one.delta ? DeltaRobot() : Gantry();
    rig.paths = {TableOf(points)};
    rig.StartAt({from.x(), from.y(), from.z(), 0, 0, 0});
    rig.Step();
    Ticket last = 0;
    if (one.queued) {
      std::size_t given = 0;
      while (given + 1 < points.size()) {
        for (int i = 0; i < 20 && given + 1 < points.size() && rig.out().buffered < 100; ++i) {
          last = rig.Give(MoveTo(points[++given], kSpeed, kDeviation));
        }
        rig.Step();
      }
    } else {
      last = rig.Give(MovePath{.path = 0,
                               .velocity = kSpeed,
                               .transition_mode = TransitionMode::kMaxCornerDeviation,
                               .transition_parameter = kDeviation});
    }
    ASSERT_TRUE(rig.RunToEnd(last, 20));
    EXPECT_TRUE(rig.lives[last].done);
    ExpectAt(ToolOf(rig), {points.back().x(), points.back().y(), points.back().z(), 0, 0, 0});
    ExpectSmooth(rig);
    ExpectNoDip(rig, kSpeed, LengthOf(points), 10);
    // Half of a chord of 1 mm, at a corner of 1/30 rad: a quarter of both.
    EXPECT_LE(OffChords(rig, points), 1.02 * 0.25 * 0.5 / 30);
  }
}

// GR-24: short chords, on small circles, too; where jerk and acceleration let it.
TEST(ChordPaths, OnCircles) {
  struct One {
    double radius, chord, speed;
  };
  for (const One& one :
       {One{10, 0.2, 100}, One{10, 1, 100}, One{30, 0.2, 150}, One{30, 3, 150}, One{100, 1, 400}, One{100, 3, 400}}) {
    SCOPED_TRACE(testing::Message() << one.radius << " " << one.chord);
    const Points points = Circle(one.radius, one.chord, static_cast<int>(200 / one.chord), {});
    Rig rig = Gantry({TableOf(points)});
    rig.Start();
    const Ticket move = rig.Give(MovePath{.path = 0,
                                          .velocity = one.speed,
                                          .transition_mode = TransitionMode::kMaxCornerDeviation,
                                          .transition_parameter = 0.1});
    ASSERT_TRUE(rig.RunToEnd(move, 20));
    ExpectSmooth(rig);
    // On the largest the axes are at their limits, of which plans keep 1 % for what is between their knots.
    ExpectNoDip(rig, one.speed, LengthOf(points), 30, 0.015);
  }
}

// GR-22, GR-24: any chords, any deviation, coming at any time, interrupted: within the deviation, and smooth.
TEST(ChordPaths, PropertyStayWithinTheDeviation) {
  double most_off_path = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(Trials(60, 10)); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const double mean = std::exp(Uniform(random, std::log(0.2), std::log(5)));
    const double spread = Uniform(random, 1, 4), most = Uniform(random, 0.02, 1.2);
    const double deviation = mean * std::exp(Uniform(random, std::log(1e-3), std::log(0.3)));
    Points points{KDL::Vector::Zero()};
    double direction = 0;
    for (int i = 0; i < 60; ++i) {
      direction += Uniform(random, -0.3 * most, most);
      const KDL::Vector way(std::cos(direction), std::sin(direction), Uniform(random, -0.1, 0.1) * most);
      points.push_back(points.back() + mean * Uniform(random, 1, spread) * way);
    }
    Rig rig = Gantry();
    rig.Start();
    const double speed = Uniform(random, 50, 500);
    const bool slow = random() % 2 == 0;
    Ticket last = 0;
    double off_chords = 0, off_path = 0;
    KDL::Vector before = points[0];
    const auto run = [&](int cycles) {
      for (; cycles > 0; --cycles) {
        rig.Step();
        if (cycles % 4 == 0) ExpectSmoothPath(*rig.ahead);
        if (!rig.state.begun || rig.lives[last].ended()) continue;
        const KDL::Vector at = OnPath(rig);
        off_chords = std::max(off_chords, FromChords(at, points));
        off_path = std::max(off_path, (ToolOf(rig).p - at).Norm());
        ASSERT_LE((at - before).Norm(), 1.01 * speed * rig.cycle.period_s);
        before = at;
      }
    };
    for (std::size_t i = 1; i < points.size(); ++i) {
      last = rig.Give(MoveTo(points[i], speed, deviation));
      if (random() % 50 == 0) {
        rig.Give(Interrupt{});
        run(static_cast<int>(Uniform(random, 1, 100)));
        rig.Give(Continue{});
      }
      if (random() % 3 == 0) run(slow ? static_cast<int>(Uniform(random, 1, 50)) : 1);
    }
    rig.Give(Continue{});
    for (int i = 0; i < 1200 && !rig.lives[last].ended(); ++i) run(100);
    ASSERT_TRUE(rig.lives[last].done);
    EXPECT_LE((ToolOf(rig).p - points.back()).Norm(), 1e-9);
    ExpectSmooth(rig);
    EXPECT_LE(off_chords, deviation * (1 + 1e-6));
    most_off_path = std::max(most_off_path, off_path);
  }
  std::cout << "members that keep their own limits leave the path by up to " << most_off_path << " mm\n";
}

// GR-22: what is further from all corners than the corner distance lies on the chords.
TEST(ChordPaths, PropertyKeepTheCornerDistance) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(Trials(40, 10)); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const double distance = Uniform(random, 0.3, 1.5);
    Points points{KDL::Vector::Zero()};
    double direction = 0;
    for (int i = 0; i < 60; ++i) {
      direction += Uniform(random, 0, 0.2);
      points.push_back(points.back() +
                       Uniform(random, 0.5, 2) * KDL::Vector(std::cos(direction), std::sin(direction), 0));
    }
    Rig rig = Gantry({TableOf(points)});
    rig.Start();
    const Ticket move = rig.Give(MovePath{.path = 0,
                                          .velocity = 100,
                                          .transition_mode = TransitionMode::kCornerDistance,
                                          .transition_parameter = distance});
    while (!rig.lives[move].ended()) {
      rig.Step();
      if (!rig.state.begun) continue;
      const KDL::Vector at = OnPath(rig);
      double nearest = 1e99;
      for (const KDL::Vector& corner : points) nearest = std::min(nearest, (at - corner).Norm());
      if (nearest > distance) {
        ASSERT_LE(FromChords(at, points), 1e-9);
      }
    }
    EXPECT_TRUE(rig.lives[move].done);
    ExpectSmooth(rig);
  }
}

// GR-12: chords that lead out of where an axis may go end before that, on the last chord that can be gone whole.
TEST(ChordPaths, EndWhereAnAxisCannotGo) {
  const Points points = Circle(30, 1, 100, {});
  Rig rig = Gantry();
  rig.axes[1].limits.upper = 40;
  rig.Start();
  Ticket move = 0;
  for (std::size_t i = 1; i < points.size(); ++i) move = rig.Give(MoveTo(points[i], 150, 0.01));
  ASSERT_TRUE(rig.RunToEnd(move, 20));
  rig.Run(0.5);
  EXPECT_TRUE(rig.lives[move].aborted);  // behind the one that cannot be gone
  ExpectSmooth(rig);
  const double y = ToolOf(rig).p.y();
  EXPECT_LE(y, 40);
  EXPECT_GT(y, 39);
  EXPECT_LE(FromChords(ToolOf(rig).p, points), 1e-9);
}

// GR-20: no element is gone faster than it may, on the blend behind it either.
TEST(ChordPaths, KeepTheSpeedOfAnElementOnItsBlends) {
  PathTable table = TableOf({{0, 0, 0}, {100, 0, 0}, {100, 100, 0}});
  table.pieces[0].velocity = 50;
  Rig rig = Gantry({table});
  rig.Start();
  const Ticket move = rig.Give(MovePath{
      .path = 0, .velocity = 400, .transition_mode = TransitionMode::kCornerDistance, .transition_parameter = 10});
  ASSERT_TRUE(rig.RunToEnd(move));
  double slow = 0, fast = 0;
  for (const Sample& sample : rig.trace) {
    double& most = ToolOf(rig, sample).p.y() < 10 ? slow : fast;
    most = std::max(most, sample.out.velocity);
  }
  EXPECT_NEAR(slow, 50, 1e-3);
  EXPECT_GT(fast, 350);
}

// Lines of 4 mm between corners rounded tightly: fast between them, not only on the long ones.
TEST(ChordPaths, AreFastBetweenCorners) {
  const Points points = {{0, 0, 0}, {50, 0, 0}, {50, 4, 0}, {54, 4, 0}, {54, 50, 0}};
  Rig rig = Gantry({TableOf(points)});
  rig.Start();
  const Ticket move = rig.Give(MovePath{.path = 0,
                                        .velocity = 400,
                                        .transition_mode = TransitionMode::kMaxCornerDeviation,
                                        .transition_parameter = 0.05});
  ASSERT_TRUE(rig.RunToEnd(move, 10));
  ExpectSmooth(rig);
  EXPECT_LE(OffChords(rig, points), 0.051);
  double fastest = 0;
  for (const Sample& sample : rig.trace) {
    const double y = ToolOf(rig, sample).p.y();
    if (y > 1 && y < 3) fastest = std::max(fastest, sample.out.velocity);
  }
  EXPECT_GT(fastest, 40);
}

}  // namespace
}  // namespace takt::group
