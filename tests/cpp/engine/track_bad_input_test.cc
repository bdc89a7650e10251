// Every number of every command of tracks, made invalid: refused with a sentence before it reaches the cycle; if it
// reaches the cycle, it changes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "machines.h"
#include "takt/engine/path_checks.h"
#include "wrong.h"

namespace takt::engine {
namespace {

using testing::HasSubstr;

constexpr char kTracks[] = R"(
name: tracks
axes: []
tracks:
  - {name: main, elements: [{from: {x: 0, y: 0}, to: {x: 300, y: 0}}]}
  - {name: branch, starts_from: [main]}
planar_groups: [{name: cell}]
)";

Machine TrackMachine() {
  LoadResult loaded = LoadMachine(kTracks, "tracks.yaml");
  return loaded.machine.value();
}

std::vector<track::Command> GoodTrackCommands() {
  const Name branch = Name::Of("branch");
  return {track::AppendLine{400, 0, 500, 0},
          track::AppendCircle{400, 0, 500, 0, 450, 0},
          track::AppendPosition{5, 5},
          track::CloseLoop{},
          track::Clear{},
          track::StartFromTrack{branch},
          track::EndAtTrack{branch},
          track::Enable{},
          track::Disable{},
          track::Reset{},
          track::AddToGroup{Name::Of("cell")},
          track::RemoveFromGroup{},
          track::TrackMade{}};
}

struct TrackTwin {
  FeedbackEvent Give(const track::Command& body) {
    engine.Submit({.target = 1, .body = body});
    engine.RunCycle();
    FeedbackEvent last;
    while (engine.feedback().TryPop(last)) {
    }
    return last;
  }

  Machine machine = TrackMachine();
  Engine engine{machine};
};

// PL-20, EN-22
TEST(TrackBadInput, IsRefusedWithASentenceAndChangesNothing) {
  EXPECT_EQ(GoodTrackCommands().size(), std::variant_size_v<track::Command>);
  TrackTwin asked, twin;
  int refused = 0;
  for (const track::Command& good : GoodTrackCommands()) {
    const CommandText fine = ToText(asked.machine, {.target = 1, .body = good});
    ASSERT_EQ(ParseCommand(asked.machine, fine.target, fine.verb, fine.arguments, Giver::kJournal).error,
              ErrorId::kNone)
        << fine.verb;
    for (const Wrong<track::Command>& wrong : WrongVersionsOf(good)) {
      const CommandText text = ToText(asked.machine, {.target = 1, .body = wrong.command});
      const ParsedCommand parsed = ParseCommand(asked.machine, text.target, text.verb, text.arguments);
      EXPECT_EQ(parsed.error, ErrorId::kParameter) << wrong.what;
      EXPECT_THAT(parsed.sentence, HasSubstr(std::string(wrong.field) + ": expected ")) << wrong.what;
      EXPECT_EQ(asked.Give(wrong.command).error, ErrorId::kParameter) << wrong.what;
      twin.engine.RunCycle();
      ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash()) << wrong.what;
      ++refused;
    }
  }
  EXPECT_GT(refused, 80);
}

// PL-20, EN-22
TEST(TrackBadInput, SaysWhatWasExpected) {
  const Machine machine = TrackMachine();
  const struct {
    const char* verb;
    const char* arguments;
    const char* sentence;
  } cases[] = {
      {"append_line", "{start_x: 1, start_y: 2, end_x: 3}", "end_y: "},
      {"append_circle", "{start_x: 1, start_y: 2, end_x: 3, end_y: 4, center_x: 1, center_y: 5, clockwise: left}",
       "clockwise: expected "},
      {"append_position", "{x: east, y: 0}", "x: expected "},
      {"close_loop", "{now: true}", "now"},
      {"start_from_track", "{}", "track: "},
      {"start_from_track", "{track: main}", "track: expected the name of another track, found 'main'"},
      {"end_at_track", "{track: brunch}", "track: expected the name of another track, found 'brunch'; did you mean"},
  };
  for (const auto& c : cases) {
    const ParsedCommand parsed = ParseCommand(machine, "main", c.verb, c.arguments);
    EXPECT_EQ(parsed.error, ErrorId::kParameter) << c.verb << " " << c.arguments;
    EXPECT_THAT(parsed.sentence, HasSubstr(c.sentence)) << c.verb << " " << c.arguments;
  }
  EXPECT_EQ(ParseCommand(machine, "main", "track_made", "{number: 1}").error, ErrorId::kUnknownVerb);
}

// PL-20: the feedback for a track with invalid geometry.
TEST(TrackBadInput, SaysWhyATrackCannotBe) {
  const auto sentence = [](planar::Problem problem, std::uint32_t element) {
    return Sentence(
        {.state = FeedbackState::kError, .error = ErrorId::kTrackGeometry, .value = track::ToValue(problem, element)});
  };
  EXPECT_EQ(sentence(planar::Problem::kCrosses, 0), "the track crosses or touches itself");
  EXPECT_EQ(sentence(planar::Problem::kTooTight, 64), "a radius is less than 1 mm, in element 64");
  for (const Enumerator& e : TypeOf<planar::Problem>().enumerators) {
    for (const std::uint32_t element : {0u, 1u, 64u}) {
      const double value = track::ToValue(static_cast<planar::Problem>(e.value), element);
      EXPECT_EQ(static_cast<std::int64_t>(track::ProblemOf(value)), e.value);
      EXPECT_EQ(track::ElementOf(value), element);
    }
  }
}

}  // namespace
}  // namespace takt::engine
