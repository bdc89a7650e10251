// GR-01, GR-02, GR-03, GR-10, GR-25: a random walk over two groups of one machine, whose axes change between them, with
// free axes that lead and follow, and faults. In every cycle: no transition outside the table, members as in table 8.1
// of the manual, every axis with at most one master, every set point within the limits and without a jump, every
// command ended once.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "../core/trials.h"
#include "machines.h"
#include "takt/axis/guidance.h"
#include "takt/engine/cycle.h"

// GCC 12 reports optionals that are moved into a variant as uninitialised.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

namespace takt::engine {
namespace {

using axis::PlcState;
using group::GroupState;

const char* kTwoGroups = R"(
name: two_groups
axes:
  - {name: a1, unit: deg, limits: {velocity: 600, acceleration: 6000, jerk: 200000}, supervision: {deviation_moving: 5}}
  - {name: a2, unit: deg, limits: {velocity: 600, acceleration: 6000, jerk: 200000}, supervision: {deviation_moving: 5}}
  - {name: az, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -300, upper: 300}}
  - {name: ac, unit: deg, limits: {velocity: 900, acceleration: 9000, jerk: 300000}}
  - {name: u, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: l, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}, homing: {method: pulse, velocity: 40, time_limit: 0.4}}
  - {name: r, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: m, limits: {velocity: 300, acceleration: 3000, jerk: 60000, lower: -400, upper: 400}}
  - {name: f, limits: {velocity: 2000, acceleration: 40000, jerk: 2000000}}
groups:
  - name: arm
    axes: [a1, a2, az, ac, u]
    kinematics: {scara: {first_arm: 325, second_arm: 275}}
    path: {velocity: 800, acceleration: 8000, jerk: 300000}
    base: {x: 100, y: -50, c: 30}
    tool: {x: 20, z: -40}
  - name: cross
    axes: [l, r]
    kinematics: {core_xy: {}}
    path: {velocity: 500, acceleration: 6000, jerk: 300000}
paths:
  - name: hook
    elements:
      - {shape: line, to: {x: 380, y: 60, z: 0}}
      - {shape: arc, via_x: 400, via_y: 100, via_z: -10, to: {x: 360, y: 120, z: -20}, velocity: 100}
      - {shape: spline, points: [{x: 330, y: 100, z: -20}, {x: 320, y: 60, z: 0}]}
  - name: zigzag
    elements:
      - {shape: line, to: {x: 30, y: 0, z: 0}}
      - {shape: line, to: {x: 10, y: 20, z: 0}, velocity: 80}
      - {shape: line, to: {x: 40, y: 30, z: 0}}
)";

Machine TwoGroups() {
  LoadResult loaded = LoadMachine(kTwoGroups, "two_groups.yaml");
  if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
  return *loaded.machine;
}

constexpr std::size_t kGroups = 2;

// Any command, valid or not.
class Fancy {
 public:
  explicit Fancy(std::uint64_t seed) : random_(seed) {}

  std::size_t Under(std::size_t count) { return random_() % count; }
  bool Once(std::size_t in) { return Under(in) == 0; }
  double Between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Name Axis() {
    static const char* const names[] = {"a1", "a2", "az", "ac", "u", "l", "r", "m", "f"};
    return Name::Of(names[Under(std::size(names))]);
  }

