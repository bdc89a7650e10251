// Buffered commands: PL-71; why a mover does not move on: PL-70.
#include "takt/mover/buffer.h"

#include "rig.h"
#include "takt/planar/environment.h"

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
  for (const Ticket waits : {second, third}) {  // both are reported as accepted
    EXPECT_EQ(rig.Of(waits).ticket, waits);
    EXPECT_EQ(rig.Of(waits).state, FeedbackState::kBusy);
  }
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

// Two moves on one line, with the second one known early enough, are as fast as one move.
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
  EXPECT_NEAR(cycles, alone, 5);  // it takes over some cycles early, and the jerk changes its sign twice
}

// Around a square: the mover does not stop at the corners, cuts them by no more than allowed, and keeps its limits.
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
    // Each move is done where the next one took over.
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
  // An early release serves a later wait, once.
  rig.Give(Release{});
  EXPECT_EQ(rig.Become(rig.Give(Wait{.for_release = true})), FeedbackState::kDone);
  const Ticket again = rig.Give(Wait{.for_release = true});
  rig.Run(100);
  EXPECT_EQ(rig.Of(again).state, FeedbackState::kActive);
  // Both: at least the duration, and until a release.
  rig.Give(Halt{});
  EXPECT_EQ(rig.Of(again).state, FeedbackState::kAborted);
  const Ticket both = rig.Give(Wait{.duration = 0.1, .for_release = true});
  rig.Give(Release{});
  rig.Run(99);
  EXPECT_EQ(rig.Of(both).state, FeedbackState::kActive);
  rig.Run(3);
  EXPECT_EQ(rig.Of(both).state, FeedbackState::kDone);
}

// A release that is there in time costs no time.
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
  // Z is independent.
  Rig rig;
  rig.Enable();
  rig.Give(MoveToPosition{.x = 100});
  const Ticket next = rig.Give(To(200, 0));
  rig.Give(MoveZ{.position = 1});
  EXPECT_EQ(rig.Become(next), FeedbackState::kDone);
}

// A command that fails in its turn aborts the ones behind it: after a skipped move, the rest must not be executed.
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

// A rotation or lift given later delays neither the buffered commands given before it nor their blending; given before,
// it does.
TEST(MoverBuffer, AuxiliaryMovesGivenLaterLeaveItAlone) {
  int alone = 0;
  for (const bool lifts : {false, true}) {
    Rig rig;
    rig.Enable();
    rig.Give(MoveToPosition{.x = 1000});
    const Ticket next = rig.Give(To(1000, 1000, 100));
    rig.Run(10);
    Ticket lift = 0;
    if (lifts) lift = rig.Give(MoveZ{.position = 5, .velocity = 1});
    double nearest = INFINITY;
    int cycles = 10;
    for (; !IsFinal(rig.Of(next).state) && cycles < 9000; ++cycles) {
      rig.Step();
      nearest = std::min(nearest, std::hypot(rig.out.x - 1000, rig.out.y));
    }
    EXPECT_GT(nearest, 1);
    if (!lifts) alone = cycles;
    if (!lifts) continue;
    EXPECT_EQ(cycles, alone);
    EXPECT_EQ(rig.Of(lift).state, FeedbackState::kActive);
    const Ticket behind = rig.Give(To(0, 0));
    rig.Run(1000);
    EXPECT_EQ(rig.out.buffered, 1u);
    rig.Finish(lift);
    EXPECT_EQ(rig.out.x, 1000);
    EXPECT_EQ(rig.Become(behind), FeedbackState::kDone);
  }
}

