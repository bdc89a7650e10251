// PL-72: routes over the free surface, carried out by the engine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "parts_rig.h"
#include "takt/engine/path_checks.h"
#include "takt/mover/routes.h"
#include "takt/routing/run.h"
#include "takt/routing/surface.h"

namespace takt::engine {
namespace {

using ::testing::HasSubstr;

constexpr double kPitch = 120, kSide = 113;  // [mm]

struct Cell {
  int x = 0, y = 0;
};

double MiddleOf(int place) {
  return kPitch * (place + 0.5);
}

// Movers with these names at these cells.
std::string Surface(const std::vector<std::pair<std::string, Cell>>& movers, const std::string& more = "") {
  std::string text = "name: surface\naxes: []\nmovers:\n";
  for (const auto& [name, at] : movers) {
    text += "  - {name: " + name + ", width: 113, height: 113, initial: {x: " + std::to_string(MiddleOf(at.x)) +
            ", y: " + std::to_string(MiddleOf(at.y)) +
            "}, xy: {maximum: {velocity: 1000, acceleration: 5000, jerk: 100000}}}\n";
  }
  return text + more;
}

struct Step {
  Cell at;
  int after = 0, after_visit = 0;
};

std::string Visits(int first, const std::vector<Step>& steps) {
  std::string text = "{first: " + std::to_string(first) + ", visits: [";
  for (const Step& step : steps) {
    text += "{x: " + std::to_string(MiddleOf(step.at.x)) + ", y: " + std::to_string(MiddleOf(step.at.y)) +
            ", after: " + std::to_string(step.after) + ", after_visit: " + std::to_string(step.after_visit) + "}, ";
  }
  return text + "]}";
}

class Rig : public PartsRig {
 public:
  explicit Rig(const std::string& text, const EngineOptions& options = {}) : PartsRig(text, options) {
    for (const mover::MoverParams& mover : machine.movers) Do(mover.name, "enable");
    each_cycle = [this] { Watch(); };
  }

  void ExpectAt(const std::string& mover, Cell at) {
    EXPECT_NEAR(Mover(mover).x, MiddleOf(at.x), 1e-6) << mover;
    EXPECT_NEAR(Mover(mover).y, MiddleOf(at.y), 1e-6) << mover;
  }
  bool Rests() const {
    return std::ranges::all_of(machine.movers, [&](const mover::MoverParams& m) {
      return Mover(m.name).velocity_x == 0 && Mover(m.name).velocity_y == 0;
    });
  }
  void ExpectInPlaces() const {
    for (const mover::MoverParams& mover : machine.movers) {
      EXPECT_NEAR(std::remainder(Mover(mover.name).x - 60, kPitch), 0, 1e-6) << mover.name;
      EXPECT_NEAR(std::remainder(Mover(mover.name).y - 60, kPitch), 0, 1e-6) << mover.name;
    }
  }
  std::string Refusal(const std::string& target, const std::string& verb, const std::string& arguments = "{}") {
    return SentenceNaming(Do(target, verb, arguments), machine);
  }

  int overlaps = 0;

 private:
  void Watch() {
    for (std::size_t i = 0; i < machine.movers.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const mover::Outputs &a = engine.mover_outputs(i), &b = engine.mover_outputs(k);
        if (std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) < kSide - 1e-6) ++overlaps;
      }
    }
  }
};

// b lets a pass the crossing first; c blocks neither.
struct Crossing : Rig {
  Crossing() : Rig(Surface({{"a", {2, 0}}, {"b", {0, 2}}, {"c", {5, 5}}})) {
    a = Give("a", "set_route", Visits(0, {{{2, 0}}, {{2, 1}}, {{2, 2}}, {{2, 3}}, {{2, 4}}}));
    b = Give("b", "set_route", Visits(0, {{{0, 2}}, {{1, 2}}, {{2, 2}, 1, 2}, {{3, 2}}}));
    c = Give("c", "set_route", Visits(0, {{{5, 5}}, {{4, 5}}}));
  }
  Ticket a = 0, b = 0, c = 0;
};

TEST(Routes, KeepTheOrderOfVisits) {
  Crossing rig;
  rig.Run(10);
  EXPECT_EQ(rig.answers[rig.a].state, FeedbackState::kBusy);
  EXPECT_FALSE(rig.Mover("a").on_route);
  EXPECT_EQ(rig.Do("machine", "start_routes").state, FeedbackState::kDone);
  EXPECT_TRUE(rig.Mover("a").on_route);
  bool crossed = false, waited = false;
  const auto watch = rig.each_cycle;
  rig.each_cycle = [&] {
    watch();
    crossed |= rig.Mover("a").route_visit >= 3;
    EXPECT_TRUE(crossed || rig.Mover("b").x <= MiddleOf(1) + 1e-9);
    const mover::Outputs& b = rig.Mover("b");
    waited |= b.delay == mover::Delay::kPlace && b.blocker_kind == ObjectKind::kMover && b.blocker == 1;
  };
  for (const Ticket ticket : {rig.a, rig.b, rig.c}) EXPECT_EQ(rig.End(ticket).state, FeedbackState::kDone);
  rig.ExpectAt("a", {2, 4});
  rig.ExpectAt("b", {3, 2});
  rig.ExpectAt("c", {4, 5});
  EXPECT_EQ(rig.Mover("b").route_visit, 3u);
  EXPECT_FALSE(rig.Mover("b").on_route);
  EXPECT_TRUE(waited);
  EXPECT_EQ(rig.overlaps, 0);
}

