// GR-11, GR-20, GR-21, GR-22: on every mechanism, also one from URDF and each with an auxiliary axis: circles, helices,
// turns of the tool, blends and direct moves, at speeds that the axes can keep everywhere. Where the tool is comes from
// the forward kinematics of the set points, where it should be from closed forms written here.
#include <fstream>
#include <random>
#include <sstream>

#include "../core/trials.h"
#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

constexpr double kTurned = 1e-7;    // rad
constexpr double kWithPath = 1e-6;  // u, of an auxiliary axis

std::string Puma() {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/cpp/kinematics/puma.urdf");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The mechanism of a rig with one axis more, which goes along.
Rig WithAuxiliary(const Rig& rig) {
  GroupParams params = rig.params;
  params.axes.push_back("u");
  std::vector<axis::AxisParams> axes = rig.axes;
  axes.push_back(AxisOf("u", 1500, 10000, 500000));
  return Rig(std::move(params), std::move(axes));
}

// All kinds, with the place where a curve is to be.
std::vector<Kind> AllKinds() {
  std::vector<Kind> kinds = Kinds();
  const auto urdf = [] {
    KinematicsParams k;
    k.serial = {.urdf = Puma(), .base = {}, .tip = {}};
    return Machine(k, {"a1", "a2", "a3", "a4", "a5", "a6"}, {300, 3000, 100000},
                   {.velocity = 1000, .acceleration = 8000, .deceleration = {}, .jerk = 300000});
  };
  const Rig arm = urdf();
  kinds.push_back({"URDF", urdf, [kinematics = *arm.kinematics](std::mt19937_64& r) {
                     kinematics::Joints joints = {0, -30, 60, 0, 40, 0};
                     for (std::size_t k = 0; k < 6; ++k) joints[k] += Uniform(r, -12, 12);
                     Frame tool;
                     EXPECT_EQ(kinematics::Forward(kinematics, joints, tool), kinematics::Reason::kNone);
                     return kinematics::ToPose(tool);
                   }});
  return kinds;
}

// Standing at a pose: a chain from URDF is solved from nearby.
void StandAt(Rig& rig, const Kind& kind, const Pose& pose) {
  kinematics::Joints near{};
  if (kind.name == "URDF") {
    near = {0, -30, 60, 0, 40, 0};
  } else {
    near.fill(std::numeric_limits<double>::quiet_NaN());
  }
  kinematics::Joints found{};
  ASSERT_EQ(kinematics::Inverse(*rig.kinematics, kinematics::ToFrame(pose), {}, near, found),
            kinematics::Reason::kNone);
  std::vector<double> positions(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(rig.kinematics->count));
  positions.push_back(5);
  rig.Start(positions);
  rig.Step();
  rig.trace = {rig.trace.back()};
}

// Aux of a move: what goes along has the place behind the axes of the kinematics.
template <typename M>
void TakeAlong(const Rig& rig, double to, M& move) {
  std::optional<double>* const places[] = {&move.a1, &move.a2, &move.a3, &move.a4, &move.a5, &move.a6, &move.a7};
  *places[rig.kinematics->count] = to;
}
double Along(const Rig& rig, const Sample& sample) {
  return sample.set[rig.kinematics->count].position;
}

template <typename M>
void GoTo(const Pose& to, M& move) {
  move.x = to.x;
  move.y = to.y;
  move.z = to.z;
  move.a = to.a;
  move.b = to.b;
  move.c = to.c;
}

KDL::Vector Direction(std::mt19937_64& random) {
  KDL::Vector v;
  do {
    v = {Uniform(random, -1, 1), Uniform(random, -1, 1), Uniform(random, -1, 1)};
  } while (v.Norm() > 1 || v.Norm() < 0.1);
  return v / v.Norm();
}

// The tool's velocity and acceleration where the axes are told to be.
kinematics::MovingFrame MotionOf(const Rig& rig, const Sample& sample) {
  kinematics::JointMotion motion;
  for (std::size_t k = 0; k < rig.kinematics->count; ++k) {
    motion.position[k] = sample.set[k].position;
    motion.velocity[k] = sample.set[k].velocity;
    motion.acceleration[k] = sample.set[k].acceleration;
  }
  kinematics::MovingFrame tool;
  EXPECT_EQ(kinematics::Forward(*rig.kinematics, motion, tool), kinematics::Reason::kNone);
  return tool;
}

// A circle, or a helix, from `begin` through `turn` rad about `normal` with a rise; the tool turns to `end` evenly.
struct Round {
  KDL::Vector centre, normal, radius;  // from the centre to the beginning
  double turn = 0, rise = 0;
  KDL::Rotation from, to;

  KDL::Vector At(double angle) const {
    const KDL::Vector side = normal * radius;
    return centre + std::cos(angle) * radius + std::sin(angle) * side + rise * (angle / turn) * normal;
  }
};

struct Off {
  double path = 0, turn = 0, auxiliary = 0;
};

// How far tool and auxiliary axis (from 5 to 25) were from where they should be, all along.
Off FromRound(const Rig& rig, const Round& round) {
  Off off;
  double angle = 0;
  const KDL::Vector side = round.normal * round.radius;
  const KDL::Vector turn = kinematics::TurnBetween(round.from, round.to);
  for (const Sample& sample : rig.trace) {
    const Frame tool = ToolOf(rig, sample);
    const KDL::Vector p = tool.p - round.centre;
    const double now = std::atan2(KDL::dot(p, side), KDL::dot(p, round.radius));
    angle += std::remainder(now - angle, 2 * std::numbers::pi);
    off.path = std::max(off.path, (tool.p - round.At(angle)).Norm());
    const double share = angle / round.turn;
    const KDL::Rotation want = KDL::Rot(share * turn) * round.from;
    off.turn = std::max(off.turn, kinematics::TurnBetween(want, tool.M).Norm());
    off.auxiliary = std::max(off.auxiliary, std::abs(Along(rig, sample) - (5 + 20 * share)));
  }
  EXPECT_NEAR(angle, round.turn, 1e-6);
  return off;
}

// An orientation that the kind can take: that of one of its places.
Pose Turned(const Pose& at, const Pose& like) {
  return {at.x, at.y, at.z, like.a, like.b, like.c};
}

// Circles and helices of one kind: how many were gone, how far they were from the closed form.
struct Gone {
  int moves = 0, refused = 0;
  Off off;
};

Gone GoRound(const Kind& kind, std::uint64_t seed, bool helix) {
  std::mt19937_64 random(seed);
  Rig rig = WithAuxiliary(kind.make());
  const Pose at = kind.place(random), like = kind.place(random);
  Round round;
  round.normal = Direction(random);
  const KDL::Vector any = round.normal * Direction(random);
  round.radius = Uniform(random, 15, 45) * (any / any.Norm());
  const Frame begin = kinematics::ToFrame(at);
  round.centre = begin.p - round.radius;
  round.turn = Uniform(random, 0.5, 5.5) + (helix ? 2 * std::numbers::pi : 0);
  round.rise = helix ? Uniform(random, -30, 30) : 0;
  round.from = begin.M;
  const KDL::Vector p = round.At(round.turn);
  const Pose to = Turned({p.x(), p.y(), p.z(), 0, 0, 0}, like);
  round.to = kinematics::ToFrame(to).M;
  StandAt(rig, kind, at);
  MoveCircularAbsolute move;
  GoTo(to, move);
  const KDL::Vector point = helix ? round.centre : round.At(round.turn / 2);
  move.circ_mode = helix ? path::CircMode::kCenter : path::CircMode::kBorder;
  move.aux_x = point.x();
  move.aux_y = point.y();
  move.aux_z = point.z();
  if (helix) {
    move.normal_x = round.normal.x();
    move.normal_y = round.normal.y();
    move.normal_z = round.normal.z();
    move.turns = 1;
  }
  move.velocity = 60;
  TakeAlong(rig, 25, move);
  const Ticket ticket = rig.Give(move);
  EXPECT_TRUE(rig.RunToEnd(ticket));
  ExpectSmooth(rig, kind.name);
  Gone gone;
  if (!rig.lives[ticket].done) {
    EXPECT_TRUE(rig.lives[ticket].error_id == ErrorId::kUnreachable || rig.lives[ticket].error_id == ErrorId::kSingular)
        << static_cast<int>(rig.lives[ticket].error_id);
    EXPECT_EQ(rig.trace.back().set, rig.trace.front().set) << "refused, but moved";
    gone.refused = 1;
    return gone;
  }
  gone.moves = 1;
  gone.off = FromRound(rig, round);
  return gone;
}

void ExpectRound(bool helix) {
  for (const Kind& kind : AllKinds()) {
    Gone all;
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(Trials(12, 1)); ++seed) {
      SCOPED_TRACE(kind.name + " " + std::to_string(seed));
      const Gone gone = GoRound(kind, seed, helix);
      all.moves += gone.moves;
      all.refused += gone.refused;
      all.off.path = std::max(all.off.path, gone.off.path);
      all.off.turn = std::max(all.off.turn, gone.off.turn);
      all.off.auxiliary = std::max(all.off.auxiliary, gone.off.auxiliary);
    }
    std::cout << kind.name << ": " << all.moves << " gone, " << all.refused << " refused; off by " << all.off.path
              << " mm, " << all.off.turn << " rad, " << all.off.auxiliary << " u\n";
    EXPECT_GE(all.moves, Trials(8, 1)) << kind.name;
    EXPECT_LE(all.off.path, kOnPath) << kind.name;
    EXPECT_LE(all.off.turn, kTurned) << kind.name;
    EXPECT_LE(all.off.auxiliary, kWithPath) << kind.name;
  }
}

