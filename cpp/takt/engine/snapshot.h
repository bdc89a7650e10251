// Data that the cycle hands to other threads: small copies through bounded queues.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <tuple>

#include "takt/axis/outputs.h"
#include "takt/conveyor/outputs.h"
#include "takt/conveyor/pose.h"
#include "takt/conveyor/state.h"
#include "takt/core/describe_fwd.h"
#include "takt/engine/command.h"
#include "takt/environment/outputs.h"
#include "takt/flexcam/outputs.h"
#include "takt/group/outputs.h"
#include "takt/mover/outputs.h"
#include "takt/mover/route.h"
#include "takt/part/outputs.h"
#include "takt/pickplace/outputs.h"
#include "takt/planar/network.h"
#include "takt/planargroup/outputs.h"
#include "takt/track/outputs.h"

namespace takt::engine {

// The outputs that each kind of component publishes, in the order of ComponentKinds().
using PublishedKinds = std::tuple<axis::Outputs, flexcam::Outputs, group::Outputs, conveyor::Outputs,
                                  conveyor::PoseOutputs, pickplace::Outputs, mover::Outputs, track::Outputs,
                                  planargroup::Outputs, environment::Outputs, part::Outputs>;

// The outputs of one component after a cycle.
template <typename Outputs>
struct SnapshotOf {
  std::uint64_t cycle = 0;
  std::uint32_t index = 0;  // within its kind, in the order of the machine file
  bool due = true;          // due at the rate of its channel; false only with EngineOptions::every_cycle
  Outputs outputs;
};
using AxisSnapshot = SnapshotOf<axis::Outputs>;
using FlexCamSnapshot = SnapshotOf<flexcam::Outputs>;
using GroupSnapshot = SnapshotOf<group::Outputs>;
using BeltSnapshot = SnapshotOf<conveyor::Outputs>;
using PoseSnapshot = SnapshotOf<conveyor::PoseOutputs>;
using PickPlaceSnapshot = SnapshotOf<pickplace::Outputs>;
using MoverSnapshot = SnapshotOf<mover::Outputs>;
using TrackSnapshot = SnapshotOf<track::Outputs>;
using PlanarGroupSnapshot = SnapshotOf<planargroup::Outputs>;
using EnvironmentSnapshot = SnapshotOf<environment::Outputs>;
using PartSnapshot = SnapshotOf<part::Outputs>;

// The objects on a belt, at the rate of its channel.
struct ObjectsSnapshot {
  std::uint64_t cycle = 0;
  std::uint32_t index = 0;  // of the belt
  conveyor::State state;
};

// The tracks that a mover has yet to travel.
struct TrailSnapshot {
  std::uint64_t cycle = 0;
  std::uint32_t index = 0;  // of the mover
  planar::Route trail;
};

// The positions that a mover on a route over the free surface visits.
struct RouteSnapshot {
  std::uint64_t cycle = 0;
  std::uint32_t index = 0;              // of the mover
  std::uint32_t coordinate_system = 0;  // of the positions, from 1; 0: the machine has no parts
  std::uint64_t first = 0;              // number of the first visit
  std::uint32_t count = 0;              // 0: the mover is not on a route
  std::array<planar::Place, mover::kMostKept + mover::kMostVisits> places{};

  std::span<const planar::Place> all() const noexcept { return {places.data(), count}; }
};

struct JournalEntry {  // a command as it was applied
  std::uint64_t cycle = 0;
  Command command;
};

struct HashEntry {
  std::uint64_t cycle = 0;  // after this cycle ...
  std::uint64_t hash = 0;   // ... the whole state had this hash
};

// Counts of nanoseconds by powers of two: bucket i holds values in [2^i, 2^(i+1)); bucket 0 also 0.
struct Histogram {
  std::array<std::uint64_t, 32> buckets{};
  std::uint64_t count = 0;
  std::uint64_t max = 0;

  void Add(std::uint64_t ns) noexcept;
  // Returns the value below which the given share (0..1) of all values lies, interpolated within its bucket.
  double Quantile(double share) const noexcept;
};

// Measurements of the scheduler; all 0 in virtual time except now_ns.
struct CycleTiming {
  // Of the previous cycle:
  std::uint64_t latency_ns = 0;    // wake-up after the deadline
  std::uint64_t execution_ns = 0;  // of the whole cycle
  bool overrun = false;            // it ended after the next deadline
  // Of this cycle:
  std::uint64_t late_periods = 0;  // whole periods by which it begins later than the previous cycle implies
  std::int64_t now_ns = 0;         // its begin on the monotonic clock; 0: unknown, no command expires
};

struct EngineFigures {
  std::uint64_t cycle = 0;
  std::uint64_t overruns = 0;
  std::uint64_t cycles_skipped = 0;  // whole periods that passed without a cycle
  std::uint64_t commands_applied = 0;
  std::uint64_t commands_refused = 0;   // queue full
  std::uint64_t snapshots_dropped = 0;  // because of a slow reader
  std::uint64_t feedback_dropped = 0;
  // commands or hashes dropped because of a slow reader of the journal: it cannot be replayed
  std::uint64_t journal_dropped = 0;
  std::uint64_t set_points_dropped = 0;  // of external drives: because of a slow reader
  std::uint64_t samples_refused = 0;     // from external drives, of no use
  std::uint64_t planner_second_scale = 0;
  std::uint64_t planner_failures = 0;
  std::uint64_t state_hash = 0;  // 0 unless hashing is on
  Histogram execution;
  Histogram latency;
};

void describe(Description<Histogram>&);
void describe(Description<EngineFigures>&);

}  // namespace takt::engine