// Routes are published: each soon after a change, few per cycle, again every second, and their end; later if the reader
// stalls.
TEST(Routes, ArePublishedAsTheyChange) {
  constexpr std::uint32_t kMovers = 40;
  std::vector<std::pair<std::string, Cell>> movers;
  for (int i = 0; i < int{kMovers}; ++i) movers.push_back({"m" + std::to_string(i), {0, 2 * i}});
  Rig rig(Surface(movers), {.publish = true});
  std::vector<std::vector<RouteSnapshot>> told(kMovers);
  std::size_t most = 0;
  bool reads = true;
  rig.each_cycle = [&] {
    std::size_t count = 0;
    for (RouteSnapshot route; reads && rig.engine.mover_routes().TryPop(route); ++count) {
      told[route.index].push_back(route);
    }
    most = std::max(most, count);
  };
  std::vector<Ticket> tickets;
  for (int i = 0; i < int{kMovers}; ++i) {
    const Cell at = movers[static_cast<std::size_t>(i)].second;
    tickets.push_back(
        rig.Give(movers[static_cast<std::size_t>(i)].first, "set_route", Visits(0, {{at}, {{1, at.y}}, {{2, at.y}}})));
    rig.Run();
  }
  rig.Run(20);
  EXPECT_EQ(most, 0u);
  const std::uint64_t begin = rig.engine.cycle().count;
  rig.Do("machine", "start_routes", "{velocity: 100}");
  rig.Run(10);
  EXPECT_LE(most, 8u);
  for (const auto& of : told) {
    ASSERT_EQ(of.size(), 1u);
    EXPECT_LE(of[0].cycle, begin + 10);
    ASSERT_EQ(of[0].count, 3u);
    EXPECT_EQ(of[0].first, 0u);
    EXPECT_EQ(of[0].places[2].x, MiddleOf(2));
    EXPECT_EQ(of[0].places[2].y, MiddleOf(2 * static_cast<int>(of[0].index)));
  }
  rig.Run(1020);
  for (const auto& of : told) EXPECT_EQ(of.size(), 2u);
  reads = false;
  for (const Ticket ticket : tickets) rig.End(ticket);
  rig.Run(100);
  EXPECT_EQ(rig.engine.mover_route(0).count, 0u);
  reads = true;
  rig.Run(20);
  for (const auto& of : told) EXPECT_EQ(of.back().count, 0u);
}

// A mover that is taken off its route holds up those behind it, and no others; then it continues.
TEST(Routes, OneThatIsHaltedHoldsUpThoseBehindIt) {
  for (const char* how : {"halt", "disable", "move_to_position", "move_x"}) {
    SCOPED_TRACE(how);
    Crossing rig;
    rig.Do("machine", "start_routes");
    rig.Run(150);
    const std::string verb = how;
    const std::string back = verb == "move_to_position" ? "{x: 300, y: 60}" : verb == "move_x" ? "{position: 300}" : "";
    rig.Give("a", verb, back);
    EXPECT_EQ(rig.End(rig.a).state, FeedbackState::kAborted);
    rig.Run(3000);
    EXPECT_EQ(rig.answers[rig.c].state, FeedbackState::kDone);
    rig.ExpectAt("b", {1, 2});
    EXPECT_EQ(rig.Mover("b").blocker, 1u);
    EXPECT_EQ(rig.overlaps, 0);
    if (verb == "disable") rig.Do("a", "enable");
    const Ticket on = rig.Give("a", "continue_route");
    EXPECT_EQ(rig.End(on).state, FeedbackState::kDone);
    EXPECT_EQ(rig.End(rig.b).state, FeedbackState::kDone);
    rig.ExpectAt("a", {2, 4});
    rig.ExpectAt("b", {3, 2});
  }
}

// Commands for coordinates other than X and Y do not end the route; buffered commands wait for its end.
TEST(Routes, GoOnBesideOtherCommands) {
  Crossing rig;
  rig.Do("machine", "start_routes");
  rig.Run(20);
  EXPECT_EQ(rig.ErrorOf("a", "start_external_setpoint_generation", "{mode: relative}"), ErrorId::kCommandMode);
  EXPECT_EQ(rig.ErrorOf("a", "move_c", "{position: 0.0}"), ErrorId::kNone);
  const Ticket next = rig.Give("a", "move_to_position", "{x: 660, y: 540, buffer_mode: buffered}");
  rig.Run(200);
  EXPECT_EQ(rig.answers[next].state, FeedbackState::kBusy);
  EXPECT_TRUE(rig.Mover("a").on_route);
  EXPECT_EQ(rig.End(next).state, FeedbackState::kDone);
  EXPECT_EQ(rig.answers[rig.a].state, FeedbackState::kDone);
  rig.ExpectAt("a", {5, 4});
}