// GR-20, GR-21
TEST(Curves, Circles) {
  ExpectRound(false);
}
TEST(Curves, Helices) {
  ExpectRound(true);
}

// GR-20, GR-21: a direct move to a pose: axes evenly, the tool there at the end, on the branch where it began.
TEST(Curves, DirectMoves) {
  for (const Kind& kind : AllKinds()) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      SCOPED_TRACE(kind.name + " " + std::to_string(seed));
      std::mt19937_64 random(seed);
      Rig rig = WithAuxiliary(kind.make());
      StandAt(rig, kind, kind.place(random));
      const std::size_t count = rig.axes.size();
      kinematics::Joints begin{};
      for (std::size_t k = 0; k < count; ++k) begin[k] = rig.trace.back().set[k].position;
      MoveDirectAbsolute move{.coordinate_system = CoordinateSystem::kMcs,
                              .velocity_factor = 0.5,
                              .acceleration_factor = 0.5,
                              .jerk_factor = 0.5};
      const Pose to = kind.place(random);
      GoTo(to, move);
      TakeAlong(rig, 25, move);
      const Ticket ticket = rig.Give(move);
      ASSERT_TRUE(rig.RunToEnd(ticket));
      ASSERT_TRUE(rig.lives[ticket].done) << static_cast<int>(rig.lives[ticket].error_id);
      ExpectSmooth(rig, kind.name);
      ExpectAt(ToolOf(rig), to);
      kinematics::Joints end{};
      for (std::size_t k = 0; k < count; ++k) end[k] = rig.trace.back().set[k].position;
      EXPECT_TRUE(kinematics::ConfigurationOf(*rig.kinematics, begin) ==
                  kinematics::ConfigurationOf(*rig.kinematics, end));
      for (const Sample& sample : rig.trace) {
        const double share = (Along(rig, sample) - 5) / 20;
        for (std::size_t k = 0; k < count; ++k) {
          EXPECT_NEAR(sample.set[k].position, begin[k] + share * (end[k] - begin[k]), 1e-6) << k;
        }
      }
    }
  }
}

