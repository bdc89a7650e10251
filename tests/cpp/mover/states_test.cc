// PL-01, PL-02, PL-10: states, command modes and feedback of a mover.
#include <set>
#include <utility>

#include "rig.h"
#include "troop.h"

namespace takt::mover {
namespace {

using planar::ObjectState;

TEST(MoverStates, BeginsDisabledAndIsEnabledWithinACycle) {
  Rig rig;
  EXPECT_EQ(rig.out.state, ObjectState::kDisabled);
  const Ticket enable = rig.Give(Enable{});
  rig.Step();
  EXPECT_EQ(rig.out.state, ObjectState::kEnabling);
  EXPECT_EQ(rig.Of(enable).state, FeedbackState::kActive);
  rig.Step();
  EXPECT_EQ(rig.out.state, ObjectState::kEnabled);
  EXPECT_EQ(rig.Of(enable).state, FeedbackState::kDone);
}

// PL-01: enable while it is being disabled, and the reverse; the mover comes to rest first.
TEST(MoverStates, EnableAndDisableTakeOverFromOneAnother) {
  Rig rig;
  rig.Enable();
  const Ticket move = rig.Give(MoveToPosition{.x = 1000});
  rig.Run(200);
  ASSERT_GT(rig.out.velocity_x, 100);
  const Ticket disable = rig.Give(Disable{});
  rig.Run(3);
  EXPECT_EQ(rig.Of(move).state, FeedbackState::kAborted);
  EXPECT_EQ(rig.out.state, ObjectState::kDisabling);
  const Ticket enable = rig.Give(Enable{});
  EXPECT_EQ(rig.Of(disable).state, FeedbackState::kAborted);
  rig.Step();
  EXPECT_EQ(rig.out.state, ObjectState::kEnabling);
  EXPECT_GT(rig.out.velocity_x, 0);
  rig.Finish(enable);
  EXPECT_EQ(rig.Of(enable).state, FeedbackState::kDone);
  EXPECT_EQ(rig.out.velocity_x, 0);
  EXPECT_EQ(rig.out.state, ObjectState::kEnabled);

  rig.Give(Disable{});
  rig.Run(5);
  const Ticket second = rig.Give(Enable{});
  const Ticket third = rig.Give(Disable{});
  EXPECT_EQ(rig.Of(second).state, FeedbackState::kAborted);
  EXPECT_EQ(rig.Become(third), FeedbackState::kDone);
  EXPECT_EQ(rig.out.state, ObjectState::kDisabled);
}

// A mover that is disabled brakes with its maximum dynamics, over the distance of the planner's closed form.
TEST(MoverStates, DisableBrakesWithTheMaximum) {
  Rig rig;
  rig.Enable();
  rig.Give(
      MoveToPosition{.x = 2000, .velocity = 800.0, .acceleration = 2000.0, .deceleration = 1000.0, .jerk = 20000.0});
  rig.Run(700);
  ASSERT_NEAR(rig.out.velocity_x, 800, 1e-6);
  const double stop = trajectory::StopPosition(rig.state.set_point[kX], rig.params.xy.maximum.limits());
  rig.Finish(rig.Give(Disable{}));
  EXPECT_NEAR(rig.out.x, stop, 1e-6);
}

// PL-01: a reset leads back to Enabled after a quick stop, to Disabled after an abort, into which disable turns it.
TEST(MoverStates, ErrorsLeadBackByReset) {
  for (const int aborted_in : {0, 1, 2, 3}) {
    Rig rig;
    rig.Enable();
    const Ticket move = rig.Give(MoveToPosition{.x = 1000});
    rig.Run(200);
    Fail(rig.context(), ErrorId::kOverrun, rig.state);
    rig.Step();
    EXPECT_EQ(rig.Of(move).state, FeedbackState::kError);
    EXPECT_EQ(rig.Of(move).error, ErrorId::kOverrun);
    EXPECT_EQ(rig.out.state, ObjectState::kErrorPending);
    EXPECT_EQ(rig.Of(rig.Give(Reset{})).error, ErrorId::kState);
    if (aborted_in == 1) rig.Give(Disable{});
    rig.Run(500);
    EXPECT_EQ(rig.out.state, ObjectState::kError);
    EXPECT_EQ(rig.out.error, ErrorId::kOverrun);
    EXPECT_EQ(rig.out.velocity_x, 0);
    EXPECT_EQ(rig.Of(rig.Give(Enable{})).error, ErrorId::kState);
    EXPECT_EQ(rig.Of(rig.Give(MoveToPosition{})).error, ErrorId::kMoverDisabled);
    if (aborted_in == 2) rig.Give(Disable{});
    const Ticket reset = rig.Give(Reset{});
    rig.Step();
    EXPECT_EQ(rig.out.state, ObjectState::kResetting);
    if (aborted_in == 3) rig.Give(Disable{});
    EXPECT_EQ(rig.Become(reset), FeedbackState::kDone);
    EXPECT_EQ(rig.out.state, aborted_in == 0 ? ObjectState::kEnabled : ObjectState::kDisabled);
    EXPECT_EQ(rig.out.error, ErrorId::kNone);
  }
}

// A mover that was disabled anyway is disabled after its reset, too.
TEST(MoverStates, AFaultOfADisabledMoverLeadsToDisabled) {
  for (const bool disabling : {true, false}) {
    Rig rig;
    if (disabling) {
      rig.Enable();
      rig.Give(MoveToPosition{.x = 1000});
      rig.Run(200);
      rig.Give(Disable{});
      rig.Run(3);
    }
    Fail(rig.context(), ErrorId::kOverrun, rig.state);
    rig.Run(500);
    EXPECT_EQ(rig.out.state, ObjectState::kError);
    EXPECT_TRUE(IsOff(rig.state));
    rig.Finish(rig.Give(Reset{}));
    EXPECT_EQ(rig.out.state, ObjectState::kDisabled);
  }
}

// Every command in every mode: a command that the table of modes does not name is refused.
TEST(MoverStates, WhatAModeDoesNotAcceptIsRefused) {
  Rig rig({.initial = {.c = 20}});
  rig.Enable();
  EXPECT_EQ(rig.out.command_mode, CommandMode::kCRotationFreeMovement);
  EXPECT_EQ(rig.Of(rig.Give(MoveToPosition{.x = 1})).error, ErrorId::kCommandMode);
  EXPECT_EQ(rig.Of(rig.Give(StartExternalSetpointGeneration{})).error, ErrorId::kCommandMode);
  EXPECT_EQ(rig.Of(rig.Give(SetExternalSetpoint{})).error, ErrorId::kCommandMode);
  EXPECT_EQ(rig.Of(rig.Give(StopExternalSetpointGeneration{})).error, ErrorId::kCommandMode);
  EXPECT_EQ(rig.Of(rig.Give(SetPosition{})).error, ErrorId::kState);
  EXPECT_EQ(rig.Become(rig.Give(MoveZ{.position = 2})), FeedbackState::kDone);
}

TEST(MoverStates, ADisabledMoverIsToldWhereItIs) {
  Rig rig;
  EXPECT_EQ(rig.Of(rig.Give(SetPosition{.x = 10, .y = -20, .c = 45})).state, FeedbackState::kDone);
  rig.Step();
  EXPECT_EQ(rig.out.x, 10);
  EXPECT_EQ(rig.out.y, -20);
  EXPECT_EQ(rig.out.c, 45);
  EXPECT_EQ(rig.out.command_mode, CommandMode::kCRotationFreeMovement);
  rig.Step();
  EXPECT_EQ(rig.out.actual_x, 10);
}

// PL-03: the actual position is checked if the machine file says so.
TEST(MoverStates, ADeviationIsAFault) {
  for (const bool watched : {true, false}) {
    Rig rig({.deviation = watched ? std::optional(2.0) : std::nullopt});
    rig.Enable();
    rig.Give(MoveToPosition{.x = 300});
    rig.Run(150);
    EXPECT_EQ(rig.out.state, ObjectState::kEnabled);
    rig.inputs.actual.y += 1.9;
    rig.Step();
    EXPECT_EQ(rig.out.state, ObjectState::kEnabled);
    rig.inputs.actual.y += 2.1;
    rig.Step();
    EXPECT_EQ(rig.out.error, watched ? ErrorId::kMoverDeviation : ErrorId::kNone);
  }
}

// PL-01, PL-02, PL-10: random commands at random times: only transitions of the tables occur, and every command ends
// once.
TEST(MoverStates, RandomWalkKeepsToTheTables) {
  std::mt19937 random(7);
  std::set<std::pair<ObjectState, ObjectState>> seen;
  std::set<std::pair<CommandMode, CommandMode>> modes;
  for (int run = 0; run < 200; ++run) {
    Rig rig({.c_modulus = 360});
    ObjectState state = rig.state.state;
    CommandMode mode = rig.state.mode;
    const auto look = [&] {
      ASSERT_TRUE(planar::IsLegal(state, rig.state.state))
          << static_cast<int>(state) << " to " << static_cast<int>(rig.state.state);
      ASSERT_TRUE(IsLegal(mode, rig.state.mode))
          << static_cast<int>(mode) << " to " << static_cast<int>(rig.state.mode);
      if (state != rig.state.state) seen.insert({state, rig.state.state});
      if (mode != rig.state.mode) modes.insert({mode, rig.state.mode});
      state = rig.state.state;
      mode = rig.state.mode;
    };
    for (int i = 0; i < 60; ++i) {
      switch (Whole(random, 0, 18)) {
        case 0:
        case 1:
        case 2:
          rig.Give(Enable{});
          break;
        case 3:
          rig.Give(Disable{});
          break;
        case 4:
        case 5:
          rig.Give(Reset{});
          break;
        case 6:
          rig.Give(Halt{});
          break;
        case 7:
        case 8:
          rig.Give(MoveToPosition{.x = Uniform(random, -500, 500), .y = Uniform(random, -500, 500)});
          break;
        case 9:
          rig.Give(MoveC{.position = Uniform(random, -200, 200), .direction = TurnDirection::kShortestWay});
          break;
        case 10:
          rig.Give(StartExternalSetpointGeneration{});
          break;
        case 11: {
          const Place at = Simulate(rig.state).actual;
          rig.Give(SetExternalSetpoint{.x = at.x, .y = at.y, .z = at.z, .c = at.c});
          break;
        }
        case 12:
          rig.Give(StopExternalSetpointGeneration{});
          break;
        case 13:
          rig.Give(MoveX{.position = Uniform(random, -500, 500)});
          break;
        case 14:
          rig.Give(MoveVelocityY{.velocity = Uniform(random, -500, 500)});
          break;
        case 15:
          rig.Give(MoveVelocityC{.velocity = Uniform(random, -500, 500)});
          break;
        case 16:
          rig.Give(HaltX{});
          rig.Give(HaltY{});
          break;
        case 17:
          rig.Give(HaltC{});
          break;
        default:
          if (Whole(random, 0, 2) == 0) Fail(rig.context(), ErrorId::kOverrun, rig.state);
      }
      look();
      const int cycles = Whole(random, 0, 3) == 0 ? 400 : Whole(random, 0, 3);
      for (int k = 0; k < cycles; ++k) {
        rig.Step();
        look();
      }
    }
    rig.Give(Disable{});
    rig.Run(3000);
    for (Ticket ticket = 1; ticket <= rig.ticket; ++ticket) {
      ASSERT_TRUE(IsFinal(rig.Of(ticket).state)) << ticket;
    }
  }
  // All transitions but a fault during a fault, which changes nothing.
  EXPECT_EQ(seen.size(), planar::kTransitions.size() - 1);
  EXPECT_EQ(modes.size(), 4u);  // those without tracks and external turns
}

// PL-70: the last hundred commands, in order, with their results.
TEST(MoverStates, KeepsItsLastCommands) {
  Rig rig;
  rig.Give(MoveZ{.position = 1});
  rig.Enable();
  const Ticket first = rig.Give(MoveToPosition{.x = 100});
  rig.Run(10);
  const Ticket second = rig.Give(MoveToPosition{.x = 50});
  rig.Finish(second);
  const History& history = rig.state.history;
  EXPECT_EQ(history.count, 4u);
  EXPECT_EQ(history.records[0].error, ErrorId::kMoverDisabled);
  EXPECT_EQ(history.records[1].state, FeedbackState::kDone);
  EXPECT_EQ(history.records[2].ticket, first);
  EXPECT_EQ(history.records[2].state, FeedbackState::kAborted);
  EXPECT_EQ(history.records[2].changed - history.records[2].cycle, 10u);
  EXPECT_EQ(history.records[3].ticket, second);
  EXPECT_EQ(history.records[3].state, FeedbackState::kDone);
  EXPECT_EQ(&TypeOfCommand(history.records[3].command), &TypeOf<MoveToPosition>());
  for (int i = 0; i < 250; ++i) rig.Give(MoveZ{.position = 99});
  EXPECT_EQ(history.count, 254u);
  std::set<Ticket> kept;
  for (const Record& record : history.records) kept.insert(record.ticket);
  EXPECT_EQ(kept.size(), kHistory);
  EXPECT_EQ(*kept.begin(), rig.ticket - kHistory + 1);
}

// A reduction is reported with its command, also after later commands.
TEST(MoverStates, KeepsWhatWasReduced) {
  Rig rig;
  rig.Enable();
  rig.Give(MoveToPosition{.x = 100, .velocity = 1e5});
  rig.Give(MoveZ{.position = 1, .jerk = 1e9});
  rig.Give(MoveToPosition{.x = 50, .buffer_mode = Buffering::kBuffered});
  rig.Step();
  const History& history = rig.state.history;
  EXPECT_EQ(history.records[1].limited_by, LimitedBy::kVelocity);
  EXPECT_EQ(history.records[2].limited_by, LimitedBy::kJerk);
  rig.Run(2000);
  EXPECT_EQ(history.records[1].limited_by, LimitedBy::kVelocity);
  EXPECT_EQ(history.records[3].state, FeedbackState::kDone);
  EXPECT_EQ(history.records[3].limited_by, LimitedBy::kNothing);
}

// PL-81: set_position puts no mover onto another one, with or without a group; side by side there is room.
TEST(MoverStates, IsSetOntoNoOtherMover) {
  struct Case {
    double x, y, c;
    bool room;
  };
  const Case cases[] = {{400, 0, 0, false},   {400 - 112.9, 0, 0, false}, {400 - 113, 0, 0, true},
                        {400, 113, 0, true},  {400 - 130, 0, 45, false},  {400 - 137, 0, 45, true},
                        {310, 100, 0, false}, {-50, 20, 10, true}};  // the last one: its own position
  for (const Case& k : cases) {
    Troop troop({Turning(0, 0), Turning(400, 0)});
    const Ticket set = troop.Give(0, SetPosition{.x = k.x, .y = k.y, .c = k.c});
    const FeedbackEvent& of = troop.Of(set);
    EXPECT_EQ(of.state, k.room ? FeedbackState::kDone : FeedbackState::kError) << k.x << " " << k.y << " " << k.c;
    troop.Run(2);
    EXPECT_EQ(troop.outs[0].x, k.room ? k.x : 0);
    EXPECT_EQ(troop.outs[0].c, k.room ? k.c : 0);
    if (k.room) continue;
    EXPECT_EQ(of.error, ErrorId::kCollision);
    EXPECT_EQ(of.object, (ObjectInfo{ObjectKind::kMover, 2}));
  }
}

}  // namespace
}  // namespace takt::mover
