// The Python module takt._core: one file per folder of cpp/takt, and what they share. Nothing here knows a command or a
// field by name: everything walks the descriptions.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "takt/core/columns.h"
#include "takt/core/describe.h"

namespace takt::bindings {

namespace py = pybind11;

// A single number, bool or enum (as its number).
py::object ScalarToPython(const Type& type, const void* object);

// The NumPy layout of an object of `size` bytes with these columns: numbers, bools and enums.
py::dtype LayoutOf(const std::vector<Column>& columns, std::size_t size);

// Raises takt.ConfigError.
[[noreturn]] void ThrowConfigError(const std::vector<std::string>& problems);

void BindCore(py::module_& m);
void BindCam(py::module_& m);
void BindAxis(py::module_& m);
void BindEngine(py::module_& m);

}  // namespace takt::bindings
