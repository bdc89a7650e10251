// Inputs that were reported to Ruckig as failing (pantor/ruckig, issue numbers in the names), each axis by itself.
// Where a report leaves out a limit, a range of them is tried.
#include <gtest/gtest.h>

#include <vector>

#include "problems.h"
#include "takt/trajectory/planner.h"

namespace takt::trajectory {
namespace {

struct Axis {
  double p, v, a;  // start
  double target, end_velocity;
  double v_max, a_max, j_max;
};

void ExpectPlanned(const std::vector<Axis>& axes) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Axis& x = axes[i];
    for (const double unit : {1.0, 1e3, 1e6}) {
      const KinematicState from{unit * x.p, unit * x.v, unit * x.a};
      const Limits limits{unit * x.v_max, unit * x.a_max, unit * x.a_max, unit * x.j_max};
      Planner planner;
      Profile plan;
      ASSERT_TRUE(planner.ToPosition(from, unit * x.target, unit * x.end_velocity, limits, plan).ok())
          << "axis " << i << " unit " << unit;
      const testing::Excess e = testing::Audit(plan, limits);
      EXPECT_LE(e.velocity, 1e-9) << i;
      EXPECT_LE(std::max(e.acceleration, e.deceleration), 1e-9) << i;
      EXPECT_LE(std::max(e.velocity_step, e.acceleration_step), 1e-9) << i;
      EXPECT_EQ(plan.end(), (KinematicState{unit * x.target, unit * x.end_velocity, 0}));
    }
  }
}

// Visual servoing: targets very close to a slow start. Limits not given.
TEST(RuckigIssue, N19TargetsCloseToASlowStart) {
  for (const double v : {0.1, 1.0, 3.0}) {
    for (const double a : {0.2, 1.0, 10.0}) {
      for (const double j : {0.5, 10.0, 1000.0}) {
        ExpectPlanned({{-0.843763019702056, -0.0303436943534115, 0.0941203950600968, -0.847254234340315, 0, v, a, j},
                       {-1.26164314329262, 0.0371785718477563, -0.152313813731685, -1.25777615061367, 0, v, a, j},
                       {1.62592703780797, -0.0294029319779939, 0.134100351460333, 1.62279392916203, 0, v, a, j},
                       {-1.26322670514057, -0.0129669308625882, 0.0630571844324987, -1.26518389118862, 0, v, a, j},
                       {-0.900133529360832, -0.030242580748223, 0.0116214644247746, -0.90368278625599, 0, v, a, j},
                       {1.09819107359504, 0.00636710830722948, -0.0622068786789912, 1.09921788488865, 0, v, a, j}});
      }
    }
  }
}

// Seven axes, speeds at or beyond their limit of 1, high jerk.
TEST(RuckigIssue, N24SpeedsAtTheLimitWithHighJerk) {
  ExpectPlanned({{0.01073568005271233, 0.05656281587106524, -5.348847133445708, 0.0698, 0, 1, 7, 1000},
                 {-0.7002627264230739, 1.011281770884991, -3.400994300842285, 0.6283, 0, 1, 7, 1000},
                 {0.08182424814164639, 0.9677565166950226, -3.708171844482422, 0.6981000000000001, 0, 1, 7, 1000},
                 {-2.453889055015553, 0.9125879855751985, -3.951635360717773, -2.1642, 0, 1, 7, 1000},
                 {-0.08363270962592464, -0.9937611499130723, 3.508039474487305, -0.733, 0, 1, 7, 1000},
                 {1.829417851685384, 0.9963710898160936, -3.532837390899658, 2.5482, 0, 1, 7, 1000},
                 {0.7163509366199623, -0.8048512544333941, 4.73619270324707, 0.5061, 0, 1, 7, 1000}});
}

// Failed at a jerk of 62.5 and not at 32.5.
TEST(RuckigIssue, N96LowerJerkHelped) {
  for (const double j : {62.5, 32.5}) {
    ExpectPlanned({{0.2473592757796861, -0.2426115138900957, 0.01877538437863763, 0.2308075286416321, 0, 0.25, 2.5, j},
                   {0.2921606775204735, 0.2200706500820608, -0.6573642866096158, 0.3066442218484541, 0, 0.25, 2.5, j},
                   {0.7758663276711127, -0.01891492763905089, 0.5, 0.7733155040940536, 0, 0.25, 2.5, j},
                   {3.141592653589793, 0, 0, 3.141592653589793, 0, 0.35, 3.5, 1.4 * j}});
  }
}

