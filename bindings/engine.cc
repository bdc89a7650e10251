#include "takt/engine/engine.h"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bindings.h"
#include "recorder.h"
#include "takt/conveyor/objects.h"
#include "takt/core/angle.h"
#include "takt/core/schema.h"
#include "takt/engine/components.h"
#include "takt/engine/load.h"
#include "takt/engine/path_checks.h"
#include "takt/engine/reference.h"
#include "takt/engine/track_shapes.h"
#include "takt/lcm/authentication.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/drives.h"
#include "takt/planar/nearest.h"
#include "takt/workspace/trouble.h"
#include "watch.h"

namespace takt::bindings {
namespace {

// In virtual time a scenario may command a thousand axes before it lets time pass. With what the engine keeps besides
// it is just below a power of two, to which queues are rounded up: touching their memory is most of what an engine
// costs.
constexpr std::size_t kCommandQueue = 3 << 10;
// Journals are taken after every cycle, which adds about a hundred commands at most, and what each drive has measured.
constexpr std::size_t kJournalQueue = 1 << 9;
constexpr std::size_t kJournalledPerDrive = 16;

}  // namespace

engine::LoadResult Load(const py::bytes& text, const std::string& file_name, bool workspaces, engine::Files files) {
  const auto make = workspaces ? engine::Workspaces::kMake : engine::Workspaces::kSkip;
  engine::LoadResult result = engine::LoadMachine(static_cast<std::string_view>(text), file_name, make, files);
  if (!result.machine) ThrowConfigError(result.problems);
  return result;
}

namespace {

std::string MachineJson(const engine::Machine& machine) {
  return ToJson(TypeOf<engine::Machine>(), &machine).dump();
}

std::vector<std::string> CheckMachine(const py::bytes& text, const std::string& file_name) {
  return Load(text, file_name, true).warnings;
}

std::string LoadMachine(const py::bytes& text, const std::string& file_name, bool files) {
  return MachineJson(*Load(text, file_name, false, files ? engine::Files::kOpen : engine::Files::kRefuse).machine);
}

py::typing::Dict<py::str, py::typing::List<py::str>> PartsOfGroups(const py::bytes& text,
                                                                   const std::string& file_name) {
  const engine::LoadResult loaded = Load(text, file_name, false);
  py::typing::Dict<py::str, py::typing::List<py::str>> parts;
  for (const group::GroupParams& group : loaded.machine->groups) {
    if (!group.workspace) continue;
    const kinematics::MakeResult made = kinematics::Make(group.kinematics.value());
    parts[py::str(group.name)] = py::cast(workspace::PartNames(*group.workspace, made.kinematics.value()));
  }
  return parts;
}

using Submitted = py::typing::Tuple<Ticket, int, py::str>;  // ticket, error number, sentence
using ShapeRow = py::typing::Tuple<int, double, bool, std::vector<double>, std::vector<double>, std::vector<double>,
                                   std::vector<double>>;
using FeedbackRow =
    py::typing::Tuple<Ticket, std::uint64_t, int, bool, int, double, py::str, int,
                      std::uint32_t>;  // ticket, cycle, state, reached, error, value, sentence, object: kind and number
using JournalRow =
    py::typing::Tuple<std::uint64_t, Ticket, double, py::str, py::str, py::str>;  // cycle, ticket, lease, command
using Wires = py::typing::Dict<py::str, py::object>;
using DriveRow = py::typing::Tuple<std::uint64_t, std::uint32_t, std::int64_t, Wires>;  // cycle, axis, answers, wires
using Foreseen = py::typing::Tuple<axis::Forecast, py::str>;
using PoseRow = py::typing::Tuple<double, double, double, double, double, double>;
using ObjectRow = py::typing::Tuple<std::uint32_t, int, double, PoseRow, bool, std::uint32_t, std::uint32_t,
                                    double>;  // number, state, place, pose, in range, kind, colour, quality
using RecordRow =
    py::typing::Tuple<Ticket, py::str, int, int, std::uint64_t, std::uint64_t, std::uint64_t, int, std::uint32_t,
                      int>;  // ticket, verb, state, error, cycles: given, begun, changed, object, limited by
using TrackRow = py::typing::Tuple<double, double, double, double>;  // x, y, direction in deg, curvature
using TrackLinks = py::typing::Tuple<py::typing::List<std::size_t>, py::typing::List<std::size_t>>;
using State = py::typing::Tuple<double, double, double>;  // position, velocity, acceleration
using Hashes = py::typing::Tuple<py::array_t<std::uint64_t>, py::array_t<std::uint64_t>>;  // cycles, hashes

// What moves instead of simulated servos, in this process: a step of it, in Python, for the set points of each cycle.
struct InProcess {
  std::vector<std::uint32_t> axes;  // indices in Machine::axes
  std::vector<ServoOutputs> told;   // one an axis
  std::vector<PlantAnswer> measured;
  std::int64_t cycle = -1;  // of the set points
  py::object step{};        // called with the cycle and views of both
  py::object told_view{};
  py::object measured_view{};
  bool failed = false;
};

// An engine in virtual time. Stepping releases the GIL; what it collects is guarded by a mutex that is only ever waited
// for without the GIL.
class VirtualEngine {
 public:
  // `loaded`: from LoadMachine. `drives_url`: LCM network of external drives; without it their feedback comes from
  // Hear. `drives_keys`: the keys shared with them, if any.
  VirtualEngine(engine::LoadResult loaded, bool journal, const std::optional<std::string>& drives_url,
                const std::optional<lcm::Keys>& drives_keys, const std::vector<std::uint32_t>& plant, bool checks)
      : journaling_(journal),
        journal_queue_(kJournalQueue + kJournalledPerDrive * loaded.machine->axes.size()),
        engine_(std::move(*loaded.machine), {.drives = drives_url.has_value() || !plant.empty(),
                                             .journal = journal,
                                             .command_queue = kCommandQueue,
                                             .snapshot_queue = journal_queue_}) {
    plant_.axes = plant;
    plant_.told.resize(plant.size());
    plant_.measured.resize(plant.size());
    engine_.PlanElsewhere();  // a replay has the answers from its journal
    if (checks) checks_.emplace(engine_, std::move(loaded.checkers));
    if (!plant.empty() || !drives_url || engine_.machine().external.drives.empty()) return;
    std::string problem;
    const auto complain = [this](const std::string& text) { complaints_.push_back(text); };
    drives_ = lcm::Drives::Open(
        engine_,
        {.url = *drives_url,
         .run_id = lcm::WallClockUs(),
         .authentication = drives_keys ? std::make_shared<lcm::Authentication>(*drives_keys, complain) : nullptr,
         .complain = complain},
        problem);
    if (!drives_) Throw("ConnectionError", py::str(problem));
  }

