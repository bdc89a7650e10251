// The engine: one machine, one cycle. Real time and virtual time differ only in what calls RunCycle.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "takt/axis/forecast.h"
#include "takt/cam/builder.h"
#include "takt/cam/table.h"
#include "takt/conveyor/outputs.h"
#include "takt/conveyor/pose.h"
#include "takt/core/cycle.h"
#include "takt/core/spsc_queue.h"
#include "takt/engine/command.h"
#include "takt/engine/drives.h"
#include "takt/engine/machine.h"
#include "takt/engine/snapshot.h"
#include "takt/engine/track_shapes.h"
#include "takt/environment/environments.h"
#include "takt/flexcam/outputs.h"
#include "takt/group/outputs.h"
#include "takt/group/path_check_request.h"
#include "takt/group/survey.h"
#include "takt/mover/outputs.h"
#include "takt/mover/state.h"
#include "takt/part/outputs.h"
#include "takt/pickplace/outputs.h"
#include "takt/planar/track.h"
#include "takt/track/tracks.h"

namespace takt::engine {

struct EngineOptions {
  bool publish = false;      // hand snapshots and figures to the queues (a reader must drain them)
  bool every_cycle = false;  // snapshots of every component in every cycle, regardless of the machine's rates
  bool drives = false;       // hand the set points of external drives to a queue (a reader must drain it)
  bool journal = false;      // journal entries and a state hash every cycle
  // Capacity for waiting commands, in addition to those for which LetsGo() is true. A stop behind a full queue waits
  // for this many commands, at kCommandsPerCycle a cycle.
  std::size_t command_queue = 256;
  std::size_t snapshot_queue = 1 << 14;
};

struct PartFaults;

class Engine {
 public:
  // Requires: `machine` has been checked (LoadMachine).
  explicit Engine(Machine machine, const EngineOptions& options = {});
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  const Machine& machine() const;

  // --- one producing thread ---
  // Queues a command for the next cycle. Returns its ticket, or 0 if the queue is full. Commands for which LetsGo() is
  // true have reserved entries, some for each component and some for the whole machine, so that a flood of other
  // commands does not keep them out. Commands are applied in the order given, a few in each cycle; renewals overtake
  // the others, so that a lease does not expire in the queue.
  Ticket Submit(const Command& command) noexcept;
  // Queues a command from a journal, which keeps its ticket (0: given by the engine itself). The next cycle applies all
  // of these, in the order given. Returns false if there are more than one cycle ever writes into a journal.
  bool Resubmit(const Command& command) noexcept;

  // --- one thread that feeds in the samples of external drives ---
  // The next cycle takes the newest sample of each drive.
  SpscQueue<DriveSample>& drive_samples() noexcept;

  // --- the cycle thread ---
  void RunCycle(const CycleTiming& timing = {}) noexcept;
  // Call from RunCycle's thread, or while it does not run.
  const Cycle& cycle() const noexcept;
  const axis::Outputs& outputs(std::size_t axis) const noexcept;
  const flexcam::Outputs& flex_cam_outputs(std::size_t module) const noexcept;
  const group::Outputs& group_outputs(std::size_t group) const noexcept;
  const conveyor::Outputs& belt_outputs(std::size_t belt) const noexcept;
  const conveyor::PoseOutputs& pose_outputs(std::size_t pose) const noexcept;
  const conveyor::State& belt_state(std::size_t belt) const noexcept;
  const pickplace::Outputs& pick_place_outputs(std::size_t module) const noexcept;
  const mover::Outputs& mover_outputs(std::size_t mover) const noexcept;
  const mover::State& mover_state(std::size_t mover) const noexcept;
  // Returns the tracks that a mover has yet to travel (planar::RemainingTracks).
  planar::Route mover_trail(std::size_t mover) const noexcept;
  // Returns the positions that a mover visits on its route over the free surface.
  RouteSnapshot mover_route(std::size_t mover) const noexcept;
  const part::Outputs& part_outputs(std::size_t part) const noexcept;
  const track::Tracks& tracks() const noexcept;
  const planar::GroupRegistry& grounds() const noexcept;
  // Cams of the machine file and those made at run time; a table without pieces is an unused entry.
  std::span<const cam::Table> cams() const noexcept;
  // The outputs of a component of any kind, by its number: its target less one.
  struct Published {
    const Type* type;
    const void* outputs;
  };
  std::size_t components() const noexcept;
  Published published(std::size_t component) const noexcept;
  const EngineFigures& figures() const noexcept;
  std::uint64_t StateHash() const noexcept;
  // Forecasts the motion of an axis, and the motion that a command would cause if it were given now (AX-96). Changes
  // nothing; allocates and takes time, so do not call it between two cycles that have a deadline.
  axis::Forecast Foresee(std::size_t axis) const;
  axis::Forecast Foresee(std::size_t axis, const axis::Command& command) const;
  // Returns true if every axis is disabled with its loop open and every mover is disabled.
  bool all_disabled() const noexcept;
  bool at_rest() const noexcept;

