// Traffic of movers that follow a master: PL-14, PL-34.
#include "takt/planar/gear.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../core/trials.h"
#include "streets.h"
#include "takt/planar/going_along.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {
namespace {

using testing::Straight;
using testing::TrackNetworkState;
using testing::Watcher;

// An axis that moves from one random velocity to the next, with an occasional jump.
class Axis {
 public:
  Axis(const trajectory::Limits& limits, testing::Random& random) : limits_(limits), random_(random) {}

  KinematicState Next() {
    time_ += testing::kPeriod;
    if (time_ > profile_.duration() + hold_) {
      hold_ = random_.Between(0, 0.5);
      // Near either end of its range it reverses.
      double velocity = random_.Between(-1, 1) * limits_.velocity;
      if (at_.position > upper) velocity = -std::abs(velocity);
      if (at_.position < lower) velocity = std::abs(velocity);
      if (random_.Below(4) == 0) velocity = 0;
      const KinematicState from = at_;
      profile_ = trajectory::Profile{from};
      time_ = testing::kPeriod;
      EXPECT_TRUE(planner_.ToVelocity(from, velocity, limits_, profile_).ok());
    }
    at_ = profile_.At(time_);
    return at_;
  }
  void Jump(double by) {
    at_.position += by;
    time_ = 0;
    hold_ = 0;
    profile_ = trajectory::Profile{at_};
  }

  double lower = -INFINITY, upper = INFINITY;

