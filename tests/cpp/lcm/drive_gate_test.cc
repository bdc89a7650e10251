// AX-87, EN-26: the messages of external drives are checked before the engine receives them.
#include "takt/lcm/drive_gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "takt/core/describe.h"
#include "takt/core/drive_errors.h"
#include "takt/core/hash.h"
#include "takt/lcm/channels.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

constexpr std::uint32_t kMissing = 3;

// Three axes, x and z with external drives; the set points of cycles -1 to 10 were sent.
class DriveGateTest : public testing::Test {
 protected:
  DriveGateTest() : machine(TestMachine(3)) {
    for (const char* axis : {"z", "x"}) machine.external.drives.push_back({axis, kMissing});
    gate = std::make_unique<DriveGate>(machine, kRunId, [this](const std::string& sentence) {
      ++refused;
      if (!sentence.empty()) sentences.push_back(sentence);
    });
    for (std::int64_t cycle = -1; cycle <= 10; ++cycle) Send(cycle);
  }

  void Send(std::int64_t cycle) {
    for (const std::uint32_t axis : {0u, 2u}) gate->OnSent({cycle, axis, {}});
  }
  static msgs::drive_feedback Answer(std::int64_t cycle, std::int64_t sequence, std::int64_t plant = 1) {
    msgs::drive_feedback m{};
    m.run_id = kRunId;
    m.cycle = cycle;
    m.plant = plant;
    m.sequence = sequence;
    m.axis = "x";
    m.counts = 42;
    return m;
  }
  std::optional<engine::DriveSample> Take(const msgs::drive_feedback& message,
                                          const std::string& channel = "takt/drive/x/feedback") {
    std::vector<std::uint8_t> bytes;
    Encode(message, bytes);
    return gate->Take(channel, bytes);
  }
  // Expects a refusal, with this sentence if it is the first of its kind.
  void ExpectRefused(const msgs::drive_feedback& message, const std::string& sentence) {
    const std::size_t before = sentences.size();
    const int refused_before = refused;
    EXPECT_FALSE(Take(message)) << sentence;
    EXPECT_EQ(refused, refused_before + 1);
    if (sentence.empty()) {
      EXPECT_EQ(sentences.size(), before) << sentences.back();
    } else {
      ASSERT_EQ(sentences.size(), before + 1) << sentence;
      EXPECT_EQ(sentences.back(), "takt/drive/x/feedback: " + sentence);
    }
  }

  engine::Machine machine;
  std::unique_ptr<DriveGate> gate;
  int refused = 0;
  std::vector<std::string> sentences;
};

TEST_F(DriveGateTest, AnAnswerIsHandedOn) {
  msgs::drive_feedback m = Answer(10, 0);
  m.counts = -7;
  m.index_pulses = (std::int64_t{1} << 32) + 5;
  m.limit_negative = 1;
  m.drive_ready = 1;
  m.torque_nm = 0.25;
  m.probe_rise_age_s = 0.0005;
  const auto sample = Take(m);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->axis, 0u);
  EXPECT_EQ(sample->cycle, 10);
  EXPECT_EQ(sample->inputs.counts, 0xFFFF'FFF9u);
  EXPECT_EQ(sample->inputs.index_pulses, 5u);
  EXPECT_TRUE(sample->inputs.limit_negative);
  EXPECT_FALSE(sample->inputs.limit_positive);
  EXPECT_TRUE(sample->inputs.drive_ready);
  EXPECT_EQ(sample->inputs.torque_nm, 0.25);
  EXPECT_EQ(sample->inputs.probe_rise_age_s, 0.0005);
  m.axis = "z";
  const auto other = Take(m, "takt/drive/z/feedback");
  ASSERT_TRUE(other);
  EXPECT_EQ(other->axis, 2u);
  EXPECT_EQ(refused, 0);
}

TEST_F(DriveGateTest, WhatADriveSaysOfItsFaultAndOfItsClock) {  // AX-87
  msgs::drive_feedback m = Answer(9, 0);
  m.drive_error = 0x8611;
  m.later_s = -0.0004;
  const auto sample = Take(m);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->inputs.drive_error, 0x8611);
  EXPECT_EQ(sample->later_s, -0.0004);
  m = Answer(10, 1);
  m.later_s = HUGE_VAL;
  ExpectRefused(m, "later_s: expected a finite number, found inf");
  EXPECT_EQ(DriveErrorText(0x8611), "0x8611 (following error)");
  EXPECT_EQ(DriveErrorText(0x8619), "0x8619 (positioning)");
  EXPECT_EQ(DriveErrorText(0xFF07), "0xFF07 (of the maker of the drive)");
  EXPECT_EQ(DriveErrorText(-1), "0xFFFFFFFF (of the maker of the drive)");
}

