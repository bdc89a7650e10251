#include "takt/lcm/gateway.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <random>

#include "takt/engine/engine.h"
#include "takt/lcm/channels.h"
#include "takt/lcm/clock.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

bool Eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 5000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

template <typename Message>
Bytes Encoded(const Message& message) {
  Bytes bytes;
  Encode(message, bytes);
  return bytes;
}

// Random bytes, and valid messages that are truncated, extended, or have some bytes changed.
class Fuzz {
 public:
  Bytes Next() {
    const int kind = Uniform(0, 4);
    if (kind == 0) {
      Bytes bytes(static_cast<std::size_t>(Uniform(0, 200)));
      for (std::uint8_t& b : bytes) b = Byte();
      return bytes;
    }
    static const std::vector<std::pair<std::string, std::string>> kCommands = {
        {"power", ""},
        {"move_absolute", "{position: 10, velocity: 50, buffer_mode: buffered}"},
        {"halt", "{}"},
        {"move_velocity", "{velocity: 5, direction: positive}"},
        {"stop", "{hold: true}"},
        {"jog", "{forward: true}"},
    };
    const auto& [verb, arguments] =
        kCommands[static_cast<std::size_t>(Uniform(0, static_cast<int>(kCommands.size()) - 1))];
    msgs::heartbeat heartbeat{};
    heartbeat.run_id = kRunId;
    heartbeat.client = "test";
    heartbeat.session = Uniform(0, 3);
    msgs::command command = Command(Uniform(-2, 1'000'000), "x", verb, arguments);
    if (kind == 1 && !command.arguments.empty()) {  // well-formed message, odd text
      for (int i = Uniform(1, 4); i > 0; --i)
        command.arguments[Index(command.arguments.size())] = static_cast<char>(Uniform(1, 255));
    }
    Bytes bytes = Uniform(0, 9) == 0 ? Encoded(heartbeat) : Encoded(command);
    if (kind == 2) bytes.resize(Index(bytes.size()));
    if (kind == 3) bytes.insert(bytes.end(), Index(50), Byte());
    if (kind >= 3) {
      for (int i = Uniform(1, 8); i > 0; --i)
        bytes[8 + Index(bytes.size() - 8)] = Uniform(0, 1) ? Byte() : std::uint8_t{0xff};
    }
    return bytes;
  }

 private:
  int Uniform(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  std::uint8_t Byte() { return static_cast<std::uint8_t>(Uniform(0, 255)); }
  std::size_t Index(std::size_t size) { return static_cast<std::size_t>(Uniform(0, static_cast<int>(size) - 1)); }

  std::mt19937 random_{20240607};
};

struct GatewayTest : testing::Test {
  engine::Engine engine{TestMachine()};
  Clients clients{engine.machine(), kRunId, [this](const engine::Command& c) { return engine.Submit(c); }};