  // Steps up to `cycles` cycles, or until one reports feedback, a watch sees a change, or external drives let it wait.
  // How many it were.
  std::uint64_t Step(std::uint64_t cycles, bool until_feedback) {
    RefuseFromPlant();
    const std::lock_guard lock(mutex_);
    for (std::uint64_t i = 0; i < cycles;) {
      if (drives_ && !drives_->Ready()) return i;
      if (!plant_.axes.empty()) MovePlant();
      engine_.RunCycle();
      if (checks_) checks_->Run();
      ++i;
      const bool news = Drain(engine_.feedback(), feedback_);
      if (journaling_) {
        Drain(engine_.journal(), journal_);
        Drain(engine_.drive_journal(), drive_journal_);
        Drain(engine_.hashes(), hashes_);
      }
      for (const auto& recorder : recorders_) recorder->Append(engine_);
      if ((news && until_feedback) || AnyChanged()) return i;
    }
    return cycles;
  }

  // Has steps end where any of these fields, (component, field), is other than when it was kept last.
  std::shared_ptr<Watch> StartWatch(const std::vector<std::pair<std::size_t, std::size_t>>& fields,
                                    std::uint64_t every) {
    if (every == 0) throw std::invalid_argument("every must be at least 1");
    std::vector<Watch::Field> found;
    for (const auto& [component, field] : fields) {
      CheckComponent(component);
      const Column& column = columns_.at(engine_.published(component).type).at(field);
      found.push_back({component, column.offset, column.type->size});
    }
    const auto lock = Lock();
    watches_.push_back(std::make_shared<Watch>(std::move(found), every, engine_.cycle().count));
    watches_.back()->Keep(engine_);
    return watches_.back();
  }

