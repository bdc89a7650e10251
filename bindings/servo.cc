#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "bindings.h"
#include "takt/core/ports.h"
#include "takt/plant/servo.h"

namespace takt::bindings {
namespace {

using Wires = py::typing::Dict<py::str, py::object>;

plant::ServoParams ParamsOf(const engine::Machine& machine, const std::string& axis) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].name == axis) return engine::ServoOf(machine, i);
  }
  throw std::invalid_argument("the machine has no axis " + axis);
}

// The simulated servo of one axis, for a process that is the plant of an engine elsewhere.
class Servo {
 public:
  Servo(const py::bytes& text, const std::string& file_name, const std::string& axis)
      : params_(ParamsOf(*Load(text, file_name, false).machine, axis)), state_(plant::MakeServoState(params_)) {}

  void Restart() { state_ = plant::MakeServoState(params_); }

  Wires Step(double period_s, const Wires& told) {
    ServoOutputs outputs;
    FromPython(TypeOf<ServoOutputs>(), told, &outputs);
    ServoInputs inputs;
    plant::Step(params_, outputs, period_s, state_, inputs);
    return ToPython(TypeOf<ServoInputs>(), &inputs);
  }

 private:
  const plant::ServoParams params_;
  plant::ServoState state_;
};

// The drives, encoders and switches of axes that another physics moves (plant/servo.h). Its positions, in m and rad,
// and its torques, in N and Nm, stand in arrays of its own: here are their places in them.
class MovedServos {
 public:
  struct Axis {
    plant::ServoParams params;
    std::size_t position = 0;  // place in the positions of the physics
    std::size_t velocity = 0;  // and in its velocities and torques
    double scale = 1;          // u for 1 of the physics; negative: it counts the other way round
    double zero = 0;           // u where the physics is at 0
    plant::MovedServo state;
  };

  using Doubles = py::array_t<double, py::array::c_style>;

  MovedServos(const py::bytes& text, const std::string& file_name, double period_s, int steps)
      : machine_(*Load(text, file_name, false).machine), period_s_(period_s), steps_(steps) {}

  void Add(const std::string& axis, std::size_t position, std::size_t velocity, double scale, double zero,
           double inertia, double max_torque, double brake_torque) {
    Axis a{ParamsOf(machine_, axis), position, velocity, scale, zero, {}};
    a.params.mechanics.inertia = inertia / std::abs(scale);
    a.params.mechanics.brake_torque = brake_torque;
    a.params.drive.max_torque = max_torque;
    a.state = plant::MakeMovedServo(a.params);
    axes_.push_back(a);
    torques_.push_back(0);
    limited_.push_back(0);
  }

  // Where the physics has to begin.
  std::vector<double> Start() {
    std::vector<double> positions;
    for (Axis& a : axes_) {
      a.state = plant::MakeMovedServo(a.params);
      positions.push_back((a.state.servo.motor_position - a.zero) / a.scale);
    }
    return positions;
  }

