#include "takt/lcm/publisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>

#include "takt/engine/load.h"
#include "takt/lcm/clock.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

using namespace std::chrono_literals;

// Keeps the messages; can be made slow.
class TestOutlet : public Outlet {
 public:
  bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t) override {
    std::unique_lock lock(mutex_);
    open_.wait(lock, [this] { return !blocked_; });
    if (refuse_) return false;
    messages_[channel].emplace_back(bytes.begin(), bytes.end());
    order_.push_back(channel);
    return true;
  }
  void Block(bool blocked) {
    const std::lock_guard lock(mutex_);
    blocked_ = blocked;
    open_.notify_all();
  }
  void Refuse(bool refuse) {
    const std::lock_guard lock(mutex_);
    refuse_ = refuse;
  }
  template <typename Message>
  std::vector<Message> On(const std::string& channel) {
    const std::lock_guard lock(mutex_);
    std::vector<Message> decoded;
    for (const auto& bytes : messages_[channel]) {
      Message message{};
      EXPECT_GT(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0) << channel;
      decoded.push_back(message);
    }
    return decoded;
  }
  // Returns the channels in the order of arrival.
  std::vector<std::string> Order() {
    const std::lock_guard lock(mutex_);
    return order_;
  }
  std::set<std::string> Channels() {
    const std::lock_guard lock(mutex_);
    std::set<std::string> names;
    for (const auto& [name, messages] : messages_) names.insert(name);
    return names;
  }

 private:
  std::mutex mutex_;
  std::condition_variable open_;
  bool blocked_ = false, refuse_ = false;
  std::map<std::string, std::vector<std::vector<std::uint8_t>>> messages_;
  std::vector<std::string> order_;
};

struct TestRun {
  explicit TestRun(const engine::EngineOptions& options, engine::Machine machine = TestMachine())
      : engine(std::move(machine), options),
        clients(engine.machine(), kRunId, [this](const engine::Command& c) { return engine.Submit(c); }) {}

  // Runs cycles without outrunning the publisher.
  void Step(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      engine.RunCycle();
      while (engine.snapshots().size() * 2 > engine.snapshots().capacity() || engine.figure_queue().size() > 4 ||
             engine.hashes().size() * 2 > engine.hashes().capacity()) {
        std::this_thread::sleep_for(100us);
      }
    }
  }

  engine::Engine engine;
  Clients clients;
};

template <typename Message>
void ExpectNoGaps(const std::vector<Message>& messages) {
  for (std::size_t i = 0; i < messages.size(); ++i) EXPECT_EQ(messages[i].sequence, static_cast<std::int64_t>(i));
}