  bool HasChanged(const Watch& watch) {
    const auto lock = Lock();
    return watch.Changed(engine_);
  }

  void Keep(Watch& watch) {
    const auto lock = Lock();
    watch.Keep(engine_);
  }

  // `step` moves the axes that this engine was made with as those of a plant.
  void SetPlant(const py::object& step) {
    plant_.step = step;
    const auto count = static_cast<py::ssize_t>(plant_.axes.size());
    const auto nothing = [](void*) {};  // the rows are this engine's own
    void* const told = plant_.told.data();
    void* const measured = plant_.measured.data();
    const py::dtype layout = LayoutOf(ColumnsOf(TypeOf<ServoOutputs>()), sizeof(ServoOutputs));
    plant_.told_view = py::array(layout, count, told, py::capsule(told, nothing));
    plant_.measured_view = py::array(LayoutOfAnswers(), count, measured, py::capsule(measured, nothing));
  }

  // Seconds that so many bare cycles take, nothing collected: what stepping is compared with.
  double Measure(std::uint64_t cycles) {
    if (!plant_.axes.empty()) throw std::logic_error("bare cycles have no plant");
    const std::lock_guard lock(mutex_);
    const auto start = std::chrono::steady_clock::now();
    for (std::uint64_t i = 0; i < cycles; ++i) engine_.RunCycle();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  // (ticket, error number, sentence); ticket 0: refused.
  Submitted Submit(const std::string& target, const std::string& verb, const std::string& arguments) {
    const engine::ParsedCommand parsed = engine::ParseCommand(engine_.machine(), target, verb, arguments);
    if (parsed.error != ErrorId::kNone) return Answer(0, parsed.error, parsed.sentence);
    const Ticket ticket = engine_.Submit(parsed.command);
    return ticket != 0 ? Answer(ticket, ErrorId::kNone, "")
                       : Answer(0, ErrorId::kQueueFull, ErrorText(ErrorId::kQueueFull));
  }

  // The same for a command out of a journal.
  Submitted Resubmit(const std::string& target, const std::string& verb, const std::string& arguments, Ticket ticket,
                     double lease_s) {
    engine::ParsedCommand parsed =
        engine::ParseCommand(engine_.machine(), target, verb, arguments, engine::Giver::kJournal);
    if (parsed.error != ErrorId::kNone) return Answer(0, parsed.error, parsed.sentence);
    parsed.command.ticket = ticket;
    parsed.command.lease_s = lease_s;
    const bool taken = engine_.Resubmit(parsed.command);
    return taken ? Answer(ticket, ErrorId::kNone, "") : Answer(0, ErrorId::kQueueFull, ErrorText(ErrorId::kQueueFull));
  }

  // What an external drive had measured, out of a journal. False: too much for one cycle.
  bool Hear(std::uint32_t axis, std::int64_t answers, const Wires& wires) {
    CheckAxis(axis);
    engine::DriveSample sample{answers, axis, {}};
    FromPython(TypeOf<ServoInputs>(), wires, &sample.inputs);
    const auto lock = Lock();
    return engine_.drive_samples().TryPush(sample);
  }

  // What external drives had measured, as it was taken since the last call: (cycle, axis, cycle it answers, wires).
  py::typing::List<DriveRow> TakeDriveJournal() {
    std::vector<engine::DriveEntry> entries;
    {
      const auto lock = Lock();
      entries.swap(drive_journal_);
    }
    py::typing::List<DriveRow> list;
    for (const engine::DriveEntry& e : entries) {
      const Wires wires = ToPython(TypeOf<ServoInputs>(), &e.sample.inputs);
      list.append(py::make_tuple(e.cycle, e.sample.axis, e.sample.cycle, wires));
    }
    return list;
  }

  // What is wrong with messages of external drives, since the last call.
  std::vector<std::string> TakeComplaints() {
    const auto lock = Lock();
    return std::exchange(complaints_, {});
  }

  py::typing::List<FeedbackRow> TakeFeedback() {
    std::vector<FeedbackEvent> events;
    {
      const auto lock = Lock();
      events.swap(feedback_);
    }
    py::typing::List<FeedbackRow> list;
    for (const FeedbackEvent& e : events) {
      list.append(py::make_tuple(e.ticket, e.cycle, static_cast<int>(e.state), e.reached, static_cast<int>(e.error),
                                 e.value, checks_ ? checks_->Sentence(e) : engine::SentenceNaming(e, engine_.machine()),
                                 static_cast<int>(e.object.kind), e.object.number));
    }
    return list;
  }

  // Commands as they were applied since the last call: (cycle, ticket, lease, target, verb, arguments).
  py::typing::List<JournalRow> TakeJournal() {
    std::vector<engine::JournalEntry> entries;
    {
      const auto lock = Lock();
      entries.swap(journal_);
    }
    py::typing::List<JournalRow> list;
    for (const engine::JournalEntry& e : entries) {
      const engine::CommandText text = engine::ToText(engine_.machine(), e.command);
      list.append(py::make_tuple(e.cycle, e.command.ticket, e.command.lease_s, text.target, text.verb, text.arguments));
    }
    return list;
  }

  // State hashes since the last call: cycles and hashes.
  Hashes TakeHashes() {
    std::vector<engine::HashEntry> entries;
    {
      const auto lock = Lock();
      entries.swap(hashes_);
    }
    py::array_t<std::uint64_t> cycles(static_cast<py::ssize_t>(entries.size())),
        hashes(static_cast<py::ssize_t>(entries.size()));
    for (std::size_t i = 0; i < entries.size(); ++i) {
      cycles.mutable_data()[i] = entries[i].cycle;
      hashes.mutable_data()[i] = entries[i].hash;
    }
    return py::make_tuple(cycles, hashes);
  }

  py::typing::List<ObjectRow> BeltObjects(std::size_t belt) {
    const auto lock = Lock();
    const engine::Machine& machine = engine_.machine();
    if (belt >= machine.belts.size()) throw std::out_of_range("no such belt");
    const conveyor::State& state = engine_.belt_state(belt);
    py::typing::List<ObjectRow> list;
    for (const conveyor::Object& object : conveyor::ObjectsOf(state)) {
      const auto [place, pose, in_range] = conveyor::See(machine.belts[belt], state, object);
      const auto& [kind, colour, quality] = object.attributes;
      list.append(py::make_tuple(object.number, static_cast<int>(object.state), place,
                                 py::make_tuple(pose.x, pose.y, pose.z, pose.a, pose.b, pose.c), in_range, kind, colour,
                                 quality));
    }
    return list;
  }

  // Of a track, as it is published: number of its part, length, whether it is closed, places, x, y and direction.
  ShapeRow TrackShape(std::uint32_t track) {
    const auto lock = Lock();
    if (track >= engine_.machine().tracks.size()) throw std::out_of_range("no such track");
    std::array<std::vector<double>, 4> all;
    engine::TrackPlaces places;
    do {
      const auto first = static_cast<std::uint32_t>(all[0].size());
      places = engine::PlacesOf(0, engine_.tracks(), track, first);
      for (std::uint32_t i = 0; i < places.count; ++i) {
        const engine::TrackPlaces::At& at = places.places[i];
        all[0].push_back(at.position);
        all[1].push_back(at.x);
        all[2].push_back(at.y);
        all[3].push_back(at.direction / kDegree);
      }
    } while (all[0].size() < places.total);
    return py::make_tuple(places.part, places.length, places.closed, all[0], all[1], all[2], all[3]);
  }

  // The last commands of a mover, the oldest first.
  py::typing::List<RecordRow> MoverHistory(std::size_t mover) {
    const auto lock = Lock();
    if (mover >= engine_.machine().movers.size()) throw std::out_of_range("no such mover");
    const mover::History& history = engine_.mover_state(mover).history;
    py::typing::List<RecordRow> list;
    for (std::uint64_t i = history.count - std::min<std::uint64_t>(history.count, mover::kHistory); i < history.count;
         ++i) {
      const mover::Record& r = history.records[i % mover::kHistory];
      const Type& type = mover::TypeOfCommand(r.command);
      const auto verb = std::ranges::find(engine::Verbs(), &type, &engine::Verb::arguments);
      list.append(py::make_tuple(r.ticket, verb->name, static_cast<int>(r.state), static_cast<int>(r.error), r.cycle,
                                 r.begun, r.changed, static_cast<int>(r.object.kind), r.object.number,
                                 static_cast<int>(r.limited_by)));
    }
    return list;
  }

  // Numbers of the tracks, from 0, that a mover is to go along.
  py::typing::List<std::size_t> MoverTrail(std::size_t mover) {
    const auto lock = Lock();
    if (mover >= engine_.machine().movers.size()) throw std::out_of_range("no such mover");
    py::typing::List<std::size_t> list;
    for (const std::uint32_t track : engine_.mover_trail(mover).all()) list.append(track);
    return list;
  }

  // The number of the first visit of its route over the free surface, and the middles of all places, (n, 2) mm.
  std::pair<std::uint64_t, py::array_t<double>> MoverRoute(std::size_t mover) {
    const auto lock = Lock();
    if (mover >= engine_.machine().movers.size()) throw std::out_of_range("no such mover");
    const engine::RouteSnapshot route = engine_.mover_route(mover);
    py::array_t<double> places({py::ssize_t{route.count}, py::ssize_t{2}});
    auto rows = places.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
      rows(i, 0) = route.all()[static_cast<std::size_t>(i)].x;
      rows(i, 1) = route.all()[static_cast<std::size_t>(i)].y;
    }
    return {route.first, places};
  }