// From rest to targets passed at speed.
TEST(RuckigIssue, N106EndVelocities) {
  ExpectPlanned({{1.570796326794897, 0, 0, 1.329224180107117, -0.3363008405858447, 3, 30, 30},
                 {-0.7853981633974483, 0, 0, -1.860725548727889, -1.497, 3, 30, 30},
                 {1.570796326794897, 0, 0, 2.084440302845179, 0.7150613316808525, 5, 50, 50},
                 {-2.356194490192345, 0, 0, -2.282429484289127, 0.102690785470124, 10, 100, 100},
                 {-1.570796326794897, 0, 0, -0.5282717423818638, 1.45133409988134, 10, 100, 100},
                 {0, 0, 0, 0.6502926543734557, 0.9052946264340856, 10, 100, 100}});
}

// Braking at the limit of acceleration, so that the target is the stopping position except for rounding. Jerk not
// given.
TEST(RuckigIssue, N129BrakingAtTheLimit) {
  constexpr double kA = 4.363323129985824;
  for (const double j : {20.0, 43.63323129985824, 100.0, 1000.0}) {
    ExpectPlanned(
        {{1.635923973038584, 0.5997002460539949, -2.111156774102785, 1.6863294690542, 0, 5.235987755982989, kA, j},
         {-0.02664577603159074, 0.657823987334049, -4.363323129985824, 0.02475975543627795, 0, 3.926990816987241, kA,
          j},
         {1.398772409994243, 0.6544488698370342, -3.853477374887802, 1.450144052898067, 0, 3.926990816987241, kA, j},
         {0.7204359129215889, 0.6534667437575569, -4.32029086362776, 0.7716208457168268, 0, 6.649704450098396, kA, j},
         {0.7531949879258638, 0.6578239873340388, -4.363323129985824, 0.8046005193937291, 0, 5.427973973702365, kA, j},
         {-0.3527181789404736, 0.6578239873340486, -4.363323129985824, -0.301312647472602, 0, 8.587019919812102, kA,
          j}});
  }
}

// A single axis a rounding beside the switching curve.
TEST(RuckigIssue, N100BesideTheSwitchingCurve) {
  ExpectPlanned({{0.02853333333333339, 0.6800000000000006, 7.999999999999993, 0, 0, 1, 10, 100}});
}

// Already there, except for roundings of all three.
TEST(RuckigIssue, N160AndN216AlreadyThereToRounding) {
  ExpectPlanned(
      {{-0.04895883258572608, 1.425883388427091e-14, -2.370282711878416e-12, -0.04895883258572691, 0, 5, 10, 150},
       {0.1992637939208025, -9.520201039439915e-20, 0, 0.1992637939208025, 0, 5, 10, 150},
       {0.2093483656756634, 1.924174584908152e-18, -3.608224830031759e-16, 0.2093483656756634, 0, 5, 10, 150},
       {446.62116880136932, 4.4408920985006262e-16, 0, 446.62116880136932, 0, 500, 500, 5000},
       {42.735729882548974, -1.6205012520938689e-18, -4.0512531302346743e-17, 42.735729882548974, 0, 500, 500, 5000}});
}

// Millimetres and a jerk of a million; the speed limit equal to the speed, and both tiny.
TEST(RuckigIssue, N194AndN90LimitsFarApart) {
  ExpectPlanned({{0, 0, 0, 719, 0, 546.454545454545, 27272.72727272725, 1363636.363636363},
                 {1.250459998705841, 2.794826109810867e-08, 0, 1.25046, 0, 2.794826109810866e-08, 133.6267625041427,
                  2087.918294622123}});
}

// The end velocity is the velocity limit, the start is faster.
TEST(RuckigIssue, N130EndVelocityAtTheLimit) {
  ExpectPlanned({{3.62255615705579, -0.06422550797049381, 0, 3.587689540855463, -0.06423623454575711,
                  0.06423623454575711, 0.261799388, 100},
                 {2.181127634157466, 0.1207111377965507, -0.3999999999978001, 2.271916653384632, 0.1187909578397501,
                  0.1187909578397501, 0.4, 100}});
}

}  // namespace
}  // namespace takt::trajectory
