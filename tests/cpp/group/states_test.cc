// GR-01: states of groups, and of their members in each of them.
#include <random>

#include "../core/trials.h"
#include "machines.h"
#include "watch.h"

// GCC 12 takes optionals that go into a variant for uninitialised.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

namespace takt::group {
namespace {

using axis::PlcState;

bool All(const Rig& rig, PlcState state) {
  return std::ranges::all_of(rig.states, [&](const axis::State& member) { return member.plc == state; });
}

// GR-01: standby, moving and back; table 8.1: members stand still, are in synchronised motion, stand still.
TEST(States, OfAMove) {
  Rig rig = Gantry();
  EXPECT_EQ(rig.state.state, GroupState::kDisabled);
  rig.Start();
  EXPECT_EQ(rig.state.state, GroupState::kStandby);
  EXPECT_TRUE(All(rig, PlcState::kStandstill));
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Step();
  EXPECT_EQ(rig.out().state, GroupState::kMoving);
  while (!rig.lives[move].ended()) {
    rig.Step();
    EXPECT_TRUE(rig.lives[move].ended() || !rig.state.begun || All(rig, PlcState::kSynchronizedMotion));
  }
  rig.Step();
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_TRUE(rig.out().in_position);
  EXPECT_TRUE(All(rig, PlcState::kStandstill));
}

// GR-01, note 3 and table 8.1: stopping in synchronised motion; done at rest, standby only once released.
TEST(States, OfAStop) {
  Rig rig = Gantry();
  rig.Start();
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 500, .y = 200});
  rig.Run(0.2);
  const Ticket stop = rig.Give(Stop{.hold = true});
  rig.Step();
  EXPECT_EQ(rig.out().state, GroupState::kStopping);
  EXPECT_TRUE(All(rig, PlcState::kSynchronizedMotion));
  EXPECT_TRUE(rig.lives[move].aborted);
  ASSERT_TRUE(rig.RunToEnd(stop, 2));
  EXPECT_TRUE(rig.lives[stop].done);
  rig.Run(0.1);
  EXPECT_EQ(rig.out().state, GroupState::kStopping);
  EXPECT_TRUE(All(rig, PlcState::kStandstill));
  const Ticket refused = rig.Give(MoveLinearAbsolute{.x = 0});
  ASSERT_TRUE(rig.RunToEnd(refused, 0.1));
  EXPECT_EQ(rig.lives[refused].error_id, ErrorId::kAxisStopping);
  rig.Let(stop);
  rig.Step();
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_LE(WorstFromLine(rig, KDL::Vector::Zero(), KDL::Vector(500, 200, 0)), 1e-6);
  ExpectSmooth(rig);
}

TEST(States, OfAHalt) {
  Rig rig = Gantry();
  rig.Start();
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 500});
  rig.Run(0.2);
  const Ticket halt = rig.Give(Halt{});
  rig.Step();
  EXPECT_EQ(rig.out().state, GroupState::kMoving);
  EXPECT_TRUE(rig.lives[move].aborted);
  ASSERT_TRUE(rig.RunToEnd(halt, 2));
  EXPECT_TRUE(rig.lives[halt].done);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  ExpectSmooth(rig);
}

