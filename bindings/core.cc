#include <pybind11/stl.h>

#include <bit>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "bindings.h"
#include "takt/core/drive_errors.h"
#include "takt/core/status.h"

namespace takt::bindings {

static_assert(std::endian::native == std::endian::little);

namespace {

std::map<int, std::pair<std::string, std::string>> ErrorTexts() {
  std::map<int, std::pair<std::string, std::string>> texts;
  for (const ErrorInfo& error : Errors()) {
    if (error.id == ErrorId::kNone) continue;
    texts[static_cast<int>(error.id)] = {std::string(error.name), std::string(error.text)};
  }
  return texts;
}

}  // namespace

void Throw(const char* kind, const py::object& about) {
  const py::object error = py::module_::import("takt.errors").attr(kind);
  PyErr_SetObject(error.ptr(), error(about).ptr());
  throw py::error_already_set();
}

void ThrowConfigError(const std::vector<std::string>& problems) {
  Throw("ConfigError", py::cast(problems));
}

py::object ScalarToPython(const Type& type, const void* object) {
  switch (type.kind) {
    case Kind::kBool:
      return py::bool_(IntegerAt(type, object) != 0);
    case Kind::kReal:
      return py::float_(*static_cast<const double*>(object));
    case Kind::kInteger:
      if (!type.is_signed) return py::int_(static_cast<std::uint64_t>(IntegerAt(type, object)));
      return py::int_(IntegerAt(type, object));
    case Kind::kEnum:
      return py::int_(IntegerAt(type, object));
    default:
      throw std::logic_error("not a number: " + std::string(type.name));
  }
}

py::object ToPython(const Type& type, const void* object) {
  switch (type.kind) {
    case Kind::kStruct: {
      py::dict dict;
      for (const Field& field : type.fields) dict[py::str(field.name)] = ToPython(*field.type, FieldAt(field, object));
      return dict;
    }
    case Kind::kArray: {
      py::list list;
      for (std::size_t i = 0; i < type.count; ++i) list.append(ToPython(*type.element, ElementAt(type, object, i)));
      return list;
    }
    default:
      return ScalarToPython(type, object);
  }
}

void FromPython(const Type& type, const py::dict& values, void* object) {
  for (const Field& field : type.fields) {
    const py::str name(field.name.data(), field.name.size());
    if (!values.contains(name)) continue;
    const py::object value = values[name];
    void* member = static_cast<std::byte*>(object) + field.offset;
    switch (field.type->kind) {
      case Kind::kReal:
        *static_cast<double*>(member) = value.cast<double>();
        break;
      case Kind::kBool:
        *static_cast<bool*>(member) = value.cast<bool>();
        break;
      case Kind::kInteger:
      case Kind::kEnum: {
        const auto bits = static_cast<std::uint64_t>(value.cast<std::int64_t>());
        std::memcpy(member, &bits, field.type->size);  // the low bytes come first
        break;
      }
      default:
        throw std::logic_error("not a number: " + std::string(field.name));
    }
  }
}

py::dtype LayoutOf(const std::vector<Column>& columns, std::size_t size) {
  py::list names, formats, offsets;
  for (const Column& column : columns) {
    std::string format;
    switch (column.type->kind) {
      case Kind::kBool:
        format = "?";
        break;
      case Kind::kReal:
        format = "f8";
        break;
      case Kind::kInteger:
      case Kind::kEnum:
        format = (column.type->is_signed ? "i" : "u") + std::to_string(column.type->size);
        break;
      default:
        throw std::logic_error("a recorded column must be a number: " + column.name);
    }
    names.append(column.name);
    formats.append(format);
    offsets.append(column.offset);
  }
  return py::dtype(names, formats, offsets, static_cast<py::ssize_t>(size));
}

void BindCore(py::module_& m) {
  m.def("drive_error_text", &DriveErrorText, py::arg("code"),
        "What the error code of a drive (CiA 402, 0x603F) means: its number, and in brackets the words.");
  m.def("error_texts", &ErrorTexts, "Every error number with its short name and its sentence.");
}

}  // namespace takt::bindings
