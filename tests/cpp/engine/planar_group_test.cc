// PL-01, PL-02, PL-30, PL-31: groups of movers and environments in a machine: invalid input, and random commands
// without collisions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "../core/trials.h"
#include "takt/core/describe.h"
#include "takt/engine/engine.h"
#include "takt/engine/load.h"
#include "takt/engine/path_checks.h"
#include "texts.h"
#include "wrong.h"

namespace takt::engine {
namespace {

using ::testing::HasSubstr;

const std::string kGroundText = R"(
name: ground
axes: []
movers:
  - {name: one}
  - {name: two, initial: {x: 240}}
tracks: [{name: way}]
planar_groups:
  - {name: cell, movers: [two], tracks: [way], environment: floor}
environments:
  - {name: floor, stators: [{x: -120, y: -120}, {x: 120, y: -120}]}
  - {name: table}
)";

Machine GroundMachine() {
  return MachineOf(kGroundText);
}

TEST(PlanarGroupMachine, SaysWhatWasExpected) {
  EXPECT_THAT(ProblemOf(kGroundText, "movers: [two]", "movers: [tow]"),
              HasSubstr("movers[0]: expected the name of a mover"));
  EXPECT_THAT(ProblemOf(kGroundText, "movers: [two]", "movers: [two, two]"), HasSubstr("each mover once"));
  EXPECT_THAT(ProblemOf(kGroundText, "tracks: [way], env", "tracks: [one], env"),
              HasSubstr("expected the name of a track"));
  EXPECT_THAT(ProblemOf(kGroundText, "environment: floor", "environment: flor"), HasSubstr("did you mean floor"));
  EXPECT_THAT(ProblemOf(kGroundText, "name: cell", "name: one"), HasSubstr("expected a name that nothing else has"));
  EXPECT_THAT(ProblemOf(kGroundText, "name: table", "name: cell"), HasSubstr("expected a name that nothing else has"));
  EXPECT_THAT(ProblemOf(kGroundText, "x: 120, y: -120", "x: 100, y: -120"),
              HasSubstr("environments[0].stators[1]: two stators"));
}

// The first component of each kind.
constexpr std::uint32_t kCell = 2 + 1 + 1, kFloor = kCell + 1, kTable = kFloor + 1;

template <typename Kind>
void ExpectBadNumbersAreRefused(std::uint32_t target, const std::vector<Kind>& good_commands) {
  const Machine machine = GroundMachine();
  ASSERT_EQ(good_commands.size(), std::variant_size_v<Kind>);
  Engine engine(machine), twin(machine);
  std::size_t index = 0;
  for (const Kind& good : good_commands) {
    EXPECT_EQ(good.index(), index++);
    const CommandText fine = ToText(machine, {.target = target, .body = good});
    ASSERT_EQ(ParseCommand(machine, fine.target, fine.verb, fine.arguments, Giver::kJournal).sentence, "") << fine.verb;
    for (const Wrong<Kind>& wrong : WrongVersionsOf(good)) {
      const CommandText text = ToText(machine, {.target = target, .body = wrong.command});
      const ParsedCommand parsed = ParseCommand(machine, text.target, text.verb, text.arguments, Giver::kJournal);
      EXPECT_EQ(parsed.error, ErrorId::kParameter) << wrong.what;
      EXPECT_THAT(parsed.sentence, HasSubstr(std::string(wrong.field) + ": expected ")) << wrong.what;
      engine.Submit({.target = target, .body = wrong.command});
      engine.RunCycle();
      twin.RunCycle();
      FeedbackEvent last;
      while (engine.feedback().TryPop(last)) {
      }
      EXPECT_EQ(last.error, ErrorId::kParameter) << wrong.what;
      ASSERT_EQ(engine.StateHash(), twin.StateHash()) << wrong.what;
    }
  }
}

// EN-22
TEST(PlanarGroupMachine, BadNumbersAreRefused) {
  using namespace environment;
  ExpectBadNumbersAreRefused<environment::Command>(
      kTable, {AddStator{5, 5}, CreateBoundary{}, Clear{}, AddToGroup{Name::Of("cell")}, RemoveFromGroup{},
               BoundaryMade{.number = 7}});
  ExpectBadNumbersAreRefused<planargroup::Command>(
      kCell, {planargroup::Enable{}, planargroup::Disable{}, planargroup::Reset{}});
  const Machine machine = GroundMachine();
  EXPECT_EQ(ParseCommand(machine, "table", "boundary_made", "{number: 1}").error, ErrorId::kUnknownVerb);
  EXPECT_THAT(ParseCommand(machine, "one", "add_to_group", "{group: cel}").sentence, HasSubstr("did you mean cell"));
  EXPECT_THAT(ParseCommand(machine, "way", "add_to_group", "{group: one}").sentence, HasSubstr("a group of movers"));
  EXPECT_THAT(ParseCommand(machine, "table", "add_to_group", "{group: one}").sentence, HasSubstr("a group of movers"));
}

// Gives commands one after the other and returns their results.
struct Talk {
  explicit Talk(const Machine& machine) : engine(machine), checks(engine, {}) {}