// External set points take over a mover that waits on its route; then it continues from its position.
TEST(Routes, EndWithSetPointsFromOutside) {
  Crossing rig;
  rig.Give("a", "halt");
  rig.Do("machine", "start_routes");
  rig.Do("a", "halt");
  rig.Run(1000);
  rig.ExpectAt("b", {1, 2});
  rig.Give("b", "start_external_setpoint_generation", "{mode: absolute}");
  EXPECT_EQ(rig.End(rig.b).state, FeedbackState::kAborted);
  EXPECT_EQ(rig.ErrorOf("b", "continue_route"), ErrorId::kMoverDisabled);  // none arrived
  rig.Do("b", "reset");
  rig.Give("a", "continue_route");
  EXPECT_EQ(rig.End(rig.Give("b", "continue_route")).state, FeedbackState::kDone);
  rig.ExpectAt("b", {3, 2});
}

// All come to rest at cells without blocking one another; and continue.
TEST(Routes, AreHeld) {
  for (int cycles = 20; cycles < 700; cycles += 45) {
    SCOPED_TRACE(cycles);
    Crossing rig;
    rig.Do("machine", "start_routes");
    rig.Run(cycles);
    EXPECT_EQ(rig.Do("machine", "hold_routes").state, FeedbackState::kDone);
    rig.Run(600);
    EXPECT_TRUE(rig.Rests());
    for (const char* name : {"a", "b", "c"}) {
      const mover::Outputs& at = rig.Mover(name);
      EXPECT_NEAR(std::remainder(at.x - 60, kPitch), 0, 1e-6);
      EXPECT_NEAR(std::remainder(at.y - 60, kPitch), 0, 1e-6);
      EXPECT_EQ(at.route_visit, at.route_granted);
      EXPECT_EQ(at.delay, at.on_route ? mover::Delay::kRelease : mover::Delay::kNone);
    }
    rig.Do("machine", "hold_routes", "{hold: false, movers: [1, 3]}");
    for (const Ticket ticket : {rig.a, rig.c}) EXPECT_EQ(rig.End(ticket).state, FeedbackState::kDone);
    rig.Run(600);
    const bool there = rig.answers[rig.b].state == FeedbackState::kDone;
    if (!there) rig.Do("machine", "hold_routes", "{hold: false}");
    EXPECT_EQ(rig.End(rig.b).state, FeedbackState::kDone);
    EXPECT_EQ(rig.overlaps, 0);
  }
}

// New routes for movers in motion: if they can come to rest they change over, otherwise all continue as before.
TEST(Routes, ChangeOver) {
  Crossing rig;
  rig.Do("machine", "start_routes", "{velocity: 400}");
  while (rig.Mover("a").y < MiddleOf(1) - 20) rig.Run();
  // Too late for visit 1, and b would be left behind a visit that is cancelled.
  rig.Give("a", "set_route", Visits(1, {{{2, 1}}, {{3, 1}}}));
  EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr("cannot come to rest any more"));
  rig.Give("a", "set_route", Visits(2, {{{2, 2}}}));
  EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr("has no new route: mover b"));
  EXPECT_TRUE(rig.Mover("a").on_route);
  // b is bound for the crossing, and a would stay there.
  rig.Give("b", "set_route", Visits(2, {{{2, 2}}, {{3, 2}}}));
  EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr("that one does not leave it: mover b"));
  // a turns off at the crossing, b travels around it.
  rig.Do("machine", "hold_routes");
  const auto a_at = static_cast<int>(rig.Mover("a").route_granted),
             b_at = static_cast<int>(rig.Mover("b").route_granted);
  ASSERT_EQ(a_at, 2);
  ASSERT_EQ(b_at, 1);
  const Ticket a = rig.Give("a", "set_route", Visits(a_at, {{{2, 2}}, {{3, 2}}, {{4, 2}}}));
  const Ticket b = rig.Give("b", "set_route", Visits(b_at, {{{1, 2}}, {{2, 2}, 1, a_at}, {{2, 1}}}));
  EXPECT_EQ(rig.Do("machine", "start_routes", "{velocity: 500}").state, FeedbackState::kDone);
  for (const Ticket old : {rig.a, rig.b}) EXPECT_EQ(rig.answers[old].state, FeedbackState::kAborted);
  rig.Do("machine", "hold_routes", "{hold: false}");
  for (const Ticket ticket : {a, b, rig.c}) EXPECT_EQ(rig.End(ticket).state, FeedbackState::kDone);
  rig.ExpectAt("a", {4, 2});
  rig.ExpectAt("b", {2, 1});
  EXPECT_EQ(rig.Mover("a").route_visit, 4u);
  EXPECT_EQ(rig.overlaps, 0);
}

