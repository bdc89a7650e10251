// PL-15: times along tracks with curves, compared with the least possible within the limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "streets.h"
#include "tracks.h"

namespace takt::planar {
namespace {

using testing::TrackNetworkState;

// The tracks of tests/tools/track_problems.py: layouts, limits, and the time of a solver.
TEST(Optimum, TracksWithCurvesTakeFivePercentLongerAtMost) {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/data/track_optimum.json");
  const auto problems = nlohmann::json::parse(file);
  ASSERT_GE(problems.size(), 12u);
  std::vector<double> ratios;
  for (const auto& p : problems) {
    Layout layout;
    for (const auto& e : p["elements"]) {
      layout.elements.push_back(testing::Line({e["from"]["x"], e["from"]["y"]}, {e["to"]["x"], e["to"]["y"]}));
    }
    Track track;
    ASSERT_EQ(MakeTrack(layout, track).problem, Problem::kNone);
    ASSERT_NEAR(track.length, double(p["length"]), 1e-3) << "other tracks than the solver had";
    const Pace pace = testing::PaceOf(p["velocity"], p["acceleration"], p["jerk"], p["lateral"]);
    TrackNetworkState streets({layout}, 1);
    streets.Put(0, 0, 0, pace);
    streets.Send(0, 0, track.length);
    ASSERT_TRUE(streets.Run(30));
    // Rounding to a cycle, and the tolerance of the solver: no motion is quicker.
    ratios.push_back(streets.now() / double(p["optimum_s"]));
    EXPECT_GT(ratios.back(), 0.998) << p["name"];
    EXPECT_LT(ratios.back(), 1.05) << p["name"];
  }
  std::ranges::sort(ratios);
  RecordProperty("median", std::to_string(ratios[ratios.size() / 2]));
  RecordProperty("worst", std::to_string(ratios.back()));
}

}  // namespace
}  // namespace takt::planar
