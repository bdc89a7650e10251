// GR-12, GR-20, GR-22, GR-03: moves that are none, in every place of a queue; limits of nothing; a fault in the middle
// of a blend, on every mechanism.
#include <random>

#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

PathTable Lines(const std::vector<KDL::Vector>& points) {
  PathTable table{"lines", {}};
  for (const KDL::Vector& p : points) {
    table.pieces.push_back({.shape = ElementShape::kLine, .to = {p.x(), p.y(), p.z(), 0, 0, 0}});
  }
  return table;
}

MovePath Along(double blend) {
  return {.path = Name::Of("lines"),
          .transition_mode = blend > 0 ? TransitionMode::kMaxCornerDeviation : TransitionMode::kNone,
          .transition_parameter = blend};
}

// GR-20: an element that leads to where the path already is, at its beginning, within it, at its end.
TEST(OddMoves, ElementsOfNoLengthAreSkipped) {
  for (const double blend : {0.0, 1.0}) {
    SCOPED_TRACE(blend);
    const KDL::Vector a(100, 0, 0), b(150, 0, 0), c(150, 60, 0);
    Rig rig = Gantry({Lines({a, b, b, c, c})});
    rig.StartAt({100, 0, 0, 0, 0, 0});
    const Ticket move = rig.Give(Along(blend));
    ASSERT_TRUE(rig.RunToEnd(move, 5));
    EXPECT_TRUE(rig.lives[move].done);
    ExpectAt(ToolOf(rig), {150, 60, 0, 0, 0, 0}, 1e-9);
    EXPECT_EQ(rig.out().state, GroupState::kStandby);
    ExpectSmooth(rig);
    for (const Sample& sample : rig.trace) {
      const KDL::Vector p = ToolOf(rig, sample).p;
      EXPECT_LE(std::min(FromLine(p, a, b), FromLine(p, b, c)), blend * (1 + 1e-3) + 1e-9);
    }
  }
}

// GR-20: a whole path of nothing is done without a motion.
TEST(OddMoves, APathOfNoLengthIsDone) {
  const KDL::Vector a(100, 0, 0);
  Rig rig = Gantry({Lines({a, a})});
  rig.StartAt({100, 0, 0, 0, 0, 0});
  rig.Step();
  const std::vector<KinematicState> before = rig.trace.back().set;
  const Ticket move = rig.Give(Along(0));
  ASSERT_TRUE(rig.RunToEnd(move, 0.1));
  EXPECT_TRUE(rig.lives[move].done);
  rig.Run(0.01);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_EQ(rig.trace.back().set, before);
}

// GR-20: between blended moves, as often as one likes: all are done, the tool ends where the last one does.
TEST(OddMoves, OfNoLengthBetweenBlends) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE(i);
    Rig rig = Gantry();
    rig.Start({100, 0, 0});
    KDL::Vector at(100, 0, 0);
    std::vector<Ticket> tickets;
    for (int k = 0; k < 8; ++k) {
      if (random() % 2) at = {Uniform(random, -100, 100), Uniform(random, -100, 100), Uniform(random, -50, 50)};
      MoveLinearAbsolute move{.x = at.x(), .y = at.y(), .z = at.z()};
      move.buffer_mode = static_cast<BufferMode>(1 + random() % 5);
      move.transition_mode = static_cast<TransitionMode>(random() % 5);
      move.transition_parameter = Uniform(random, 0, 20);
      tickets.push_back(rig.Give(move));
    }
    ASSERT_TRUE(rig.RunToEnd(tickets.back(), 20));
    for (const Ticket ticket : tickets) EXPECT_TRUE(rig.lives[ticket].done) << ticket;
    EXPECT_LE((ToolOf(rig).p - at).Norm(), 1e-9);
    ExpectSmooth(rig);
  }
}

// GR-20: arcs from a place to itself through another one, or of no radius; a helix of no radius.
TEST(OddMoves, ArcsOfNothingAreRefused) {
  for (const path::CircMode mode : {path::CircMode::kBorder, path::CircMode::kCenter, path::CircMode::kRadius}) {
    for (const double rise : {0.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(mode) << " " << rise);
      Rig rig = Gantry();
      rig.Start({100, 0, 0});
      rig.Step();
      const std::vector<KinematicState> before = rig.trace.back().set;
      MoveCircularRelative move{.circ_mode = mode};
      move.normal_z = mode == path::CircMode::kCenter ? 1 : 0;
      move.z = rise;  // and the auxiliary point is where the tool is, or a radius of 0
      if (mode == path::CircMode::kRadius) move.path_choice = path::PathChoice::kShort;
      const Ticket ticket = rig.Give(move);
      ASSERT_TRUE(rig.RunToEnd(ticket, 0.5));
      EXPECT_EQ(rig.lives[ticket].error_id, ErrorId::kPathGeometry);
      EXPECT_NE(rig.out().problem, path::Problem::kNone);
      rig.Run(0.01);
      EXPECT_EQ(rig.out().state, GroupState::kStandby);
      EXPECT_EQ(rig.trace.back().set, before);
    }
  }
}