// EN-20
TEST(Publisher, EveryKindIsPublishedAtItsRateWithoutGaps) {
  engine::Machine machine = TestMachine();
  machine.lcm.axis_rate_hz = 100;
  machine.lcm.rates = {{"y", 500}};
  machine.lcm.engine_rate_hz = 10;
  TestRun run({.publish = true}, machine);
  TestOutlet network;
  {
    Publisher publisher(run.engine, run.clients, &network, nullptr,
                        {"name: test", "1.2.3", msgs::engine_state::PACE_FAST});
    run.clients.OnCommand(Command(1, "x", "power"), SteadyNs());
    run.Step(1000);
  }
  const auto x = network.On<msgs::axis_state>("takt/axis/x");
  const auto y = network.On<msgs::axis_state>("takt/axis/y");
  const auto engine = network.On<msgs::engine_state>("takt/engine");
  const auto description = network.On<msgs::machine_description>("takt/machine");
  const auto feedback = network.On<msgs::feedback>("takt/feedback");
  EXPECT_EQ(x.size(), 100u);
  EXPECT_EQ(y.size(), 500u);
  EXPECT_EQ(engine.size(), 10u);
  ASSERT_GE(description.size(), 1u);
  ASSERT_GE(feedback.size(), 2u);
  ExpectNoGaps(x);
  ExpectNoGaps(y);
  ExpectNoGaps(engine);
  ExpectNoGaps(feedback);
  for (std::size_t i = 1; i < x.size(); ++i) EXPECT_EQ(x[i].cycle - x[i - 1].cycle, 10);
  EXPECT_EQ(x.back().name, "x");
  EXPECT_EQ(x.back().state, msgs::axis_state::STATE_STANDSTILL);
  EXPECT_EQ(x.back().time_ns, x.back().cycle * 1'000'000);
  EXPECT_GT(x.back().utime, 1'700'000'000'000'000);
  EXPECT_EQ(engine.back().clients, 1);
  EXPECT_EQ(engine.back().commands_applied, 1);
  EXPECT_EQ(engine.back().run_id, description[0].run_id);
  EXPECT_EQ(engine.back().pace, msgs::engine_state::PACE_FAST);
  EXPECT_EQ(description[0].name, "test");
  EXPECT_EQ(description[0].text, "name: test");
  EXPECT_EQ(description[0].version, "1.2.3");
  EXPECT_EQ(description[0].period_s, 0.001);
  EXPECT_EQ(feedback.back().client, "test");
  EXPECT_EQ(feedback.back().id, 1);
  EXPECT_EQ(feedback.back().state, msgs::feedback::STATE_DONE);
  EXPECT_EQ(network.Channels().count("takt/journal/start"), 0u);
}

// EN-20, CAM-11: a module is published like the axes, at its own rate; the log contains every cycle of it.
TEST(Publisher, ModulesArePublishedAsAxesAre) {
  engine::Machine machine = WithModule(TestMachine());
  machine.lcm.axis_rate_hz = 100;
  machine.lcm.rates = {{"cutter", 250}};
  TestRun run({.publish = true, .every_cycle = true, .journal = true}, machine);
  TestOutlet network, log;
  {
    Publisher publisher(run.engine, run.clients, &network, &log, {});
    run.clients.OnCommand(Command(1, "x", "power"), SteadyNs());
    run.clients.OnCommand(Command(2, "cutter", "control", "{regulator_on: true}"), SteadyNs());
    run.Step(500);
    run.clients.OnCommand(Command(3, "cutter", "control", "{sync_cam: true}"), SteadyNs());
    run.Step(500);
  }
  const auto sent = network.On<msgs::flex_cam_state>("takt/flex_cam/cutter");
  const auto kept = log.On<msgs::flex_cam_state>("takt/flex_cam/cutter");
  ASSERT_EQ(sent.size(), 250u);
  ASSERT_EQ(kept.size(), 1000u);
  ExpectNoGaps(sent);
  ExpectNoGaps(kept);
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_EQ(sent[i].cycle, static_cast<std::int64_t>(4 * i));
  EXPECT_EQ(network.On<msgs::axis_state>("takt/axis/x").size(), 100u);
  EXPECT_EQ(kept.back().name, "cutter");
  EXPECT_EQ(kept[499].state, msgs::flex_cam_state::STATE_READY);
  EXPECT_EQ(kept.back().state, msgs::flex_cam_state::STATE_SYNC);
  EXPECT_TRUE(kept.back().cam_synchronised);
  const auto commands = log.On<msgs::journal_command>("takt/journal/command");
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[2].target, "cutter");
  EXPECT_EQ(commands[2].verb, "control");
  EXPECT_EQ(commands[2].arguments, "{sync_cam: true}");
}

