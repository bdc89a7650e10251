// The engine: one machine, one cycle. Real time and virtual time differ only in who calls RunCycle.
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
  bool every_cycle = false;  // snapshots of every component in every cycle, whatever the machine's rates say
  bool drives = false;       // hand the set points of external drives to a queue (a reader must drain it)
  bool journal = false;      // journal entries and a state hash every cycle
  // Commands that may wait, besides those that let go. A stop behind a flood waits for this many, kCommandsPerCycle a
  // cycle.
  std::size_t command_queue = 256;
  std::size_t snapshot_queue = 1 << 14;
};

struct PartFaults;

class Engine {
 public:
  // `machine` must have been checked (LoadMachine).
  explicit Engine(Machine machine, const EngineOptions& options = {});
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  const Machine& machine() const;

  // --- one producing thread ---
  // Queues a command for the next cycle. Its ticket, or 0: the queue is full. For commands that let go (LetsGo) there
  // are places besides, some for each component and some for the whole machine: a flood of others does not keep them
  // out. Commands are applied in the order they were given, a few in each cycle; renewals overtake the others, so that
  // a lease does not run out in the queue.
  Ticket Submit(const Command& command) noexcept;
  // Takes a command out of a journal, which keeps its ticket (0: one that the engine gave itself). The next cycle
  // applies all of these, in the order given. False: more than a cycle ever writes into a journal.
  bool Resubmit(const Command& command) noexcept;

  // --- one thread that feeds in what external drives send ---
  // The next cycle takes the newest of each drive.
  SpscQueue<DriveSample>& drive_samples() noexcept;

  // --- the cycle thread ---
  void RunCycle(const CycleTiming& timing = {}) noexcept;
  // From RunCycle's thread, or while it does not run.
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
  // The tracks that a mover is to go along (planar::TrailOf).
  planar::Route mover_trail(std::size_t mover) const noexcept;
  // The places that a mover visits on its route over the free surface.
  RouteSnapshot mover_route(std::size_t mover) const noexcept;
  const part::Outputs& part_outputs(std::size_t part) const noexcept;
  const track::Tracks& tracks() const noexcept;
  const planar::GroupRegistry& grounds() const noexcept;
  // Those of the machine file and those made at run time; a table without pieces is none.
  std::span<const cam::Table> cams() const noexcept;
  // The same for components of any kind, by the number that is their target, less one.
  struct Published {
    const Type* type;
    const void* outputs;
  };
  std::size_t components() const noexcept;
  Published published(std::size_t component) const noexcept;
  const EngineFigures& figures() const noexcept;
  std::uint64_t StateHash() const noexcept;
  // What the motion of an axis is going to do, and what that of a command would if it were given now (AX-96). Nothing
  // changes; takes memory and time, so not between two cycles that have a deadline.
  axis::Forecast Foresee(std::size_t axis) const;
  axis::Forecast Foresee(std::size_t axis, const axis::Command& command) const;
  // Every axis at rest with its loop open, every mover disabled.
  bool all_disabled() const noexcept;
  bool at_rest() const noexcept;

  // What is broken in the simulated servo of an axis; for tests. Not part of a journal.
  plant::ServoFaults& faults(std::size_t axis) noexcept;
  PartFaults& part_faults(std::size_t part) noexcept;

  // --- any thread ---
  // Stops everything along its ramps, opens the loops; further commands are refused.
  void RequestShutdown() noexcept;
  // Counts what an external drive sent and nobody could use.
  void CountRefusedSample() noexcept;

  // --- one thread that answers groups and makes tracks (PathChecks) ---
  SpscQueue<group::PathCheckRequest>& questions() noexcept;
  // The next cycle takes it. False: there is no room; then nobody waits for it, either.
  bool Answer(std::size_t group, const group::PathChecked& answer) noexcept;
  // Whether plans of groups are made by MakePlans, which has to be called for them; else the cycle makes them itself.
  // Before the first cycle. A journal with such plans needs it, too.
  void PlanElsewhere() noexcept;
  // Makes the plans that groups ask for, and tells them in the next cycle.
  void MakePlans();
  // Makes the tracks and boundaries that the cycle asks for (track/build_queues.h), and tells it in the next cycle.
  void MakeTracks();
  // Builds the next cam that the cycle asks for (cam/builder.h) and returns the result, which Answer gives to it.
  std::optional<cam::BuildResult> BuildCam();
  void Answer(const cam::CamBuilt& result) noexcept;
  // Never changes.
  group::Fixed fixed(std::size_t group) const noexcept;

  // --- one consuming thread ---
  // For external drives, with EngineOptions::drives: those of cycle -1 (all off) from the start, then of every cycle.
  SpscQueue<DriveSetPoint>& set_points() noexcept;

  // --- one consuming thread ---
  SpscQueue<FeedbackEvent>& feedback() noexcept;
  // One for each kind of components (PublishedKinds).
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
