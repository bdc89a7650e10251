#include "takt/engine/cycle.h"

#include <algorithm>
#include <array>

#include "takt/cam/build.h"
#include "takt/core/describe.h"
#include "takt/core/hash.h"
#include "takt/engine/order.h"

namespace takt::engine {

namespace {

// Feedback of one cycle: each live command of an axis may start and end in it, and so may each newly arrived one.
constexpr std::size_t kEventsPerAxis = 4 * (axis::kBufferSize + 5);
constexpr std::size_t kEventsPerCommand = 4;

axis::Context ContextOf(World& w, std::size_t i) {
  const axis::State* master = w.axis_masters[i] ? &w.axis_states[*w.axis_masters[i]] : nullptr;
  return {w.axis_params[i], w.cycle, w.planner, w.feedback, master, w.surrounding};
}

flexcam::Context ContextOf(World& w, const FlexCam& module) {
  return {module.params, ContextOf(w, module.slave), module.master, module.homing};
}

// The k-th axis that axis i must not step before: the one it follows from load on or by a cam module, those it is
// coupled to, those it will be coupled to by buffered commands. Last come those of `wanted`, a command for axis `of`.
std::optional<std::uint32_t> MasterOf(const World& w, std::uint32_t i, std::uint32_t k,
                                      const axis::CouplingRequest* wanted, std::uint32_t of) {
  const axis::State& s = w.axis_states[i];
  const auto of_request = [](const axis::CouplingRequest& r, std::uint32_t& n) -> std::optional<std::uint32_t> {
    for (const axis::CouplingTerm& term : r.terms) {
      if (term.master != axis::kNoAxis && n-- == 0) return term.master;
    }
    return std::nullopt;
  };
  if (w.axis_masters[i] && k-- == 0) return w.axis_masters[i];
  const std::optional<std::uint32_t> led = w.module_of[i] ? w.flex_cams[w.module_of[i] - 1].master : std::nullopt;
  if (led && k-- == 0) return led;
  if (const auto master = of_request(s.active.coupling, k)) return master;
  for (std::size_t b = 0; b < s.buffered; ++b) {
    if (const auto master = of_request(s.buffer[b].coupling, k)) return master;
  }
  return wanted && i == of ? of_request(*wanted, k) : std::nullopt;
}

bool MakeOrder(World& w, const axis::CouplingRequest* wanted = nullptr, std::uint32_t of = 0) {
  return w.axis_order.Make([&](std::uint32_t i, std::uint32_t k) { return MasterOf(w, i, k, wanted, of); });
}

// AX-82: after an internal fault nothing may move on: all loops open, all outputs are zero.
void OpenAllLoops(World& w) {
  for (std::size_t i = 0; i < w.axis_states.size(); ++i) {
    axis::Fail(ContextOf(w, i), ErrorId::kInternal, true, w.axis_states[i]);
    axis::Control(ContextOf(w, i), w.axis_states[i], w.servo_outputs[i]);
  }
}

// A master does not go on without a follower that has failed (AX-55). A coupling made at run time is over once its
// follower has failed, so it is told once; one made at load holds.
void StopMasters(World& w, std::uint32_t follower) {
  axis::State& s = w.axis_states[follower];
  const auto stop = [&](std::uint32_t master) {
    axis::State& its = w.axis_states[master];
    if (!axis::AtRest(its)) axis::Fail(ContextOf(w, master), ErrorId::kAxisFault, false, its);
  };
  if (w.axis_masters[follower]) stop(*w.axis_masters[follower]);
  for (axis::CouplingTerm& term : s.coupling.law.terms) {
    if (term.master != axis::kNoAxis) stop(term.master);
    term.master = axis::kNoAxis;
  }
}

struct MachineApplier {
  World& world;
  Ticket ticket;

  void Report(FeedbackState state, ErrorId error = ErrorId::kNone) const {
    world.feedback.Report({ticket, world.cycle.count, state, false, error, 0});
  }
  void operator()(const StopAll& c) const {
    for (std::size_t i = 0; i < world.axis_states.size(); ++i) {
      axis::State& state = world.axis_states[i];
      if (c.open_loops) {
        axis::Apply(ContextOf(world, i), 0, 0, axis::Power{.enable = false}, state);
      } else if (state.loop_closed && state.plc != axis::PlcState::kErrorStop) {
        axis::Apply(ContextOf(world, i), 0, 0, axis::Stop{}, state);
      }
    }
    Report(FeedbackState::kDone);
  }
  void operator()(const EmergencyStop&) const {
    for (std::size_t i = 0; i < world.axis_states.size(); ++i) {
      axis::EmergencyStop(ContextOf(world, i), world.axis_states[i]);
    }
    Report(FeedbackState::kDone);
  }
  void operator()(const FailAllAxes&) const {
    for (std::size_t i = 0; i < world.axis_states.size(); ++i) {
      axis::Fail(ContextOf(world, i), ErrorId::kOverrun, false, world.axis_states[i]);
    }
    Report(FeedbackState::kDone);
  }
  void operator()(const Release& c) const { ToOwner(c.ticket, axis::Release, flexcam::Release); }
  void operator()(const Renew& c) const { ToOwner(c.ticket, axis::Renew, flexcam::Renew); }