  group::Command OfGroup(std::size_t index) {
    switch (Under(22)) {
      case 0:
      case 1:
      case 2:
      case 3:
        return Linear<group::Reference::kAbsolute>(index);
      case 4:
      case 5:
        return Linear<group::Reference::kRelative>(index);
      case 6:
        return Circular();
      case 7:
      case 8:
        return Direct(index);
      case 9: {
        group::MovePath m{.path = Name::Of(Once(2) ? "hook" : "zigzag")};
        TakeManner(m);
        m.buffer_mode = static_cast<axis::BufferMode>(Under(6));
        return m;
      }
      case 10: {
        group::MovePathSynchronized m{.path = Name::Of(Once(2) ? "hook" : "zigzag"),
                                      .master = Once(4) ? Axis() : Name::Of("m"),
                                      .ratio = Between(-2, 2)};
        TakeManner(m);
        return m;
      }
      case 11:
        return group::SyncAxis{.axis = Once(4) ? Axis() : Name::Of("f"), .ratio_numerator = Between(-2, 2)};
      case 12:
        return group::Stop{.deceleration = Maybe(500, 9000), .hold = Once(2)};
      case 13:
        return group::Halt{.deceleration = Maybe(500, 9000)};
      case 14:
        return Once(2) ? group::Command{group::Interrupt{.deceleration = Maybe(500, 9000)}}
                       : group::Command{group::Continue{}};
      case 15:
        return Membership();
      case 16:
        return Once(4) ? group::Command{group::Disable{}} : group::Command{group::Enable{}};
      case 17:
        return Once(2) ? group::Command{group::Reset{}} : group::Command{group::Enable{}};
      case 18:
        return group::Power{.enable = !Once(4)};
      case 19:
        return Once(3) ? group::Command{group::Home{}}
                       : group::Command{group::SetOverride{Once(4) ? 0 : Between(0, 2)}};
      case 20:
        return Systems();
      default:
        return Numbers(index);
    }
  }

  axis::Command OfAxis() {
    switch (Under(9)) {
      case 0:
        return axis::Power{.enable = !Once(4)};
      case 1:
        return axis::Reset{};
      case 2:
        return axis::MoveVelocity{.velocity = Between(20, 250),
                                  .direction = Once(2) ? axis::Direction::kPositive : axis::Direction::kNegative};
      case 3:
        return axis::MoveAbsolute{.position = Between(-100, 100), .velocity = Between(20, 300)};
      case 4:
        return axis::Halt{};
      case 5:
        return axis::Stop{};
      case 6: {
        axis::GearIn gear;
        gear.master = Axis();
        gear.ratio_numerator = Between(-1, 1);
        return gear;
      }
      case 7:
        return axis::Home{};
      default:
        return axis::SetPosition{.position = Between(-50, 50)};
    }
  }