  FeedbackEvent Give(std::uint32_t target, const CommandBody& body) {
    const Ticket ticket = engine.Submit({.target = target, .body = body});
    for (int i = 0; i < 10'000; ++i) {
      Cycle();
      if (IsFinal(last[ticket].state)) break;
    }
    return last[ticket];
  }
  void Cycle() {
    engine.RunCycle();
    checks.Run();
    for (FeedbackEvent event; engine.feedback().TryPop(event);) last[event.ticket] = event;
  }

  Engine engine;
  PathChecks checks;
  std::map<Ticket, FeedbackEvent> last;
};

// Membership of groups, and objects that may not join.
TEST(PlanarGroupMachine, HasMembers) {
  Talk talk(GroundMachine());
  const auto error = [&](std::uint32_t target, const CommandBody& body) { return talk.Give(target, body).error; };
  const auto cell = [](auto kind) {
    kind.group = Name::Of("cell");
    return kind;
  };
  talk.Cycle();
  EXPECT_EQ(talk.engine.mover_outputs(0).group, 0u);
  EXPECT_EQ(talk.engine.mover_outputs(1).group, 1u);
  EXPECT_EQ(talk.engine.tracks().outputs[0].group, 1u);
  EXPECT_EQ(error(kTable, environment::Command(cell(environment::AddToGroup{}))), ErrorId::kOtherPlanarGroup);
  EXPECT_EQ(error(kTable, environment::Command(environment::RemoveFromGroup{})), ErrorId::kNoPlanarGroup);
  EXPECT_EQ(error(kFloor, environment::Command(environment::RemoveFromGroup{})), ErrorId::kNone);
  EXPECT_EQ(error(kTable, environment::Command(cell(environment::AddToGroup{}))), ErrorId::kNone);
  // Without a boundary there is nothing to check.
  EXPECT_EQ(error(kCell, planargroup::Command(planargroup::Enable{})), ErrorId::kNoBoundary);
  EXPECT_EQ(error(kTable, environment::Command(environment::RemoveFromGroup{})), ErrorId::kNone);
  EXPECT_EQ(error(kCell, planargroup::Command(planargroup::Enable{})), ErrorId::kNone);
  EXPECT_EQ(error(kTable, environment::Command(cell(environment::AddToGroup{}))), ErrorId::kNoBoundary);
  EXPECT_EQ(error(kFloor, environment::Command(cell(environment::AddToGroup{}))), ErrorId::kNone);
  EXPECT_EQ(error(1, mover::Command(cell(mover::AddToGroup{}))), ErrorId::kNone);
  EXPECT_EQ(error(1, mover::Command(cell(mover::AddToGroup{}))), ErrorId::kNone);
  EXPECT_EQ(error(1, mover::Command(mover::RemoveFromGroup{})), ErrorId::kNone);
  EXPECT_EQ(error(1, mover::Command(mover::RemoveFromGroup{})), ErrorId::kNoPlanarGroup);
  // An object in motion, or at the position of another one, does not join an enabled group.
  EXPECT_EQ(error(1, mover::Command(mover::Enable{})), ErrorId::kNone);
  talk.engine.Submit({.target = 1, .body = mover::Command(mover::MoveToPosition{.x = 200})});
  EXPECT_EQ(error(1, mover::Command(cell(mover::AddToGroup{}))), ErrorId::kObjectMoves);
  for (int i = 0; i < 1000; ++i) talk.Cycle();
  const FeedbackEvent refused = talk.Give(1, mover::Command(cell(mover::AddToGroup{})));
  EXPECT_EQ(refused.error, ErrorId::kObjectMoves);  // it waits for the other one, which it cannot pass
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kMover, 1}));
  EXPECT_EQ(talk.engine.mover_outputs(0).waits_for, 2u);
  EXPECT_EQ(SentenceNaming(refused, talk.engine.machine()),
            std::string(ErrorText(ErrorId::kObjectMoves)) + ": mover one");
}

