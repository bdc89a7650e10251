// PL-20, PL-23: changes of geometry by commands, built outside the cycle; links and what they lock.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "rig.h"
#include "takt/core/describe.h"
#include "takt/core/hash.h"
#include "takt/planar/builder.h"
#include "takt/planar/crossing.h"
#include "takt/planar/network.h"
#include "takt/track/build.h"

namespace takt::track {
namespace {

using planar::Problem;

AppendLine Line(double x0, double y0, double x1, double y1) {
  return {.start_x = x0, .start_y = y0, .end_x = x1, .end_y = y1};
}
StartFromTrack From(std::size_t track) {
  return {Name::Of(Rig::NameOf(track))};
}
EndAtTrack To(std::size_t track) {
  return {Name::Of(Rig::NameOf(track))};
}

// One step of building a track.
struct Attempt {
  Command command;
  std::function<Problem(planar::TrackBuilder&)> build;
};

Attempt Any(std::mt19937& random) {
  const auto coordinate = [&] { return static_cast<double>(random() % 13) * 100; };
  const planar::Place a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
  switch (random() % 8) {
    case 0:
      return {AppendPosition{a.x, a.y}, [=](auto& t) { return t.AppendPosition(a); }};
    case 1: {
      const planar::Place center{(a.x + b.x) / 2, (a.y + b.y) / 2};
      const bool clockwise = random() % 2 == 0;
      return {AppendCircle{a.x, a.y, b.x, b.y, center.x, center.y, clockwise},
              [=](auto& t) { return t.AppendCircle(a, b, center, clockwise); }};
    }
    case 2:
      if (random() % 3 == 0) return {CloseLoop{}, [](auto& t) { return t.CloseLoop(); }};
      [[fallthrough]];
    default:
      return {Line(a.x, a.y, b.x, b.y), [=](auto& t) { return t.AppendLine(a, b); }};
  }
}

// PL-20: random commands give the same as TrackBuilder, to the last bit; and no track crosses itself.
TEST(PendingEdits, BuildWhatTheBuilderBuilds) {
  std::mt19937 random(11);
  int made = 0, crossed = 0, refused = 0, closed = 0;
  for (int run = 0; run < Trials(60); ++run) {
    Rig rig(1);
    planar::TrackBuilder model;
    for (int i = 0; i < 12; ++i) {
      const Attempt attempt = Any(random);
      planar::TrackBuilder next = model;
      Problem expected = attempt.build(next);
      const Problem found = rig.Do(0, attempt.command);
      if (expected == Problem::kNone && next.track()) {
        planar::Track way = *next.track();
        way.closed = way.closed || SamePoint(At(way, 0).place, At(way, way.length).place);
        if (SelfCrossing(way)) expected = Problem::kCrosses;
      }
      ASSERT_EQ(found, expected) << run << " " << i;
      made += expected == Problem::kNone ? 1 : 0;
      crossed += expected == Problem::kCrosses ? 1 : 0;
      refused += expected != Problem::kNone ? 1 : 0;
      if (expected == Problem::kNone) model = next;
      ASSERT_EQ(rig.state(0).length, model.track() ? model.track()->length : 0);
      ASSERT_EQ(rig.state(0).has_length, model.track() != nullptr);
      ASSERT_EQ(rig.tracks.sketches[0].count, model.layout().elements.size());
      ASSERT_EQ(rig.state(0).sketch_hash, HashOf(rig.tracks.sketches[0], 0));
    }
    closed += rig.tracks.sketches[0].closed ? 1 : 0;
  }
  EXPECT_GT(made, Trials(60));
  EXPECT_GT(crossed, Trials(20));
  EXPECT_GT(refused, Trials(120));
  EXPECT_GT(closed, Trials(2));
}

// EN-04: the cycle does not allocate.
TEST(PendingEdits, AllocateNothingInTheCycle) {
  []<typename... T>(const std::variant<T...>*) {
    (TypeOf<T>(), ...);  // the first use allocates
  }(static_cast<const Command*>(nullptr));
  Rig rig(3);
  std::vector<FeedbackEvent> storage(1000);
  FeedbackSink feedback(storage);
  const Context c{rig.tracks, rig.grounds, rig.cycle, feedback};
  const auto quietly = [&](auto&& what) {
    const long before = AllocationsOfThisThread();
    what();
    EXPECT_EQ(AllocationsOfThisThread(), before);
  };
  const Command commands[] = {Line(0, 0, 300, 0),
                              Line(400, 100, 400, 300),
                              Line(0, 0, 0, 0),
                              AppendPosition{500, 800},
                              From(0),
                              To(0),
                              Enable{},
                              Disable{},
                              Clear{}};
  int track = 0;
  for (int round = 0; round < 40; ++round) {
    for (const Command& command : commands) {
      quietly([&] { Apply(c, static_cast<std::size_t>(track), 1, command); });
      track = (track + 1) % 3;
    }
    for (int i = 0; i < 3; ++i) {
      quietly([&] {
        Step(c);
        Publish(c);
      });
      ++rig.cycle.count;
      while (const std::optional<BuiltTrack> answer = Make(rig.tracks.desk)) {
        quietly([&] { Apply(c, answer->track, 0, answer->made); });
      }
    }
    feedback.Clear();
  }
  EXPECT_GT(rig.tracks.works.question, 50u);
}

// PL-23: links lead from ends to starts, any number at one point.
TEST(PendingEdits, LinkTracks) {
  Rig rig(5);
  ASSERT_EQ(rig.Do(0, Line(0, 0, 300, 0)), Problem::kNone);
  for (std::size_t i = 1; i < 4; ++i) {
    ASSERT_EQ(rig.Do(i, From(0)), Problem::kNone);
    EXPECT_FALSE(rig.state(i).has_length);
    ASSERT_EQ(rig.Do(i, Line(400, 100.0 * static_cast<double>(i), 500, 100.0 * static_cast<double>(i))),
              Problem::kNone);
    const planar::TrackPoint start = At(*rig.tracks.ways[i], 0);
    EXPECT_NEAR(start.place.x, 300, 1e-9);
    EXPECT_NEAR(start.curvature, 0, 1e-12);
  }
  ASSERT_EQ(rig.Do(4, Line(100, 300, 100, 200)), Problem::kNone);
  ASSERT_EQ(rig.Do(4, To(0)), Problem::kNone);
  const std::vector<Outputs>& out = rig.tracks.outputs;
  EXPECT_EQ(out[0].subsequent_tracks, 3u);
  EXPECT_EQ(out[0].previous_tracks, 1u);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(out[i].previous_tracks, 1u);
  EXPECT_EQ(out[4].subsequent_tracks, 1u);
  EXPECT_EQ(rig.state(4).ends_at.tracks[0], 0u);
  EXPECT_EQ(rig.Do(4, Line(0, 900, 100, 900)), Problem::kEnded);
  // Where several tracks end and start at one point, each end is linked to each start.
  ASSERT_EQ(rig.Do(4, Clear{}), Problem::kNone);
  EXPECT_EQ(out[0].previous_tracks, 0u);
  ASSERT_EQ(rig.Do(4, Line(200, 100, 250, 50)), Problem::kNone);
  ASSERT_EQ(rig.Do(4, To(1)), Problem::kNone);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(out[i].previous_tracks, 2u);
  EXPECT_EQ(out[4].subsequent_tracks, 3u);
}

// At most as many at one point as a network can link; reported at once, for commands and in the machine file.
TEST(PendingEdits, LinkSoManyAtOnePoint) {
  const std::size_t most = planar::kLinks;
  Rig rig(most + 2);
  ASSERT_EQ(rig.Do(0, Line(0, 0, 300, 0)), Problem::kNone);
  for (std::size_t i = 1; i <= most; ++i) ASSERT_EQ(rig.Do(i, From(0)), Problem::kNone) << i;
  EXPECT_EQ(rig.tracks.outputs[0].subsequent_tracks, most);
  EXPECT_EQ(rig.Do(most + 1, From(0)), Problem::kTooMany);
  EXPECT_EQ(rig.tracks.outputs[0].subsequent_tracks, most);

  std::vector<TrackParams> params = Rig::Named(most + 2);
  params[0].elements.push_back({.shape = planar::ElementShape::kLine, .from = planar::Place{0, 0}, .to = {300, 0}});
  for (std::size_t i = 1; i < params.size(); ++i) params[i].starts_from = {params[0].name};
  const BuildResult result = Build(params);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].path, "[65]");
  EXPECT_THAT(result.problems[0].message, testing::HasSubstr("at most 64 start, or end, at one point"));
  params.pop_back();
  EXPECT_TRUE(Build(params).problems.empty());
}

