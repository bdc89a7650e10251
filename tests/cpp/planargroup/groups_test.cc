// PL-01, PL-30, PL-31: groups of movers and environments without a machine: their states, and their use of memory.
#include "takt/planargroup/groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <vector>

#include "../core/allocations.h"
#include "takt/core/describe.h"
#include "takt/core/verify.h"
#include "takt/environment/environments.h"
#include "takt/mover/mover.h"

namespace takt::planargroup {
namespace {

using planar::ObjectState;

// A group of two movers and an environment of two stators. The movers are at the given poses.
struct Rig {
  Rig() {
    for (std::uint32_t i = 0; i < 2; ++i) {
      grounds.group_of_mover[i] = 1;
      grounds.movers[i].mover = {113, 113};
      grounds.movers[i].pose.place.x = 240 * i;
    }
    grounds.surfaces = environments.surfaces;
  }
  Context context() { return {groups, grounds, cycle, feedback}; }
  environment::Context environment() { return {environments, grounds, cycle, feedback}; }
  State& state() { return groups.states[0]; }

  Ticket Give(const Command& command) {
    Apply(context(), 0, ++ticket, command);
    return ticket;
  }
  void Step() {
    planargroup::Step(context());
    Publish(context());
    for (const FeedbackEvent& event : feedback.events()) {
      last[event.ticket] = event;
      if (IsFinal(event.state)) ++ends[event.ticket];
    }
    feedback.Clear();
    ++cycle.count;
  }
  FeedbackEvent Do(const Command& command) {
    const Ticket given = Give(command);
    for (int i = 0; i < 10 && ends[given] == 0; ++i) Step();
    return last[given];
  }

  Groups groups{1};
  planar::GroupRegistry grounds{2, 0, 1, {"cell"}};
  environment::Environments environments{{{.name = "floor", .stators = {{-120, -120}, {120, -120}}}}};
  Cycle cycle;
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(64);
  FeedbackSink feedback{storage};
  Ticket ticket = 0;
  std::map<Ticket, FeedbackEvent> last;
  std::map<Ticket, int> ends;
};

// PL-01: with any commands and faults, a group makes only transitions of the table, it watches exactly while it is
// Enabled, and every command ends once.
TEST(PlanarGroups, KeepToTheTransitions) {
  std::mt19937 random(1);
  std::set<ObjectState> seen;
  Rig rig;
  ObjectState before = rig.state().state;
  int refused = 0;
  const auto check = [&] {
    const State& s = rig.state();
    EXPECT_TRUE(planar::IsLegal(before, s.state)) << static_cast<int>(before) << " to " << static_cast<int>(s.state);
    before = s.state;
    seen.insert(s.state);
    EXPECT_EQ(rig.grounds.grounds[0].watches, s.state == ObjectState::kEnabled);
    EXPECT_EQ(s.error != ErrorId::kNone, s.state == ObjectState::kErrorPending || s.state == ObjectState::kError ||
                                             s.state == ObjectState::kResetting);
  };
  for (int i = 0; i < 20'000; ++i) {
    const auto what = random() % 12;
    if (what < 2) rig.Give(Enable{});
    if (what == 2) rig.Give(Disable{});
    if (what == 3) rig.Give(Reset{});
    if (what == 4 && random() % 4 == 0) Fail(rig.context(), 0, ErrorId::kInternal, random() % 2 == 0);
    // Sometimes the movers overlap: then it cannot be enabled.
    if (rig.state().state != ObjectState::kEnabled) rig.grounds.movers[1].pose.place.x = random() % 8 == 0 ? 50 : 240;
    check();
    rig.Step();
    check();
  }
  for (int i = 0; i < 5; ++i) rig.Step();
  for (Ticket t = 1; t <= rig.ticket; ++t) {
    EXPECT_EQ(rig.ends[t], 1) << t;
    refused += rig.last[t].error == ErrorId::kCollision ? 1 : 0;
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(planar::kObjectStates));
  EXPECT_GT(refused, 50);
}

// PL-01: after a quick stop a reset leads back, after an abort to Disabled; disable makes an abort of it.
TEST(PlanarGroups, ResetLeadsWhereTheReactionSays) {
  for (const bool abort : {false, true}) {
    for (const bool disable : {false, true}) {
      Rig rig;
      rig.Do(Enable{});
      EXPECT_EQ(rig.Do(Reset{}).state, FeedbackState::kDone);  // nothing to reset
      ASSERT_EQ(rig.state().state, ObjectState::kEnabled);
      Fail(rig.context(), 0, ErrorId::kInternal, abort);
      EXPECT_EQ(rig.state().state, ObjectState::kErrorPending);
      for (int i = 0; i < 3; ++i) rig.Step();
      ASSERT_EQ(rig.state().state, ObjectState::kError);
      EXPECT_EQ(rig.Do(Enable{}).error, ErrorId::kState);
      if (disable) rig.Do(Disable{});
      rig.Do(Reset{});
      EXPECT_EQ(rig.state().state, abort || disable ? ObjectState::kDisabled : ObjectState::kEnabled);
      EXPECT_EQ(rig.state().error, ErrorId::kNone);
    }
  }
}

// PL-30: the object that prevents enabling is reported.
TEST(PlanarGroups, SayWhoIsInTheWay) {
  Rig rig;
  rig.grounds.movers[1].rests = false;
  FeedbackEvent refused = rig.Do(Enable{});
  EXPECT_EQ(refused.error, ErrorId::kObjectMoves);
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kMover, 2}));
  rig.grounds.movers[1].rests = true;
  rig.grounds.group_of_environment[0] = 1;
  rig.grounds.movers[1].pose.place.x = 310;
  refused = rig.Do(Enable{});
  EXPECT_EQ(refused.error, ErrorId::kCollision);
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kMover, 2}));
  rig.grounds.movers[1].pose.place.x = 303;
  EXPECT_EQ(rig.Do(Enable{}).error, ErrorId::kNone);
  EXPECT_EQ(rig.groups.outputs[0].mover_count, 2u);
  EXPECT_EQ(rig.groups.outputs[0].environment, 1u);
}

