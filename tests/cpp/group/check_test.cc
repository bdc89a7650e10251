// GR-13, GR-12: a path is asked about before it starts. Here the answers come from the test.
#include <random>

#include "../core/allocations.h"
#include "belts.h"
#include "machines.h"
#include "takt/group/survey.h"
#include "watch.h"

namespace takt::group {
namespace {

using workspace::Trouble;

constexpr BufferMode kBlending = BufferMode::kBlendingNext;

Rig Watched(Rig (*make)()) {
  Rig rig = make();
  rig.params.workspace.emplace();
  return rig;
}
Rig WatchedGantry() {
  return Watched([] { return Gantry(); });
}

std::optional<PathCheckRequest> Asked(Rig& rig) {
  PathCheckRequest question, last;
  bool any = false;
  while (rig.questions->TryPop(question)) {
    last = question;
    any = true;
  }
  return any ? std::optional(last) : std::nullopt;
}

PathChecked Free(const PathCheckRequest& question) {
  return {.number = question.number};
}
PathChecked Blocked(const PathCheckRequest& question) {
  return {.number = question.number, .trouble = Trouble::kCollision, .first = 8, .second = 9, .place = 12.5};
}

// Answers whatever is asked after so many cycles, until a move has ended.
void RunAnswering(Rig& rig, Ticket move, int late = 0, double seconds = 20) {
  std::optional<PathCheckRequest> open;
  int left = 0;
  for (auto n = std::llround(seconds / rig.cycle.period_s); n > 0 && !rig.lives[move].ended(); --n) {
    rig.Step();
    if (std::optional<PathCheckRequest> asked = Asked(rig)) {
      open = asked;
      left = late;
    }
    if (open && left-- == 0) {
      rig.Give(Free(*open));
      open.reset();
    }
  }
}

TEST(Check, NothingMovesBeforeTheAnswer) {
  Rig rig = WatchedGantry();
  rig.Start();
  rig.Step();
  const std::vector<KinematicState> before = rig.trace.back().set;
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Run(0.5);
  const std::optional<PathCheckRequest> question = Asked(rig);
  ASSERT_TRUE(question);
  EXPECT_EQ(question->move.ticket, move);
  EXPECT_EQ(rig.trace.back().set, before);
  EXPECT_TRUE(rig.out().checking);
  EXPECT_EQ(rig.out().state, GroupState::kMoving);
  EXPECT_FALSE(Asked(rig)) << "asked twice";
  rig.Give(Free(*question));
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_NEAR(rig.out().x, 100, 1e-9);
  EXPECT_FALSE(rig.out().checking);
}

TEST(Check, ARefusedMoveEndsWithWhatIsInTheWay) {
  Rig rig = WatchedGantry();
  rig.Start();
  rig.Step();
  const std::vector<KinematicState> before = rig.trace.back().set;
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 100});
  const Ticket behind = rig.Give(MoveLinearAbsolute{.x = 0, .buffer_mode = BufferMode::kBuffered});
  rig.Run(0.02);
  rig.Give(Blocked(*Asked(rig)));
  ASSERT_TRUE(rig.RunToEnd(move, 0.1));
  EXPECT_EQ(rig.lives[move].error_id, ErrorId::kCollision);
  EXPECT_TRUE(rig.lives[behind].aborted);
  rig.Run(0.1);
  EXPECT_EQ(rig.trace.back().set, before);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_EQ(rig.out().trouble, Trouble::kCollision);
  EXPECT_EQ(rig.out().first_part, 8u);
  EXPECT_EQ(rig.out().second_part, 9u);
  EXPECT_EQ(rig.out().blocked_at, 12.5);
  const Ticket next = rig.Give(MoveLinearAbsolute{.y = 10});
  RunAnswering(rig, next);
  EXPECT_TRUE(rig.lives[next].done);
  EXPECT_EQ(rig.out().trouble, Trouble::kNone);
}