TEST(Routes, SayWhatWasExpected) {
  Rig rig(Surface({{"a", {0, 0}}, {"b", {3, 0}}}));
  const auto refused = [&](const std::string& arguments) { return rig.Refusal("a", "set_route", arguments); };
  EXPECT_EQ(rig.ErrorOf("a", "set_route", "{first: 1e16, visits: [{x: 60, y: 60}]}"), ErrorId::kParameter);
  EXPECT_THAT(refused(Visits(0, {{{0, 0}}, {{1, 1}}})), HasSubstr("beside the one before"));
  EXPECT_THAT(refused(Visits(0, {{{0, 0}}, {{0, 0}}})), HasSubstr("beside the one before"));
  EXPECT_THAT(refused("{first: 1, continues: true, visits: [{x: 60, y: 60}]}"),
              HasSubstr("the number after the last visit"));
  EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr("no mover was told a route"));
  const struct {
    std::string route;
    const char* sentence;
  } rows[] = {
      {Visits(0, {{{1, 0}}, {{2, 0}}}), "is not in the place of the first visit"},
      {Visits(0, {{{0, 0}}, {{1, 0}, 3, 0}}), "no mover has the number `after`"},
      {Visits(0, {{{0, 0}}, {{1, 0}, 2, 1}}), "has no visit"},
  };
  for (const auto& row : rows) {
    rig.Give("a", "set_route", row.route);
    EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr(row.sentence));
    EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr("mover a"));
    EXPECT_FALSE(rig.Mover("a").on_route);
  }
  EXPECT_THAT(rig.Refusal("a", "continue_route"), HasSubstr("has no route"));
  EXPECT_EQ(rig.ErrorOf("machine", "hold_routes", "{movers: [3]}"), ErrorId::kParameter);
  EXPECT_EQ(rig.ErrorOf("machine", "start_routes", "{velocity: -1}"), ErrorId::kParameter);
  rig.Give("a", "set_route", Visits(0, {{{0, 0}}, {{1, 0}}}));
  rig.Do("a", "disable");
  EXPECT_EQ(rig.ErrorOf("machine", "start_routes"), ErrorId::kMoverDisabled);
  // The numbers of visits continue.
  rig.Do("a", "enable");
  rig.Give("a", "set_route", Visits(0, {{{0, 0}}, {{1, 0}}}));
  rig.Do("machine", "start_routes");
  rig.Run(1000);
  EXPECT_EQ(rig.Mover("a").route_visit, 1u);
  for (const int first : {0, 2}) {
    rig.Give("a", "set_route", Visits(first, {{{1, 0}}, {{0, 0}}}));
    EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr("expected as the first visit"));
  }
  // A replaced route is over; a route to the present position ends at once.
  const Ticket before = rig.Give("a", "set_route", Visits(1, {{{1, 0}}, {{0, 0}}}));
  const Ticket now = rig.Give("a", "set_route", Visits(1, {{{1, 0}}}));
  EXPECT_EQ(rig.End(before).state, FeedbackState::kAborted);
  EXPECT_EQ(rig.Do("machine", "start_routes").state, FeedbackState::kDone);
  EXPECT_EQ(rig.End(now).state, FeedbackState::kDone);
}

// Only the named movers begin; and a route can be taken back.
TEST(Routes, BeginForThoseThatAreNamed) {
  Crossing rig;
  EXPECT_EQ(rig.ErrorOf("machine", "start_routes", "{movers: [4]}"), ErrorId::kParameter);
  EXPECT_THAT(rig.Refusal("machine", "start_routes", "{movers: [2]}"), HasSubstr("has no visit"));  // a stays
  EXPECT_EQ(rig.Do("machine", "start_routes", "{movers: [3]}").state, FeedbackState::kDone);
  EXPECT_EQ(rig.End(rig.c).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Do("b", "set_route", "{first: 0, visits: []}").state, FeedbackState::kDone);
  EXPECT_EQ(rig.answers[rig.b].state, FeedbackState::kAborted);
  EXPECT_THAT(rig.Refusal("machine", "start_routes", "{movers: [1, 2]}"), HasSubstr("told a route: mover b"));
  EXPECT_EQ(rig.Do("machine", "start_routes").state, FeedbackState::kDone);
  EXPECT_EQ(rig.End(rig.a).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Mover("b").x, MiddleOf(0));
}

