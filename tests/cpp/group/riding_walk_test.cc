// CV-01, CV-14, CV-21, CV-23: belts that change their speed, stop and turn round, under everything a group can be told:
// limits are kept in each cycle, every command ends once, and the group can always be stopped.
#include <random>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "belts.h"

namespace takt::group {
namespace {

// Speed, and how it changes, all of it known to the third derivative.
struct Waves {
  double speed = 0, size = 0, pace = 1, phase = 0;

  KinematicState operator()(double t) const {
    const double x = pace * t + phase;
    return {speed * t - size / pace * std::cos(x), speed + size * std::sin(x), size * pace * std::cos(x)};
  }
};

// mm in a cycle. Axes that are in step but for a little come fully into step while the tool rests on the object.
constexpr double kNearly = 1e-2, kStays = 1e-8;
constexpr int kSettled = 100;  // cycles

struct Walk {
  explicit Walk(std::uint64_t seed, const Kind& kind)
      : random(seed), rig(kind.make()), place(kind.place), turns(kind.name == "SCARA") {
    std::vector<Belt> all;
    for (const char* name : {"first", "second"}) {
      Pose origin = place(random);
      if (!turns) origin.c = Uniform(random, -180, 180);
      all.push_back(BeltAt(
          name, origin,
          Waves{Uniform(random, -150, 150), Uniform(random, 0, 150), Uniform(random, 0.3, 4), Uniform(random, 0, 6)}));
    }
    belts = Put(rig, std::move(all));
    Pose begin = place(random);
    if (!turns) begin.c = 0;
    rig.StartAt(begin);
  }

  int Pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); }
  Name BeltName() { return Name::Of(Pick(2) ? "first" : "second"); }
  BufferMode Buffer() {
    constexpr BufferMode kModes[] = {BufferMode::kAborting, BufferMode::kBuffered, BufferMode::kBlendingNext,
                                     BufferMode::kBlendingLow};
    return kModes[Pick(4)];
  }
  template <typename Move>
  Move Manner(Move m) {
    m.buffer_mode = Buffer();
    if (Pick(2)) {
      m.transition_mode = TransitionMode::kCornerDistance;
      m.transition_parameter = Uniform(random, 1, 30);
    }
    return m;
  }
  Command Move() {
    const bool rides = Pick(3) > 0;
    Pose to = place(random);
    if (rides) to = {Uniform(random, -40, 40), Uniform(random, -40, 40), Uniform(random, -30, 30)};
    const auto system = rides ? CoordinateSystem::kPcs : CoordinateSystem::kMcs;
    const std::uint32_t pcs = 1 + static_cast<std::uint32_t>(Pick(2));
    if (Pick(5) == 0) {
      MoveArch m{.x = to.x, .y = to.y, .z = to.z, .height = Uniform(random, 0, 40)};
      m.coordinate_system = system;
      m.pcs = pcs;
      return Manner(m);
    }
    MoveLinearAbsolute m{.x = to.x, .y = to.y, .z = to.z};
    m.coordinate_system = system;
    m.pcs = pcs;
    return Manner(m);
  }
  Command Next() {
    switch (Pick(14)) {
      case 0:
        return Stop{};
      case 1:
        return Halt{};
      case 2:
        return Interrupt{};
      case 3:
      case 4:
        return Continue{};
      case 5:
        return SetOverride{.velocity_factor = Pick(2) ? 1 : Uniform(random, 0.1, 1)};
      case 6: {
        SetDynCoordTransform m{.pcs = 1 + static_cast<std::uint32_t>(Pick(2)), .carrier = BeltName()};
        m.x = Uniform(random, -50, 50);
        return m;
      }
      case 7: {
        TrackConveyorBelt m;
        m.belt = BeltName();
        m.pcs = 1 + static_cast<std::uint32_t>(Pick(2));
        m.start_distance = Uniform(random, 0, 20);
        if (Pick(2)) m.end_distance = m.start_distance + Uniform(random, 20, 200);
        if (Pick(2)) m.sync_in_conveyor_distance = Uniform(random, 1, 20);
        if (Pick(2)) m.sync_out_conveyor_distance = Uniform(random, 1, 20);
        m.execution_mode = static_cast<ExecutionMode>(Pick(3));
        return m;
      }
      default:
        return Move();
    }
  }