// A random walk in a hall: stators with a hole, movers that translate, rotate, halt and fail, and some on a track.
class Hall {
 public:
  static constexpr std::uint32_t kMovers = 18;
  static constexpr std::uint32_t kTrack = kMovers + 1, kGroup = kTrack + 1;

  // `waits`: moves wait for their area, and some are buffered.
  Hall(unsigned seed, bool waits) : random_(seed), talk_(Make(random_, waits)), waits_(waits) {
    Must(kTrack, track::Command(track::Enable{}));
    for (std::uint32_t i = 0; i < kMovers; ++i) Must(i + 1, mover::Command(mover::Enable{}));
    Must(kGroup, planargroup::Command(planargroup::Enable{}));
  }

  // A corridor with a track at the bottom, stators around a hole at the top.
  static Machine Make(std::mt19937& random, bool waits) {
    Machine machine;
    machine.name = "hall";
    environment::EnvironmentParams floor{"floor", {}};
    for (int x = 0; x < 7; ++x) {
      for (int y = 0; y < 6; ++y) {
        if (x != 3 || y < 3 || y > 4) floor.stators.push_back({240.0 * x, 240.0 * y});
      }
    }
    machine.environments = {floor};
    track::TrackParams line;
    line.name = "line";
    line.mover_width = line.mover_height = 120;
    line.elements.push_back({.from = planar::Place{200, 120}, .to = {1400, 120}});
    machine.tracks = {line};
    planargroup::PlanarGroupParams group{"cell", {}, {"line"}, "floor", waits};
    for (std::uint32_t i = 0; i < kMovers; ++i) {
      mover::MoverParams mover;
      mover.name = "m" + std::to_string(i);
      std::uniform_real_distribution<> size(90, 120);
      mover.width = size(random);
      mover.height = size(random);
      mover.initial.x = 120 + 240 * (i % 7);
      mover.initial.y = i < 14 ? 360 + 240 * (i / 7) : 1320;
      group.movers.push_back(mover.name);
      machine.movers.push_back(mover);
    }
    machine.planar_groups = {group};
    return machine;
  }

  void Step() {
    if (Below(6) == 0) Command(Below(kMovers));
    talk_.Cycle();
    Count();
    for (std::uint32_t i = 0; i < kMovers; ++i) ExpectFree(i);
  }

