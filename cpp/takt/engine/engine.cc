#include "takt/engine/engine.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "takt/core/describe.h"
#include "takt/engine/components.h"
#include "takt/engine/cycle.h"

namespace takt::engine {

namespace {

// Lists of objects that may wait for each belt: they are large.
constexpr std::size_t kObjectLists = 64;
// Routes over the free surface that a cycle publishes: they are large.
constexpr std::size_t kRoutesPerCycle = 8;

// Returns the number of cycles between two publications at this rate; 0: never.
std::uint64_t Divisor(double rate_hz, double period_s) {
  if (rate_hz <= 0) return 0;
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(1 / (rate_hz * period_s))));
}

// Its multiples are distributed evenly, whatever subset of them is used.
constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15;  // times 2^64

// Reserved entries of the command queue for commands with LetsGo(): for each component (EN-32) ...
constexpr std::size_t kKeptPerComponent = 2;
// ... and for commands that stop the whole machine.
constexpr std::size_t kKeptForAll = 16;
// Answers to groups that one cycle takes.
constexpr std::size_t kAnswersPerCycle = 16;
// Maximum number of commands that a cycle writes into a journal: those of the queues, one for overruns and one for
// shutdown.
constexpr std::size_t kJournalledPerCycle = kCommandsPerCycle + kRenewalsPerCycle + kAnswersPerCycle + 2;

// Cycles that may pass before the set points for external drives are fetched; and maximum number of samples of a drive
// that one cycle takes.
constexpr std::size_t kDriveQueue = 16;

bool IsTrackMade(const Command& command) {
  const auto* track = std::get_if<track::Command>(&command.body);
  return track && std::holds_alternative<track::TrackMade>(*track);
}

bool IsBoundaryMade(const Command& command) {
  const auto* environment = std::get_if<environment::Command>(&command.body);
  return environment && std::holds_alternative<environment::BoundaryMade>(*environment);
}

bool IsCamBuilt(const Command& command) {
  const auto* machine = std::get_if<MachineCommand>(&command.body);
  return machine && std::holds_alternative<cam::CamBuilt>(*machine);
}

// Returns true if the command stops the whole machine.
bool StopsAll(const Command& command) {
  const auto* machine = std::get_if<MachineCommand>(&command.body);
  return machine && !std::holds_alternative<Release>(*machine) && LetsGo(command);
}

bool IsRenewal(const Command& command) {
  const auto* machine = std::get_if<MachineCommand>(&command.body);
  return machine && std::holds_alternative<Renew>(*machine);
}

}  // namespace

// The published states of the components of a kind.
template <typename Outputs>
struct OfKind {
  template <typename Params>
  OfKind(const Machine& m, const EngineOptions& options, const std::vector<Params>& components,
         const std::vector<Outputs>& of_world)
      : queue(options.publish && !components.empty() ? options.snapshot_queue : 2), outputs(of_world) {
    for (const Params& component : components) {
      double rate = m.lcm.axis_rate_hz;
      for (const ChannelRate& own : m.lcm.rates) {
        if (own.axis == component.name) rate = own.rate_hz;
      }
      divisors.push_back(Divisor(rate, m.cycle.period_s));
    }
  }

  SpscQueue<SnapshotOf<Outputs>> queue;
  const std::vector<Outputs>& outputs;
  std::vector<std::uint64_t> divisors;  // period in cycles; 0: never
};