// Times are a plan only: a wrong one makes a mover late, and never lets it pass out of turn.
TEST(Routes, KeepTheOrderWhateverTheTimes) {
  Crossing rig;
  const auto timed = [](const std::string& departure, const std::string& entry, const std::string& arrival) {
    return "{first: 0, visits: [{x: 60, y: 300, departure_time: " + departure +
           "}, {x: 180, y: 300, entry_time: " + entry +
           "}, {x: 300, y: 300, after: 1, after_visit: 2, entry_time: " + entry +
           "}, {x: 420, y: 300, entry_time: " + entry + arrival + "}]}";
  };
  for (const std::string& bad :
       {timed("0", "0", ""), timed("2", "0", ", arrival_time: 1"),
        std::string("{first: 0, visits: [{x: 60, y: 300, departure_time: 0}, {x: 180, y: 300}, "
                    "{x: 180, y: 420, arrival_time: 1}]}")}) {
    rig.Give("b", "set_route", bad);
    EXPECT_THAT(rig.Refusal("machine", "start_routes"), HasSubstr("times of departure and arrival"));
  }
  const Ticket b = rig.Give("b", "set_route", timed("0", "1000000", ", arrival_time: 1"));
  rig.Do("machine", "start_routes");
  rig.Do("a", "halt");
  rig.Run(3000);
  rig.ExpectAt("b", {1, 2});
  rig.Give("a", "continue_route");
  EXPECT_EQ(rig.End(b).state, FeedbackState::kDone);
  EXPECT_EQ(rig.overlaps, 0);
}

// A mover on a timed route over a crossing, behind another one that is halted: it stops before the crossing.
TEST(Routes, StopBeforeAPlaceThatIsNotGranted) {
  for (int cycles = 1; cycles < 300; cycles += 20) {
    SCOPED_TRACE(cycles);
    Rig rig(Surface({{"a", {4, 0}}, {"b", {0, 2}}}));
    std::string a = "{first: 0, visits: [{x: 540, y: 60, departure_time: 0}", b = "{first: 0, visits: [";
    for (int k = 1; k < 5; ++k) {
      a += ", {x: 540, y: " + std::to_string(60 + 120 * k) + ", exit_time: " + std::to_string(0.1 * k) + "}";
    }
    a.insert(a.size() - 1, ", arrival_time: 0.6");
    for (int k = 0; k < 7; ++k) {
      b += "{x: " + std::to_string(60 + 120 * k) + ", y: 300, entry_time: " + std::to_string(0.15 * k);
      b += k == 0   ? ", departure_time: 0}, "
           : k == 4 ? ", after: 1, after_visit: 2}, "
           : k == 6 ? ", arrival_time: 1}"
                    : "}, ";
    }
    rig.Give("a", "set_route", a + "]}");
    const Ticket route = rig.Give("b", "set_route", b + "]}");
    EXPECT_EQ(rig.Do("machine", "start_routes").state, FeedbackState::kDone);
    rig.Run(cycles);
    EXPECT_EQ(rig.Mover("b").target_x, MiddleOf(6));  // the whole route, though the crossing is not granted yet
    rig.Do("a", "halt");
    rig.Run(1500);
    const bool crossed = rig.Mover("a").y > 300 + 1.5 * kSide / 2;
    if (!crossed) rig.ExpectAt("b", {3, 2});
    EXPECT_EQ(rig.Mover("b").route_visit, rig.Mover("b").route_granted);
    rig.Give("a", "continue_route");
    EXPECT_EQ(rig.End(route).state, FeedbackState::kDone);
    EXPECT_EQ(rig.overlaps, 0);
  }
}

// A mover that would have to wait for one that was taken off its route no longer waits for it: it cannot continue
// behind it.
TEST(Routes, EndBehindOneThatHasAnother) {
  Crossing rig;
  rig.Do("machine", "start_routes");
  rig.Run(20);
  for (const char* name : {"a", "b"}) rig.Do(name, "halt");
  rig.Do("a", "move_to_position", "{x: 300, y: 60}");
  const Ticket other = rig.Give("a", "set_route", Visits(0, {{{2, 0}}, {{3, 0}}}));
  EXPECT_EQ(rig.Do("machine", "start_routes").state, FeedbackState::kDone);
  EXPECT_EQ(rig.End(other).state, FeedbackState::kDone);
  EXPECT_THAT(rig.Refusal("b", "continue_route"), HasSubstr("has no route"));
}

TEST(Routes, AreLeftAsTheyWereByARefusal) {
  Crossing rig;
  rig.Do("machine", "start_routes");
  rig.Run(20);
  rig.Do("a", "halt");
  rig.Do("a", "move_to_position", "{x: 400, y: 180}");
  EXPECT_THAT(rig.Refusal("a", "continue_route"), HasSubstr("not on its route"));
  EXPECT_EQ(rig.Mover("a").route_visit, 0u);
  rig.Do("a", "move_to_position", "{x: 300, y: 60}");
  EXPECT_EQ(rig.End(rig.Give("a", "continue_route")).state, FeedbackState::kDone);
}

