#include "takt/lcm/messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "test_machine.h"

namespace takt::lcm {
namespace {

// As a receiver of any language sees it.
template <typename Message>
Message ThroughBytes(const Message& message) {
  std::vector<std::uint8_t> bytes;
  Encode(message, bytes);
  Message decoded{};
  EXPECT_EQ(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return decoded;
}

msgs::command Command() {
  msgs::command m{};
  m.run_id = 4711;
  m.client = "test";
  m.session = 1;
  m.id = 2;
  m.target = "x";
  m.verb = "move_absolute";
  m.arguments = "{position: 10}";
  return m;
}

// EN-20
TEST(Messages, AxisStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.cycle.period_s = 0.00025;
  engine::AxisSnapshot s;
  s.cycle = 4'000'001;
  s.index = 1;
  axis::Outputs& o = s.outputs;
  o.set_position = 1.25;
  o.set_velocity = -2.5;
  o.set_acceleration = std::numeric_limits<double>::quiet_NaN();
  o.actual_position = 1.0 / 3;
  o.actual_velocity = -1e-300;
  o.following_error = 0.125;
  o.voltage_v = -9.75;
  o.torque_nm = 3.5;
  o.active_command = (Ticket{1} << 53) + 1;  // more than a double could hold
  o.error = ErrorId::kGroupDeviation;
  o.state = axis::PlcState::kErrorStop;
  o.limited_by = LimitedBy::kDistance;
  o.buffered_commands = 255;
  o.loop_closed = o.limit_positive = o.reference = true;
  const msgs::axis_state m = ThroughBytes(ToMessage(s, machine));
  EXPECT_EQ(m.cycle, 4'000'001);
  EXPECT_EQ(m.time_ns, 1'000'000'250'000);
  EXPECT_EQ(m.name, "y");
  EXPECT_EQ(m.set_position, 1.25);
  EXPECT_EQ(m.set_velocity, -2.5);
  EXPECT_TRUE(std::isnan(m.set_acceleration));
  EXPECT_EQ(m.actual_position, 1.0 / 3);
  EXPECT_EQ(m.actual_velocity, -1e-300);
  EXPECT_EQ(m.following_error, 0.125);
  EXPECT_EQ(m.voltage_v, -9.75);
  EXPECT_EQ(m.torque_nm, 3.5);
  EXPECT_EQ(m.active_command, 9007199254740993);
  EXPECT_EQ(m.error, 8001);
  EXPECT_EQ(m.state, msgs::axis_state::STATE_ERROR_STOP);
  EXPECT_EQ(m.limited_by, msgs::axis_state::LIMITED_BY_DISTANCE);
  EXPECT_EQ(m.buffered_commands, 255);
  EXPECT_EQ(m.loop_closed, 1);
  EXPECT_EQ(m.in_position, 0);
  EXPECT_EQ(m.limit_positive, 1);
  EXPECT_EQ(m.limit_negative, 0);
  EXPECT_EQ(m.reference, 1);
  EXPECT_EQ(m.touch_probe, 0);
}

// EN-05, EN-20
TEST(Messages, EngineStateKeepsEveryNumber) {
  engine::EngineFigures f;
  f.cycle = 10;
  f.overruns = 1;
  f.commands_applied = 2;
  f.commands_refused = 3;
  f.snapshots_dropped = 4;
  f.feedback_dropped = 5;
  f.journal_dropped = 15;
  f.planner_second_scale = 6;
  f.planner_failures = 7;
  f.state_hash = 0xffff'ffff'ffff'fffe;
  f.execution.Add(1000);
  f.latency.Add(1u << 20);
  const msgs::engine_state m = ThroughBytes(ToMessage(f, TestMachine()));
  EXPECT_EQ(m.cycle, 10);
  EXPECT_EQ(m.time_ns, 10'000'000);
  EXPECT_EQ(m.period_s, 0.001);
  EXPECT_EQ(m.overruns, 1);
  EXPECT_EQ(m.commands_applied, 2);
  EXPECT_EQ(m.commands_refused, 3);
  EXPECT_EQ(m.snapshots_dropped, 4);
  EXPECT_EQ(m.feedback_dropped, 5);
  EXPECT_EQ(m.journal_dropped, 15);
  EXPECT_EQ(m.planner_second_scale, 6);
  EXPECT_EQ(m.planner_failures, 7);
  EXPECT_EQ(m.state_hash, -2);
  EXPECT_EQ(m.execution.buckets[9], 1);
  EXPECT_EQ(m.execution.max, 1000);
  EXPECT_EQ(m.latency.buckets[20], 1);
  EXPECT_EQ(m.latency.count, 1);
}

TEST(Messages, FeedbackSaysItsErrorInASentence) {
  const msgs::feedback error =
      ThroughBytes(ToMessage(FeedbackEvent{7, 8, FeedbackState::kError, false, ErrorId::kTargetBehindLimit, 0}));
  EXPECT_EQ(error.ticket, 7);
  EXPECT_EQ(error.cycle, 8);
  EXPECT_EQ(error.state, msgs::feedback::STATE_ERROR);
  EXPECT_EQ(error.error_id, 8);
  EXPECT_EQ(error.sentence, ErrorText(ErrorId::kTargetBehindLimit));
  const msgs::feedback reached =
      ThroughBytes(ToMessage(FeedbackEvent{7, 8, FeedbackState::kActive, true, ErrorId::kNone, 2.5}));
  EXPECT_EQ(reached.reached, 1);
  EXPECT_EQ(reached.sentence, "");
}

// EN-07
TEST(Messages, JournalCommandReadsBackAsTheSameCommand) {
  const engine::Machine machine = TestMachine();
  engine::ParsedCommand parsed =
      engine::ParseCommand(machine, "y", "move_absolute", "{position: 0.1, velocity: 33.3, buffer_mode: blending_low}");
  ASSERT_EQ(parsed.error, ErrorId::kNone) << parsed.sentence;
  parsed.command.ticket = 12;
  parsed.command.lease_s = 0.25;
  const msgs::journal_command m = ThroughBytes(ToMessage(engine::JournalEntry{99, parsed.command}, machine));
  EXPECT_EQ(m.cycle, 99);
  EXPECT_EQ(m.ticket, 12);
  EXPECT_EQ(m.lease_s, 0.25);
  const engine::ParsedCommand again = engine::ParseCommand(machine, m.target, m.verb, m.arguments);
  ASSERT_EQ(again.error, ErrorId::kNone) << again.sentence;
  EXPECT_EQ(again.command.target, parsed.command.target);
  const auto& before = std::get<axis::MoveAbsolute>(std::get<axis::Command>(parsed.command.body));
  const auto& after = std::get<axis::MoveAbsolute>(std::get<axis::Command>(again.command.body));
  EXPECT_EQ(after.position, before.position);
  EXPECT_EQ(after.velocity, before.velocity);
  EXPECT_EQ(after.acceleration, before.acceleration);
  EXPECT_EQ(after.buffer_mode, before.buffer_mode);
}

TEST(Messages, JournalHashesKeepTheirBits) {
  msgs::journal_hashes m{};
  m.first_cycle = 5;
  m.hashes = {-1, 0, std::numeric_limits<std::int64_t>::min()};
  m.count = 3;
  EXPECT_EQ(ThroughBytes(m).hashes, m.hashes);
}

TEST(Messages, CommandAndHeartbeatDecode) {
  std::vector<std::uint8_t> bytes;
  Encode(Command(), bytes);
  const auto command = DecodeCommand(bytes);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->run_id, 4711);
  EXPECT_EQ(command->client, "test");
  EXPECT_EQ(command->session, 1);
  EXPECT_EQ(command->id, 2);
  EXPECT_EQ(command->target, "x");
  EXPECT_EQ(command->verb, "move_absolute");
  EXPECT_EQ(command->arguments, "{position: 10}");
  EXPECT_FALSE(DecodeHeartbeat(bytes));

  msgs::heartbeat heartbeat{};
  heartbeat.run_id = 4711;
  heartbeat.client = "test";
  heartbeat.session = -3;
  Encode(heartbeat, bytes);
  ASSERT_TRUE(DecodeHeartbeat(bytes));
  EXPECT_EQ(DecodeHeartbeat(bytes)->session, -3);
  EXPECT_EQ(DecodeHeartbeat(bytes)->run_id, 4711);
  EXPECT_FALSE(DecodeCommand(bytes));
}

// EN-22: what the generated decoder alone would read beyond its bytes for, or throw at.
TEST(Messages, WrongLengthsAreRefused) {
  std::vector<std::uint8_t> good;
  Encode(Command(), good);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(DecodeCommand(std::span(good).first(size))) << size;
  }
  std::vector<std::uint8_t> longer = good;
  longer.push_back(0);
  EXPECT_FALSE(DecodeCommand(longer));
  constexpr std::size_t kClientLength = 16;  // behind the fingerprint and run_id
  for (const std::uint32_t length : {0u, 1u, 4u, 6u, 0x7fff'ffffu, 0x8000'0000u, 0x8000'0001u, 0xffff'ffffu}) {
    std::vector<std::uint8_t> bad = good;
    for (std::size_t i = 0; i < 4; ++i) bad[kClientLength + i] = static_cast<std::uint8_t>(length >> (24 - 8 * i));
    EXPECT_FALSE(DecodeCommand(bad)) << length;
  }
  std::vector<std::uint8_t> with_zero = good;
  with_zero[kClientLength + 4 + 1] = 0;
  EXPECT_FALSE(DecodeCommand(with_zero));
}

}  // namespace
}  // namespace takt::lcm