// PL-23: a track that others start from or end at stays as it is, until they are cleared.
TEST(PendingEdits, LockWhatOthersUse) {
  Rig rig(2);
  rig.Do(0, Line(0, 0, 300, 0));
  rig.Do(1, From(0));
  for (const Command& change : {Command(Line(400, 100, 400, 300)), Command(AppendPosition{900, 900}),
                                Command(CloseLoop{}), Command(Clear{}), Command(To(1)), Command(From(1))}) {
    const Problem problem = rig.Do(0, change);
    EXPECT_TRUE(problem == Problem::kInUse || problem == Problem::kOtherEmpty) << static_cast<int>(problem);
    EXPECT_EQ(rig.state(0).length, 300);
  }
  EXPECT_EQ(rig.Do(1, From(0)), Problem::kNone);  // once more: succeeds
  EXPECT_EQ(rig.state(1).starts_from.count, 1u);
  EXPECT_EQ(rig.Do(1, Clear{}), Problem::kNone);
  EXPECT_EQ(rig.Do(0, Line(400, 100, 400, 300)), Problem::kNone);
  EXPECT_EQ(rig.Do(1, Line(0, 900, 100, 900)), Problem::kNone);
  EXPECT_EQ(rig.Do(1, From(0)), Problem::kNotItsStart);
}