// Also at the cell of a mover that is about to leave it: that one continues until then.
TEST(Routes, AreHeldBehindOneThatIsAboutToStart) {
  for (int cycles = 100; cycles < 700; cycles += 12) {
    SCOPED_TRACE(cycles);
    Rig rig(Surface({{"r", {0, 0}}, {"o", {3, 0}}, {"x", {4, 0}}, {"z", {5, 0}}}));
    const auto along = [](int from, int to, int before, int its) {  // behind another one, from cell to cell
      std::vector<Step> steps = {{{from, 0}}};
      for (int x = from + 1; x <= to; ++x) {
        const int visit = x - its;
        visit < 0 ? steps.push_back({{x, 0}}) : steps.push_back({{x, 0}, before, visit});
      }
      return steps;
    };
    std::vector<Ticket> routes = {rig.Give("z", "set_route", Visits(0, {{{5, 0}}, {{5, 1}}}))};
    std::vector<Step> first = along(4, 9, 0, 100);
    first[1].after = 4;
    routes.push_back(rig.Give("x", "set_route", Visits(0, first)));
    routes.push_back(rig.Give("o", "set_route", Visits(0, along(3, 8, 3, 4))));
    routes.push_back(rig.Give("r", "set_route", Visits(0, along(0, 7, 2, 3))));
    rig.Give("machine", "start_routes");
    rig.Run(cycles);
    rig.Do("machine", "hold_routes");
    rig.Run(1500);
    EXPECT_TRUE(rig.Rests());
    rig.ExpectInPlaces();
    rig.Do("machine", "hold_routes", "{hold: false}");
    for (const Ticket route : routes) EXPECT_EQ(rig.End(route).state, FeedbackState::kDone);
    EXPECT_EQ(rig.overlaps, 0);
  }
}

// In every cycle: also when a mover is almost at rest before a cell that is just being granted.
TEST(Routes, AreHeldInEveryCycle) {
  for (int cycles = 290; cycles < 310; ++cycles) {
    SCOPED_TRACE(cycles);
    Rig rig(Surface({{"a", {0, 0}}, {"b", {2, 0}}}));
    rig.Give("b", "set_route", Visits(0, {{{2, 0}}, {{2, 1}}}));
    const Ticket a = rig.Give("a", "set_route", Visits(0, {{{0, 0}}, {{1, 0}}, {{2, 0}, 2, 0}, {{3, 0}}, {{4, 0}}}));
    rig.Give("machine", "start_routes", "{velocity: 600}");
    rig.Run(cycles);
    rig.Give("machine", "hold_routes");
    rig.Run(1000);
    EXPECT_EQ(rig.Mover("a").route_visit, rig.Mover("a").route_granted);
    EXPECT_EQ(rig.Mover("a").x, MiddleOf(static_cast<int>(rig.Mover("a").route_visit)));
    rig.Do("machine", "hold_routes", "{hold: false}");
    EXPECT_EQ(rig.End(a).state, FeedbackState::kDone);
  }
}

// New routes for held movers leave them held; a mover that is not on a route begins at once.
TEST(Routes, StayHeldUntilItIsTakenBack) {
  Crossing rig;
  rig.Do("machine", "start_routes", "{movers: [1]}");
  rig.Run(100);
  rig.Do("machine", "hold_routes");
  rig.Run(600);
  EXPECT_EQ(rig.Do("machine", "start_routes", "{movers: [3]}").state, FeedbackState::kDone);
  EXPECT_EQ(rig.End(rig.c).state, FeedbackState::kDone);
  const auto at = static_cast<int>(rig.Mover("a").route_visit);
  const Ticket a = rig.Give("a", "set_route", Visits(at, {{{2, at}}, {{2, at + 1}}, {{2, at + 2}}, {{2, at + 3}}}));
  EXPECT_EQ(rig.Do("machine", "start_routes", "{movers: [1]}").state, FeedbackState::kDone);
  rig.Run(600);
  EXPECT_EQ(rig.answers[a].state, FeedbackState::kActive);
  EXPECT_EQ(static_cast<int>(rig.Mover("a").route_visit), at);
  rig.Do("machine", "hold_routes", "{hold: false}");
  EXPECT_EQ(rig.End(a).state, FeedbackState::kDone);
}

// Followers of a held mover come to rest at cells, too, and continue with it.
TEST(Routes, AreHeldWithTheirLeader) {
  for (int cycles = 40; cycles < 600; cycles += 40) {
    SCOPED_TRACE(cycles);
    Rig rig(Surface({{"a", {1, 0}}, {"b", {0, 0}}}));
    std::vector<Step> ahead, behind = {{{0, 0}}};
    for (int k = 0; k < 7; ++k) {
      ahead.push_back({{1 + k, 0}});
      if (k < 6) behind.push_back({{1 + k, 0}, 1, k});
    }
    const Ticket a = rig.Give("a", "set_route", Visits(0, ahead)), b = rig.Give("b", "set_route", Visits(0, behind));
    rig.Do("machine", "start_routes");
    rig.Run(cycles);
    rig.Do("machine", "hold_routes", "{movers: [1]}");
    rig.Run(800);
    EXPECT_TRUE(rig.Rests());
    for (const char* name : {"a", "b"}) EXPECT_NEAR(std::remainder(rig.Mover(name).x - 60, kPitch), 0, 1e-6) << name;
    rig.Do("machine", "hold_routes", "{hold: false}");
    for (const Ticket ticket : {a, b}) EXPECT_EQ(rig.End(ticket).state, FeedbackState::kDone);
    EXPECT_EQ(rig.overlaps, 0);
  }
}

