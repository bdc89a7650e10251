// EN-26, AX-87: external drives over a network.
#include "takt/lcm/drives.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "takt/engine/scheduler.h"
#include "takt/lcm/channels.h"
#include "takt/plant/servo.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

using namespace std::chrono_literals;

engine::Machine ExternalMachine(double answer_within_s, std::uint32_t missing_cycles) {
  engine::Machine machine = TestMachine(2);
  machine.external.answer_within_s = answer_within_s;
  machine.external.drives.push_back({"x", missing_cycles});
  return machine;
}

// The simulated servo of axis x on its own thread.
class Plant {
 public:
  Plant(const std::string& url, const engine::Machine& machine, std::int64_t id = 1)
      : params_(engine::ServoOf(machine, 0)),
        state_(plant::MakeServoState(params_)),
        id_(id),
        network_(OpenNetwork(url)) {
    network_.lcm->subscribeFunction(SetPointChannel("x"), &Plant::OnSetPoint, this);
    thread_ = std::thread([this] {
      while (!stop_) network_.lcm->handleTimeout(5);
    });
  }
  ~Plant() {
    stop_ = true;
    thread_.join();
  }

  std::atomic<bool> answers{true};
  std::atomic<std::int64_t> silent_from{1'000'000'000}, silent_to{1'000'000'000};  // cycles: in [from, to) no answer
  std::atomic<std::int64_t> heard{-2};
  std::atomic<bool> enabled{false};

 private:
  static void OnSetPoint(const ::lcm::ReceiveBuffer*, const std::string&, const msgs::drive_setpoint* m, Plant* plant) {
    plant->Serve(*m);
  }
  void Serve(const msgs::drive_setpoint& m) {
    if (m.cycle > heard) {
      ServoOutputs told{m.position_counts, m.velocity_counts_s, m.voltage_v, m.torque_nm, DriveMode{}, false, false};
      told.enable = m.enable;
      told.release_brake = m.release_brake;
      told.torque_until_counts_s = m.torque_until_counts_s;
      told.torque_limit_nm = m.torque_limit_nm;
      plant::Step(params_, told, m.period_s, state_, inputs_);
      heard = m.cycle;
      enabled = m.enable;
    }
    msgs::drive_feedback answer{};
    answer.run_id = m.run_id;
    answer.cycle = m.cycle;
    answer.plant = id_;
    answer.sequence = m.cycle + 1;
    answer.axis = m.axis;
    answer.counts = inputs_.counts;
    answer.drive_ready = inputs_.drive_ready;
    answer.torque_nm = inputs_.torque_nm;
    const bool silent = m.cycle >= silent_from && m.cycle < silent_to;
    if (answers && !silent) network_.lcm->publish(DriveFeedbackChannel("x"), &answer);
  }

  plant::ServoParams params_;
  plant::ServoState state_;
  ServoInputs inputs_;
  const std::int64_t id_;
  Network network_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

engine::Command ToX(const axis::Command& body) {
  engine::Command command;
  command.target = 1;
  command.body = body;
  return command;
}

// An engine in simulated time with its drives on a network.
struct Stepped {
  Stepped(const std::string& url, const engine::Machine& machine) : engine(machine, {.drives = true}) {
    std::string problem;
    drives = Drives::Open(
        engine, {.url = url, .run_id = kRunId, .complain = [this](const std::string& s) { said.push_back(s); }},
        problem);
    EXPECT_TRUE(drives) << problem;
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      while (!drives->Ready()) {
      }
      engine.RunCycle();
    }
  }
  engine::Engine engine;
  std::unique_ptr<Drives> drives;
  std::vector<std::string> said;
};

// EN-26, AX-87: simulated time waits for the plant, whenever it is started; the motion is that of the built-in servo.
TEST(DrivesOverANetwork, LockStep) {
  const std::string url = NewUrl();
  const engine::Machine machine = ExternalMachine(20, 5);
  Stepped run(url, machine);
  std::unique_ptr<Plant> plant;
  std::thread late([&] {
    std::this_thread::sleep_for(200ms);
    plant = std::make_unique<Plant>(url, machine);
  });
  engine::Machine inside = machine;
  inside.external.drives.clear();
  engine::Engine built_in(inside);
  for (engine::Engine* e : {&run.engine, &built_in}) e->Submit(ToX(axis::Power{}));
  for (int c = 0; c < 600; ++c) {
    if (c == 200) {
      for (engine::Engine* e : {&run.engine, &built_in}) e->Submit(ToX(axis::MoveAbsolute{.position = 10}));
    }
    run.Run(1);
    built_in.RunCycle();
    ASSERT_EQ(run.engine.outputs(0).actual_position, built_in.outputs(0).actual_position) << c;
    ASSERT_EQ(run.engine.outputs(0).torque_nm, built_in.outputs(0).torque_nm) << c;
    ASSERT_EQ(run.engine.outputs(0).state, built_in.outputs(0).state) << c;
  }
  late.join();
  EXPECT_NEAR(run.engine.outputs(0).actual_position, 10, 0.01);
  EXPECT_TRUE(run.said.empty()) << run.said.front();
  run.drives.reset();
}

