#include <pybind11/stl.h>

#include <chrono>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bindings.h"
#include "takt/engine/command.h"
#include "takt/lcm/checksum.h"
#include "takt/lcm/network.h"
#include "takt/lcm/network_log.h"
#include "takt/lcm/receiver.h"

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

// A member of an LCM network for Python clients (takt/network.py): handlers are Python's, by number of subscription.
class PythonNetwork {
 public:
  explicit PythonNetwork(const std::string& url) {
    lcm::Network network;
    {
      const py::gil_scoped_release others_go_on;
      network = lcm::OpenNetwork(url);
    }
    if (!network.lcm) Throw("ConnectionError", py::str(network.problem));
    sender_ = std::move(network.lcm);
    std::string problem;
    receiver_ = lcm::OpenReceiver(url, *sender_, problem);
    if (!receiver_) Throw("ConnectionError", py::str(problem));
  }

  void Publish(const std::string& channel, const py::bytes& data) {
    const std::string_view bytes = data;
    if (sender_->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) != 0) Fail("message is not sent");
  }

  int Subscribe(const std::string& channels, std::size_t capacity) {
    try {
      auto number = std::make_shared<int>(0);
      *number = receiver_->Subscribe(channels, capacity, [this, number](const lcm::Heard& heard) {
        channel_ = heard.channel;
        data_.assign(heard.data.begin(), heard.data.end());
        takers_.push_back(*number);
      });
      return *number;
    } catch (const std::regex_error& error) {
      throw py::value_error("channels " + channels + ": " + error.what());
    }
  }

  void Unsubscribe(int number) { receiver_->Unsubscribe(number); }
  void SetCapacity(int number, std::size_t capacity) { receiver_->SetCapacity(number, capacity); }

  // Does not wait, and keeps the interpreter's lock: a thread that asks for the lock while the interpreter ends is
  // unwound by force, which C++ answers by ending the process. Python waits for the file.
  py::object Receive() {
    takers_.clear();
    if (receiver_->Handle(0) < 0) Fail("network's server is gone");
    if (takers_.empty()) return py::none();
    return py::make_tuple(takers_, channel_, py::bytes(data_));
  }

  int file() const { return receiver_->file(); }
  std::uint64_t malformed() const { return receiver_->malformed(); }

 private:
  [[noreturn]] static void Fail(const char* what) {
    PyErr_SetString(PyExc_OSError, what);
    throw py::error_already_set();
  }

  std::unique_ptr<::lcm::LCM> sender_;
  std::unique_ptr<lcm::Receiver> receiver_;  // of networks other than udpm:// by the sender's LCM
  std::vector<int> takers_;
  std::string channel_, data_;
};

}  // namespace

void BindLcm(py::module_& m) {
  py::class_<lcm::NetworkLog>(m, "NetworkLog", "Writes what is said on an LCM network into an LCM log, without gaps.")
      .def(py::init(&OpenNetworkLog), py::arg("url"), py::arg("path"))
      .def(
          "close", &Close, py::arg("patience_s"),
          "Ends it when all that was said before is written. False: that took longer than the patience, or the file is "
          "incomplete.");
  m.def(
      "checksum_holds",
      [](const std::string& channel, const py::bytes& data) -> std::optional<bool> {
        const std::string_view bytes = data;
        const auto state =
            lcm::CheckChecksum(channel, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
        if (state == lcm::ChecksumState::kNone) return {};
        return state == lcm::ChecksumState::kHolds;
      },
      py::arg("channel"), py::arg("data"),
      "The data of a log's event are as taktd wrote them; None: there is no checksum in them.");
  m.def(
      "lets_go",
      [](const std::string& kind, const std::string& verb, const std::string& arguments) {
        return engine::LetsGo(kind, verb, arguments);
      },
      py::arg("kind"), py::arg("verb"), py::arg("arguments"),
      "The command of this kind of component stops something, releases it or switches it off: it is always taken.");
  py::class_<PythonNetwork>(m, "Network",
                            "A member of an LCM network; on udpm:// any datagram is survived. Raises ConnectionError "
                            "where it cannot be joined, OSError where it is gone later.")
      .def(py::init<const std::string&>(), py::arg("url"))
      .def("publish", &PythonNetwork::Publish, py::arg("channel"), py::arg("data"), "Sends the bytes of a message.")
      .def("subscribe", &PythonNetwork::Subscribe, py::arg("channels"), py::arg("capacity"),
           "Hears the channels that this regular expression matches; returns the number of the subscription. Of more "
           "messages than `capacity` (0: any number) the newest are dropped. Raises ValueError where it is no "
           "expression.")
      .def("unsubscribe", &PythonNetwork::Unsubscribe, py::arg("number"))
      .def("set_capacity", &PythonNetwork::SetCapacity, py::arg("number"), py::arg("capacity"),
           "Of more messages that wait than this (0: any number) the newest are dropped from now on.")
      .def("receive", &PythonNetwork::Receive,
           "The next message that waits: (numbers of subscriptions, channel, bytes); None if there is none.")
      .def("fileno", &PythonNetwork::file, "Readable while messages wait.")
      .def_property_readonly("malformed", &PythonNetwork::malformed,
                             "Datagrams that were none of LCM's, or from elsewhere where only this host is heard.");
}

}  // namespace takt::bindings