  std::mt19937_64 random;
  Rig rig;
  std::function<Pose(std::mt19937_64&)> place;
  bool turns;
  std::unique_ptr<Belts> belts;
};

// CV-20: in step with an object, and told to go nowhere, the tool stays where it is on it.
struct StaysOnObject {
  void Look(const Outputs& out) {
    const bool rests = out.in_sync && out.path_velocity == 0;
    if (rests) {
      ASSERT_FALSE(std::isnan(out.object_x));
    }
    const KDL::Vector now(out.object_x, out.object_y, out.object_z);
    if (rested > 0 && rests) {
      ASSERT_LE((now - before).Norm(), rested > kSettled ? kStays : kNearly);
    }
    rested = rests ? rested + 1 : 0;
    before = now;
  }

  int rested = 0;  // cycles
  KDL::Vector before;
};

class RidingWalk : public ::testing::TestWithParam<std::string> {};

TEST_P(RidingWalk, PropertyKeepsLimitsAndCanAlwaysBeStopped) {
  const std::vector<Kind> kinds = Kinds();
  const Kind& kind = *std::ranges::find(kinds, GetParam(), &Kind::name);
  std::uint64_t rode = 0, in_sync = 0;
  int lost = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(Trials(40, 10)); ++seed) {
    SCOPED_TRACE(seed);
    Walk walk(seed, kind);
    Rig& rig = walk.rig;
    for (const std::uint32_t pcs : {1u, 2u}) {
      rig.Give(SetDynCoordTransform{.pcs = pcs, .carrier = Name::Of(pcs == 1 ? "first" : "second")});
    }
    rig.Step();
    rig.trace = {rig.trace.back()};
    std::vector<Ticket> given;
    StaysOnObject stays;
    for (int i = 0; i < 60; ++i) {
      given.push_back(rig.Give(walk.Next()));
      for (int n = walk.Pick(walk.Pick(4) == 0 ? 800 : 120); n >= 0; --n) {
        rig.Step();
        rode += rig.out().track_state != TrackState::kNone;
        in_sync += rig.out().in_sync;
        ASSERT_NO_FATAL_FAILURE(stays.Look(rig.out()));
        ASSERT_EQ(rig.state.illegal_transitions, 0u);
        if (rig.out().state == GroupState::kErrorStop) {  // braked on the way to where the arms do not reach
          ASSERT_EQ(rig.out().error, ErrorId::kUnreachable);
          ++lost;
          rig.Run(0.5);
          ASSERT_TRUE(rig.RunToEnd(rig.Give(Reset{}), 2));
        }
      }
      if (rig.out().state == GroupState::kDisabled) rig.RunToEnd(rig.Give(Enable{}), 1);
    }
    const Ticket stop = rig.Give(Stop{});
    ASSERT_TRUE(rig.RunToEnd(stop, 5));
    ASSERT_TRUE(rig.lives[stop].done);
    rig.Step();
    EXPECT_EQ(rig.out().velocity, 0);
    EXPECT_EQ(rig.out().track_state, TrackState::kNone);
    for (const Ticket ticket : given) EXPECT_TRUE(rig.lives[ticket].ended()) << ticket;
    ExpectSmooth(rig);
  }
  std::cout << kind.name << ": " << rode << " cycles on rides, " << in_sync << " in step, lost " << lost << "\n";
  EXPECT_GT(in_sync, static_cast<std::uint64_t>(Trials(10000, 10)));
  // At the rim of an arm's reach a path may have to be braked where it cannot be gone any more: then each axis brakes
  // by itself, within its limits.
  EXPECT_LE(lost, kind.name == "gantry" ? 0 : std::max(6, Trials(6, 10)));
}

INSTANTIATE_TEST_SUITE_P(Group, RidingWalk, ::testing::Values("gantry", "Delta", "SCARA"),
                         [](const auto& param) { return param.param; });

}  // namespace
}  // namespace takt::group