// What is being gone goes on to its end, and stops there.
TEST(Check, TheMotionGoesOnWhileTheNextMoveIsChecked) {
  for (const int late : {0, 3, 40, 120, 1000}) {  // while it moves, while it brakes, when it stands
    for (const double y : {0.0, 100.0}) {         // straight on, and a corner to be rounded
      SCOPED_TRACE(std::to_string(late) + " cycles late, y " + std::to_string(y));
      Rig rig = WatchedGantry();
      rig.Start();
      const Ticket first = rig.Give(MoveLinearAbsolute{.x = 100});
      rig.Step();
      ASSERT_TRUE(Asked(rig));
      rig.Give(PathChecked{.number = 1});
      const Ticket second = rig.Give(MoveLinearAbsolute{.x = y == 0 ? 200.0 : 100.0,
                                                        .y = y,
                                                        .buffer_mode = kBlending,
                                                        .transition_mode = TransitionMode::kMaxCornerDeviation,
                                                        .transition_parameter = 5});
      RunAnswering(rig, second, late);
      EXPECT_TRUE(rig.lives[first].done);
      EXPECT_TRUE(rig.lives[second].done);
      EXPECT_NEAR(rig.out().x, y == 0 ? 200 : 100, 1e-9);
      EXPECT_NEAR(rig.out().y, y, 1e-9);
      ExpectSmooth(rig);
      double nearest = 1e9;
      for (const Sample& sample : rig.trace) nearest = std::min(nearest, std::hypot(sample.out.x - 100, sample.out.y));
      if (y > 0 && late == 0) {
        EXPECT_NEAR(nearest, 5, 0.5);  // rounded
      }
      if (late == 1000) {
        EXPECT_LT(nearest, 1e-6);  // stood there
      }
    }
  }
}

TEST(Check, ARefusedMoveBehindAnotherLetsThatEnd) {
  Rig rig = WatchedGantry();
  rig.Start();
  const Ticket first = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Step();
  rig.Give(Free(*Asked(rig)));
  rig.Step();
  const Ticket second = rig.Give(MoveLinearAbsolute{.x = 200, .buffer_mode = kBlending});
  rig.Run(0.05);
  rig.Give(Blocked(*Asked(rig)));
  ASSERT_TRUE(rig.RunToEnd(first));
  EXPECT_TRUE(rig.lives[first].done);
  EXPECT_EQ(rig.lives[second].error_id, ErrorId::kCollision);
  EXPECT_NEAR(rig.out().x, 100, 1e-9);
  EXPECT_EQ(rig.out().trouble, Trouble::kCollision);
  EXPECT_EQ(rig.out().blocked_at, 12.5);
  ExpectSmooth(rig);
}

// Whatever ends a move that waits for its answer: the answer comes too late and changes nothing.
TEST(Check, AnAnswerThatIsNotWaitedForIsDropped) {
  const struct {
    const char* name;
    Command command;
    GroupState state;
  } cases[] = {{"stop", Stop{}, GroupState::kStandby},
               {"held stop", Stop{.hold = true}, GroupState::kStopping},
               {"halt", Halt{}, GroupState::kStandby},
               {"disable", Disable{}, GroupState::kDisabled},
               {"power off", Power{.enable = false}, GroupState::kStandby}};
  for (const bool on_the_way : {false, true}) {
    for (const bool good : {false, true}) {
      for (const auto& one : cases) {
        SCOPED_TRACE(std::string(one.name) + (on_the_way ? ", on the way" : "") + (good ? ", free" : ", blocked"));
        Rig rig = WatchedGantry();
        rig.Start();
        const Ticket first = rig.Give(MoveLinearAbsolute{.x = 100});
        rig.Step();
        if (on_the_way) {
          rig.Give(Free(*Asked(rig)));
          rig.Run(0.05);
        }
        const Ticket second = rig.Give(MoveLinearAbsolute{.x = 200, .buffer_mode = kBlending});
        rig.Run(0.05);
        const std::optional<PathCheckRequest> question = Asked(rig);
        ASSERT_TRUE(question);
        const Ticket end = rig.Give(one.command);
        rig.Step();
        const PathChecked answer = good ? Free(*question) : Blocked(*question);
        rig.Give(answer);
        rig.Run(1);
        rig.Give(answer);
        rig.Run(0.1);
        EXPECT_TRUE(rig.lives[end].done);
        EXPECT_EQ(rig.out().state, one.state);
        EXPECT_TRUE(rig.lives[first].aborted);
        EXPECT_TRUE(rig.lives[second].aborted);
        EXPECT_FALSE(rig.out().checking);
        EXPECT_EQ(rig.state.illegal_transitions, 0u);
        EXPECT_LT(rig.out().x, on_the_way ? 99 : 1e-9);
        ExpectSmooth(rig);
      }
    }
  }
}