  std::vector<msgs::feedback> Replies() {
    std::vector<msgs::feedback> replies;
    for (msgs::feedback reply; clients.TakeReply(reply);) replies.push_back(reply);
    return replies;
  }
  // Forwards feedback as the publisher does.
  void Step() {
    engine.RunCycle();
    for (FeedbackEvent event; engine.feedback().TryPop(event);) clients.OnFeedback(event);
  }
};

// EN-22
TEST_F(GatewayTest, CommandsAndHeartbeatsArriveMalformedBytesAreCounted) {
  ::lcm::LCM network("memq://");
  const auto receiver = ReceiverOf(network);
  Gateway gateway(*receiver, clients);
  const Bytes command = Encoded(Command(1, "x", "no_such_verb"));
  ASSERT_EQ(network.publish(kCommandChannel, command.data(), static_cast<unsigned>(command.size())), 0);
  std::vector<msgs::feedback> replies;
  ASSERT_TRUE(Eventually([&] { return !(replies = Replies()).empty(); }));
  EXPECT_EQ(replies[0].error_id, static_cast<int>(ErrorId::kUnknownVerb));

  const char garbage[] = "garbage";
  network.publish(kCommandChannel, garbage, sizeof garbage);
  network.publish(kHeartbeatChannel, garbage, sizeof garbage);
  network.publish(kCommandChannel, garbage, 0);
  network.publish(kHeartbeatChannel, command.data(), static_cast<unsigned>(command.size()));  // the other kind
  EXPECT_TRUE(Eventually([&] { return clients.figures(SteadyNs()).malformed == 4; }));

  msgs::heartbeat heartbeat{};
  heartbeat.run_id = kRunId;
  heartbeat.client = "another";
  network.publish(kHeartbeatChannel, &heartbeat);
  EXPECT_TRUE(Eventually([&] { return clients.figures(SteadyNs()).alive == 2; }));
}

TEST_F(GatewayTest, AnotherEngineOnTheNetworkIsSaidOnceInOneLine) {
  ::lcm::LCM network("memq://");
  const auto receiver = ReceiverOf(network);
  testing::internal::CaptureStderr();
  {
    Gateway gateway(*receiver, clients);
    msgs::machine_description machine{};
    machine.name = "other\nmachine";
    machine.run_id = kRunId;
    const char garbage[] = "garbage";
    network.publish(kMachineChannel, garbage, sizeof garbage);
    network.publish(kMachineChannel, &machine);  // its own
    machine.run_id = kRunId + 1;
    network.publish(kMachineChannel, &machine);
    network.publish(kMachineChannel, &machine);
    const Bytes command = Encoded(Command(1, "x", "no_such_verb"));
    network.publish(kCommandChannel, command.data(), static_cast<unsigned>(command.size()));
    EXPECT_TRUE(Eventually([&] { return !Replies().empty(); }));  // all earlier ones have arrived
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_TRUE(said.starts_with("another engine runs on this LCM network, machine 'other")) << said;
}

// EN-22: nothing crashes, nothing grows without bound, and later messages are still served.
TEST_F(GatewayTest, Fuzz) {
  Fuzz fuzz;
  std::int64_t now_ns = 0;
  std::size_t malformed = 0, taken = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Bytes bytes = fuzz.Next();
    if (const auto command = DecodeCommand(bytes)) {
      clients.OnCommand(*command, now_ns);
      ++taken;
    } else if (const auto heartbeat = DecodeHeartbeat(bytes)) {
      clients.OnHeartbeat(*heartbeat, now_ns);
      ++taken;
    } else {
      ++malformed;
    }
    now_ns += 50'000;
    if (i % 20 == 0) {
      Step();
      for (const msgs::feedback& reply : Replies()) {
        if (reply.state == msgs::feedback::STATE_ERROR) {
          EXPECT_FALSE(reply.sentence.empty());
        }
        EXPECT_LT(reply.sentence.size(), 600u);
      }
    }
  }
  EXPECT_GT(malformed, 50'000u);
  EXPECT_GT(taken, 50'000u);
  msgs::command command = Command(1, "x", "power");
  command.client = "afterwards";
  clients.OnCommand(command, now_ns + 3'000'000'000);
  for (int i = 0; i < 200; ++i) Step();
  const auto replies = Replies();
  EXPECT_TRUE(
      std::any_of(replies.begin(), replies.end(), [](const auto& reply) { return reply.client == "afterwards"; }));
}

// EN-22: the same through LCM itself.
TEST_F(GatewayTest, FuzzThroughLcm) {
  ::lcm::LCM network("memq://");
  const auto receiver = ReceiverOf(network);
  Gateway gateway(*receiver, clients);
  Fuzz fuzz;
  for (int i = 0; i < 20'000; ++i) {
    const Bytes bytes = fuzz.Next();
    network.publish(i % 10 ? kCommandChannel : kHeartbeatChannel, bytes.data(), static_cast<unsigned>(bytes.size()));
    if (i % 100 == 0) {
      Step();
      Replies();
    }
  }
  ASSERT_TRUE(Eventually([&] {  // the last ones have arrived
    Step();
    Replies();
    msgs::command command = Command(1, "x", "no_such_verb");
    command.client = "afterwards";
    network.publish(kCommandChannel, &command);
    std::this_thread::sleep_for(1ms);
    for (const msgs::feedback& reply : Replies()) {
      if (reply.client == "afterwards") return true;
    }
    return false;
  }));
  EXPECT_GT(clients.figures(SteadyNs()).malformed, 1000u);
}

// EN-22: at 100 times the cycle's rate, every command has exactly one final state, and commands beyond the queue are
// refused.
TEST_F(GatewayTest, CommandsAtAHundredTimesTheCyclesRate) {
  std::map<std::int64_t, int> ends;
  std::size_t refused = 0;
  const auto count = [&] {
    for (const msgs::feedback& reply : Replies()) {
      if (!IsFinal(static_cast<FeedbackState>(reply.state))) continue;
      ++ends[reply.id];
      if (reply.error_id == static_cast<int>(ErrorId::kQueueFull)) ++refused;
    }
  };
  std::int64_t id = 0;
  clients.OnCommand(Command(++id, "x", "power"), 0);
  for (int i = 0; i < 300; ++i) Step();
  for (int cycle = 0; cycle < 500; ++cycle) {
    for (int i = 0; i < 100; ++i) {
      ++id;
      clients.OnCommand(Command(id, "x", "move_absolute", "{position: " + std::to_string(id % 50) + "}"),
                        cycle * 1'000'000);
    }
    Step();
    count();
  }
  for (int i = 0; i < 2000; ++i) Step();
  count();
  EXPECT_EQ(ends.size(), static_cast<std::size_t>(id));
  for (const auto& [command, times] : ends) EXPECT_EQ(times, 1) << command;
  EXPECT_GT(refused, 0u);
  EXPECT_GT(engine.figures().commands_applied, 5'000u);
}

// EN-23: a jog continues while heartbeats arrive, and releases itself when the client is killed during it.
TEST_F(GatewayTest, DeadMan) {
  std::int64_t now_ns = 0;
  std::vector<msgs::feedback> replies;
  const auto run = [&](double seconds, bool heartbeats) {
    for (int i = 0; i < static_cast<int>(seconds * 1000); ++i) {
      if (heartbeats && i % 50 == 0) {
        msgs::heartbeat heartbeat{};
        heartbeat.run_id = kRunId;
        heartbeat.client = "test";
        heartbeat.session = 1;
        clients.OnHeartbeat(heartbeat, now_ns);
      }
      Step();
      now_ns += 1'000'000;
      for (const msgs::feedback& reply : Replies()) replies.push_back(reply);
    }
  };
  clients.OnCommand(Command(1, "x", "power"), now_ns);
  run(0.5, true);
  ASSERT_EQ(engine.outputs(0).state, axis::PlcState::kStandstill) << replies.back().sentence;
  clients.OnCommand(Command(2, "x", "jog", "{forward: true, velocity: 20}"), now_ns);
  run(2, true);
  EXPECT_EQ(engine.outputs(0).state, axis::PlcState::kContinuousMotion);
  EXPECT_NEAR(engine.outputs(0).set_velocity, 20, 1e-9);
  EXPECT_NE(replies.back().state, msgs::feedback::STATE_ABORTED);

  run(engine.machine().lcm.dead_man_s - 0.1, false);
  EXPECT_NEAR(engine.outputs(0).set_velocity, 20, 1e-9);
  run(0.1 + 0.1, false);
  EXPECT_EQ(engine.outputs(0).set_velocity, 0);
  EXPECT_EQ(engine.outputs(0).state, axis::PlcState::kStandstill);
  EXPECT_EQ(replies.back().id, 2);
  EXPECT_TRUE(IsFinal(static_cast<FeedbackState>(replies.back().state)));
  EXPECT_EQ(replies.back().error_id, static_cast<int>(ErrorId::kLeaseExpired)) << replies.back().sentence;
}

}  // namespace
}  // namespace takt::lcm
