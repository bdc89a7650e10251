// AX-04, and AX-03's measurement part: from raw counts to position and velocity.
#include "takt/axis/encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "takt/core/verify.h"

namespace takt::axis {
namespace {

struct Measurement {
  Encoder params;
  EncoderInputs in;
  EncoderState state;
  EncoderOutputs out;

  const EncoderOutputs& Read(std::int64_t counts, bool error = false) {
    in.counts = static_cast<std::uint32_t>(counts);
    in.error = error;
    Step(params, in, Cycle{.count = 0, .period_s = 0.001}, state, out);
    return out;
  }
};

TEST(Encoder, CountsBecomePositionAndVelocity) {  // AX-03: increments per u
  Measurement m;
  m.params.increments_per_unit = 1000;
  EXPECT_EQ(m.Read(2500).position, 2.5);
  EXPECT_EQ(m.out.velocity, 0) << "one sample says nothing of speed";
  EXPECT_EQ(m.Read(2700).position, 2.7);
  EXPECT_DOUBLE_EQ(m.out.velocity, 200);
  EXPECT_DOUBLE_EQ(m.Read(2600).velocity, -100);
}

TEST(Encoder, InvertAndOffset) {  // AX-03: measurement sense
  Measurement m;
  m.params.invert = true;
  m.params.offset = 10;
  EXPECT_EQ(m.Read(2500).position, 7.5);
  EXPECT_DOUBLE_EQ(m.Read(2600).velocity, -100);
  EXPECT_DOUBLE_EQ(CountsAt(m.params, m.out.position), 2600);
  EXPECT_DOUBLE_EQ(CountRateAt(m.params, 3), -3000);
}

TEST(Encoder, CounterWrapsBothWays) {  // AX-04: 32-bit wrap
  Measurement m;
  const std::int64_t top = 0x7FFFFFF0;
  m.Read(top);
  for (std::int64_t k = 1; k <= 1000; ++k) ASSERT_EQ(m.Read(top + k).position, static_cast<double>(top + k) / 1000);
  for (std::int64_t k = 999; k >= -1000; --k) ASSERT_EQ(m.Read(top + k).position, static_cast<double>(top + k) / 1000);
  EXPECT_EQ(m.Read(top - 1100).velocity, -100);

  Measurement zero;  // through 0 and 0xFFFFFFFF
  zero.Read(5);
  EXPECT_EQ(zero.Read(-5).position, -0.005);
  EXPECT_DOUBLE_EQ(zero.out.velocity, -10);
  EXPECT_EQ(zero.Read(5).position, 0.005);
}

TEST(Encoder, CounterThatStartsBehindTheMiddleIsNegative) {  // AX-04
  Measurement m;
  EXPECT_EQ(m.Read(0xFFFFFFFF).position, -0.001);
}

TEST(Encoder, ExactAfterManyWraps) {  // AX-04: no drift
  Measurement m;
  m.params.increments_per_unit = 4096;
  m.Read(0);
  const std::int64_t step = 1'500'000'001;
  std::int64_t count = 0;
  for (int k = 0; k < 1'000'000; ++k) m.Read(count += step);
  EXPECT_EQ(m.state.count, 1'500'000'001'000'000);  // about 350,000 times round
  EXPECT_EQ(m.out.position, 1'500'000'001'000'000.0 / 4096);
  for (int k = 0; k < 1'000'000; ++k) m.Read(count -= step);
  EXPECT_EQ(m.out.position, 0);
}

TEST(Encoder, MillionSmallStepsGiveTheSamePositionAsOneLargeOne) {  // AX-04: exact, 1e9 counts
  Measurement m;
  m.params.increments_per_unit = 3;  // no binary fraction
  m.Read(0);
  for (int k = 1; k <= 1'000'000; ++k) m.Read(std::int64_t{1000} * k);
  EXPECT_EQ(m.out.position, 1e9 / 3);
}

TEST(Encoder, GrayCodeTable) {  // AX-04: the reflected code of 4 bits as printed in any textbook
  constexpr std::uint32_t kGray[16] = {0b0000, 0b0001, 0b0011, 0b0010, 0b0110, 0b0111, 0b0101, 0b0100,
                                       0b1100, 0b1101, 0b1111, 0b1110, 0b1010, 0b1011, 0b1001, 0b1000};
  Measurement m;
  m.params = {.type = EncoderType::kAbsoluteSsi, .increments_per_unit = 1, .ssi_bits = 8, .coding = SsiCoding::kGray};
  for (int k = 0; k < 16; ++k) EXPECT_EQ(m.Read(kGray[k]).position, k);
}

TEST(Encoder, GrayCodeOfEveryWidthInvertsItsDefinition) {  // AX-04: 8 to 32 bits
  std::mt19937 random(7);
  for (int bits = 8; bits <= 32; ++bits) {
    const std::uint32_t mask = ~std::uint32_t{0} >> (32 - bits);
    for (int k = 0; k < 200; ++k) {
      const auto word = static_cast<std::uint32_t>(random()) & mask;
      Measurement m;
      m.params = {
          .type = EncoderType::kAbsoluteSsi, .increments_per_unit = 1, .ssi_bits = bits, .coding = SsiCoding::kGray};
      ASSERT_EQ(m.Read(word ^ (word >> 1)).position, word) << bits;
    }
  }
}

TEST(Encoder, SsiWordWraps) {  // AX-04: a single-turn encoder on an axis that goes on
  for (const SsiCoding coding : {SsiCoding::kBinary, SsiCoding::kGray}) {
    Measurement m;
    m.params = {.type = EncoderType::kAbsoluteSsi, .increments_per_unit = 1, .ssi_bits = 10, .coding = coding};
    const auto wire = [&](std::int64_t count) {
      const std::int64_t word = count & 1023;
      return coding == SsiCoding::kGray ? word ^ (word >> 1) : word;
    };
    EXPECT_EQ(m.Read(wire(1000)).position, 1000) << "absolute: the word as it is, never negative";
    for (int count = 1000; count <= 5000; count += 100) ASSERT_EQ(m.Read(wire(count)).position, count);
    for (int count = 5000; count >= -5000; count -= 100) ASSERT_EQ(m.Read(wire(count)).position, count);
  }
}

TEST(Encoder, AbsolutePositionsOfDrivesHaveASign) {  // AX-04, AX-87: 32 bits in binary; fewer count from 0 up
  Measurement drive;
  drive.params.type = EncoderType::kAbsoluteSsi;
  drive.params.ssi_bits = 32;
  EXPECT_EQ(drive.Read(-10000).position, -10);
  EXPECT_EQ(drive.Read(-9900).position, -9.9);
  Measurement word;
  word.params.type = EncoderType::kAbsoluteSsi;
  EXPECT_EQ(word.Read((1 << 24) - 1000).position, 16776.216);
  Measurement gray;
  gray.params = {.type = EncoderType::kAbsoluteSsi, .ssi_bits = 32, .coding = SsiCoding::kGray};
  EXPECT_EQ(gray.Read(0x80000000).position, 4294967.295);
}

TEST(Encoder, BitsAboveTheWordAreIgnored) {  // AX-04
  Measurement m;
  m.params = {.type = EncoderType::kAbsoluteSsi, .increments_per_unit = 1, .ssi_bits = 12};
  EXPECT_EQ(m.Read(0xABCDE123).position, 0x123);
}

TEST(Encoder, ErrorLineHoldsPositionUntilItIsGone) {  // AX-04: ERR
  Measurement m;
  m.Read(1000);
  m.Read(1100);
  EXPECT_TRUE(m.Read(77777, true).error);
  EXPECT_EQ(m.out.position, 1.1);
  EXPECT_DOUBLE_EQ(m.out.velocity, 100);
  EXPECT_TRUE(m.Read(88888, true).error);
  EXPECT_FALSE(m.Read(1400).error);
  EXPECT_EQ(m.out.position, 1.4);
  EXPECT_DOUBLE_EQ(m.out.velocity, 100) << "300 counts in three cycles";
}

TEST(Encoder, ErrorBeforeTheFirstSample) {  // AX-04
  Measurement m;
  EXPECT_TRUE(m.Read(500, true).error);
  EXPECT_FALSE(m.state.started);
  EXPECT_EQ(m.Read(500).position, 0.5);
  EXPECT_EQ(m.out.velocity, 0);
}

TEST(Encoder, ImpossibleJumpIsAnErrorAndNotBelieved) {  // AX-04
  Measurement m;
  m.in.largest_step = 0.5;
  m.Read(0);
  EXPECT_FALSE(m.Read(500).error) << "just possible";
  EXPECT_TRUE(m.Read(1001).error) << "501 counts";
  EXPECT_EQ(m.out.position, 0.5);
  EXPECT_FALSE(m.Read(1001).error) << "in two cycles the axis can have got there";
  EXPECT_EQ(m.out.position, 1.001);
  EXPECT_TRUE(m.Read(1001 - 501).error);
}

TEST(Encoder, OneBadWordCostsOneCycle) {  // AX-04
  Measurement m;
  m.in.largest_step = 0.5;
  m.params = {.type = EncoderType::kAbsoluteSsi, .ssi_bits = 24};
  m.Read(1000);
  EXPECT_TRUE(m.Read(1000 ^ 0x400000).error);
  EXPECT_FALSE(m.Read(1100).error);
  EXPECT_EQ(m.out.position, 1.1);
}

TEST(Encoder, TrustTakesTheNextSample) {  // AX-04: after MC_Reset
  Measurement m;
  m.in.largest_step = 0.5;
  m.Read(0);
  EXPECT_TRUE(m.Read(100000).error);
  Trust(m.state);
  EXPECT_TRUE(m.Read(100000, true).error) << "not while the encoder itself complains";
  EXPECT_FALSE(m.Read(100000).error);
  EXPECT_EQ(m.out.position, 100);
  EXPECT_EQ(m.out.velocity, 0) << "a slip is no speed";
  EXPECT_TRUE(m.Read(200000).error) << "once";
}

TEST(Encoder, VelocityFilterIsFirstOrder) {
  Measurement m;
  m.params.velocity_filter_s = 0.01;
  m.Read(0);
  for (int k = 1; k <= 30; ++k) {
    m.Read(100 * k);
    ASSERT_NEAR(m.out.velocity, 100 * (1 - std::exp(-0.1 * k)), 1e-9);
  }
}

TEST(Encoder, LatchedPositionNearAWrap) {  // AX-04: index pulse
  Measurement m;
  m.Read(0x7FFFFFFF);
  m.Read(0x80000010);
  EXPECT_EQ(LatchedPosition(m.params, m.state, 0x7FFFFFF0), 2147483632.0 / 1000);
  EXPECT_EQ(LatchedPosition(m.params, m.state, 0x80000000), 2147483648.0 / 1000);
}

TEST(Encoder, IsDescribed) {  // EN-11
  for (const Type* type : {&TypeOf<Encoder>(), &TypeOf<EncoderState>()}) EXPECT_THAT(Verify(*type), testing::IsEmpty());
}

}  // namespace
}  // namespace takt::axis
