#include "takt/core/arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "allocations.h"
#include "example.h"
#include "takt/core/hash.h"
#include "takt/core/writer.h"
#include "takt/core/yaml_reader.h"

namespace takt {
namespace {

using example::Machine;
using example::MoveAbsolute;
using testing::HasSubstr;

template <typename T = MoveAbsolute>
std::string ProblemOf(std::string_view text) {
  T object;
  Problem problem;
  return ReadArguments(object, text, &problem) ? "" : problem.Text();
}

TEST(Arguments, ReadsACommand) {  // EN-11
  MoveAbsolute move;
  ASSERT_TRUE(ReadArguments(move, "{position: 100, velocity: 50.5, direction: positive}", nullptr));
  EXPECT_EQ(move.position, 100);
  EXPECT_EQ(move.velocity, 50.5);
  EXPECT_EQ(move.jerk, 0);
  EXPECT_EQ(move.direction, example::Direction::kPositive);
}

TEST(Arguments, TakesJsonAndOtherWaysOfWritingTheSame) {
  for (const std::string_view text : {R"({"position": 1, "velocity":2, "direction": "positive"})",
                                      "{'position': 1, 'velocity': 2, 'direction': 'positive'}",
                                      "\n {\n  position : 1 ,\n velocity:\t2,direction: positive,}\n ",
                                      "{position: 1.0, velocity: 2e0, direction: \"positive\"}"}) {
    MoveAbsolute move;
    Problem problem;
    ASSERT_TRUE(ReadArguments(move, text, &problem)) << problem.Text();
    EXPECT_EQ(move.position, 1);
    EXPECT_EQ(move.velocity, 2);
    EXPECT_EQ(move.direction, example::Direction::kPositive);
  }
}

TEST(Arguments, EmptyTextIsNoArguments) {
  example::Limits limits;
  for (const std::string_view text : {"", "  ", "\n", "{}", " { } "}) EXPECT_TRUE(ReadArguments(limits, text, nullptr));
  EXPECT_THAT(ProblemOf(""), HasSubstr("arguments:1:1: position: expected this key with a number in u"));
}

TEST(Arguments, SpeaksLikeTheYamlReader) {  // EN-10, EN-11
  for (const std::string text :
       {"{position: 1, velocity: 50, direction: positve}", "{position: 500 mm, velocity: 50}",
        "{position: 1, velocty: 50}", "{position: 1, velocity: 0}", "{position: 1, velocity_mm_s: 5}",
        "{position: 1, velocity: 5, velocity: 6}", "{velocity: 5}", "{position: '1', velocity: 5}",
        "{position: .nan, velocity: 1}", "{position: 1e999, velocity: 1}", "{position: [1], velocity: 1}",
        "{position: {a: 1}, velocity: 1}", "{position: , velocity: 1}", "{position: 010, velocity: 1}", "[1, 2]", "5",
        "{position: &a 1, velocity: 1}", "{position: !!int 1, velocity: 1}", "{<<: 1, position: 1, velocity: 1}"}) {
    const auto yaml = ReadYaml<MoveAbsolute>(text, "arguments");
    ASSERT_FALSE(yaml.ok()) << text;
    EXPECT_EQ(ProblemOf(text), yaml.problems.front().Text()) << text;
  }
  EXPECT_EQ(ProblemOf("{position: 1, velocity: 50, direction: positve}"),
            "arguments:1:40: direction: expected one of current, positive, shortest, negative, found 'positve'; did "
            "you mean positive?");
}

TEST(Arguments, RefuseWhatIsNotFiniteInEveryNumber) {
  for (const std::string word : {"nan", "inf", ".nan", ".inf", "-inf", "-.inf", "NaN", "+Infinity"}) {
    EXPECT_THAT(ProblemOf("{position: " + word + ", velocity: 1}"),
                HasSubstr("position: expected a finite number in u (the axis' own unit), found"));
    EXPECT_THAT(ProblemOf("{position: 1, velocity: " + word + "}"), HasSubstr("velocity: expected a finite number"));
    EXPECT_THAT(ProblemOf("{position: 1, velocity: 1, jerk: " + word + "}"),
                HasSubstr("jerk: expected a finite number"));
    EXPECT_THAT(ProblemOf<example::Homing>("{velocity: 1, timeout_s: " + word + "}"),
                HasSubstr("timeout_s: expected a finite number"));
    EXPECT_THAT(ProblemOf<Machine>("{axes: [], points: [[1, " + word + "]]}"),
                HasSubstr("points[0][1]: expected a finite number"));
    EXPECT_THAT(ProblemOf<Machine>("{axes: [], spare: " + word + "}"), HasSubstr("spare: expected a"));
  }
}

TEST(Arguments, BrokenTextTellsWhere) {
  EXPECT_EQ(ProblemOf("{position: 1, velocity: 5"), "arguments:1:26: expected ',' or '}', found the end");
  EXPECT_THAT(ProblemOf("{position: 1, velocity: 5} x"),
              HasSubstr("arguments:1:28: expected the end behind the closing bracket, found 'x'"));
  EXPECT_THAT(ProblemOf("{position: 1 velocity: 5}"), HasSubstr("arguments:1:12: position: expected a number in u"));
  EXPECT_THAT(ProblemOf("{position:1, velocity: 5}"),
              HasSubstr("arguments:1:2: expected a blank behind the colon, found 'position:1'"));
  EXPECT_THAT(ProblemOf("{position: 'a' velocity: 5}"), HasSubstr("expected a number"));
  EXPECT_THAT(ProblemOf("{position: [] velocity: 5}"), HasSubstr("expected a number"));
  EXPECT_THAT(ProblemOf("{position"), HasSubstr("expected ': ' and a value behind the key, found the end"));
  EXPECT_THAT(ProblemOf("{,}"), HasSubstr("expected a key, found"));
  EXPECT_THAT(ProblemOf("{\"position: 1}"), HasSubstr("expected a closing quote"));
  EXPECT_THAT(ProblemOf("{position: 1, # where\n velocity: 2}"), HasSubstr("found '# where"));
  EXPECT_THAT(ProblemOf("{position: 1,\n velocity: x}"), HasSubstr("arguments:2:12: velocity"));
  EXPECT_THAT(ProblemOf("{position: 1\x04}"), HasSubstr("control character 0x04"));
  EXPECT_THAT(ProblemOf("{position: 1\xFF}"), HasSubstr("byte 0xff"));
  EXPECT_THAT(ProblemOf(std::string(100, '{')), HasSubstr("expected a plain word as key"));
  EXPECT_THAT(ProblemOf("{position: " + std::string(100, '[')), HasSubstr("expected"));
  EXPECT_THAT(ProblemOf(std::string(kMaxArgumentBytes + 1, ' ') + "x"), HasSubstr("expected at most 16384 bytes"));
}

TEST(Arguments, QuotedTextKnowsItsEscapes) {
  Machine machine;
  Problem problem;
  ASSERT_TRUE(
      ReadArguments(machine, R"({axes: [], title: "a\"b\\c\n\u00e4\x41", tags: ['it''s', '''', ""]})", &problem))
      << problem.Text();
  EXPECT_EQ(machine.title,
            "a\"b\\c\n\xC3\xA4"
            "A");
  EXPECT_EQ(machine.tags, (std::vector<std::string>{"it's", "'", ""}));
  ASSERT_TRUE(ReadArguments(machine, R"({axes: [], title: "a\uD83D\ude00\uFFFDb"})", &problem)) << problem.Text();
  EXPECT_EQ(machine.title,
            "a\xF0\x9F\x98\x80\xEF\xBF\xBD"
            "b");
  EXPECT_THAT(ProblemOf<Machine>(R"({axes: [], title: "\q"})"), HasSubstr("expected a known escape"));
  for (const char* const text : {R"({axes: [], title: "\ud83d"})", R"({axes: [], title: "\ud83dx\ude00"})",
                                 R"({axes: [], title: "\ude00\ud83d"})"})
    EXPECT_THAT(ProblemOf<Machine>(text), HasSubstr("expected a known escape")) << text;
  EXPECT_THAT(ProblemOf<Machine>(R"({axes: [], title: "\)"), HasSubstr("expected a known escape"));
}

TEST(Arguments, ListsReplaceWhatWasThere) {
  Machine machine;
  machine.table = {1, 2, 3};
  machine.spare = 5;
  ASSERT_TRUE(ReadArguments(machine, "{axes: [], table: [4], spare: null}", nullptr));
  EXPECT_EQ(machine.table, std::vector<double>{4});
  EXPECT_FALSE(machine.spare);
}

TEST(Arguments, AllocateNothingOnSuccess) {
  MoveAbsolute move;
  TypeOf<MoveAbsolute>();
  const long before = AllocationsOfThisThread();
  const bool read = ReadArguments(move, "{position: 100, velocity: 50, jerk: 1e3, direction: \"positive\"}", nullptr);
  const long after = AllocationsOfThisThread();
  EXPECT_EQ(after, before);
  EXPECT_TRUE(read);
}

TEST(Hash, AllocatesNothing) {
  const auto read = ReadYaml<Machine>(example::kMachineYaml, "m");
  ASSERT_TRUE(read.ok());
  const Machine copy = *read.value;
  const long before = AllocationsOfThisThread();
  const bool same = HashOf(*read.value) == HashOf(copy) && Equal(*read.value, copy);
  const long after = AllocationsOfThisThread();
  EXPECT_EQ(after, before);
  EXPECT_TRUE(same);
}

TEST(Arguments, AreReadInMicroseconds) {
  MoveAbsolute move;
  const Type& type = TypeOf<MoveAbsolute>();
  const auto start = std::chrono::steady_clock::now();
  constexpr int kRounds = 10'000;
  for (int i = 0; i < kRounds; ++i)
    ASSERT_TRUE(ReadArguments(type, &move, "{position: 100, velocity: 50, direction: positive}", nullptr));
  const auto took =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start) / kRounds;
  EXPECT_LT(took.count(), 50'000);
  std::printf("one command: %lld ns\n", static_cast<long long>(took.count()));
}

TEST(Arguments, RandomBytesAndMutationsNeverCrash) {
  std::mt19937_64 random(7);
  const auto read = ReadYaml<Machine>(example::kMachineYaml, "m");
  ASSERT_TRUE(read.ok());
  const std::string good = WriteFlow(*read.value);
  const std::string spice = "{}[]:,'\"\\&*!~ \n0.e-xu#";
  int accepted = 0;
  for (int round = 0; round < 10'000; ++round) {
    std::string text = good;
    for (std::size_t change = 1 + random() % 3; change > 0; --change) {
      const std::size_t at = random() % text.size();
      if (random() % 3 == 0) {
        text.erase(at, 1 + random() % 6);
      } else {
        text[at] = spice[random() % spice.size()];
      }
    }
    Machine machine, again;
    Problem problem;
    if (!ReadArguments(machine, text, &problem)) {
      ASSERT_FALSE(problem.message.empty());
      continue;
    }
    ++accepted;
    ASSERT_TRUE(ReadArguments(again, WriteFlow(machine), &problem)) << problem.Text();
    ASSERT_TRUE(Equal(machine, again)) << WriteFlow(machine);
  }
  EXPECT_GT(accepted, 200);
  for (int round = 0; round < 10'000; ++round) {
    std::string bytes(random() % 200, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    MoveAbsolute move;
    EXPECT_FALSE(ReadArguments(move, bytes, nullptr));  // empty or not: the position is missing
  }
}

}  // namespace
}  // namespace takt
