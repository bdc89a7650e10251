#include "takt/core/writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "example.h"
#include "takt/core/arguments.h"
#include "takt/core/hash.h"
#include "takt/core/scalar.h"
#include "takt/core/yaml_reader.h"

namespace takt {
namespace {

using example::Machine;

TEST(Writer, WritesAMachineFile) {
  Machine machine;
  machine.axes.push_back({.name = "x", .velocity = 500});
  machine.axes[0].mounting_angle = std::numbers::pi / 6;
  machine.axes[0].homing = example::Homing{};
  machine.table = {1, 0.001};
  EXPECT_EQ(WriteYaml(machine, Comments::kUnits), R"(title: untitled
axes:
  - name: x
    velocity: 500.0  # u/s
    mounting_angle: 30.0  # deg
    inverted: false
    serial: 0
    shift: 0
    gains: [1.0, 0.0, 0.0]  # 1/s
    drive:
      mode: csp
      station: 0
      offset: 0  # count
    homing:
      velocity: 10.0  # u/s
      direction: current
    limits:
      lower: -100.0  # u
      upper: 100.0  # u
table: [1.0, 0.001]  # mm
tags: []
points: []  # mm
)");
  const auto read = ReadYaml<Machine>(WriteYaml(machine, Comments::kUnits), "m");
  ASSERT_TRUE(read.ok());
  EXPECT_TRUE(Equal(*read.value, machine));
}

TEST(Writer, WritesOneLine) {
  EXPECT_EQ(WriteFlow(example::MoveAbsolute{.position = -1.5, .velocity = 20}),
            "{position: -1.5, velocity: 20.0, jerk: 0.0, direction: current}");
}

TEST(Writer, RealsAreRealsForEveryReader) {
  EXPECT_EQ(FormatReal(1e-3), "0.001");
  EXPECT_EQ(FormatReal(1e-5), "1.0e-05");  // 1e-05 is text for YAML 1.1
  EXPECT_EQ(FormatReal(1e22), "1.0e+22");
  EXPECT_EQ(FormatReal(100), "100.0");
  EXPECT_EQ(FormatReal(-0.0), "-0.0");
  EXPECT_EQ(FormatReal(0.1), "0.1");
}

TEST(Writer, RealsReadBackAsTheSameBits) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = random();
    double value, again = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isnormal(value)) continue;
    ASSERT_EQ(ParseReal(FormatReal(value), again), NumberError::kNone) << FormatReal(value);
    ASSERT_EQ(std::memcmp(&value, &again, sizeof value), 0) << FormatReal(value);
  }
  for (const double value :
       {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max(), 1e-310, -0.0}) {
    double again = 1;
    ASSERT_EQ(ParseReal(FormatReal(value), again), NumberError::kNone) << FormatReal(value);
    ASSERT_EQ(value, again);
  }
}

TEST(Writer, AnglesAreWrittenAsPeopleWroteThem) {
  const double scale = std::numbers::pi / 180;
  for (int i = -36'000; i <= 36'000; ++i) {
    const double degrees = i / 100.0;
    ASSERT_EQ(Written(degrees * scale, scale) * scale, degrees * scale);
    ASSERT_LE(FormatReal(Written(degrees * scale, scale)).size(), FormatReal(degrees).size()) << degrees;
  }
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> angle(-360, 360);
  for (int i = 0; i < 100'000; ++i) {
    const double held = angle(random) * scale;
    ASSERT_EQ(Written(held, scale) * scale, held);
  }
}

TEST(Writer, AnyTextReadsBack) {
  using namespace std::string_literals;
  Machine machine;
  machine.tags = {"",
                  "no",
                  "ON",
                  "y",
                  "5",
                  "1e3",
                  "null",
                  "~",
                  "a: b",
                  "a #b",
                  "#",
                  "- a",
                  "'",
                  "\"",
                  "\\",
                  "a\nb",
                  "\t",
                  " a ",
                  "\x01\x7F"s,
                  "\0"s,
                  "\xC2\x85",
                  "\xE2\x80\xA8",
                  "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80",
                  "&a",
                  "*a",
                  "!a",
                  "<<",
                  "{",
                  "]",
                  "a,b",
                  "?",
                  "%",
                  "@",
                  "`",
                  "|",
                  ">",
                  "2026-01-01",
                  "0x10",
                  ".5",
                  "---",
                  "...",
                  "\xEF\xBB\xBF",
                  "true",
                  "a b",
                  "-",
                  "."};
  machine.title = "\r\n";
  for (const std::string& text : {WriteYaml(machine), WriteFlow(machine)}) {
    const auto read = ReadYaml<Machine>(text, "m");
    ASSERT_TRUE(read.ok()) << read.problems.front().Text() << text;
    EXPECT_EQ(read.value->tags, machine.tags);
    EXPECT_TRUE(Equal(*read.value, machine));
  }
  Machine again;
  Problem problem;
  ASSERT_TRUE(ReadArguments(again, WriteFlow(machine), &problem)) << problem.Text();
  EXPECT_TRUE(Equal(again, machine));
}

}  // namespace
}  // namespace takt