struct Engine::Impl {
  Impl(Machine m, const EngineOptions& o)
      : machine(std::move(m)),
        options(o),
        world(machine),
        kept(kKeptPerComponent * (FirstNumbers(machine).back() + 1)),
        commands(o.command_queue + kept + kKeptForAll),
        renewals(kRenewalsPerCycle * 4),
        answers(4 * kAnswersPerCycle + 4 * machine.groups.size()),
        journalled(kJournalledPerCycle),
        feedback(4 * world.feedback_storage.size()),
        axes(machine, o, machine.axes, world.axis_outputs),
        flex_cams(machine, o, machine.flex_cams, world.flex_cam_outputs),
        groups(machine, o, machine.groups, world.group_outputs),
        belts(machine, o, machine.belts, world.belt_outputs),
        poses(machine, o, machine.poses, world.pose_outputs),
        belt_objects(o.publish ? kObjectLists * machine.belts.size() : 2),
        mover_trails(o.publish ? 64 + 2 * machine.movers.size() : 2),
        trails(machine.movers.size()),
        mover_routes(o.publish && !machine.movers.empty() ? 4 * kRoutesPerCycle : 2),
        routes(machine.movers.size()),
        pick_places(machine, o, machine.pick_and_place, world.pick_place_outputs),
        movers(machine, o, machine.movers, world.mover_outputs),
        tracks(machine, o, machine.tracks, world.tracks.outputs),
        track_places(o.publish ? 64 + 2 * machine.tracks.size() : 2),
        track_shapes(machine.tracks.size()),
        planar_groups(machine, o, machine.planar_groups, world.planar_groups.outputs),
        environments(machine, o, machine.environments, world.environments.outputs),
        parts(machine, o, machine.parts, world.part_outputs),
        figure_queue(16),
        journal(o.journal ? o.snapshot_queue : 2),
        hashes(o.journal ? o.snapshot_queue : 2),
        set_points(o.drives ? kDriveQueue * world.drives.size() : 2),
        drive_samples(kDriveQueue * world.drives.size()),
        drive_journal(o.journal && !world.drives.empty() ? o.snapshot_queue : 2),
        figures_divisor(Divisor(machine.lcm.engine_rate_hz, machine.cycle.period_s)) {
    PublishFirst();
    SendSetPoints(-1);
    LetsGo(Command{});  // its first call allocates
  }

  // Before the first cycle, readers find the outputs of an idle cycle: values at rest, not zeros.
  void PublishFirst() {
    World idle(machine);
    Sense(idle);
    Move(idle);
    Control(idle);
    world.axis_outputs = idle.axis_outputs;
    world.flex_cam_outputs = idle.flex_cam_outputs;
    world.group_outputs = idle.group_outputs;
    world.belt_outputs = idle.belt_outputs;
    world.pose_outputs = idle.pose_outputs;
    world.pick_place_outputs = idle.pick_place_outputs;
    world.mover_outputs = idle.mover_outputs;
    world.tracks.outputs = idle.tracks.outputs;
    world.planar_groups.outputs = idle.planar_groups.outputs;
    world.environments.outputs = idle.environments.outputs;
    world.part_outputs = idle.part_outputs;
  }

  // Queues an answer for a component, by its index within its kind.
  bool GiveAnswer(std::size_t index, const CommandBody& answer) noexcept {
    const auto target = static_cast<std::uint32_t>(world.first_of[answer.index() - 1] + index + 1);
    return answers.TryPush({0, target, 0, answer});
  }

  void SendSetPoints(std::int64_t cycle) noexcept {
    if (!options.drives) return;
    for (const HeardDrive& drive : world.drives) {
      if (!set_points.TryPush({cycle, drive.axis, world.servo_outputs[drive.axis]})) ++figures.set_points_dropped;
    }
  }

  void TakeSamples() noexcept {
    DriveSample sample;
    for (std::size_t i = 0; i < drive_samples.capacity() && drive_samples.TryPop(sample); ++i) {
      if (!Take(world, sample)) {
        ++samples_unused;
      } else if (options.journal && !drive_journal.TryPush({world.cycle.count, sample})) {
        ++figures.journal_dropped;
      }
    }
  }

  void TakeTiming(const CycleTiming& timing) noexcept {
    if (timing.execution_ns > 0) figures.execution.Add(timing.execution_ns);
    if (timing.latency_ns > 0 || timing.execution_ns > 0) figures.latency.Add(timing.latency_ns);
    figures.overruns += timing.overrun ? 1 : 0;
    figures.cycles_skipped += timing.late_periods;
    now_ns = timing.now_ns;
    // A cycle that ends late counts as one period, however small the delay; a stall counts its whole periods (EN-34).
    const bool late = timing.overrun || timing.late_periods > 0;
    late_periods = late ? late_periods + std::max<std::uint64_t>(1, timing.late_periods) : 0;
    const std::uint32_t allowed = machine.cycle.overruns_in_a_row;
    if (allowed > 0 && late_periods >= allowed) {
      late_periods = 0;
      ApplyOne({0, kMachineTarget, 0, MachineCommand(FailAllAxes{})});
    }
  }

