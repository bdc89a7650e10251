// Homing on a simulated axis: AX-60 to AX-71. The expectations are those of tables 7.1 and 7.2 of the GT-775x manual,
// written down here anew.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "takt/axis/axis.h"
#include "takt/plant/servo.h"

namespace takt::axis {
namespace {

constexpr double kUnset = 1e9;

// A linear axis of 200 mm: LIM- on up to -100, LIM+ on from 100, REF on from 10 to 30, NI every 10 mm at ...3.
class Bench {
 public:
  explicit Bench(double start) {
    params.name = "x";
    params.limits = {
        .velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000, .lower = {}, .upper = {}};
    params.encoder.increments_per_unit = 10000;
    servo.encoder.increments_per_unit = 10000;
    servo.encoder.index_distance = 10;
    servo.encoder.index_offset = 3;
    servo.drive.power_up_s = 0.01;
    servo.mechanics.start_position = start;
    servo.switches.limit_negative.to = -100;
    servo.switches.limit_positive.from = 100;
    servo.switches.reference.from = 10;
    servo.switches.reference.to = 30;
  }
  // The machine begins to count where it stands: the place `x` of the plant is the position x - start.
  void On() {
    plant = plant::MakeServoState(servo);
    plant::Step(servo, out, cycle.period_s, plant, in);
    state = MakeState(params);
    state.encoder = {};
    Give(Power{});
    Run(0.1);
    ASSERT_TRUE(state.loop_closed);
  }
  Ticket Give(const Command& command) {
    const Ticket ticket = next++;
    pending.push_back({ticket, command});
    return ticket;
  }
  void Step() {
    Context c{params, cycle, planner, sink};
    Sense(c, in, state);
    for (const auto& [ticket, command] : pending) Apply(c, ticket, 0, command, state);
    pending.clear();
    const KinematicState before = state.setpoint;
    const double shift = state.origin;
    Move(c, state);
    Control(c, state, out);
    Publish(params, state, seen);
    plant::Step(servo, out, cycle.period_s, plant, in);
    for (const FeedbackEvent& e : sink.events()) last[e.ticket] = e;
    sink.Clear();
    ++cycle.count;
    if (!state.loop_closed) return;
    const trajectory::Limits own = params.planner_limits();
    EXPECT_LE(std::abs(state.setpoint.velocity), own.velocity * (1 + 1e-9));
    EXPECT_LE(std::abs(state.setpoint.acceleration), own.acceleration * (1 + 1e-9));
    EXPECT_LE(std::abs(state.setpoint.acceleration - before.acceleration),
              own.jerk * cycle.period_s * (1 + 1e-6) + 1e-6);
    const double step = state.setpoint.position + state.origin - before.position - shift;
    EXPECT_NEAR(step, 0.5 * cycle.period_s * (before.velocity + state.setpoint.velocity), own.jerk * 1e-9);
    EXPECT_EQ(state.illegal_transitions, 0u);
  }
  void Run(double seconds) {
    for (double t = 0; t < seconds; t += cycle.period_s) Step();
  }
  bool RunToEnd(Ticket ticket, double seconds = 60) {
    for (double t = 0; t < seconds && !(IsFinal(last[ticket].state) && last[ticket].ticket); t += cycle.period_s)
      Step();
    return IsFinal(last[ticket].state) && last[ticket].ticket;
  }
  double place() const { return plant.load_position; }

