// PL-01, PL-32: the states of a part: each change is one of the table, and every command ends once.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "takt/core/describe.h"
#include "takt/part/part.h"

namespace takt::part {
namespace {

using planar::ObjectState;

class Rig {
 public:
  Rig() {
    params.name = "lift";
    params.positions = {{"lower", 0, 0}, {"upper", 0, 0}, {"upper", 240, 0}};
    state = MakeState(params);
    inputs = Simulate(context(), state);
  }
  Context context() { return {params, cycle, feedback}; }
  Ticket Give(const Command& command, const MoveBlocker& hindrance = {}) {
    Apply(context(), ++ticket, command, hindrance, state);
    Hear();
    return ticket;
  }
  // Returns true if it has arrived.
  bool Step() {
    const ObjectState before = state.state;
    const bool arrived = Arrive(context(), inputs, state);
    part::Step(context(), around, state);
    if (state.state != before) seen.insert({before, state.state});
    Hear();
    inputs = Simulate(context(), state);
    ++cycle.count;
    return arrived;
  }
  void Steps(int count) {
    for (int i = 0; i < count; ++i) Step();
  }
  FeedbackEvent Of(Ticket of) { return last[of]; }

  PartParams params;
  State state;
  Inputs inputs;
  Around around;
  Cycle cycle{1, 0.001};
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(32);
  FeedbackSink feedback{storage};
  Ticket ticket = 0;
  std::map<Ticket, FeedbackEvent> last;
  std::set<std::pair<ObjectState, ObjectState>> seen;

 private:
  void Hear() {
    for (const FeedbackEvent& event : feedback.events()) {
      const auto before = last.find(event.ticket);
      EXPECT_FALSE(before != last.end() && IsFinal(before->second.state)) << "final once";
      last[event.ticket] = event;
    }
    EXPECT_EQ(feedback.lost(), 0u);
    feedback.Clear();
  }
};

TEST(PartStates, FollowWhatMoversNeed) {
  Rig rig;
  rig.Steps(3);
  EXPECT_EQ(rig.state.state, ObjectState::kDisabled);
  rig.around.wanted = true;
  rig.Step();
  EXPECT_EQ(rig.state.state, ObjectState::kEnabling);
  rig.Step();
  EXPECT_EQ(rig.state.state, ObjectState::kEnabled);
  rig.around = {.wanted = false, .reset = false, .movers_rest = false};
  rig.Steps(5);
  EXPECT_EQ(rig.state.state, ObjectState::kDisabling);
  rig.around.movers_rest = true;
  rig.Step();
  EXPECT_EQ(rig.state.state, ObjectState::kDisabled);
}

TEST(PartStates, ArriveWhenThatIsReported) {
  Rig rig;
  const Ticket going = rig.Give(ActivatePosition{.index = 3});
  EXPECT_TRUE(Show(rig.state).away);
  EXPECT_EQ(rig.Of(going).state, FeedbackState::kActive);
  for (int i = 0; i < 10; ++i) {
    rig.inputs.position = i < 5 ? 1 : 0;  // still there, then on its way
    EXPECT_FALSE(rig.Step());
  }
  EXPECT_EQ(rig.state.position, 0u);
  EXPECT_TRUE(rig.Step());
  EXPECT_EQ(rig.state.position, 2u);
  EXPECT_FALSE(Show(rig.state).away);
  EXPECT_EQ(rig.Of(going).state, FeedbackState::kDone);
  EXPECT_EQ(rig.state.error, ErrorId::kNone);
  // Neither the position that it was sent from nor that it was sent to.
  const Ticket lost = rig.Give(ActivatePosition{.index = 1});
  rig.inputs.position = 2;
  rig.Step();
  EXPECT_EQ(rig.Of(lost).error, ErrorId::kPartPosition);
  EXPECT_EQ(rig.state.state, ObjectState::kErrorPending);
}

TEST(PartStates, RefuseWhatIsHindered) {
  Rig rig;
  const Ticket refused = rig.Give(ActivatePosition{.index = 2}, {ErrorId::kPartMover, {ObjectKind::kMover, 7}});
  EXPECT_EQ(rig.Of(refused).error, ErrorId::kPartMover);
  EXPECT_EQ(rig.Of(refused).object, (ObjectInfo{ObjectKind::kMover, 7}));
  EXPECT_FALSE(Show(rig.state).away);
  EXPECT_EQ(rig.Of(rig.Give(ActivatePosition{.index = 4})).error, ErrorId::kParameter);
  EXPECT_EQ(rig.Of(rig.Give(ActivatePosition{.index = 0})).error, ErrorId::kParameter);
  // At its own position it may stay, whatever is in the way.
  EXPECT_EQ(rig.Of(rig.Give(ActivatePosition{.index = 1}, {ErrorId::kPartMover, {ObjectKind::kMover, 7}})).state,
            FeedbackState::kDone);
}

// Each change of state is one of the table, and all of the table occur except those of a quick stop that would leave a
// part enabled: its faults always lead to Disabled.
TEST(PartStates, RandomWalk) {
  Rig rig;
  std::mt19937 random(5);
  const auto whole = [&](int from, int to) { return std::uniform_int_distribution<int>(from, to)(random); };
  for (int i = 0; i < 200000; ++i) {
    const ObjectState before = rig.state.state;
    switch (whole(0, 30)) {
      case 0:
        rig.Give(ActivatePosition{.index = static_cast<std::uint32_t>(whole(1, 3))});
        break;
      case 1:
        rig.Give(AllowEnable{});
        break;
      case 2:
        rig.Give(ForceDisable{});
        break;
      case 3:
        rig.Give(Reset{});
        break;
      default:
        break;
    }
    if (rig.state.state != before) {
      EXPECT_TRUE(planar::IsLegal(before, rig.state.state));
      rig.seen.insert({before, rig.state.state});
    }
    rig.around.wanted = whole(0, 10) == 0 ? !rig.around.wanted : rig.around.wanted;
    rig.around.reset = whole(0, 40) == 0;
    rig.around.movers_rest = whole(0, 2) == 0;
    rig.around.movers_failed = whole(0, 2) == 0;
    if (whole(0, 50) == 0) rig.inputs.fault = true;
    if (whole(0, 50) == 0) rig.inputs.position = static_cast<std::uint32_t>(whole(0, 3));
    const ObjectState at = rig.state.state;
    rig.Step();
    EXPECT_TRUE(at == rig.state.state || planar::IsLegal(at, rig.state.state) ||
                // A fault in the cycle that would have led elsewhere.
                rig.state.state == ObjectState::kErrorPending);
    const planar::PartNow now = Show(rig.state);
    EXPECT_EQ(now.enabled, rig.state.state == ObjectState::kEnabled);
    EXPECT_TRUE(!rig.state.forced || rig.state.state != ObjectState::kEnabling);
    EXPECT_TRUE(!now.faulty || rig.state.error != ErrorId::kNone);
  }
  for (const planar::Transition& t : planar::kTransitions) {
    const bool never = (t.from == ObjectState::kResetting && t.to == ObjectState::kEnabled) ||
                       (t.from == ObjectState::kError && t.to == ObjectState::kErrorPending);
    EXPECT_EQ(rig.seen.contains({t.from, t.to}), !never) << static_cast<int>(t.from) << static_cast<int>(t.to);
  }
}

}  // namespace
}  // namespace takt::part
