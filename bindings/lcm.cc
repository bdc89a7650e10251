#include <chrono>
#include <memory>
#include <string>

#include "bindings.h"
#include "takt/lcm/network_log.h"

namespace takt::bindings {
namespace {

std::unique_ptr<lcm::NetworkLog> OpenNetworkLog(const std::string& url, const py::bytes& path) {
  std::string problem;
  auto log = lcm::NetworkLog::Open(url, path, problem);
  if (!log) {
    const auto text = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeFSDefaultAndSize(problem.data(), static_cast<Py_ssize_t>(problem.size())));
    Throw("ConnectionError", text);
  }
  return log;
}

bool Close(lcm::NetworkLog& log, double patience_s) {
  const py::gil_scoped_release others_go_on;
  return log.Close(std::chrono::milliseconds(static_cast<std::int64_t>(patience_s * 1000)));
}

}  // namespace

void BindLcm(py::module_& m) {
  py::class_<lcm::NetworkLog>(m, "NetworkLog", "Writes what is said on an LCM network into an LCM log, without gaps.")
      .def(py::init(&OpenNetworkLog), py::arg("url"), py::arg("path"))
      .def(
          "close", &Close, py::arg("patience_s"),
          "Ends it when all that was said before is written. False: that took longer than the patience, or the file is "
          "incomplete.");
}

}  // namespace takt::bindings