// PL-31: an environment that is in use, or being built, stays as it is; invalid stators are reported.
TEST(Environments, AreMadeOutsideTheCycle) {
  Rig rig;
  const auto give = [&](const environment::Command& command) {
    environment::Apply(rig.environment(), 0, ++rig.ticket, command);
    rig.Step();
    return rig.last[rig.ticket];
  };
  const auto make = [&] {
    const auto answer = environment::Make(rig.environments.desk);
    ASSERT_TRUE(answer.has_value());
    environment::Apply(rig.environment(), answer->environment, 0, answer->made);
    rig.Step();
  };
  const environment::State& s = rig.environments.states[0];
  EXPECT_EQ(s.border_count, 4u);
  EXPECT_EQ(give(environment::AddStator{120, 120}).error, ErrorId::kNone);
  const Ticket made = give(environment::CreateBoundary{}).ticket;
  EXPECT_EQ(rig.last[made].state, FeedbackState::kActive);
  EXPECT_EQ(give(environment::AddStator{360, 120}).error, ErrorId::kEnvironmentUsed);
  EXPECT_EQ(give(environment::BoundaryMade{.number = 7}).error, ErrorId::kState);
  make();
  EXPECT_EQ(rig.last[made].state, FeedbackState::kDone);
  EXPECT_EQ(s.border_count, 6u);
  EXPECT_EQ(s.stator_count, 3u);
  EXPECT_EQ(give(environment::AddStator{-100, 100}).error, ErrorId::kNone);
  const Ticket wrong = give(environment::CreateBoundary{}).ticket;
  make();
  EXPECT_EQ(rig.last[wrong].error, ErrorId::kStators);
  EXPECT_EQ(environment::ProblemOf(rig.last[wrong].value), planar::StatorProblem::kOverlap);
  EXPECT_GT(environment::StatorOf(rig.last[wrong].value), 0u);
  // The old boundary stays.
  EXPECT_EQ(s.border_count, 6u);
  EXPECT_EQ(give(environment::AddToGroup{Name::Of("cell")}).error, ErrorId::kNone);
  rig.Do(Enable{});
  for (const environment::Command& command : std::vector<environment::Command>{
           environment::AddStator{360, 120}, environment::CreateBoundary{}, environment::Clear{}}) {
    EXPECT_EQ(give(command).error, ErrorId::kEnvironmentUsed);
  }
  rig.Do(Disable{});
  EXPECT_EQ(give(environment::Clear{}).error, ErrorId::kNone);
  EXPECT_EQ(rig.grounds.surfaces[0], nullptr);
  EXPECT_EQ(rig.Do(Enable{}).error, ErrorId::kNoBoundary);
  EXPECT_EQ(give(environment::CreateBoundary{}).state, FeedbackState::kActive);
  make();
  EXPECT_EQ(environment::ProblemOf(rig.last[rig.ticket].value), planar::StatorProblem::kEmpty);
}