TEST(Check, AFaultEndsTheWaiting) {
  Rig rig = WatchedGantry();
  rig.Start();
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Run(0.01);
  const std::optional<PathCheckRequest> question = Asked(rig);
  rig.inputs[1].drive_fault = true;
  rig.Step();
  rig.Give(Free(*question));
  rig.Run(0.2);
  EXPECT_TRUE(rig.lives[move].error);
  EXPECT_EQ(rig.out().state, GroupState::kErrorStop);
  EXPECT_EQ(rig.out().x, 0);
}

TEST(Check, AnAbortingMoveIsAskedAboutInstead) {
  Rig rig = WatchedGantry();
  rig.Start();
  const Ticket first = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Run(0.01);
  const std::optional<PathCheckRequest> old = Asked(rig);
  const Ticket second = rig.Give(MoveLinearAbsolute{.y = 50});
  rig.Step();
  rig.Give(Blocked(*old));
  rig.Run(0.01);
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_FALSE(rig.lives[second].ended());
  const std::optional<PathCheckRequest> now = Asked(rig);
  ASSERT_TRUE(now);
  EXPECT_GT(now->number, old->number);
  rig.Give(Free(*now));
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_NEAR(rig.out().y, 50, 1e-9);
  EXPECT_EQ(rig.out().x, 0);
}

TEST(Check, AnInterruptedGroupTakesTheAnswerWhenItGoesOn) {
  Rig rig = WatchedGantry();
  rig.Start();
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Run(0.01);
  rig.Give(Interrupt{});
  rig.Step();
  rig.Give(Free(*Asked(rig)));
  rig.Run(0.2);
  EXPECT_EQ(rig.out().x, 0);
  rig.Give(Continue{});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
}

TEST(Check, OnlyTheAwaitedNumberIsTaken) {
  Rig rig = WatchedGantry();
  rig.Start();
  const Ticket early = rig.Give(PathChecked{.number = 1});
  rig.Step();
  EXPECT_EQ(rig.lives[early].error_id, ErrorId::kState);
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Run(0.01);
  for (const std::uint64_t number : {0, 2, 3}) {
    const Ticket wrong = rig.Give(PathChecked{.number = number});
    rig.Run(0.01);
    EXPECT_EQ(rig.lives[wrong].error_id, ErrorId::kState);
  }
  EXPECT_EQ(rig.out().x, 0);
  rig.Give(PathChecked{.number = 1});
  const Ticket twice = rig.Give(PathChecked{.number = 1, .trouble = Trouble::kCollision});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_EQ(rig.lives[twice].error_id, ErrorId::kState);
}

TEST(Check, WithoutWorkspaceOrKinematicsNobodyIsAsked) {
  Rig plain = Gantry();
  plain.Start();
  ASSERT_TRUE(plain.RunToEnd(plain.Give(MoveLinearAbsolute{.x = 10})));
  EXPECT_FALSE(Asked(plain));
  Rig off = WatchedGantry();
  off.Start();
  off.Give(Disable{});
  off.Give(SetKinTransform{.enable = false});
  off.Give(Enable{});
  const Ticket move = off.Give(MoveDirectAbsolute{.a1 = 10});
  ASSERT_TRUE(off.RunToEnd(move));
  EXPECT_TRUE(off.lives[move].done);
  EXPECT_FALSE(Asked(off));
}

PathTable LongPath(int elements, double far_at = -1) {
  PathTable table{.name = "long", .pieces = {}};
  for (int i = 0; i < elements; ++i) {
    PathPiece piece;
    piece.to = {5.0 * (i + 1), i % 2 == 0 ? 4.0 : 0.0, i == far_at ? 9000.0 : 0.0, 0, 0, 0};
    table.pieces.push_back(piece);
  }
  return table;
}