  // Of the way as it is now: x, y and the direction in deg.
  TrackRow TrackAt(std::size_t track, double s) {
    const auto lock = Lock();
    WayOf(track);
    const planar::TrackPoint point = engine_.tracks().At(track, s);
    return py::make_tuple(point.place.x, point.place.y, point.direction * 180 / std::numbers::pi, point.curvature);
  }

  double TrackClosestTo(std::size_t track, double x, double y) {
    const auto lock = Lock();
    return planar::NearestTo(WayOf(track), planar::Place{x, y} - engine_.tracks().spot(track).origin).s;
  }

  // Tracks that end where this one starts, and that start where it ends.
  TrackLinks LinksOf(std::size_t track) {
    const auto lock = Lock();
    const track::Tracks& tracks = engine_.tracks();
    std::vector<std::size_t> before, behind;
    for (std::size_t i = 0; i < tracks.states.size(); ++i) {
      if (tracks.end_nodes[i] == tracks.start_nodes.at(track)) before.push_back(i);
      if (tracks.start_nodes[i] == tracks.end_nodes.at(track)) behind.push_back(i);
    }
    return py::make_tuple(before, behind);
  }

  // A copy of the cam with this number.
  cam::Table Cam(std::uint64_t number) {
    const auto lock = Lock();
    const auto cams = engine_.cams();
    const auto found = std::ranges::find(cams, number, &cam::Table::number);
    if (number == 0 || found == cams.end()) Throw("TaktError", py::str("there is no cam of this number any more"));
    return *found;
  }