  void ApplyOne(const Command& command) noexcept {
    Apply(world, command);
    ++figures.commands_applied;
    if (options.journal && !journal.TryPush({world.cycle.count, command})) ++figures.journal_dropped;
  }

  void ApplyCommands() noexcept {
    if (shutdown.load(std::memory_order_relaxed) && !shutting_down) {
      shutting_down = true;
      const std::size_t before = world.feedback.events().size();
      ApplyOne({0, kMachineTarget, 0, MachineCommand(StopAll{.open_loops = true})});
      for (std::size_t i = before; i < world.feedback.events().size(); ++i) {
        FeedbackEvent& event = world.feedback_storage[i];
        if (event.state == FeedbackState::kAborted) event.error = ErrorId::kShutdown;
      }
    }
    ApplyFrom(journalled, journalled.capacity());
    ApplyFrom(answers, kAnswersPerCycle);
    ApplyFrom(renewals, kRenewalsPerCycle);
    ApplyFrom(commands, kCommandsPerCycle);
  }

  void ApplyFrom(SpscQueue<Command>& queue, std::size_t at_most) noexcept {
    for (std::size_t i = 0; i < at_most && queue.TryPop(taken); ++i) Admit(taken);
  }

  void Admit(const Command& command) noexcept {
    if (shutting_down) {
      world.feedback.Report({command.ticket, world.cycle.count, FeedbackState::kError, false, ErrorId::kShutdown, 0});
    } else if (command.expires_ns != 0 && now_ns > command.expires_ns && !LetsGo(command)) {
      world.feedback.Report({command.ticket, world.cycle.count, FeedbackState::kError, false, ErrorId::kTooOld, 0});
    } else {
      ApplyOne(command);
    }
  }

  // Called by the producing thread.
  bool Queue(const Command& command) noexcept {
    if (IsRenewal(command)) return renewals.TryPush(command);
    const std::size_t waiting = commands.size();
    const bool room = waiting < options.command_queue || (waiting < options.command_queue + kept && LetsGo(command)) ||
                      StopsAll(command);
    return room && commands.TryPush(command);
  }

  // All kinds of components, in the order of their numbers.
  auto kinds() noexcept {
    return std::tie(axes, flex_cams, groups, belts, poses, pick_places, movers, tracks, planar_groups, environments,
                    parts);
  }

  template <typename Outputs>
  void PublishAll(OfKind<Outputs>& kind) noexcept {
    const std::size_t count = kind.divisors.size();
    if (count == 0) return;
    // The last components are those that a full queue or buffer drops: the first one varies from cycle to cycle, at any
    // rate.
    std::size_t i = ((world.cycle.count * kGoldenRatio) >> 32) % count;
    for (std::size_t k = 0; k < count; ++k, i = i + 1 < count ? i + 1 : 0) {
      // All components of a rate in the same cycle, so that a receiver can compare them.
      const bool due = kind.divisors[i] != 0 && world.cycle.count % kind.divisors[i] == 0;
      if (!due && !options.every_cycle) continue;
      if (!kind.queue.TryPush({world.cycle.count, static_cast<std::uint32_t>(i), due, kind.outputs[i]}))
        ++figures.snapshots_dropped;
    }
  }

  void PublishObjects() noexcept {
    for (std::uint32_t i = 0; i < belts.divisors.size(); ++i) {
      if (belts.divisors[i] == 0 || world.cycle.count % belts.divisors[i] != 0) continue;
      if (!belt_objects.TryPush({world.cycle.count, i, world.belt_states[i]})) ++figures.snapshots_dropped;
    }
  }