// GR-01, note 4: disabled from every state but ErrorStop.
// GR-20: a halt brakes with its own deceleration and jerk, on the way of an S-curve: v²/2d + v d/2j.
TEST(States, BrakingHasItsOwnLimits) {
  for (const auto& halt : {Halt{.deceleration = 3000}, Halt{.deceleration = 3000, .jerk = 40000}}) {
    Rig rig = Gantry();
    rig.Start();
    rig.Give(MoveLinearAbsolute{.x = 1000, .velocity = 500});
    rig.Run(0.5);
    const double from = rig.trace.back().set[0].position;
    EXPECT_NEAR(rig.trace.back().set[0].velocity, 500, 1e-6);
    const double jerk = halt.jerk.value_or(rig.params.path.jerk);
    ASSERT_TRUE(rig.RunToEnd(rig.Give(halt), 5));
    const double way = 500.0 * 500 / (2 * 3000) + 500 * 3000 / (2 * jerk);
    EXPECT_NEAR(rig.trace.back().set[0].position - from, way, 500 * 0.003);  // some cycles at 500 mm/s
    double most = 0;
    for (std::size_t i = 1; i < rig.trace.size(); ++i) {
      if (rig.trace[i].set[0].position <= from) continue;
      const double change = rig.trace[i].set[0].acceleration - rig.trace[i - 1].set[0].acceleration;
      most = std::max(most, std::abs(change) / rig.cycle.period_s);
    }
    EXPECT_LE(most, jerk * (1 + 1e-6));
    EXPECT_GE(most, 0.9 * jerk);
  }
}

TEST(States, OfDisabling) {
  for (const double after : {0.0, 0.05, 0.2, 0.5}) {
    Rig rig = Gantry();
    rig.Start();
    const Ticket move = rig.Give(MoveLinearAbsolute{.x = 500});
    rig.Run(after);
    const Ticket disable = rig.Give(Disable{});
    rig.Step();
    EXPECT_TRUE(rig.lives[disable].done);
    EXPECT_EQ(rig.out().state, GroupState::kDisabled);
    rig.Run(1);
    EXPECT_TRUE(rig.lives[move].ended());
    EXPECT_TRUE(All(rig, PlcState::kStandstill)) << after;
    ExpectSmooth(rig);
    const Ticket refused = rig.Give(MoveLinearAbsolute{.x = 0});
    ASSERT_TRUE(rig.RunToEnd(refused, 0.1));
    EXPECT_EQ(rig.lives[refused].error_id, ErrorId::kGroupDisabled);
  }
}

// GR-01, note 2: in ErrorStop nothing but a reset.
TEST(States, OfErrors) {
  Rig rig = Gantry();
  rig.Start();
  rig.inputs[1].drive_fault = true;
  rig.Run(0.01);
  EXPECT_EQ(rig.out().state, GroupState::kErrorStop);
  EXPECT_EQ(rig.out().error, ErrorId::kDrive);
  for (const Command& command : std::vector<Command>{MoveLinearAbsolute{.x = 1}, Halt{}, Stop{}, Disable{}, Enable{},
                                                     UngroupAllAxes{}, AddAxis{Name::Of("x"), 4}, RemoveAxis{1}}) {
    const Ticket ticket = rig.Give(command);
    ASSERT_TRUE(rig.RunToEnd(ticket, 0.1));
    EXPECT_TRUE(rig.lives[ticket].error) << command.index();
  }
  rig.inputs[1].drive_fault = false;
  const Ticket reset = rig.Give(Reset{});
  ASSERT_TRUE(rig.RunToEnd(reset, 2));
  EXPECT_TRUE(rig.lives[reset].done);
  EXPECT_EQ(rig.out().state, GroupState::kStandby);
  EXPECT_EQ(rig.out().error, ErrorId::kNone);
}

std::optional<double> Maybe(std::mt19937_64& random, double low, double high) {
  if (random() % 3 == 0) return std::nullopt;
  return Uniform(random, low, high);
}

