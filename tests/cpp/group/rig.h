// A group with its axes in front of ideal drives: what is commanded in a cycle is measured in the next.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "takt/core/describe.h"
#include "takt/group/group.h"
#include "takt/group/plan.h"
#include "takt/group/systems.h"

namespace takt::group {

struct Life {
  bool busy = false, active = false, done = false, aborted = false, error = false;
  ErrorId error_id = ErrorId::kNone;
  double value = 0;  // at the end
  std::uint64_t active_cycle = 0, final_cycle = 0;
  bool ended() const { return done || aborted || error; }
};

struct Sample {
  Outputs out;
  std::vector<KinematicState> set;  // of each axis
};

inline axis::AxisParams AxisOf(const std::string& name, double velocity, double acceleration, double jerk) {
  axis::AxisParams p;
  p.name = name;
  p.limits = {
      .velocity = velocity, .acceleration = acceleration, .deceleration = {}, .jerk = jerk, .lower = {}, .upper = {}};
  p.encoder.increments_per_unit = 1e6;
  return p;
}

class Rig {
 public:
  explicit Rig(GroupParams p, std::vector<axis::AxisParams> of_axes, std::vector<PathTable> path_tables = {})
      : params(std::move(p)), axes(std::move(of_axes)), paths(std::move(path_tables)), storage_(4096), sink_(storage_) {
    cycle.period_s = 0.001;
    if (params.kinematics) {
      auto made = kinematics::Make(*params.kinematics);
      if (!made.kinematics) throw std::runtime_error(made.path + ": " + made.problem);
      kinematics = *made.kinematics;
    }
    std::vector<std::uint32_t> members;
    for (const std::string& name : params.axes) {
      for (std::uint32_t i = 0; i < axes.size(); ++i) {
        if (axes[i].name == name) members.push_back(i);
      }
    }
    for (const axis::AxisParams& a : axes) states.push_back(axis::MakeState(a));
    group_of.assign(axes.size(), 0);
    for (const std::uint32_t member : members) group_of[member] = 1;
    inputs.resize(axes.size());
    commanded.resize(axes.size());
    slip_counts.resize(axes.size());
    ahead = std::make_unique<LookAhead>(trajectory::CoordinateLimits{}, cycle.period_s);
    mounting = MakeMounting(params);
    questions = std::make_unique<PathCheckRequests>(4);
    state = MakeState(members);
  }

  Ticket Give(const Command& command, double lease_s = 0) {
    const Ticket ticket = next_++;
    pending_.push_back([=, this] { Apply(Now(), ticket, lease_s, command, state); });
    return ticket;
  }
  Ticket GiveAxis(std::size_t i, const axis::Command& command) {
    const Ticket ticket = next_++;
    pending_.push_back([=, this] { axis::Apply(AxisContext(i), ticket, 0, command, states[i]); });
    return ticket;
  }
  void Let(Ticket ticket) {
    pending_.push_back([=, this] { Release(Now(), ticket, state); });
  }