  // Of the cam that this name stands for; 0: none.
  std::uint64_t CamNumber(const std::string& name) {
    const auto lock = Lock();
    const std::optional<std::uint32_t> index = cam::Find(engine_.cams(), name);
    return index ? engine_.cams()[*index].number() : 0;
  }

  py::object Value(std::size_t component, std::size_t field) {
    const auto lock = Lock();
    CheckComponent(component);
    const engine::Engine::Published published = engine_.published(component);
    const Column& column = columns_.at(published.type).at(field);
    return ScalarToPython(*column.type, static_cast<const std::byte*>(published.outputs) + column.offset);
  }

  axis::Forecast Foresee(std::size_t axis) {
    CheckAxis(axis);
    const auto lock = Lock();
    return engine_.Foresee(axis);
  }

  // Of a command if it were given now, and the sentence that says why it would be refused.
  Foreseen ForeseeCommand(const std::string& target, const std::string& verb, const std::string& arguments) {
    const engine::ParsedCommand parsed = engine::ParseCommand(engine_.machine(), target, verb, arguments);
    axis::Forecast forecast;
    forecast.error = parsed.error;
    if (parsed.error != ErrorId::kNone) return py::make_tuple(forecast, parsed.sentence);
    {
      const auto lock = Lock();
      CheckAxis(parsed.command.target - 1);
      forecast = engine_.Foresee(parsed.command.target - 1, std::get<axis::Command>(parsed.command.body));
    }
    return py::make_tuple(forecast, ErrorText(forecast.error));
  }