// Any command, sensible or not.
Command AnyCommand(std::mt19937_64& random) {
  const auto n = [&](auto count) { return static_cast<decltype(count)>(random() % static_cast<unsigned>(count)); };
  const auto system = static_cast<CoordinateSystem>(n(4));
  const auto buffer = static_cast<BufferMode>(n(6));
  const auto transition = static_cast<TransitionMode>(n(5));
  const double parameter = Uniform(random, 0, 60);
  const auto place = [&] { return Maybe(random, -250, 250); };
  const auto speed = [&] { return random() % 2 ? std::optional<double>{} : Uniform(random, 5, 1500); };
  const auto ramp = [&] { return random() % 2 ? std::optional<double>{} : Uniform(random, 200, 20000); };
  switch (random() % 24) {
    case 0:
    case 1:
    case 2:
    case 3: {
      MoveLinearAbsolute m;
      const bool of_axes = system == CoordinateSystem::kAcs && random() % 4;
      (of_axes ? m.a1 : m.x) = place();
      (of_axes ? m.a2 : m.y) = place();
      (of_axes ? m.a3 : m.z) = place();
      m.coordinate_system = system;
      m.velocity = speed();
      m.acceleration = ramp();
      m.buffer_mode = buffer;
      m.transition_mode = transition;
      m.transition_parameter = parameter;
      return m;
    }
    case 4:
    case 5:
    case 6: {
      MoveLinearRelative m;
      m.x = Maybe(random, -60, 60);
      m.y = Maybe(random, -60, 60);
      m.velocity = speed();
      m.buffer_mode = buffer;
      m.transition_mode = transition;
      m.transition_parameter = parameter;
      return m;
    }
    case 7:
    case 8: {
      MoveCircularRelative m{.circ_mode = static_cast<path::CircMode>(n(3))};
      m.aux_x = Uniform(random, -80, 80);
      m.aux_y = Uniform(random, -80, 80);
      m.x = m.circ_mode == path::CircMode::kCenter ? 2 * m.aux_x : Uniform(random, -80, 80);
      m.y = m.circ_mode == path::CircMode::kCenter ? 2 * m.aux_y : Uniform(random, -80, 80);
      if (m.circ_mode == path::CircMode::kRadius) m.aux_x = m.aux_y = 0, m.aux_z = 120;
      m.path_choice = static_cast<path::PathChoice>(n(4));
      m.buffer_mode = buffer;
      m.transition_mode = transition;
      m.transition_parameter = parameter;
      return m;
    }
    case 9:
    case 10:
      return MoveDirectAbsolute{.a1 = place(),
                                .a2 = place(),
                                .velocity_factor = Uniform(random, 0.1, 1),
                                .buffer_mode = buffer,
                                .transition_mode = transition,
                                .transition_parameter = parameter};
    case 11:
      return Stop{.deceleration = ramp(), .hold = random() % 2 == 0};
    case 12:
      return Halt{.deceleration = ramp()};
    case 13:
      return Interrupt{.deceleration = ramp()};
    case 14:
    case 15:
      return Continue{};
    case 16:
      if (random() % 4) return SetOverride{.velocity_factor = random() % 4 ? Uniform(random, 0, 1.5) : 0};
      return AddAxis{Name::Of("z"), 3};
    case 17:
      if (random() % 4) return SetOverride{};
      return random() % 2 ? Command{RemoveAxis{3}} : Command{UngroupAllAxes{}};
    case 18:
      return random() % 3 ? Command{Enable{}} : Command{Disable{}};
    case 19:
      return Enable{};
    case 20:
      return Reset{};
    case 21:
      return Power{.enable = random() % 4 != 0};
    case 22:
      if (random() % 2) return SetPosition{.a1 = Uniform(random, -50, 50)};
      return SetKinTransform{.enable = random() % 4 != 0};
    default:
      return random() % 3 ? Command{SetCartesianTransform{1 + n(16u), parameter, 5, 0, 0, 0, parameter}}
                          : Command{Home{}};
  }
}