TEST_F(DriveGateTest, TheJournalHasTheSameNumbers) {  // EN-07
  engine::DriveEntry entry{17, {16, 0, {}}};
  entry.sample.inputs = {.counts = 4'000'000'000u,
                         .index_counts = 3,
                         .index_pulses = 2,
                         .encoder_error = true,
                         .limit_positive = true,
                         .reference = true,
                         .touch_probe = true,
                         .probe_rises = 5,
                         .probe_falls = 4,
                         .probe_rise_age_s = 0.1 + 0.2,
                         .probe_fall_age_s = 1e-9,
                         .drive_ready = true,
                         .drive_fault = true,
                         .drive_error = 0x3210,
                         .torque_nm = -1.5};
  const msgs::journal_drive message = ToMessage(entry, machine);
  EXPECT_EQ(message.cycle, 17);
  EXPECT_EQ(message.feedback.axis, "x");
  const engine::DriveSample back = ToSample(message.feedback, 0);
  EXPECT_EQ(back.cycle, 16);
  EXPECT_EQ(HashOf(back.inputs), HashOf(entry.sample.inputs));
}

TEST_F(DriveGateTest, WhatIsWrongIsSaidOnce) {
  msgs::drive_feedback m = Answer(5, 0);
  m.axis = "z";
  ExpectRefused(m, "axis: expected x, found 'z'");
  ExpectRefused(m, "");
  m = Answer(5, 0);
  m.run_id = 99;
  ExpectRefused(m, "answers another start of an engine: run_id 99, this one is 4711");
  m = Answer(5, 0);
  m.torque_nm = std::numeric_limits<double>::quiet_NaN();
  ExpectRefused(m, "torque_nm: expected a finite number, found nan");
  m.torque_nm = HUGE_VAL;
  ExpectRefused(m, "");
  ExpectRefused(Answer(11, 0), "answers cycle 11, but the newest set point is that of cycle 10");
  ExpectRefused(Answer(-2, 0), "");
  ExpectRefused(Answer(std::numeric_limits<std::int64_t>::max(), 0), "");
  EXPECT_EQ(gate->answered(0), -2);
}

TEST_F(DriveGateTest, EdgesComeBeforeTheSample) {
  msgs::drive_feedback m = Answer(5, 0);
  m.probe_rise_age_s = -0.001;
  ExpectRefused(m, "probe_rise_age_s: expected a finite number >= 0, found -0.001000");
  m.probe_rise_age_s = 0;
  m.probe_fall_age_s = std::numeric_limits<double>::quiet_NaN();
  ExpectRefused(m, "");
}

TEST_F(DriveGateTest, OldOnesAndDoublesAreIgnored) {
  EXPECT_TRUE(Take(Answer(5, 7)));
  ExpectRefused(Answer(5, 7), "cycle 5 after cycle 5: old, out of order or twice");
  ExpectRefused(Answer(5, 8), "");
  ExpectRefused(Answer(4, 6), "");
  EXPECT_TRUE(Take(Answer(6, 9)));
  EXPECT_EQ(gate->answered(0), 6);
}

// EN-31: the sender's own sequence is ignored: a message with the largest number does not lock the drive out.
TEST_F(DriveGateTest, NoSequenceLocksTheDriveOut) {
  EXPECT_TRUE(Take(Answer(5, std::numeric_limits<std::int64_t>::max())));
  EXPECT_TRUE(Take(Answer(6, 3)));
  EXPECT_TRUE(Take(Answer(10, std::numeric_limits<std::int64_t>::max())));
  Send(11);
  EXPECT_TRUE(Take(Answer(11, std::numeric_limits<std::int64_t>::min())));
}

TEST_F(DriveGateTest, DoublesThatWereAskedForAreNoFault) {
  EXPECT_TRUE(Take(Answer(10, 0)));
  Send(10);  // again: the answer was late
  EXPECT_FALSE(Take(Answer(10, 0)));
  EXPECT_EQ(refused, 0);
}