  AxisParams params;
  plant::ServoParams servo;
  plant::ServoState plant;
  ServoInputs in;
  ServoOutputs out;
  Cycle cycle{1, 0.001};
  trajectory::Planner planner;
  State state;
  Outputs seen;
  std::array<FeedbackEvent, 256> storage;
  FeedbackSink sink{storage};
  std::map<Ticket, FeedbackEvent> last;
  std::vector<std::pair<Ticket, Command>> pending;
  Ticket next = 1;
};

// Where a search for REF ends by the tables, from `start`: an idealised axis that turns on the spot.
double Expected(HomingDirection direction, SwitchMode mode, double start) {
  const auto on = [](double x) { return x >= 10 && x <= 30; };
  double sense = 1;
  if (direction == HomingDirection::kNegative) sense = -1;
  if (direction == HomingDirection::kSwitchPositive) sense = on(start) ? -1 : 1;
  if (direction == HomingDirection::kSwitchNegative) sense = on(start) ? 1 : -1;
  if (sense > 0 ? start >= 100 : start <= -100) sense = -sense;
  if (mode == SwitchMode::kOn && on(start)) return start;
  if (mode == SwitchMode::kOff && !on(start)) return start;
  double x = start;
  for (int i = 0; i < 100000; ++i) {
    const double next = x + sense * 0.01;
    const bool rises = !on(x) && on(next);
    const bool falls = on(x) && !on(next);
    x = next;
    switch (mode) {
      case SwitchMode::kOn:
        if (on(x)) return x;
        break;
      case SwitchMode::kOff:
        if (!on(x)) return x;
        break;
      case SwitchMode::kEdgeOn:
        if (rises) return x;
        if (falls) sense = -sense;
        break;
      case SwitchMode::kEdgeOff:
        if (falls) return x;
        if (rises) sense = -sense;
        break;
      case SwitchMode::kEdgeSwitchPositive:
        if (sense > 0 ? rises : falls) return x;
        break;
      case SwitchMode::kEdgeSwitchNegative:
        if (sense < 0 ? rises : falls) return x;
        break;
    }
    if (sense > 0 ? x >= 100 : x <= -100) sense = -sense;
  }
  return kUnset;
}

struct Case {
  HomingDirection direction;
  SwitchMode mode;
  double start;
};

class AbsSwitch : public testing::TestWithParam<Case> {};

// AX-60, AX-69: from before, on and behind the switch and from both limits, in all directions and modes: found where
// the tables say, returned there, still in Homing.
TEST_P(AbsSwitch, IsFoundWhereTheTablesSay) {
  const Case& p = GetParam();
  Bench bench(p.start);
  bench.On();
  StepAbsSwitch step;
  step.direction = p.direction;
  step.switch_mode = p.mode;
  step.velocity = 40;
  step.set_position = 1000;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_EQ(bench.state.plc, PlcState::kHoming);
  EXPECT_FALSE(bench.seen.homed);
  // The switch is sampled once a cycle, and braking to turn round changes from where an edge is met by nothing.
  EXPECT_NEAR(bench.place(), Expected(p.direction, p.mode, p.start), 40 * 0.001 + 0.015);
  EXPECT_NEAR(bench.seen.set_position, 1000, 1e-9);
  const Ticket finish = bench.Give(FinishHoming{});
  ASSERT_TRUE(bench.RunToEnd(finish, 1));
  EXPECT_EQ(bench.last[finish].state, FeedbackState::kDone);
  EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
  EXPECT_TRUE(bench.seen.homed);
}

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  for (int direction = 0; direction < 4; ++direction) {
    for (int mode = 0; mode < 6; ++mode) {
      for (const double start : {-100.5, -50.0, 20.0, 60.0, 100.5}) {
        cases.push_back({static_cast<HomingDirection>(direction), static_cast<SwitchMode>(mode), start});
      }
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Tables, AbsSwitch, testing::ValuesIn(AllCases()), [](const auto& info) {
  return "d" + std::to_string(static_cast<int>(info.param.direction)) + "m" +
         std::to_string(static_cast<int>(info.param.mode)) + "i" + std::to_string(info.index % 5);
});

// AX-61: a limit switch, from anywhere, is no fault while it is searched; the axis ends on its edge.
TEST(LimitSwitch, IsFoundOnItsSide) {
  for (const HomingDirection direction : {HomingDirection::kPositive, HomingDirection::kNegative}) {
    for (const SwitchMode mode : {SwitchMode::kEdgeOn, SwitchMode::kEdgeOff, SwitchMode::kOn}) {
      for (const double start : {-100.5, -20.0, 100.5}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(direction) << " " << static_cast<int>(mode) << " "
                                        << start);
        Bench bench(start);
        bench.On();
        StepLimitSwitch step;
        step.direction = direction;
        step.switch_mode = mode;
        step.velocity = 50;
        step.set_position = 0;
        const Ticket ticket = bench.Give(step);
        ASSERT_TRUE(bench.RunToEnd(ticket));
        EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
        EXPECT_EQ(bench.state.plc, PlcState::kHoming);
        const double edge = direction == HomingDirection::kPositive ? 100 : -100;
        const bool at_once = mode == SwitchMode::kOn && start * edge > 0 && std::abs(start) > 100;
        EXPECT_NEAR(bench.place(), at_once ? start : edge, 0.07);
        EXPECT_EQ(bench.seen.error, ErrorId::kNone);
      }
    }
  }
}

// AX-63: the position of the index edge itself, to a count; the axis stops behind it and does not return.
TEST(RefPulse, IsTheEdgeItself) {
  for (const double start : {-46.0, 0.5, 2.9}) {
    for (const HomingDirection direction : {HomingDirection::kPositive, HomingDirection::kNegative}) {
      Bench bench(start);
      bench.On();
      StepRefPulse step;
      step.direction = direction;
      step.velocity = 20;
      step.set_position = 500;
      const Ticket ticket = bench.Give(step);
      ASSERT_TRUE(bench.RunToEnd(ticket));
      EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
      EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
      EXPECT_TRUE(bench.seen.homed);
      bench.Run(0.1);
      const double up = 3 + 10 * std::ceil((start - 3) / 10);
      const double pulse = direction == HomingDirection::kPositive ? up : up - 10;
      EXPECT_NEAR(bench.seen.actual_position - 500, bench.place() - pulse, 0.0003);
      EXPECT_GT(std::abs(bench.place() - pulse), 0.01);
    }
  }
}

// AX-62: held up at an end stop; the set point goes back to where the axis stands.
TEST(Block, IsFoundByTheLag) {
  Bench bench(-40);
  bench.params.supervision.deviation_moving = 3;
  bench.servo.mechanics.lower_stop = -60;
  bench.servo.drive.max_torque = 2;
  bench.On();
  StepBlock step;
  step.velocity = 20;
  step.deviation = 1;
  step.set_position = -5;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone) << static_cast<int>(bench.last[ticket].error);
  bench.Run(0.2);
  EXPECT_NEAR(bench.place(), -60, 0.05);
  EXPECT_NEAR(bench.seen.actual_position, -5, 0.05);
  EXPECT_NEAR(bench.seen.following_error, 0, 0.05);
  step.deviation = 4;  // beyond what is supervised
  const Ticket too_much = bench.Give(step);
  bench.Run(0.01);
  EXPECT_EQ(bench.last[too_much].error, ErrorId::kParameter);
}

// AX-64, AX-65, AX-71.
TEST(Reference, IsTakenOnTheSpotAndIsNeeded) {
  Bench bench(7);
  bench.params.requires_reference = true;
  bench.On();
  const Ticket early = bench.Give(MoveAbsolute{.position = 1});
  const Ticket relative = bench.Give(MoveRelative{.distance = 1});
  ASSERT_TRUE(bench.RunToEnd(relative));
  EXPECT_EQ(bench.last[early].error, ErrorId::kNoReference);
  EXPECT_EQ(bench.last[relative].state, FeedbackState::kDone);
  const Ticket absolute = bench.Give(StepAbsolute{});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[absolute].error, ErrorId::kState);  // no absolute encoder
  const Ticket direct = bench.Give(StepDirect{.set_position = 50});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[direct].state, FeedbackState::kDone);
  EXPECT_EQ(bench.seen.set_position, 50);
  EXPECT_TRUE(bench.seen.homed);
  ASSERT_TRUE(bench.RunToEnd(bench.Give(MoveAbsolute{.position = 48})));
  bench.Run(0.1);
  EXPECT_NEAR(bench.place(), 6, 0.001);
  bench.plant.faults.encoder_error = true;  // a lost signal loses the reference
  bench.Run(0.01);
  EXPECT_FALSE(bench.seen.homed);
}