  // Publishes a trail with the state of its mover when it has changed, and periodically for later subscribers.
  void PublishTrails() noexcept {
    const auto repeat = static_cast<std::uint64_t>(1 / machine.cycle.period_s);  // 1 s
    for (std::uint32_t i = 0; i < movers.divisors.size(); ++i) {
      if (movers.divisors[i] == 0 || world.cycle.count % movers.divisors[i] != 0) continue;
      const planar::Route trail = planar::RemainingTracks(world.streets.riders[i]);
      Said& said = trails[i];
      if (trail == said.trail && (trail.count == 0 || world.cycle.count - said.cycle < repeat)) continue;
      if (mover_trails.TryPush({world.cycle.count, i, trail})) {
        said = {trail, world.cycle.count};
      } else {
        ++figures.snapshots_dropped;
      }
    }
  }

  RouteSnapshot RouteOf(std::uint32_t mover) const noexcept {
    RouteSnapshot out{.cycle = world.cycle.count, .index = mover};
    if (!mover::IsOnRoute(world.mover_states[mover])) return out;
    const mover::SurfaceRoute& route = world.routes.of[mover];
    out.coordinate_system = world.streets.parts->none() ? 0 : route.system + 1;
    out.first = route.begin;
    for (std::uint64_t k = route.begin; k <= route.last() && out.count < out.places.size(); ++k) {
      out.places[out.count++] = {route.visits[k].x, route.visits[k].y};
    }
    return out;
  }

  // Publishes each route soon after it has changed, at most kRoutesPerCycle in a cycle, and again every second for
  // later subscribers.
  void PublishRoutes() noexcept {
    const auto repeat = static_cast<std::uint64_t>(1 / machine.cycle.period_s);  // 1 s
    const auto count = static_cast<std::uint32_t>(movers.divisors.size());
    std::size_t told = 0;
    for (std::uint32_t k = 0, i = next_route; k < count && told < kRoutesPerCycle; ++k, i = i + 1 < count ? i + 1 : 0) {
      if (movers.divisors[i] == 0) continue;
      const mover::SurfaceRoute& route = world.routes.of[i];
      SaidRoute now{.on = mover::IsOnRoute(world.mover_states[i]), .cycle = world.cycle.count};
      if (now.on) now = {now.on, route.started, route.begin, route.last(), now.cycle};
      SaidRoute& said = routes[i];
      if (now.IsLike(said) && (!now.on || now.cycle - said.cycle < repeat)) continue;
      next_route = i;
      if (!mover_routes.TryPush(RouteOf(i))) return;
      said = now;
      ++told;
    }
  }

  void Publish() noexcept {
    figures.cycle = world.cycle.count;
    figures.commands_refused = refused.load(std::memory_order_relaxed);
    figures.samples_refused = samples_unused + samples_refused.load(std::memory_order_relaxed);
    figures.planner_second_scale = world.planner.counters().second_scale;
    figures.planner_failures = world.planner.counters().failures;
    for (const FeedbackEvent& event : world.feedback.events()) {
      if (!feedback.TryPush(event)) ++feedback_dropped;
    }
    figures.feedback_dropped = feedback_dropped + world.feedback.lost();
    world.feedback.Clear();
    if (options.journal) {
      figures.state_hash = world.StateHash();
      if (!hashes.TryPush({world.cycle.count, figures.state_hash})) ++figures.journal_dropped;
    }
    if (!options.publish) return;
    std::apply([this](auto&... kind) { (PublishAll(kind), ...); }, kinds());
    PublishObjects();
    PublishTrails();
    PublishRoutes();
    track_shapes.Publish(world.cycle.count, world.tracks, track_places);
    if (figures_divisor > 0 && world.cycle.count % figures_divisor == 0) figure_queue.TryPush(figures);
  }

  const Machine machine;
  const EngineOptions options;
  World world;
  EngineFigures figures;

