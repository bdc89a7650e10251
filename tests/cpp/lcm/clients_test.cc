#include "takt/lcm/clients.h"

#include <gtest/gtest.h>

#include <optional>

#include "takt/core/describe.h"
#include "takt/engine/components.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

// A mock engine that records commands.
class ClientsTest : public testing::Test {
 protected:
  Clients Make(const ClientLimits& limits = {}) {
    return Clients(
        machine_, kRunId,
        [this](const engine::Command& command) {
          if (queue_is_full_) return Ticket{0};
          submitted_.push_back(command);
          return Ticket{submitted_.size()};
        },
        limits);
  }

  static msgs::command Command(std::int64_t id, const std::string& verb = "move_absolute",
                               const std::string& arguments = "{position: 10}") {
    msgs::command m{};
    m.run_id = kRunId;
    m.client = "anna";
    m.session = 1;
    m.id = id;
    m.target = "x";
    m.verb = verb;
    m.arguments = arguments;
    return m;
  }
  static msgs::command Jog(std::int64_t id) { return Command(id, "jog", "{forward: true}"); }
  static msgs::heartbeat Heartbeat(std::int64_t session = 1) {
    msgs::heartbeat m{};
    m.run_id = kRunId;
    m.client = "anna";
    m.session = session;
    return m;
  }
  static std::vector<msgs::feedback> Replies(Clients& clients) {
    std::vector<msgs::feedback> replies;
    for (msgs::feedback reply; clients.TakeReply(reply);) replies.push_back(reply);
    return replies;
  }
  static msgs::feedback OneReply(Clients& clients) {
    const auto replies = Replies(clients);
    EXPECT_EQ(replies.size(), 1u);
    return replies.empty() ? msgs::feedback{} : replies[0];
  }
  static void ExpectError(const msgs::feedback& reply, ErrorId error, const std::string& part_of_sentence) {
    EXPECT_EQ(reply.state, msgs::feedback::STATE_ERROR);
    EXPECT_EQ(reply.error_id, static_cast<int>(error)) << reply.sentence;
    EXPECT_NE(reply.sentence.find(part_of_sentence), std::string::npos) << reply.sentence;
  }
  // Returns the first component that understands the verb.
  std::string TargetOf(const engine::Verb& verb) const {
    for (const engine::ComponentKind& kind : engine::ComponentKinds()) {
      if (kind.name == verb.target_kind) return std::string(kind.name_of(machine_, 0));
    }
    return "machine";
  }
  std::vector<Ticket> Renewed() const {
    std::vector<Ticket> tickets;
    for (const engine::Command& command : submitted_) {
      if (const auto* body = std::get_if<engine::MachineCommand>(&command.body)) {
        if (const auto* renew = std::get_if<engine::Renew>(body)) tickets.push_back(renew->ticket);
      }
    }
    return tickets;
  }

  const engine::Machine machine_ =
      WithPart(WithGround(WithTrack(WithMover(WithPicker(WithBelt(WithGroup(WithModule(TestMachine()))))))));
  std::vector<engine::Command> submitted_;
  bool queue_is_full_ = false;
};

// EN-22
TEST_F(ClientsTest, FeedbackGoesToTheCommandItIsAbout) {
  Clients clients = Make();
  clients.OnCommand(Command(5), 0);
  EXPECT_TRUE(Replies(clients).empty());  // the cycle answers
  clients.OnFeedback({1, 76, FeedbackState::kBusy, false, ErrorId::kNone});
  const msgs::feedback busy = OneReply(clients);
  EXPECT_EQ(busy.client, "anna");
  EXPECT_EQ(busy.session, 1);
  EXPECT_EQ(busy.id, 5);
  EXPECT_EQ(busy.ticket, 1);
  EXPECT_EQ(busy.cycle, 76);
  EXPECT_EQ(busy.state, msgs::feedback::STATE_BUSY);
  clients.OnFeedback({1, 77, FeedbackState::kDone, false, ErrorId::kNone});
  const msgs::feedback done = OneReply(clients);
  EXPECT_EQ(done.client, "anna");
  EXPECT_EQ(done.id, 5);
  EXPECT_EQ(done.cycle, 77);
  EXPECT_EQ(done.state, msgs::feedback::STATE_DONE);
}