  void Begin(const py::array& told) {
    const auto* commanded = static_cast<const ServoOutputs*>(Checked(told, sizeof(ServoOutputs)));
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      plant::BeginCycle(axes_[i].params, commanded[i], period_s_, steps_, axes_[i].state);
      limited_[i] = 0;
    }
  }

  // `feed_forward`: torques of the physics that the motors are told to add; `torques` are set.
  void Ask(int step, const Doubles& positions, const Doubles& velocities, const Doubles& feed_forward,
           Doubles& torques) {
    auto out = torques.mutable_unchecked<1>();
    const auto q = positions.unchecked<1>();
    const auto v = velocities.unchecked<1>();
    const auto ahead = feed_forward.unchecked<1>();
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      Axis& a = axes_[i];
      const auto [at, dof] = PlacesIn(a, q.shape(0), v.shape(0), out.shape(0));
      const double sense = a.scale < 0 ? -1 : 1;
      const double more = dof < ahead.shape(0) ? sense * ahead(dof) : 0;
      const double torque = plant::AskTorque(a.params, step, a.zero + a.scale * q(at), a.scale * v(dof), more, a.state);
      out(dof) = sense * torque;
      torques_[i] = a.state.servo.torque;
      limited_[i] |= a.state.limited ? 1 : 0;
    }
  }

  void Sense(const Doubles& positions, const Doubles& velocities, py::array& measured) {
    auto* answers = static_cast<PlantAnswer*>(const_cast<void*>(Checked(measured, sizeof(PlantAnswer))));
    const auto q = positions.unchecked<1>();
    const auto v = velocities.unchecked<1>();
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      Axis& a = axes_[i];
      const auto [at, dof] = PlacesIn(a, q.shape(0), v.shape(0), v.shape(0));
      answers[i].true_position = a.zero + a.scale * q(at);
      plant::Sense(a.params, answers[i].true_position, a.scale * v(dof), a.state, answers[i].wires);
    }
  }

  // Of the motors in the last step, in the axes' sense; and which were held back by their limit in this cycle.
  const std::vector<double>& torques() const { return torques_; }
  const std::vector<std::uint8_t>& limited() const { return limited_; }

 private:
  static std::pair<py::ssize_t, py::ssize_t> PlacesIn(const Axis& a, py::ssize_t positions, py::ssize_t velocities,
                                                      py::ssize_t torques) {
    const auto at = static_cast<py::ssize_t>(a.position);
    const auto dof = static_cast<py::ssize_t>(a.velocity);
    if (at >= positions || dof >= velocities || dof >= torques) throw std::out_of_range("no such joint");
    return {at, dof};
  }

  const void* Checked(const py::array& rows, std::size_t size) const {
    if (rows.ndim() != 1 || static_cast<std::size_t>(rows.itemsize()) != size ||
        static_cast<std::size_t>(rows.shape(0)) != axes_.size() || rows.strides(0) != rows.itemsize()) {
      throw std::invalid_argument("expected one row for each axis, as a plant's step is given them");
    }
    return rows.data();
  }

  const engine::Machine machine_;
  const double period_s_;
  const int steps_;
  std::vector<Axis> axes_;
  std::vector<double> torques_;
  std::vector<std::uint8_t> limited_;
};

Wires Off() {
  const ServoOutputs outputs;
  return ToPython(TypeOf<ServoOutputs>(), &outputs);
}

Wires Nothing() {
  const ServoInputs inputs;
  return ToPython(TypeOf<ServoInputs>(), &inputs);
}

}  // namespace

py::dtype LayoutOfAnswers() {
  static_assert(offsetof(PlantAnswer, wires) == 0);
  std::vector<Column> columns = ColumnsOf(TypeOf<ServoInputs>());
  const Type* const real = std::ranges::find(columns, "torque_nm", &Column::name)->type;
  columns.push_back({"true_position", "", unit::u, offsetof(PlantAnswer, true_position), real});
  return LayoutOf(columns, sizeof(PlantAnswer));
}

void BindServo(py::module_& m) {
  m.def("servo_outputs", &Off, "What a drive is told, switched off: by name.");
  m.def("servo_inputs", &Nothing, "What a drive says when there is nothing to say: by name.");
  m.def("told_layout", [] { return LayoutOf(ColumnsOf(TypeOf<ServoOutputs>()), sizeof(ServoOutputs)); });
  m.def("measured_layout", &LayoutOfAnswers);
  using M = MovedServos;
  py::class_<M>(m, "MovedServos", "Drives, encoders and switches of axes that another physics moves.")
      .def(py::init<const py::bytes&, const std::string&, double, int>(), py::arg("text"), py::arg("file_name"),
           py::arg("period_s"), py::arg("steps"))
      .def("add", &M::Add, py::arg("axis"), py::arg("position"), py::arg("velocity"), py::arg("scale"), py::arg("zero"),
           py::arg("inertia"), py::arg("max_torque"), py::arg("brake_torque"))
      .def("start", &M::Start, "All as when power comes on; where the physics has to begin, m or rad.")
      .def("begin", &M::Begin, py::arg("told"))
      .def("ask", &M::Ask, py::arg("step"), py::arg("positions"), py::arg("velocities"), py::arg("feed_forward"),
           py::arg("torques").noconvert())
      .def("sense", &M::Sense, py::arg("positions"), py::arg("velocities"), py::arg("measured"))
      .def_property_readonly("torques", &M::torques)
      .def_property_readonly("limited", &M::limited);
  py::class_<Servo>(m, "Servo", "The simulated servo of an axis, with its encoder and switches.")
      .def(py::init<const py::bytes&, const std::string&, const std::string&>(), py::arg("text"), py::arg("file_name"),
           py::arg("axis"))
      .def("restart", &Servo::Restart, "Makes it stand as when power comes on.")
      .def("step", &Servo::Step, py::arg("period_s"), py::arg("told"), "One cycle: what the wires say at its end.");
}

}  // namespace takt::bindings
