#include "takt/flexcam/bounds.h"

#include <cmath>
#include <numeric>

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

// About 0.05 µs each; ten times as much if a piece exceeds the extreme values so far.
constexpr int kPiecesPerCycle = 4;

// Pieces are visited in strides all over the cam: the large values are found early, and most of the remaining pieces
// are quickly seen not to exceed them.
std::size_t LeapOf(std::size_t pieces) {
  std::size_t leap = std::max<std::size_t>(1, pieces * 5 / 8);
  while (std::gcd(leap, pieces) != 1) ++leap;
  return leap;
}

}  // namespace

void WorkOut(const BoundsOf& of, std::span<const cam::Table> cams, BoundsState& s) noexcept {
  if (!(of == s.of)) {
    s = {};
    s.of = of;
    s.max_position = -HUGE_VAL;
    s.min_position = HUGE_VAL;
  }
  for (int i = 0; i < kPiecesPerCycle && !s.valid; ++i) {
    if (s.cam >= of.count) {
      s.valid = of.count > 0;
      return;
    }
    const cam::Table& table = cams[of.cams[s.cam]];
    cam::SlavePeaks peaks;
    peaks.position = {{0, s.min_position}, {0, s.max_position}};
    peaks.velocity.value = s.max_velocity;
    peaks.acceleration.value = s.max_acceleration;
    if (s.leap == 0) s.leap = static_cast<std::uint32_t>(LeapOf(table.size()));
    const std::size_t piece = std::size_t{s.piece} * s.leap % table.size();
    cam::Include(table, piece, of.velocity, of.acceleration, peaks);
    s.max_position = peaks.position.greatest.value;
    s.min_position = peaks.position.least.value;
    s.max_velocity = peaks.velocity.value;
    s.max_acceleration = peaks.acceleration.value;
    if (++s.piece == table.size()) {
      s.piece = s.leap = 0;
      ++s.cam;
    }
  }
}

void describe(Description<BoundsOf>& d) {
  using B = BoundsOf;
  d.about("Parameters of the extreme values.");
  d.internal<&B::cams>("Indices of the cams, from 0.");
  d.internal<&B::count>("Number of cams.");
  d.internal<&B::velocity>("Velocity of X.");
  d.internal<&B::acceleration>("Acceleration of X.");
}

void describe(Description<BoundsState>& d) {
  using B = BoundsState;
  d.about("Extreme values of a slave.");
  d.internal<&B::of>("Parameters for which they are computed.");
  d.internal<&B::cam>("Cam that is being evaluated.");
  d.internal<&B::piece>("Number of its pieces that are done.");
  d.internal<&B::leap>("Stride from one piece to the next; 0: not yet known.");
  d.internal<&B::valid>("The evaluation is complete.");
  d.internal<&B::max_position>("Largest position of Y.");
  d.internal<&B::min_position>("Smallest position of Y.");
  d.internal<&B::max_velocity>("Largest velocity of Y.");
  d.internal<&B::max_acceleration>("Largest acceleration of Y.");
}

}  // namespace takt::flexcam
