#include "takt/core/describe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "example.h"
#include "takt/core/columns.h"
#include "takt/core/feedback.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/ports.h"
#include "takt/core/status.h"
#include "takt/core/verify.h"

namespace forgetful {

using namespace takt;

enum class Switch { kOn, kOff };
void describe(Enumeration<Switch>& e) {
  e.about("A switch.");
  e.value(Switch::kOn, "on", "Closed.");
  e.value(Switch::kOff, "apart", "");
}

struct Thing {
  double size = -1;
  std::optional<double> limit;
  double angle = NAN;
  Switch state = Switch::kOn;
  int forgotten = 0;
};
void describe(Description<Thing>& d) {
  d.about("A thing.");
  d.defaulted<&Thing::size>(unit::mm, positive, "How large.");
  d.defaulted<&Thing::limit>("");
  d.defaulted<&Thing::angle>(unit::deg, "How turned.");
  d.defaulted<&Thing::state>("On or off.");
}

// Members of every kind that may be miscounted.
struct Inner {
  int a = 0;
  double b = 0;
};
struct Many {
  std::array<Inner, 2> array;
  std::optional<Inner> optional_struct;
  std::optional<bool> optional_bool;
  std::vector<Inner> vector;
  std::string text;
  std::optional<std::string> optional_text;
  std::array<std::optional<double>, 2> optionals;
  bool last = false;
};

}  // namespace forgetful

namespace takt {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(Describe, FieldsCarryWhatWasSaid) {  // EN-11
  const Type& type = TypeOf<example::MoveAbsolute>();
  EXPECT_EQ(type.name, "MoveAbsolute");
  EXPECT_EQ(type.about, "Moves an axis to an absolute position.");
  ASSERT_EQ(type.fields.size(), 4u);
  const Field& velocity = type.fields[1];
  EXPECT_EQ(velocity.name, "velocity");
  EXPECT_EQ(velocity.about, "Largest speed on the way.");
  EXPECT_EQ(velocity.unit.text, "u/s");
  EXPECT_EQ(velocity.presence, Presence::kRequired);
  EXPECT_EQ(velocity.offset, offsetof(example::MoveAbsolute, velocity));
  EXPECT_EQ(velocity.type->kind, Kind::kReal);
  EXPECT_FALSE(velocity.range.Holds(0));
  EXPECT_TRUE(velocity.range.Holds(1e-9));
  EXPECT_EQ(type.fields[3].presence, Presence::kDefaulted);
}

TEST(Describe, ATypeIsMadeOnce) {
  EXPECT_EQ(&TypeOf<example::Machine>(), &TypeOf<example::Machine>());
}

TEST(Describe, EnumsFindTheirNamesAndSignedValues) {
  const Type& type = TypeOf<example::Direction>();
  ASSERT_TRUE(type.FindEnumerator("negative"));
  EXPECT_EQ(type.FindEnumerator("negative")->value, 2);
  const auto current = example::Direction::kCurrent;
  EXPECT_EQ(IntegerAt(type, &current), -1);
  EXPECT_EQ(type.FindEnumerator(std::int64_t{-1})->name, "current");
  EXPECT_FALSE(type.FindEnumerator("Negative"));
}

TEST(Describe, RangesReadLikeSentences) {
  EXPECT_EQ(Text(positive), "above 0");
  EXPECT_EQ(Text(not_negative), "at least 0");
  EXPECT_EQ(Text(between(-0.5, 360)), "from -0.5 to 360");
  EXPECT_EQ(Text(at_most(5)), "at most 5");
  EXPECT_EQ(Text(any_value), "");
  EXPECT_EQ(LongText(unit::u_s), "u/s (the axis' unit per second)");
  EXPECT_EQ(LongText(unit::mm), "mm");
}

TEST(Describe, NoRangeHoldsNaN) {
  for (const Range& range : {any_value, positive, between(0, 1)}) EXPECT_FALSE(range.Holds(NAN));
}

TEST(Describe, MembersAreCountedWhateverTheyAre) {
  EXPECT_EQ(internal::Arity<forgetful::Many>(), 8u);
}

TEST(Verify, FindsNothingInGoodDescriptions) {
  EXPECT_THAT(Verify(TypeOf<example::Machine>()), IsEmpty());
  EXPECT_THAT(Verify(TypeOf<example::MoveAbsolute>()), IsEmpty());
}

TEST(Verify, FindsNothingInThisFolder) {  // EN-11
  EXPECT_THAT(Verify(TypeOf<KinematicState>()), IsEmpty());
  EXPECT_THAT(Verify(TypeOf<ServoInputs>()), IsEmpty());
  EXPECT_THAT(Verify(TypeOf<ServoOutputs>()), IsEmpty());
  EXPECT_THAT(Verify(TypeOf<FeedbackEvent>()), IsEmpty());
  EXPECT_THAT(Verify(TypeOf<Status>()), IsEmpty());
}

TEST(Verify, FindsEveryFault) {
  EXPECT_THAT(Verify(TypeOf<forgetful::Thing>()),
              UnorderedElementsAre("Thing: describes 4 of 5 members", "Thing.size: the default -1.0 is not above 0",
                                   "Thing.limit: says nothing about itself",
                                   "Thing.angle: the default is not finite; an optional says that there is none",
                                   "Switch.on: YAML does not read this name as text",
                                   "Switch.apart: says nothing about itself"));
}

TEST(Columns, NameTheNumbersOfAStruct) {
  std::vector<std::string> names;
  for (const Column& column : ColumnsOf(TypeOf<example::Axis>()))
    names.push_back(column.name + " " + std::string(column.unit.text));
  EXPECT_THAT(names, ElementsAre("velocity u/s", "mounting_angle deg", "inverted ", "serial ", "shift ", "gains[0] 1/s",
                                 "gains[1] 1/s", "gains[2] 1/s", "drive_mode ", "drive_station ", "drive_offset count",
                                 "limits_lower u", "limits_upper u", "counter "));
}

TEST(Columns, ReadNumbersInWrittenUnits) {
  example::Axis axis;
  axis.mounting_angle = std::numbers::pi / 2;
  axis.inverted = true;
  axis.serial = ~std::uint64_t{0};
  axis.shift = -5;
  axis.gains[2] = 0.25;
  axis.drive.mode = example::DriveMode::kVelocity;
  std::vector<double> values;
  for (const Column& column : ColumnsOf(TypeOf<example::Axis>())) values.push_back(ReadColumn(column, &axis));
  EXPECT_THAT(values, ElementsAre(0, 90, 1, 0x1p64, -5, 1, 0, 0.25, 1, 0, 0, -100, 100, 0));

  example::Homing homing;
  const Column timeout = ColumnsOf(TypeOf<example::Homing>()).back();
  EXPECT_TRUE(std::isnan(ReadColumn(timeout, &homing)));
  homing.timeout_s = 3;
  EXPECT_EQ(ReadColumn(timeout, &homing), 3);
}

}  // namespace
}  // namespace takt
