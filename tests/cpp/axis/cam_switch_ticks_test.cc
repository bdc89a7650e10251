// No tick is lost or doubled: each passage of the edge at which a range is entered counts once, at any speed, across
// the modulo point, wherever the axis turns round and whatever its positions are called.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "cam_switch_ways.h"
#include "rig.h"

namespace takt::axis {
namespace {

using Count = std::int64_t;  // positions in eighths of a unit: what is compared is exact

Count FloorDivide(Count a, Count b) {
  return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}
Count Rest(Count a, Count b) {
  return a - b * FloorDivide(a, b);
}

struct Range {
  Count first = 0, last = 0;
  CamDirection direction = CamDirection::kBoth;
  Count cycles = 0;  // time mode; 0: position mode
};

// How often a place is passed from `from` to `to`: it is when the way ends there, not when it begins there.
Count Passages(Count place, Count from, Count to, Count turn) {
  const Count up = to >= from ? 1 : -1;
  const Count a = up * (from - place), b = up * (to - place);
  if (turn == 0) return a < 0 && b >= 0 ? 1 : 0;
  return FloorDivide(b, turn) - FloorDivide(a, turn);
}

bool Runs(const Range& range, Count sense) {
  return range.direction == CamDirection::kBoth || (range.direction == CamDirection::kPositive) == (sense > 0);
}

bool Passes(const Range& range, Count from, Count to, Count turn) {
  const Count sense = to > from ? 1 : -1;
  return Runs(range, sense) && Passages(sense > 0 ? range.first : range.last, from, to, turn) > 0;
}

bool Contains(const Range& range, Count at, Count sense, Count turn) {
  if (!Runs(range, sense)) return false;
  if (turn == 0) return at >= range.first && at <= range.last;
  const Count width = range.last - range.first;
  return Rest(at - range.first, turn) <= (width < 0 ? width + turn : width);
}

CamSwitch SwitchOf(const Range& r, int track) {
  CamSwitch out{track, static_cast<double>(r.first) / 8, static_cast<double>(r.last) / 8, r.direction};
  if (r.cycles == 0) return out;
  out.mode = CamSwitchMode::kTime;
  out.duration_s = static_cast<double>(r.cycles) * 0.001;
  return out;
}

class Walk {
 public:
  explicit Walk(unsigned seed) : random_(seed) {
    turn = seed % 4 == 0 ? 0 : Pick({8, 360 * 8, 5000 * 8, 1000});
    const Count scale = turn == 0 ? 4000 : turn;
    fastest_ = Pick({3, scale / 20 + 1, scale, scale + scale / 2});
    for (int i = 0; i < 6; ++i) {
      Range r{Between(0, scale - 1), Between(0, scale - 1), static_cast<CamDirection>(Between(0, 2)),
              i < 3 ? 0 : Between(1, 4)};
      if (turn == 0 && r.last < r.first) std::swap(r.first, r.last);
      if (i == 1) r.last = r.first;
      ranges.push_back(r);
    }
    at = Between(0, scale - 1);
  }

  void Go() {
    before = at;
    const Count kind = Between(0, 9);
    if (kind == 0) return;
    if (kind == 1) step_ = Between(-fastest_, fastest_);
    at += kind == 2 ? ToAnEdge() : step_;
    if (turn == 0 && std::abs(at) > 20000) step_ = at > 0 ? -std::abs(step_) : std::abs(step_);
  }
  Count Between(Count low, Count high) { return std::uniform_int_distribution<Count>(low, high)(random_); }

  std::vector<Range> ranges;
  Count turn = 0, at = 0, before = 0;

 private:
  Count Pick(std::initializer_list<Count> of) { return of.begin()[Between(0, static_cast<Count>(of.size()) - 1)]; }
  Count ToAnEdge() {
    const Range& r = ranges[static_cast<std::size_t>(Between(0, 5))];
    const Count way = (Between(0, 1) == 0 ? r.first : r.last) - at;
    return turn == 0 ? way : Rest(way, turn);
  }