// EN-20, GR-02
TEST(Publisher, GroupsArePublishedAsAxesAre) {
  engine::Machine machine = WithGroup(TestMachine());
  machine.lcm.axis_rate_hz = 100;
  machine.lcm.rates = {{"portal", 250}};
  TestRun run({.publish = true, .every_cycle = true, .journal = true}, machine);
  TestOutlet network, log;
  {
    Publisher publisher(run.engine, run.clients, &network, &log, {});
    run.clients.OnCommand(Command(1, "portal", "power"), SteadyNs());
    run.Step(500);
    run.clients.OnCommand(Command(2, "portal", "enable"), SteadyNs());
    run.clients.OnCommand(Command(3, "portal", "move_linear_absolute", "{x: 1, y: 2}"), SteadyNs());
    run.Step(500);
  }
  const auto sent = network.On<msgs::group_state>("takt/group/portal");
  const auto kept = log.On<msgs::group_state>("takt/group/portal");
  ASSERT_EQ(sent.size(), 250u);
  ASSERT_EQ(kept.size(), 1000u);
  ExpectNoGaps(sent);
  ExpectNoGaps(kept);
  EXPECT_EQ(kept[400].state, msgs::group_state::STATE_GROUP_DISABLED);
  EXPECT_EQ(kept.back().state, msgs::group_state::STATE_GROUP_STANDBY);
  EXPECT_EQ(kept.back().axes, 2);
  EXPECT_NEAR(kept.back().x, 1, 1e-9);
  EXPECT_NEAR(kept.back().y, 2, 1e-9);
  EXPECT_EQ(kept.back().z, 0);
}

// EN-20, PL-10: the shape of a track is published when it is made, when commands change it, and again for later
// subscribers.
TEST(Publisher, TheShapesOfTracksArePublishedWhenTheyChange) {
  const engine::LoadResult loaded = engine::LoadMachine(R"(
name: test
axes: []
tracks:
  - {name: half, elements: [{shape: circle, from: {x: 0, y: 0}, to: {x: 0, y: 200}, center: {x: 0, y: 100}}]}
  - {name: later}
)",
                                                        "test.yaml");
  ASSERT_TRUE(loaded.machine) << loaded.problems.front();
  TestRun run({.publish = true}, *loaded.machine);
  TestOutlet network, log;
  {
    Publisher publisher(run.engine, run.clients, &network, &log, {});
    run.Step(100);
    run.clients.OnCommand(Command(1, "later", "append_line", "{start_x: 0, start_y: 50, end_x: 1000, end_y: 50}"),
                          SteadyNs());
    for (int i = 0; i < 100; ++i) {
      run.Step(1);
      run.engine.MakeTracks();
    }
    std::this_thread::sleep_for(1100ms);
  }
  const auto half = log.On<msgs::track_shape>("takt/track_shapes/half");
  ASSERT_EQ(half.size(), 1u);
  EXPECT_EQ(half[0].name, "half");
  EXPECT_EQ(half[0].count, std::ceil(half[0].length / 10) + 1);
  EXPECT_EQ(half[0].position.back(), half[0].length);
  EXPECT_FALSE(half[0].closed);
  EXPECT_EQ(half[0].part, 0);
  for (int i = 0; i < half[0].count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(std::hypot(half[0].x[k], half[0].y[k] - 100), 100, 1e-6) << i;
  }
  EXPECT_NEAR(half[0].direction.front(), 0, 1e-9);
  EXPECT_NEAR(half[0].direction.back(), 180, 1e-9);
  const auto later = log.On<msgs::track_shape>("takt/track_shapes/later");
  ASSERT_EQ(later.size(), 2u);
  EXPECT_EQ(later[0].count, 0);
  EXPECT_EQ(later[0].length, 0);
  EXPECT_EQ(later[1].length, 1000);
  ASSERT_EQ(later[1].count, 101);
  EXPECT_NEAR(later[1].x[50], 500, 1e-9);
  EXPECT_NEAR(later[1].y[50], 50, 1e-9);
  const auto sent = network.On<msgs::track_shape>("takt/track_shapes/later");
  ExpectNoGaps(sent);
  ASSERT_GE(sent.size(), 3u);
  EXPECT_EQ(sent.back().count, 101);
}

