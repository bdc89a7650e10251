// The Python module takt._core: one file per folder of cpp/takt, and what they share. Nothing here knows a command or a
// field by name: everything walks the descriptions.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <pybind11/typing.h>

#include <limits>
#include <string>
#include <vector>

#include "takt/core/columns.h"
#include "takt/core/describe.h"
#include "takt/core/ports.h"
#include "takt/engine/load.h"
#include "takt/lcm/key.h"

namespace takt::bindings {

namespace py = pybind11;

// What a plant in this process says of one axis: the wires, and where the load really is (u; NaN: it does not say).
struct PlantAnswer {
  ServoInputs wires;
  double true_position = std::numeric_limits<double>::quiet_NaN();
};
py::dtype LayoutOfAnswers();

// Raises takt.ConfigError with these sentences.
[[noreturn]] void ThrowConfigError(const std::vector<std::string>& problems);

// A single number, bool or enum (as its number).
py::object ScalarToPython(const Type& type, const void* object);

// The NumPy layout of an object of `size` bytes with these columns: numbers, bools and enums.
py::dtype LayoutOf(const std::vector<Column>& columns, std::size_t size);

// A described struct of numbers as dicts and lists, internal fields too.
py::object ToPython(const Type& type, const void* object);
// And back, for structs of nothing but numbers; integers are taken modulo their size, what is not given stays.
void FromPython(const Type& type, const py::dict& values, void* object);

// Raises an exception of takt.errors.
[[noreturn]] void Throw(const char* kind, const py::object& about);

// Keys that takt._core.read_keys has read. Raises ValueError where they are none.
lcm::Keys KeysOf(const py::bytes& data);

// A machine file: there is a machine in it, or takt.ConfigError says every problem.
// `workspaces`: what knows whether paths are free is made, too.
engine::LoadResult Load(const py::bytes& text, const std::string& file_name, bool workspaces,
                        engine::Files files = engine::Files::kOpen);

void BindCore(py::module_& m);
void BindCam(py::module_& m);
void BindKinematics(py::module_& m);
void BindAxis(py::module_& m);
void BindEngine(py::module_& m);
void BindTrack(py::module_& m);
void BindRouting(py::module_& m);
void BindServo(py::module_& m);
void BindLcm(py::module_& m);

}  // namespace takt::bindings