// GR-12: all elements but the 40th are good.
TEST(Check, APathIsTriedToItsEndBeforeItBegins) {
  for (const bool watched : {false, true}) {
    Rig rig = Gantry({LongPath(60, 39)});
    if (watched) rig.params.workspace.emplace();
    rig.axes[2].limits.upper = 1000;
    rig.Start();
    rig.Step();
    const std::vector<KinematicState> before = rig.trace.back().set;
    const Ticket move = rig.Give(MovePath{.path = Name::Of("long")});
    ASSERT_TRUE(rig.RunToEnd(move, 1));
    EXPECT_EQ(rig.lives[move].error_id, ErrorId::kUnreachable);
    EXPECT_EQ(rig.lives[move].value, 40);
    EXPECT_EQ(rig.out().blocked_element, 40u);
    EXPECT_EQ(rig.out().reason, kinematics::Reason::kAxisLimit);
    EXPECT_FALSE(Asked(rig));
    rig.Run(0.2);
    EXPECT_EQ(rig.trace.back().set, before);
    EXPECT_EQ(rig.out().state, GroupState::kStandby);
    const Ticket next = rig.Give(MoveLinearAbsolute{.x = 10});  // from where it stands
    RunAnswering(rig, next);
    EXPECT_TRUE(rig.lives[next].done);
    EXPECT_NEAR(rig.out().x, 10, 1e-9);
    EXPECT_EQ(rig.out().y, 0);
  }
}

TEST(Check, APathIsOneQuestion) {
  Rig rig = Gantry({LongPath(60)});
  rig.params.workspace.emplace();
  rig.Start();
  const Ticket move = rig.Give(MovePath{
      .path = Name::Of("long"), .transition_mode = TransitionMode::kMaxCornerDeviation, .transition_parameter = 0.5});
  rig.Run(0.2);
  const std::optional<PathCheckRequest> question = Asked(rig);
  ASSERT_TRUE(question);
  EXPECT_EQ(rig.out().x, 0);
  rig.Give(Free(*question));
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_FALSE(Asked(rig));
  EXPECT_NEAR(rig.out().x, 300, 1e-9);
  ExpectSmooth(rig);
}

// It is tried while the move before it is gone, and joined to that.
TEST(Check, APathBehindAMoveGoesOnFromThere) {
  for (const bool good : {true, false}) {
    Rig rig = Gantry({LongPath(60, good ? -1 : 39)});
    rig.params.workspace.emplace();
    rig.axes[2].limits.upper = 1000;
    rig.Start();
    const Ticket first = rig.Give(MoveLinearAbsolute{.x = -100});
    rig.Step();
    const Ticket path = rig.Give(MovePath{.path = Name::Of("long"), .buffer_mode = BufferMode::kBuffered});
    rig.Give(Free(*Asked(rig)));
    RunAnswering(rig, path);
    EXPECT_EQ(rig.lives[path].done, good);
    const Ticket last = rig.Give(MoveLinearRelative{.y = 10, .buffer_mode = BufferMode::kBuffered});
    RunAnswering(rig, last);
    EXPECT_TRUE(rig.lives[first].done);
    EXPECT_TRUE(rig.lives[last].done);
    EXPECT_NEAR(rig.out().x, good ? 300 : -100, 1e-9);
    EXPECT_NEAR(rig.out().y, 10, 1e-9);
    ExpectSmooth(rig);
    bool there = false;
    for (std::size_t i = 1; i < rig.trace.size(); ++i) {
      if (there) {
        EXPECT_GE(rig.trace[i].out.x, rig.trace[i - 1].out.x - 0.001) << "goes back";
      }
      there |= rig.trace[i].out.x < -99.999;
    }
    EXPECT_TRUE(there);
  }
}

TEST(Check, ABadElementOfAPathIsNamed) {
  Rig rig = Gantry({LongPath(60)});
  rig.params.workspace.emplace();
  rig.Start();
  const Ticket move = rig.Give(MovePath{.path = Name::Of("long")});
  rig.Run(0.2);
  PathChecked answer = Blocked(*Asked(rig));
  answer.element = 17;
  rig.Give(answer);
  ASSERT_TRUE(rig.RunToEnd(move, 0.1));
  EXPECT_EQ(rig.lives[move].error_id, ErrorId::kCollision);
  EXPECT_EQ(rig.lives[move].value, 17);
  EXPECT_EQ(rig.out().blocked_element, 17u);
  rig.Run(0.1);
  EXPECT_EQ(rig.out().x, 0);
}

