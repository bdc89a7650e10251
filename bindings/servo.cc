#include <stdexcept>
#include <string>

#include "bindings.h"
#include "takt/core/ports.h"
#include "takt/plant/servo.h"

namespace takt::bindings {
namespace {

using Wires = py::typing::Dict<py::str, py::object>;

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
  static plant::ServoParams ParamsOf(const engine::Machine& machine, const std::string& axis) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i) {
      if (machine.axes[i].name == axis) return engine::ServoOf(machine, i);
    }
    throw std::invalid_argument("the machine has no axis " + axis);
  }

  const plant::ServoParams params_;
  plant::ServoState state_;
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

void BindServo(py::module_& m) {
  m.def("servo_outputs", &Off, "What a drive is told, switched off: by name.");
  m.def("servo_inputs", &Nothing, "What a drive says when there is nothing to say: by name.");
  py::class_<Servo>(m, "Servo", "The simulated servo of an axis, with its encoder and switches.")
      .def(py::init<const py::bytes&, const std::string&, const std::string&>(), py::arg("text"), py::arg("file_name"),
           py::arg("axis"))
      .def("restart", &Servo::Restart, "Makes it stand as when power comes on.")
      .def("step", &Servo::Step, py::arg("period_s"), py::arg("told"), "One cycle: what the wires say at its end.");
}

}  // namespace takt::bindings