 private:
  std::optional<double> Maybe(double low, double high) {
    return Once(2) ? std::nullopt : std::optional<double>(Between(low, high));
  }
  template <typename M>
  void TakeManner(M& m) {
    m.coordinate_system = static_cast<group::CoordinateSystem>(Under(4));
    m.pcs = static_cast<std::uint32_t>(1 + Under(3));
    m.transition_mode = static_cast<group::TransitionMode>(Under(5));
    m.transition_parameter = Between(0, 40);
    if constexpr (requires { m.velocity_factor; }) {
      m.velocity_factor = Between(0.1, 1);
    } else {
      m.velocity = Maybe(5, 900);
      m.acceleration = Maybe(300, 12000);
      m.jerk = Maybe(10000, 500000);
    }
  }
  // Of the tool, or of axes.
  template <typename M>
  void TakeTarget(std::size_t index, bool by, M& m) {
    if (m.coordinate_system == group::CoordinateSystem::kAcs) {
      m.a1 = Maybe(-60, 60);
      m.a2 = by ? Maybe(-20, 20) : Maybe(20, 100);
      m.a5 = Maybe(-50, 50);
    } else if (by) {
      m.x = Maybe(-60, 60);
      m.y = Maybe(-60, 60);
      if (index == 0) m.c = Maybe(-40, 40);
    } else {
      m.x = index == 0 ? Maybe(200, 500) : Maybe(-60, 60);
      m.y = Maybe(-100, 200);
      if (index == 0) m.z = Maybe(-80, 20);
      if (Once(4)) m.a5 = Maybe(-50, 50);
    }
  }
  template <group::Reference kReference>
  group::Command Linear(std::size_t index) {
    group::MoveLinear<kReference> m;
    TakeManner(m);
    TakeTarget(index, kReference == group::Reference::kRelative, m);
    m.buffer_mode = static_cast<axis::BufferMode>(Under(6));
    return m;
  }
  group::Command Circular() {
    group::MoveCircularRelative m{.circ_mode = static_cast<path::CircMode>(Under(3))};
    TakeManner(m);
    m.aux_x = Between(-50, 50);
    m.aux_y = Between(-50, 50);
    m.x = m.circ_mode == path::CircMode::kCenter ? 2 * m.aux_x : Between(-50, 50);
    m.y = m.circ_mode == path::CircMode::kCenter ? 2 * m.aux_y : Between(-50, 50);
    if (m.circ_mode == path::CircMode::kRadius) m.aux_x = m.aux_y = 0, m.aux_z = 80;
    m.path_choice = static_cast<path::PathChoice>(Under(4));
    m.buffer_mode = static_cast<axis::BufferMode>(Under(6));
    return m;
  }
  group::Command Direct(std::size_t index) {
    group::MoveDirectAbsolute m;
    TakeManner(m);
    TakeTarget(index, false, m);
    m.buffer_mode = static_cast<axis::BufferMode>(Under(6));
    return m;
  }
  group::Command Membership() {
    const auto place = static_cast<std::uint32_t>(1 + Under(9));
    switch (Under(8)) {
      case 0:
        return group::UngroupAllAxes{};
      case 1:
      case 2:
        return group::RemoveAxis{place};
      default:
        return group::AddAxis{Axis(), place};
    }
  }
  group::Command Systems() {
    const auto pcs = static_cast<std::uint32_t>(1 + Under(3));
    if (Once(4)) return group::SetKinTransform{.enable = !Once(3)};
    if (Once(2))
      return group::SetCartesianTransform{pcs, Between(-50, 50), Between(-50, 50), 0, 0, 0, Between(-90, 90)};
    group::SetCoordinateTransform m{.pcs = pcs, .x = Between(-20, 20), .c = Between(-30, 30)};
    m.reference = static_cast<group::CoordinateSystem>(Under(4));
    m.reference_pcs = static_cast<std::uint32_t>(1 + Under(3));
    return m;
  }
  group::Command Numbers(std::size_t index) {
    if (Once(2)) return group::SetPosition{.a1 = Between(-20, 20), .a2 = Between(30, 70)};
    group::SetPosition m{.coordinate_system = group::CoordinateSystem::kMcs};
    m.x = index == 0 ? Between(300, 450) : Between(-50, 50);
    m.y = Between(-50, 100);
    return m;
  }

  std::mt19937_64 random_;
};