  void Step() {
    Step([](const auto& step) { step(); });
  }
  // `around`: calls what it gets, the group's part of the cycle.
  template <typename Around>
  void Step(const Around& around) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (commanded[i].enable) {  // else the drive holds it
        inputs[i].counts = static_cast<std::uint32_t>(std::llround(commanded[i].position_counts + slip_counts[i]));
      }
      inputs[i].drive_ready = commanded[i].enable && !inputs[i].drive_fault;
      axis::Sense(AxisContext(i), inputs[i], states[i]);
    }
    for (const auto& command : pending_) command();
    pending_.clear();
    around([&] { group::Step(Now(), state); });
    for (std::size_t i = 0; i < axes.size(); ++i) axis::Move(AxisContext(i), states[i]);
    Sample sample;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axis::Control(AxisContext(i), states[i], commanded[i]);
      sample.set.push_back(states[i].setpoint);
    }
    Publish(Now(), state, sample.out);
    for (const FeedbackEvent& e : sink_.events()) Note(e);
    sink_.Clear();
    trace.push_back(sample);
    ++cycle.count;
  }
  void Run(double seconds) {
    for (auto n = std::llround(seconds / cycle.period_s); n > 0; --n) Step();
  }
  bool RunToEnd(Ticket ticket, double seconds = 60) {
    for (auto n = std::llround(seconds / cycle.period_s); n > 0 && !lives[ticket].ended(); --n) Step();
    return lives[ticket].ended();
  }
  // On, enabled, and standing at these positions.
  void Start(const std::vector<double>& positions = {}) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      RunToEnd(GiveAxis(i, axis::SetPosition{.position = positions[i]}), 1);
    }
    RunToEnd(Give(Power{}), 1);
    const Ticket enable = Give(Enable{});
    RunToEnd(enable, 1);
    EXPECT_TRUE(lives[enable].done);
    trace.clear();
  }
  // Standing where the tool is there.
  void StartAt(const kinematics::Pose& tool) {
    kinematics::Joints joints{};
    joints.fill(std::numeric_limits<double>::quiet_NaN());
    kinematics::Joints found{};
    const Frame flange = kinematics::ToFrame(tool) * kinematics::ToFrame(params.tool).Inverse();
    const auto reason = kinematics::Inverse(*kinematics, flange, {}, joints, found);
    EXPECT_EQ(reason, kinematics::Reason::kNone);
    Start({found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kinematics->count)});
  }

  axis::Context AxisContext(std::size_t i) noexcept {
    machine_ = {.states = states, .params = axes, .cam_switches = {}, .cams = {}};
    return {axes[i], cycle, planner, sink_, nullptr, machine_};
  }
  Context Now() {
    Context c{params, mounting, kinematics ? &*kinematics : nullptr, paths, group_of, 1, {}, cycle, sink_, *ahead};
    c.axes = {states, axes,
              [](void* owner, std::size_t i) noexcept { return static_cast<Rig*>(owner)->AxisContext(i); }, this};
    c.carriers = carriers;
    if (params.workspace) c.questions = questions.get();
    return c;
  }
  bool out_of_work() const { return state.state == GroupState::kStandby && pending_.empty(); }
  const Outputs& out() const { return trace.back().out; }

  GroupParams params;
  Mounting mounting;
  std::vector<axis::AxisParams> axes;
  std::vector<PathTable> paths;
  std::optional<kinematics::Kinematics> kinematics;
  std::vector<axis::State> states;
  std::vector<std::uint32_t> group_of;
  std::vector<ServoInputs> inputs;
  std::vector<ServoOutputs> commanded;
  std::vector<double> slip_counts;  // measured beyond what is commanded
  std::unique_ptr<LookAhead> ahead;
  std::unique_ptr<PathCheckRequests> questions;  // with a workspace
  Carriers carriers;
  State state;
  Cycle cycle;
  trajectory::Planner planner;
  std::map<Ticket, Life> lives;
  std::vector<Sample> trace;

 private:
  void Note(const FeedbackEvent& e) {
    Life& life = lives[e.ticket];
    EXPECT_FALSE(life.ended()) << "ticket " << e.ticket << " ended before: done " << life.done << ", aborted "
                               << life.aborted << ", error " << life.error << "; now " << static_cast<int>(e.state);
    life.busy |= e.state == FeedbackState::kBusy;
    if (e.state == FeedbackState::kActive && !life.active) life.active_cycle = e.cycle;
    life.active |= e.state == FeedbackState::kActive;
    life.done |= e.state == FeedbackState::kDone;
    life.aborted |= e.state == FeedbackState::kAborted;
    life.error |= e.state == FeedbackState::kError;
    if (IsFinal(e.state)) {
      life.final_cycle = e.cycle;
      life.error_id = e.error;
      life.value = e.value;
    }
  }

  axis::MachineView machine_;
  std::vector<FeedbackEvent> storage_;
  FeedbackSink sink_;
  std::vector<std::function<void()>> pending_;
  Ticket next_ = 1;
};

}  // namespace takt::group