  const std::size_t kept;  // reserved entries of the queue for commands with LetsGo()
  SpscQueue<Command> commands;
  SpscQueue<Command> renewals;
  SpscQueue<Command> answers;
  SpscQueue<Command> journalled;
  SpscQueue<FeedbackEvent> feedback;
  OfKind<axis::Outputs> axes;
  OfKind<flexcam::Outputs> flex_cams;
  OfKind<group::Outputs> groups;
  OfKind<conveyor::Outputs> belts;
  OfKind<conveyor::PoseOutputs> poses;
  SpscQueue<ObjectsSnapshot> belt_objects;
  SpscQueue<TrailSnapshot> mover_trails;
  struct Said {
    planar::Route trail;
    std::uint64_t cycle = 0;
  };
  std::vector<Said> trails;  // by mover, as last published
  SpscQueue<RouteSnapshot> mover_routes;
  struct SaidRoute {
    bool on = false;
    std::uint64_t started = 0, begin = 0, last = 0;  // of SurfaceRoute
    std::uint64_t cycle = 0;
    bool IsLike(const SaidRoute& other) const noexcept {
      return on == other.on && started == other.started && begin == other.begin && last == other.last;
    }
  };
  std::vector<SaidRoute> routes;  // by mover, as last published
  std::uint32_t next_route = 0;   // the mover that is checked first
  OfKind<pickplace::Outputs> pick_places;
  OfKind<mover::Outputs> movers;
  OfKind<track::Outputs> tracks;
  SpscQueue<TrackPlaces> track_places;
  TrackShapes track_shapes;
  OfKind<planargroup::Outputs> planar_groups;
  OfKind<environment::Outputs> environments;
  OfKind<part::Outputs> parts;
  SpscQueue<EngineFigures> figure_queue;
  SpscQueue<JournalEntry> journal;
  SpscQueue<HashEntry> hashes;
  SpscQueue<DriveSetPoint> set_points;
  SpscQueue<DriveSample> drive_samples;
  SpscQueue<DriveEntry> drive_journal;

  Command taken;  // by the cycle from a queue; made once, as it is large

  std::uint64_t figures_divisor;
  std::uint64_t feedback_dropped = 0;  // by the queue
  std::uint64_t samples_unused = 0;    // by the cycle
  std::uint64_t late_periods = 0;      // since the last cycle in time
  std::int64_t now_ns = 0;             // of CycleTiming
  bool shutting_down = false;
  std::atomic<bool> shutdown{false};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<std::uint64_t> samples_refused{0};  // before they reached the cycle
  Ticket next_ticket = 1;                         // of the producing thread
};

Engine::Engine(Machine machine, const EngineOptions& options)
    : impl_(std::make_unique<Impl>(std::move(machine), options)) {}
Engine::~Engine() = default;

const Machine& Engine::machine() const {
  return impl_->machine;
}

Ticket Engine::Submit(const Command& command) noexcept {
  Command numbered = command;
  numbered.ticket = impl_->next_ticket;
  if (!impl_->Queue(numbered)) {
    impl_->refused.fetch_add(1, std::memory_order_relaxed);
    return 0;
  }
  return impl_->next_ticket++;
}

bool Engine::Resubmit(const Command& command) noexcept {
  impl_->next_ticket = std::max(impl_->next_ticket, command.ticket + 1);
  if (IsTrackMade(command)) track::Make(impl_->world.tracks.desk);  // the journal has its result
  if (IsBoundaryMade(command)) environment::Make(impl_->world.environments.desk);
  if (IsCamBuilt(command)) BuildCam();
  return impl_->journalled.TryPush(command);
}

SpscQueue<group::PathCheckRequest>& Engine::questions() noexcept {
  return impl_->world.questions;
}

bool Engine::Answer(std::size_t group, const group::PathChecked& answer) noexcept {
  return impl_->GiveAnswer(group, group::Command(answer));
}

void Engine::PlanElsewhere() noexcept {
  impl_->world.plans_elsewhere = true;
}

void Engine::MakePlans() {
  for (std::size_t i = 0; i < impl_->world.look_aheads.size(); ++i) {
    if (const auto number = impl_->world.look_aheads[i].timing.MakePlan()) {
      const bool told = impl_->GiveAnswer(i, group::Command(group::PathPlanned{*number}));
      if (!told) impl_->world.look_aheads[i].timing.RepeatPlan();
    }
  }
}

void Engine::MakeTracks() {
  while (const std::optional<track::BuiltTrack> answer = track::Make(impl_->world.tracks.desk)) {
    impl_->GiveAnswer(answer->track, track::Command(answer->made));
  }
  while (const std::optional<environment::BuiltBoundary> answer = environment::Make(impl_->world.environments.desk)) {
    impl_->GiveAnswer(answer->environment, environment::Command(answer->made));
  }
}