  std::shared_ptr<Recorder> StartRecorder(const std::vector<std::size_t>& components, std::uint64_t every) {
    for (const std::size_t component : components) CheckComponent(component);
    if (every == 0) throw std::invalid_argument("every must be at least 1");
    const auto lock = Lock();
    recorders_.push_back(std::make_shared<Recorder>(engine_, components, every));
    return recorders_.back();
  }

  void StopRecorder(const std::shared_ptr<Recorder>& recorder) {
    const auto lock = Lock();
    std::erase(recorders_, recorder);
  }

  py::typing::Dict<py::str, py::object> Figures() {
    const auto lock = Lock();
    return ToPython(TypeOf<engine::EngineFigures>(), &engine_.figures());
  }

  std::uint64_t StateHash() {
    const auto lock = Lock();
    return engine_.StateHash();
  }
  std::uint64_t cycle() {
    const auto lock = Lock();
    return engine_.cycle().count;
  }
  double period_s() const { return engine_.machine().cycle.period_s; }
  bool at_rest() {
    const auto lock = Lock();
    return engine_.at_rest();
  }
  bool all_disabled() {
    const auto lock = Lock();
    return engine_.all_disabled();
  }
  std::string machine_json() const { return MachineJson(engine_.machine()); }
  void RequestShutdown() { engine_.RequestShutdown(); }

  // External drives hear nothing more of this engine, whenever Python takes it away.
  void LeaveNetwork() {
    const auto lock = Lock();
    drives_.reset();
  }

 private:
  static Submitted Answer(Ticket ticket, ErrorId error, std::string_view sentence) {
    return py::make_tuple(ticket, static_cast<int>(error), sentence);
  }

  bool AnyChanged() const {
    const std::uint64_t cycle = engine_.cycle().count;
    return std::ranges::any_of(watches_,
                               [&](const auto& watch) { return watch->IsDue(cycle) && watch->Changed(engine_); });
  }

  template <typename T>
  static bool Drain(SpscQueue<T>& queue, std::vector<T>& out) {
    T value;
    bool any = false;
    while (queue.TryPop(value)) {
      out.push_back(value);
      any = true;
    }
    return any;
  }

  // One step of the plant, once all set points of a cycle are there; the GIL is not held. What it raises ends the step
  // of the engine before its cycle, and each later one.
  void MovePlant() {
    if (plant_.failed) throw std::logic_error("the plant has failed before");
    engine::DriveSetPoint set_point;
    while (engine_.set_points().TryPop(set_point)) {
      const auto at = std::ranges::find(plant_.axes, set_point.axis) - plant_.axes.begin();
      plant_.told[static_cast<std::size_t>(at)] = set_point.outputs;
      plant_.cycle = set_point.cycle;
    }
    {
      const py::gil_scoped_acquire acquire;
      plant_.failed = true;  // until it has come back
      stepping_ = std::this_thread::get_id();
      try {
        plant_.step(plant_.cycle, plant_.told_view, plant_.measured_view);
      } catch (...) {
        stepping_ = std::thread::id();
        throw;
      }
      stepping_ = std::thread::id();
      plant_.failed = false;
    }
    for (std::size_t i = 0; i < plant_.axes.size(); ++i) {
      const auto& [wires, true_position] = plant_.measured[i];
      if (!engine_.drive_samples().TryPush({plant_.cycle, plant_.axes[i], wires, true_position})) {
        engine_.CountRefusedSample();
      }
    }
  }

  // A plant that asks its own engine in the middle of a cycle would wait for itself for ever.
  void RefuseFromPlant() const {
    if (stepping_ != std::this_thread::get_id()) return;
    throw std::logic_error("a plant's step must not use its engine, which is in the middle of a cycle");
  }

  std::unique_lock<std::mutex> Lock() {
    RefuseFromPlant();
    const py::gil_scoped_release release;
    return std::unique_lock(mutex_);
  }

  void CheckAxis(std::size_t axis) const {
    if (axis >= engine_.machine().axes.size()) throw std::out_of_range("no such axis");
  }

  const planar::Track& WayOf(std::size_t track) const {
    const planar::Track* way = engine_.tracks().ways.at(track);
    if (!way) throw std::invalid_argument("the track has no length yet");
    return *way;
  }

  void CheckComponent(std::size_t component) const {
    if (component >= engine_.components()) throw std::out_of_range("no such component");
  }