// GR-12: lines between places far apart, also close by and through where a wrist or an elbow is stretched: refused
// before anything moves, or gone to their end without a jump and on the branch where they began.
TEST(Curves, StayOnTheirBranch) {
  int gone = 0, singular = 0, others = 0;
  for (const Kind& kind : AllKinds()) {
    if (kind.name != "six axes" && kind.name != "URDF" && kind.name != "SCARA") continue;
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(Trials(30, 1)); ++seed) {
      SCOPED_TRACE(kind.name + " " + std::to_string(seed));
      std::mt19937_64 random(seed);
      Rig rig = WithAuxiliary(kind.make());
      const bool scara = kind.name == "SCARA";
      const auto some = [&] {
        kinematics::Joints joints{};
        for (std::size_t k = 0; k < rig.kinematics->count; ++k) joints[k] = Uniform(random, -60, 60);
        if (!scara) joints[2] = Uniform(random, 30, 90), joints[4] = Uniform(random, -20, 60);
        return joints;
      };
      const kinematics::Joints from = some(), to = some();
      Frame target;
      ASSERT_EQ(kinematics::Forward(*rig.kinematics, to, target), kinematics::Reason::kNone);
      rig.Start({from.begin(), from.begin() + static_cast<std::ptrdiff_t>(rig.kinematics->count)});
      rig.Step();
      rig.trace = {rig.trace.back()};
      MoveLinearAbsolute move{.velocity = 100};
      GoTo(kinematics::ToPose(target), move);
      const Ticket ticket = rig.Give(move);
      ASSERT_TRUE(rig.RunToEnd(ticket));
      ExpectSmooth(rig, kind.name);
      if (!rig.lives[ticket].done) {
        const ErrorId error = rig.lives[ticket].error_id;
        EXPECT_TRUE(error == ErrorId::kSingular || error == ErrorId::kUnreachable) << static_cast<int>(error);
        EXPECT_EQ(rig.trace.back().set, rig.trace.front().set) << "refused, but moved";
        ++(error == ErrorId::kSingular ? singular : others);
        continue;
      }
      ++gone;
      kinematics::Joints end{};
      for (std::size_t k = 0; k < rig.kinematics->count; ++k) end[k] = rig.trace.back().set[k].position;
      EXPECT_TRUE(kinematics::ConfigurationOf(*rig.kinematics, from) ==
                  kinematics::ConfigurationOf(*rig.kinematics, end));
      ExpectAt(ToolOf(rig), kinematics::ToPose(target), 2e-6);
    }
  }
  std::cout << gone << " lines gone, " << singular << " singular, " << others << " out of reach\n";
  EXPECT_GE(gone, Trials(40, 1));
  if (!kSanitized) {
    EXPECT_GE(singular, 1);
  }
}