// EN-07, EN-20: the log contains every cycle, every command and every hash; the network has its own rate.
TEST(Publisher, TheLogHoldsEverything) {
  constexpr int kCycles = 2500;
  TestRun run({.publish = true, .every_cycle = true, .journal = true});
  TestOutlet network, log;
  {
    Publisher publisher(run.engine, run.clients, &network, &log, {"name: test", "1.2.3", 0});
    run.clients.OnCommand(Command(1, "x", "power"), SteadyNs());
    run.Step(1000);
    run.clients.OnCommand(Command(2, "x", "move_relative", "{distance: 5}"), SteadyNs());
    run.Step(kCycles - 1000);
  }
  const auto x = log.On<msgs::axis_state>("takt/axis/x");
  ASSERT_EQ(x.size(), static_cast<std::size_t>(kCycles));
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ(x[i].cycle, static_cast<std::int64_t>(i));
  ExpectNoGaps(x);
  EXPECT_EQ(network.On<msgs::axis_state>("takt/axis/x").size(), kCycles / 10u);
  EXPECT_NEAR(x.back().set_position, x[0].set_position + 5, 1e-9);

  const auto start = log.On<msgs::journal_start>("takt/journal/start");
  ASSERT_EQ(start.size(), 1u);
  EXPECT_EQ(start[0].text, "name: test");
  EXPECT_EQ(start[0].period_s, 0.001);
  const auto commands = log.On<msgs::journal_command>("takt/journal/command");
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[1].cycle, 1000);
  EXPECT_EQ(commands[1].target, "x");
  EXPECT_EQ(commands[1].verb, "move_relative");

  // Given again in the same cycles, they produce the same states.
  engine::Engine replay(run.engine.machine(), {.journal = true});
  std::size_t next_command = 0;
  std::int64_t cycle = 0;
  for (const auto& hashes : log.On<msgs::journal_hashes>("takt/journal/hashes")) {
    ASSERT_EQ(hashes.first_cycle, cycle);
    for (const std::int64_t hash : hashes.hashes) {
      for (; next_command < commands.size() && commands[next_command].cycle == cycle; ++next_command) {
        const auto& c = commands[next_command];
        engine::ParsedCommand parsed = engine::ParseCommand(replay.machine(), c.target, c.verb, c.arguments);
        ASSERT_EQ(parsed.error, ErrorId::kNone);
        parsed.command.lease_s = c.lease_s;
        EXPECT_EQ(replay.Submit(parsed.command), static_cast<Ticket>(c.ticket));
      }
      replay.RunCycle();
      engine::HashEntry entry;
      ASSERT_TRUE(replay.hashes().TryPop(entry));
      ASSERT_EQ(static_cast<std::int64_t>(entry.hash), hash) << "cycle " << cycle;
      ++cycle;
    }
  }
  EXPECT_EQ(cycle, kCycles);
}

// EN-21: a network that accepts nothing causes counted drops; the cycle does not wait for it.
TEST(Publisher, ASlowNetworkCostsCountedDropsAndNoCycle) {
  engine::Machine machine = TestMachine();
  machine.lcm.axis_rate_hz = 1000;
  machine.lcm.engine_rate_hz = 1000;
  TestRun run({.publish = true, .snapshot_queue = 64}, machine);
  TestOutlet network;
  network.Block(true);
  std::uint64_t dropped = 0;
  {
    Publisher publisher(run.engine, run.clients, &network, nullptr, {});
    for (int i = 0; i < 5000; ++i) run.engine.RunCycle();  // would hang here if it waited
    dropped = run.engine.figures().snapshots_dropped;
    EXPECT_GE(dropped, 2 * 5000u - 64 - 2);
    network.Block(false);
    while (run.engine.snapshots().size() > 0 || run.engine.figure_queue().size() > 0) std::this_thread::sleep_for(1ms);
    run.Step(10);
  }
  const auto x = network.On<msgs::axis_state>("takt/axis/x");
  const auto y = network.On<msgs::axis_state>("takt/axis/y");
  EXPECT_EQ(x.size() + y.size() + run.engine.figures().snapshots_dropped, 2 * 5010u);
  const auto engine = network.On<msgs::engine_state>("takt/engine");
  ASSERT_FALSE(engine.empty());
  EXPECT_EQ(engine.back().snapshots_dropped, static_cast<std::int64_t>(dropped));
}