// AX-87: cycles without an answer run after the time in the machine file; N - 1 missing answers have no effect, N are a
// drive error, and then the drive is not waited for. The cycle does not depend on any clock.
TEST(DrivesOverANetwork, MissingAnswers) {
  const std::string url = NewUrl();
  const engine::Machine machine = ExternalMachine(1, 2);  // [s] longer than any delay of a loaded computer
  Plant plant(url, machine);
  Stepped run(url, machine);
  run.engine.Submit(ToX(axis::Power{}));
  run.Run(200);
  run.engine.Submit(ToX(axis::MoveVelocity{.velocity = 50}));
  run.Run(100);
  ASSERT_EQ(run.engine.outputs(0).state, axis::PlcState::kContinuousMotion);
  plant.silent_from = 310;
  plant.silent_to = 311;  // one
  run.Run(50);
  EXPECT_EQ(run.engine.outputs(0).state, axis::PlcState::kContinuousMotion);
  EXPECT_TRUE(run.said.empty());
  plant.silent_from = 360;
  plant.silent_to = 1'000'000'000;
  run.Run(12);  // cycles 350 to 361; in 361 there are answers up to 359, so one is missing
  EXPECT_EQ(run.engine.cycle().count, 362u);
  EXPECT_EQ(run.engine.outputs(0).state, axis::PlcState::kContinuousMotion);
  run.Run(1);
  EXPECT_EQ(run.engine.outputs(0).state, axis::PlcState::kErrorStop);
  EXPECT_EQ(run.engine.outputs(0).error, ErrorId::kDrive);
  ASSERT_EQ(run.said.size(), 1u);
  EXPECT_NE(run.said[0].find("axis x: no plant answers on " + url), std::string::npos);
  const auto begin = std::chrono::steady_clock::now();
  run.Run(5000);  // at 1 s each this would take 5000 s
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 100s);
  EXPECT_FALSE(run.engine.outputs(0).loop_closed);

  plant.silent_to = 0;  // it answers again: waited for again
  for (int i = 0; i < 2000 && run.engine.outputs(0).error != ErrorId::kNone; ++i) {
    run.engine.Submit(ToX(axis::Reset{}));
    run.Run(1);
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(run.engine.outputs(0).state, axis::PlcState::kDisabled);
  run.engine.Submit(ToX(axis::Power{}));
  run.Run(200);
  EXPECT_EQ(run.engine.outputs(0).state, axis::PlcState::kStandstill);
  run.drives.reset();
}

// EN-26: at the end the drives receive that they are off.
TEST(DrivesOverANetwork, TheEndIsHeard) {
  const engine::Machine machine = ExternalMachine(20, 5);
  const std::string url = NewUrl();
  Plant plant(url, machine);
  Stepped run(url, machine);
  std::atomic<int> signals{0};
  run.engine.Submit(ToX(axis::Power{}));
  const engine::RunResult result = engine::Run(
      run.engine, {.pace = engine::Pace::kFast, .duration_s = 0.5, .ready = [&] { return run.drives->Ready(); }},
      signals);
  EXPECT_EQ(result.end, engine::RunEnd::kStopped);
  const auto last = static_cast<std::int64_t>(run.engine.cycle().count) - 1;
  run.drives.reset();
  for (int i = 0; i < 5000 && plant.heard < last; ++i) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(plant.heard, last);
  EXPECT_FALSE(plant.enabled);
}

// EN-02, EN-21, EN-26: real time: the cycle does not wait. Threads exchange whatever is available; the thread sanitizer
// checks this test.
TEST(Drives, RealTime) {
  const std::string url = NewUrl();
  const engine::Machine machine = ExternalMachine(1, 2000);  // a loaded computer is slow
  engine::Engine engine(machine, {.drives = true});
  std::string problem;
  std::atomic<int> complaints{0};
  auto drives = Drives::Open(
      engine, {.url = url, .run_id = kRunId, .real_time = true, .complain = [&](const std::string&) { ++complaints; }},
      problem);
  ASSERT_TRUE(drives) << problem;
  Plant plant(url, machine);
  std::unique_ptr<Plant> second;
  std::atomic<bool> powered{false}, moved{false}, lost{false};
  std::atomic<int> signals{0};
  int cycles = 0;
  const auto watch = [&] {
    const axis::Outputs& x = engine.outputs(0);
    if (cycles++ == 0) engine.Submit(ToX(axis::Power{}));
    if (!powered && x.state == axis::PlcState::kStandstill) {
      powered = true;
      engine.Submit(ToX(axis::MoveAbsolute{.position = 5}));
    }
    if (powered && std::abs(x.actual_position - 5) < 0.01) moved = true;
    if (x.error == ErrorId::kDrive && x.state == axis::PlcState::kErrorStop && !x.loop_closed) lost = true;
  };
  std::thread cycle([&] { engine::Run(engine, {.pace = engine::Pace::kRealTime, .program = watch}, signals); });
  const auto eventually = [](const std::function<bool()>& holds) {
    for (int i = 0; i < 30'000 && !holds(); ++i) std::this_thread::sleep_for(1ms);
    return holds();
  };
  EXPECT_TRUE(eventually([&] { return moved.load(); }));
  second = std::make_unique<Plant>(url, machine, 2);
  EXPECT_TRUE(eventually([&] { return complaints > 0; }));  // two plants for one axis
  EXPECT_FALSE(lost);
  second.reset();
  plant.answers = false;
  EXPECT_TRUE(eventually([&] { return lost.load(); }));
  signals = 1;
  cycle.join();
  drives.reset();
}

TEST(Drives, AnAbsentNetworkIsSaid) {
  engine::Engine engine(ExternalMachine(1, 5), {.drives = true});
  std::string problem;
  EXPECT_FALSE(Drives::Open(engine, {.url = "nonsense"}, problem));
  EXPECT_NE(problem.find("nonsense"), std::string::npos);
}

}  // namespace
}  // namespace takt::lcm
