// CAM-88: cams made at run time. Random commands against a model of the names and of the cams in use.
#include "takt/cam/store.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "../core/allocations.h"
#include "made.h"

namespace takt::cam {
namespace {

struct Bench {
  Bench() : store({Points(Interpolation::kQuintic, {{0, 0}, {1, 1}})}) {}

  Context Of() {
    return {store, 0, sink,
            [](const void* used, std::uint32_t index) noexcept {
              return static_cast<const std::set<std::uint32_t>*>(used)->contains(index);
            },
            &used};
  }
  // Carries out a command as the cycle does, without an allocation. Returns the last report.
  template <typename Command>
  FeedbackEvent Tell(const Command& command) {
    sink.Clear();
    const long before = AllocationsOfThisThread();
    Apply(Of(), ++ticket, command);
    EXPECT_EQ(AllocationsOfThisThread(), before);
    return sink.events().empty() ? FeedbackEvent{} : sink.events().back();
  }
  // Sends a cam of two points with this end and builds it. Returns the feedback of the building.
  FeedbackEvent Make(std::string_view name, double end) {
    Tell(BeginCam{.name = Name::Of(name)});
    AddCamPoints points{.cam = Name::Of(name), .points = {}};
    points.points.Add({0, 0, {}, {}});
    points.points.Add({1, end, {}, {}});
    Tell(points);
    const FeedbackEvent begun = Tell(BuildCam{Name::Of(name), 2u});
    return IsFinal(begun.state) ? begun : Answer();
  }
  FeedbackEvent Answer() {
    const std::optional<BuildResult> result = BuildNext(store.queues);
    return result ? Tell(result->built) : FeedbackEvent{};
  }

  std::set<std::uint32_t> used;
  Store store;
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(16);
  FeedbackSink sink{storage};
  Ticket ticket = 0;
};

TEST(Store, NamesStandForTheLastCamAndWhatIsInUseStays) {
  Bench bench;
  Dice dice(88);
  std::map<std::string, double> ends;  // of the cam that each name refers to
  std::map<std::uint32_t, double> in_use;
  for (int step = 0; step < 4000; ++step) {
    const std::string name = "cam " + std::to_string(dice.Whole(40));
    switch (dice.Whole(6)) {
      case 0:
        if (const auto index = Find(bench.store.tables, name)) {  // an axis begins to follow it
          in_use[*index] = bench.store.tables[*index].At(1).y;
          bench.used.insert(*index);
        }
        break;
      case 1:
        if (!in_use.empty()) {  // and stops following it
          const auto left = std::next(in_use.begin(), static_cast<long>(dice.Whole(in_use.size())));
          bench.used.erase(left->first);
          in_use.erase(left);
        }
        break;
      case 2:
        EXPECT_EQ(bench.Tell(DropCam{Name::Of(name)}).state == FeedbackState::kDone, ends.erase(name) > 0);
        break;
      default: {
        const FeedbackEvent event = bench.Make(name, step + 1);
        if (event.state == FeedbackState::kDone) {
          ends[name] = step + 1;
        } else {
          EXPECT_EQ(ProblemOf(event.value), MakingProblem::kNoRoom);
        }
      }
    }
    for (const auto& [of, end] : ends) {
      const auto index = Find(bench.store.tables, of);
      ASSERT_TRUE(index) << of;
      ASSERT_EQ(bench.store.tables[*index].At(1).y, end) << of;
    }
    for (const auto& [index, end] : in_use) ASSERT_EQ(bench.store.tables[index].At(1).y, end);
  }
  EXPECT_EQ(Find(bench.store.tables, "cam"), 0u);  // the cam of the machine file
  std::set<std::uint64_t> numbers;
  for (const Table& table : bench.store.tables) {
    const bool is_new = table.size() == 0 || numbers.insert(table.number()).second;
    EXPECT_TRUE(is_new);
  }
}

// Two drafts can be built at a time, in the order of their commands; a draft that is being built does not change.
TEST(Store, TwoCamsAreBuiltAtATime) {
  Bench bench;
  for (const char* name : {"a", "b"}) {
    bench.Tell(BeginCam{.name = Name::Of(name)});
    AddCamPoints points{.cam = Name::Of(name), .points = {}};
    for (const double x : {0.0, 1.0, 2.0}) points.points.Add({x, *name == 'a' ? x : -x, {}, {}});
    bench.Tell(points);
    EXPECT_EQ(bench.Tell(BuildCam{Name::Of(name)}).state, FeedbackState::kActive);
  }
  EXPECT_EQ(bench.Tell(BeginCam{.name = Name::Of("a")}).error, ErrorId::kCamMaking);
  AddCamPoints late{.cam = Name::Of("a"), .points = {}};
  late.points.Add({3, 0, {}, {}});
  EXPECT_EQ(ProblemOf(bench.Tell(late).value), MakingProblem::kNoDraft);
  EXPECT_EQ(bench.Answer().value, 2);
  EXPECT_EQ(bench.Answer().value, 3);
  EXPECT_EQ(bench.store.tables[*Find(bench.store.tables, "a")].end(), 2);
  EXPECT_EQ(bench.store.tables[*Find(bench.store.tables, "b")].At(2).y, -2);
}

// The largest cams are handled without an allocation in the cycle.
TEST(Store, TakesTheLargestCams) {
  Bench bench;
  for (int round = 0; round < 2; ++round) {
    bench.Tell(BeginCam{.name = Name::Of("long"), .interpolation = Interpolation::kLinear});
    for (std::uint32_t first = 0; first < kMaxPoints; first += kPointsPerCommand) {
      AddCamPoints points{.cam = Name::Of("long"), .first = first, .points = {}};
      for (std::uint32_t i = 0; i < kPointsPerCommand; ++i)
        points.points.Add({static_cast<double>(first + i), 0, {}, {}});
      ASSERT_EQ(bench.Tell(points).state, FeedbackState::kDone);
    }
    AddCamPoints more{.cam = Name::Of("long"), .points = {}};
    more.points.Add({1e6, 0, {}, {}});
    if (round == 1) {
      EXPECT_EQ(ProblemOf(bench.Tell(more).value), MakingProblem::kTooManyPoints);
      EXPECT_EQ(ProblemOf(bench.Tell(BuildCam{Name::Of("long")}).value), MakingProblem::kIncomplete);
      continue;
    }
    EXPECT_EQ(bench.Tell(BuildCam{Name::Of("long"), std::uint32_t{kMaxPoints}}).state, FeedbackState::kActive);
    EXPECT_EQ(bench.Answer().state, FeedbackState::kDone);
    EXPECT_EQ(bench.store.tables[*Find(bench.store.tables, "long")].size(), kMaxPoints - 1);
  }
}

}  // namespace
}  // namespace takt::cam
