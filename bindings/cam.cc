#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bindings.h"
#include "takt/cam/build.h"
#include "takt/cam/csv.h"
#include "takt/cam/extremes.h"
#include "takt/cam/laws.h"
#include "takt/core/binder.h"
#include "takt/core/schema.h"
#include "takt/core/writer.h"
#include "takt/core/yaml_reader.h"
#include "takt/engine/load.h"

namespace takt::bindings {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Pair = py::typing::Tuple<double, double>;                           // x, value
using Values = py::typing::Tuple<Array, Array, Array, Array>;             // y, dy, ddy, dddy
using Warned = py::typing::Tuple<cam::Table, py::typing::List<py::str>>;  // a table, what to know about it

Pair PairOf(const cam::Extreme& extreme) {
  return py::make_tuple(extreme.x, extreme.value);
}

template <typename E>
E EnumOf(std::string_view name) {
  const Enumerator* found = TypeOf<E>().FindEnumerator(name);
  if (found) return static_cast<E>(found->value);
  ThrowConfigError({"expected " + Expectation(TypeOf<E>(), nullptr) + ", found " + Quoted(name)});
}

// `where` stands before each path.
Warned Built(const cam::CamParams& params, const std::function<std::string(const cam::Finding&)>& text) {
  cam::Built built = cam::Build(params);
  std::vector<std::string> errors;
  for (const cam::Finding& finding : built.errors) errors.push_back(text(finding));
  if (!errors.empty()) ThrowConfigError(errors);
  py::typing::List<py::str> warnings;
  for (const cam::Finding& finding : built.warnings) warnings.append(text(finding));
  return py::make_tuple(std::move(*built.table), warnings);
}

std::string TextOf(const std::string& name, const cam::Finding& finding) {
  return name + ": " + (finding.path.empty() ? "" : finding.path + ": ") + finding.message;
}

std::vector<std::string> TextsOf(const std::vector<Problem>& problems) {
  std::vector<std::string> texts;
  for (const Problem& problem : problems) texts.push_back(problem.Text());
  return texts;
}

struct Options {
  std::string name;
  std::string interpolation;
  bool cyclic = false;
  std::string x_unit;
  std::string y_unit;
};

cam::CamParams ParamsOf(const Options& options) {
  cam::CamParams params;
  params.name = options.name;
  params.interpolation = EnumOf<cam::Interpolation>(options.interpolation);
  params.cyclic = options.cyclic;
  params.x_unit = options.x_unit;
  params.y_unit = options.y_unit;
  return params;
}

Warned FromPoints(const Array& x, const Array& y, const std::optional<Array>& v, const std::optional<Array>& a,
                  const std::string& name, const std::string& interpolation, bool cyclic, const std::string& x_unit,
                  const std::string& y_unit) {
  const auto check = [&](const Array& array, const char* which) {
    if (array.ndim() != 1) throw std::invalid_argument(std::string(which) + " must be an array of one dimension");
    if (array.size() != x.size()) {
      throw std::invalid_argument(std::string(which) + ": expected as many values as x has, " +
                                  std::to_string(x.size()) + ", found " + std::to_string(array.size()));
    }
  };
  check(x, "x");
  check(y, "y");
  if (v) check(*v, "v");
  if (a) check(*a, "a");
  cam::CamParams params = ParamsOf({name, interpolation, cyclic, x_unit, y_unit});
  const auto given = [](const std::optional<Array>& array, py::ssize_t i) {
    return array && !std::isnan(array->at(i)) ? std::optional(array->at(i)) : std::nullopt;
  };
  for (py::ssize_t i = 0; i < x.size(); ++i) params.points.push_back({x.at(i), y.at(i), given(v, i), given(a, i)});
  return Built(params, [&](const cam::Finding& finding) { return TextOf(name, finding); });
}

Warned FromCsv(const py::bytes& text, const std::string& file_name, const std::string& name,
               const std::string& interpolation, bool cyclic, const std::string& x_unit, const std::string& y_unit) {
  cam::CamParams params = ParamsOf({name, interpolation, cyclic, x_unit, y_unit});
  const cam::CsvPoints csv = cam::ReadCsv(static_cast<std::string_view>(text), file_name);
  if (!csv.problems.empty()) ThrowConfigError(TextsOf(csv.problems));
  params.points = csv.points;
  return Built(params, [&](const cam::Finding& finding) {
    return Problem{file_name, cam::PlaceInCsv(csv, finding.path), {}, finding.message}.Text();
  });
}

Warned FromYaml(const py::bytes& text, const std::string& file_name) {
  const ReadResult<cam::CamParams> read = ReadYaml<cam::CamParams>(static_cast<std::string_view>(text), file_name);
  if (!read.ok()) ThrowConfigError(TextsOf(read.problems));
  if (!read.value->file.empty()) ThrowConfigError({file_name + ": expected points or segments, found a file"});
  return Built(*read.value, [&](const cam::Finding& finding) {
    return read.source.ProblemAt(finding.path, finding.message).Text();
  });
}

py::typing::List<Warned> OfMachine(const py::bytes& text, const std::string& file_name) {
  engine::LoadResult loaded =
      engine::LoadMachine(static_cast<std::string_view>(text), file_name, engine::Workspaces::kSkip);
  if (!loaded.machine) ThrowConfigError(loaded.problems);
  py::typing::List<Warned> tables;
  for (const cam::CamParams& params : loaded.machine->cams) {
    tables.append(Built(params, [&](const cam::Finding& finding) { return TextOf(params.name, finding); }));
  }
  return tables;
}

Values At(const cam::Table& table, const Array& x) {
  const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
  Array y(shape), dy(shape), ddy(shape), dddy(shape);
  double *out_y = y.mutable_data(), *out_dy = dy.mutable_data();
  double *out_ddy = ddy.mutable_data(), *out_dddy = dddy.mutable_data();
  const std::span<const double> places(x.data(), static_cast<std::size_t>(x.size()));
  {
    const py::gil_scoped_release release;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const cam::Value value = table.At(places[i]);
      out_y[i] = value.y;
      out_dy[i] = value.dy;
      out_ddy[i] = value.ddy;
      out_dddy[i] = value.dddy;
    }
  }
  return py::make_tuple(y, dy, ddy, dddy);
}

