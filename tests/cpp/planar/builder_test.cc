// PL-20, PL-23: tracks built step by step, and links to others.
#include "takt/planar/builder.h"

#include <gtest/gtest.h>

#include "tracks.h"

namespace takt::planar {
namespace {

using testing::Distance;
using testing::EndOf;
using testing::kPi;
using testing::StartOf;

// PL-23, the manual's example of a network: four tracks, three of which start at the end of the first.
TEST(Builders, LinkTheExamplesNetwork) {
  TrackBuilder one, two, three, four;
  EXPECT_EQ(one.AppendLine({250, 120}, {650, 120}), Problem::kNone);
  EXPECT_EQ(one.AppendLine({700, 170}, {800, 450}), Problem::kNone);
  EXPECT_EQ(one.AppendLine({650, 500}, {250, 500}), Problem::kNone);
  const TrackPoint end = EndOf(*one.track());
  EXPECT_EQ(two.StartFrom(end), Problem::kNone);
  EXPECT_EQ(two.AppendLine({200, 450}, {200, 170}), Problem::kNone);
  EXPECT_EQ(two.EndAt(StartOf(*one.track())), Problem::kNone);
  EXPECT_EQ(three.StartFrom(end), Problem::kNone);
  EXPECT_EQ(three.AppendLine({200, 500}, {120, 500}), Problem::kNone);
  EXPECT_EQ(four.StartFrom(end), Problem::kNone);
  EXPECT_EQ(four.AppendLine({200, 550}, {200, 750}), Problem::kNone);
  // One straight on; and two equal curves, to the left and to the right of it.
  EXPECT_NEAR(three.track()->length, 130, 1e-9);
  EXPECT_NEAR(four.track()->pieces[0].segment.length, two.track()->pieces[0].segment.length, 1e-9);
  EXPECT_NEAR(two.track()->pieces[2].segment.length, two.track()->pieces[0].segment.length, 1e-9);
  EXPECT_LT(Distance(StartOf(*two.track()).place, {250, 500}), 1e-9);
  EXPECT_LT(Distance(EndOf(*two.track()).place, {250, 120}), 1e-9);
  EXPECT_LT(Distance(At(*two.track(), two.track()->pieces[1].start).place, {200, 450}), 1e-9);
}

// PL-33, the manual's example of two parts: two tracks of the same shape have equal lengths, though one of them begins
// with transitions where the other has lines.
TEST(Builders, MakeEqualWaysEquallyLong) {
  TrackBuilder three, two;
  EXPECT_EQ(three.AppendLine({0, 360}, {80, 360}), Problem::kNone);
  EXPECT_EQ(three.AppendLine({120, 320}, {120, 160}), Problem::kNone);
  EXPECT_EQ(three.AppendLine({80, 120}, {0, 120}), Problem::kNone);
  EXPECT_EQ(two.StartFrom({{480, 600}, kPi}), Problem::kNone);
  EXPECT_EQ(two.AppendLine({440, 600}, {400, 600}), Problem::kNone);
  EXPECT_EQ(two.AppendLine({360, 560}, {360, 400}), Problem::kNone);
  EXPECT_EQ(two.AppendLine({400, 360}, {440, 360}), Problem::kNone);
  EXPECT_EQ(two.EndAt({{480, 360}, 0}), Problem::kNone);
  EXPECT_NEAR(two.track()->length, three.track()->length, 1e-9);
}

// PL-20: an element that cannot be appended changes nothing.
TEST(Builders, RefuseWhatCannotBe) {
  TrackBuilder builder;
  EXPECT_EQ(builder.track(), nullptr);
  EXPECT_EQ(builder.CloseLoop(), Problem::kEmpty);
  EXPECT_EQ(builder.EndAt({{0, 0}, 0}), Problem::kEmpty);
  EXPECT_EQ(builder.AppendLine({0, 0}, {300, 0}), Problem::kNone);
  EXPECT_EQ(builder.AppendLine({300, 0}, {300, 100}), Problem::kKink);
  EXPECT_EQ(builder.CloseLoop(), Problem::kReversal);
  EXPECT_NEAR(builder.track()->length, 300, 1e-12);
  EXPECT_EQ(builder.layout().elements.size(), 1u);
  EXPECT_EQ(builder.AppendCircle({350, 50}, {350, 150}, {350, 100}, false), Problem::kNone);
  EXPECT_EQ(builder.AppendLine({300, 200}, {0, 200}), Problem::kNone);
  EXPECT_EQ(builder.CloseLoop(), Problem::kNone);
  EXPECT_TRUE(builder.track()->closed);
  EXPECT_EQ(builder.CloseLoop(), Problem::kClosed);
  EXPECT_EQ(builder.AppendPosition({-500, 0}), Problem::kClosed);
  EXPECT_EQ(builder.StartFrom({{0, 0}, 0}), Problem::kLinked);
  EXPECT_EQ(builder.EndAt({{0, 0}, 0}), Problem::kLinked);
  builder.Clear();
  EXPECT_EQ(builder.track(), nullptr);
  EXPECT_EQ(builder.AppendPosition({0, 0}), Problem::kNone);
  EXPECT_EQ(builder.track(), nullptr);
  EXPECT_EQ(builder.AppendPosition({30, 40}), Problem::kNone);
  EXPECT_NEAR(builder.track()->length, 50, 1e-9);
}

// PL-23: a track has one start and one end; any number of other tracks may be linked there.
TEST(Builders, LinkAtOnePlaceOnly) {
  TrackBuilder builder;
  const TrackPoint from{{0, 0}, 0}, to{{300, 100}, 0};
  EXPECT_EQ(builder.StartFrom(from), Problem::kNone);
  EXPECT_EQ(builder.StartFrom(to), Problem::kNotItsStart);
  EXPECT_EQ(builder.EndAt(to), Problem::kNone);
  EXPECT_EQ(builder.AppendLine({400, 0}, {500, 0}), Problem::kEnded);
  EXPECT_EQ(builder.CloseLoop(), Problem::kLinked);
  // The same points again, as other tracks have them; the direction may differ by whole turns.
  EXPECT_EQ(builder.StartFrom({{0, 0}, 2 * kPi}), Problem::kNone);
  EXPECT_EQ(builder.EndAt(to), Problem::kNone);
  EXPECT_EQ(builder.StartFrom({{0, 1}, 0}), Problem::kNotItsStart);
  EXPECT_EQ(builder.StartFrom({{0, 0}, 0.01}), Problem::kNotItsStart);
  EXPECT_EQ(builder.StartFrom({{0, 0}, 0, 0.01}), Problem::kNotItsStart);
  EXPECT_EQ(builder.EndAt({{300, 100}, 0, 0.01}), Problem::kNotItsEnd);
  EXPECT_EQ(builder.EndAt(from), Problem::kNotItsEnd);
  // A track that is there already is linked unchanged.
  TrackBuilder lying;
  EXPECT_EQ(lying.AppendLine({0, 0}, {300, 0}), Problem::kNone);
  EXPECT_EQ(lying.StartFrom(from), Problem::kNone);
  EXPECT_EQ(lying.StartFrom(to), Problem::kNotItsStart);
  EXPECT_EQ(lying.EndAt({{300, 0}, 0}), Problem::kNone);
  EXPECT_NEAR(lying.track()->length, 300, 1e-12);
}

}  // namespace
}  // namespace takt::planar