  // All come to rest, including those that wait for one another on the track; then only their areas at rest are
  // reserved.
  void Settle() {
    for (int i = 0; i < 4000; ++i) {
      if (i >= 3000 && i < 3000 + static_cast<int>(kMovers)) Give(static_cast<std::uint32_t>(i - 3000), mover::Halt{});
      talk_.Cycle();
      Count();
      for (std::uint32_t k = 0; k < kMovers; ++k) ExpectFree(k);
    }
    const planar::GroupReservations& ground = talk_.engine.grounds().grounds[0];
    for (std::uint32_t i = 0; i < kMovers; ++i) {
      const mover::Outputs& at = Of(i);
      const planar::Area area = planar::AreaOf(ground.reserved.movers[i]);
      EXPECT_FALSE(ground.reserved.movers[i].moving);
      EXPECT_EQ(area.count, 1);
      EXPECT_EQ(area.places[0].x, at.x);
      EXPECT_EQ(area.places[0].y, at.y);
      EXPECT_EQ(area.least_c, at.c);
      EXPECT_EQ(area.most_c, at.c);
    }
    EXPECT_FALSE(ground.reserved.tracks[0].moving);
  }

  std::map<ObjectKind, int> refused;
  int done = 0, faults = 0, rides = 0, justified = 0;
  int waited = 0, after_waiting = 0;  // cycles of movers; commands done that had waited for their area

 private:
  struct Point {
    double x, y;
  };
  using Corners = std::array<Point, 4>;

  std::uint32_t Below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  double Between(double lower, double upper) { return std::uniform_real_distribution<>(lower, upper)(random_); }
  const mover::Outputs& Of(std::uint32_t i) const { return talk_.engine.mover_outputs(i); }

  void Must(std::uint32_t target, const CommandBody& body) {
    const FeedbackEvent event = talk_.Give(target, body);
    ASSERT_EQ(event.error, ErrorId::kNone) << target << ' ' << SentenceNaming(event, talk_.engine.machine());
  }

  struct Wish {
    std::uint32_t mover = 0;
    bool straight = false;  // from rest, without a rotation
    bool waited = false;    // for its area
    Point from{}, to{};
    double c = 0;
  };

  void Give(std::uint32_t i, const mover::Command& body, bool straight = false, Point to = {}) {
    const mover::Outputs& at = Of(i);
    straight &= !mover::IsBuffered(body);
    const Ticket ticket = talk_.engine.Submit({.target = i + 1, .body = body});
    wishes_[ticket] = {i, straight && !at.busy_xyc && !at.busy_c, false, {at.x, at.y}, to, at.c};
  }

  void Command(std::uint32_t i) {
    const mover::Outputs& at = Of(i);
    if (at.state == planar::ObjectState::kError) return Give(i, mover::Reset{});
    if (at.state == planar::ObjectState::kDisabled) return Give(i, mover::Enable{});
    const bool on_track = at.command_mode == mover::CommandMode::kOnTrack;
    switch (Below(12)) {
      case 0:
        return Give(i, mover::Halt{.deceleration = Between(500, 10000), .jerk = Between(2e4, 2e5)});
      case 1:
        if (Below(4) == 0) Give(i, mover::Disable{});
        return;
      case 2:  // external set points that never arrive: a fault in motion
        if (at.busy_xyc && Below(2) == 0) {
          Give(i, mover::StartExternalSetpointGeneration{.mode = mover::SetpointMode::kRelative});
          Give(i, mover::SetExternalSetpoint{});
        }
        return;
      case 3:
        return Give(i, mover::MoveC{.position = at.c + Between(-10, 10)});
      case 4:
        return Give(i, mover::MoveC{.position = 90.0 * (static_cast<int>(Below(5)) - 2)});
      case 5:
      case 7:
      case 8:
        if (!on_track && at.y < 700) {
          return Give(i, mover::JoinTrack{.track = Name::Of("line"), .use_orientation = false});
        }
        break;
      case 6:
        if (on_track) return Give(i, mover::LeaveTrack{.x = at.x + Between(-200, 200), .y = Between(250, 700)});
        break;
      default:
        break;
    }
    if (on_track) return Give(i, mover::MoveOnTrack{.position = Between(0, 1200), .velocity = Between(100, 1500)});
    // Near, far, or across the track.
    const std::uint32_t how = Below(8);
    const double x = how < 2 ? Between(40, 1640) : at.x + Between(-300, 300);
    const double y = how < 2   ? Between(260, 1400)
                     : how < 4 ? Between(70, 170)
                               : std::max(at.y + Between(-300, 300), 260.0);
    const bool turns = Below(4) == 0;
    mover::MoveToPosition move{.x = x, .y = y, .c = at.c + Between(-5, 5), .use_orientation = turns};
    if (waits_ && Below(3) == 0) move.buffer_mode = mover::Buffering::kBuffered;
    if (Below(3) == 0) move.velocity = Between(100, 2000);
    if (Below(3) == 0) move.acceleration = move.deceleration = Between(1000, 10000);
    Give(i, move, !turns, {x, y});
  }