class RandomWalk {
 public:
  explicit RandomWalk(std::uint64_t seed) : random_(seed), rig_(Gantry()) {
    for (axis::AxisParams& p : rig_.axes) p.supervision.deviation_moving = 5;
    rig_.Start();
  }
  void Go() {
    for (int step = 0; step < 60; ++step) {
      for (auto n = random_() % 4; n > 0; --n) tickets_.push_back(rig_.Give(AnyCommand(random_)));
      if (random_() % 3 == 0 && !tickets_.empty()) rig_.Let(tickets_[random_() % tickets_.size()]);
      ServoInputs& inputs = rig_.inputs[random_() % 3];
      const auto fault = random_() % 60;
      if (fault == 0) inputs.drive_fault = true;
      if (fault == 1) inputs.limit_positive = true;
      if (fault == 2) inputs.limit_negative = true;
      if (fault == 3) slipping_ = random_() % 3;
      if (fault > 50) Mend();
      for (auto n = random_() % 120; n > 0; --n) Step();
      if (testing::Test::HasFailure()) return;
    }
  }
  // Whatever it was, it ends.
  void End() {
    Mend();
    for (const Ticket ticket : tickets_) rig_.Let(ticket);
    tickets_.push_back(rig_.Give(SetOverride{}));
    tickets_.push_back(rig_.Give(Stop{}));
    for (int i = 0; i < 2000; ++i) Step();
    tickets_.push_back(rig_.Give(Reset{}));
    for (int i = 0; i < 1000; ++i) Step();
    tickets_.push_back(rig_.Give(Disable{}));
    for (int i = 0; i < 1000; ++i) Step();
    EXPECT_EQ(rig_.state.state, GroupState::kDisabled);
    for (const Ticket ticket : tickets_) EXPECT_TRUE(rig_.lives[ticket].ended()) << ticket;
  }

 private:
  void Mend() {
    slipping_.reset();
    for (ServoInputs& inputs : rig_.inputs) {
      inputs.drive_fault = inputs.limit_positive = inputs.limit_negative = false;
    }
  }
  void Step() {
    const std::vector<axis::State> before = rig_.states;
    if (slipping_) rig_.slip_counts[*slipping_] += 0.5e6;
    rig_.Step();
    if (rig_.trace.size() > 10) rig_.trace.erase(rig_.trace.begin(), rig_.trace.end() - 2);
    EXPECT_EQ(rig_.state.illegal_transitions, 0U);
    Use use;
    bool members_stand = true;
    for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
      const axis::State& now = rig_.states[i];
      if (rig_.group_of[i] == 1) {
        // A fault of this very cycle the group sees in the next.
        const bool fails = now.plc == PlcState::kErrorStop && before[i].plc != PlcState::kErrorStop;
        members_stand &= now.plc == PlcState::kStandstill || now.plc == PlcState::kDisabled || fails;
        if (rig_.state.guides && rig_.state.state == GroupState::kMoving && !fails) {
          EXPECT_EQ(now.plc, PlcState::kSynchronizedMotion);
        }
      }
      if (!before[i].loop_closed || !now.loop_closed) continue;
      KinematicState a = before[i].setpoint, b = now.setpoint;
      a.position += before[i].origin;  // other numbers are no motion
      b.position += now.origin;
      Take(a, b, rig_.axes[i].limits, rig_.cycle.period_s, use);
    }
    EXPECT_TRUE(members_stand || rig_.state.state != GroupState::kStandby || rig_.state.task == Task::kPower);
    EXPECT_LE(use.velocity, 1 + 1e-9);
    EXPECT_LE(use.acceleration, 1 + 1e-9);
    EXPECT_LE(use.jerk, 1 + 1e-6);
    EXPECT_LE(use.step, 1e-4);
  }

  std::mt19937_64 random_;
  Rig rig_;
  std::vector<Ticket> tickets_;
  std::optional<std::size_t> slipping_;  // its encoder shows more and more
};

// GR-01: whatever is commanded in whatever state, and whatever breaks: no transition outside the table, members are as
// the group's state says, every axis keeps its limits and never jumps, and every command ends once.
TEST(States, RandomWalk) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(Trials(300)); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomWalk walk(seed);
    walk.Go();
    if (!testing::Test::HasFailure()) walk.End();
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace takt::group

#pragma GCC diagnostic pop