// How corners are gone.
struct Pace {
  double velocity = 0, acceleration = 0, jerk = 0;
  double least_deviation = 0, most_deviation = 0;  // mm
  double sharpest = 0;                             // rad, between the lines
  double turn = 0;                                 // of the way between two places' orientations
  double shortest = 0, longest = 0;                // mm, of lines
};

struct Bend {
  double deviation = 0, nearest = 1e99, off_path = 0, slowest = 1e99, step = 0;
  bool done = false;
};

// A place at a point, turned a little towards another one.
Pose TurnedTowards(const KDL::Vector& at, const Pose& from, const Pose& to, double share) {
  const KDL::Rotation begin = kinematics::ToFrame(from).M;
  const KDL::Vector turn = kinematics::TurnBetween(begin, kinematics::ToFrame(to).M);
  return kinematics::ToPose({KDL::Rot(share * turn) * begin, at});
}

// Distance of a point from the motion between two samples: a cubic with their velocities, as chords of a fast motion
// cut the corner.
double FromArc(const KDL::Vector& point, const KDL::VectorAcc& a, const KDL::VectorAcc& b, double period_s) {
  constexpr int kParts = 8;
  double nearest = (point - a.p).Norm();
  KDL::Vector last = a.p;
  for (int i = 1; i <= kParts; ++i) {
    const double x = static_cast<double>(i) / kParts, y = 1 - x;
    const KDL::Vector p =
        y * y * (1 + 2 * x) * a.p + x * x * (3 - 2 * x) * b.p + period_s * x * y * (y * a.v - x * b.v);
    nearest = std::min(nearest, (p - last).Norm() > 0 ? FromLine(point, last, p) : (point - p).Norm());
    last = p;
  }
  return nearest;
}