class RandomGroups {
 public:
  explicit RandomGroups(std::uint64_t seed) : machine_(TwoGroups()), world_(machine_), fancy_(seed) {
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) Give(OfAxis(axis, axis::Power{}));
    Run(200);
    Give(OfAxis(1, axis::SetPosition{.position = 60}));
    Give(OfGroup(0, group::Enable{}));
    Give(OfGroup(1, group::Enable{}));
    Run(5);
  }

  void Go() {
    for (int step = 0; step < 80 && !testing::Test::HasFailure(); ++step) {
      for (auto n = fancy_.Under(4); n > 0; --n) {
        const std::size_t index = fancy_.Under(kGroups);
        Give(OfGroup(index, fancy_.OfGroup(index)), fancy_.Once(8) ? 0.1 : 0);
      }
      if (fancy_.Once(2)) Give(OfAxis(fancy_.Under(machine_.axes.size()), fancy_.OfAxis()));
      if (fancy_.Once(3)) Let();
      if (fancy_.Once(25)) Break();
      if (fancy_.Once(6)) Mend();
      Run(static_cast<int>(fancy_.Under(100)));
    }
  }
  // Whatever the motion, it ends.
  void End() {
    Mend();
    for (const auto& [ticket, life] : lives_) Release(ticket);
    for (std::size_t index = 0; index < kGroups; ++index) {
      Give(OfGroup(index, group::SetOverride{}));
      Give(OfGroup(index, group::Stop{}));
    }
    Run(2500);
    for (std::size_t index = 0; index < kGroups; ++index) Give(OfGroup(index, group::Reset{}));
    Run(1500);
    for (std::size_t index = 0; index < kGroups; ++index) Give(OfGroup(index, group::Disable{}));
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
      Give(OfAxis(axis, axis::Reset{}));
      Give(OfAxis(axis, axis::Stop{}));
    }
    Run(2500);
    for (std::size_t index = 0; index < kGroups; ++index)
      EXPECT_EQ(GroupAt(index).state, GroupState::kDisabled) << index;
    for (const auto& [ticket, life] : lives_) EXPECT_TRUE(life.ended) << "never ended: " << life.what;
  }

  std::map<GroupState, int> seen;

 private:
  struct Life {
    std::string what;
    bool ended = false;
  };

  Command OfAxis(std::size_t axis, const axis::Command& body) const {
    return ToAxis(machine_, machine_.axes[axis].name, body);
  }
  Command OfGroup(std::size_t index, const group::Command& body) const {
    Command command = ToGroup(machine_, body);
    command.target += static_cast<std::uint32_t>(index);
    return command;
  }
  void Give(Command command, double lease_s = 0) {
    command.ticket = next_++;
    command.lease_s = lease_s;
    const CommandText text = ToText(machine_, command);
    lives_[command.ticket].what =
        text.target + "." + text.verb + " " + text.arguments + " in cycle " + std::to_string(world_.cycle.count);
    waiting_.push_back(command);
  }
  void Release(Ticket ticket) {
    Command release;
    release.target = 0;
    release.body = MachineCommand(engine::Release{ticket});
    waiting_.push_back(release);
  }
  void Let() { Release(1 + fancy_.Under(static_cast<std::size_t>(next_))); }
  void Break() {
    plant::ServoFaults& faults = world_.servo_states[fancy_.Under(machine_.axes.size())].faults;
    (fancy_.Once(3) ? faults.encoder_error : fancy_.Once(2) ? faults.stuck : faults.drive_fault) = true;
  }
  void Mend() {
    for (plant::ServoState& servo : world_.servo_states) servo.faults = {};
  }
  const group::State& GroupAt(std::size_t index) const { return world_.group_states[index]; }

  void Run(int cycles) {
    for (; cycles > 0 && !testing::Test::HasFailure(); --cycles) Step();
  }
  void Step() {
    Sense(world_);
    const std::vector<axis::State> before = world_.axis_states;
    for (const Command& command : waiting_) Apply(world_, command);
    waiting_.clear();
    Move(world_);
    Control(world_);
    Actuate(world_);
    for (const FeedbackEvent& event : world_.feedback.events()) Note(event);
    EXPECT_EQ(world_.feedback.lost(), 0u);
    world_.feedback.Clear();
    SCOPED_TRACE(testing::Message() << "cycle " << world_.cycle.count);
    for (std::size_t index = 0; index < kGroups; ++index) LookAt(index, before);
    LookAtMembership();
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) LookAtAxis(axis, before[axis]);
    ++world_.cycle.count;
  }
  void Note(const FeedbackEvent& event) {
    const auto found = lives_.find(event.ticket);
    ASSERT_NE(found, lives_.end()) << event.ticket;
    EXPECT_FALSE(found->second.ended) << "again " << static_cast<int>(event.state) << ": " << found->second.what;
    found->second.ended |= IsFinal(event.state);
    EXPECT_EQ(event.state == FeedbackState::kError, event.error != ErrorId::kNone) << found->second.what;
  }

  // Table 8.1.
  void LookAt(std::size_t index, const std::vector<axis::State>& before) {
    const group::State& g = GroupAt(index);
    SCOPED_TRACE(testing::Message() << machine_.groups[index].name << " in state " << static_cast<int>(g.state));
    ++seen[g.state];
    EXPECT_EQ(g.illegal_transitions, 0u);
    EXPECT_EQ(g.error != ErrorId::kNone, g.state == GroupState::kErrorStop);
    bool failed_before = false;
    for (const std::uint32_t member : g.members) {
      if (member == 0) continue;
      const axis::State& axis = world_.axis_states[member - 1];
      SCOPED_TRACE(machine_.axes[member - 1].name);
      // Faults of this very cycle are seen by the group in the next one; likewise an axis that was switched off by
      // itself.
      const bool fails = axis.plc == PlcState::kErrorStop || !axis.loop_closed;
      failed_before |= before[member - 1].plc == PlcState::kErrorStop && axis.plc == PlcState::kErrorStop;
      const bool still = axis.plc == PlcState::kStandstill || axis.plc == PlcState::kDisabled;
      switch (g.state) {
        case GroupState::kDisabled:
          EXPECT_FALSE(g.guides);
          break;
        case GroupState::kStandby:
          EXPECT_TRUE(still || fails) << static_cast<int>(axis.plc);
          EXPECT_FALSE(g.guides);
          break;
        case GroupState::kMoving:
          EXPECT_TRUE(!g.begun || fails || axis.plc == PlcState::kSynchronizedMotion) << static_cast<int>(axis.plc);
          EXPECT_TRUE(g.begun || still || fails || axis.plc == PlcState::kSynchronizedMotion)
              << static_cast<int>(axis.plc);
          break;
        case GroupState::kStopping:
          EXPECT_TRUE(!g.begun || fails || axis.plc == PlcState::kSynchronizedMotion) << static_cast<int>(axis.plc);
          break;
        case GroupState::kHoming:
          EXPECT_TRUE(still || fails || axis.plc == PlcState::kHoming || axis.plc == PlcState::kStopping)
              << static_cast<int>(axis.plc);
          break;
        case GroupState::kErrorStop:
          break;
      }
    }
    EXPECT_TRUE(!failed_before || g.state == GroupState::kDisabled || g.state == GroupState::kErrorStop);
  }
  void LookAtMembership() {
    std::vector<std::uint32_t> groups(machine_.axes.size());
    for (std::size_t index = 0; index < kGroups; ++index) {
      for (const std::uint32_t member : GroupAt(index).members) {
        if (member == 0) continue;
        EXPECT_EQ(groups[member - 1], 0u) << machine_.axes[member - 1].name << " is in two groups";
        groups[member - 1] = static_cast<std::uint32_t>(index + 1);
      }
    }
    EXPECT_EQ(groups, world_.group_of);
  }
  void LookAtAxis(std::size_t index, const axis::State& before) {
    const axis::State& now = world_.axis_states[index];
    if (!before.loop_closed || !now.loop_closed) return;
    const axis::AxisLimits& limits = machine_.axes[index].limits;
    SCOPED_TRACE(machine_.axes[index].name);
    const double period = world_.cycle.period_s;
    const KinematicState &a = before.setpoint, &b = now.setpoint;
    EXPECT_LE(std::abs(b.velocity), limits.velocity * (1 + 1e-9));
    EXPECT_LE(std::abs(b.acceleration), limits.acceleration * (1 + 1e-9));
    EXPECT_LE(std::abs(b.acceleration - a.acceleration), limits.jerk * period * (1 + 1e-6));
    const double step = b.position + now.origin - a.position - before.origin;  // a new origin is no motion
    // The effect of a jerk that changes within the cycle.
    const double inside = limits.jerk * period * period * period / 6;
    EXPECT_NEAR(step,
                0.5 * period * (a.velocity + b.velocity) - period * period / 12 * (b.acceleration - a.acceleration),
                1e-5 + inside);
  }

  Machine machine_;
  World world_;
  Fancy fancy_;
  std::vector<Command> waiting_;
  std::map<Ticket, Life> lives_;
  Ticket next_ = 1;
};

TEST(TwoGroups, RandomWalk) {
  std::map<GroupState, int> seen;
  const auto seeds = static_cast<std::uint64_t>(Trials(40, 75));
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomGroups walk(seed);
    walk.Go();
    if (!testing::Test::HasFailure()) walk.End();
    for (const auto& [state, cycles] : walk.seen) seen[state] += cycles;
    if (testing::Test::HasFailure()) return;
  }
  for (int state = 0; state < group::kGroupStates; ++state) {
    EXPECT_GT(seen[static_cast<GroupState>(state)], Trials(60, 75)) << state;
  }
}

}  // namespace
}  // namespace takt::engine

#pragma GCC diagnostic pop
