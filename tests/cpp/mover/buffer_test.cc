// Commands that wait for their turn: PL-71; why a mover does not go on: PL-70.
#include "takt/mover/buffer.h"

#include "rig.h"

namespace takt::mover {
namespace {

MoveToPosition To(double x, double y, double blending = 0) {
  return {.x = x, .y = y, .buffer_mode = Buffering::kBuffered, .blending = blending};
}

double Speed(const Rig& rig) {
  return std::hypot(rig.out.velocity_x, rig.out.velocity_y);
}

TEST(MoverBuffer, EachBeginsWhenTheOneBeforeIsDoneAndSaysHowLongItTook) {
  Rig rig;
  rig.Enable();
  const Ticket first = rig.Give(To(100, 0));
  const Ticket second = rig.Give(MoveZ{.position = 2, .buffer_mode = Buffering::kBuffered});
  const Ticket third = rig.Give(To(100, 200));
  rig.Step();
  EXPECT_EQ(rig.Of(first).state, FeedbackState::kActive);
  EXPECT_EQ(rig.out.buffered, 2u);
  rig.Finish(first);
  EXPECT_EQ(rig.out.x, 100);
  EXPECT_EQ(rig.out.z, 0);
  rig.Finish(second);
  EXPECT_EQ(rig.out.z, 2);
  EXPECT_EQ(rig.out.y, 0);
  rig.Finish(third);
  EXPECT_EQ(rig.out.y, 200);
  for (const Ticket ticket : {first, second, third}) {
    EXPECT_EQ(rig.Of(ticket).state, FeedbackState::kDone);
    EXPECT_NEAR(rig.Of(ticket).value, rig.planned_s[ticket], 1.01 * rig.cycle.period_s) << ticket;
  }
  const History& history = rig.state.history;
  EXPECT_EQ(history.records[3].begun, history.records[2].changed + 1);
}

// On one line, far enough ahead, two moves are one: no time is lost.
TEST(MoverBuffer, GoesOnAlongALineAsIfItWereOneMove) {
  Rig one, two;
  one.Enable();
  two.Enable();
  const int alone = one.Finish(one.Give(MoveToPosition{.x = 900}));
  two.Give(MoveToPosition{.x = 400});
  const Ticket last = two.Give(To(900, 0, 399));
  Watch watch(two);
  int cycles = 0;
  for (; !IsFinal(two.Of(last).state); ++cycles) {
    two.Step();
    watch.Look();
  }
  EXPECT_NEAR(cycles, alone, 5);  // it looks some cycles ahead, and the jerk turns twice
}

// Round a square: it does not stop at the corners, cuts them by no more than it may, and keeps its limits.
TEST(MoverBuffer, BlendsAtCorners) {
  for (const double blending : {20.0, 60.0, 100.0}) {
    Rig rig;
    rig.Enable();
    rig.Give(MoveToPosition{.x = 300});
    const std::vector<Ticket> rest{rig.Give(To(300, 300, blending)), rig.Give(To(0, 300, blending)),
                                   rig.Give(To(0, 0, blending))};
    Watch watch(rig);
    std::vector<double> nearest(3, INFINITY);
    const std::vector<std::pair<double, double>> corners{{300, 0}, {300, 300}, {0, 300}};
    double slowest = INFINITY;
    int cycles = 0;
    for (; !IsFinal(rig.Of(rest.back()).state) && cycles < 5000; ++cycles) {
      rig.Step();
      watch.Look();
      for (std::size_t i = 0; i < 3; ++i) {
        nearest[i] = std::min(nearest[i], std::hypot(rig.out.x - corners[i].first, rig.out.y - corners[i].second));
      }
      if (cycles > 50 && rig.state.buffer.count > 0) slowest = std::min(slowest, Speed(rig));
    }
    for (const double distance : nearest) EXPECT_LE(distance, blending + 1e-9);
    EXPECT_GT(slowest, 1) << blending;
    EXPECT_EQ(rig.out.x, 0);
    EXPECT_EQ(rig.out.y, 0);
    // Each is done where the next one took over.
    EXPECT_EQ(rig.Of(rest[0]).state, FeedbackState::kDone);
    Rig stops;
    stops.Enable();
    stops.Give(MoveToPosition{.x = 300});
    stops.Give(To(300, 300));
    stops.Give(To(0, 300));
    EXPECT_LT(cycles, stops.Finish(stops.Give(To(0, 0))) - 3);
  }
}

TEST(MoverBuffer, WaitsForTime) {
  Rig rig;
  rig.Enable();
  const Ticket wait = rig.Give(Wait{.duration = 0.25});
  const Ticket move = rig.Give(To(10, 0));
  rig.Step();
  EXPECT_EQ(rig.Of(wait).state, FeedbackState::kActive);
  EXPECT_EQ(rig.out.delay, Delay::kTime);
  EXPECT_EQ(rig.out.delay_since, rig.cycle.count - 1);
  EXPECT_EQ(rig.Finish(wait), 250);
  EXPECT_NEAR(rig.Of(wait).value, 0.25, 1e-12);
  EXPECT_EQ(rig.Of(move).state, FeedbackState::kActive);
  EXPECT_EQ(rig.out.delay, Delay::kNone);
}

TEST(MoverBuffer, WaitsForARelease) {
  Rig rig;
  rig.Enable();
  const Ticket first = rig.Give(To(50, 0));
  const Ticket wait = rig.Give(Wait{.for_release = true});
  const Ticket move = rig.Give(To(100, 0));
  rig.Finish(first);
  rig.Run(700);
  EXPECT_EQ(rig.Of(wait).state, FeedbackState::kActive);
  EXPECT_EQ(rig.out.delay, Delay::kRelease);
  EXPECT_EQ(rig.out.x, 50);
  rig.Give(Release{});
  rig.Finish(move);
  EXPECT_EQ(rig.out.x, 100);
  // One that came first is there for a later wait, once.
  rig.Give(Release{});
  EXPECT_EQ(rig.Become(rig.Give(Wait{.for_release = true})), FeedbackState::kDone);
  const Ticket again = rig.Give(Wait{.for_release = true});
  rig.Run(100);
  EXPECT_EQ(rig.Of(again).state, FeedbackState::kActive);
  // Both: at least so long, and until a release.
  rig.Give(Halt{});
  EXPECT_EQ(rig.Of(again).state, FeedbackState::kAborted);
  const Ticket both = rig.Give(Wait{.duration = 0.1, .for_release = true});
  rig.Give(Release{});
  rig.Run(99);
  EXPECT_EQ(rig.Of(both).state, FeedbackState::kActive);
  rig.Run(3);
  EXPECT_EQ(rig.Of(both).state, FeedbackState::kDone);
}

// A release that is there in time costs nothing.
TEST(MoverBuffer, AReleaseInTimeDoesNotStopIt) {
  Rig rig;
  rig.Enable();
  rig.Give(Release{});
  rig.Give(MoveToPosition{.x = 300});
  const Ticket wait = rig.Give(Wait{.for_release = true});
  const Ticket move = rig.Give(To(900, 0, 250));
  rig.Run(100);
  EXPECT_EQ(rig.Of(wait).state, FeedbackState::kDone);
  double slowest = INFINITY;
  while (!IsFinal(rig.Of(move).state)) {
    rig.Step();
    if (rig.out.x < 600) slowest = std::min(slowest, Speed(rig));
  }
  EXPECT_GT(slowest, 500);
}

TEST(MoverBuffer, RefusesOneTooManyAndLosesNothing) {
  Rig rig;
  EXPECT_EQ(rig.Of(rig.Give(To(1, 0))).error, ErrorId::kMoverDisabled);
  rig.Enable();
  rig.Give(MoveToPosition{.x = 1});
  std::vector<Ticket> all;
  for (std::size_t i = 0; i < kBuffered; ++i) all.push_back(rig.Give(To(2.0 + static_cast<double>(i), 0)));
  EXPECT_EQ(rig.Of(rig.Give(To(99, 0))).error, ErrorId::kBufferFull);
  rig.Finish(all.back());
  for (const Ticket ticket : all) EXPECT_EQ(rig.Of(ticket).state, FeedbackState::kDone);
  EXPECT_EQ(rig.out.x, 1.0 + static_cast<double>(kBuffered));
}

TEST(MoverBuffer, IsEmptiedByWhatTakesOver) {
  const std::vector<Command> takes{MoveToPosition{.x = 5}, Halt{}, Disable{}};
  for (std::size_t how = 0; how <= takes.size(); ++how) {
    Rig rig;
    rig.Enable();
    rig.Give(MoveToPosition{.x = 100});
    const Ticket next = rig.Give(To(200, 0));
    rig.Run(20);
    if (how < takes.size()) {
      rig.Give(takes[how]);
    } else {
      Fail(rig.context(), ErrorId::kOverrun, rig.state);
      rig.Step();
    }
    EXPECT_EQ(rig.Of(next).state, FeedbackState::kAborted) << how;
    rig.Run(1500);
    EXPECT_LT(rig.out.x, 150) << how;
    EXPECT_EQ(rig.out.buffered, 0u);
  }
  // Z is its own.
  Rig rig;
  rig.Enable();
  rig.Give(MoveToPosition{.x = 100});
  const Ticket next = rig.Give(To(200, 0));
  rig.Give(MoveZ{.position = 1});
  EXPECT_EQ(rig.Become(next), FeedbackState::kDone);
}

// What cannot be done in its turn takes those behind it with it: who skips a move must not do the rest.
TEST(MoverBuffer, AFailureEndsWhatIsBehind) {
  Rig rig;
  rig.Enable();
  rig.Give(MoveToPosition{.x = 100});
  const Ticket bad = rig.Give(MoveZ{.position = 99, .buffer_mode = Buffering::kBuffered});
  const Ticket next = rig.Give(To(200, 0));
  EXPECT_EQ(rig.Become(bad), FeedbackState::kError);
  EXPECT_EQ(rig.Of(bad).error, ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.Of(next).state, FeedbackState::kAborted);
  EXPECT_EQ(rig.out.x, 100);
}

// Whatever is buffered and blended: limits are kept, targets without blending are stood at, every command ends once.
TEST(MoverBuffer, PropertyKeepsLimits) {
  std::mt19937 random(3);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  for (int run = 0; run < 60; ++run) {
    Rig rig;
    rig.Enable();
    Watch watch(rig);
    for (int i = 0; i < 400; ++i) {
      if (rig.state.buffer.count < 3) {
        MoveToPosition move = To(between(-500, 500), between(-500, 500), between(-100, 200));
        if (move.blending < 0) move.blending = 0;
        move.velocity = between(50, 3000);
        if (between(0, 1) < 0.5) move.velocity.reset();
        if (between(0, 1) < 0.1) move.use_orientation = true, move.c = between(-10, 10);
        if (between(0, 1) < 0.1) move.buffer_mode = Buffering::kAborting, move.blending = 0;
        rig.Give(move);
      }
      if (between(0, 1) < 0.02) rig.Give(Wait{.duration = between(0, 0.1)});
      if (between(0, 1) < 0.01) rig.Give(Halt{});
      for (int k = 0; k < 20; ++k) {
        rig.Step();
        watch.Look();
      }
      ASSERT_FALSE(testing::Test::HasFailure()) << run;
    }
    rig.Give(Disable{});
    rig.Run(2000);
    for (Ticket ticket = 1; ticket <= rig.ticket; ++ticket) ASSERT_TRUE(IsFinal(rig.Of(ticket).state)) << ticket;
  }
}

}  // namespace
}  // namespace takt::mover
