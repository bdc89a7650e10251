// Machine files: every problem with its position, nothing started.
#include "takt/engine/load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "machines.h"
#include "takt/core/writer.h"
#include "takt/engine/order.h"

namespace takt::engine {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string FileOf(const std::string& axes, const std::string& rest = "") {
  return "name: m\n" + rest + "axes:\n" + axes;
}

// EN-10: a machine that is written and read again is the same.
TEST(LoadMachine, ReadsWhatWasWritten) {
  const Machine machine = FullMachine();
  const LoadResult again = LoadMachine(WriteYaml(machine, Comments::kUnits), "again.yaml");
  ASSERT_THAT(again.problems, testing::IsEmpty());
  EXPECT_EQ(WriteYaml(*again.machine), WriteYaml(machine));
}

// EN-10: all errors of a file in one run, each with file:line:column, key path, expected and found value, and the
// nearest word.
TEST(LoadMachine, ReportsEverythingAtOnceWithItsPlace) {
  const LoadResult result = LoadMachine(
      "name: m\n"
      "cycle: {period_s: 5}\n"
      "axes:\n"
      "  - name: x\n"
      "    limits: {velocty: 5, velocity: 500 mm/s, acceleration: -1, jerk: 0}\n"
      "  - name: x\n"
      "    kind: rotery\n"
      "    limits: {velocity: 1, acceleration: 1, jerk: 1}\n"
      "simulation:\n"
      "  servos:\n"
      "    - axis: xx\n",
      "bad.yaml");
  EXPECT_FALSE(result.machine);
  EXPECT_THAT(
      result.problems,
      ElementsAre(
          AllOf(HasSubstr("bad.yaml:2:19: cycle.period_s: "), HasSubstr("from 0.00025 to 0.02"), HasSubstr("5")),
          AllOf(HasSubstr("bad.yaml:5:14: axes[0].limits: "), HasSubstr("velocty"), HasSubstr("did you mean velocity")),
          AllOf(HasSubstr("bad.yaml:5:36: axes[0].limits.velocity: "), HasSubstr("u/s"), HasSubstr("500 mm/s")),
          AllOf(HasSubstr("axes[0].limits.acceleration: "), HasSubstr("above 0"), HasSubstr("-1")),
          AllOf(HasSubstr("bad.yaml:6:"), HasSubstr("axes[1].name: "), HasSubstr("x")),
          AllOf(HasSubstr("bad.yaml:7:11: axes[1].kind: "), HasSubstr("did you mean rotary")),
          AllOf(HasSubstr("bad.yaml:11:13: simulation.servos[0].axis: "), HasSubstr("xx"))));
}

// EN-03: a loop of followers is an error that names its members in order.
TEST(LoadMachine, NamesTheMembersOfALoop) {
  const std::string limits = "    limits: {velocity: 1, acceleration: 1, jerk: 1}\n";
  const LoadResult result =
      LoadMachine(FileOf("  - name: a\n" + limits + "    follows: {axis: c}\n  - name: b\n" + limits +
                         "    follows: {axis: a}\n  - name: c\n" + limits + "    follows: {axis: b}\n  - name: d\n" +
                         limits + "    follows: {axis: a}\n"),
                  "loop.yaml");
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_THAT(result.problems[0], HasSubstr("in no loop, found b -> c -> a -> b"));
}

// EN-03: a follower that could not keep up with its master's limits is refused.
TEST(LoadMachine, RefusesAFollowerThatCannotKeepUp) {
  const LoadResult result = LoadMachine(FileOf("  - name: a\n    limits: {velocity: 10, acceleration: 1, jerk: 1}\n"
                                               "  - name: b\n    limits: {velocity: 10, acceleration: 9, jerk: 9}\n"
                                               "    follows: {axis: a, ratio: -2}\n"),
                                        "m.yaml");
  EXPECT_THAT(result.problems,
              ElementsAre(AllOf(HasSubstr("m.yaml:7:21: axes[1].follows.axis"), HasSubstr("velocity"))));
}

// EN-03: each limit of the follower is checked, and a jerk limit cannot be kept with a master without one.
TEST(LoadMachine, LooksAtEveryLimitOfAFollower) {
  const auto problems = [](const std::string& master, const std::string& follower) {
    return LoadMachine(FileOf("  - name: a\n    limits: " + master + "\n  - name: b\n    limits: " + follower +
                              "\n    follows: {axis: a, ratio: -2}\n"),
                       "m.yaml")
        .problems;
  };
  const std::string master = "{velocity: 1, acceleration: 1, deceleration: 1, jerk: 1}";
  EXPECT_THAT(problems(master, "{velocity: 2, acceleration: 2, deceleration: 2, jerk: 2}"), testing::IsEmpty());
  EXPECT_THAT(problems(master, "{velocity: 2, acceleration: 2, deceleration: 2, jerk: 0}"), testing::IsEmpty());
  EXPECT_THAT(problems(master, "{velocity: 1.9, acceleration: 2, deceleration: 2, jerk: 2}"),
              ElementsAre(HasSubstr("limit of velocity")));
  EXPECT_THAT(problems(master, "{velocity: 2, acceleration: 1.9, deceleration: 2, jerk: 2}"),
              ElementsAre(HasSubstr("limit of acceleration")));
  EXPECT_THAT(problems(master, "{velocity: 2, acceleration: 2, deceleration: 1.9, jerk: 2}"),
              ElementsAre(HasSubstr("limit of deceleration")));
  EXPECT_THAT(problems(master, "{velocity: 2, acceleration: 2, deceleration: 2, jerk: 1.9}"),
              ElementsAre(HasSubstr("limit of jerk")));
  EXPECT_THAT(problems("{velocity: 1, acceleration: 1, jerk: 0}", "{velocity: 2, acceleration: 2, jerk: 100}"),
              ElementsAre(HasSubstr("limit of jerk")));
}

// References to axes must name existing ones, each once; problems are in the order of the file.
TEST(LoadMachine, ChecksWhatRefersToAxes) {
  const std::string limits = "    limits: {velocity: 1, acceleration: 1, jerk: 1}\n";
  const LoadResult result =
      LoadMachine(FileOf("  - name: machine\n" + limits + "  - name: x\n" + limits + "    follows: {axis: y}\n" +
                             "  - name: z\n    limits: {velocity: 0, acceleration: 1, jerk: 1}\n" +
                             "simulation: {servos: [{axis: x}, {axis: x}]}\n",
                         "lcm: {rates: [{axis: w, rate_hz: 1}, {axis: x, rate_hz: 1}, {axis: x, rate_hz: 2}]}\n"),
                  "m.yaml");
  EXPECT_THAT(
      result.problems,
      ElementsAre(AllOf(HasSubstr("lcm.rates[0].axis"), HasSubstr("'w'")),
                  AllOf(HasSubstr("lcm.rates[2].axis"), HasSubstr("again")), HasSubstr("axes[0].name"),
                  AllOf(HasSubstr("axes[1].follows.axis"), HasSubstr("'y'")), HasSubstr("axes[2].limits.velocity"),
                  AllOf(HasSubstr("simulation.servos[1].axis"), HasSubstr("again"))));
}

// A missing name is one problem, not two.
TEST(LoadMachine, ReportsAMissingNameOnce) {
  EXPECT_THAT(LoadMachine(FileOf("  - limits: {velocity: 1, acceleration: 1, jerk: 1}\n"), "m.yaml").problems,
              ElementsAre(HasSubstr("name")));
}

TEST(LoadMachine, TakesEveryGoodName) {
  for (const char* name : {"a.b", "A-b_9", "aaaaaaaaaabbbbbbbbbbccccccccccdddddddddd"}) {
    const std::string text =
        FileOf(std::string("  - name: ") + name + "\n    limits: {velocity: 1, acceleration: 1, jerk: 1}\n");
    EXPECT_THAT(LoadMachine(text, "m.yaml").problems, testing::IsEmpty()) << name;
  }
}

// AX-83: a follower has no SW limits of its own, as its master could lead it out of them.
TEST(LoadMachine, RefusesAFollowerWithSoftLimits) {
  const LoadResult result =
      LoadMachine(FileOf("  - name: a\n    limits: {velocity: 10, acceleration: 1, jerk: 1}\n"
                         "  - name: b\n    limits: {velocity: 10, acceleration: 9, jerk: 9, upper: 50}\n"
                         "    follows: {axis: a}\n"),
                  "m.yaml");
  EXPECT_THAT(result.problems, ElementsAre(AllOf(HasSubstr("axes[1].follows.axis"), HasSubstr("no lower and upper"))));
}

TEST(LoadMachine, WantsAtLeastOneAxis) {
  EXPECT_THAT(LoadMachine("name: m\naxes: []\n", "m.yaml").problems, ElementsAre(HasSubstr("at least one axis")));
  EXPECT_FALSE(LoadMachine("", "m.yaml").problems.empty());
}

TEST(LoadMachine, RefusesNamesThatCannotBeAddressed) {
  for (const char* name :
       {"machine", "a b", "a/b", "\"\"", "äxis", "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"}) {
    const std::string text =
        FileOf(std::string("  - name: ") + name + "\n    limits: {velocity: 1, acceleration: 1, jerk: 1}\n");
    EXPECT_FALSE(LoadMachine(text, "m.yaml").problems.empty()) << name;
  }
}

// AX-02: SW limits are refused on rotary axes.
TEST(LoadMachine, RefusesSoftLimitsOnRotaryAxes) {
  const LoadResult result = LoadMachine(
      FileOf("  - name: c\n    kind: rotary\n    limits: {velocity: 1, acceleration: 1, jerk: 1, lower: 0}\n"),
      "m.yaml");
  EXPECT_THAT(result.problems, ElementsAre(HasSubstr("axes[0].limits")));
}

TEST(LoadMachineFile, SaysWhatCannotBeRead) {
  EXPECT_THAT(LoadMachineFile("/nowhere/m.yaml").problems, ElementsAre(HasSubstr("/nowhere/m.yaml: ")));
}

// EN-22: problems of a command are reported in a sentence, with the nearest word.
TEST(ParseCommand, SaysWhatIsWrong) {
  const Machine machine = FullMachine();
  EXPECT_EQ(ParseCommand(machine, "y1", "move_absolute", "{position: 10, velocity: 50}").sentence, "");
  EXPECT_EQ(ParseCommand(machine, "y1", "halt", "").sentence, "");
  const ParsedCommand target = ParseCommand(machine, "y3", "halt", "");
  EXPECT_EQ(target.error, ErrorId::kUnknownTarget);
  EXPECT_THAT(target.sentence, HasSubstr("'y3'"));
  const ParsedCommand verb = ParseCommand(machine, "y1", "move_absolut", "");
  EXPECT_EQ(verb.error, ErrorId::kUnknownVerb);
  EXPECT_THAT(verb.sentence, HasSubstr("did you mean move_absolute"));
  for (const char* bad : {"{position: .nan}", "{position: inf}", "{velocity: 5}", "{position: 1, velocity: 501}",
                          "{position: 1, velocity: 0}", "{position: 1, sped: 1}", "{position: [1]}", "{", "position: 1",
                          "{position: 1, direction: up}"}) {
    const ParsedCommand parsed = ParseCommand(machine, "y1", "move_absolute", bad);
    EXPECT_EQ(parsed.error, ErrorId::kParameter) << bad;
    EXPECT_FALSE(parsed.sentence.empty()) << bad;
  }
}

// EN-22: the machine has its own verbs only; the sentence lists those of the target.
TEST(ParseCommand, KnowsWhoseVerbItIs) {
  const Machine machine = FullMachine();
  const ParsedCommand axis = ParseCommand(machine, "y1", "stop_all", "");
  EXPECT_EQ(axis.error, ErrorId::kUnknownVerb);
  EXPECT_THAT(axis.sentence, AllOf(HasSubstr("a command of an axis"), testing::Not(HasSubstr("renew"))));
  const ParsedCommand whole = ParseCommand(machine, "machine", "halt", "");
  EXPECT_EQ(whole.error, ErrorId::kUnknownVerb);
  EXPECT_THAT(whole.sentence, AllOf(HasSubstr("a command of the machine"), testing::Not(HasSubstr("jog"))));
  EXPECT_THAT(ParseCommand(machine, "y11", "halt", "").sentence, HasSubstr("did you mean y1"));
}

// EN-23: verbs that need a heartbeat over LCM.
TEST(ParseCommand, SaysWhatIsLevelSensitive) {
  const Machine machine = FullMachine();
  EXPECT_TRUE(ParseCommand(machine, "y1", "jog", "{forward: true}").level_sensitive);
  EXPECT_TRUE(ParseCommand(machine, "y1", "stop", "{hold: true}").level_sensitive);
  EXPECT_FALSE(ParseCommand(machine, "y1", "halt", "").level_sensitive);
}

// EN-07: text and command are equivalent.
TEST(ParseCommand, IsTheInverseOfToText) {
  const Machine machine = FullMachine();
  for (const auto& [when, command] : Scenario(machine)) {
    const CommandText text = ToText(machine, command);
    const ParsedCommand again = ParseCommand(machine, text.target, text.verb, text.arguments);
    EXPECT_EQ(again.sentence, "");
    const CommandText twice = ToText(machine, again.command);
    EXPECT_EQ(text.target + text.verb + text.arguments, twice.target + twice.verb + twice.arguments);
  }
}

auto From(const std::vector<std::vector<std::uint32_t>>& masters) {
  return [&](std::uint32_t i, std::uint32_t k) -> std::optional<std::uint32_t> {
    if (k >= masters[i].size()) return std::nullopt;
    return masters[i][k];
  };
}

// EN-03: the order itself, as a property over random acyclic graphs.
TEST(Order, PutsMastersFirst) {
  std::uint32_t seed = 1;
  const auto random = [&](std::uint32_t n) { return (seed = seed * 1664525u + 1013904223u) / 65536u % n; };
  for (int run = 0; run < 200; ++run) {
    const std::uint32_t n = 1 + random(30);
    std::vector<std::uint32_t> shuffled(n);
    for (std::uint32_t i = 0; i < n; ++i) shuffled[i] = i;
    for (std::uint32_t i = n; i > 1; --i) std::swap(shuffled[i - 1], shuffled[random(i)]);
    std::vector<std::vector<std::uint32_t>> masters(n);
    for (std::uint32_t i = 1; i < n; ++i) {
      for (std::uint32_t k = random(3); k > 0; --k) masters[shuffled[i]].push_back(shuffled[random(i)]);
    }
    Order order(n);
    ASSERT_TRUE(order.Make(From(masters)));
    std::vector<std::uint32_t> place(n);
    for (std::uint32_t k = 0; k < n; ++k) place[order.sequence()[k]] = k;
    for (std::uint32_t i = 0; i < n; ++i) {
      for (const std::uint32_t master : masters[i]) ASSERT_LT(place[master], place[i]);
    }
  }
}

// EN-03: only the members of the loop are named, not components on the path to it or completed before.
TEST(Order, GivesTheMembersOfALoopOnly) {
  const std::vector<std::vector<std::uint32_t>> masters = {{2}, {}, {3}, {1, 4}, {2}};
  Order order(masters.size());
  EXPECT_FALSE(order.Make(From(masters)));
  EXPECT_THAT(order.sequence(), ElementsAre(0, 1, 2, 3, 4));  // unchanged
  EXPECT_THAT(order.loop(), ElementsAre(4, 3, 2));            // each a master of the next, the last one of the first
}

// The machine's own name: anything readable, of limited length; a missing one is one problem.
TEST(LoadMachine, ChecksTheNameOfTheMachine) {
  const auto problems = [](const std::string& name) {
    return LoadMachine(name + "axes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\n", "m.yaml")
        .problems;
  };
  EXPECT_THAT(problems("name: Große Säge 1\n"), testing::IsEmpty());
  EXPECT_THAT(problems("name: " + std::string(64, 'a') + "\n"), testing::IsEmpty());
  EXPECT_THAT(problems("name: " + std::string(65, 'a') + "\n"), ElementsAre(HasSubstr("m.yaml:1:7: name: ")));
  EXPECT_THAT(problems("name: \"a\\x7f\"\n"), ElementsAre(HasSubstr("control characters")));
  EXPECT_THAT(problems("name: \"a\\n\"\n"), ElementsAre(HasSubstr("control characters")));
  EXPECT_THAT(problems("name: \"\"\n"), ElementsAre(HasSubstr("1 to 64 bytes")));
  EXPECT_THAT(problems(""), ElementsAre(HasSubstr("name")));
}

// CAM-72: the list is valid for another axis.
TEST(ParseCommand, SaysWhichListsOfCamSwitchesAnAxisCannotHave) {
  const LoadResult loaded = LoadMachine(
      "name: m\naxes:\n  - {name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}\n"
      "  - {name: c, kind: rotary, limits: {velocity: 1, acceleration: 1, jerk: 1}}\n"
      "cam_switches:\n  - {name: a, switches: [{track: 1, first_on_position: 350, last_on_position: 10}]}\n",
      "m.yaml");
  ASSERT_TRUE(loaded.machine);
  const auto refused = [&](const char* axis, const char* list) {
    return ParseCommand(*loaded.machine, axis, "digital_cam_switch", list).sentence;
  };
  EXPECT_EQ(refused("c", "{switches: a}"), "");
  EXPECT_EQ(refused("x", "{switches: a}"),
            "switches: 'a': expected last_on_position not below first_on_position, as axis x is linear and the list "
            "has no modulus, found 10 below 350");
  EXPECT_EQ(refused("x", "{switches: b}"), "");  // the cycle reports that it does not exist
}

// AX-50: lists of cam switches.
TEST(LoadMachine, ChecksListsOfCamSwitches) {
  const auto problems = [](const std::string& lists) {
    return LoadMachine(
               "name: m\naxes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\ncam_switches:\n" + lists,
               "m.yaml")
        .problems;
  };
  const std::string good = "switches: [{track: 32, first_on_position: 10, last_on_position: 350}]}\n";
  EXPECT_THAT(problems("  - {name: a, " + good + "  - {name: b, " + good), testing::IsEmpty());
  EXPECT_THAT(problems("  - {name: a, " + good + "  - {name: a, " + good),
              ElementsAre(HasSubstr("m.yaml:5:12: cam_switches[1].name: expected each name once")));
  EXPECT_THAT(problems("  - {name: a b, " + good), ElementsAre(HasSubstr("1 to 40 letters")));
  EXPECT_THAT(problems("  - {name: a, switches: [{track: 33, first_on_position: 1, last_on_position: 2}]}\n"),
              ElementsAre(HasSubstr("track")));
  EXPECT_THAT(problems("  - {name: a, switches: [{track: 1, first_on_position: 1}]}\n"),
              ElementsAre(HasSubstr("must be given, but in time mode")));
  const std::string across = "switches: [{track: 1, first_on_position: 350, last_on_position: 10}]}\n";
  EXPECT_THAT(problems("  - {name: a, modulus: 360, " + across), testing::IsEmpty());
  EXPECT_THAT(problems("  - {name: a, " + across),  // CAM-72
              ElementsAre(HasSubstr("m.yaml:4:25: cam_switches[0].switches: no axis can have this list: expected "
                                    "last_on_position not below first_on_position")));
  EXPECT_THAT(problems("  - {name: a, switches: [{track: 1, first_on_position: 1, mode: time}]}\n"),
              ElementsAre(HasSubstr("must be above 0 in time mode")));
  EXPECT_THAT(LoadMachine("name: m\naxes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}, "
                          "drive: {mode: cyclic_torque}}]\n",
                          "m.yaml")
                  .problems,
              ElementsAre(HasSubstr("must not be cyclic_torque")));
}

}  // namespace
}  // namespace takt::engine