  template <typename OfAxis, typename OfModule>
  void ToOwner(Ticket of, OfAxis change, OfModule of_module) const {
    bool found = false;
    for (std::size_t i = 0; i < world.axis_states.size() && !found; ++i) {
      found = change(ContextOf(world, i), of, world.axis_states[i]);
    }
    for (std::size_t i = 0; i < world.flex_cams.size() && !found; ++i) {
      found = of_module(ContextOf(world, world.flex_cams[i]), of, world.flex_cam_states[i]);
    }
    Report(FeedbackState::kDone);  // letting go of what is over already is no error
  }
};

}  // namespace

World::World(const Machine& machine)
    : cycle{0, machine.cycle.period_s},
      axis_params(machine.axes),
      cam_switches(machine.cam_switches),
      axis_outputs(machine.axes.size()),
      axis_order(machine.axes.size()),
      servo_inputs(machine.axes.size()),
      servo_outputs(machine.axes.size()),
      samplings(machine.axes.size()),
      feedback_storage(machine.axes.size() * kEventsPerAxis +
                       (kCommandsPerCycle + kRenewalsPerCycle) * kEventsPerCommand),
      feedback(feedback_storage) {
  TypeOf<axis::State>();  // the first use of a type allocates
  TypeOf<plant::ServoState>();
  TypeOf<HeardDrive>();
  TypeOf<ServoInputs>();
  for (const cam::CamParams& cam : machine.cams) cams.push_back(cam::Build(cam).table.value());
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    axis_states.push_back(axis::MakeState(axis_params[i]));
    servo_params.push_back(ServoOf(machine, i));
    servo_states.push_back(plant::MakeServoState(servo_params[i]));
    const auto index = static_cast<std::uint32_t>(i);
    if (const ExternalDrive* external = ExternalOf(machine, i)) {
      drives.push_back({.axis = index, .missing_cycles = external->missing_cycles});
    } else {
      simulated.push_back(index);
      plant::Step(servo_params[i], servo_outputs[i], cycle.period_s, servo_states[i], servo_inputs[i]);
    }
  }
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    axis_masters.push_back(engine::MasterOf(machine, i));
  }
  MakeModules(machine);
  surrounding = {axis_states, axis_params, cam_switches, cams};
  MakeOrder(*this);
}

void World::MakeModules(const Machine& machine) {
  TypeOf<flexcam::State>();
  TypeOf<flexcam::Settings>();
  TypeOf<flexcam::Configure>();
  TypeOf<flexcam::Inputs>();
  TypeOf<flexcam::Control>();
  TypeOf<flexcam::Jog>();
  TypeOf<flexcam::SetCam>();
  TypeOf<flexcam::ChangeCam>();
  TypeOf<flexcam::WithdrawChanges>();
  module_of.assign(machine.axes.size(), 0);
  const auto index_of = [](const auto& list, const std::string& name) {
    return static_cast<std::uint32_t>(std::ranges::find(list, name, [](const auto& x) { return x.name; }) -
                                      list.begin());
  };
  for (const flexcam::FlexCamParams& params : machine.flex_cams) {
    FlexCam module{params, index_of(machine.axes, params.slave), {}, {}};
    if (params.master) module.master = index_of(machine.axes, *params.master);
    module.homing = machine.axes[module.slave].homing;
    std::array<std::uint32_t, flexcam::kSlots> slots{};
    for (std::size_t i = 0; i < params.cams.size(); ++i) slots[i] = index_of(machine.cams, params.cams[i]) + 1;
    flex_cams.push_back(module);
    flex_cam_states.push_back(flexcam::MakeState(params, slots));
    module_of[module.slave] = static_cast<std::uint32_t>(flex_cams.size());
  }
  flex_cam_outputs.resize(flex_cams.size());
}