// Relative external set points do not affect the buffer.
TEST(MoverBuffer, GoesOnUnderRelativeSetPoints) {
  Rig rig;
  rig.Enable();
  rig.Give(MoveToPosition{.x = 100});
  const Ticket before = rig.Give(To(200, 0));
  const Ticket start = rig.Give(StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
  const Ticket behind = rig.Give(To(300, 0));
  for (int i = 0; i < 3000 && !IsFinal(rig.Of(behind).state); ++i) {
    rig.Give(SetExternalSetpoint{});
    rig.Step();
  }
  EXPECT_EQ(rig.Of(before).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Of(behind).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Of(start).state, FeedbackState::kActive);
  EXPECT_EQ(rig.out.x, 300);
}

// A surface of two parts, 2 m each: one has its origin elsewhere.
planar::Parts TwoHalves() {
  const auto part = [](const char* name, double x) {
    planar::Part half;
    half.name = name;
    std::vector<planar::Place> stators;
    for (int i = 0; i < 8; ++i) {
      for (int k = 0; k < 16; ++k) stators.push_back({240.0 * i, 240.0 * k});
    }
    planar::MakeEnvironment(stators, half.shape);
    half.positions = {{0, {x, -1920}}};
    return half;
  };
  return {{"plane"}, {part("left", -1920), part("right", 0)}, {{.enabled = true}, {.enabled = true}}};
}

// Random buffered and blended moves, releases, rotations and relative set points: limits are kept, each command ends
// once, in the order of the commands, and a move that no other one takes over without a stop is done at its target.
TEST(MoverBuffer, PropertyKeepsLimits) {
  std::mt19937 random(3);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  const auto chance = [&](double p) { return between(0, 1) < p; };
  const planar::Parts parts = TwoHalves();
  struct Wish {
    Ticket ticket = 0;
    double x = 0, y = 0;
    double blended = 0;  // [mm] by the next move
  };
  int done = 0, rounded = 0, failed = 0, released = 0, beside = 0;
  for (int run = 0; run < 60; ++run) {
    Rig rig;
    const bool on_parts = run % 2 == 1;
    if (on_parts) {
      rig.streets.parts = &parts;
      rig.state.part = 1;
    }
    rig.Enable();
    Watch watch(rig);
    std::vector<Wish> wishes;
    bool reckoned = true;  // X and Y are at the targets of the moves
    const auto run_cycles = [&](int cycles, double amplitude = 0) {
      for (int k = 0; k < cycles; ++k) {
        if (amplitude != 0) {  // out and back, smoothly
          const double u = static_cast<double>(k) / cycles, q = u * (1 - u), slope = 1 - 2 * u, w = 1000.0 / cycles;
          rig.Give(SetExternalSetpoint{.x = amplitude * 64 * q * q * q,
                                       .velocity_x = amplitude * 192 * w * q * q * slope,
                                       .acceleration_x = amplitude * 384 * w * w * q * (slope * slope - q)});
        }
        rig.Step();
        watch.Look(amplitude != 0);
        if (rig.out.state != planar::ObjectState::kEnabled) reckoned = false;
        for (const Wish& wish : wishes) {
          if (rig.Of(wish.ticket).state != FeedbackState::kDone || rig.Of(wish.ticket).cycle + 1 != rig.cycle.count)
            continue;
          ++done;
          if (!reckoned || amplitude != 0) continue;
          const double off = std::hypot(rig.out.x - wish.x, rig.out.y - wish.y);
          EXPECT_LE(off, wish.blended + 1e-9) << wish.ticket;
          rounded += off > 1 ? 1 : 0;
        }
      }
    };
    for (int i = 0; i < 400; ++i) {
      if (rig.out.state == planar::ObjectState::kError) {
        ++failed;
        rig.Finish(rig.Give(Reset{}));
        watch = Watch(rig);
        reckoned = true;
      }
      if (rig.state.buffer.count < 3) {
        const double x = between(-500, 500), y = between(-500, 500);
        MoveToPosition move = To(x, y, std::max(0.0, between(-100, 200)));
        if (on_parts) {
          const int reference = Whole(random, 0, 2);
          move.reference = Name::Of(reference == 0 ? "" : reference == 1 ? "left" : "right");
          if (reference > 0) move.x += reference == 1 ? 1920 : 0, move.y += 1920;
        }
        move.velocity = between(50, 3000);
        if (chance(0.5)) move.velocity.reset();
        if (chance(0.1)) move.c = between(-10, 10);
        if (chance(0.1)) move.buffer_mode = Buffering::kAborting, move.blending = 0;
        if (!wishes.empty()) wishes.back().blended = move.buffer_mode == Buffering::kBuffered ? move.blending : 0;
        wishes.push_back({rig.Give(move), x, y, 0});
      }
      const Buffering buffering = chance(0.5) ? Buffering::kBuffered : Buffering::kAborting;
      if (chance(0.05)) {
        ++beside;
        rig.Give(MoveZ{.position = between(0, 5), .velocity = between(1, 100), .buffer_mode = buffering});
      }
      if (chance(0.03)) rig.Give(MoveA{.position = between(-1, 1), .buffer_mode = buffering});
      if (chance(0.03)) rig.Give(MoveC{.position = between(-15, 15), .buffer_mode = buffering});
      if (chance(0.02)) rig.Give(Wait{.duration = between(0, 0.1), .for_release = chance(0.5)});
      if (chance(0.1)) {
        ++released;
        rig.Give(Release{});
      }
      if (chance(0.01)) rig.Give(Halt{});
      if (chance(0.01) && rig.out.state == planar::ObjectState::kEnabled) {
        rig.Give(StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
        run_cycles(Whole(random, 200, 400), between(0.1, 5));
        if (chance(0.5)) rig.Give(StopExternalSetpointGeneration{});
        // Otherwise no further set point arrives: a fault.
        watch = Watch(rig);
        reckoned = false;
        for (int k = 0; k < 600; ++k) {
          rig.Step();
          watch.Look();
        }
        reckoned = rig.out.state == planar::ObjectState::kEnabled;
        wishes.clear();
      }
      run_cycles(20);
      ASSERT_FALSE(testing::Test::HasFailure()) << run;
    }
    rig.Give(Disable{});
    rig.Run(2000);
    for (Ticket ticket = 1; ticket <= rig.ticket; ++ticket) ASSERT_TRUE(IsFinal(rig.Of(ticket).state)) << ticket;
  }
  std::printf("moves done %d, of those round a corner %d; faults %d, releases %d, auxiliary moves %d\n", done, rounded,
              failed, released, beside);
  EXPECT_GT(done, 500);
  EXPECT_GT(rounded, 50);
  EXPECT_GT(failed, 10);
}

}  // namespace
}  // namespace takt::mover
