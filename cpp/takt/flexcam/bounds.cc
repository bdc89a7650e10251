#include "takt/flexcam/bounds.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

// Some 0.3 µs each.
constexpr int kPiecesPerCycle = 4;

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
    cam::Include(table, s.piece, of.velocity, of.acceleration, peaks);
    s.max_position = std::max(s.max_position, peaks.position.greatest.value);
    s.min_position = std::min(s.min_position, peaks.position.least.value);
    s.max_velocity = std::max(s.max_velocity, peaks.velocity.value);
    s.max_acceleration = std::max(s.max_acceleration, peaks.acceleration.value);
    if (++s.piece == table.size()) {
      s.piece = 0;
      ++s.cam;
    }
  }
}

void describe(Description<BoundsOf>& d) {
  using B = BoundsOf;
  d.about("For what extreme values are worked out.");
  d.internal<&B::cams>("Numbers of the cams, from 0.");
  d.internal<&B::count>("How many they are.");
  d.internal<&B::velocity>("Of X.");
  d.internal<&B::acceleration>("Of X.");
}

void describe(Description<BoundsState>& d) {
  using B = BoundsState;
  d.about("Extreme values of a slave.");
  d.internal<&B::of>("For what they are.");
  d.internal<&B::cam>("At which cam the work is.");
  d.internal<&B::piece>("At which of its pieces.");
  d.internal<&B::valid>("The work is done.");
  d.internal<&B::max_position>("Of Y.");
  d.internal<&B::min_position>("Of Y.");
  d.internal<&B::max_velocity>("Of Y.");
  d.internal<&B::max_acceleration>("Of Y.");
}

}  // namespace takt::flexcam
