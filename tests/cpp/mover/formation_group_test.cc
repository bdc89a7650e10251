// PL-73, PL-51: formations in a group of movers: the area of all members is checked and reserved.
#include <algorithm>

#include "../core/trials.h"
#include "troop.h"

namespace takt::mover {
namespace {

constexpr std::uint32_t kCell = 1;

// Four movers in a square, and one more that is free, in an enabled group.
class Cell : public Troop {
 public:
  explicit Cell(std::vector<MoverParams> params, int members = 4) : Troop(std::move(params)), members_(members) {
    for (std::uint32_t i = 0; i < this->params.size(); ++i) planar::AddMover(i, kCell, grounds);
  }
  void Begin() {
    ASSERT_EQ(planar::Watch(kCell, grounds).error, ErrorId::kNone);
    for (std::uint32_t i = 0; i < params.size(); ++i) Give(i, Enable{});
    Run(3);
    for (int i = 1; i < members_; ++i) Give(static_cast<std::uint32_t>(i), JoinFormation{Name::Of("m0")});
    Step();
  }
  planar::Area Rectangle(std::size_t i) const {
    const SetPoint& at = states[i].set_point;
    planar::Area area{.places = {planar::Place{at[kX].position, at[kY].position}},
                      .count = 1,
                      .least_c = at[kC].position,
                      .most_c = at[kC].position,
                      .mover = {params[i].width, params[i].height}};
    return area;
  }