// EN-22
TEST_F(ClientsTest, TheSameIdAgainIsAnsweredAgainAndNeverGivenTwice) {
  Clients clients = Make();
  clients.OnCommand(Command(1), 0);
  clients.OnCommand(Command(1), 0);
  const msgs::feedback not_there_yet = OneReply(clients);
  EXPECT_EQ(not_there_yet.state, msgs::feedback::STATE_BUSY);
  EXPECT_EQ(not_there_yet.cycle, -1);
  clients.OnFeedback({1, 3, FeedbackState::kActive, false, ErrorId::kNone});
  Replies(clients);
  clients.OnCommand(Command(1), 0);
  EXPECT_EQ(OneReply(clients).state, msgs::feedback::STATE_ACTIVE);
  clients.OnFeedback({1, 4, FeedbackState::kAborted, false, ErrorId::kNone});
  Replies(clients);
  for (int i = 0; i < 100; ++i) clients.OnCommand(Command(1), 0);
  const auto replies = Replies(clients);
  ASSERT_EQ(replies.size(), 100u);
  EXPECT_EQ(replies.back().state, msgs::feedback::STATE_ABORTED);
  EXPECT_EQ(replies.back().cycle, 4);
  EXPECT_EQ(submitted_.size(), 1u);
}

// EN-22
TEST_F(ClientsTest, WhatIsUnknownOrWrongIsAnsweredWithASentence) {
  Clients clients = Make();
  msgs::command unknown_target = Command(1);
  unknown_target.target = "nobody";
  clients.OnCommand(unknown_target, 0);
  ExpectError(OneReply(clients), ErrorId::kUnknownTarget, "nobody");
  clients.OnCommand(Command(2, "move_absolut"), 0);
  ExpectError(OneReply(clients), ErrorId::kUnknownVerb, "move_absolut");
  clients.OnCommand(Command(3, "move_absolute", "{position: fast}"), 0);
  ExpectError(OneReply(clients), ErrorId::kParameter, "position");
  clients.OnCommand(Command(4, "move_absolute", "{"), 0);
  EXPECT_FALSE(OneReply(clients).sentence.empty());
  clients.OnCommand(Command(5, "move_absolute", std::string(100'000, ' ')), 0);
  ExpectError(OneReply(clients), ErrorId::kParameter, "longer");
  clients.OnCommand(Command(0), 0);
  ExpectError(OneReply(clients), ErrorId::kParameter, "id");
  clients.OnCommand(Command(-1), 0);
  ExpectError(OneReply(clients), ErrorId::kParameter, "id");
  EXPECT_TRUE(submitted_.empty());
}

// EN-22: every number of every command.
TEST_F(ClientsTest, NotANumberAndInfinityAreRefusedEverywhere) {
  Clients clients = Make();
  std::int64_t id = 0;
  for (const engine::Verb& verb : engine::Verbs()) {
    const std::string target = TargetOf(verb);
    for (const Field& field : verb.arguments->fields) {
      const Type& type = field.type->kind == Kind::kOptional ? *field.type->element : *field.type;
      if (type.kind != Kind::kReal) continue;
      for (const char* value : {"nan", ".nan", "NaN", "inf", ".inf", "-.inf", "-inf", "Infinity", "1e999", "-1e999"}) {
        msgs::command m = Command(++id, std::string(verb.name), "{" + std::string(field.name) + ": " + value + "}");
        m.target = target;
        clients.OnCommand(m, 0);
        ExpectError(OneReply(clients), ErrorId::kParameter, std::string(field.name));
      }
    }
  }
  EXPECT_GT(id, 1000);
  EXPECT_TRUE(submitted_.empty());
}

// EN-22
TEST_F(ClientsTest, AFullQueueRefusesForGood) {
  Clients clients = Make();
  queue_is_full_ = true;
  clients.OnCommand(Command(1), 0);
  ExpectError(OneReply(clients), ErrorId::kQueueFull, std::string(ErrorText(ErrorId::kQueueFull)));
  queue_is_full_ = false;
  clients.OnCommand(Command(1), 0);  // the client knows already that it failed
  ExpectError(OneReply(clients), ErrorId::kQueueFull, "");
  EXPECT_TRUE(submitted_.empty());
  clients.OnCommand(Command(2), 0);
  EXPECT_EQ(submitted_.size(), 1u);
}

// EN-22
TEST_F(ClientsTest, TwoClientsWithOneName) {
  Clients clients = Make();
  msgs::command second = Command(1);
  second.session = 2;
  clients.OnHeartbeat(Heartbeat(1), 0);
  EXPECT_TRUE(Replies(clients).empty());

  clients.OnCommand(second, kSecond);
  const msgs::feedback refused = OneReply(clients);
  ExpectError(refused, ErrorId::kClientName, "anna");
  EXPECT_EQ(refused.session, 2);
  EXPECT_EQ(refused.id, 1);
  clients.OnHeartbeat(Heartbeat(2), kSecond);
  const msgs::feedback heartbeat = OneReply(clients);
  ExpectError(heartbeat, ErrorId::kClientName, "anna");
  EXPECT_EQ(heartbeat.id, 0);
  EXPECT_TRUE(submitted_.empty());

  clients.OnCommand(Command(1), 2 * kSecond);  // the first one is not affected
  EXPECT_EQ(submitted_.size(), 1u);
  clients.OnCommand(second, 4 * kSecond + 1);  // the first one has been silent for 2 s
  EXPECT_EQ(submitted_.size(), 2u);
  EXPECT_TRUE(Replies(clients).empty());
  clients.OnFeedback({1, 9, FeedbackState::kDone, false, ErrorId::kNone});  // of the ended session
  EXPECT_TRUE(Replies(clients).empty());
  clients.OnFeedback({2, 9, FeedbackState::kDone, false, ErrorId::kNone});
  EXPECT_EQ(OneReply(clients).session, 2);
}

// EN-23: of a module's commands only its jog.
TEST_F(ClientsTest, AHeartbeatRenewsTheJogOfAModule) {
  Clients clients = Make();
  msgs::command control = Command(1, "control", "{stop: true}"), jog = Command(2, "jog", "{positive: true}");
  control.target = jog.target = "cutter";
  clients.OnCommand(control, 0);
  clients.OnCommand(jog, 0);
  ASSERT_EQ(submitted_.size(), 2u);
  EXPECT_EQ(submitted_[0].lease_s, 0);
  EXPECT_EQ(submitted_[1].lease_s, machine_.lcm.dead_man_s);
  clients.OnHeartbeat(Heartbeat(), 1);
  EXPECT_EQ(Renewed(), (std::vector<Ticket>{2}));
}

// EN-23
TEST_F(ClientsTest, AHeartbeatRenewsWhatIsLevelSensitiveAndAlive) {
  Clients clients = Make();
  clients.OnCommand(Command(1), 0);
  clients.OnCommand(Jog(2), 0);
  clients.OnCommand(Jog(3), 0);
  ASSERT_EQ(submitted_.size(), 3u);
  EXPECT_EQ(submitted_[0].lease_s, 0);
  EXPECT_EQ(submitted_[1].lease_s, machine_.lcm.dead_man_s);
  clients.OnHeartbeat(Heartbeat(), 1);
  EXPECT_EQ(Renewed(), (std::vector<Ticket>{2, 3}));
  clients.OnFeedback({2, 5, FeedbackState::kAborted, false, ErrorId::kNone});
  submitted_.clear();
  clients.OnHeartbeat(Heartbeat(), 2);
  EXPECT_EQ(Renewed(), (std::vector<Ticket>{3}));

  msgs::heartbeat other = Heartbeat();
  other.client = "berta";
  submitted_.clear();
  clients.OnHeartbeat(other, 3);
  EXPECT_TRUE(submitted_.empty());
}

// EN-23, AX-37: a held stop is done when the axis is at rest, and kept alive until it is released.
TEST_F(ClientsTest, AHeldStopIsRenewedUntilItIsReleased) {
  Clients clients = Make();
  const auto release = [](std::int64_t id, const char* arguments) {
    msgs::command m = Command(id, "release", arguments);
    m.target = "machine";
    return m;
  };
  const auto renewed = [&] {
    submitted_.clear();
    clients.OnHeartbeat(Heartbeat(), 1);
    return Renewed();
  };
  clients.OnCommand(Command(1, "stop", "{hold: true}"), 0);
  clients.OnFeedback({1, 5, FeedbackState::kDone, false, ErrorId::kNone});
  EXPECT_EQ(renewed(), (std::vector<Ticket>{1}));
  clients.OnCommand(release(2, "{ticket: 1}"), 0);
  EXPECT_TRUE(renewed().empty());
}

// EN-23, GR-20: likewise the held stop of a group.
TEST_F(ClientsTest, AHeldStopOfAGroupIsRenewedUntilItIsReleased) {
  Clients clients = Make();
  msgs::command stop = Command(1, "stop", "{hold: true}");
  stop.target = "portal";
  clients.OnCommand(stop, 0);
  clients.OnFeedback({1, 5, FeedbackState::kDone, false, ErrorId::kNone});
  for (int beat = 1; beat < 5; ++beat) {
    submitted_.clear();
    clients.OnHeartbeat(Heartbeat(), beat);
    EXPECT_EQ(Renewed(), (std::vector<Ticket>{1}));
  }
  msgs::command release = Command(2, "release", "{ticket: 1}");
  release.target = "machine";
  clients.OnCommand(release, 0);
  submitted_.clear();
  clients.OnHeartbeat(Heartbeat(), 9);
  EXPECT_TRUE(Renewed().empty());
}

// EN-23: another client may release it, too.
TEST_F(ClientsTest, AHeldStopReleasedByAnotherClientIsNotRenewed) {
  Clients clients = Make();
  clients.OnCommand(Command(1, "stop", "{hold: true}"), 0);
  clients.OnFeedback({1, 5, FeedbackState::kDone, false, ErrorId::kNone});
  msgs::command release = Command(1, "release", "{ticket: 1}");
  release.client = "berta";
  release.target = "machine";
  clients.OnCommand(release, 0);
  clients.OnHeartbeat(Heartbeat(), 1);
  EXPECT_TRUE(Renewed().empty());
}

// EN-22, EN-24: a message for another run of the engine, as in a log that is played into the network, has no effect.
TEST_F(ClientsTest, WhatIsMeantForAnotherStartIsRefused) {
  Clients clients = Make();
  clients.OnCommand(Jog(1), 0);
  submitted_.clear();
  msgs::command command = Command(2);
  command.run_id = kRunId - 1;
  clients.OnCommand(command, 0);
  const msgs::feedback refused = OneReply(clients);
  ExpectError(refused, ErrorId::kOtherRun, "another start");
  EXPECT_EQ(refused.id, 2);
  msgs::heartbeat heartbeat = Heartbeat();
  heartbeat.run_id = 0;
  clients.OnHeartbeat(heartbeat, 1);
  ExpectError(OneReply(clients), ErrorId::kOtherRun, "another start");
  EXPECT_TRUE(submitted_.empty());
  clients.OnCommand(Command(2), 2);  // the refusal used no id
  EXPECT_EQ(submitted_.size(), 1u);
}

// EN-23: a release while the axis still brakes does not take the lease from the ramp.
TEST_F(ClientsTest, AReleasedCommandIsRenewedUntilItIsDone) {
  Clients clients = Make();
  clients.OnCommand(Command(1, "stop", "{hold: true}"), 0);
  msgs::command release = Command(2, "release", "{ticket: 1}");
  release.target = "machine";
  clients.OnCommand(release, 0);
  clients.OnHeartbeat(Heartbeat(), 1);
  EXPECT_EQ(Renewed(), (std::vector<Ticket>{1}));
  clients.OnFeedback({1, 5, FeedbackState::kDone, false, ErrorId::kNone});
  submitted_.clear();
  clients.OnHeartbeat(Heartbeat(), 2);
  EXPECT_TRUE(Renewed().empty());
}

// EN-22: memory is bounded, and a forgotten id is not taken for a new one.
TEST_F(ClientsTest, OldIdsAreForgottenAndStayHarmless) {
  Clients clients = Make({.ids_per_client = 10});
  for (std::int64_t id = 1; id <= 100; ++id) {
    clients.OnCommand(Command(id), 0);
    clients.OnFeedback({submitted_.size(), 1, FeedbackState::kDone, false, ErrorId::kNone});
  }
  Replies(clients);
  ASSERT_EQ(submitted_.size(), 100u);
  clients.OnCommand(Command(50), 0);
  ExpectError(OneReply(clients), ErrorId::kParameter, "too old");
  clients.OnCommand(Command(95), 0);
  EXPECT_EQ(OneReply(clients).state, msgs::feedback::STATE_DONE);
  EXPECT_EQ(submitted_.size(), 100u);
}

// EN-22
TEST_F(ClientsTest, TooManyUnfinishedCommandsAreRefused) {
  Clients clients = Make({.ids_per_client = 4});
  for (std::int64_t id = 1; id <= 5; ++id) clients.OnCommand(Command(id), 0);
  const auto replies = Replies(clients);
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(replies[0].id, 5);
  ExpectError(replies[0], ErrorId::kQueueFull, "not finished");
  clients.OnFeedback({2, 1, FeedbackState::kDone, false, ErrorId::kNone});
  Replies(clients);
  clients.OnCommand(Command(5), 0);  // refused once, always refused
  EXPECT_EQ(OneReply(clients).state, msgs::feedback::STATE_ERROR);
  clients.OnCommand(Command(6), 0);
  EXPECT_EQ(submitted_.size(), 5u);
}

// EN-22
TEST_F(ClientsTest, TheNumberOfClientsIsBounded) {
  Clients clients = Make({.clients = 3});
  for (const char* name : {"a", "b", "c", "d"}) {
    msgs::command m = Command(1);
    m.client = name;
    clients.OnCommand(m, 0);
  }
  ExpectError(OneReply(clients), ErrorId::kQueueFull, "3 clients");
  EXPECT_EQ(clients.figures(kSecond).alive, 3u);
  EXPECT_EQ(clients.figures(3 * kSecond).alive, 0u);
  msgs::command m = Command(1);
  m.client = "d";
  clients.OnCommand(m, 3 * kSecond);  // the one that was silent for longest makes room
  EXPECT_TRUE(Replies(clients).empty());
  EXPECT_EQ(submitted_.size(), 4u);
}

// EN-22
TEST_F(ClientsTest, RepliesNobodyTakesAreBoundedAndCounted) {
  Clients clients = Make({.replies = 10});
  for (int i = 0; i < 26; ++i) clients.OnCommand(Command(1), 0);  // all but the first are answered at once
  EXPECT_EQ(Replies(clients).size(), 10u);
  EXPECT_EQ(clients.figures(0).replies_dropped, 15u);
}

// EN-22
TEST_F(ClientsTest, OddNamesAreRefused) {
  Clients clients = Make();
  for (const std::string& name : {std::string(), std::string(65, 'a'), std::string("a\nb"), std::string("\xff\xfe")}) {
    msgs::command m = Command(1);
    m.client = name;
    clients.OnCommand(m, 0);
    ExpectError(OneReply(clients), ErrorId::kParameter, "client");
  }
  EXPECT_EQ(clients.figures(0).alive, 0u);
}

// EN-32: with the maximum number of clients, the stop of a further client is accepted and answered, of every kind;
// nothing else is.
TEST_F(ClientsTest, AStrangerMayStop) {
  Clients clients = Make({.clients = 3, .guests = 2});
  for (int i = 0; i < 3; ++i) {
    msgs::heartbeat squatter = Heartbeat();
    squatter.client = "squatter " + std::to_string(i);
    clients.OnHeartbeat(squatter, 0);
  }
  std::int64_t session = 100;
  const auto give = [&](const std::string& target, const std::string& verb, const std::string& arguments) {
    msgs::command message = Command(1, verb, arguments);
    message.client = "stranger";
    message.session = ++session;
    message.target = target;
    clients.OnCommand(message, kSecond / 10);
    return message;
  };
  struct Given {
    const char *target, *verb, *arguments;
    bool taken;
  };
  for (const Given& one : std::vector<Given>{{"machine", "emergency_stop", "", true},
                                             {"machine", "stop_all", "", true},
                                             {"x", "halt", "", true},
                                             {"x", "power", "{enable: false}", true},
                                             {"x", "power", "", false},
                                             {"x", "jog", "{forward: true}", false},
                                             {"portal", "stop", "", true},
                                             {"cutter", "control", "{stop: true}", true},
                                             {"picker", "control", "{path_halt: true}", true},
                                             {"shuttle", "halt", "", true},
                                             {"shuttle", "enable", "", false},
                                             {"lift", "force_disable", "", true}}) {
    submitted_.clear();
    give(one.target, one.verb, one.arguments);
    if (!one.taken) {
      EXPECT_TRUE(submitted_.empty()) << one.verb;
      ExpectError(OneReply(clients), ErrorId::kQueueFull, "there are 3 clients already");
      continue;
    }
    ASSERT_EQ(submitted_.size(), 1u) << one.target << ' ' << one.verb;
    clients.OnFeedback({1, 3, FeedbackState::kDone, false, ErrorId::kNone});
    const msgs::feedback done = OneReply(clients);
    EXPECT_EQ(done.client, "stranger");
    EXPECT_EQ(done.session, session);
    EXPECT_EQ(done.state, msgs::feedback::STATE_DONE);
  }
  // Sent again it is answered, but not given again; the guest's heartbeats keep a held stop in force.
  submitted_.clear();
  const msgs::command held = give("x", "stop", "{hold: true}");
  clients.OnCommand(held, kSecond / 10);
  EXPECT_EQ(submitted_.size(), 1u);
  msgs::heartbeat beat = Heartbeat(held.session);
  beat.client = "stranger";
  clients.OnHeartbeat(beat, kSecond / 5);
  EXPECT_EQ(Renewed(), std::vector<Ticket>{1});
  EXPECT_EQ(clients.figures(kSecond / 5).alive, 3u);
}

// EN-32: another client has taken the name meanwhile: the former client may still stop what it began.
TEST_F(ClientsTest, AClientThatLostItsNameMayStop) {
  Clients clients = Make();
  clients.OnCommand(Jog(1), 0);
  msgs::command other = Command(1, "move_absolute");
  other.session = 2;
  clients.OnCommand(other, 3 * kSecond);
  ASSERT_EQ(submitted_.size(), 2u);
  Replies(clients);
  clients.OnCommand(Jog(2), 3 * kSecond);
  ExpectError(OneReply(clients), ErrorId::kClientName, "another client uses the name anna");
  clients.OnCommand(Command(3, "halt", ""), 3 * kSecond);
  msgs::command release = Command(4, "release", "{ticket: 1}");
  release.target = "machine";
  clients.OnCommand(release, 3 * kSecond);
  EXPECT_EQ(submitted_.size(), 4u);
  EXPECT_TRUE(Replies(clients).empty());  // the cycle answers
}

// EN-32: with the maximum number of unfinished commands, a stop is still accepted.
TEST_F(ClientsTest, ACrowdedClientMayStop) {
  Clients clients = Make({.ids_per_client = 5, .stops_per_client = 2});
  for (int id = 1; id <= 6; ++id) clients.OnCommand(Command(id), 0);
  EXPECT_EQ(submitted_.size(), 5u);
  for (int id = 7; id <= 9; ++id) clients.OnCommand(Command(id, "halt", ""), 0);
  EXPECT_EQ(submitted_.size(), 7u);
}

// EN-33: old commands are refused with a reply; those with LetsGo() are not.
TEST_F(ClientsTest, OldCommandsAreRefused) {
  Clients clients = Make();
  clients.OnCommand(Command(1), 10 * kSecond, kSecond);
  ASSERT_EQ(submitted_.size(), 1u);
  EXPECT_EQ(submitted_[0].expires_ns, 10 * kSecond);
  clients.OnCommand(Command(2), 10 * kSecond, kSecond / 4);
  EXPECT_EQ(submitted_[1].expires_ns, 10 * kSecond + 3 * kSecond / 4);
  clients.OnCommand(Command(3), 10 * kSecond, 8 * kSecond + kSecond / 2);
  EXPECT_EQ(submitted_.size(), 2u);
  ExpectError(OneReply(clients), ErrorId::kTooOld, "the command is 8.5 s old");
  clients.OnCommand(Command(3), 10 * kSecond, 0);  // its age is not reset
  EXPECT_EQ(submitted_.size(), 2u);
  EXPECT_EQ(OneReply(clients).state, msgs::feedback::STATE_ERROR);
  clients.OnCommand(Command(4, "stop", ""), 10 * kSecond, 100 * kSecond);
  EXPECT_EQ(submitted_.size(), 3u);
  clients.OnCommand(Command(1), 10 * kSecond, 100 * kSecond);  // repeated: answered with its present state
  EXPECT_EQ(OneReply(clients).state, msgs::feedback::STATE_BUSY);
  EXPECT_EQ(clients.figures(0).ignored, 1u);
}

// EN-33: heartbeats older than the lease keep nothing in force.
TEST_F(ClientsTest, OldHeartbeatsRenewNothing) {
  Clients clients = Make();
  clients.OnCommand(Jog(1), 0);
  clients.OnHeartbeat(Heartbeat(), kSecond, kSecond / 5);
  EXPECT_EQ(Renewed().size(), 1u);
  clients.OnHeartbeat(Heartbeat(), kSecond, kSecond / 3);
  EXPECT_EQ(Renewed().size(), 1u);
  EXPECT_EQ(clients.figures(0).ignored, 1u);
}

}  // namespace
}  // namespace takt::lcm