std::optional<cam::BuildResult> Engine::BuildCam() {
  return cam::BuildNext(impl_->world.cams.queues);
}

void Engine::Answer(const cam::CamBuilt& result) noexcept {
  impl_->answers.TryPush({0, kMachineTarget, 0, MachineCommand(result)});
}

group::Fixed Engine::fixed(std::size_t group) const noexcept {
  const AxesGroup& of = impl_->world.groups[group];
  return {of.params, of.mounting, *of.kinematics, impl_->world.paths, impl_->world.cycle};
}

void Engine::RunCycle(const CycleTiming& timing) noexcept {
  World& world = impl_->world;
  impl_->TakeSamples();
  Sense(world);
  impl_->TakeTiming(timing);
  impl_->ApplyCommands();
  Move(world);
  Control(world);
  Actuate(world);
  impl_->SendSetPoints(static_cast<std::int64_t>(world.cycle.count));
  impl_->Publish();
  ++world.cycle.count;
}

const Cycle& Engine::cycle() const noexcept {
  return impl_->world.cycle;
}
const axis::Outputs& Engine::outputs(std::size_t axis) const noexcept {
  return impl_->world.axis_outputs[axis];
}
const flexcam::Outputs& Engine::flex_cam_outputs(std::size_t module) const noexcept {
  return impl_->world.flex_cam_outputs[module];
}
const group::Outputs& Engine::group_outputs(std::size_t group) const noexcept {
  return impl_->world.group_outputs[group];
}
const conveyor::Outputs& Engine::belt_outputs(std::size_t belt) const noexcept {
  return impl_->world.belt_outputs[belt];
}
const conveyor::PoseOutputs& Engine::pose_outputs(std::size_t pose) const noexcept {
  return impl_->world.pose_outputs[pose];
}
const conveyor::State& Engine::belt_state(std::size_t belt) const noexcept {
  return impl_->world.belt_states[belt];
}
const pickplace::Outputs& Engine::pick_place_outputs(std::size_t module) const noexcept {
  return impl_->world.pick_place_outputs[module];
}
const mover::Outputs& Engine::mover_outputs(std::size_t mover) const noexcept {
  return impl_->world.mover_outputs[mover];
}
const mover::State& Engine::mover_state(std::size_t mover) const noexcept {
  return impl_->world.mover_states[mover];
}
const part::Outputs& Engine::part_outputs(std::size_t part) const noexcept {
  return impl_->world.part_outputs[part];
}
PartFaults& Engine::part_faults(std::size_t part) noexcept {
  return impl_->world.part_faults[part];
}
const track::Tracks& Engine::tracks() const noexcept {
  return impl_->world.tracks;
}
const planar::GroupRegistry& Engine::grounds() const noexcept {
  return impl_->world.grounds;
}
std::span<const cam::Table> Engine::cams() const noexcept {
  return impl_->world.cams.tables;
}
std::size_t Engine::components() const noexcept {
  return std::apply([](const auto&... kind) { return (kind.outputs.size() + ...); }, impl_->kinds());
}
Engine::Published Engine::published(std::size_t component) const noexcept {
  Published found{};
  const auto look = [&]<typename Outputs>(const OfKind<Outputs>& kind) {
    if (found.type != nullptr) return;
    if (component < kind.outputs.size()) {
      found = {&TypeOf<Outputs>(), &kind.outputs[component]};
    } else {
      component -= kind.outputs.size();
    }
  };
  std::apply([&](const auto&... kind) { (look(kind), ...); }, impl_->kinds());
  return found;
}
axis::Forecast Engine::Foresee(std::size_t axis) const {
  return engine::Foresee(impl_->world, axis);
}

axis::Forecast Engine::Foresee(std::size_t axis, const axis::Command& command) const {
  return engine::Foresee(impl_->world, axis, command);
}

std::uint64_t Engine::StateHash() const noexcept {
  return impl_->world.StateHash();
}

const EngineFigures& Engine::figures() const noexcept {
  impl_->figures.commands_refused = impl_->refused.load(std::memory_order_relaxed);
  return impl_->figures;
}

