// Every number of every command of belts and poses, made invalid: refused with a sentence before it reaches the cycle;
// if it reaches the cycle, it changes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "machines.h"
#include "wrong.h"

namespace takt::engine {
namespace {

using testing::HasSubstr;

std::vector<conveyor::Command> GoodBeltCommands() {
  return {conveyor::Detect{.x = 5},  conveyor::Locate{.number = 2, .x = 5},
          conveyor::TakeObject{1},   conveyor::GiveBackObject{1},
          conveyor::RemoveObject{1}, conveyor::ClearObjects{}};
}

// With one object that is visible and one that is not.
struct BeltTwin {
  BeltTwin() {
    Give(conveyor::Detect{.x = 1});
    Give(conveyor::Detect{});
  }
  FeedbackEvent Give(const conveyor::Command& body) { return Give(ToBelt(machine, 0, body)); }
  FeedbackEvent Give(const Command& command) {
    engine.Submit(command);
    engine.RunCycle();
    FeedbackEvent last;
    while (engine.feedback().TryPop(last)) {
    }
    return last;
  }

  Machine machine = FullMachine();
  Engine engine{machine};
};

// CV-02, EN-22
TEST(BeltBadInput, IsRefusedWithASentenceAndChangesNothing) {
  EXPECT_EQ(GoodBeltCommands().size(), std::variant_size_v<conveyor::Command>);
  BeltTwin asked, twin;
  int refused = 0;
  for (const conveyor::Command& good : GoodBeltCommands()) {
    const CommandText fine = ToText(asked.machine, ToBelt(asked.machine, 0, good));
    ASSERT_EQ(ParseCommand(asked.machine, fine.target, fine.verb, fine.arguments).error, ErrorId::kNone) << fine.verb;
    for (const Wrong<conveyor::Command>& wrong : WrongVersionsOf(good)) {
      const CommandText text = ToText(asked.machine, ToBelt(asked.machine, 0, wrong.command));
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

// CV-42, EN-22
TEST(BeltBadInput, OfPosesIsRefusedToo) {
  BeltTwin asked, twin;
  for (const Wrong<conveyor::PoseCommand>& wrong : WrongVersionsOf(conveyor::PoseCommand(conveyor::SetPose{}))) {
    EXPECT_EQ(asked.Give(ToPose(asked.machine, wrong.command)).error, ErrorId::kParameter) << wrong.what;
    twin.engine.RunCycle();
    ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash()) << wrong.what;
  }
}

// CV-02, EN-22
TEST(BeltBadInput, SaysWhatWasExpected) {
  const Machine machine = FullMachine();
  const struct {
    const char* verb;
    const char* arguments;
    const char* sentence;
  } cases[] = {
      {"detect", "{xx: 1}", "xx"},
      {"detect", "{latched_with: 0}", "latched_with: expected a whole number"},
      {"detect", "{latched_with: 1, recorded_position: 5}", "must not be given besides recorded_position"},
      {"detect", "{kind: -1}", "kind: expected "},
      {"detect", "{kind: round}", "kind: expected "},
      {"locate", "{number: 1.5}", "number: expected a whole number"},
      {"take", "{}", "number: "},
      {"remove", "{number: 4294967296}", "number: expected "},
  };
  for (const auto& c : cases) {
    const ParsedCommand parsed = ParseCommand(machine, "infeed", c.verb, c.arguments);
    EXPECT_EQ(parsed.error, ErrorId::kParameter) << c.verb << " " << c.arguments;
    EXPECT_THAT(parsed.sentence, HasSubstr(c.sentence)) << c.verb << " " << c.arguments;
  }
  EXPECT_THAT(ParseCommand(machine, "infeed", "detekt", "").sentence, HasSubstr("did you mean detect?"));
}

}  // namespace
}  // namespace takt::engine
