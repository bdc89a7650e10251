// CAM-04: points as CSV. Messages about files: tests/cpp/engine/load_cams_test.cc.
#include "takt/cam/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made.h"

namespace takt::cam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Csv, ReadsColumnsInAnyOrder) {
  const CsvPoints csv = ReadCsv("\xEF\xBB\xBF# a cam\r\na\ty\tv\tx\r\n\r\n0.5\t2\t\t1\r\n\t4\t-1\t3", "f.csv");
  EXPECT_THAT(csv.problems, IsEmpty());
  ASSERT_EQ(csv.points.size(), 2u);
  EXPECT_EQ(csv.points[0].x, 1);
  EXPECT_EQ(csv.points[0].y, 2);
  EXPECT_EQ(csv.points[0].v, std::nullopt);
  EXPECT_EQ(csv.points[0].a, 0.5);
  EXPECT_EQ(csv.points[1].v, -1);
  EXPECT_EQ(csv.points[1].a, std::nullopt);
  EXPECT_THAT(csv.lines, ElementsAre(4, 5));
  EXPECT_EQ(PlaceInCsv(csv, "points[1].x").line, 5);
  EXPECT_EQ(PlaceInCsv(csv, "points").line, 1);
}

// CAM-92: decimal commas, unless commas separate the columns; for other files, advice what to do.
TEST(Csv, ReadsDecimalCommas) {
  for (const char* text : {"x;y;v\n0;-1,25;\n1,5e1;2.5;0,125\n", "x\ty\tv\n0\t-1,25\t\n15\t2,5\t,125\n"}) {
    const CsvPoints csv = ReadCsv(text, "f.csv");
    EXPECT_THAT(csv.problems, IsEmpty());
    ASSERT_EQ(csv.points.size(), 2u);
    EXPECT_EQ(csv.points[0].y, -1.25);
    EXPECT_EQ(csv.points[1].x, 15);
    EXPECT_EQ(csv.points[1].y, 2.5);
    EXPECT_EQ(csv.points[1].v, 0.125);
  }
  for (const char* text : {"x;y\n0;1.234,5\n", "x;y\n0;1,234,5\n", "x;y\n0;,\n"}) {
    const CsvPoints csv = ReadCsv(text, "f.csv");
    ASSERT_EQ(csv.problems.size(), 1u) << text;
    EXPECT_EQ(csv.problems[0].place.line, 2);
    EXPECT_THAT(csv.problems[0].message, testing::HasSubstr("expected a finite number for y, found"));
  }
  EXPECT_EQ(ReadCsv("x,y\n0,1,25\n", "f.csv").problems[0].message, "expected 2 columns, found 3");
  for (const char* text : {"Master;Slave\n0;1\n", "0;1\n1;2\n", "(dX := 0, dY := 0)"}) {
    EXPECT_THAT(ReadCsv(text, "f.csv").problems[0].message,
                testing::EndsWith("; takt cam FILE --csv cam.csv converts files of other systems"));
  }
}

// A written file reads back as the identical numbers.
TEST(Csv, ReadsWhatItWrote) {
  Dice dice(1);
  for (int run = 0; run < 100; ++run) {
    const CamParams params = RandomPoints(dice, static_cast<Interpolation>(dice.Whole(3)));
    const CsvPoints csv = ReadCsv(WriteCsv(params.points), "f.csv");
    ASSERT_THAT(csv.problems, IsEmpty());
    ASSERT_EQ(csv.points.size(), params.points.size());
    for (std::size_t i = 0; i < csv.points.size(); ++i) {
      ASSERT_EQ(csv.points[i].x, params.points[i].x);
      ASSERT_EQ(csv.points[i].y, params.points[i].y);
      ASSERT_EQ(csv.points[i].v, params.points[i].v);
      ASSERT_EQ(csv.points[i].a, params.points[i].a);
    }
  }
}

// Arbitrary bytes give a result, with at most 20 problems.
TEST(Csv, StandsAnything) {
  Dice dice(2);
  const std::string letters = "xyva,;\t\n\n\r0123456789.-+e# \xC3\xFF";
  for (int run = 0; run < 5000; ++run) {
    std::string text = dice.Flip() ? "x,y\n" : "";
    for (std::size_t n = dice.Whole(60); n > 0; --n) text += letters[dice.Whole(letters.size())];
    const CsvPoints csv = ReadCsv(text, "f.csv");
    ASSERT_EQ(csv.lines.size(), csv.points.size());
    ASSERT_LE(csv.problems.size(), 20u);
  }
}

}  // namespace
}  // namespace takt::cam