struct SeenPart {
  std::uint32_t element = 0;
  bool on_blend = false;
  std::vector<workspace::Sample> samples;
};

std::vector<SeenPart> Surveyed(Rig& rig, const PathCheckRequest& question) {
  Survey survey({rig.params, rig.mounting, *rig.kinematics, rig.paths, rig.cycle});
  std::vector<SeenPart> seen;
  EXPECT_EQ(survey.Run(question,
                       [&](const Survey::Part& part) {
                         seen.push_back({part.element, part.on_blend, {part.samples.begin(), part.samples.end()}});
                         return true;
                       }),
            kinematics::Reason::kNone);
  return seen;
}

// What is looked at is what is gone: on every mechanism each place of the motion lies on what was surveyed.
TEST(Survey, IsWhatIsGone) {
  for (const Kind& kind : Kinds()) {
    SCOPED_TRACE(kind.name);
    std::mt19937_64 random(7);
    Rig rig = kind.make();
    rig.params.workspace.emplace();
    rig.StartAt(kind.place(random));
    rig.Step();
    rig.trace = {rig.trace.back()};
    std::vector<workspace::Sample> all;
    Ticket last = 0;
    for (int i = 0; i < 4; ++i) {
      const Pose to = kind.place(random);
      last = rig.Give(MoveLinearAbsolute{.x = to.x,
                                         .y = to.y,
                                         .z = to.z,
                                         .a = to.a,
                                         .b = to.b,
                                         .c = to.c,
                                         .velocity = 100,
                                         .buffer_mode = i == 0 ? BufferMode::kBuffered : kBlending,
                                         .transition_mode = TransitionMode::kCornerDistance,
                                         .transition_parameter = 30});
    }
    int blends = 0;
    for (int n = 0; n < 60000 && !rig.lives[last].ended(); ++n) {
      rig.Step();
      const std::optional<PathCheckRequest> question = Asked(rig);
      if (!question) continue;
      for (const SeenPart& part : Surveyed(rig, *question)) {
        all.insert(all.end(), part.samples.begin(), part.samples.end());
        blends += part.on_blend;
      }
      rig.Give(Free(*question));
    }
    ASSERT_TRUE(rig.lives[last].done);
    EXPECT_EQ(blends, 3);
    double worst = 0;
    const std::size_t joints = rig.kinematics->count;
    for (const Sample& sample : rig.trace) {
      double nearest = 1e9;
      for (std::size_t i = 1; i < all.size(); ++i) {
        double share = 0, way = 0, off = 0;
        for (std::size_t k = 0; k < joints; ++k) {
          const double step = all[i].joints[k] - all[i - 1].joints[k];
          share += step * (sample.set[k].position - all[i - 1].joints[k]);
          way += step * step;
        }
        share = way > 0 ? std::clamp(share / way, 0.0, 1.0) : 0;
        for (std::size_t k = 0; k < joints; ++k) {
          const double at = std::lerp(all[i - 1].joints[k], all[i].joints[k], share);
          off = std::max(off, std::abs(sample.set[k].position - at));
        }
        nearest = std::min(nearest, off);
      }
      worst = std::max(worst, nearest);
    }
    EXPECT_LT(worst, 0.005) << "mm or deg of an axis";
  }
}

TEST(Survey, CountsTheWayAndTheElements) {
  Rig rig = Gantry({LongPath(4)});
  rig.params.workspace.emplace();
  rig.Start();
  rig.Give(MovePath{
      .path = Name::Of("long"), .transition_mode = TransitionMode::kCornerDistance, .transition_parameter = 1});
  rig.Run(0.05);
  const std::vector<SeenPart> seen = Surveyed(rig, *Asked(rig));
  ASSERT_EQ(seen.size(), 7u);
  const double length = std::hypot(5, 4);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].on_blend, i % 2 == 1);
    EXPECT_EQ(seen[i].element, (i + 1) / 2 + 1);
    const double corner = static_cast<double>((i + 1) / 2) * length;
    EXPECT_NEAR(seen[i].samples.front().s, seen[i].on_blend ? corner - 1 : corner, 1e-9);
    EXPECT_NEAR(seen[i].samples.back().s, seen[i].on_blend ? corner + 1 : corner + length, 1e-9);
    EXPECT_GE(seen[i].samples.size(), 8u);
  }
  // The parts that are no blends go on from one another.
  EXPECT_EQ(seen[0].samples.back().joints, seen[2].samples.front().joints);
}