  // Faults to inject into the simulated servo of an axis; for tests. Not recorded in a journal.
  plant::ServoFaults& faults(std::size_t axis) noexcept;
  PartFaults& part_faults(std::size_t part) noexcept;

  // --- any thread ---
  // Stops everything along its ramps and opens the loops; further commands are refused.
  void RequestShutdown() noexcept;
  // Counts a sample of an external drive that was refused before it reached the cycle.
  void CountRefusedSample() noexcept;

  // --- one thread that answers groups and builds tracks and cams (PathChecks) ---
  SpscQueue<group::PathCheckRequest>& questions() noexcept;
  // The next cycle takes the answer. Returns false if there is no room; the group no longer waits for it then.
  bool Answer(std::size_t group, const group::PathChecked& answer) noexcept;
  // From now on MakePlans makes the plans of groups, and must be called for them; otherwise the cycle makes them
  // itself. Call before the first cycle. A journal with PathPlanned commands requires it, too.
  void PlanElsewhere() noexcept;
  // Makes the plans that groups request; the next cycle receives them.
  void MakePlans();
  // Builds the tracks and boundaries that the cycle requests (track/build_queues.h); the next cycle receives them.
  void MakeTracks();
  // Builds the next cam that the cycle requests (cam/builder.h) and returns the result, to be passed to Answer; nothing
  // if no request waits.
  std::optional<cam::BuildResult> BuildCam();
  void Answer(const cam::CamBuilt& result) noexcept;
  // Constant over the life of the engine.
  group::Fixed fixed(std::size_t group) const noexcept;

  // --- one consuming thread ---
  // For external drives, with EngineOptions::drives: the set points of cycle -1 (all off) at the start, then those of
  // every cycle.
  SpscQueue<DriveSetPoint>& set_points() noexcept;

  // --- one consuming thread ---
  SpscQueue<FeedbackEvent>& feedback() noexcept;
  // One queue for each kind of component (PublishedKinds).
  template <typename Outputs = axis::Outputs>
  SpscQueue<SnapshotOf<Outputs>>& snapshots() noexcept;
  SpscQueue<ObjectsSnapshot>& belt_objects() noexcept;
  SpscQueue<TrackPlaces>& track_places() noexcept;
  SpscQueue<TrailSnapshot>& mover_trails() noexcept;
  SpscQueue<RouteSnapshot>& mover_routes() noexcept;
  SpscQueue<cam::CamPiece>& cam_pieces() noexcept;
  SpscQueue<EngineFigures>& figure_queue() noexcept;
  SpscQueue<JournalEntry>& journal() noexcept;
  SpscQueue<DriveEntry>& drive_journal() noexcept;
  SpscQueue<HashEntry>& hashes() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace takt::engine