// EN-20: a receiver with a small buffer loses the end of a burst, which is not always of the same component.
TEST(Publisher, EndsEachBurstWithAnother) {
  engine::Machine machine = WithModule(TestMachine());
  machine.lcm.axis_rate_hz = 1000;
  machine.lcm.engine_rate_hz = 0;
  TestRun run({.publish = true}, machine);
  TestOutlet network;
  Publisher publisher(run.engine, run.clients, &network, nullptr, {});
  const auto states = [&] {
    std::vector<std::string> order = network.Order();
    std::erase(order, "takt/machine");
    return order;
  };
  std::map<std::string, int> last;
  for (std::size_t burst = 1; burst <= 200; ++burst) {
    run.engine.RunCycle();
    while (states().size() < burst * (machine.axes.size() + 1)) std::this_thread::sleep_for(100us);
    ++last[states().back()];
  }
  EXPECT_EQ(last.size(), machine.axes.size() + 1);
  for (const auto& [channel, times] : last) EXPECT_GT(times, 1) << channel;
}

// EN-20: messages that the network refuses are counted, and a receiver sees the gap.
TEST(Publisher, RefusedMessagesAreCountedAndLeaveAGap) {
  TestRun run({.publish = true});
  TestOutlet network;
  Publisher publisher(run.engine, run.clients, &network, nullptr, {});
  run.Step(100);
  while (network.On<msgs::axis_state>("takt/axis/x").size() < 10) std::this_thread::sleep_for(1ms);
  network.Refuse(true);
  run.Step(100);
  while (publisher.send_failures() < 20) std::this_thread::sleep_for(1ms);
  network.Refuse(false);
  run.Step(100);
  publisher.Stop();
  const auto x = network.On<msgs::axis_state>("takt/axis/x");
  ASSERT_EQ(x.size(), 20u);
  EXPECT_EQ(x[9].sequence, 9);
  EXPECT_EQ(x[10].sequence, 20);
}

// EN-22: commands arrive on one thread while the cycle runs on another and a third one publishes: each has exactly one
// final state.
TEST(Publisher, FeedbackFindsItsCommandAcrossThreads) {
  constexpr int kCommands = 2000;
  TestRun run({.publish = true});
  TestOutlet network;
  {
    std::atomic<bool> done{false};
    Publisher publisher(run.engine, run.clients, &network, nullptr, {});
    std::thread gateway([&] {
      for (int i = 1; i <= kCommands; ++i) {
        run.clients.OnCommand(Command(i, i % 2 ? "x" : "y", i % 5 ? "halt" : "power"), SteadyNs());
        if (i % 20 == 0) std::this_thread::sleep_for(1ms);
      }
      done = true;
    });
    while (!done) {
      run.engine.RunCycle();
      std::this_thread::sleep_for(50us);
    }
    gateway.join();
    for (int i = 0; i < 2000; ++i) {
      run.engine.RunCycle();
      std::this_thread::sleep_for(50us);
    }
  }
  std::map<std::int64_t, int> finals;
  for (const msgs::feedback& f : network.On<msgs::feedback>("takt/feedback")) {
    EXPECT_EQ(f.client, "test");
    if (IsFinal(static_cast<FeedbackState>(f.state))) ++finals[f.id];
  }
  EXPECT_EQ(finals.size(), static_cast<std::size_t>(kCommands));
  for (const auto& [id, count] : finals) EXPECT_EQ(count, 1) << id;
}

}  // namespace
}  // namespace takt::lcm
