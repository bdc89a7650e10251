// Objects on a belt: from their detection until they are taken or lost.
#include "rig.h"
#include "takt/core/angle.h"

namespace takt::conveyor {
namespace {

KinematicState At(double position, double velocity = 0) {
  return {position, velocity, 0};
}

// CV-02, CV-03, PP-40: for a pose that arrives late, the travel of the belt is compensated to the last bit.
TEST(Objects, LiesWhereItWasTakenToByTheBelt) {
  BeltParams p = Straight();
  p.origin = {100, -50, 20, 0, 0, 90};  // travels along Y of the world
  Rig rig(p);
  rig.Step(At(1000));
  const std::uint32_t number = rig.Detected();
  EXPECT_EQ(number, 1u);
  EXPECT_EQ(rig.The(number).state, ObjectState::kDetected);
  EXPECT_EQ(rig.Out().visible_count, 0u);
  for (int k = 1; k <= 64; ++k) rig.Step(At(1000 + 0.25 * k, 250));
  const FeedbackEvent told = rig.Give(Locate{.number = number, .x = 30, .y = 4, .z = 1, .c = 15});
  EXPECT_EQ(told.state, FeedbackState::kDone);
  EXPECT_EQ(told.value, 1);
  EXPECT_EQ(rig.Place(number), 30 + 16);
  const kinematics::MovingFrame pose = PoseOf(rig.params, rig.state, rig.The(number));
  const kinematics::Pose frame = kinematics::ToPose(pose.GetFrame());
  EXPECT_NEAR(frame.x, 100 - 4, 1e-12);
  EXPECT_NEAR(frame.y, -50 + 46, 1e-12);
  EXPECT_NEAR(frame.z, 21, 1e-12);
  EXPECT_NEAR(frame.c, 105, 1e-12);
  EXPECT_NEAR(pose.p.v.y(), 250, 1e-9);
  EXPECT_NEAR(pose.p.v.x(), 0, 1e-9);
}

// CV-02: the position of an object does not depend on the order in which it is detected and located.
TEST(Objects, IsTheSameLocatedAtOnceOrLate) {
  Rig rig(Straight());
  rig.Step(At(5));
  const std::uint32_t early = rig.Detected({.x = 12.5, .y = 3.0, .c = 40.0});
  const std::uint32_t late = rig.Detected();
  EXPECT_EQ(rig.The(early).state, ObjectState::kVisible);
  for (int k = 0; k < 1000; ++k) rig.Step(At(5 + 0.37 * k, 370));
  rig.Give(Locate{.number = late, .x = 12.5, .y = 3.0, .c = 40.0});
  EXPECT_EQ(rig.The(early).pose, rig.The(late).pose);
  EXPECT_EQ(rig.Place(early), rig.Place(late));
}

// CV-02: the position of the belt latched by a touch probe; and several objects in one image.
TEST(Objects, AreLatchedInThePastAndTogether) {
  Rig rig(Straight());
  rig.params.ratio = 3;
  rig.Step(At(100, 10));
  const std::uint32_t first = rig.Detected({.recorded_position = 90});
  EXPECT_EQ(rig.The(first).latch, 270);
  for (int k = 0; k < 10; ++k) rig.Step(At(110 + k));
  const std::uint32_t second = rig.Detected({.latched_with = first, .x = 20.0});
  rig.Give(Locate{.number = first, .x = 5});
  EXPECT_EQ(rig.Place(second) - rig.Place(first), 15);
  EXPECT_EQ(rig.Give(Detect{.latched_with = 77}).error, ErrorId::kNoWorkpiece);
  EXPECT_EQ(rig.state.count, 2u);
}

// PP-40: without a number, Locate applies to the object that has waited longest.
TEST(Objects, AreLocatedInTheOrderOfTheirDetection) {
  Rig rig(Straight());
  EXPECT_EQ(rig.Give(Locate{}).error, ErrorId::kNoWorkpiece);
  rig.Detected();
  rig.Detected({.x = 0.0});
  rig.Detected();
  EXPECT_EQ(rig.Give(Locate{.x = 1}).value, 1);
  EXPECT_EQ(rig.Give(Locate{.x = 2}).value, 3);
  EXPECT_EQ(rig.Give(Locate{.x = 3}).error, ErrorId::kNoWorkpiece);
  EXPECT_EQ(rig.Give(Locate{.number = 9}).error, ErrorId::kNoWorkpiece);
  EXPECT_EQ(rig.Give(Locate{.number = 3, .x = 4}).state, FeedbackState::kDone);  // corrected
  EXPECT_EQ(rig.The(3).pose.x, 4);
}

// PP-40: the 31st is refused, and nothing else is disturbed.
TEST(Objects, AreThirtyAtMost) {
  Rig rig(Straight());
  for (int i = 0; i < 30; ++i) {
    rig.Step(At(10 * i));
    EXPECT_EQ(rig.Detected({.x = 1.0 * i}), static_cast<std::uint32_t>(i + 1));
  }
  const State before = rig.state;
  const FeedbackEvent refused = rig.Give(Detect{.x = 5.0});
  EXPECT_EQ(refused.state, FeedbackState::kError);
  EXPECT_EQ(refused.error, ErrorId::kTooManyWorkpieces);
  EXPECT_EQ(static_cast<int>(refused.error), 17918);
  EXPECT_EQ(rig.Out().refused_count, 1u);
  EXPECT_EQ(rig.state.objects, before.objects);
  EXPECT_EQ(rig.state.count, 30u);
  rig.Give(RemoveObject{17});
  EXPECT_EQ(rig.Detected(), 31u);  // the refused one had no number
  EXPECT_EQ(Find(rig.state, 17), nullptr);
  for (std::uint32_t number = 1; number <= 31; ++number) {
    if (number != 17) {
      ASSERT_NE(Find(rig.state, number), nullptr) << number;
    }
  }
}

// PP-40: an object beyond the range is deleted and the next one is first; a taken one is not.
TEST(Objects, LeaveTheRange) {
  BeltParams p = Straight();
  p.lower_limit = 50;
  p.upper_limit = 200;
  Rig rig(p);
  rig.Step(At(0));
  const std::uint32_t a = rig.Detected({.x = 40.0}), b = rig.Detected({.x = 20.0}), c = rig.Detected({.x = 0.0});
  EXPECT_EQ(rig.Out().first_number, 0u);
  EXPECT_TRUE(std::isnan(rig.Out().first_pose.x));
  rig.Step(At(60, 100));
  EXPECT_EQ(rig.Out().in_range_count, 3u);
  EXPECT_EQ(rig.Out().first_number, a);
  EXPECT_NEAR(rig.Out().first_time_left, 1, 1e-12);
  EXPECT_TRUE(Take(b, rig.state).ok());
  rig.Step(At(160, 100));
  EXPECT_NE(Find(rig.state, a), nullptr) << "on the limit";
  rig.Step(At(160.001, 100));
  EXPECT_EQ(Find(rig.state, a), nullptr);
  EXPECT_EQ(rig.Out().first_number, c);
  EXPECT_EQ(rig.Out().lost_count, 1u);
  rig.Step(At(300, 100));
  EXPECT_EQ(ObjectsOf(rig.state).size(), 1u);
  EXPECT_EQ(rig.The(b).state, ObjectState::kTaken);
  EXPECT_FALSE(InRange(rig.params, rig.state, rig.The(b)));
  EXPECT_EQ(rig.Out().lost_count, 2u);
  EXPECT_TRUE(GiveBack(b, rig.state).ok());
  rig.Step(At(300, 100));
  EXPECT_TRUE(ObjectsOf(rig.state).empty());
  EXPECT_EQ(rig.Out().lost_count, 3u);
}

// CV-01: a belt that moves backwards takes its objects back, out of the range and in again.
TEST(Objects, GoBackWithTheBelt) {
  BeltParams p = Straight();
  p.lower_limit = 50;
  p.upper_limit = 200;
  Rig rig(p);
  rig.Step(At(0));
  const std::uint32_t number = rig.Detected({.x = 0.0});
  rig.Step(At(100, 100));
  EXPECT_TRUE(IsFree(rig.params, rig.state, rig.The(number)));
  rig.Step(At(40, -100));
  EXPECT_FALSE(InRange(rig.params, rig.state, rig.The(number)));
  rig.Step(At(60, 100));
  EXPECT_TRUE(InRange(rig.params, rig.state, rig.The(number)));
  EXPECT_EQ(rig.Place(number), 60);
}

// PP-40: an object that is never located is forgotten, if configured.
TEST(Objects, AreForgottenWithoutAPose) {
  BeltParams p = Straight();
  p.upper_limit = 10;
  p.forget_after = 100;
  Rig rig(p);
  rig.Step(At(0));
  rig.Detected();
  rig.Step(At(100));
  EXPECT_EQ(rig.state.count, 1u) << "it may lie far before the origin";
  rig.Step(At(100.5));
  EXPECT_EQ(rig.state.count, 0u);
  EXPECT_EQ(rig.state.lost, 1u);
}

// CV-44
TEST(Objects, KeepTheirAttributes) {
  Rig rig(Straight());
  rig.Detected({.kind = 3, .colour = 7, .quality = 0.25});
  rig.Give(Locate{.x = 1, .colour = 8});
  EXPECT_EQ(rig.The(1).attributes, (Attributes{3, 8, 0.25}));
  const Outputs out = rig.Out();
  EXPECT_EQ(out.first_kind, 3u);
  EXPECT_EQ(out.first_colour, 8u);
  EXPECT_EQ(out.first_quality, 0.25);
}

// CV-02
TEST(Objects, AreTakenOnce) {
  Rig rig(Straight());
  rig.Detected();
  EXPECT_EQ(rig.Give(TakeObject{1}).error, ErrorId::kNoWorkpiece) << "it is not visible";
  rig.Give(Locate{});
  EXPECT_EQ(rig.Give(GiveBackObject{1}).error, ErrorId::kNoWorkpiece);
  EXPECT_EQ(rig.Give(TakeObject{1}).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Give(TakeObject{1}).error, ErrorId::kNoWorkpiece);
  EXPECT_EQ(rig.Give(Locate{.number = 1}).error, ErrorId::kNoWorkpiece);
  EXPECT_EQ(rig.Out().first_number, 0u);
  EXPECT_EQ(rig.Out().taken_count, 1u);
  EXPECT_EQ(rig.Give(GiveBackObject{1}).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Out().first_number, 1u);
  EXPECT_EQ(rig.Give(RemoveObject{1}).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Give(RemoveObject{1}).error, ErrorId::kNoWorkpiece);
  rig.Detected();
  EXPECT_EQ(rig.Detected(), 3u);
  EXPECT_EQ(rig.Give(ClearObjects{}).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Out().object_count, 0u);
  EXPECT_EQ(rig.Out().lost_count, 0u);
  EXPECT_EQ(rig.Detected(), 4u);
}

// CV-43
TEST(Objects, AreForeseen) {
  BeltParams p = Straight();
  p.lower_limit = -100;
  p.upper_limit = 400;
  Rig rig(p);
  rig.Step(At(0, 200));
  const Object object = rig.The(rig.Detected({.x = 100.0}));
  EXPECT_DOUBLE_EQ(TimeTo(p, rig.state, object, 300), 1);
  EXPECT_EQ(TimeTo(p, rig.state, object, 100), 0);
  EXPECT_TRUE(std::isnan(TimeTo(p, rig.state, object, 50)));
  EXPECT_DOUBLE_EQ(PlaceIn(p, rig.state, object, 0.5), 200);
  EXPECT_DOUBLE_EQ(TimeLeft(p, rig.state, object), 1.5);
  rig.Step(At(0, -100));
  EXPECT_DOUBLE_EQ(TimeLeft(p, rig.state, object), 2);
  EXPECT_DOUBLE_EQ(TimeTo(p, rig.state, object, 50), 0.5);
  rig.Step(At(0, 0));
  EXPECT_TRUE(std::isnan(TimeTo(p, rig.state, object, 300)));
  EXPECT_TRUE(std::isinf(TimeLeft(p, rig.state, object)));
}

// CV-03, CV-22: on a table an object rotates about Z; its position is its angle.
TEST(Objects, TurnOnATable) {
  BeltParams p = Table();
  p.origin = {500, 0, 0, 0, 0, 30};
  p.lower_limit = 20;
  p.upper_limit = 90;
  Rig rig(p);
  rig.Step(At(360));
  const std::uint32_t number = rig.Detected({.x = 0.0, .y = 100.0, .c = 5.0});  // at 90 degrees
  rig.Step(At(300, 45));
  EXPECT_NEAR(rig.Place(number), 30, 1e-12);
  EXPECT_TRUE(InRange(p, rig.state, rig.The(number)));
  const kinematics::MovingFrame pose = PoseOf(p, rig.state, rig.The(number));
  const kinematics::Pose frame = kinematics::ToPose(pose.GetFrame());
  EXPECT_NEAR(frame.x, 500 + 100 * std::cos(60 * kDegree), 1e-9);
  EXPECT_NEAR(frame.y, 100 * std::sin(60 * kDegree), 1e-9);
  EXPECT_NEAR(frame.c, 5 - 60 + 30, 1e-9);
  EXPECT_NEAR(pose.p.v.Norm(), 100 * 45 * kDegree, 1e-9);
  EXPECT_NEAR(pose.M.w.z(), 45 * kDegree, 1e-12);
  EXPECT_NEAR(TimeLeft(p, rig.state, rig.The(number)), 60.0 / 45, 1e-9);
  rig.Step(At(361, 45));
  EXPECT_EQ(Find(rig.state, number), nullptr);
}

// CV-02: values that are not finite are refused and change nothing.
TEST(Objects, RefusesNumbersThatAreNone) {
  Rig rig(Straight());
  EXPECT_EQ(rig.Give(Detect{.x = NAN}).error, ErrorId::kParameter);
  EXPECT_EQ(rig.Give(Detect{.recorded_position = INFINITY}).error, ErrorId::kParameter);
  EXPECT_EQ(rig.Give(Locate{.y = NAN}).error, ErrorId::kParameter);
  EXPECT_EQ(rig.Give(TakeObject{0}).error, ErrorId::kParameter);
  EXPECT_EQ(rig.state.count, 0u);
  EXPECT_EQ(rig.state.last_number, 0u);
}

}  // namespace
}  // namespace takt::conveyor
