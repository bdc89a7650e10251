// CV-21, CV-23, PP-20, PP-21: transitions from belt to belt that do not go as they were planned, because of overrides,
// interrupts, and belts that swing and turn round: the axes are asked for no more than they can, so the tool is where
// its path is.
#include <random>

#include "../core/trials.h"
#include "belts.h"
#include "takt/group/clutch.h"

namespace takt::group {
namespace {

constexpr double kSame = 0.02;  // u
const int kTrips = Trials(50, 1);

// After the move before, or rounding its end.
MoveLinearAbsolute Then(double x, double y, double z, std::uint32_t pcs, double radius = 0) {
  return Line(x, y, z, pcs, radius > 0 ? BufferMode::kBlendingNext : BufferMode::kBuffered, radius);
}

// How far the axes are behind what is asked of them, u.
double Lag(const Rig& rig) {
  double most = 0;
  for (const axis::State& member : rig.states) {
    most = std::max(most, std::abs(member.guidance.demand.position - member.origin - member.setpoint.position));
  }
  return most;
}

// From one belt to another: lift, over, lowering; and what is done to it on the way.
struct Trip {
  explicit Trip(const Kind& kind, std::uint64_t seed, bool direct = false) : random(seed), rig(kind.make()) {
    const Pose a = kind.place(random), b = kind.place(random);
    const auto at = [](const Pose& p) { return Pose{p.x, p.y, p.z}; };
    Pose start = at(a);
    start.z += 5;
    rig.StartAt(start);
    belts = Put(rig, {BeltAt("first", at(a), Way()), BeltAt("second", at(b), Way())});
    for (const std::uint32_t pcs : {1u, 2u}) {
      rig.RunToEnd(rig.Give(SetDynCoordTransform{.pcs = pcs, .carrier = Name::Of(pcs == 1 ? "first" : "second")}));
    }
    from = rig.state.cargoes[1].from;
    const bool rides = Uniform(random, 0, 1) < 0.7;
    if (rides) {
      EXPECT_TRUE(rig.RunToEnd(rig.Give(Then(0, 0, 0, 1)), 10));
      rig.Give(Then(0, 0, 25, 1));
    }
    if (direct) {
      MoveDirectAbsolute over{.x = 0, .y = 0, .z = 25};
      over.coordinate_system = CoordinateSystem::kPcs;
      over.pcs = 2;
      over.buffer_mode = BufferMode::kBuffered;
      rig.Give(over);
    } else {
      rig.Give(Then(0, 0, 25, 2, rides ? 10 : 0));
    }
    last = rig.Give(Then(0, 0, 0, 2, 10));
  }

  // Goes on evenly, swings, or turns round.
  std::function<KinematicState(double)> Way() {
    const double speed = Uniform(random, -200, 200), size = Uniform(random, 0, 1) < 0.5 ? 0 : Uniform(random, 0, 200);
    const double pace = Uniform(random, 1, 8), phase = Uniform(random, 0, 6);
    return [=](double t) {
      const double x = pace * t + phase;
      return KinematicState{speed * t - size / pace * std::cos(x), speed + size * std::sin(x),
                            size * pace * std::cos(x)};
    };
  }

  // The same, left alone.
  bool Go() {
    for (int i = 0; i < 30000 && !rig.lives[last].ended(); ++i) {
      rig.Step();
      lag = std::max(lag, Lag(rig));
    }
    return rig.lives[last].done;
  }
  // False: the object went out of reach.
  bool Go(bool interrupted) {
    const auto random_cycle = [&](int to) { return std::uniform_int_distribution<int>(1, to)(random); };
    int next = random_cycle(300), undo = 0, left = 3;
    for (int i = 1; i < 30000 && !rig.lives[last].ended(); ++i) {
      if (i == next) {
        if (interrupted) {
          rig.Give(Interrupt{});
        } else {
          rig.Give(SetOverride{.velocity_factor = std::pow(10, Uniform(random, -2, 0))});
        }
        undo = i + random_cycle(1000);
      }
      if (i == undo) {
        if (interrupted) {
          rig.Give(Continue{});
        } else {
          rig.Give(SetOverride{.velocity_factor = 1});
        }
        next = --left > 0 ? i + random_cycle(300) : 0;
      }
      rig.Step();
      lag = std::max(lag, Lag(rig));
    }
    return rig.lives[last].done;
  }
  double off() const { return (ToolOf(rig).p - ObjectOn(*belts, 1, from, {}, rig.cycle.count - 1).p).Norm(); }

