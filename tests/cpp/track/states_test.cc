// PL-01, PL-22: states of tracks and their transitions.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "rig.h"
#include "takt/core/verify.h"

namespace takt::track {
namespace {

using planar::ObjectState;
using planar::Problem;

constexpr AppendLine kLine{.start_x = 0, .start_y = 0, .end_x = 500, .end_y = 0};

// PL-01: the table agrees with the manual's diagram: every state is entered and left, and one transition leads out of
// Error.
TEST(ObjectStates, TableIsThatOfTheManual) {
  std::set<std::pair<ObjectState, ObjectState>> seen;
  std::set<ObjectState> from, to;
  for (const planar::Transition& t : planar::kTransitions) {
    EXPECT_NE(t.from, t.to);
    EXPECT_TRUE(seen.insert({t.from, t.to}).second);
    from.insert(t.from);
    to.insert(t.to);
  }
  EXPECT_EQ(from.size(), static_cast<std::size_t>(planar::kObjectStates));
  EXPECT_EQ(to.size(), static_cast<std::size_t>(planar::kObjectStates));
  using S = ObjectState;
  EXPECT_TRUE(IsLegal(S::kEnabling, S::kDisabling));
  EXPECT_TRUE(IsLegal(S::kDisabling, S::kEnabling));
  EXPECT_FALSE(IsLegal(S::kDisabled, S::kEnabled));
  EXPECT_FALSE(IsLegal(S::kErrorPending, S::kResetting));
  EXPECT_FALSE(IsLegal(S::kError, S::kEnabled));
  for (int s = 0; s < planar::kObjectStates; ++s) {
    const auto state = static_cast<S>(s);
    const bool itself = state == S::kErrorPending;
    EXPECT_EQ(IsLegal(state, S::kErrorPending), state != S::kResetting || itself) << s;
  }
}

TEST(Tracks, AreDescribedToTheLastMember) {
  for (const Type* type : {&TypeOf<State>(), &TypeOf<PendingEdits>(), &TypeOf<Order>(), &TypeOf<Links>(),
                           &TypeOf<Sketch>(), &TypeOf<Outputs>(), &TypeOf<TrackParams>(), &TypeOf<ElementParams>(),
                           &TypeOf<AppendLine>(), &TypeOf<AppendCircle>(), &TypeOf<TrackMade>()}) {
    EXPECT_EQ(Verify(*type), std::vector<std::string>{}) << type->name;
  }
}

// PL-01, PL-22: any commands and faults, in any order: only legal transitions, each command ends once, a mode that fits
// the state; and all states occur.
TEST(Tracks, GoByTheTable) {
  std::mt19937 random(7);
  std::set<ObjectState> seen;
  for (int run = 0; run < 20; ++run) {
    Rig rig(1);
    if (run % 4 != 0) {
      ASSERT_EQ(rig.Do(0, kLine), Problem::kNone);
    }
    Ticket given = 0;
    ObjectState before = rig.state(0).state;
    const auto check = [&] {
      const State& s = rig.state(0);
      EXPECT_TRUE(IsLegal(before, s.state)) << static_cast<int>(before) << " to " << static_cast<int>(s.state);
      before = s.state;
      seen.insert(s.state);
      if (s.state == ObjectState::kEnabled) {
        EXPECT_EQ(s.mode, OperationMode::kStanding);
        EXPECT_TRUE(s.has_length);
      }
      if (s.state == ObjectState::kDisabled) {
        EXPECT_EQ(s.mode, OperationMode::kUninitialized);
      }
      EXPECT_EQ(s.error != ErrorId::kNone, s.state == ObjectState::kErrorPending || s.state == ObjectState::kError ||
                                               s.state == ObjectState::kResetting);
    };
    for (int i = 0; i < 2000; ++i) {
      switch (random() % 12) {
        case 0:
        case 1:
          given = rig.Give(0, Enable{});
          break;
        case 2:
          given = rig.Give(0, Disable{});
          break;
        case 3:
          given = rig.Give(0, Reset{});
          break;
        case 4:
          if (random() % 4 == 0) Fail(rig.context(), 0, ErrorId::kInternal, static_cast<ErrorReaction>(random() % 2));
          break;
        default:
          break;
      }
      check();
      rig.Step();
      check();
      rig.Work();
    }
    rig.Steps(5);
    for (Ticket t = 1; t <= given; ++t) EXPECT_EQ(rig.ends[t], 1) << t;
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(planar::kObjectStates));
}

// PL-01: after a quick stop a reset leads back, after an abort to Disabled; disable makes an abort of it.
TEST(Tracks, ResetLeadsWhereTheReactionSays) {
  for (const bool abort : {false, true}) {
    for (const bool disable : {false, true}) {
      Rig rig(1);
      rig.Do(0, kLine);
      rig.Do(0, Enable{});
      rig.Do(0, Reset{});  // nothing to reset
      ASSERT_EQ(rig.state(0).state, ObjectState::kEnabled);
      Fail(rig.context(), 0, ErrorId::kInternal, abort ? ErrorReaction::kAbort : ErrorReaction::kQuickStop);
      EXPECT_EQ(rig.state(0).state, ObjectState::kErrorPending);
      rig.Steps(3);
      ASSERT_EQ(rig.state(0).state, ObjectState::kError);
      const Ticket enable = rig.Give(0, Enable{});
      rig.Steps(1);
      EXPECT_EQ(rig.last[enable].error, ErrorId::kState);
      if (disable) rig.Do(0, Disable{});
      rig.Do(0, Reset{});
      EXPECT_EQ(rig.state(0).state, abort || disable ? ObjectState::kDisabled : ObjectState::kEnabled);
      EXPECT_EQ(rig.state(0).error, ErrorId::kNone);
    }
  }
}

// PL-22: only a track at rest is disabled; nor is its geometry changed while movers are on it.
TEST(Tracks, AreNotDisabledInUse) {
  Rig rig(1);
  rig.Do(0, kLine);
  rig.Do(0, Enable{});
  for (const bool moves : {true, false}) {
    Use({1, moves, !moves, 4}, 0, rig.tracks);
    ASSERT_EQ(rig.state(0).mode, moves ? OperationMode::kMoving : OperationMode::kConfiguring);
    const Ticket disable = rig.Give(0, Disable{});
    rig.Steps(3);
    EXPECT_EQ(rig.last[disable].error, ErrorId::kTrackMode);
    EXPECT_EQ(rig.last[disable].object, ObjectAt(ObjectKind::kMover, 4));
    EXPECT_EQ(rig.state(0).state, ObjectState::kEnabled);
  }
  Use({1, false, false, 2}, 0, rig.tracks);
  rig.Do(0, Disable{});
  EXPECT_EQ(rig.state(0).state, ObjectState::kDisabled);
  const Ticket clear = rig.Give(0, Clear{});
  rig.Steps(3);
  EXPECT_EQ(rig.last[clear].error, ErrorId::kTrackMode);
  EXPECT_EQ(rig.last[clear].object, ObjectAt(ObjectKind::kMover, 2));
  EXPECT_EQ(rig.state(0).length, 500);
}

// Elements given before Enable are built first.
TEST(Tracks, EnableWaitsForTheGeometry) {
  Rig rig(2);
  rig.Give(1, kLine);
  const Ticket line = rig.Give(0, kLine);
  const Ticket enable = rig.Give(0, Enable{});
  for (int i = 0; i < 10; ++i) rig.Step();  // without a builder
  EXPECT_EQ(rig.state(0).state, ObjectState::kEnabling);
  EXPECT_EQ(rig.ends[line] + rig.ends[enable], 0);
  EXPECT_EQ(rig.End(enable), Problem::kNone);
  EXPECT_EQ(rig.ends[line], 1);
  EXPECT_EQ(rig.state(0).state, ObjectState::kEnabled);
  EXPECT_EQ(rig.tracks.outputs[0].length, 500);
}

}  // namespace
}  // namespace takt::track