  void Count() {
    for (auto& [ticket, event] : talk_.last) {
      if (!IsFinal(event.state)) continue;
      const auto wish = wishes_.find(ticket);
      if (wish == wishes_.end()) continue;
      if (event.error == ErrorId::kCollision) {
        EXPECT_NE(event.object.number, 0u);
        ++refused[event.object.kind];
        Justify(wish->second, event.object);
      }
      done += event.state == FeedbackState::kDone ? 1 : 0;
      after_waiting += event.state == FeedbackState::kDone && wish->second.waited ? 1 : 0;
      faults += event.error == ErrorId::kNoSetPoint ? 1 : 0;
      wishes_.erase(wish);
    }
    std::erase_if(talk_.last, [](const auto& entry) { return IsFinal(entry.second.state); });
    for (auto& [ticket, wish] : wishes_) {
      const bool waits = Of(wish.mover).buffered == 1 && Of(wish.mover).waits_for != 0 && !Of(wish.mover).busy_xyc;
      wish.waited |= waits;
      waited += waits ? 1 : 0;
    }
    for (std::uint32_t i = 0; i < kMovers; ++i) rides += std::abs(Of(i).track_velocity) > 100 ? 1 : 0;
  }

  // On the straight path of a mover from rest there is the border, or another mover at rest.
  void Justify(const Wish& wish, const ObjectInfo& object) {
    if (!wish.straight) return;
    const bool border = object.kind == ObjectKind::kEnvironment;
    if (!border &&
        (object.kind != ObjectKind::kMover || Of(object.number - 1).busy_xyc || Of(object.number - 1).busy_c))
      return;
    bool near = false;
    const double length = std::hypot(wish.to.x - wish.from.x, wish.to.y - wish.from.y);
    const int steps = static_cast<int>(length / 0.5) + 1;
    for (int k = 0; k <= steps && !near; ++k) {
      const double share = static_cast<double>(k) / steps;
      const Corners body =
          Body(wish.mover, std::lerp(wish.from.x, wish.to.x, share), std::lerp(wish.from.y, wish.to.y, share), wish.c);
      near = border ? !OnFloor(body, -0.5) : Apart(body, BodyOf(object.number - 1)) < 0.5;
    }
    EXPECT_TRUE(near) << "mover " << wish.mover << " to " << wish.to.x << ' ' << wish.to.y;
    ++justified;
  }