std::uint64_t World::StateHash() const noexcept {
  std::uint64_t hash = cycle.count;
  for (const axis::State& state : axis_states) hash = HashOf(state, hash);
  for (const axis::AxisParams& params : axis_params) hash = HashOf(params, hash);  // settings change them
  for (const flexcam::State& state : flex_cam_states) hash = HashOf(state, hash);
  for (const plant::ServoState& state : servo_states) hash = HashOf(state, hash);
  for (const HeardDrive& drive : drives) hash = HashOf(servo_inputs[drive.axis], HashOf(drive, hash));
  return hash;
}

bool Take(World& w, const DriveSample& sample) noexcept {
  for (HeardDrive& drive : w.drives) {
    if (drive.axis == sample.axis) return Take(w.cycle, sample, drive, w.servo_inputs[drive.axis]);
  }
  return false;
}

axis::Forecast Foresee(World& w, std::size_t axis) {
  return axis::Foresee(ContextOf(w, axis), w.axis_states.at(axis));
}

axis::Forecast Foresee(World& w, std::size_t axis, const axis::Command& command) {
  return axis::Foresee(ContextOf(w, axis), command, w.axis_states.at(axis));
}

void Sense(World& w) noexcept {
  for (HeardDrive& drive : w.drives) w.samplings[drive.axis] = SamplingIn(w.cycle, drive);
  for (std::size_t i = 0; i < w.axis_states.size(); ++i)
    axis::Sense(ContextOf(w, i), w.servo_inputs[i], w.axis_states[i], w.samplings[i]);
}

void Apply(World& w, const Command& command) noexcept {
  const auto refuse = [&](ErrorId error) {
    w.feedback.Report({command.ticket, w.cycle.count, FeedbackState::kError, false, error, 0});
  };
  const std::uint32_t component = command.target - 1;  // none has the machine's number less one
  const std::size_t axes = w.axis_states.size();
  if (const auto* for_machine = std::get_if<MachineCommand>(&command.body)) {
    std::visit(MachineApplier{w, command.ticket}, *for_machine);
  } else if (const auto* for_axis = std::get_if<axis::Command>(&command.body)) {
    if (component >= axes) return refuse(ErrorId::kUnknownTarget);
    axis::CouplingRequest coupling;
    if (axis::CouplingOf(ContextOf(w, component), *for_axis, coupling) && !MakeOrder(w, &coupling, component)) {
      return refuse(ErrorId::kCouplingLoop);
    }
    axis::Apply(ContextOf(w, component), command.ticket, command.lease_s, *for_axis, w.axis_states[component]);
  } else if (const auto* for_module = std::get_if<flexcam::Command>(&command.body)) {
    const std::size_t i = component - axes;  // of an axis: beyond all
    if (i >= w.flex_cams.size()) return refuse(ErrorId::kUnknownTarget);
    const FlexCam& module = w.flex_cams[i];
    flexcam::Apply(ContextOf(w, module), command.ticket, command.lease_s, *for_module, w.axis_states[module.slave],
                   w.flex_cam_states[i]);
  }
}

void Move(World& w) noexcept {
  // A master does not go on without a follower that has failed.
  for (const std::uint32_t i : w.axis_order.sequence()) {
    if (w.axis_states[i].plc == axis::PlcState::kErrorStop) StopMasters(w, i);
  }
  for (const std::uint32_t i : w.axis_order.sequence()) {
    if (const std::uint32_t module = w.module_of[i]; module != 0) {
      flexcam::Step(ContextOf(w, w.flex_cams[module - 1]), w.axis_states[i], w.flex_cam_states[module - 1]);
    }
    axis::Move(ContextOf(w, i), w.axis_states[i]);
  }
}

void Control(World& w) noexcept {
  bool sound = true;
  for (std::size_t i = 0; i < w.axis_states.size(); ++i) {
    sound &= axis::Control(ContextOf(w, i), w.axis_states[i], w.servo_outputs[i]);
  }
  if (!sound) OpenAllLoops(w);
  for (std::size_t i = 0; i < w.axis_states.size(); ++i) {
    axis::Publish(w.axis_params[i], w.axis_states[i], w.axis_outputs[i]);
  }
  for (std::size_t i = 0; i < w.flex_cams.size(); ++i) {
    const FlexCam& module = w.flex_cams[i];
    flexcam::Publish(ContextOf(w, module), w.axis_states[module.slave], w.flex_cam_states[i], w.flex_cam_outputs[i]);
  }
}

void Actuate(World& w) noexcept {
  for (const std::uint32_t i : w.simulated) {
    plant::Step(w.servo_params[i], w.servo_outputs[i], w.cycle.period_s, w.servo_states[i], w.servo_inputs[i]);
  }
}

}  // namespace takt::engine