// Also in its first cycles of motion.
TEST(Routes, ChangeOverAtOnce) {
  for (int cycles = 0; cycles < 12; ++cycles) {
    SCOPED_TRACE(cycles);
    Rig rig(Surface({{"a", {0, 0}}}));
    const Ticket a = rig.Give("a", "set_route", Visits(0, {{{0, 0}}, {{1, 0}}, {{2, 0}}, {{3, 0}}}));
    rig.Do("machine", "start_routes");
    rig.Run(cycles);
    const Ticket now = rig.Give("a", "set_route", Visits(0, {{{0, 0}}, {{0, 1}}}));
    const bool taken = rig.Do("machine", "start_routes").error == ErrorId::kNone;
    EXPECT_EQ(rig.End(taken ? now : a).state, FeedbackState::kDone);
    taken ? rig.ExpectAt("a", {0, 1}) : rig.ExpectAt("a", {3, 0});
  }
}

TEST(Routes, AreAsLongAsTheyMayBe) {
  Rig rig(Surface({{"a", {0, 0}}}));
  const auto part = [&](int from, int to) {
    std::vector<Step> steps;
    for (int k = from; k < to; ++k) steps.push_back({{k % 2, k / 2 % 2 == 0 ? 0 : 0}});
    std::string text = Visits(from, steps);
    if (from > 0) text.insert(1, "continues: true, ");
    return text;
  };
  const Ticket route = rig.Give("a", "set_route", part(0, 40));
  for (int k = 40; k < 480; k += 40) EXPECT_EQ(rig.Do("a", "set_route", part(k, k + 40)).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Do("a", "set_route", part(480, 512)).state, FeedbackState::kDone);
  EXPECT_THAT(rig.Refusal("a", "set_route", part(512, 513)), HasSubstr("512 visits at most"));
  rig.Do("machine", "start_routes");
  EXPECT_EQ(rig.End(route, 200'000).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Mover("a").route_visit, 511u);
}

// EN-22: nothing continues by itself, and no route can be started meanwhile.
TEST(Routes, EndWithAnEmergencyStop) {
  Crossing rig;
  rig.Do("machine", "start_routes");
  rig.Run(150);
  rig.Do("machine", "emergency_stop", "{hold: true}");
  for (const Ticket ticket : {rig.a, rig.b, rig.c}) EXPECT_EQ(rig.End(ticket).state, FeedbackState::kAborted);
  rig.Run(300);
  const mover::Outputs at = rig.Mover("b");
  EXPECT_EQ(rig.ErrorOf("machine", "start_routes"), ErrorId::kEmergencyStop);
  EXPECT_EQ(rig.ErrorOf("machine", "hold_routes", "{hold: false}"), ErrorId::kEmergencyStop);
  EXPECT_EQ(rig.ErrorOf("machine", "hold_routes"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("a", "continue_route"), ErrorId::kEmergencyStop);
  rig.Do("machine", "release_emergency_stop");
  for (const char* name : {"a", "b", "c"}) rig.Do(name, "enable");
  rig.Run(300);
  EXPECT_EQ(rig.Mover("b").x, at.x);
  for (const char* name : {"b", "a", "c"}) rig.Give(name, "continue_route");
  rig.Run(4000);
  rig.ExpectAt("a", {2, 4});
  rig.ExpectAt("b", {3, 2});
  EXPECT_EQ(rig.overlaps, 0);
}

// --- random worlds ---

struct World {
  static constexpr int kWide = 6;

  World(int movers, std::uint64_t seed) : chance(seed) {
    std::vector<int> places(kWide * kWide);
    for (int i = 0; i < kWide * kWide; ++i) places[static_cast<std::size_t>(i)] = i;
    const auto some = [&] {
      std::shuffle(places.begin(), places.end(), chance);
      return std::vector<routing::CellIndex>(places.begin(), places.begin() + movers);
    };
    problem = {.width = kWide,
               .height = kWide,
               .pitch = kPitch,
               .mover_size = kSide,
               .dynamics = {1000, 5000, 100000},
               .blocked = std::vector<bool>(kWide * kWide),
               .starts = some(),
               .targets = some(),
               .effort = 2000};
    plan = routing::PlanSurface(problem);
  }
  static Cell At(int place) { return {place % kWide, place / kWide}; }
  std::string Machine(bool in_group) const {
    std::vector<std::pair<std::string, Cell>> movers;
    std::string names;
    for (std::size_t i = 0; i < problem.starts.size(); ++i) {
      movers.push_back({"m" + std::to_string(i), At(problem.starts[i])});
      names += movers.back().first + ", ";
    }
    return Surface(movers, in_group ? "planar_groups: [{name: cell, movers: [" + names + "]}]\n" : "");
  }
  // Returns a route of one mover, with or without times.
  std::string Route(std::size_t i, bool timed) const {
    std::string text = "{first: 0, visits: [";
    const auto add = [&](const char* field, double value) {
      text += std::string(", ") + field + ": " + std::to_string(std::max(value, 0.0));
    };
    std::vector<std::string> ends(plan.visits[i].size());
    std::size_t at = 0;
    for (const routing::Leg& leg : plan.legs[i]) {
      const int places =
          std::abs(leg.to - leg.from) < kWide ? std::abs(leg.to - leg.from) : std::abs(leg.to - leg.from) / kWide;
      const double takes = routing::StraightRun(kPitch * places, problem.dynamics).duration();
      ends[at] += ", departure_time: " + std::to_string(leg.departure);
      at += static_cast<std::size_t>(places);
      ends[at] += ", arrival_time: " + std::to_string(leg.departure + takes);
    }
    for (std::size_t k = 0; k < plan.visits[i].size(); ++k) {
      const routing::Visit& visit = plan.visits[i][k];
      const Cell cell = At(visit.place);
      text += "{x: " + std::to_string(MiddleOf(cell.x)) + ", y: " + std::to_string(MiddleOf(cell.y));
      if (visit.before != routing::kNone) {
        text += ", after: " + std::to_string(visit.before + 1) + ", after_visit: " + std::to_string(visit.before_index);
      }
      if (timed) {
        add("entry_time", visit.entry + routing::kEarly);
        add("exit_time", visit.left);
        text += ends[k];
      }
      text += "}, ";
    }
    return text + "]}";
  }

  std::mt19937_64 chance;
  routing::SurfaceProblem problem;
  routing::SurfacePlan plan;
};

// With any halts and holds: no two movers overlap, and all reach their ends. With times, and without disturbances: at
// the planned time.
class RoutesOfWorlds : public testing::TestWithParam<std::tuple<int, bool, bool, bool>> {};

TEST_P(RoutesOfWorlds, GetThereWithoutACollision) {
  const auto [movers, timed, in_group, halts] = GetParam();
  World world(movers, static_cast<std::uint64_t>(movers));
  ASSERT_EQ(world.plan.outcome, routing::Outcome::kPlanned);
  Rig rig(world.Machine(in_group));
  if (in_group) rig.Do("cell", "enable");
  std::vector<Ticket> routes;
  for (std::size_t i = 0; i < world.problem.starts.size(); ++i) {
    routes.push_back(rig.Give("m" + std::to_string(i), "set_route", world.Route(i, timed)));
  }
  ASSERT_EQ(rig.Do("machine", "start_routes").state, FeedbackState::kDone);
  const auto there = [&] {
    return std::ranges::all_of(routes, [&](Ticket t) { return rig.answers[t].state == FeedbackState::kDone; });
  };
  double sum = 0;
  for (int cycle = 0; cycle < 60'000 && !there(); ++cycle) {
    rig.Run();
    for (const Ticket route : routes) sum += rig.answers[route].state == FeedbackState::kDone ? 0 : 0.001;
    if (!halts || world.chance() % 150 != 0) continue;
    const std::size_t one = world.chance() % routes.size();
    const std::string name = "m" + std::to_string(one);
    switch (world.chance() % 3) {
      case 0:
        rig.Do("machine", "hold_routes");
        rig.Run(world.chance() % 2 == 0 ? 600 : static_cast<int>(world.chance() % 400));
        if (rig.Rests()) rig.ExpectInPlaces();
        rig.Do("machine", "hold_routes", "{hold: false}");
        break;
      default:
        if (rig.answers[routes[one]].state == FeedbackState::kDone) break;
        rig.Do(name, "halt");
        rig.Run(static_cast<int>(world.chance() % 200));
        routes[one] = rig.Give(name, "continue_route");
    }
  }
  EXPECT_TRUE(there());
  EXPECT_EQ(rig.overlaps, 0);
  for (std::size_t i = 0; i < routes.size(); ++i) {
    rig.ExpectAt("m" + std::to_string(i), World::At(world.problem.targets[i]));
  }
  EXPECT_LT(sum, (halts || in_group ? 10 : timed ? 1.01 : 1.6) * world.plan.sum);
}

std::string NameOf(const testing::TestParamInfo<std::tuple<int, bool, bool, bool>>& info) {
  const auto [movers, timed, in_group, halts] = info.param;
  return std::to_string(movers) + (timed ? "Timed" : "") + (in_group ? "InGroup" : "") + (halts ? "Halted" : "");
}

INSTANTIATE_TEST_SUITE_P(, RoutesOfWorlds,
                         testing::Combine(testing::Values(8, 24), testing::Bool(), testing::Bool(), testing::Bool()),
                         NameOf);

}  // namespace
}  // namespace takt::engine