  std::mt19937 random_;
  Count fastest_ = 0, step_ = 1;
};

TEST(CamSwitchTicks, EachPassageCountsOnceAtAnySpeed) {  // CAM-72
  for (unsigned seed = 0; seed < 400; ++seed) {
    Walk walk(seed);
    std::vector<CamSwitch> switches;
    for (const Range& r : walk.ranges) switches.push_back(SwitchOf(r, static_cast<int>(switches.size()) + 1));
    const CamSwitches list = ListOf(switches);
    CamSwitchState state;
    std::array<Count, 6> end{};
    Count sense = 1;
    for (int k = 0; k < 1000; ++k) {
      if (k > 0) walk.Go();
      if (walk.at != walk.before) sense = walk.at > walk.before ? 1 : -1;
      if (k == 0) sense = 1;
      const KinematicState x{static_cast<double>(walk.at) / 8, static_cast<double>(walk.at - walk.before) * 125, 0};
      CamSwitchInputs in = At(x, static_cast<double>(walk.turn) / 8, k);
      if (k == 0) in.sense = 1;
      const std::uint32_t outputs = Step(list, in, state);
      for (std::size_t i = 0; i < walk.ranges.size(); ++i) {
        const Range& r = walk.ranges[i];
        const bool passes = k > 0 && Passes(r, walk.before, walk.at, walk.turn);
        if (passes) end[i] = k + r.cycles;
        const bool on = r.cycles > 0 ? k < end[i] : passes || Contains(r, walk.at, sense, walk.turn);
        ASSERT_EQ(Bit(outputs, static_cast<int>(i) + 1), on)
            << "seed " << seed << " cycle " << k << " switch " << i << " at " << walk.at << " from " << walk.before;
      }
      if (walk.Between(0, 30) != 0) continue;
      // Other numbers for the same place: whole turns, or on a linear axis the switches' own move along.
      const Count turns = walk.turn * walk.Between(-3000, 3000);
      walk.at += turns;
      walk.before += turns;
      Shift(static_cast<double>(turns) / 8, state);
    }
  }
}

// A lag delays what counts, but neither loses nor repeats it: in the end each passage of the edge has counted once.
// A lead time may count what the axis, having braked, does not reach; what it passes has counted once for each way
// there.
TEST(CamSwitchTicks, LeadAndLagTimesLoseNoneAndRepeatNone) {  // CAM-72
  std::mt19937 random(72);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int run = 0; run < 300; ++run) {
    const double edge = between(-3, 3);
    const double lead = run % 2 == 0 ? -between(0, 0.2) : between(0, 0.2);
    const auto once = [&](int track, CamDirection direction) {
      return CamSwitch{track, edge, {}, direction, CamSwitchMode::kTime, 0.001};
    };
    CamSwitches list = ListOf({once(1, CamDirection::kPositive), once(2, CamDirection::kNegative)}, {1, lead, 0, 0});
    list.tracks.push_back({2, lead, 0, 0});
    const std::array<double, 3> w = {between(1, 9), between(5, 20), between(20, 40)};
    const std::array<double, 3> phase = {between(0, 6), between(0, 6), between(0, 6)};
    const Way way = [&](double t) {
      KinematicState x;
      for (std::size_t i = 0; i < 3; ++i) {
        const double size = 3.0 / static_cast<double>(i + 1);
        x.position += size * std::sin(w[i] * t + phase[i]);
        x.velocity += size * w[i] * std::cos(w[i] * t + phase[i]);
      }
      return x;
    };
    CamSwitchState state;
    int passed[2] = {0, 0}, counted[2] = {0, 0}, counted_this_way = 0, sense = 0;
    KinematicState before = way(0);
    for (int k = 0; k < 4000; ++k) {
      KinematicState x = way(k * 0.001);
      if (k == 0) x.velocity = 0;
      if (k == 3999) x = {before.position, 0, 0};
      const int now = x.position > before.position ? 1 : x.position < before.position ? -1 : sense;
      const bool passes = (before.position < edge) != (x.position < edge);
      const std::uint32_t outputs = Step(list, At(x, 0, k), state);
      if (now != sense) counted_this_way = 0;
      sense = now;
      for (const int side : {0, 1}) {
        const bool its_way = (side == 0) == (sense > 0);
        if (passes && its_way) ++passed[side];
        if (!Bit(outputs, side + 1)) continue;
        ++counted[side];
        counted_this_way += its_way;
      }
      ASSERT_LE(counted_this_way, 1) << "run " << run << " cycle " << k;
      ASSERT_TRUE(lead < 0 || !passes || counted_this_way == 1) << "run " << run << " cycle " << k;
      before = x;
    }
    if (lead > 0) continue;
    EXPECT_EQ(counted[0], passed[0]) << run;
    EXPECT_EQ(counted[1], passed[1]) << run;
  }
}

// Through the axis: 300 degrees a cycle, over the thousandth turn, where whole turns are taken out of its positions.
TEST(CamSwitchTicks, AxisLosesNoneOverThousandsOfTurns) {  // CAM-72
  for (const MasterSource source : {MasterSource::kSetValue, MasterSource::kActualValue}) {
    AxisParams params = RotaryParams();
    params.limits = {.velocity = 3e5, .acceleration = 1e6, .deceleration = {}, .jerk = 1e8, .lower = {}, .upper = {}};
    params.encoder.increments_per_unit = 1000;
    Rig rig(params);
    rig.cam_switches = {ListOf({{1, 0, {}, CamDirection::kBoth, CamSwitchMode::kTime, 0.001},
                                {2, 359, 1, CamDirection::kPositive},
                                {3, 359, 1, CamDirection::kNegative}})};
    ASSERT_TRUE(rig.PowerOn());
    rig.RunToEnd(rig.Give(MoveAbsolute{.position = 180}));
    rig.Step();
    rig.Give(DigitalCamSwitch{.switches = Name::Of("list"), .source = source});
    rig.Step();
    double last = 180;
    const auto over_all_turns = [&] {
      return (source == MasterSource::kSetValue ? rig.state.setpoint : rig.state.actual).position + rig.state.origin;
    };
    const auto run = [&](Direction direction, int cycles) {
      rig.Give(MoveVelocity{.velocity = 3e5, .direction = direction});
      for (int k = 0; k < cycles; ++k) {
        rig.Step();
        const double x = over_all_turns();
        const bool up = x > last;
        const auto met = [&](double edge, double slack) {  // rounding is the only doubt
          return up ? std::floor((x - edge + slack) / 360) > std::floor((last - edge + slack) / 360)
                    : std::ceil((x - edge - slack) / 360) < std::ceil((last - edge - slack) / 360);
        };
        const bool inside = std::abs(std::remainder(x, 360)) <= 1 + 1e-6;
        ASSERT_EQ(Bit(rig.out.cam_outputs, 1), met(0, 1e-6)) << x << " after " << last;
        if (x == last) continue;
        ASSERT_EQ(Bit(rig.out.cam_outputs, 2), up && (inside || met(359, 1e-6))) << x << " after " << last;
        ASSERT_EQ(Bit(rig.out.cam_outputs, 3), !up && (inside || met(1, 1e-6))) << x << " after " << last;
        last = x;
      }
    };
    run(Direction::kPositive, 4000);
    EXPECT_GT(last, 360 * 3000);
    run(Direction::kNegative, 6000);
    EXPECT_LT(last, 360 * 1500);
  }
}

TEST(CamSwitchTicks, OtherNumbersForThePlaceAreNoWay) {  // CAM-72
  Rig rig(LinearParams());
  rig.cam_switches = {ListOf({{1, 20, {}, CamDirection::kBoth, CamSwitchMode::kTime, 0.05}})};
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(DigitalCamSwitch{.switches = Name::Of("list")});
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 10}));
  rig.Give(SetPosition{.position = 30});
  rig.Run(0.1);
  rig.Give(SetPosition{.position = 10});
  rig.Run(0.1);
  int on = 0;
  for (const Sample& sample : rig.trace) on += sample.out.cam_outputs != 0;
  EXPECT_EQ(on, 0);
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 30}));
  for (const Sample& sample : rig.trace) on += sample.out.cam_outputs != 0;
  EXPECT_EQ(on, 50);
}

// Where the encoder shows the axis after it had failed is where it was brought, not a way past the switches.
TEST(CamSwitchTicks, WhatWasNotMeasuredIsNoWay) {  // CAM-72
  Rig rig(LinearParams());
  rig.cam_switches = {ListOf({{1, 20, {}, CamDirection::kBoth, CamSwitchMode::kTime, 0.001}})};
  ASSERT_TRUE(rig.PowerOn());
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 10}));
  rig.Give(DigitalCamSwitch{.switches = Name::Of("list"), .source = MasterSource::kActualValue});
  rig.Run(0.05);
  rig.frozen = true;
  rig.inputs.encoder_error = true;
  rig.Run(0.05);
  rig.inputs.encoder_error = false;
  rig.inputs.counts += 50'000'000;
  rig.Give(Reset{});
  for (int k = 0; k < 100; ++k) {
    rig.Step();
    ASSERT_EQ(rig.out.cam_outputs, 0U);
  }
  EXPECT_NEAR(rig.out.actual_position, 60, 1e-3);
}

}  // namespace
}  // namespace takt::axis