py::typing::List<py::typing::Tuple<Pair, Pair>> Extremes(const cam::Table& table) {
  const cam::Extremes extremes = cam::ExtremesOf(table);
  py::typing::List<py::typing::Tuple<Pair, Pair>> list;
  for (const cam::Bounds& bounds : {extremes.y, extremes.dy, extremes.ddy, extremes.dddy}) {
    list.append(py::make_tuple(PairOf(bounds.least), PairOf(bounds.greatest)));
  }
  return list;
}

py::typing::Tuple<Pair, Pair, Pair, Pair> SlavePeaks(const cam::Table& table, double velocity, double acceleration) {
  if (!(velocity >= 0 && acceleration >= 0 && std::isfinite(velocity + acceleration))) {
    throw std::invalid_argument("the master's velocity and acceleration must be finite numbers, at least 0");
  }
  const cam::SlavePeaks peaks = cam::SlavePeaksOf(table, velocity, acceleration);
  return py::make_tuple(PairOf(peaks.position.least), PairOf(peaks.position.greatest), PairOf(peaks.velocity),
                        PairOf(peaks.acceleration));
}

py::array_t<double> ArrayOf(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

void CheckFinite(double value, const char* what) {
  if (!std::isfinite(value)) throw std::invalid_argument(std::string(what) + " must be a finite number");
}

py::array_t<double> AllX(const cam::Table& table, double y) {
  CheckFinite(y, "y");
  return ArrayOf(cam::AllX(table, y));
}

std::optional<double> NearestX(const cam::Table& table, double y, double near) {
  CheckFinite(y, "y");
  CheckFinite(near, "near");
  return cam::NearestX(table, y, near);
}

std::tuple<double, double, double> LawFactors(const std::string& law, double sine_share, double cosine_share) {
  if (!(sine_share >= 0 && cosine_share >= 0 && sine_share + cosine_share <= 1)) {
    throw std::invalid_argument("the shares of sine and cosine must be at least 0, and 1 at most together");
  }
  const cam::PeakFactors f = cam::PeakFactorsOf(EnumOf<cam::Law>(law), sine_share, cosine_share);
  return {f.velocity, f.acceleration, f.jerk};
}

py::array_t<double> JointsOf(const cam::Table& table) {
  std::vector<double> joints;
  for (std::size_t i = 0; i < table.size(); ++i) joints.push_back(table.BeginOf(i));
  joints.push_back(table.end());
  return ArrayOf(joints);
}

Values PointsOf(const cam::Table& table) {
  std::vector<double> x, y, v, a;
  for (const cam::CamPoint& point : table.source().points) {
    x.push_back(point.x);
    y.push_back(point.y);
    v.push_back(point.v.value_or(NAN));
    a.push_back(point.a.value_or(NAN));
  }
  return py::make_tuple(ArrayOf(x), ArrayOf(y), ArrayOf(v), ArrayOf(a));
}

}  // namespace