  std::mt19937_64 random;
  Rig rig;
  std::unique_ptr<Belts> belts;
  double from = 0;
  Ticket last = 0;
  double lag = 0;
};

class Late : public ::testing::TestWithParam<std::string> {};

struct Sum {
  double worst = 0;  // distance of the axes from what is asked of them, u
  int late = 0;      // trips in which it was more than kSame
  int done = 0;
};

Sum Go(const std::string& name, bool interrupted) {
  const std::vector<Kind> kinds = Kinds();
  const Kind& kind = *std::ranges::find(kinds, name, &Kind::name);
  Sum sum;
  for (int seed = 1; seed <= kTrips; ++seed) {
    SCOPED_TRACE(seed);
    Trip trip(kind, static_cast<std::uint64_t>(seed));
    const bool arrived = trip.Go(interrupted);
    sum.worst = std::max(sum.worst, trip.lag);
    sum.late += trip.lag > kSame;
    EXPECT_TRUE(trip.rig.lives[trip.last].ended());
    if (!arrived) continue;
    ++sum.done;
    EXPECT_LE(trip.off(), kOnObject);
    ExpectSmooth(trip.rig);
  }
  std::cout << name << ": " << sum.done << " arrived; " << sum.late << " came later than " << kSame << " u, "
            << sum.worst << " u at most\n";
  return sum;
}

// A SCARA's tool may be carried by near the arm's own axis: no pace of the path helps there.
TEST_P(Late, PropertyOverridesAndBeltsThatSwing) {
  const Sum sum = Go(GetParam(), false);
  const bool scara = GetParam() == "SCARA";
  EXPECT_LE(sum.late, scara ? Trials(2, 1) : 0);
  EXPECT_GE(sum.done, scara ? Trials(40, 1) : kTrips);
}

// As fast as the axes can, between belts that change their speed.
TEST_P(Late, PropertyDirectMoves) {
  const std::vector<Kind> kinds = Kinds();
  const Kind& kind = *std::ranges::find(kinds, GetParam(), &Kind::name);
  int late = 0;
  for (int seed = 1; seed <= kTrips; ++seed) {
    SCOPED_TRACE(seed);
    Trip trip(kind, static_cast<std::uint64_t>(seed), true);
    const bool arrived = trip.Go();
    late += trip.lag > kSame;
    if (arrived) {
      EXPECT_LE(trip.off(), kOnObject);
    }
  }
  EXPECT_LE(late, GetParam() == "SCARA" ? Trials(2, 1) : 0);
}

// At the instant of an interrupt a path may use all that the axes can, and its carriers are to be braked, too.
TEST_P(Late, PropertyInterrupts) {
  const Sum sum = Go(GetParam(), true);
  const bool scara = GetParam() == "SCARA";
  EXPECT_LE(sum.late, Trials(scara ? 6 : 2, 1));
  EXPECT_LE(sum.worst, 10);
  EXPECT_GE(sum.done, Trials(scara ? 15 : 25, 1));
}

// The way over may be short, or nothing at all: then it takes its time.
TEST(ShortWays, FromBeltToBelt) {
  for (const double apart : {0.0, 0.01, 1.0, 5.0, 10.0, 20.0, 40.0}) {
    for (const bool lifts : {false, true}) {
      for (const double speed : {0.0, -100.0, 300.0}) {
        SCOPED_TRACE(testing::Message() << apart << " mm apart" << (lifts ? ", lifted, to " : ", to ") << speed);
        Rig rig = Gantry();
        rig.StartAt({0, 0, 30});
        const auto belts = Put(rig, {BeltAt("first", {}, [](double t) { return Steady(t, 150); }),
                                     BeltAt("second", {0, apart, 0}, [=](double t) { return Steady(t, speed); })});
        const auto bind = [&](std::uint32_t pcs, double x) {
          rig.RunToEnd(
              rig.Give(SetDynCoordTransform{.pcs = pcs, .carrier = Name::Of(pcs == 1 ? "first" : "second"), .x = x}));
        };
        bind(1, 0);
        ASSERT_TRUE(rig.RunToEnd(rig.Give(Then(0, 0, 0, 1)), 5));
        bind(2, rig.out().x);
        const double from = rig.state.cargoes[1].from;
        const double x = rig.state.cargoes[1].lies.x;
        if (lifts) rig.Give(Then(0, 0, 25, 1));
        if (lifts) rig.Give(Then(0, 0, 25, 2, 10));
        const Ticket last = rig.Give(Then(0, 0, 0, 2, lifts ? 10 : 0));
        double lag = 0;
        while (!rig.lives[last].ended() && rig.cycle.count < 20000) {
          rig.Step();
          lag = std::max(lag, Lag(rig));
        }
        EXPECT_TRUE(rig.lives[last].done);
        EXPECT_LE(lag, kSame);
        const Frame object = ObjectOn(*belts, 1, from, {x, 0, 0}, rig.cycle.count - 1);
        EXPECT_LE((ToolOf(rig).p - object.p).Norm(), 1e-3);
        ExpectSmooth(rig);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Group, Late, ::testing::Values("gantry", "CoreXY", "Delta", "SCARA"),
                         [](const auto& param) { return param.param; });

}  // namespace
}  // namespace takt::group
