// GR-20: lines and arcs by arc length.
#include "takt/path/segment.h"

#include <gtest/gtest.h>

#include "takt/path/make.h"

namespace takt::path {
namespace {

TEST(Segments, Line) {
  Segment s;
  ASSERT_EQ(MakeLine({}, {Frame({3, 4, 0}), {1}}, s), Problem::kNone);
  EXPECT_DOUBLE_EQ(s.length, 5);
  EXPECT_NEAR(At(s, 2.5).p.p.x(), 1.5, 1e-15);
}

}  // namespace
}  // namespace takt::path
