// A million random problems per row: how often Ruckig alone fails, how often we do, and by how much any limit is
// exceeded.
//   long_trajectory [problems]

#include <cstdio>
#include <cstdlib>
#include <ruckig/ruckig.hpp>

#include "takt/trajectory/planner.h"
#include "trajectory/problems.h"

namespace takt::trajectory::testing {
namespace {

struct Row {
  const char* name;
  Mix mix;
  bool replanned;  // the start is a state of another plan, underway to the same target
};

class Raw {
 public:
  // Duration, or a negative number on failure.
  double Plan(const Problem& p) {
    input_.current_position = {p.from.position};
    input_.current_velocity = {p.from.velocity};
    input_.current_acceleration = {p.from.acceleration};
    input_.target_position = {p.position};
    input_.target_velocity = {p.end_velocity};
    input_.max_velocity = {p.limits.velocity};
    input_.max_acceleration = {p.limits.acceleration};
    input_.max_jerk = {p.limits.jerk > 0 ? p.limits.jerk : std::numeric_limits<double>::infinity()};
    const auto result = otg_.calculate(input_, trajectory_);
    return result == ruckig::Result::Working ? trajectory_.get_duration() : -1;
  }

 private:
  ruckig::Ruckig<1> otg_;
  ruckig::InputParameter<1> input_;
  ruckig::Trajectory<1> trajectory_;
};

void Run(const Row& row, long count) {
  Problems problems(20260101, row.mix);
  Planner planner;
  Raw raw;
  Excess worst;
  long raw_failures = 0;
  long slower = 0;
  Profile plan;
  for (long i = 0; i < count; ++i) {
    Problem p = problems.Next();
    if (row.replanned) {
      if (planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, plan).failed()) continue;
      p.from = plan.At(plan.duration() * (0.5 + problems.Signed(0.5)));
    }
    const double raw_s = raw.Plan(p);
    if (raw_s < 0) ++raw_failures;
    if (planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, plan).failed()) continue;
    worst.Widen(Audit(plan, p.limits));
    if (raw_s > 0 && p.limits.acceleration == p.limits.deceleration && plan.duration() > raw_s * (1 + 1e-6)) ++slower;
  }
  const PlannerCounters& c = planner.counters();
  std::printf("%-24s %9ld %9ld %7llu %7llu %7ld | %8.1e %8.1e %8.1e %8.1e | %8.1e %8.1e %8.1e\n", row.name, count,
              raw_failures, static_cast<unsigned long long>(c.second_scale),
              static_cast<unsigned long long>(c.failures), slower, worst.velocity, worst.acceleration,
              worst.deceleration, worst.jerk, worst.position_step, worst.velocity_step, worst.acceleration_step);
  std::fflush(stdout);
}

}  // namespace
}  // namespace takt::trajectory::testing

int main(int argc, char** argv) {
  using namespace takt::trajectory::testing;
  const long count = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  const Row rows[] = {
      {"mm, feasible start", {.unit = 1}, false},
      {"um, feasible start", {.unit = 1000}, false},
      {"m, feasible start", {.unit = 0.001}, false},
      {"deg, feasible start", {.unit = 0.36}, false},
      {"mm, any start", {.unit = 1, .start_within_limits = false}, false},
      {"mm, replanned underway", {.unit = 1}, true},
      {"mm, dec differs", {.unit = 1, .asymmetric = true}, false},
      {"mm, dec differs, any", {.unit = 1, .start_within_limits = false, .asymmetric = true}, false},
      {"mm, also jerk unlimited", {.unit = 1, .unlimited_jerk = true}, false},
      {"mm, limits far apart", {.unit = 1, .spread = 3}, false},
      {"the same, any start", {.unit = 1, .start_within_limits = false, .spread = 3}, false},
  };
  std::printf("%-24s %9s %9s %7s %7s %7s | %-35s | %s\n", "", "problems", "Ruckig", "2nd", "both", "slower",
              "worst excess, share of limit", "worst step (position, velocity, acceleration)");
  std::printf("%-24s %9s %9s %7s %7s %7s | %8s %8s %8s %8s |\n", "", "", "failures", "scale", "failed", "than it",
              "velocity", "accel.", "decel.", "jerk");
  for (const Row& row : rows) Run(row, count);
}