void BindCam(py::module_& m) {
  using T = cam::Table;
  py::class_<T>(m, "CamTable", "A cam, ready to be looked up.")
      .def_property_readonly("name", &T::name)
      .def_property_readonly("cyclic", &T::cyclic)
      .def_property_readonly("x_unit", [](const T& t) { return t.source().x_unit; })
      .def_property_readonly("y_unit", [](const T& t) { return t.source().y_unit; })
      .def_property_readonly("begin", &T::begin)
      .def_property_readonly("end", &T::end)
      .def_property_readonly("stroke", &T::stroke)
      .def_property_readonly("joints", &JointsOf)
      .def_property_readonly("points", &PointsOf)
      .def_property_readonly("source", [](const T& t) { return ToJson(TypeOf<cam::CamParams>(), &t.source()).dump(); })
      .def("at", &At, py::arg("x"))
      .def("extremes", &Extremes)
      .def("slave_peaks", &SlavePeaks, py::arg("master_velocity"), py::arg("master_acceleration"))
      .def("all_x", &AllX, py::arg("y"))
      .def("nearest_x", &NearestX, py::arg("y"), py::arg("near"))
      .def("to_csv", [](const T& t) { return cam::WriteCsv(t.source().points); })
      .def("to_yaml", [](const T& t) { return WriteYaml(t.source()); });
  m.def("cam_from_points", &FromPoints, py::arg("x"), py::arg("y"), py::arg("v"), py::arg("a"), py::arg("name"),
        py::arg("interpolation"), py::arg("cyclic"), py::arg("x_unit"), py::arg("y_unit"),
        "NaN in v and a: free. The table and warnings.");
  m.def("cam_from_csv", &FromCsv, py::arg("text"), py::arg("file_name"), py::arg("name"), py::arg("interpolation"),
        py::arg("cyclic"), py::arg("x_unit"), py::arg("y_unit"), "The table and warnings.");
  m.def("cam_from_yaml", &FromYaml, py::arg("text"), py::arg("file_name"), "The table and warnings.");
  m.def("cams_of_machine", &OfMachine, py::arg("text"), py::arg("file_name"),
        "The cams of a machine file, each with its warnings.");
  m.def("law_factors", &LawFactors, py::arg("law"), py::arg("sine_share") = 0.25, py::arg("cosine_share") = 0.5,
        "The largest velocity, acceleration and jerk of a law from (0, 0) to (1, 1).");
}

}  // namespace takt::bindings