 private:
  int members_;
};

std::vector<MoverParams> SquareAnd(double x, double y) {
  return {Turning(0, 0), Turning(120, 0), Turning(120, 120), Turning(0, 120), Turning(x, y)};
}

void ExpectRefused(const FeedbackEvent& answer, const ObjectInfo& object) {
  EXPECT_EQ(answer.state, FeedbackState::kError);
  EXPECT_EQ(answer.error, ErrorId::kCollision);
  EXPECT_EQ(answer.object, object);
}
constexpr ObjectInfo Mover(std::uint32_t number) {
  return {ObjectKind::kMover, number};
}

// The path of the star is free; that of a planet is not.
TEST(FormationGroup, RefusesWhatAPlanetWouldMeet) {
  Cell t(SquareAnd(600, 120));
  t.Begin();
  ExpectRefused(t.Of(t.Give(0, MoveToPosition{.x = 500})), Mover(5));
  EXPECT_EQ(t.Become(t.Give(0, MoveToPosition{.x = 366})), FeedbackState::kDone);  // 366 + 120 + 113 < 600
  ExpectRefused(t.Of(t.Give(0, MoveToPosition{.x = 367.1})), Mover(5));
  ExpectRefused(t.Of(t.Give(4, MoveToPosition{.x = 500, .y = 120})), Mover(3));
  EXPECT_EQ(t.Become(t.Give(0, MoveToPosition{.x = 0, .y = -200})), FeedbackState::kDone);
  EXPECT_EQ(t.Become(t.Give(4, MoveToPosition{.x = 120, .y = 120})), FeedbackState::kDone);
}

// The area that a planet sweeps as the body turns: the corner of m2 moves on a circle of 169.7 + 79.9 mm about m0.
TEST(FormationGroup, RefusesWhatATurnWouldMeet) {
  for (const double x : {-280.0, -312.0}) {
    Cell t(SquareAnd(x, 0));
    t.Begin();
    const Ticket turn = t.Give(0, MoveC{.position = 180});
    if (x > -300) {
      ExpectRefused(t.Of(turn), Mover(5));
      EXPECT_EQ(t.Become(t.Give(0, MoveC{.position = -45})), FeedbackState::kDone);
    } else {
      EXPECT_EQ(t.Become(turn), FeedbackState::kDone);
      EXPECT_NEAR(t.outs[2].x, -120, 1e-9);
    }
  }
}

// The area that the body has left is free again while it still moves.
TEST(FormationGroup, LeavesWhatIsBehindIt) {
  for (const double turned : {0.0, 40.0}) {
    Cell t(SquareAnd(60, 400));
    t.Begin();
    const Ticket move = t.Give(0, MoveToPosition{.x = 1500, .y = 0, .c = turned, .use_orientation = true});
    ExpectRefused(t.Of(t.Give(4, MoveToPosition{.x = 60, .y = 60})), Mover(1));
    t.Run(600);
    EXPECT_EQ(t.Of(move).state, FeedbackState::kActive);
    const Ticket into = t.Give(4, MoveToPosition{.x = 60, .y = 60});
    EXPECT_EQ(t.Of(into).state, FeedbackState::kActive);
    EXPECT_EQ(t.Become(into), FeedbackState::kDone);
    EXPECT_EQ(t.Become(move), FeedbackState::kDone);
  }
}

TEST(FormationGroup, StaysWithinTheBorder) {
  planar::Environment floor;
  const std::vector<planar::Place> stators = {{-120, -120}, {120, -120}, {-120, 120}, {120, 120}};
  ASSERT_EQ(planar::MakeEnvironment(stators, floor).problem, planar::StatorProblem::kNone);
  Cell t({Turning(0, 0), Turning(120, 0), Turning(120, 120), Turning(0, 120)});
  t.grounds.surfaces[0] = &floor;
  ASSERT_EQ(planar::AddEnvironment(0, kCell, t.grounds).error, ErrorId::kNone);
  t.Begin();
  const ObjectInfo border{ObjectKind::kEnvironment, 1};
  ExpectRefused(t.Of(t.Give(0, MoveToPosition{.x = 184})), border);  // 184 + 120 + 56.5 > 360
  ExpectRefused(t.Of(t.Give(0, MoveC{.position = 90})), border);
  const Ticket move = t.Give(0, MoveToPosition{.x = 183});
  EXPECT_EQ(t.Become(move), FeedbackState::kDone);
}

// Two formations and single movers among each other: no two ever overlap, whatever fails in whatever cycle.
TEST(FormationGroup, PropertyNothingMeets) {
  const int seeds = Trials(12, 50);
  int accepted = 0, refused = 0, turned = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(static_cast<unsigned>(seed));
    std::vector<MoverParams> params;
    for (int i = 0; i < 14; ++i) {
      MoverParams p = Turning(-450.0 + 150 * (i % 7), i < 7 ? 0 : 180);
      p.height = Uniform(random, 60, 113);
      p.xy.maximum = {Uniform(random, 500, 2000), Uniform(random, 2000, 20000), {}, Uniform(random, 2e4, 5e5)};
      params.push_back(p);
    }
    Cell t(params, 1);
    t.Begin();
    std::array<std::uint32_t, 14> stars{};
    for (std::uint32_t i = 0; i < 14; ++i) stars[i] = i % 7 < 3 ? 1 : i % 7 > 4 ? 5 : i;
    const auto rejoin = [&] {
      for (std::uint32_t i = 0; i < 14; ++i) {
        if (stars[i] != i) t.Give(i, JoinFormation{Name::Of("m" + std::to_string(stars[i]))});
      }
    };
    rejoin();
    for (int cycle = 0; cycle < 6000; ++cycle) {
      if (Whole(random, 0, 25) == 0) {
        const auto any = static_cast<std::uint32_t>(Whole(random, 0, 13));
        const std::uint32_t star = stars[any];
        const SetPoint& at = t.states[star].set_point;
        const double c = at[kC].position + Uniform(random, -120, 120);
        Ticket given = 0;
        switch (Whole(random, 0, 40)) {
          case 0:
            t.Give(any, Halt{});
            break;
          case 1:
            t.Give(any, Disable{});
            break;
          case 2:
            t.Break(any);
            break;
          case 3:
          case 4:
          case 5:
          case 6:
          case 7:
            given = t.Give(star, MoveC{.position = c});
            break;
          default:
            given = t.Give(star, MoveToPosition{.x = at[kX].position + Uniform(random, -400, 400),
                                                .y = at[kY].position + Uniform(random, -400, 400),
                                                .c = c,
                                                .use_orientation = Whole(random, 0, 1) == 0});
        }
        if (given != 0) ++(t.Of(given).error == ErrorId::kCollision ? refused : accepted);
      }
      if (cycle % 1500 == 1499) {
        for (std::uint32_t i = 0; i < 14; ++i) {
          t.Give(i, Reset{});
          t.Give(i, Enable{});
        }
      }
      if (cycle % 1500 == 10) rejoin();
      t.Step();
      turned += t.outs[1].velocity_c != 0 && t.outs[1].velocity_x != 0 ? 1 : 0;
      for (std::size_t i = 0; i < 14; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          const bool one = t.outs[i].formation != 0 && t.outs[i].formation == t.outs[k].formation;
          if (one) continue;
          ASSERT_FALSE(planar::Near(t.Rectangle(i), t.Rectangle(k), -1e-6)) << i << " and " << k << " in " << cycle;
        }
      }
    }
  }
  EXPECT_GT(accepted, 20 * seeds);
  EXPECT_GT(refused, 20 * seeds);
  EXPECT_GT(turned, 100 * seeds);
}

}  // namespace
}  // namespace takt::mover
