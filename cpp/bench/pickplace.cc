// PP-50: what a cycle of a pick and place module costs with its group, a Delta, and two belts full of workpieces, from
// one to the other without a pause; beside the group alone, as the floor. And where no workpiece can be reached, so
// that all of them are tried in each cycle.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <vector>

#include "cpp/pickplace/cell.h"
#include "takt/conveyor/belt.h"

namespace takt::pickplace {
namespace {

using Clock = std::chrono::steady_clock;

double Nanoseconds(Clock::time_point from) {
  return std::chrono::duration<double, std::nano>(Clock::now() - from).count();
}

// In the range and on the way there, mm apart.
constexpr double kApart = 25;

CellBelt BeltAt(const char* name, double y) {
  CellBelt belt;
  belt.params.name = belt.params.axis = name;
  belt.params.origin = {-200, y, -900, 0, 0, 0};
  belt.params.upper_limit = 400;
  belt.settings = {.park_x = 0, .park_y = y, .park_z = -860, .z_distance = 25, .lower_limit = 0, .upper_limit = 400};
  return belt;
}

Settings OfTheDelta() {
  Settings s = Fast();
  s.path_velocity = 4000;
  s.path_acceleration = s.path_deceleration = 60000;
  s.path_jerk = 3e6;
  s.z_elliptical = 25;
  s.gripper_closing_time = s.gripper_open_time = 0.02;
  s.tracking_mode = TrackingMode::kBelt1ToBelt2;
  return s;
}

// The belts really step; the rest is that of the tests.
class Line {
 public:
  // `aside`: mm that workpieces lie beside the middle of the belts.
  explicit Line(double aside)
      : aside_(aside), cell_(OfTheDelta(), {BeltAt("in", -100), BeltAt("out", 100)}, group::DeltaRobot()) {
    cell_.Start({0, 0, -860, 0, 0, 0});
    for (axis::State& axis : drives_) axis.loop_closed = true;
    Refill();
    Apply(cell_.Now(), 0, 0, Control{.execute = true}, cell_.rig.state, cell_.state);
  }

  // ns of belts, module and group, from their steps to what they publish.
  double Cycle() {
    double time = 0;
    cell_.rig.trace.clear();
    cell_.rig.Step([&](const auto& group) {
      for (axis::State& drive : drives_) drive.setpoint = {drive.setpoint.position + 0.2, 200, 0};
      const auto from = Clock::now();
      for (std::size_t i = 0; i < drives_.size(); ++i) conveyor::Step(BeltContext(i), cell_.belt_states[i]);
      const Context context = cell_.Now();
      pickplace::Step(context, cell_.rig.state, cell_.state);
      group();
      for (std::size_t i = 0; i < drives_.size(); ++i) {
        conveyor::Publish(BeltContext(i), cell_.belt_states[i], belt_out_);
        benchmark::DoNotOptimize(belt_out_);
      }
      group::Publish(context.group, cell_.rig.state, group_out_);
      pickplace::Publish(context, cell_.rig.state, cell_.state, out_);
      benchmark::DoNotOptimize(group_out_);
      benchmark::DoNotOptimize(out_);
      time = Nanoseconds(from);
    });
    Refill();
    return time;
  }
  const State& module() const { return cell_.state; }

 private:
  // Always as many as a belt holds.
  void Refill() {
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      conveyor::State& belt = cell_.belt_states[i];
      while (belt.count < conveyor::kObjects) {
        double x = 400;
        for (const conveyor::Object& object : conveyor::ObjectsOf(belt)) {
          x = std::min(x, conveyor::PlaceOf(cell_.belts[i].params, belt, object));
        }
        Apply(BeltContext(i), 0, conveyor::Detect{.x = x - kApart, .y = aside_}, belt);
      }
    }
    feedback_.Clear();
  }
  conveyor::Context BeltContext(std::size_t i) {
    return {cell_.belts[i].params, drives_[i], drive_params_, cell_.rig.cycle, feedback_};
  }

  double aside_;
  Cell cell_;
  std::array<axis::State, 2> drives_;
  axis::AxisParams drive_params_;
  std::vector<FeedbackEvent> storage_ = std::vector<FeedbackEvent>(64);
  FeedbackSink feedback_{storage_};
  conveyor::Outputs belt_out_;
  group::Outputs group_out_;
  Outputs out_;
};

// The group alone, on the same way between places that stand: up, across, down.
class Floor {
 public:
  Floor() { rig_.StartAt({0, -100, -900, 0, 0, 0}); }

  double Cycle() {
    if (rig_.out_of_work()) Give();
    double time = 0;
    rig_.trace.clear();
    rig_.Step([&](const auto& group) {
      const auto from = Clock::now();
      group();
      group::Publish(rig_.Now(), rig_.state, out_);
      benchmark::DoNotOptimize(out_);
      time = Nanoseconds(from);
    });
    return time;
  }

 private:
  void Give() {
    side_ = -side_;
    const auto line = [&](std::optional<double> y, double z, group::BufferMode mode) {
      return group::MoveLinearAbsolute{.y = y,
                                       .z = z,
                                       .buffer_mode = mode,
                                       .transition_mode = group::TransitionMode::kCornerDistance,
                                       .transition_parameter = 10};
    };
    rig_.Give(line({}, -875, group::BufferMode::kAborting));
    rig_.Give(line(side_, -875, group::BufferMode::kBlendingNext));
    rig_.Give(line({}, -900, group::BufferMode::kBlendingNext));
  }

  Rig rig_ = group::DeltaRobot();
  group::Outputs out_;
  double side_ = -100;
};

template <typename What>
void Cycles(benchmark::State& bench, What& what) {
  std::vector<double> times;
  for (auto _ : bench) {
    times.push_back(what.Cycle());
    bench.SetIterationTime(times.back() * 1e-9);
  }
  std::ranges::sort(times);
  // Others on the machine take their time out of cycles: they are the largest ones.
  bench.counters["median_ns"] = times[times.size() / 2];
  bench.counters["p98_ns"] = times[times.size() * 98 / 100];
  bench.counters["p99.9_ns"] = times[times.size() * 999 / 1000];
  bench.counters["largest_ns"] = times.back();
}

void PickAndPlace(benchmark::State& bench, double aside) {
  Line line(aside);
  Cycles(bench, line);
  bench.counters["picked"] = line.module().counters.picked;
  if (line.module().state == PickPlaceState::kError) bench.SkipWithError("the module is in error");
}
void GroupAlone(benchmark::State& bench) {
  Floor floor;
  Cycles(bench, floor);
}
BENCHMARK_CAPTURE(PickAndPlace, busy, 0.0)->UseManualTime()->Iterations(20000);
BENCHMARK_CAPTURE(PickAndPlace, none_reachable, -600.0)->UseManualTime()->Iterations(20000);
BENCHMARK(GroupAlone)->UseManualTime()->Iterations(20000);

}  // namespace
}  // namespace takt::pickplace