// A boundary that was being built while its group was enabled is not taken over: movers rely on the old one.
TEST(Environments, DoNotChangeUnderAnEnabledGroup) {
  Rig rig;
  const auto give = [&](const environment::Command& command) {
    environment::Apply(rig.environment(), 0, ++rig.ticket, command);
    rig.Step();
    return rig.ticket;
  };
  give(environment::AddToGroup{Name::Of("cell")});
  give(environment::AddStator{1000, 1000});
  const std::uint32_t borders = rig.environments.states[0].border_count;
  const Ticket made = give(environment::CreateBoundary{});
  EXPECT_EQ(rig.Do(Enable{}).error, ErrorId::kNone);
  const auto answer = environment::Make(rig.environments.desk);
  ASSERT_TRUE(answer.has_value());
  environment::Apply(rig.environment(), answer->environment, 0, answer->made);
  rig.Step();
  EXPECT_EQ(rig.last[made].error, ErrorId::kEnvironmentUsed);
  EXPECT_EQ(rig.environments.states[0].border_count, borders);
  rig.Do(Disable{});
  const Ticket again = give(environment::CreateBoundary{});
  const auto second = environment::Make(rig.environments.desk);
  ASSERT_TRUE(second.has_value());
  environment::Apply(rig.environment(), second->environment, 0, second->made);
  rig.Step();
  EXPECT_EQ(rig.last[again].state, FeedbackState::kDone);
  EXPECT_GT(rig.environments.states[0].border_count, borders);
}

// PL-31: the number of stators is limited.
TEST(Environments, HoldSoManyStators) {
  Rig rig;
  const auto give = [&](const environment::Command& command) {
    environment::Apply(rig.environment(), 0, ++rig.ticket, command);
    rig.Step();
    return rig.last[rig.ticket].error;
  };
  for (std::size_t i = 2; i < planar::kMostStators; ++i) {
    ASSERT_EQ(give(environment::AddStator{240.0 * static_cast<double>(i), 0}), ErrorId::kNone);
  }
  EXPECT_EQ(give(environment::AddStator{-480, 0}), ErrorId::kStators);
}

// EN-04: a mover in a group, the group and its environment do not allocate in the cycle.
TEST(PlanarGroups, AllocateNothingInTheCycle) {
  const auto touch = []<typename... T>(const std::variant<T...>*) {
    (TypeOf<T>(), ...);  // the first use allocates
  };
  touch(static_cast<const mover::Command*>(nullptr));
  touch(static_cast<const environment::Command*>(nullptr));
  TypeOf<planar::Place>();
  Rig rig;
  const mover::MoverParams params{.name = "one"};
  mover::State state = mover::MakeState(params);
  mover::TrackNetworkState streets(2, {});
  trajectory::Planner planner;
  const auto context = [&] {
    return mover::Context{params, rig.cycle, planner, rig.feedback, streets, rig.grounds, 0};
  };
  rig.grounds.group_of_environment[0] = 1;
  const long before = AllocationsOfThisThread();
  const auto step = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) {
      mover::Step(context(), mover::Simulate(state), state);
      Step(rig.context());
      rig.feedback.Clear();
      ++rig.cycle.count;
    }
  };
  Apply(rig.context(), 0, 1, Enable{});
  mover::Apply(context(), 2, mover::Enable{}, state);
  step(5);
  ASSERT_TRUE(rig.grounds.grounds[0].watches);
  mover::Apply(context(), 3, mover::MoveToPosition{.x = 60, .y = 0}, state);
  EXPECT_TRUE(rig.grounds.grounds[0].reserved.movers[0].moving);
  step(30);
  mover::Apply(context(), 4, mover::MoveToPosition{.x = 60, .y = 50}, state);
  mover::Apply(context(), 5, mover::MoveToPosition{.x = 240, .y = 0}, state);
  EXPECT_EQ(rig.feedback.events().back().object, (ObjectInfo{ObjectKind::kMover, 2}));
  step(30);
  mover::Apply(context(), 6, mover::Halt{}, state);
  step(500);
  EXPECT_FALSE(rig.grounds.grounds[0].reserved.movers[0].moving);
  mover::Apply(context(), 7, mover::RemoveFromGroup{}, state);
  mover::Apply(context(), 8, mover::AddToGroup{Name::Of("cell")}, state);
  Apply(rig.context(), 0, 9, Disable{});
  step(3);
  environment::Apply(rig.environment(), 0, 10, environment::AddStator{360, 0});
  environment::Apply(rig.environment(), 0, 11, environment::CreateBoundary{});
  EXPECT_EQ(AllocationsOfThisThread(), before);
  const auto answer = environment::Make(rig.environments.desk);
  const long made = AllocationsOfThisThread();
  EXPECT_GT(made, before);
  environment::Apply(rig.environment(), 0, 0, answer->made);
  environment::Apply(rig.environment(), 0, 12, environment::Clear{});
  EXPECT_EQ(AllocationsOfThisThread(), made);
}

// EN-11: all state is described.
TEST(PlanarGroups, AreDescribed) {
  EXPECT_THAT(Verify(TypeOf<State>()), ::testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<planar::GroupReservations>()), ::testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<environment::State>()), ::testing::IsEmpty());
}

}  // namespace
}  // namespace takt::planargroup
