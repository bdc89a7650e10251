#include "takt/core/yaml_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <random>

#include "example.h"
#include "takt/core/hash.h"
#include "takt/core/writer.h"

namespace takt {
namespace {

using example::Axis;
using example::Machine;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

template <typename T = Machine>
std::vector<std::string> Problems(std::string_view text) {
  std::vector<std::string> texts;
  for (const Problem& problem : ReadYaml<T>(text, "m.yaml").problems) texts.push_back(problem.Text());
  return texts;
}

// Problems of one axis with `lines` in place of or after the lines that every axis needs.
std::vector<std::string> AxisProblems(const std::string& lines) {
  return Problems("axes:\n- name: x\n  velocity: 5\n  drive: {mode: csp}\n" + lines + "\n");
}

std::string Only(const std::vector<std::string>& problems) {
  EXPECT_THAT(problems, SizeIs(1));
  return problems.empty() ? "" : problems.front();
}

TEST(YamlReader, ReadsEveryKindOfField) {  // EN-10, EN-11
  const auto result = ReadYaml<Machine>(example::kMachineYaml, "m.yaml");
  ASSERT_TRUE(result.ok()) << result.problems.front().Text();
  const Machine& m = *result.value;
  EXPECT_EQ(m.title, "Press 5");
  ASSERT_EQ(m.axes.size(), 2u);
  const Axis& x = m.axes[0];
  EXPECT_EQ(x.name, "x");
  EXPECT_EQ(x.velocity, 500);
  EXPECT_DOUBLE_EQ(x.mounting_angle, 0.52359877559829887);  // 30 deg
  EXPECT_TRUE(x.inverted);
  EXPECT_EQ(x.serial, ~std::uint64_t{0});
  EXPECT_EQ(x.shift, std::numeric_limits<std::int64_t>::min());
  EXPECT_THAT(x.gains, ElementsAre(20, 0.5, 0));
  EXPECT_EQ(x.drive.station, 3);
  EXPECT_EQ(x.drive.offset, -7);
  ASSERT_TRUE(x.homing);
  EXPECT_EQ(x.homing->velocity, 25);
  EXPECT_EQ(x.homing->direction, example::Direction::kNegative);
  EXPECT_EQ(x.homing->timeout_s, 10);
  EXPECT_EQ(x.limits.upper, 1200);
  EXPECT_EQ(m.axes[1].drive.mode, example::DriveMode::kVelocity);
  EXPECT_FALSE(m.axes[1].homing);
  EXPECT_THAT(m.axes[1].gains, ElementsAre(1, 0, 0));
  EXPECT_THAT(m.table, ElementsAre(1, 2.5, -3));
  EXPECT_THAT(m.tags, ElementsAre("a", "no", "5"));
  EXPECT_EQ(m.points[1][0], 3);
  EXPECT_EQ(m.spare, 4);
}

// All errors of a file in one run, in order, each with its position, path, the expected value and the nearest known
// word.
TEST(YamlReader, TellsAllProblemsAtOnce) {  // EN-10
  EXPECT_THAT(
      Problems(R"(titel: a
axes:
  - name: x
    velocity: fast
    drive: {mode: csp, station: 256}
    homing: {velocity: 1, direction: positve}
  - name: y
    velocity: -1
    drive: {}
  - 5
nothing_like_it: {a: [1, 2], b: {c: d}}
table: [1, 2000]
)"),
      ElementsAre(
          "m.yaml:1:1: expected a known key, found 'titel'; did you mean title?",
          "m.yaml:4:15: axes[0].velocity: expected a number in u/s (the axis' unit per second) above 0, found 'fast'",
          "m.yaml:5:33: axes[0].drive.station: expected a whole number from 0 to 255, found '256'",
          "m.yaml:6:38: axes[0].homing.direction: expected one of current, positive, shortest, negative, found "
          "'positve'; "
          "did you mean positive?",
          "m.yaml:8:15: axes[1].velocity: expected a number in u/s (the axis' unit per second) above 0, found -1",
          "m.yaml:9:12: axes[1].drive.mode: expected this key with one of csp, csv, found nothing",
          "m.yaml:10:5: axes[2]: expected a mapping, found '5'",
          "m.yaml:11:1: expected one of the keys title, axes, table, tags, points, spare, found 'nothing_like_it'",
          "m.yaml:12:12: table[1]: expected a number in mm at most 1000, found 2000"));
}

TEST(YamlReader, AMisspeltRequiredKeyIsNotMissingAsWell) {
  EXPECT_THAT(Problems("axes:\n- nam: x\n  velocity: 5\n  drive: {mode: csp}\n"),
              ElementsAre("m.yaml:2:3: axes[0]: expected a known key, found 'nam'; did you mean name?"));
  EXPECT_THAT(
      Problems("axes:\n- name: x\n  drive: {mode: csp}\n"),
      ElementsAre(
          "m.yaml:2:3: axes[0].velocity: expected this key with a number in u/s (the axis' unit per second) above 0, "
          "found nothing"));
}

TEST(YamlReader, InternalFieldsAreNotRead) {
  EXPECT_THAT(Only(AxisProblems("  counter: 5")), HasSubstr("found 'counter'"));
  EXPECT_THAT(Only(AxisProblems("  countr: 5")), testing::Not(HasSubstr("mean counter")));
}

TEST(YamlReader, UnitsAreNotWritten) {  // EN-10: wrong unit
  EXPECT_EQ(Only(Problems("axes: []\ntable: [500 mm/s]\n")),
            "m.yaml:2:9: table[0]: expected a number in mm without the unit, found '500 mm/s'");
  EXPECT_EQ(Only(AxisProblems("  mounting_angle: 90deg")),
            "m.yaml:5:19: axes[0].mounting_angle: expected a number in deg without the unit, found '90deg'");
  EXPECT_THAT(Only(AxisProblems("  mounting_angle: \"1.5 rad\"")),
              HasSubstr("a number in deg without the unit, found '1.5 rad'"));
  EXPECT_THAT(Only(AxisProblems("  mounting_angle: 90°")), HasSubstr("without the unit, found '90°'"));
  EXPECT_THAT(Only(AxisProblems("  serial: 5 pieces")), HasSubstr("a whole number without the unit, found '5 pieces'"));
  EXPECT_EQ(Only(Problems("axes:\n- name: x\n  velocity_mm_s: 5\n  drive: {mode: csp}\n")),
            "m.yaml:3:3: axes[0]: expected the key velocity without a unit, found 'velocity_mm_s'; it takes a number "
            "in u/s (the "
            "axis' unit per second) above 0");
  EXPECT_THAT(Only(AxisProblems("  mounting_angle [rad]: 1")), HasSubstr("the key mounting_angle without a unit"));
  EXPECT_THAT(Only(AxisProblems("  mounting_angle_deg: 1")), HasSubstr("it takes a number in deg from -360 to 360"));
}

TEST(YamlReader, RangesAreInWrittenUnits) {
  EXPECT_THAT(AxisProblems("  mounting_angle: 360"), IsEmpty());
  EXPECT_EQ(Only(AxisProblems("  mounting_angle: 360.1")),
            "m.yaml:5:19: axes[0].mounting_angle: expected a number in deg from -360 to 360, found 360.1");
  EXPECT_THAT(Only(AxisProblems("  gains: [1, -1, 1]")),
              HasSubstr("gains[1]: expected a number in 1/s at least 0, found -1"));
  EXPECT_THAT(Only(Problems("axes: []\nspare: 11")), HasSubstr("expected a whole number from 1 to 10, found 11"));
}

TEST(YamlReader, NumbersAreFinite) {
  for (const std::string word : {".nan", ".inf", "-.inf", "nan", "inf", "+inf", ".NaN", "Infinity"}) {
    EXPECT_THAT(Only(AxisProblems("  mounting_angle: " + word)),
                HasSubstr("expected a finite number in deg, found '" + word + "'"));
  }
  EXPECT_THAT(Only(AxisProblems("  mounting_angle: 1e400")), HasSubstr("found '1e400'"));
}

TEST(YamlReader, NumbersAreDecimal) {
  EXPECT_THAT(Only(AxisProblems("  serial: 010")), HasSubstr("without leading zeros, found '010'"));
  EXPECT_THAT(Only(AxisProblems("  mounting_angle: 007.5")), HasSubstr("without leading zeros, found '007.5'"));
  for (const std::string word :
       {"0x1F", "1_000", "1:30", "3.0", "1e3", "--1", "five", "''", "\"5\"", "true", "~", "+-1"}) {
    EXPECT_THAT(AxisProblems("  serial: " + word), SizeIs(1)) << word;
  }
  for (const std::string word : {"0x1F", "1_000", "1:30", "1e", "e5", ".", "1.2.3", "1,5", "'5'", "true", "~", ""}) {
    EXPECT_THAT(AxisProblems("  mounting_angle: " + word), SizeIs(1)) << word;
  }
  for (const std::string word : {"3", "+3", "-3.", ".5", "1e-3", "1.0E+1", "-0", "0.25"}) {
    EXPECT_THAT(AxisProblems("  mounting_angle: " + word), IsEmpty()) << word;
  }
}

TEST(YamlReader, WholeNumbersFitTheirType) {
  EXPECT_THAT(AxisProblems("  drive: {mode: csp, offset: -32768}"), SizeIs(1));  // only the key is repeated
  const auto drive = [](const std::string& text) { return Problems<example::Drive>("mode: csp\n" + text + "\n"); };
  EXPECT_THAT(drive("offset: -32768"), IsEmpty());
  EXPECT_THAT(drive("offset: 32767"), IsEmpty());
  EXPECT_THAT(Only(drive("offset: -32769")),
              HasSubstr("a whole number in count (encoder counts) from -32768 to 32767, found '-32769'"));
  EXPECT_THAT(drive("offset: 32768"), SizeIs(1));
  EXPECT_THAT(drive("station: 255"), IsEmpty());
  EXPECT_THAT(drive("station: -1"), SizeIs(1));
  EXPECT_THAT(AxisProblems("  serial: 18446744073709551616"), SizeIs(1));
  EXPECT_THAT(AxisProblems("  shift: -9223372036854775809"), SizeIs(1));
  EXPECT_THAT(AxisProblems("  shift: 9223372036854775807"), IsEmpty());
}

TEST(YamlReader, SwitchesAreTrueOrFalse) {
  EXPECT_THAT(AxisProblems("  inverted: true"), IsEmpty());
  for (const std::string word : {"yes", "on", "y", "True", "1", "'true'"}) {
    EXPECT_THAT(Only(AxisProblems("  inverted: " + word)), HasSubstr("expected true or false, found")) << word;
  }
}

TEST(YamlReader, WordsThatOtherReadersTakeForSomethingElseNeedQuotes) {
  for (const std::string word : {"no", "on", "Yes", "5", "1e3", "010", "2026-01-01", "1:30", ".inf", "true", "0x1F"}) {
    EXPECT_THAT(Only(Problems("axes: []\ntitle: " + word)), HasSubstr("write it in double quotes")) << word;
    EXPECT_THAT(Problems("axes: []\ntitle: \"" + word + "\""), IsEmpty()) << word;
  }
  for (const std::string word : {"no way", "y", "n", "x5", "12abc", "-x", "a:b"})
    EXPECT_THAT(Problems("axes: []\ntitle: " + word), IsEmpty()) << word;
}

TEST(YamlReader, KeysComeOnce) {
  EXPECT_EQ(Only(AxisProblems("  velocity: 6")),
            "m.yaml:5:3: axes[0].velocity: expected each key once, found it again");
}

TEST(YamlReader, NamesInAListComeOnce) {  // EN-10: duplicate name
  const std::string axis = "  velocity: 5\n  drive: {mode: csp}\n";
  EXPECT_EQ(Only(Problems("axes:\n- name: x\n" + axis + "- name: y\n" + axis + "- name: x\n" + axis)),
            "m.yaml:8:9: axes[2].name: expected each name once, found 'x' again, first in [0]");
}

TEST(YamlReader, RulesOverSeveralFields) {
  EXPECT_EQ(Only(AxisProblems("  limits: {lower: 5, upper: 5}")),
            "m.yaml:5:29: axes[0].limits.upper: must lie above lower");
  EXPECT_EQ(Only(AxisProblems("  limits: {lower: 500}")), "m.yaml:5:11: axes[0].limits.upper: must lie above lower");
}

TEST(YamlReader, ListsOfFixedLength) {
  EXPECT_THAT(Only(AxisProblems("  gains: [1, 2]")), HasSubstr("axes[0].gains: expected a list of 3, found 2"));
  EXPECT_THAT(Only(AxisProblems("  gains: [1, 2, 3, 4, 5]")),
              HasSubstr("axes[0].gains[3]: expected a list of 3, found more"));
  EXPECT_THAT(Only(AxisProblems("  gains: 1")), HasSubstr("axes[0].gains: expected a list of 3, found '1'"));
  EXPECT_THAT(Only(AxisProblems("  gains: {a: 1}")), HasSubstr("found a mapping"));
  EXPECT_THAT(Only(AxisProblems("  limits: [1]")), HasSubstr("expected a mapping, found a list"));
}

TEST(YamlReader, AnchorsAliasesTagsAndMergeKeysAreRefusedWithTheirPlace) {
  EXPECT_THAT(Only(AxisProblems("  mounting_angle: &a 5")),
              HasSubstr("m.yaml:5:19: axes[0].mounting_angle: expected a value, found an anchor"));
  EXPECT_THAT(Only(AxisProblems("  limits: &a {lower: 1}")),
              HasSubstr("m.yaml:5:11: axes[0].limits: expected a value, found an anchor"));
  EXPECT_THAT(Problems("axes: &a [*a]\n"), SizeIs(2));
  EXPECT_THAT(AxisProblems("  limits: &a {lower: 1}\n  homing: *a"), SizeIs(2));
  EXPECT_THAT(AxisProblems("  limits: &a {lower: 1}\n  <<: *a"), SizeIs(3));  // anchor, key, alias
  EXPECT_THAT(Only(AxisProblems("  <<: {inverted: true}")),
              HasSubstr("m.yaml:5:3: axes[0]: expected a key, found '<<'"));
  for (const std::string tag : {"!!float 5", "!mine 5", "! 5", "!!str \"5\"", "!<tag:yaml.org,2002:int> 5"}) {
    EXPECT_THAT(Only(AxisProblems("  mounting_angle: " + tag)), HasSubstr("found a tag")) << tag;
  }
  EXPECT_THAT(Only(AxisProblems("  limits: !!map {lower: 1}")),
              HasSubstr("axes[0].limits: expected a value, found a tag"));
  EXPECT_THAT(Only(Problems("!!map {axes: []}")), HasSubstr("m.yaml:1:1: expected a value, found a tag"));
  EXPECT_THAT(Only(AxisProblems("  &k inverted: true")), HasSubstr("found an anchor"));
}

TEST(YamlReader, OneDocumentOnly) {
  EXPECT_THAT(Problems("---\naxes: []\n...\n"), IsEmpty());
  for (const std::string behind : {"---\n", "---\naxes: []\n", "...\n---\n{}\n", "...\naxes: []\n"}) {
    EXPECT_THAT(Only(Problems("axes: []\n" + behind)), HasSubstr("second document")) << behind;
  }
}

TEST(YamlReader, EmptyFilesSaySo) {
  for (const std::string text : {"", "\n\n", "# nothing but words\n", "\xEF\xBB\xBF"}) {
    EXPECT_EQ(Only(Problems(text)), "m.yaml:1:1: expected a mapping, found an empty file") << text;
  }
  EXPECT_THAT(Only(Problems("---\n")), HasSubstr("expected a mapping, found nothing"));
  EXPECT_THAT(Only(Problems("just words")), HasSubstr("expected a mapping, found 'just words'"));
  EXPECT_THAT(Only(Problems("[1, 2]")), HasSubstr("expected a mapping, found a list"));
}

TEST(YamlReader, AByteOrderMarkDoesNotMoveColumns) {
  EXPECT_EQ(Only(Problems("\xEF\xBB\xBFtitel: a\naxes: []")).substr(0, 11), "m.yaml:1:1:");
}

TEST(YamlReader, ControlCharactersAndBrokenUtf8AreRefusedWithTheirPlace) {
  using namespace std::string_literals;
  EXPECT_EQ(Only(Problems("axes: []\ntit\x04le: a\n")), "m.yaml:2:4: expected text, found the control character 0x04");
  EXPECT_EQ(Only(Problems("axes: []\n\0"s)), "m.yaml:2:1: expected text, found the control character 0x00");
  EXPECT_EQ(Only(Problems("title: \xC3\xA4\xFF")), "m.yaml:1:9: expected text in UTF-8, found the byte 0xff");
  for (const std::string& bytes : {"\xC0\xAF"s, "\xE0\x81\x81"s, "\xF0\x80\x81\x81"s, "\xED\xA0\x80"s,
                                   "\xF5\x80\x80\x80"s, "\xE2\x82"s, "\x80"s, "\xC2\x85"s, "\x7F"s, "\xFF\xFE"s}) {
    EXPECT_THAT(Only(Problems("axes: []\ntitle: " + bytes)), HasSubstr("m.yaml:2:8: expected text"));
  }
}

TEST(YamlReader, ColumnsCountCharacters) {
  EXPECT_EQ(Only(Problems("{title: \"\xC3\xA4\xC3\xB6\xC3\xBC\", axs: []}")).substr(0, 12), "m.yaml:1:16:");
}

TEST(YamlReader, BrokenYamlTellsWhere) {
  for (const std::string open : {"\"a\n", "\"a", "'a", "'a''", "'a''\n", "\"a\\\"", "'", "\""}) {
    EXPECT_THAT(Problems("axes: []\ntitle: " + open), SizeIs(1)) << open;
  }
  for (const std::string closed : {"\"a\\\"\"", "'a'''", "''", "|\n  \"a", ">\n  'a"}) {
    EXPECT_THAT(Problems("axes: []\ntitle: " + closed + "\n"), IsEmpty()) << closed;
  }
  EXPECT_THAT(Only(Problems("axes: [}\n")), HasSubstr("m.yaml:1:8:"));
  EXPECT_THAT(Problems("axes: []\n\ttitle: a\n"), SizeIs(1));
  EXPECT_THAT(Problems("axes: []\n} \n"), SizeIs(1));
}

TEST(YamlReader, MappingsAndListsAsKeys) {
  EXPECT_THAT(Only(Problems("? [a, b]\n: 5\naxes: []\n")), HasSubstr("expected a plain word as key, found a list"));
  EXPECT_THAT(Only(Problems("? {a: b}\n: {c: d}\naxes: []\n")),
              HasSubstr("expected a plain word as key, found a mapping"));
  EXPECT_THAT(Only(Problems("axes: []\n: 5\n")), HasSubstr("found ''"));
}

TEST(YamlReader, DepthIsLimited) {
  for (const std::size_t levels : {std::size_t{30}, std::size_t{1000}, std::size_t{100'000}}) {
    const auto problems = Problems("points: " + std::string(levels, '[') + std::string(levels, ']') + "\naxes: []\n");
    ASSERT_FALSE(problems.empty());
    EXPECT_THAT(problems.back(), HasSubstr("expected at most 24 levels of mappings and lists, found more")) << levels;
  }
}

TEST(YamlReader, ProblemsAreCapped) {
  std::string text = "axes:\n";
  for (int i = 0; i < 1000; ++i) text += "- 5\n";
  const auto problems = Problems(text);
  ASSERT_THAT(problems, SizeIs(kMaxProblems + 1));
  EXPECT_THAT(problems.back(), HasSubstr("too many problems"));
}

TEST(YamlReader, PlacesOfKeyPathsForLaterChecks) {  // EN-10: for references to nothing
  const auto result = ReadYaml<Machine>(example::kMachineYaml, "m.yaml");
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.source.ProblemAt("axes[0].drive.mode", "expected a drive, found nothing").Text(),
            "m.yaml:11:19: axes[0].drive.mode: expected a drive, found nothing");
  EXPECT_EQ(result.source.PlaceOf("axes[1].name").line, 19);
  EXPECT_EQ(result.source.PlaceOf("axes[1].limits.upper").line, 19);  // not written: the axis
  EXPECT_EQ(result.source.PlaceOf("axes[7].name").line, 4);           // no such axis: the list
}

TEST(YamlReader, FilesThatCannotBeReadSayWhy) {
  EXPECT_THAT(ReadYamlFile<Machine>("/no/such/file.yaml").problems.at(0).Text(), HasSubstr("No such file"));
  EXPECT_THAT(ReadYamlFile<Machine>("/").problems, SizeIs(1));
  const std::string path = testing::TempDir() + "takt_reader_test.yaml";
  std::ofstream(path) << example::kMachineYaml;
  EXPECT_TRUE(ReadYamlFile<Machine>(path).ok());
}

// --- Bad input
// ------------------------------------------------------------------------------------------------------------------

std::string RandomBytes(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

TEST(YamlReader, TenMegabytesOfRandomBytesGiveOneClearProblem) {  // EN-10
  const std::string bytes = RandomBytes(10'000'000, 1);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(Only(Problems(bytes)), "m.yaml:1:1: expected at most 8 MB, found more");
  EXPECT_THAT(Only(Problems(bytes.substr(0, 7'000'000))), HasSubstr("expected text"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));

  const std::string path = testing::TempDir() + "takt_random.yaml";
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_THAT(ReadYamlFile<Machine>(path).problems, SizeIs(1));
}

TEST(YamlReader, LargeFilesOfOneCharacterEndQuickly) {
  for (const char c : std::string("[{-:?,\"'#&*!|> \na%@`]}~.0")) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_LE(Problems(std::string(2'000'000, c)).size(), kMaxProblems + 1) << c;
    EXPECT_LE(Problems("axes:\n" + std::string(200'000, c) + "\n").size(), kMaxProblems + 1) << c;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20)) << c;
  }
}

// Random bytes of a valid file are changed. The result is read or reported, never a crash; a file that is read is
// written and read back as the identical object.
TEST(YamlReader, TenThousandMutationsOfAGoodFile) {
  std::mt19937_64 random(20261101);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::string good(example::kMachineYaml);
  const std::string spice = "[]{}:,-?&*!|>'\"%@`#~<=\n \t.0123456789eE+_xyn\x04\xFF\xC3";
  int accepted = 0;
  for (int round = 0; round < 10'000; ++round) {
    std::string text = good;
    for (std::size_t change = 1 + below(2); change > 0; --change) {
      const std::size_t at = below(text.size());
      switch (below(5)) {
        case 0:
          text[at] = spice[below(spice.size())];
          break;
        case 1:
          text.insert(at, 1, spice[below(spice.size())]);
          break;
        case 2:
          text.erase(at, 1 + below(8));
          break;
        case 3:
          text.insert(below(text.size()), text.substr(at, below(40)));
          break;
        default:
          std::swap(text[at], text[below(text.size())]);
      }
    }
    const auto result = ReadYaml<Machine>(text, "m.yaml");
    ASSERT_EQ(result.ok(), result.problems.empty());
    if (!result.ok()) continue;
    ++accepted;
    const std::string written = WriteYaml(*result.value);
    const auto again = ReadYaml<Machine>(written, "again.yaml");
    ASSERT_TRUE(again.ok()) << again.problems.front().Text() << "\n" << written << "\nfrom\n" << text;
    ASSERT_TRUE(Equal(*result.value, *again.value)) << written;
    ASSERT_EQ(HashOf(*result.value), HashOf(*again.value));
  }
  EXPECT_GT(accepted, 500);
  EXPECT_LT(accepted, 9'500);
}

TEST(YamlReader, ReadsPairsOfSurrogates) {  // EN-10: as JSON escapes characters above U+FFFF
  const std::map<std::string, std::string> titles = {
      {R"("\uD83D\uDE00")", "\xF0\x9F\x98\x80"},
      {R"("\ud800\udc00\udbff\udfff")", "\xF0\x90\x80\x80\xF4\x8F\xBF\xBF"},
      {R"("a\\\ud83d\ude00\u00e4")", "a\\\xF0\x9F\x98\x80\xC3\xA4"},
      {R"("\\ud83d\\ude00")", R"(\ud83d\ude00)"},
      {R"('\ud83d\ude00')", R"(\ud83d\ude00)"},
      {R"(\ud83d\ude00)", R"(\ud83d\ude00)"},
  };
  for (const auto& [written, title] : titles) {
    const auto result = ReadYaml<Machine>("axes: []\ntitle: " + written + " # \\ud83d\\ude00\n", "m.yaml");
    ASSERT_TRUE(result.ok()) << result.problems.front().Text();
    EXPECT_EQ(result.value->title, title) << written;
  }
  for (const char* const single : {R"("\ud83d")", R"("\ude00\ud83d")", R"("\ud83d \ude00")"})
    EXPECT_THAT(Only(Problems("axes: []\ntitle: " + std::string(single))), HasSubstr("m.yaml:2:")) << single;
  EXPECT_THAT(Only(Problems(R"({"axes": [], "title": "\ud83d\ude00", "colour": 1})")), HasSubstr("m.yaml:1:39: "));
  EXPECT_THAT(Only(Problems(R"({"axes": [], "\ud83d\ude00": 1})")), HasSubstr("found '\xF0\x9F\x98\x80'"));
}

TEST(YamlReader, ALargeMachineIsReadQuickly) {
  Machine machine;
  for (int i = 0; i < 200; ++i) {
    Axis axis{.name = "axis" + std::to_string(i), .velocity = 1.5 + i};
    axis.homing = example::Homing{};
    machine.axes.push_back(axis);
  }
  const std::string text = WriteYaml(machine);
  const auto start = std::chrono::steady_clock::now();
  const auto result = ReadYaml<Machine>(text, "m.yaml");
  const auto took = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(Equal(*result.value, machine));
  EXPECT_LT(took.count(), 2'000'000);
  std::printf("%td lines: %lld us\n", std::count(text.begin(), text.end(), '\n'), static_cast<long long>(took.count()));
}

}  // namespace
}  // namespace takt
