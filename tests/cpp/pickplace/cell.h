// A gantry with a pick and place module and belts, cycle by cycle.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "../group/machines.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

using group::Rig;
using kinematics::Pose;

inline Settings Fast() {
  Settings s;
  s.path_velocity = 1000;
  s.path_acceleration = 8000;
  s.path_deceleration = 8000;
  s.path_jerk = 400000;
  s.path_halt_deceleration = 8000;
  s.max_velocity.fill(0);
  s.max_acceleration.fill(0);
  s.max_jerk.fill(0);
  s.cartesian_jog_velocity = 100;
  s.cartesian_jog_acceleration = 1000;
  s.cartesian_jog_deceleration = 1000;
  s.real_axis_jog_velocity = 50;
  s.keep_orientation = true;
  s.z_start_distance = 30;
  s.z_target_distance = 20;
  s.blending_radius = 10;
  return s;
}

inline Configure To(double x, double y, double z) {
  Configure c;
  c.x_target = x;
  c.y_target = y;
  c.z_target = z;
  return c;
}

// Largest distance of the tool from its workpiece: while it holds it, and sideways on the way down and up [mm].
inline constexpr double kOnWorkpiece = 1e-6, kBeside = 0.01;
inline constexpr double kHalfWidth = 60;  // [mm] of a belt

struct CellBelt {
  conveyor::BeltParams params;
  BeltSettings settings;
  std::function<KinematicState(double t)> travel = [](double) { return KinematicState{}; };
};

class Cell {
 public:
  explicit Cell(Settings settings = Fast(), std::vector<CellBelt> of_belts = {}, Rig machine = group::Gantry())
      : rig(std::move(machine)), belts(std::move(of_belts)), belt_states(belts.size()) {
    params.name = "pick";
    params.group = "group";
    params.settings = settings;
    for (const CellBelt& belt : belts) params.belts.push_back({belt.params.name, belt.settings});
    state = MakeState(params);
    rig.carriers = {[](void* owner, std::string_view name) noexcept -> std::uint32_t {
                      const auto& all = static_cast<Cell*>(owner)->belts;
                      for (std::size_t i = 0; i < all.size(); ++i) {
                        if (all[i].params.name == name) return static_cast<std::uint32_t>(i + 1);
                      }
                      return 0;
                    },
                    [](void* owner, std::uint32_t i) noexcept {
                      const auto* cell = static_cast<Cell*>(owner);
                      return conveyor::CarrierOf(cell->belts[i - 1].params, cell->belt_states[i - 1].travel);
                    },
                    nullptr, this, true};
    MoveBelts();
  }
  Cell(const Cell&) = delete;

  // On and READY, with the tool at a place.
  void Start(const Pose& tool = {0, 0, 0, 0, 0, 0}) {
    rig.StartAt(tool);
    Do(Control{.enable = true, .regulator_on = true});
    Steps(2);
    EXPECT_EQ(state.state, PickPlaceState::kReady);
    rig.trace.clear();
    outs.clear();
  }

  Ticket Give(const Command& command, double lease_s = 0) {
    const Ticket ticket = next_++;
    pending_.push_back([=, this] { Apply(Now(), ticket, lease_s, command, rig.state, state); });
    return ticket;
  }
  // In the next cycle.
  Ticket Do(const Command& command) {
    const Ticket ticket = Give(command);
    Step();
    return ticket;
  }
  Ticket Execute(std::uint32_t target = 0) {
    Give(Control{.execute = false});
    return Give(Control{.execute = true, .set_target = target});
  }

  void Step() {
    MoveBelts();
    rig.Step([&](const auto& group) {
      for (const auto& command : pending_) command();
      pending_.clear();
      pickplace::Step(Now(), rig.state, state);
      group();
    });
    Outputs out;
    Publish(Now(), rig.state, state, out);
    outs.push_back(out);
    EXPECT_EQ(state.illegal_transitions, 0u);
    EXPECT_EQ(rig.state.illegal_transitions, 0u);
  }
  void Steps(int n) {
    while (n-- > 0) Step();
  }
  template <typename Until>
  bool RunUntil(const Until& until, double seconds = 10) {
    for (auto n = std::llround(seconds / rig.cycle.period_s); n > 0; --n) {
      if (!outs.empty() && until()) return true;  // outputs are published from the first cycle on
      Step();
    }
    return until();
  }
  bool RunTo(PickPlaceState wanted, double seconds = 10) {
    return RunUntil([&] { return state.state == wanted; }, seconds);
  }
  bool RunToEnd(Ticket ticket, double seconds = 10) {
    return RunUntil([&] { return rig.lives[ticket].ended(); }, seconds);
  }
  const Outputs& out() const { return outs.back(); }
  KDL::Vector tool() const { return {rig.out().x, rig.out().y, rig.out().z}; }
  double Off(double x, double y, double z) const { return (tool() - KDL::Vector(x, y, z)).Norm(); }

  // Puts a workpiece at this pose relative to the belt's origin.
  std::uint32_t Put(std::size_t belt, const Pose& pose) {
    conveyor::State& s = belt_states[belt];
    s.objects[s.count] = {++s.last_number, conveyor::ObjectState::kVisible, s.travel.position, pose, {}};
    ++s.count;
    return s.last_number;
  }

  Context Now() {
    Context c{params, rig.Now()};
    for (std::size_t i = 0; i < belts.size(); ++i) c.belts[i] = {&belts[i].params, &belt_states[i]};
    return c;
  }

  Rig rig;
  std::vector<CellBelt> belts;
  std::vector<conveyor::State> belt_states;
  PickPlaceParams params;
  State state;
  std::vector<Outputs> outs;

 private:
  void MoveBelts() {
    for (std::size_t i = 0; i < belts.size(); ++i) {
      belt_states[i].travel = belts[i].travel(static_cast<double>(rig.cycle.count) * rig.cycle.period_s);
      belt_states[i].sense = belt_states[i].travel.velocity < 0 ? -1 : 1;
    }
  }

  std::vector<std::function<void()>> pending_;
  Ticket next_ = 1'000'000;
};

}  // namespace takt::pickplace
