#include "takt/axis/encoder.h"

#include <cmath>

#include "takt/core/describe.h"
#include "takt/core/maths.h"

namespace takt::axis {

namespace {

constexpr std::uint32_t kHeld = 4;  // cycles without a valid sample for which the last velocity is kept

int Bits(const Encoder& p) noexcept {
  return p.type == EncoderType::kIncremental ? 32 : p.ssi_bits;
}

std::uint32_t Decode(const Encoder& p, std::uint32_t counts) noexcept {
  if (p.type == EncoderType::kIncremental) return counts;
  std::uint32_t word = counts & (~std::uint32_t{0} >> (32 - p.ssi_bits));
  if (p.coding == SsiCoding::kGray) {
    for (int shift = 1; shift < 32; shift *= 2) word ^= word >> shift;
  }
  return word;
}

// Returns the shortest difference of two words around the counter.
std::int64_t Difference(const Encoder& p, std::uint32_t from, std::uint32_t to) noexcept {
  const int unused = 32 - Bits(p);
  return static_cast<std::int32_t>((to - from) << unused) >> unused;
}

// Returns true if the counter starts as a signed number, as position objects of drives are.
bool IsSigned(const Encoder& p) noexcept {
  return p.type == EncoderType::kIncremental || (p.ssi_bits == 32 && p.coding == SsiCoding::kBinary);
}

double PositionOf(const Encoder& p, std::int64_t count) noexcept {
  const double distance = static_cast<double>(count) / p.increments_per_unit;
  return p.offset + (p.invert ? -distance : distance);
}

// Accepts the sample into the state; `distance`: displacement since the last one [u]. Returns false if it is a jump.
bool Take(const Encoder& p, const EncoderInputs& in, EncoderState& s, double& distance) noexcept {
  const std::uint32_t word = Decode(p, in.counts);
  distance = 0;
  if (!s.started) {
    s.count = IsSigned(p) ? static_cast<std::int32_t>(word) : std::int64_t{word};
  } else {
    const std::int64_t step = Difference(p, s.word, word);
    distance = static_cast<double>(p.invert ? -step : step) / p.increments_per_unit;
    const double largest = in.largest_step * static_cast<double>(s.missed + in.cycles);
    if (!s.trusting && in.largest_step > 0 && std::abs(distance) > largest) return false;
    s.count += step;
    if (s.trusting) distance = 0;
  }
  s.started = true;
  s.trusting = false;
  s.word = word;
  return true;
}

}  // namespace

void Step(const Encoder& p, const EncoderInputs& in, Cycle cycle, EncoderState& s, EncoderOutputs& out) noexcept {
  double distance = 0;
  const bool fresh = in.cycles > 0;
  out.error = fresh ? in.error || !Take(p, in, s, distance) : s.missed > 0;
  if (out.error) {
    s.missed += in.cycles;
    if (s.missed > kHeld) s.velocity = 0;
  } else if (fresh) {
    const double time = cycle.period_s * static_cast<double>(s.missed + in.cycles);
    const double share = p.velocity_filter_s > 0 ? -maths::Expm1(-time / p.velocity_filter_s) : 1;
    s.velocity += (distance / time - s.velocity) * share;
    s.missed = 0;
  }
  out.position = PositionOf(p, s.count);
  out.velocity = s.velocity;
}

void Trust(EncoderState& s) noexcept {
  s.trusting = true;
}

double LatchedPosition(const Encoder& p, const EncoderState& s, std::uint32_t counts) noexcept {
  return PositionOf(p, s.count + Difference(p, s.word, Decode(p, counts)));
}

// Upwards from a fixed mark, its coded mark is half the distance plus some steps away, the next fixed one the
// remainder.
std::optional<double> MarkPosition(const CodedMarks& m, double before, double mark) noexcept {
  const double apart = m.reversed ? before - mark : mark - before;
  const double steps = (std::abs(apart) - m.distance / 2) / m.step;
  const double whole = std::round(std::abs(steps));
  const bool coded = whole >= 1 && whole * m.step < m.distance / 2 && std::abs(std::abs(steps) - whole) <= 0.25;
  if (!coded) return std::nullopt;
  const double fixed_mark = (whole - 1) * m.distance;
  const double coded_mark = fixed_mark + m.distance / 2 + whole * m.step;
  const double lower = steps > 0 ? fixed_mark : coded_mark;
  const double upper = steps > 0 ? coded_mark : fixed_mark + m.distance;
  const double at = apart > 0 ? upper : lower;
  return m.position + (m.reversed ? -at : at);
}

void describe(Enumeration<EncoderType>& e) {
  e.about("Kind of signal of an encoder.");
  e.value(EncoderType::kIncremental, "incremental", "A 32-bit counter of quadrature increments.");
  e.value(EncoderType::kAbsoluteSsi, "absolute_ssi", "An SSI word that represents the position.");
}

void describe(Enumeration<SsiCoding>& e) {
  e.about("Coding of the position of an SSI encoder.");
  e.value(SsiCoding::kBinary, "binary", "Binary number.");
  e.value(SsiCoding::kGray, "gray", "Gray code: one bit changes from one count to the next.");
}

void describe(Description<CodedMarks>& d) {
  using M = CodedMarks;
  d.about(
      "Distance-coded reference marks: pair k has a fixed mark at k distance, and a coded mark (k + 1) step beyond the "
      "middle between this fixed mark and the next. The distance of two neighbours determines the position "
      "(step_distance_coded).");
  d.required<&M::distance>(unit::u, between(1e-6, 1e9), "Distance from one fixed mark to the next.");
  d.required<&M::step>(unit::u, between(1e-9, 1e9),
                       "Distance by which the coded mark moves from the middle with each pair.");
  d.defaulted<&M::position>(unit::u, "Position of the axis at the fixed mark of pair 0.");
  d.defaulted<&M::reversed>("The scale counts in the opposite sense to the axis.");
  d.rule<&M::step>("must be less than half of distance", [](const M& m) { return m.step < m.distance / 2; });
}

void describe(Description<Encoder>& d) {
  using P = Encoder;
  d.about("The position encoder of an axis.");
  d.defaulted<&P::type>("Kind of signal.");
  d.defaulted<&P::increments_per_unit>(unit::count_u, between(1e-6, 1e9), "Counts per unit of the axis.");
  d.defaulted<&P::invert>("Counts fall while the position grows.");
  d.defaulted<&P::ssi_bits>(
      between(8, 32), "Absolute: bits of the word; 32 bits in binary are a signed number, as sent by drives on a bus.");
  d.defaulted<&P::coding>("Absolute: coding of the word.");
  d.defaulted<&P::offset>(unit::u, "Position of the axis at count 0 of the encoder.");
  d.defaulted<&P::velocity_filter_s>(unit::s, between(0, 10), "Time constant of the velocity filter; 0: none.");
  d.defaulted<&P::coded_marks>("Distance-coded reference marks; unset: index pulses are all alike.");
  d.rule<&P::coded_marks>("must have a step of four counts or more, which tell one code from the next", [](const P& p) {
    return !p.coded_marks || p.coded_marks->step * p.increments_per_unit >= 4 * (1 - 1e-9);
  });
}

void describe(Description<EncoderState>& d) {
  using S = EncoderState;
  d.about("Memory of the measurement from one cycle to the next.");
  d.internal<&S::started>("A first sample was taken.");
  d.internal<&S::trusting>("The next sample is accepted at any distance.");
  d.internal<&S::word>(unit::count, "Last good sample.");
  d.internal<&S::count>(unit::count, "Last good sample, unwrapped.");
  d.internal<&S::missed>(unit::cycles, "Cycles since the last good sample.");
  d.internal<&S::velocity>(unit::u_s, "Filtered velocity.");
}

}  // namespace takt::axis