plant::ServoFaults& Engine::faults(std::size_t axis) noexcept {
  return impl_->world.servo_states[axis].faults;
}

bool Engine::all_disabled() const noexcept {
  return std::all_of(impl_->world.axis_states.begin(), impl_->world.axis_states.end(),
                     [](const axis::State& s) { return !s.enable && !s.loop_closed; }) &&
         std::ranges::all_of(impl_->world.mover_states, mover::IsOff);
}

bool Engine::at_rest() const noexcept {
  return std::all_of(impl_->world.axis_states.begin(), impl_->world.axis_states.end(),
                     [](const axis::State& s) { return s.setpoint.velocity == 0 && s.setpoint.acceleration == 0; }) &&
         std::ranges::all_of(impl_->world.mover_states, mover::AtRest);
}

void Engine::RequestShutdown() noexcept {
  impl_->shutdown.store(true, std::memory_order_relaxed);
}

void Engine::CountRefusedSample() noexcept {
  impl_->samples_refused.fetch_add(1, std::memory_order_relaxed);
}

SpscQueue<DriveSample>& Engine::drive_samples() noexcept {
  return impl_->drive_samples;
}
SpscQueue<DriveSetPoint>& Engine::set_points() noexcept {
  return impl_->set_points;
}
SpscQueue<DriveEntry>& Engine::drive_journal() noexcept {
  return impl_->drive_journal;
}
SpscQueue<FeedbackEvent>& Engine::feedback() noexcept {
  return impl_->feedback;
}
template <typename Outputs>
SpscQueue<SnapshotOf<Outputs>>& Engine::snapshots() noexcept {
  return std::get<OfKind<Outputs>&>(impl_->kinds()).queue;
}
template SpscQueue<AxisSnapshot>& Engine::snapshots<axis::Outputs>() noexcept;
template SpscQueue<FlexCamSnapshot>& Engine::snapshots<flexcam::Outputs>() noexcept;
template SpscQueue<GroupSnapshot>& Engine::snapshots<group::Outputs>() noexcept;
template SpscQueue<BeltSnapshot>& Engine::snapshots<conveyor::Outputs>() noexcept;
template SpscQueue<PoseSnapshot>& Engine::snapshots<conveyor::PoseOutputs>() noexcept;
template SpscQueue<PickPlaceSnapshot>& Engine::snapshots<pickplace::Outputs>() noexcept;
template SpscQueue<MoverSnapshot>& Engine::snapshots<mover::Outputs>() noexcept;
template SpscQueue<TrackSnapshot>& Engine::snapshots<track::Outputs>() noexcept;
template SpscQueue<PlanarGroupSnapshot>& Engine::snapshots<planargroup::Outputs>() noexcept;
template SpscQueue<EnvironmentSnapshot>& Engine::snapshots<environment::Outputs>() noexcept;
template SpscQueue<PartSnapshot>& Engine::snapshots<part::Outputs>() noexcept;

SpscQueue<ObjectsSnapshot>& Engine::belt_objects() noexcept {
  return impl_->belt_objects;
}
SpscQueue<TrackPlaces>& Engine::track_places() noexcept {
  return impl_->track_places;
}
SpscQueue<TrailSnapshot>& Engine::mover_trails() noexcept {
  return impl_->mover_trails;
}
SpscQueue<RouteSnapshot>& Engine::mover_routes() noexcept {
  return impl_->mover_routes;
}
RouteSnapshot Engine::mover_route(std::size_t mover) const noexcept {
  return impl_->RouteOf(static_cast<std::uint32_t>(mover));
}
planar::Route Engine::mover_trail(std::size_t mover) const noexcept {
  return planar::RemainingTracks(impl_->world.streets.riders[mover]);
}
SpscQueue<cam::CamPiece>& Engine::cam_pieces() noexcept {
  return impl_->world.cams.pieces;
}
SpscQueue<EngineFigures>& Engine::figure_queue() noexcept {
  return impl_->figure_queue;
}
SpscQueue<JournalEntry>& Engine::journal() noexcept {
  return impl_->journal;
}
SpscQueue<HashEntry>& Engine::hashes() noexcept {
  return impl_->hashes;
}

}  // namespace takt::engine