  static std::map<const Type*, std::vector<Column>> ColumnsOfAll() {
    std::map<const Type*, std::vector<Column>> columns;
    for (const engine::ComponentKind& kind : engine::ComponentKinds()) columns[kind.outputs] = ColumnsOf(*kind.outputs);
    return columns;
  }

  const std::map<const Type*, std::vector<Column>> columns_ = ColumnsOfAll();
  const bool journaling_;
  std::size_t journal_queue_;  // before the machine is given away
  std::mutex mutex_;
  engine::Engine engine_;
  std::optional<engine::PathChecks> checks_;
  std::unique_ptr<lcm::Drives> drives_;
  InProcess plant_;
  std::atomic<std::thread::id> stepping_{};  // the thread that the plant's step runs in
  std::vector<FeedbackEvent> feedback_;
  std::vector<engine::JournalEntry> journal_;
  std::vector<engine::HashEntry> hashes_;
  std::vector<engine::DriveEntry> drive_journal_;
  std::vector<std::string> complaints_;
  std::vector<std::shared_ptr<Recorder>> recorders_;
  std::vector<std::shared_ptr<Watch>> watches_;
};

// `checks`: groups with a workspace are answered when they ask about a path, and tracks are made; without, the journal
// does it, and the machine is from a log: it opens no files.
std::unique_ptr<VirtualEngine> MakeEngine(const py::bytes& text, const std::string& file_name, bool journal,
                                          std::optional<double> period_s, const std::optional<std::string>& drives_url,
                                          const std::optional<py::bytes>& drives_key,
                                          const std::vector<std::string>& plant_axes, bool checks) {
  engine::LoadResult loaded = Load(text, file_name, checks, checks ? engine::Files::kOpen : engine::Files::kRefuse);
  for (const std::string& warning : loaded.warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 2) != 0) throw py::error_already_set();
  }
  if (period_s) {
    const Field& field = *TypeOf<engine::CycleParams>().FindField("period_s");
    if (!field.range.Holds(*period_s)) ThrowConfigError({"the cycle's period must be " + Text(field.range) + " s"});
    loaded.machine->cycle.period_s = *period_s;
  }
  const auto keys = drives_key ? std::optional(KeysOf(*drives_key)) : std::nullopt;
  std::vector<std::uint32_t> plant;
  for (const std::string& name : plant_axes) {
    const std::uint32_t axis = axis::FindAxis(loaded.machine->axes, name);
    if (axis == axis::kNoAxis) throw std::invalid_argument("the machine has no axis " + name);
    if (!engine::ExternalOf(*loaded.machine, axis)) loaded.machine->external.drives.push_back({.axis = name});
    plant.push_back(axis);
  }
  return std::make_unique<VirtualEngine>(std::move(loaded), journal, drives_url, keys, plant, checks);
}

}  // namespace

