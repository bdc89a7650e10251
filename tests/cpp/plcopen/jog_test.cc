// GT_Jog: moving by hand (AX-39).
#include <gtest/gtest.h>

#include "bench.h"

namespace takt::plcopen {
namespace {

class JogTest : public Blocks {
 protected:
  JogTest() : jog(bench.x) { jog.velocity = 50; }

  // Calls the block with these keys for so many cycles; the velocity then.
  double Press(bool enable, bool up, bool down, int cycles = 200) {
    jog.Enable = enable;
    jog.JogPos = up;
    jog.JogNeg = down;
    for (; cycles > 0; --cycles) {
      jog();
      Step();
    }
    return At(x).set_velocity;
  }
  GT_Jog jog;
};

// AX-39: the direction pressed first wins; both must be let go before the next jog.
TEST_F(JogTest, TheKeyPressedFirstWins) {
  EXPECT_EQ(Press(false, true, false), 0);  // not enabled
  Press(false, false, false, 1);
  EXPECT_DOUBLE_EQ(Press(true, true, false), 50);
  EXPECT_DOUBLE_EQ(Press(true, true, true), 50);
  EXPECT_EQ(Press(true, false, true), 0);
  EXPECT_EQ(Press(true, false, false, 5), 0);
  EXPECT_DOUBLE_EQ(Press(true, false, true, 50), -50);
  EXPECT_EQ(Press(false, false, true), 0);
  EXPECT_FALSE(jog.Error());
}

// AX-39: a key that is held while Enable goes and comes moves nothing; nor does one pressed before Enable.
TEST_F(JogTest, NeedsAKeyPressedAnew) {
  EXPECT_DOUBLE_EQ(Press(true, true, false), 50);
  EXPECT_EQ(Press(false, true, false), 0);
  EXPECT_EQ(Press(true, true, false), 0);
  Press(false, false, false, 1);  // seen up while not enabled
  Press(false, true, false, 1);
  EXPECT_EQ(Press(true, true, false), 0);
  Press(true, false, false, 1);
  EXPECT_DOUBLE_EQ(Press(true, true, false), 50);
}

// AX-39: the second key brings a velocity that is refused; the axis does not run on without anyone holding it.
TEST_F(JogTest, EndsWhereItCannotGoOn) {
  EXPECT_DOUBLE_EQ(Press(true, true, false), 50);
  jog.velocity = -1;
  EXPECT_EQ(Press(true, true, true), 0);
  EXPECT_EQ(jog.ErrorID(), ErrorId::kParameter);
  Press(true, false, false, 1);
  EXPECT_FALSE(jog.Error());
}

// AX-39: also when the keys change twice before the engine has answered.
TEST_F(JogTest, EndsWhereItCannotGoOnTwice) {
  EXPECT_DOUBLE_EQ(Press(true, true, false), 50);
  jog.velocity = -1;
  Press(true, true, true, 0);
  jog();
  EXPECT_EQ(Press(true, true, false), 0);
  EXPECT_EQ(jog.ErrorID(), ErrorId::kParameter);
}

// AX-11, AX-39: the key is let go before the answer is there; the error is shown in one call.
TEST_F(JogTest, TheErrorOfAShortJogIsSeen) {
  GT_Jog unpowered(bench.r);
  unpowered.Enable = unpowered.JogPos = true;
  unpowered();
  unpowered.JogPos = false;
  unpowered();
  Step();
  unpowered();
  EXPECT_EQ(unpowered.ErrorID(), ErrorId::kPowerOff);
  unpowered();
  EXPECT_FALSE(unpowered.Error());
}

// AX-39: pressed again in the cycle in which it was let go: the second press counts, once the first is settled.
TEST_F(JogTest, PressedAgainAtOnce) {
  jog.Enable = jog.JogPos = true;
  jog();
  jog.JogPos = false;
  jog();
  EXPECT_DOUBLE_EQ(Press(true, true, false), 50);
  EXPECT_EQ(Press(true, false, false), 0);
}

}  // namespace
}  // namespace takt::plcopen