// GR-30: asking takes no memory.
TEST(Check, TakesNoMemoryInTheCycle) {
  Rig rig = Gantry({LongPath(60)});
  rig.params.workspace.emplace();
  rig.Start();
  rig.Step();
  Context c = rig.Now();
  EXPECT_EQ(Diagnose(PathChecked{}), "");
  EXPECT_EQ(Diagnose(MovePath{.path = Name::Of("long")}), "");
  const long before = AllocationsOfThisThread();
  Apply(c, 1000, 0, MovePath{.path = Name::Of("long")}, rig.state);
  std::uint64_t answered = 0;
  for (int i = 0; i < 500; ++i) {
    Step(c, rig.state);
    for (std::size_t k = 0; k < 3; ++k) axis::Move(rig.AxisContext(k), rig.states[k]);
    c.feedback.Clear();
    PathCheckRequest question;
    if (!rig.questions->TryPop(question)) continue;
    ++answered;
    Apply(c, 0, 0, Free(question), rig.state);
  }
  EXPECT_EQ(AllocationsOfThisThread() - before, 0);
  EXPECT_EQ(answered, 1u);
  EXPECT_GT(rig.states[0].setpoint.position, 10);
}

// GR-45: a path that begins on what moves is asked about, too, as it will lie in the MCS: from where the carrier takes
// the tool to where the target will be. Nothing of it is gone before the answer.
TEST(Check, PathsThatBeginOnABelt) {
  for (const double speed : {0.0, 120.0}) {
    for (const bool stays : {false, true}) {  // on the belt, or off it
      SCOPED_TRACE(testing::Message() << speed << (stays ? ", on the belt" : ", off it"));
      Rig rig = WatchedGantry();
      const auto belts = Put(rig, {BeltAt("belt", {0, 200, 0, 0, 0, 0}, [=](double t) { return Steady(t, speed); })});
      rig.Start();
      rig.Give(SetDynCoordTransform{.pcs = 3, .carrier = Name::Of("belt"), .x = 50});
      RunAnswering(rig, rig.Give(MoveLinearAbsolute{
                            .x = 0, .y = 0, .z = 0, .coordinate_system = CoordinateSystem::kPcs, .pcs = 3}));
      rig.Run(0.3);
      Asked(rig);
      const KDL::Vector left = ToolOf(rig).p;
      const Ticket move =
          stays ? rig.Give(MoveLinearAbsolute{.z = 40, .coordinate_system = CoordinateSystem::kPcs, .pcs = 3})
                : rig.Give(MoveLinearAbsolute{.x = 10, .y = 0, .z = 30});
      rig.Run(0.05);
      const std::optional<PathCheckRequest> question = Asked(rig);
      ASSERT_TRUE(question);
      EXPECT_NEAR(ToolOf(rig).p.y(), 200, 1e-6);
      EXPECT_NEAR(ToolOf(rig).p.z(), 0, 1e-6);
      EXPECT_NEAR(ToolOf(rig).p.x(), left.x() + 0.05 * speed, 1e-6);
      EXPECT_NEAR(question->from[0], left.x() + 0.01 * speed, 0.05 * speed + 1e-6);
      EXPECT_NEAR(question->from[1], 200, 1e-6);
      EXPECT_EQ(question->move.cargo.carrier, 0u);
      const Pose& target = question->move.frame;
      EXPECT_NEAR(target.y, stays ? 200 : 0, 1e-6);
      EXPECT_NEAR(target.z, stays ? 40 : 30, 1e-6);
      if (stays) {
        EXPECT_GE(target.x, left.x() + 0.1 * speed);
        EXPECT_LE(target.x, left.x() + 0.5 * speed + 1e-6);
      } else {
        EXPECT_NEAR(target.x, 10, 1e-6);
      }
      rig.Give(Blocked(*question));
      ASSERT_TRUE(rig.RunToEnd(move, 0.5));
      EXPECT_EQ(rig.lives[move].error_id, ErrorId::kCollision);
    }
  }
}

}  // namespace
}  // namespace takt::group