 private:
  trajectory::Limits limits_;
  testing::Random& random_;
  trajectory::Planner planner_;
  trajectory::Profile profile_;
  KinematicState at_;
  double time_ = 0, hold_ = 0;
};

void Couple(TrackNetworkState& streets, std::uint32_t mover, double offset, std::uint32_t master = kNobody) {
  Rider& r = streets[mover];
  r.aim = Aim::kFollow;
  r.gear = {.master = master, .offset = offset};
}

TEST(Gear, FollowsWhatItsLimitsAllowBitForBit) {  // PL-14
  for (unsigned trial = 0; trial < 20; ++trial) {
    testing::Random random(trial);
    const Pace pace = testing::PaceOf(random.Between(500, 2000), random.Between(3000, 15000), random.Between(5e4, 4e5));
    TrackNetworkState streets({Straight(100000)}, 1);
    streets.Put(0, 0, 50000, pace);
    Couple(streets, 0, 50000);
    Axis axis({0.9 * pace.limits.velocity, 0.9 * pace.limits.acceleration, 0.9 * pace.limits.deceleration,
               0.9 * pace.limits.jerk},
              random);
    double travelled = 0;
    for (int i = 0; i < 20000; ++i) {
      streets[0].demand = axis.Next();
      streets.Step();
      ASSERT_EQ(streets[0].at.position, streets[0].demand.position + 50000) << trial << " " << i;
      ASSERT_EQ(streets[0].at.velocity, streets[0].demand.velocity);
      ASSERT_TRUE(streets[0].gear.in_step);
      travelled += std::abs(streets[0].at.velocity) * testing::kPeriod;
    }
    EXPECT_GT(travelled, 1000);
  }
}

// A master beyond the limits of the mover, and one that jumps: limits are kept, and in_step is true only in step.
TEST(Gear, KeepsItsLimitsWhateverTheMasterDoes) {  // PL-14
  int regained = 0, lost = 0;
  for (unsigned trial = 0; trial < 20; ++trial) {
    testing::Random random(100 + trial);
    const Pace pace = testing::PaceOf(random.Between(500, 2000), random.Between(3000, 15000), random.Between(5e4, 4e5));
    TrackNetworkState streets({Straight(200000)}, 1);
    streets.Put(0, 0, 100000, pace);
    Couple(streets, 0, 100000);
    streets[0].gear.tolerance = trial % 2 == 0 ? 0 : 1;
    const double more = random.Between(0.5, 2);
    Axis axis({more * pace.limits.velocity, more * pace.limits.acceleration, more * pace.limits.deceleration,
               more * pace.limits.jerk},
              random);
    axis.lower = -20000;
    axis.upper = 20000;
    Watcher watcher(streets);
    bool was = true;
    for (int i = 0; i < 30000; ++i) {
      if (random.Below(3000) == 0) axis.Jump(random.Between(-300, 300));
      streets[0].demand = axis.Next();
      streets.Step();
      watcher.Look();
      const Rider& r = streets[0];
      const double error = r.at.position - 100000 - r.demand.position;
      ASSERT_NEAR(r.gear.error, error, 1e-9);
      if (r.gear.in_step) {
        ASSERT_LE(std::abs(error), std::max(1e-6, r.gear.tolerance));
      }
      ASSERT_EQ(r.gear.end, GearEnd::kNot);
      lost += was && !r.gear.in_step ? 1 : 0;
      regained += !was && r.gear.in_step ? 1 : 0;
      was = r.gear.in_step;
    }
    EXPECT_LE(watcher.speed, 1 + 1e-8) << trial;
    EXPECT_LE(watcher.acceleration, 1 + 1e-8) << trial;
    EXPECT_LE(watcher.jerk, 1 + 1e-5) << trial;
  }
  EXPECT_GT(lost, 100);
  EXPECT_GT(regained, 100);
}

// Until it has been in step it moves only in the permitted direction.
TEST(Gear, GetsIntoStepTheWayItMay) {  // PL-14
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  for (const int sense : {0, 1, -1}) {
    TrackNetworkState streets({Straight(3000)}, 1);
    streets.Put(0, 0, 1500, pace);
    Couple(streets, 0, 0);
    streets[0].gear.sense = static_cast<std::int8_t>(sense);
    // The master is at rest behind it, comes up to it, and continues.
    double least = 1500, most = 1500;
    for (int i = 0; i < 6000; ++i) {
      const double t = i * testing::kPeriod;
      streets[0].demand = t < 2 ? KinematicState{1300, 0, 0} : KinematicState{1300 + 200 * (t - 2), 200, 0};
      streets.Step();
      least = std::min(least, streets[0].at.position);
      most = std::max(most, streets[0].at.position);
    }
    EXPECT_NEAR(least, sense > 0 ? 1500 : 1300, 1e-6) << sense;
    // Once it has been in step it follows in both directions.
    EXPECT_TRUE(streets[0].gear.in_step);
    EXPECT_NEAR(most, 2099.8, 1e-6);
  }
}

// Coupled late, it comes from behind and does not pass its master's position: it could not move back.
TEST(Gear, ComesFromBehindWithoutPassing) {  // PL-14
  for (unsigned trial = 0; trial < 30; ++trial) {
    testing::Random random(trial);
    const Pace pace = testing::PaceOf(random.Between(500, 2000), random.Between(3000, 15000), random.Between(5e4, 4e5));
    const Pace its =
        testing::PaceOf(random.Between(0.5, 1) * pace.limits.velocity, pace.limits.acceleration, pace.limits.jerk);
    TrackNetworkState streets({Straight(5000), Straight(5000)}, 2);
    streets.Put(0, 0, 0, pace);
    streets.Put(1, 1, 0, its);
    const double target = random.Between(50, 4000);
    streets.Send(1, 1, target);
    const int late = 1 + random.Below(1500);
    for (int i = 0; i < late; ++i) streets.Step();
    Couple(streets, 0, 0, 1);
    streets[0].gear.sense = 1;
    double most = -INFINITY;
    for (int i = 0; i < 15000; ++i) {
      streets.Step();
      if (!streets[0].gear.was_in_step) most = std::max(most, streets[0].gear.error);
    }
    EXPECT_LT(most, 1e-5) << trial;
    EXPECT_TRUE(streets[0].gear.in_step) << trial;
    EXPECT_NEAR(streets[0].at.position, target, 1e-6);
  }
}

// Its master's position is behind it and it may only move forwards: it waits for its master, which waits for it.
TEST(Gear, MayWaitForItsMaster) {  // PL-14, PL-26
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  TrackNetworkState streets({Straight(3000)}, 2);
  streets.Put(0, 0, 600, testing::PaceOf(100, 8000, 200000), 200);
  streets.Put(1, 0, 1000, pace, 200);
  Couple(streets, 1, -300, 0);
  streets[1].gear.sense = 1;
  streets.Run(1);
  EXPECT_EQ(streets[1].waits, Waits::kMover);
  EXPECT_EQ(streets[1].waits_for, 0U);
  EXPECT_FALSE(IsDeadlocked(streets.riders(), 1));
  streets.Send(0, 0, 2000);
  EXPECT_FALSE(streets.Run(5));
  EXPECT_NEAR(streets[1].at.position - streets[0].at.position, 200, 0.05);
  EXPECT_TRUE(IsDeadlocked(streets.riders(), 0) && IsDeadlocked(streets.riders(), 1));
  Couple(streets, 1, 300, 0);
  streets[1].gear.sense = 1;
  EXPECT_TRUE(streets.Run(20));
  EXPECT_EQ(streets[1].waits, Waits::kNot);
  EXPECT_TRUE(streets[1].gear.in_step);
  EXPECT_NEAR(streets[1].at.position, 2300, 1e-6);
}

// The demand is ahead and comes back; while it is on the track the mover can wait for it.
TEST(Gear, LetsAPlaceComeThatIsOnItsWay) {  // PL-14
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  trajectory::Planner planner;
  for (const double from : {0.0, 1000.0}) {
    for (const int sense : {-1, 0, 1}) {
      const double back = from > 0 ? -1 : 1;
      TrackNetworkState streets({Straight(1000)}, 1);
      streets.Put(0, 0, from, pace);
      Couple(streets, 0, from + 400 * back);
      streets[0].gear.sense = static_cast<std::int8_t>(sense);
      trajectory::Profile master;  // comes back to the end, and leaves it
      ASSERT_TRUE(planner.ToPosition({}, -399 * back, 0, {900, 8000, 8000, 200000}, master).ok());
      double furthest = from;
      for (int i = 1; i < 3000; ++i) {
        streets[0].demand = master.At(i * testing::kPeriod);
        streets.Step();
        ASSERT_EQ(streets[0].gear.end, GearEnd::kNot) << from << " " << sense << " " << i;
        ASSERT_GE(streets[0].at.position, -1e-6);
        ASSERT_LE(streets[0].at.position, 1000 + 1e-6);
        furthest = back > 0 ? std::max(furthest, streets[0].at.position) : std::min(furthest, streets[0].at.position);
      }
      // Away from the end it moves only in the permitted direction.
      const bool may = sense == 0 || sense == back;
      EXPECT_EQ(streets[0].gear.in_step, may) << from << " " << sense;
      if (!may) {
        EXPECT_EQ(furthest, from);
      }
      // A demand beyond the end is not waited for.
      trajectory::Profile on;
      ASSERT_TRUE(planner.ToPosition(master.end(), -500 * back, 0, {900, 8000, 8000, 200000}, on).ok());
      for (int i = 1; i < 2000; ++i) {
        streets[0].demand = on.At(i * testing::kPeriod);
        streets.Step();
      }
      EXPECT_EQ(streets[0].gear.end, GearEnd::kWay) << from << " " << sense;
      EXPECT_NEAR(streets[0].at.position, from, 1e-6);
    }
  }
}

TEST(Gear, StopsWhereItsWayEnds) {  // PL-14
  const Pace pace = testing::PaceOf(1000, 8000, 200000);
  for (const bool forward : {true, false}) {
    TrackNetworkState streets({Straight(1000)}, 1);
    streets.Put(0, 0, 500, pace);
    Couple(streets, 0, 500);
    Watcher watcher(streets);
    const double velocity = forward ? 300 : -300;
    trajectory::Planner planner;
    trajectory::Profile up;
    ASSERT_TRUE(planner.ToVelocity({}, velocity, pace.limits, up).ok());
    double in_step_until = 0;
    for (int i = 1; i < 3000; ++i) {
      streets[0].demand = up.At(i * testing::kPeriod);
      streets.Step();
      watcher.Look();
      if (streets[0].aim == Aim::kFollow && streets[0].gear.in_step) in_step_until = streets[0].at.position;
    }
    EXPECT_EQ(streets[0].gear.end, GearEnd::kWay);
    EXPECT_TRUE(streets[0].there);
    EXPECT_NEAR(streets[0].at.position, forward ? 1000 : 0, 1e-9);
    // In step until it has to brake.
    const double way = StoppingDistance(300, pace.brakes());
    EXPECT_NEAR(in_step_until, forward ? 1000 - way : way, 1);
    EXPECT_LE(watcher.acceleration, 1 + 1e-8);
    EXPECT_LE(watcher.jerk, 1 + 1e-5);
  }
}

// Each follows the one ahead, at just the gap that it has to keep: they are one body.
TEST(Gear, AConvoyIsRigid) {  // PL-14
  TrackNetworkState streets({Straight(30000)}, 11);
  const Pace pace = testing::PaceOf(1500, 10000, 200000);
  for (std::uint32_t i = 0; i < 11; ++i) {
    streets.Put(i, 0, 4000 - 200.0 * i, pace, 200);
    if (i > 0) Couple(streets, i, -200, i - 1);
  }
  Watcher watcher(streets);
  double most = 0;
  streets.watch = [&] {
    watcher.Look();
    for (std::size_t i = 1; i < 11; ++i) {
      most = std::max(most, std::abs(streets[i - 1].at.position - streets[i].at.position - 200));
      ASSERT_TRUE(streets[i].gear.in_step) << i << " " << streets.now();
    }
  };
  for (const double to : {8000.0, 9000.0, 9100.0, 20000.0}) {
    streets.Send(0, 0, to);
    EXPECT_TRUE(streets.Run(20));
    EXPECT_NEAR(streets[10].at.position, to - 2000, 1e-6);
  }
  streets.Send(0, 0, 29000);
  streets.Run(2);
  streets.Halt(0);
  for (int i = 0; i < 3000; ++i) streets.Step();
  for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ(streets[i].at.velocity, 0) << i;
  EXPECT_LT(most, 1e-6);
  EXPECT_LE(watcher.acceleration, 1 + 1e-8);
  EXPECT_LE(watcher.jerk, 1 + 1e-5);
}

// The same, but they start somewhere behind: they close up, without oscillation, and then are one body.
TEST(Gear, AConvoyClosesUp) {  // PL-14
  testing::Random random(7);
  TrackNetworkState streets({Straight(60000)}, 11);
  const Pace pace = testing::PaceOf(1500, 10000, 200000);
  const Pace slow = testing::PaceOf(1000, 10000, 200000);
  double place = 8000;
  for (std::uint32_t i = 0; i < 11; ++i) {
    streets.Put(i, 0, place, i == 0 ? slow : pace, 200);
    streets[i].brakes = pace.brakes();
    if (i > 0) Couple(streets, i, -200, i - 1);
    place -= 200 + random.Between(0, 300);
  }
  streets.Send(0, 0, 50000);
  Watcher watcher(streets);
  double missing = -INFINITY;
  int refused = 0;
  streets.watch = [&] {
    watcher.Look();
    missing = std::max(missing, streets.Missing());
    refused += static_cast<int>(streets.traffic().refused());
  };
  streets.Run(15);
  for (std::size_t i = 1; i < 11; ++i) {
    EXPECT_TRUE(streets[i].gear.in_step) << i;
    EXPECT_NEAR(streets[i - 1].at.position - streets[i].at.position, 200, 1e-6) << i;
  }
  streets.Halt(0);
  for (int i = 0; i < 3000; ++i) streets.Step();
  for (std::size_t i = 1; i < 11; ++i) {
    EXPECT_NEAR(streets[i - 1].at.position - streets[i].at.position, 200, 1e-6) << i;
    EXPECT_EQ(streets[i].at.velocity, 0) << i;
  }
  EXPECT_LT(missing, 1e-5);
  EXPECT_LT(refused, 100);
  EXPECT_LE(watcher.acceleration, 1 + 1e-8);
  EXPECT_LE(watcher.jerk, 1 + 1e-5);
  RecordProperty("refused", refused);
}

// If a curve does not admit the master's motion the mover falls behind, keeps its lateral acceleration, and catches up.
TEST(Gear, SlowsDownInCurves) {  // PL-14, PL-21
  for (unsigned trial = 0; trial < 10; ++trial) {
    testing::Random random(trial);
    Layout layout{{testing::Line({0, 0}, {1500, 0}), testing::Line({1700, 200}, {1700, 1500}),
                   testing::Line({1900, 1700}, {5000, 1700})}};
    const Pace pace = testing::PaceOf(2000, 10000, 200000, random.Between(3000, 8000));
    const Pace pace_of_master = testing::PaceOf(random.Between(300, 1700), 8000, 150000);
    TrackNetworkState streets({layout, Straight(10000)}, 2);
    streets.Put(0, 0, 0, pace);
    streets.Put(1, 1, 0, pace_of_master);
    Couple(streets, 0, 0, 1);
    const double length = streets.track(0).length;
    streets.Send(1, 1, length - 100);
    Watcher watcher(streets);
    int refused = 0;
    bool lost = false;
    streets.watch = [&] {
      watcher.Look();
      refused += static_cast<int>(streets.traffic().refused());
      lost |= !streets[0].gear.in_step;
    };
    EXPECT_TRUE(streets.Run(30));
    for (int i = 0; i < 3000; ++i) streets.Step();
    EXPECT_TRUE(streets[0].gear.in_step);
    EXPECT_NEAR(streets[0].at.position, length - 100, 1e-9);
    double slowest = INFINITY;
    for (const Bend& bend : streets.track(0).bends) {
      if (bend.curvature > 0) slowest = std::min(slowest, std::sqrt(pace.lateral / bend.curvature));
    }
    EXPECT_EQ(lost, slowest < pace_of_master.limits.velocity) << trial << " " << slowest;
    EXPECT_LE(watcher.lateral, 1 + 1e-6) << trial;
    EXPECT_LE(watcher.speed, 1 + 1e-8) << trial;
    EXPECT_LE(watcher.acceleration, 1 + 1e-8) << trial;
    EXPECT_LE(watcher.jerk, 1 + 1e-5) << trial;
    EXPECT_LT(refused, 10) << trial;
  }
}

// At a switch each takes the route of the first one, as one body.
TEST(Gear, AConvoyGoesThroughSwitches) {  // PL-14, PL-34
  const Layout in{{testing::Line({0, 0}, {2000, 0})}};
  const Layout left{{testing::Line({2000, 0}, {2300, 0}), testing::Line({2600, 300}, {4000, 300})}};
  const Layout right{{testing::Line({2000, 0}, {2300, 0}), testing::Line({2600, -300}, {4000, -300})}};
  const Layout on{{testing::Line({4000, 300}, {6000, 300})}};
  TrackNetworkState streets({in, left, right, on}, 6);
  const Pace pace = testing::PaceOf(600, 5000, 100000, 8000);
  for (std::uint32_t i = 0; i < 6; ++i) {
    streets.Put(i, 0, 1500 - 200.0 * i, pace, 200);
    if (i > 0) Couple(streets, i, -200, i - 1);
    streets[i].gear.takes_masters_way = i > 0;
  }
  ASSERT_TRUE(streets.Send(0, 3, 1900));
  Watcher watcher(streets);
  double nearest = INFINITY;
  const auto step = [&] {
    for (std::uint32_t i = 1; i < 6; ++i) ASSERT_TRUE(TakeMastersRoute(streets.network(), streets[i - 1], streets[i]));
    streets.Step();
    watcher.Look();
    nearest = std::min(nearest, streets.Nearest());
    for (std::uint32_t i = 1; i < 6; ++i) ASSERT_TRUE(streets[i].gear.in_step) << i << " " << streets.now();
  };
  for (int i = 0; i < 1500; ++i) step();
  // The first one is past the switch, the last one not yet: all take the route of the first one.
  EXPECT_GT(streets[0].origin, 0);
  EXPECT_EQ(streets[5].origin, 0);
  EXPECT_FALSE(streets[0].route.Contains(2));
  EXPECT_TRUE(streets[5].route.Contains(1));
  for (int i = 0; i < 12000 && !streets[0].there; ++i) step();
  EXPECT_TRUE(streets[0].there);
  EXPECT_EQ(streets[5].route.first(), 3U);
  EXPECT_NEAR(streets[5].at.position, 900, 1e-6);
  EXPECT_GT(nearest, 0);
  EXPECT_LE(watcher.lateral, 1 + 1e-6);
}

bool Follows(TrackNetworkState& streets, std::uint32_t mover, std::uint32_t master) {
  while (mover != master) {
    const Rider& r = streets[mover];
    if (r.aim != Aim::kFollow || r.gear.master == kNobody) return false;
    mover = r.gear.master;
  }
  return true;
}

// Random movers of random cities follow axes, movers anywhere, and movers whose routes they take; others have targets.
// Whatever masters do, none comes too near, limits are kept, and in_step is true only in step.
TEST(Gear, NobodyComesTooNear) {  // PL-14, PL-23, PL-24
  const int trials = Trials(12);
  int behind = 0, in_step = 0, ended = 0, crossed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    testing::Random random(static_cast<unsigned>(trial));
    const std::vector<Layout> layouts = testing::RandomCity(random, 14, 100);
    TrackNetworkState streets(layouts, 14);
    std::uint32_t put = 0;
    for (std::uint32_t track = 0; track < layouts.size(); ++track) {
      const Road& road = streets.network()[track];
      const double from = std::max(170.0, road.range_at_start) + 1,
                   to = road.length - std::max(170.0, road.range_at_end) - 1;
      for (double s = from; s < to && put < 14; s += 180 + random.Between(0, 100)) {
        const Pace pace = testing::PaceOf(random.Between(300, 2000), random.Between(2000, 15000),
                                          random.Between(5e4, 4e5), random.Between(2000, 10000));
        Rider& r = streets.Put(put++, track, s, pace, 170);
        r.brakes.deceleration *= random.Between(1, 2);
      }
    }
    std::vector<trajectory::Limits> most;
    for (std::uint32_t k = 0; k < put; ++k) most.push_back(streets[k].pace.limits);
    // Each command has dynamics of its own.
    const auto some_of = [&](const trajectory::Limits& l) {
      const auto share = [&] { return random.Coin() ? 1 : random.Between(0.2, 1); };
      return trajectory::Limits{share() * l.velocity, share() * l.acceleration, share() * l.deceleration,
                                share() * l.jerk};
    };
    std::vector<Axis> axes;
    for (std::uint32_t k = 0; k < put; ++k) {
      const double more = random.Between(0.3, 2);
      const trajectory::Limits& own = streets[k].pace.limits;
      axes.emplace_back(
          trajectory::Limits{more * own.velocity, more * own.acceleration, more * own.deceleration, more * own.jerk},
          random);
    }
    RouteSearch search(layouts.size());
    double missing = -INFINITY, nearest = INFINITY;
    Watcher watcher(streets);
    for (int i = 0; i < 20000; ++i) {
      for (std::uint32_t k = 0; k < put; ++k) {
        Rider& r = streets[k];
        if (random.Below(3000) == 0) streets.Halt(k);
        if (random.Below(3000) == 0) axes[k].Jump(random.Between(-200, 200));
        r.gear.end = GearEnd::kNot;
        const auto track = static_cast<std::uint32_t>(random.Below(static_cast<int>(layouts.size())));
        const bool idle = r.aim == Aim::kRest || r.there;
        if (k % 2 == 0 && ((idle && random.Below(100) == 0) || random.Below(8000) == 0)) {
          if (streets.Send(k, track, random.Between(0, streets.track(track).length))) {
            r.pace.limits = some_of(most[k]);
          }
        } else if (k % 2 == 1 && ((idle && random.Below(100) == 0) || random.Below(3000) == 0)) {
          const auto master = static_cast<std::uint32_t>(random.Below(static_cast<int>(put)));
          Rider next = r;
          next.planned = next.there = false;
          next.aim = Aim::kFollow;
          next.pace.limits = some_of(most[k]);
          next.gear = {.tolerance = random.Coin() ? 0 : 0.5, .sense = static_cast<std::int8_t>(random.Below(3) - 1)};
          const double place = r.at.position + r.origin + random.Between(-100, 100);
          if (random.Below(4) == 0 || Follows(streets, master, k)) {
            Route more;
            if (FindRoute(streets.network(), r.route.first(), track, search, more)) next.route = more;
            next.gear.offset = place - axes[k].Next().position;
          } else {
            const Rider& its = streets[master];
            next.gear.master = master;
            next.gear.offset = place - its.at.position - its.origin;
            Route way;
            const bool one_track = its.route.first() == r.route.first();
            if (one_track || FindRoute(streets.network(), r.route.first(), its.route.first(), search, way)) {
              double end = 0;
              for (std::uint32_t m = 0; !one_track && m + 1 < way.count; ++m) {
                end += streets.track(way.tracks[m]).length;
              }
              if (!one_track) next.route = way;
              next.gear.apart = r.origin + end - its.origin;
              next.gear.takes_masters_way = TakeMastersRoute(streets.network(), its, next);
              // At a distance, or at just the gap.
              const double apart = end + its.at.position - r.at.position;
              const double wanted = random.Coin() ? 170 : random.Between(170, 600);
              if (apart > 0) next.gear.offset = next.gear.apart - std::max(wanted, 0.0);
              behind += next.gear.takes_masters_way && apart > 0 ? 1 : 0;
            }
          }
          if (MayTake(streets.network(), r, next.route)) r = next;
        }
        if (r.aim != Aim::kFollow) continue;
        r.demand = axes[k].Next();
        if (r.gear.takes_masters_way && !TakeMastersRoute(streets.network(), streets[r.gear.master], r)) {
          r.aim = Aim::kRest;
          r.gear = {};
        }
      }
      std::vector<double> origins;
      for (std::uint32_t k = 0; k < put; ++k) origins.push_back(streets[k].origin);
      streets.Step();
      watcher.Look();
      missing = std::max(missing, streets.Missing());
      if (i % 5 == 0) nearest = std::min(nearest, streets.Nearest());
      for (std::uint32_t k = 0; k < put; ++k) {
        const Rider& r = streets[k];
        ended += r.gear.end == GearEnd::kWay ? 1 : 0;
        if (r.aim != Aim::kFollow || !r.gear.in_step) continue;
        ++in_step;
        crossed += r.origin != origins[k] ? 1 : 0;
        const Rider* master = r.gear.master == kNobody ? nullptr : &streets[r.gear.master];
        const double its = master ? master->at.position + master->origin : r.demand.position;
        ASSERT_LE(std::abs(r.at.position + r.origin - its - r.gear.offset),
                  std::max(2e-6, r.gear.tolerance * 1.000001));
      }
    }
    EXPECT_LT(missing, 1e-3) << trial;
    EXPECT_GT(nearest, 0) << trial;
    EXPECT_LE(watcher.acceleration, 1 + 1e-6) << trial;
    EXPECT_LE(watcher.jerk, 1 + 1e-5) << trial;
    EXPECT_LE(watcher.speed, 1 + 1e-8) << trial;
    EXPECT_LE(watcher.lateral, 1 + 1e-6) << trial;
  }
  // Otherwise the test would prove nothing.
  EXPECT_GT(behind, Trials(50));
  EXPECT_GT(in_step, Trials(10000));
  EXPECT_GT(ended, Trials(10));
  if (kSanitized) return;  // too few trials for rare events
  EXPECT_GT(crossed, 0);
}

}  // namespace
}  // namespace takt::planar