// On a busy host the second answer may come when set points of later cycles were repeated, too.
TEST_F(DriveGateTest, DoublesThatWereAskedForMayComeLate) {
  Send(10);
  EXPECT_TRUE(Take(Answer(10, 0)));
  for (int i = 0; i < 2; ++i) Send(11);
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(Take(Answer(10, 0)));
  EXPECT_TRUE(Take(Answer(11, 0)));
  Send(12);
  EXPECT_TRUE(Take(Answer(12, 0)));
  EXPECT_FALSE(Take(Answer(11, 0)));
  EXPECT_EQ(refused, 0);
  EXPECT_FALSE(Take(Answer(12, 0)));
  EXPECT_FALSE(Take(Answer(9, 0)));
  EXPECT_EQ(refused, 2);
}

TEST_F(DriveGateTest, WrongChannelsAndTypes) {
  const auto sentence_of = [&](const std::string& channel) {
    sentences.clear();
    EXPECT_FALSE(Take(Answer(5, 0), channel));
    return sentences.empty() ? "" : sentences.back();
  };
  EXPECT_EQ(sentence_of("takt/drive/y/feedback"),
            "takt/drive/y/feedback: the machine's external.drives do not name axis y");
  EXPECT_EQ(sentence_of("takt/drive/q/feedback"), "takt/drive/q/feedback: expected the name of an axis, found 'q'");
  EXPECT_EQ(sentence_of("takt/drive//feedback"), "takt/drive//feedback: expected the name of an axis, found ''");

  std::vector<std::uint8_t> bytes;
  Encode(Answer(5, 0), bytes);
  bytes[3] = static_cast<std::uint8_t>(bytes[3] ^ 1);  // another version has another fingerprint
  EXPECT_FALSE(gate->Take("takt/drive/x/feedback", bytes));
  EXPECT_EQ(sentences.back(), "takt/drive/x/feedback: no drive_feedback of this version of Takt");
  Encode(msgs::heartbeat{}, bytes);
  EXPECT_FALSE(gate->Take("takt/drive/x/feedback", bytes));
  EXPECT_FALSE(gate->Take("takt/drive/x/feedback", {}));
}

// Two plants for one axis: the first one is used. Another one may take over once the engine had to run without answers,
// so that a restarted plant is never overlooked.
TEST_F(DriveGateTest, ASecondPlantWaits) {
  EXPECT_TRUE(Take(Answer(9, 0, 1)));
  ExpectRefused(Answer(10, 0, 2), "a second plant answers for this axis; the first one is listened to");
  EXPECT_TRUE(Take(Answer(10, 1, 1)));
  for (std::int64_t cycle = 11; cycle <= 10 + kMissing; ++cycle) {
    Send(cycle);
    ExpectRefused(Answer(cycle, cycle, 2), "");
  }
  Send(10 + kMissing + 1);
  EXPECT_TRUE(Take(Answer(10 + kMissing + 1, 0, 2)));
  ExpectRefused(Answer(10 + kMissing + 1, 9, 1), "");
}

// Random messages: no crash, only finite answers to sent set points are accepted, and the number of sentences is
// bounded.
TEST_F(DriveGateTest, Fuzz) {
  std::mt19937 random(3);
  std::int64_t last = -2;
  for (int i = 0; i < 200'000; ++i) {
    msgs::drive_feedback m = Answer(static_cast<std::int64_t>(random() % 14) - 2, i, random() % 3);
    std::vector<std::uint8_t> bytes;
    Encode(m, bytes);
    for (auto n = random() % 4; n > 0; --n) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (random() % 10 == 0) bytes.resize(random() % bytes.size());
    if (random() % 10 == 0) bytes.insert(bytes.end(), random() % 20, 0);
    const std::string name(1, static_cast<char>('a' + random() % 26));
    const auto sample = gate->Take(DriveFeedbackChannel(random() % 5 ? "x" : name), bytes);
    if (!sample) continue;
    EXPECT_TRUE(std::isfinite(sample->inputs.torque_nm));
    EXPECT_GE(sample->inputs.probe_rise_age_s, 0);
    EXPECT_LE(sample->cycle, 10);
    if (sample->axis == 0) {
      EXPECT_GT(sample->cycle, last);
      last = sample->cycle;
    }
  }
  EXPECT_LT(sentences.size(), 60u);
}

}  // namespace
}  // namespace takt::lcm
