// From the raw counts of the encoder to position and velocity in the axis' unit.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/ports.h"

namespace takt::axis {

enum class EncoderType : std::uint8_t { kIncremental, kAbsoluteSsi };
enum class SsiCoding : std::uint8_t { kBinary, kGray };

// A scale with distance-coded marks. In its own sense the marks lie in pairs: pair k has a fixed mark at k * distance
// and a coded one at (k + 1/2) * distance + (k + 1) * step, so that each pair of neighbours has a distance of its own.
struct CodedMarks {
  double distance = 0;    // [u] > 0, from one fixed mark to the next
  double step = 0;        // [u] > 0, by which the distance from fixed to coded mark grows from pair to pair
  double position = 0;    // [u] of the axis at the fixed mark of pair 0
  bool reversed = false;  // the scale counts against the axis

  bool operator==(const CodedMarks&) const = default;
};

struct Encoder {
  EncoderType type = EncoderType::kIncremental;
  double increments_per_unit = 1000;        // [counts per u] > 0
  bool invert = false;                      // counts fall while the position grows
  int ssi_bits = 24;                        // absolute: 8 to 32 (binary: signed); higher bits are ignored
  SsiCoding coding = SsiCoding::kBinary;    // absolute
  double offset = 0;                        // [u] position at count 0
  double velocity_filter_s = 0;             // [s] >= 0: time constant of the velocity filter; 0: none
  std::optional<CodedMarks> coded_marks{};  // unset: index pulses are all alike

  bool operator==(const Encoder&) const = default;
};

struct EncoderInputs {
  std::uint32_t counts = 0;  // raw
  bool error = false;        // ERR line, or no answer
  double largest_step = 0;   // [u] largest displacement of the axis in one cycle; 0: any step is accepted
  std::uint32_t cycles = 1;  // since the previous sample; 0: no new sample
};

struct EncoderState {
  bool started = false;      // a first sample was taken
  bool trusting = false;     // the next sample is accepted at any distance
  std::uint32_t word = 0;    // last good sample, decoded
  std::int64_t count = 0;    // the same, unwrapped
  std::uint32_t missed = 0;  // cycles since the last good sample
  double velocity = 0;       // [u/s] filtered

  bool operator==(const EncoderState&) const = default;
};

// While `error` is set, position and velocity are those of the last good sample.
struct EncoderOutputs {
  double position = 0;  // [u] continuous over all wraps
  double velocity = 0;  // [u/s]
  bool error = false;   // the encoder reports an error, or it jumped further than the axis can move
};

// Evaluates one sample. A jump is rejected: the last good sample stays, and the next one is compared with it over the
// longer time. So one bad word costs one cycle with an error, and an encoder that really is elsewhere is accepted once
// the axis could have moved that far, or after Trust. Between two good samples the count must change by less than half
// its range: 2^31, or 2^(ssi_bits - 1).
void Step(const Encoder& params, const EncoderInputs& inputs, Cycle cycle, EncoderState& state,
          EncoderOutputs& outputs) noexcept;

// After a fault was cleared (MC_Reset): the next good sample is accepted at any distance, as the axis may have moved.
void Trust(EncoderState& state) noexcept;

// Returns the position [u] of a counter value latched near the last good sample (index pulse).
double LatchedPosition(const Encoder& params, const EncoderState& state, std::uint32_t counts) noexcept;

// Returns the position [u] of the axis at the mark `mark` [u], given the position of the neighbouring mark that was
// passed before it; empty if no neighbours have this distance, within a quarter of a step.
std::optional<double> MarkPosition(const CodedMarks& marks, double before, double mark) noexcept;

// Returns a position in unwrapped counts: csp set points.
inline double CountsAt(const Encoder& params, double position) noexcept {
  const double counts = (position - params.offset) * params.increments_per_unit;
  return params.invert ? -counts : counts;
}
// Returns a velocity in counts/s.
inline double CountRateAt(const Encoder& params, double velocity) noexcept {
  const double rate = velocity * params.increments_per_unit;
  return params.invert ? -rate : rate;
}

void describe(Enumeration<EncoderType>&);
void describe(Enumeration<SsiCoding>&);
void describe(Description<CodedMarks>&);
void describe(Description<Encoder>&);
void describe(Description<EncoderState>&);

}  // namespace takt::axis
