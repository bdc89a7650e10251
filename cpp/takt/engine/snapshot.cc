#include "takt/engine/snapshot.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::engine {

void Histogram::Add(std::uint64_t ns) noexcept {
  const auto bucket = static_cast<std::size_t>(std::bit_width(ns | 1) - 1);
  ++buckets[std::min(bucket, buckets.size() - 1)];
  ++count;
  max = std::max(max, ns);
}

double Histogram::Quantile(double share) const noexcept {
  const double wanted = std::clamp(share, 0.0, 1.0) * static_cast<double>(count);
  double below = 0;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    const double here = static_cast<double>(buckets[i]);
    if (here > 0 && below + here >= wanted) {
      const double largest = static_cast<double>(max);
      const double lower = i == 0 ? 0 : std::ldexp(1, static_cast<int>(i));
      const double upper =
          i + 1 == buckets.size() ? largest : std::min(std::ldexp(1, static_cast<int>(i) + 1), largest);
      return lower + (upper - lower) * (wanted - below) / here;
    }
    below += here;
  }
  return 0;
}

void describe(Description<Histogram>& d) {
  using H = Histogram;
  d.about("Histogram of times with buckets by powers of two.");
  d.internal<&H::buckets>(
      "Number of times in [2^i, 2^(i+1)) ns; bucket 0 also holds 0, the last bucket everything above.");
  d.internal<&H::count>("Number of times in all.");
  d.internal<&H::max>(unit::ns, "Longest time.");
}

void describe(Description<EngineFigures>& d) {
  using F = EngineFigures;
  d.about("Figures of the engine. All counts run from the start of the engine and never decrease.");
  d.internal<&F::cycle>("Cycle to which these figures belong, 0 for the first one after the start.");
  d.internal<&F::overruns>("Cycles that ended after the next one should have begun.");
  d.internal<&F::cycles_skipped>("Whole periods without a cycle because an earlier cycle was too late.");
  d.internal<&F::commands_applied>("Commands that the cycle has applied.");
  d.internal<&F::commands_refused>("Commands refused because the queue to the cycle was full.");
  d.internal<&F::snapshots_dropped>("States of components lost because their queue was full (a slow network or disk).");
  d.internal<&F::feedback_dropped>("Feedback events lost because their queue was full.");
  d.internal<&F::journal_dropped>(
      "Commands and hashes missing in the journal because their queue was full: it cannot be replayed.");
  d.internal<&F::set_points_dropped>("Set points for external drives that were lost because their queue was full.");
  d.internal<&F::samples_refused>("Messages of external drives that were wrong, too old or not requested.");
  d.internal<&F::planner_second_scale>("Motions that could be planned only at the second scale.");
  d.internal<&F::planner_failures>("Motions that could not be planned: the motion in progress was kept.");
  d.internal<&F::state_hash>("Hash of the whole state after the cycle; 0: not computed.");
  d.internal<&F::execution>("Execution times of the cycle; real time only.");
  d.internal<&F::latency>("Wake-up after the deadline; real time only.");
}

}  // namespace takt::engine