// Many at once: those beyond the capacity are refused, the others are made in their order.
TEST(PendingEdits, TakeSoManyAtOnce) {
  Rig rig(2);
  std::vector<Ticket> given;
  for (std::size_t i = 0; i < kOrders + 3; ++i) {
    const double x = 100 * static_cast<double>(i / 2);
    given.push_back(rig.Give(i % 2, Line(x, 0, x + 50, 0)));
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_EQ(rig.End(given[i]), i < kOrders ? Problem::kNone : Problem::kBusy) << i;
  }
  EXPECT_EQ(rig.tracks.sketches[0].count, kOrders / 2);
  EXPECT_DOUBLE_EQ(rig.state(0).length, 100 * (kOrders / 2) - 50);
}

// An answer that is not awaited, or without a delivery, changes nothing.
TEST(PendingEdits, TakeTheAnswerTheyWaitForAlone) {
  Rig rig(2);
  const auto hash = [&] { return HashOf(rig.tracks.works, HashOf(rig.state(0), HashOf(rig.state(1), 0))); };
  const auto refuse = [&](std::size_t track, const TrackMade& made) {
    const std::uint64_t before = hash();
    const Ticket ticket = rig.Give(track, made);
    EXPECT_EQ(rig.feedback.events().back().error, ErrorId::kState);
    EXPECT_EQ(rig.feedback.events().back().ticket, ticket);
    EXPECT_EQ(hash(), before);
  };
  refuse(0, {.number = 0});
  refuse(0, {.number = 1});
  const Ticket line = rig.Give(0, Line(0, 0, 300, 0));
  rig.Step();
  refuse(0, {.number = 1});  // nothing was made
  refuse(0, {.number = 2});
  refuse(0, {.number = 2, .problem = Problem::kKink});
  refuse(1, {.number = 1});
  EXPECT_EQ(rig.End(line), Problem::kNone);
  refuse(0, {.number = 1});  // a second answer
  EXPECT_EQ(rig.state(0).length, 300);
}

// A delivery that is not wanted is no answer to the next request.
TEST(PendingEdits, ForgetWhatWasMadeForNothing) {
  Rig rig(1);
  const Ticket first = rig.Give(0, Line(0, 0, 300, 0));
  rig.Step();
  ASSERT_TRUE(Make(rig.tracks.desk));
  Apply(rig.context(), 0, 0, TrackMade{.number = 1, .problem = Problem::kKink});
  EXPECT_EQ(rig.End(first), Problem::kKink);
  EXPECT_FALSE(rig.state(0).has_length);
  EXPECT_EQ(rig.Do(0, Line(0, 0, 500, 0)), Problem::kNone);
  EXPECT_EQ(rig.state(0).length, 500);
}

// PL-20: only while it is disabled.
TEST(PendingEdits, StandStillWhileEnabled) {
  Rig rig(2);
  rig.Do(0, Line(0, 0, 300, 0));
  rig.Do(1, Line(300, 0, 500, 0));
  rig.Give(0, Enable{});
  for (const Command& change :
       {Command(Line(400, 100, 400, 300)), Command(AppendPosition{900, 900}), Command(AppendCircle{}),
        Command(CloseLoop{}), Command(Clear{}), Command(To(1)), Command(From(1))}) {
    EXPECT_EQ(rig.Do(0, change), Problem::kNotDisabled);  // while it is being enabled, too
    EXPECT_EQ(rig.state(0).length, 300);
  }
  EXPECT_EQ(rig.state(0).state, planar::ObjectState::kEnabled);
}

}  // namespace
}  // namespace takt::track