void BindEngine(py::module_& m) {
  m.def("load_machine", &LoadMachine, py::arg("text"), py::arg("file_name"), py::arg("files") = true,
        "Reads and checks a machine file: all its parameters with their defaults, as JSON. With `files` false, for "
        "texts from a network or a log, a file that the text names is a problem and is not opened. Raises "
        "takt.ConfigError with every problem.");
  m.def("check_machine", &CheckMachine, py::arg("text"), py::arg("file_name"),
        "Reads and checks a machine file: its warnings. Raises takt.ConfigError with every problem.");
  m.def("parts_of_groups", &PartsOfGroups, py::arg("text"), py::arg("file_name"),
        "For each group with a workspace the names of its parts, in the order of their numbers.");
  m.def("schema", &engine::SchemaText, "The JSON Schema of machine files.");
  m.def(
      "reference", [] { return engine::ReferenceText(TAKT_VERSION); },
      "Everything that is described, as JSON: machine, verbs, outputs, figures, states, transitions, homing, errors.");

  py::class_<Recorder, std::shared_ptr<Recorder>>(m, "Recorder",
                                                  "Rows of what components publish, one every so many cycles.")
      .def_property_readonly("rows", &Recorder::rows)
      .def("cycles", &Recorder::Cycles, "The cycle of every row.")
      .def("take_table", &Recorder::TakeTable, py::arg("index"),
           "The rows of the component at this place of the list it was started with; once, when it has been stopped.");

  py::class_<Watch, std::shared_ptr<Watch>>(m, "Watch", "Published values that end a step when they change.");

  using F = axis::Forecast;
  py::class_<F>(m, "Forecast", "What a motion is going to do.")
      .def_property_readonly("error_id", [](const F& f) { return static_cast<int>(f.error); })
      .def_readonly("known", &F::known)
      .def_readonly("held", &F::held)
      .def_property_readonly("limited_by", [](const F& f) { return static_cast<int>(f.limited_by); })
      .def_readonly("start_s", &F::start_s)
      .def_property_readonly("duration_s", &F::duration_s)
      .def("time_to", &F::TimeTo, py::arg("position"))
      .def(
          "at",
          [](const F& f, double in_s) -> State {
            const KinematicState s = f.At(in_s);
            return py::make_tuple(s.position, s.velocity, s.acceleration);
          },
          py::arg("in_s"));

  using E = VirtualEngine;
  using Released = py::call_guard<py::gil_scoped_release>;
  py::class_<E>(m, "Engine", "One machine in virtual time.")
      .def(py::init(&MakeEngine), py::arg("text"), py::arg("file_name"), py::kw_only(), py::arg("journal") = false,
           py::arg("period_s") = py::none(), py::arg("drives_url") = py::none(), py::arg("drives_key") = py::none(),
           py::arg("plant") = std::vector<std::string>{}, py::arg("checks") = true)
      .def("set_plant", &E::SetPlant, py::arg("step"))
      .def("step", &E::Step, py::arg("cycles"), py::arg("until_feedback") = false, Released())
      .def("measure", &E::Measure, py::arg("cycles"), Released())
      .def("submit", &E::Submit, py::arg("target"), py::arg("verb"), py::arg("arguments"))
      .def("resubmit", &E::Resubmit, py::arg("target"), py::arg("verb"), py::arg("arguments"), py::arg("ticket"),
           py::arg("lease_s"))
      .def("hear", &E::Hear, py::arg("axis"), py::arg("answers"), py::arg("wires"))
      .def("take_drive_journal", &E::TakeDriveJournal)
      .def("take_complaints", &E::TakeComplaints)
      .def("take_feedback", &E::TakeFeedback)
      .def("take_journal", &E::TakeJournal)
      .def("take_hashes", &E::TakeHashes)
      .def("belt_objects", &E::BeltObjects, py::arg("belt"))
      .def("track_shape", &E::TrackShape, py::arg("track"))
      .def("mover_trail", &E::MoverTrail, py::arg("mover"))
      .def("mover_route", &E::MoverRoute, py::arg("mover"))
      .def("mover_history", &E::MoverHistory, py::arg("mover"))
      .def("track_at", &E::TrackAt, py::arg("track"), py::arg("s"))
      .def("track_closest_to", &E::TrackClosestTo, py::arg("track"), py::arg("x"), py::arg("y"))
      .def("track_links", &E::LinksOf, py::arg("track"))
      .def("cam", &E::Cam, py::arg("number"))
      .def("cam_number", &E::CamNumber, py::arg("name"))
      .def("value", &E::Value, py::arg("component"), py::arg("field"))
      .def("foresee", &E::Foresee, py::arg("axis"))
      .def("foresee_command", &E::ForeseeCommand, py::arg("target"), py::arg("verb"), py::arg("arguments"))
      .def("start_recorder", &E::StartRecorder, py::arg("components"), py::arg("every") = 1)
      .def("stop_recorder", &E::StopRecorder, py::arg("recorder"))
      .def("start_watch", &E::StartWatch, py::arg("fields"), py::arg("every"))
      .def("has_changed", &E::HasChanged, py::arg("watch"))
      .def("keep", &E::Keep, py::arg("watch"))
      .def("figures", &E::Figures)
      .def("state_hash", &E::StateHash)
      .def_property_readonly("cycle", &E::cycle)
      .def_property_readonly("period_s", &E::period_s)
      .def_property_readonly("at_rest", &E::at_rest)
      .def_property_readonly("all_disabled", &E::all_disabled)
      .def_property_readonly("machine_json", &E::machine_json)
      .def("request_shutdown", &E::RequestShutdown)
      .def("leave_network", &E::LeaveNetwork);
}

}  // namespace takt::bindings