  Corners Body(std::uint32_t i, double x, double y, double c) const {
    const mover::MoverParams& p = talk_.engine.machine().movers[i];
    const double turned = c * std::numbers::pi / 180, cosine = std::cos(turned), sine = std::sin(turned);
    Corners corners{};
    const std::array<Point, 4> signs = {{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    for (std::size_t k = 0; k < 4; ++k) {
      const double u = signs[k].x * p.width / 2, v = signs[k].y * p.height / 2;
      corners[k] = {x + cosine * u - sine * v, y + sine * u + cosine * v};
    }
    return corners;
  }
  Corners BodyOf(std::uint32_t i) const { return Body(i, Of(i).x, Of(i).y, Of(i).c); }

  // [mm] by separating axes; below 0 they overlap.
  static double Apart(const Corners& a, const Corners& b) {
    double most = -1e9;
    for (const Corners* body : {&a, &b}) {
      for (std::size_t k = 0; k < 2; ++k) {
        const double dx = (*body)[k + 1].x - (*body)[k].x, dy = (*body)[k + 1].y - (*body)[k].y;
        const double length = std::hypot(dx, dy);
        const auto span = [&](const Corners& of) {
          double least = 1e9, largest = -1e9;
          for (const Point& p : of) {
            const double at = (p.x * dx + p.y * dy) / length;
            least = std::min(least, at);
            largest = std::max(largest, at);
          }
          return std::pair{least, largest};
        };
        const auto [least_a, most_a] = span(a);
        const auto [least_b, most_b] = span(b);
        most = std::max({most, least_b - most_a, least_a - most_b});
      }
    }
    return most;
  }

  // Returns true if the body is within the outer border, and clear of the hole, by more than `by` [mm].
  static bool OnFloor(const Corners& body, double by) {
    for (const Point& p : body) {
      if (p.x < -by - 1e-6 || p.y < -by - 1e-6 || p.x > 1680 + by + 1e-6 || p.y > 1440 + by + 1e-6) return false;
    }
    const Corners hole = {{{720 - by, 720 - by}, {960 + by, 720 - by}, {960 + by, 1200 + by}, {720 - by, 1200 + by}}};
    return Apart(body, by == 0 ? hole
                               : Corners{{{720 + by, 720 + by},
                                          {960 - by, 720 + by},
                                          {960 - by, 1200 - by},
                                          {720 + by, 1200 - by}}}) > -1e-6;
  }

  void ExpectFree(std::uint32_t i) const {
    const Corners body = BodyOf(i);
    EXPECT_TRUE(OnFloor(body, 0)) << "mover " << i << " at " << Of(i).x << ' ' << Of(i).y << ' ' << Of(i).c;
    for (std::uint32_t k = 0; k < i; ++k) {
      if (std::abs(Of(i).x - Of(k).x) > 200 || std::abs(Of(i).y - Of(k).y) > 200) continue;
      EXPECT_GT(Apart(body, BodyOf(k)), 0) << "movers " << i << ' ' << k << " in cycle " << talk_.engine.cycle().count;
    }
  }

  std::mt19937 random_;
  Talk talk_;
  bool waits_;
  std::map<Ticket, Wish> wishes_;
};

// PL-30, PL-72: with any commands to 18 movers, and any halts and faults, no two bodies ever touch, and none leaves the
// stators; a refused command had a reason, also if moves wait for their area instead; and once all are at rest only
// their own areas are reserved.
TEST(PlanarGroupMachine, NothingEverTouches) {
  std::map<ObjectKind, int> refused;
  int done = 0, faults = 0, rides = 0, justified = 0, waited = 0, after_waiting = 0;
  for (unsigned seed = 1; seed <= 4 && !HasFailure(); ++seed) {
    Hall hall(seed, seed == 4);
    for (int i = 0; i < Trials(20'000, 10) && !HasFailure(); ++i) hall.Step();
    hall.Settle();
    for (const auto& [kind, count] : hall.refused) refused[kind] += count;
    done += hall.done;
    faults += hall.faults;
    rides += hall.rides;
    justified += hall.justified;
    waited += hall.waited;
    after_waiting += hall.after_waiting;
  }
  EXPECT_GT(refused[ObjectKind::kMover], Trials(200, 10));
  EXPECT_GT(refused[ObjectKind::kTrack], Trials(20, 10));
  EXPECT_GT(refused[ObjectKind::kEnvironment], Trials(200, 10));
  EXPECT_GT(done, Trials(1000, 10));
  EXPECT_GT(faults, Trials(20, 10));
  EXPECT_GT(rides, Trials(1000, 10));
  EXPECT_GT(justified, Trials(100, 10));
  EXPECT_GT(waited, Trials(1000, 10));
  EXPECT_GT(after_waiting, Trials(20, 10));
}

}  // namespace
}  // namespace takt::engine