TEST(Reference, ComesFromAnAbsoluteEncoder) {  // AX-65
  Bench bench(7);
  bench.params.encoder.type = EncoderType::kAbsoluteSsi;
  bench.params.requires_reference = true;
  bench.servo.encoder.type = plant::ServoEncoderType::kAbsolute;
  bench.On();
  EXPECT_TRUE(bench.seen.homed);
  EXPECT_NEAR(bench.seen.actual_position, 7, 0.001);
  bench.Give(SetPosition{.position = 100});
  const Ticket step = bench.Give(StepAbsolute{});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[step].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.seen.set_position, 7, 0.001);
}

// AX-66: moves off, and ends homing; not without a step before.
TEST(FinishHoming, MovesOff) {
  Bench bench(0);
  bench.On();
  const Ticket early = bench.Give(FinishHoming{});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[early].error, ErrorId::kState);
  StepAbsSwitch step;
  step.direction = HomingDirection::kPositive;
  step.velocity = 50;
  step.set_position = 0;
  bench.Give(step);
  FinishHoming finish;
  finish.distance = -5;
  finish.velocity = 10;
  finish.buffer_mode = BufferMode::kBuffered;
  const Ticket ticket = bench.Give(finish);
  const Ticket move = bench.Give(MoveAbsolute{.position = 1, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_NEAR(bench.seen.set_position, -5, 1e-6);
  EXPECT_NEAR(bench.place(), 5, 0.1);
  ASSERT_TRUE(bench.RunToEnd(move));
  EXPECT_EQ(bench.last[move].state, FeedbackState::kDone);
}

// AX-70: limits of time and way, of a search that finds nothing, too.
TEST(Search, EndsInTime) {
  for (const double time : {0.0, 0.5}) {
    Bench bench(-50);
    bench.servo.switches.reference = {};
    bench.On();
    StepAbsSwitch step;
    step.direction = HomingDirection::kPositive;
    step.velocity = 20;
    step.time_limit = time;
    step.distance_limit = time > 0 ? 0 : 12;
    const Ticket ticket = bench.Give(step);
    ASSERT_TRUE(bench.RunToEnd(ticket));
    EXPECT_EQ(bench.last[ticket].error, time > 0 ? ErrorId::kTimeLimit : ErrorId::kDistanceLimit);
    bench.Run(0.2);
    EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
    EXPECT_FALSE(bench.seen.homed);
    EXPECT_NEAR(bench.place(), time > 0 ? -40 : -38, 0.6);
    step.time_limit = step.distance_limit = 0;
    step.velocity = 200;
    const Ticket nothing = bench.Give(step);
    ASSERT_TRUE(bench.RunToEnd(nothing));
    EXPECT_EQ(bench.last[nothing].error, ErrorId::kDistanceLimit);
  }
}

// Stop, power off and a fault in the middle; nothing else gets in.
TEST(Search, IsInterrupted) {
  for (int how = 0; how < 4; ++how) {
    SCOPED_TRACE(how);
    Bench bench(-50);
    bench.On();
    StepAbsSwitch step;
    step.velocity = 50;
    step.direction = HomingDirection::kPositive;
    const Ticket ticket = bench.Give(step);
    bench.Run(0.3);
    const Ticket move = bench.Give(MoveRelative{.distance = 1});
    const Ticket jog = bench.Give(Jog{.forward = true});
    const Ticket again = bench.Give(step);
    bench.Run(0.01);
    for (const Ticket other : {move, jog, again}) EXPECT_EQ(bench.last[other].error, ErrorId::kState);
    EXPECT_EQ(bench.last[ticket].state, FeedbackState::kActive);
    if (how == 0) bench.Give(Stop{});
    if (how == 1) bench.Give(Power{.enable = false});
    if (how == 2) bench.plant.faults.drive_fault = true;
    if (how == 3) bench.plant.faults.encoder_error = true;
    bench.Run(0.5);
    EXPECT_EQ(bench.last[ticket].state, how < 2 ? FeedbackState::kAborted : FeedbackState::kError);
    const PlcState expected[] = {PlcState::kStandstill, PlcState::kDisabled, PlcState::kErrorStop,
                                 PlcState::kErrorStop};
    EXPECT_EQ(bench.state.plc, expected[how]);
    EXPECT_FALSE(bench.seen.homed);
    EXPECT_EQ(bench.state.homing.stage, HomingStage::kNone);
  }
}

// AX-67, AX-68: in passing; the motion goes on to where it went.
TEST(Flying, TakesTheReferenceInPassing) {
  for (const bool pulse : {false, true}) {
    Bench bench(-5);
    bench.On();
    const Ticket move = bench.Give(MoveRelative{.distance = 60, .velocity = 100});
    StepRefFlyingSwitch by_switch;
    by_switch.set_position = 200;
    StepRefFlyingRefPulse by_pulse;
    by_pulse.set_position = 200;
    const Ticket reference = pulse ? bench.Give(by_pulse) : bench.Give(by_switch);
    ASSERT_TRUE(bench.RunToEnd(move));
    EXPECT_EQ(bench.last[move].state, FeedbackState::kDone);
    EXPECT_EQ(bench.last[reference].state, FeedbackState::kDone);
    EXPECT_TRUE(bench.seen.homed);
    bench.Run(0.1);
    EXPECT_NEAR(bench.place(), 55, 0.001);
    EXPECT_NEAR(bench.seen.actual_position - 200, bench.place() - (pulse ? 3 : 10), pulse ? 0.0003 : 0.11);
  }
}

TEST(Flying, GivesUp) {
  Bench bench(40);
  bench.On();
  bench.Give(MoveRelative{.distance = 50, .velocity = 50});
  StepRefFlyingSwitch step;
  step.distance_limit = 20;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].error, ErrorId::kDistanceLimit);
  EXPECT_EQ(bench.state.plc, PlcState::kDiscreteMotion);
}

}  // namespace
}  // namespace takt::axis
