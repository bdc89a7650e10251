// AX-91 and AX-01: whole cycles of a machine, with position loop and simulated servo, by number of axes; and the
// cycle's own overhead. PL-60: whole cycles of a machine of movers.
#include "takt/engine/engine.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "takt/engine/components.h"
#include "takt/engine/load.h"

namespace takt::engine {
namespace {

Machine MachineOf(std::int64_t axes, DriveMode mode) {
  Machine machine;
  machine.name = "bench";
  for (std::int64_t i = 0; i < axes; ++i) {
    axis::AxisParams axis;
    axis.name = "a" + std::to_string(i);
    axis.limits = {
        .velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000, .lower = -1e9, .upper = 1e9};
    axis.supervision.deviation_moving = 100;
    axis.drive.mode = mode;
    machine.axes.push_back(axis);
  }
  return machine;
}

void GiveAll(Engine& engine, std::int64_t axes, const axis::Command& body) {
  for (std::int64_t i = 0; i < axes; ++i) {
    Command command;
    command.target = static_cast<std::uint32_t>(i + 1);
    command.body = body;
    while (engine.Submit(command) == 0) engine.RunCycle();
  }
}

void RunCycles(benchmark::State& state, DriveMode mode, bool moving) {
  const std::int64_t axes = state.range(0);
  Engine engine(MachineOf(axes, mode));
  GiveAll(engine, axes, axis::Power{});
  for (int i = 0; i < 500; ++i) engine.RunCycle();
  if (moving) GiveAll(engine, axes, axis::MoveVelocity{.velocity = 400});
  for (int i = 0; i < 500; ++i) engine.RunCycle();
  FeedbackEvent event;
  for (auto _ : state) {
    engine.RunCycle();
    while (engine.feedback().TryPop(event)) {
    }
  }
  state.counters["per_axis"] = benchmark::Counter(
      static_cast<double>(axes), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// A cycle without anything powered: what the engine itself costs.
void RunIdle(benchmark::State& state) {
  Engine engine(MachineOf(state.range(0), DriveMode::kCyclicPosition));
  for (auto _ : state) engine.RunCycle();
}

// Two rows of lanes, each beside another one with a switch at both ends, joined to one ring: five movers to a lane.
class Ring {
 public:
  explicit Ring(std::int64_t movers, double scale)
      : lanes_(static_cast<int>(movers / 5)), scale_(scale), engine_(Make()) {
    Do("close", "enable");
    for (int i = 0; i < lanes_; ++i) Do("lane" + std::to_string(i), "enable"), Do("side" + std::to_string(i), "enable");
    for (int i = 0; i < 5 * lanes_; ++i) Do(Mover(i), "enable");
    Run(5);
    for (int i = 0; i < 5 * lanes_; ++i) Do(Mover(i), "join_track", "{track: lane" + std::to_string(i / 5) + "}");
    Run(5);
    for (int i = 0; i < 5 * lanes_; ++i) Send(i);
    Run(3000);
  }
  // How long the cycle took, us; whoever has arrived is sent on.
  double Step() {
    const auto begin = std::chrono::steady_clock::now();
    engine_.RunCycle();
    const auto end = std::chrono::steady_clock::now();
    for (FeedbackEvent event; engine_.feedback().TryPop(event);) {
      if (!IsFinal(event.state)) continue;
      const auto whose = sent_.find(event.ticket);
      if (whose == sent_.end()) continue;
      const int mover = whose->second;
      sent_.erase(whose);
      Send(mover);
    }
    return std::chrono::duration<double, std::micro>(end - begin).count();
  }
  double Moving() const {
    double moving = 0;
    for (int i = 0; i < 5 * lanes_; ++i)
      moving += engine_.mover_outputs(static_cast<std::size_t>(i)).track_velocity > 0;
    return moving;
  }

 private:
  static std::string Mover(int i) { return "m" + std::to_string(i); }
  Engine Make() const {
    std::string text = "name: ring\naxes: []\ntracks:\n", movers = "movers:\n";
    const int row = lanes_ / 2;
    for (int i = 0; i < lanes_; ++i) {
      const bool back = i >= row;
      const double at = 3000.0 * scale_ * (back ? lanes_ - 1 - i : i), y = back ? 4000 : 0;
      const double side = (back ? 400 : -400) * scale_;
      const double length = 2400 * scale_, from = back ? at + length : at, to = back ? at : at + length;
      const std::string next = std::to_string((i + 1) % lanes_), n = std::to_string(i);
      const auto line = [](double a, double b, double height) {
        const std::string level = std::to_string(height);
        return "{from: {x: " + std::to_string(a) + ", y: " + level + "}, to: {x: " + std::to_string(b) +
               ", y: " + level + "}}";
      };
      text += "  - {name: lane" + n + ", elements: [" + line(from, to, y) + "]";
      // Tracks refer to one another in no circle: the last one is joined to the first by one more.
      text += i + 1 < lanes_ ? ", ends_at: [lane" + next + "]}\n"
                             : "}\n  - {name: close, starts_from: [lane" + n + "], ends_at: [lane0]}\n";
      const double way = to > from ? scale_ : -scale_, in = from + 800 * way, out = to - 800 * way;
      const std::string before = std::to_string((i + lanes_ - 1) % lanes_);
      text += "  - {name: side" + n + ", starts_from: [lane" + before + "], elements: [" + line(in, out, y + side) +
              "], ends_at: [lane" + next + "]}\n";
      for (int k = 0; k < 5; ++k) {
        movers += "  - {name: " + Mover(5 * i + k) +
                  ", gap: 160, initial: {x: " + std::to_string(from + way * (200 + 400 * k)) +
                  ", y: " + std::to_string(y) + "}}\n";
      }
    }
    LoadResult loaded = LoadMachine(text + movers, "ring.yaml");
    if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
    return Engine(*loaded.machine);
  }
  Ticket Give(const std::string& target, const std::string& verb, const std::string& arguments) {
    const ParsedCommand parsed = ParseCommand(engine_.machine(), target, verb, arguments);
    if (!parsed.sentence.empty()) throw std::runtime_error(parsed.sentence);
    Ticket ticket = 0;
    while ((ticket = engine_.Submit(parsed.command)) == 0) engine_.RunCycle();
    return ticket;
  }
  void Do(const std::string& target, const std::string& verb, const std::string& arguments = "{}") {
    Give(target, verb, arguments);
    if (++given_ % 50 == 0) Run(1);
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  // One to five lanes further on, on one side or the other.
  void Send(int mover) {
    const std::uint32_t track = engine_.mover_outputs(static_cast<std::size_t>(mover)).track;
    const int lane = static_cast<int>((track == 0 ? 0 : track - 1) / 2) % lanes_;
    const int ahead = std::uniform_int_distribution<int>(1, 5)(random_);
    const bool side = std::uniform_int_distribution<int>(0, 1)(random_) != 0;
    const std::string to = (side ? "side" : "lane") + std::to_string((lane + ahead) % lanes_);
    const double place = scale_ * std::uniform_real_distribution<double>(700, 1700)(random_);
    sent_[Give(Mover(mover), "move_on_track", "{track: " + to + ", position: " + std::to_string(place) + "}")] = mover;
  }

  int lanes_;
  double scale_;  // of all lengths but those of movers
  Engine engine_;
  std::unordered_map<Ticket, int> sent_;
  std::mt19937 random_{1};
  int given_ = 0;
};

// PL-60: everything that a cycle is, with commands that arrive and tracks that are looked for.
void RunMovers(benchmark::State& state, double scale) {
  Ring ring(state.range(0), scale);
  std::vector<double> cycles;
  double moving = 0;
  for (auto _ : state) {
    cycles.push_back(ring.Step());
    state.SetIterationTime(1e-6 * cycles.back());
    moving += ring.Moving();
  }
  std::ranges::sort(cycles);
  state.counters["moving"] = moving / static_cast<double>(cycles.size());
  state.counters["median_us"] = cycles[cycles.size() / 2];
  state.counters["p99_us"] = cycles[cycles.size() * 99 / 100];
  state.counters["max_us"] = cycles.back();
}

BENCHMARK_CAPTURE(RunMovers, usual, 1)
    ->Name("CycleMovers")
    ->UseManualTime()
    ->Arg(50)
    ->Arg(200)
    ->Arg(800)
    ->Iterations(3000);
BENCHMARK_CAPTURE(RunMovers, dense, 0.6)->Name("CycleMoversDense")->UseManualTime()->Arg(200)->Iterations(3000);
BENCHMARK(RunIdle)->Name("CycleIdle")->Arg(1)->Arg(6);
BENCHMARK_CAPTURE(RunCycles, csp, DriveMode::kCyclicPosition, false)
    ->Name("CycleStandstillCsp")
    ->Arg(6)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(RunCycles, csp_moving, DriveMode::kCyclicPosition, true)
    ->Name("CycleMovingCsp")
    ->Arg(6)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(RunCycles, loop, DriveMode::kAnalog, true)
    ->Name("CycleMovingLoop")
    ->Arg(1)
    ->Arg(6)
    ->Arg(64)
    ->Arg(100)
    ->Arg(1000);

}  // namespace
}  // namespace takt::engine