// Two lines with a corner, blended, with turns and an auxiliary axis.
Bend GoAroundCorner(const Kind& kind, std::uint64_t seed, const Pace& pace) {
  std::mt19937_64 random(seed);
  const auto even = [&](double low, double high) { return std::exp(Uniform(random, std::log(low), std::log(high))); };
  Rig rig = WithAuxiliary(kind.make());
  const Pose a = kind.place(random);
  const KDL::Vector begin(a.x, a.y, a.z), out = Direction(random);
  KDL::Vector on;
  do {
    on = Direction(random);
  } while (std::acos(KDL::dot(out, on)) > pace.sharpest);
  const KDL::Vector corner = begin + even(pace.shortest, pace.longest) * out;
  const KDL::Vector end = corner + even(pace.shortest, pace.longest) * on;
  const Pose p1 = TurnedTowards(corner, a, kind.place(random), pace.turn);
  const Pose p2 = TurnedTowards(end, p1, kind.place(random), pace.turn);
  Bend bend;
  bend.deviation = even(pace.least_deviation, pace.most_deviation);
  StandAt(rig, kind, a);
  MoveLinearAbsolute first{.velocity = pace.velocity, .acceleration = pace.acceleration, .jerk = pace.jerk};
  MoveLinearAbsolute second = first;
  GoTo(p1, first);
  GoTo(p2, second);
  TakeAlong(rig, 8, first);
  TakeAlong(rig, 6, second);
  second.buffer_mode = BufferMode::kBlendingNext;
  second.transition_mode = TransitionMode::kMaxCornerDeviation;
  second.transition_parameter = bend.deviation;
  rig.Give(first);
  const Ticket ticket = rig.Give(second);
  EXPECT_TRUE(rig.RunToEnd(ticket));
  ExpectSmooth(rig, kind.name);
  bend.done = rig.lives[ticket].done;
  if (!bend.done) return bend;
  ExpectAt(ToolOf(rig), p2, 2e-6);
  EXPECT_NEAR(Along(rig, rig.trace.back()), 6, 1e-9);
  kinematics::MovingFrame before = MotionOf(rig, rig.trace.front());
  for (const Sample& sample : rig.trace) {
    const kinematics::MovingFrame motion = MotionOf(rig, sample);
    const KDL::Vector& p = motion.p.p;
    const double near = FromArc(corner, before.p, motion.p, rig.cycle.period_s);
    if (near < bend.nearest) {
      bend.nearest = near;
      bend.slowest = motion.p.v.Norm();
    }
    bend.off_path = std::max(bend.off_path, std::min(FromLine(p, begin, corner), FromLine(p, corner, end)));
    bend.step = std::max(bend.step, (motion.p.dv - before.p.dv).Norm());
    before = motion;
  }
  return bend;
}

// `slack`: mm beyond the bound.
void ExpectBoundsKept(const Pace& pace, int seeds, double slack, double most_step) {
  for (const Kind& kind : AllKinds()) {
    int gone = 0;
    double worst = 0, step = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      SCOPED_TRACE(kind.name + " " + std::to_string(seed));
      const Bend bend = GoAroundCorner(kind, static_cast<std::uint64_t>(seed), pace);
      if (!bend.done) continue;
      ++gone;
      worst = std::max(worst, std::max(bend.nearest, bend.off_path) / bend.deviation);
      step = std::max(step, bend.step);
      EXPECT_LE(bend.nearest, bend.deviation * (1 + 1e-3) + slack);
      EXPECT_LE(bend.off_path, bend.deviation * (1 + 1e-3) + slack);
      // A tool that turns along goes through the sharpest of them at 0.4 mm/s.
      EXPECT_GE(bend.slowest, 0.2) << "a stop";
      EXPECT_LE(bend.step, most_step);
    }
    std::cout << kind.name << ": " << gone << " corners; " << worst << " of the deviation, steps of " << step
              << " mm/s2 at most\n";
    EXPECT_GE(gone, seeds * 2 / 3) << kind.name;
  }
}

// GR-22: random corners, lengths and bounds on every mechanism: no further from the corner than asked for, never off
// the lines by more, through it without a stop, and no step in the tool's acceleration: at this speed a corner of the
// curvature would be one of 10 to 300 mm/s2.
TEST(Curves, BlendsKeepTheirBounds) {
  ExpectBoundsKept({.velocity = 6,
                    .acceleration = 100,
                    .jerk = 2000,
                    .least_deviation = 0.2,
                    .most_deviation = 5,
                    .sharpest = 2,
                    .turn = 0.1,
                    .shortest = 4,
                    .longest = 20},
                   Trials(20, 1), kOnPath, 8);
}

// The same as fast as the axes can, sharp and with large turns: on the finest blends, gone in a few cycles, a jerk that
// the axes cannot follow takes the tool off its path by less than a µm.
TEST(Curves, BlendsKeepTheirBoundsAtTheLimits) {
  ExpectBoundsKept({.velocity = 80,
                    .acceleration = 2000,
                    .jerk = 50000,
                    .least_deviation = 0.02,
                    .most_deviation = 10,
                    .sharpest = 3,
                    .turn = 1,
                    .shortest = 2,
                    .longest = 60},
                   Trials(30, 1), 1e-3, 1e9);
}

}  // namespace
}  // namespace takt::group