// GR-20: limits of nothing.
TEST(OddMoves, LimitsOfNothingAreRefused) {
  Rig rig = Gantry();
  rig.Start();
  const std::vector<Command> bad = {Stop{.deceleration = 0},
                                    Stop{.jerk = 0},
                                    Halt{.deceleration = 0},
                                    Interrupt{.deceleration = 0},
                                    SetOverride{.acceleration_factor = 0},
                                    SetOverride{.jerk_factor = 0},
                                    MoveDirectAbsolute{.a1 = 1, .acceleration_factor = 0},
                                    MoveDirectAbsolute{.a1 = 1, .jerk_factor = 0},
                                    MovePath{.path = Name::Of("lines"), .velocity = 0},
                                    MoveLinearAbsolute{.x = 1, .transition_parameter = -1}};
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const Ticket ticket = rig.Give(bad[i]);
    ASSERT_TRUE(rig.RunToEnd(ticket, 0.5)) << i;
    EXPECT_TRUE(rig.lives[ticket].error) << i;
    EXPECT_EQ(rig.out().state, GroupState::kStandby) << i;
  }
}

// Two lines with a blend that takes half of either, slowly enough for all axes.
Ticket GiveBlend(Rig& rig, const KDL::Vector& a) {
  const auto to = [](const KDL::Vector& p) {
    return MoveLinearAbsolute{.x = p.x(), .y = p.y(), .z = p.z(), .velocity = 60, .acceleration = 600, .jerk = 8000};
  };
  rig.Give(to(a + KDL::Vector(0, 40, 0)));
  MoveLinearAbsolute second = to(a + KDL::Vector(0, 40, -40));
  second.buffer_mode = BufferMode::kBlendingNext;
  second.transition_mode = TransitionMode::kCornerDistance;
  second.transition_parameter = 20;
  return rig.Give(second);
}

// GR-03: a fault of any member in the middle of a blend: a member whose loop stays closed comes to rest on the blend
// with the others; where its loop is open the others brake all the same. Once mended the group goes on from where it
// stands.
TEST(OddMoves, AFaultInTheMiddleOfABlend) {
  for (const Kind& kind : Kinds()) {
    std::mt19937_64 random(2);
    const Pose at = kind.place(random);
    const KDL::Vector a(at.x, at.y, at.z), corner = a + KDL::Vector(0, 40, 0);
    Rig whole = kind.make();
    whole.StartAt(at);
    ASSERT_TRUE(whole.RunToEnd(GiveBlend(whole, a), 10));
    std::size_t middle = 0;
    std::vector<KDL::Vector> way;
    for (const Sample& sample : whole.trace) {
      way.push_back(ToolOf(whole, sample).p);
      if ((way.back() - corner).Norm() < (way[middle] - corner).Norm()) middle = way.size() - 1;
    }
    ASSERT_GT((way[middle] - corner).Norm(), 1);
    for (std::size_t member = 0; member < whole.kinematics->count; ++member) {
      for (const bool closed : {true, false}) {
        SCOPED_TRACE(testing::Message() << kind.name << ", member " << member << (closed ? ", loop closed" : ", open"));
        Rig rig = kind.make();
        rig.StartAt(at);
        const Ticket ticket = GiveBlend(rig, a);
        while (rig.trace.size() < middle) rig.Step();
        (closed ? rig.inputs[member].limit_positive : rig.inputs[member].drive_fault) = true;
        (closed ? rig.inputs[member].limit_negative : rig.inputs[member].drive_fault) = true;
        rig.Run(0.6);
        EXPECT_EQ(rig.out().state, GroupState::kErrorStop);
        EXPECT_EQ(rig.lives[ticket].error_id, rig.out().error);
        double worst = 0;
        for (const Sample& sample : rig.trace) {
          double least = 1e99;
          const KDL::Vector p = ToolOf(rig, sample).p;
          for (std::size_t i = 1; i < way.size(); ++i) {
            if (way[i] != way[i - 1]) least = std::min(least, FromLine(p, way[i - 1], way[i]));
          }
          worst = std::max(worst, least);
        }
        // Between two samples of the blend its way is no chord.
        EXPECT_LE(worst, closed ? 1e-4 : 1e99);
        Use use;
        for (std::size_t n = 1; n < rig.trace.size(); ++n) {
          for (std::size_t i = 0; i < rig.axes.size(); ++i) {
            EXPECT_TRUE(std::isfinite(rig.trace[n].set[i].position));
            if (i == member && !closed) continue;
            Take(rig.trace[n - 1].set[i], rig.trace[n].set[i], rig.axes[i].limits, rig.cycle.period_s, use);
          }
        }
        EXPECT_LE(use.acceleration, 1 + 1e-9);
        EXPECT_LE(use.jerk, 1 + 1e-6);
        EXPECT_LE(use.step, 1e-4);
        for (const KinematicState& set : rig.trace.back().set) EXPECT_EQ(set.velocity, 0);
        rig.inputs[member].limit_positive = rig.inputs[member].limit_negative = rig.inputs[member].drive_fault = false;
        ASSERT_TRUE(rig.RunToEnd(rig.Give(Reset{}), 2));
        ASSERT_TRUE(rig.RunToEnd(rig.Give(Power{}), 2));
        const Ticket again = rig.Give(MoveLinearAbsolute{.x = a.x(), .y = a.y(), .z = a.z(), .velocity = 100});
        ASSERT_TRUE(rig.RunToEnd(again, 5));
        EXPECT_TRUE(rig.lives[again].done) << static_cast<int>(rig.lives[again].error_id);
        EXPECT_LE((ToolOf(rig).p - a).Norm(), 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace takt::group
