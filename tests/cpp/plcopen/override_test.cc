// MC_SetOverride: AX-51 as a block.
#include <gtest/gtest.h>

#include <limits>

#include "bench.h"

namespace takt::plcopen {
namespace {

class SetOverrideBlock : public Blocks {};

// AX-51, AX-95: the factors count as long as Enable is true, whenever they change; afterwards the last ones stay.
TEST_F(SetOverrideBlock, KeepsTheFactors) {
  MC_SetOverride set(x);
  MC_MoveVelocity move(x);
  move.velocity = 100;
  move.Execute = true;
  set.VelFactor = 0.5;
  set();
  EXPECT_FALSE(set.Enabled() || set.Busy() || set.Error());
  ASSERT_TRUE(Until(move, [&] { return move.InVelocity(); }));
  EXPECT_EQ(At(x).set_velocity, 100);
  set.Enable = true;
  set();
  EXPECT_TRUE(set.Busy() && !set.Enabled());
  ASSERT_TRUE(Until(set, [&] { return set.Enabled() && At(x).set_velocity == 50; }));
  EXPECT_EQ(At(x).override_factor, 0.5);
  set.VelFactor = 0;
  set();
  EXPECT_FALSE(set.Enabled());
  ASSERT_TRUE(Until(set, [&] { return set.Enabled() && At(x).set_velocity == 0; }));
  EXPECT_EQ(bench.State(x), axis::PlcState::kContinuousMotion);
  set.VelFactor = 0.25;
  ASSERT_TRUE(Until(set, [&] { return At(x).set_velocity == 25; }));
  set.Enable = false;
  set.VelFactor = 1;
  set();
  Step(100);
  set();
  EXPECT_EQ(At(x).set_velocity, 25);
  EXPECT_FALSE(set.Enabled() || set.Busy());
}

// AX-51: AccFactor and JerkFactor 0 are refused; what was set stays.
TEST_F(SetOverrideBlock, ShowsWhatIsRefused) {
  MC_SetOverride set(x);
  set.Enable = true;
  set.VelFactor = 0.5;
  ASSERT_TRUE(Until(set, [&] { return set.Enabled(); }));
  for (double MC_SetOverride::*const factor : {&MC_SetOverride::AccFactor, &MC_SetOverride::JerkFactor}) {
    set.*factor = 0;
    ASSERT_TRUE(Until(set, [&] { return set.Error(); }));
    EXPECT_EQ(set.ErrorID(), ErrorId::kParameter);
    EXPECT_FALSE(set.Enabled() || set.Busy());
    EXPECT_EQ(At(x).override_factor, 0.5);
    set.*factor = 1;
    ASSERT_TRUE(Until(set, [&] { return set.Enabled(); }));
  }
}

}  // namespace
}  // namespace takt::plcopen
