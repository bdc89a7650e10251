#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bindings.h"
#include "takt/engine/command.h"
#include "takt/lcm/authentication.h"
#include "takt/lcm/checksum.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/network.h"
#include "takt/lcm/network_log.h"
#include "takt/lcm/receiver.h"

namespace takt::bindings {
namespace {

// Text that holds the name of a file, whatever bytes that has.
py::object FromFileSystem(const std::string& text) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<Py_ssize_t>(text.size())));
}

std::unique_ptr<lcm::NetworkLog> OpenNetworkLog(const std::string& url, const py::bytes& path) {
  std::string problem;
  auto log = lcm::NetworkLog::Open(url, path, problem);
  if (!log) Throw("ConnectionError", FromFileSystem(problem));
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
        utime_ = heard.utime;
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
    if (receiver_->Handle(0) < 0) Fail("the server of the LCM network is gone");
    if (takers_.empty()) return py::none();
    return py::make_tuple(takers_, channel_, py::bytes(data_), utime_);
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
  std::int64_t utime_ = 0;
};

std::span<const std::uint8_t> BytesOf(const py::bytes& data) {
  const std::string_view bytes = data;
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

py::bytes ToBytes(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

py::bytes ReadKeys(const py::bytes& path) {
  std::string problem;
  const auto keys = lcm::ReadKeys(path, problem);
  if (!keys) Throw("KeyFileError", FromFileSystem(problem));
  std::vector<std::uint8_t> bytes(keys->own.begin(), keys->own.end());
  if (keys->other) bytes.insert(bytes.end(), keys->other->begin(), keys->other->end());
  return ToBytes(bytes);
}

py::bytes Sign(lcm::Signer& signer, const std::string& channel, const py::bytes& data) {
  const auto bytes = BytesOf(data);
  std::vector<std::uint8_t> message(bytes.begin(), bytes.end());
  signer.Sign(channel, message);
  return ToBytes(message);
}

py::typing::Tuple<lcm::TagState, py::bytes> OpenTagged(lcm::Verifier& verifier, const std::string& channel,
                                                       const py::bytes& data, std::optional<std::int64_t> heard_us) {
  auto bytes = BytesOf(data);
  const lcm::TagState state = verifier.Open(channel, bytes, heard_us.value_or(lcm::WallClockUs()));
  return py::make_tuple(state, ToBytes(bytes));
}

void BindAuthentication(py::module_& m) {
  py::enum_<lcm::TagState>(m, "TagState", "What became of the authentication tag of a message.")
      .value("good", lcm::TagState::kGood)
      .value("untagged", lcm::TagState::kMissing)
      .value("wrong_key", lcm::TagState::kForeign)
      .value("replayed", lcm::TagState::kReplayed)
      .value("stale", lcm::TagState::kStale);
  m.def("tag_text", &lcm::Text, py::arg("state"), "What is wrong with a tag, for people.");
  m.def("read_keys", &ReadKeys, py::arg("path"),
        "The key in a file; while it is changed the two, one behind the other, of which the first tags what is sent. "
        "Raises KeyFileError, which says why there is none.");
  m.def("is_tagged_channel", &lcm::IsTaggedChannel, py::arg("channel"),
        "With a key, messages on this channel carry a tag.");
  m.def(
      "has_tag", [](const py::bytes& data) { return lcm::HasTag(BytesOf(data)); }, py::arg("data"),
      "The bytes end like a tag, good or not.");
  py::class_<lcm::Signer>(m, "Signer", "Tags the messages of one sender.")
      .def(py::init([](const py::bytes& key) { return std::make_unique<lcm::Signer>(KeysOf(key).own); }),
           py::arg("key"))
      .def("sign", &Sign, py::arg("channel"), py::arg("data"), "The message with a tag behind it.");
  py::class_<lcm::Verifier>(m, "Verifier", "Checks the tags of what one receiver hears.")
      .def(py::init([](const py::bytes& key) { return std::make_unique<lcm::Verifier>(KeysOf(key)); }), py::arg("key"))
      .def("open", &OpenTagged, py::arg("channel"), py::arg("data"), py::arg("heard_us") = py::none(),
           "State of the tag of a message that came at this time [us, wall clock; now], and the message: without the "
           "tag "
           "where that is good.");
}

}  // namespace

lcm::Keys KeysOf(const py::bytes& data) {
  const auto bytes = BytesOf(data);
  if (bytes.size() != lcm::kKeyBytes && bytes.size() != 2 * lcm::kKeyBytes) {
    throw py::value_error("expected one key of " + std::to_string(lcm::kKeyBytes) + " bytes, or two");
  }
  lcm::Keys keys;
  std::ranges::copy(bytes.first(lcm::kKeyBytes), keys.own.begin());
  if (bytes.size() > lcm::kKeyBytes) std::ranges::copy(bytes.last(lcm::kKeyBytes), keys.other.emplace().begin());
  return keys;
}

void BindLcm(py::module_& m) {
  BindAuthentication(m);
  py::class_<lcm::NetworkLog>(m, "NetworkLog", "Writes what is said on an LCM network into an LCM log, without gaps.")
      .def(py::init(&OpenNetworkLog), py::arg("url"), py::arg("path"))
      .def(
          "close", &Close, py::arg("patience_s"),
          "Ends it when all that was said before is written. False: that took longer than the patience, or the file is "
          "incomplete.");
  m.def(
      "checksum_holds",
      [](const std::string& channel, const py::bytes& data) -> std::optional<bool> {
        const auto state = lcm::CheckChecksum(channel, BytesOf(data));
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
                            "where it cannot be joined, OSError when it is lost later.")
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
           "The next message that waits: (numbers of subscriptions, channel, bytes, when it came [us, wall clock]); "
           "None: "
           "there is none.")
      .def("fileno", &PythonNetwork::file, "Readable while messages wait.")
      .def_property_readonly("malformed", &PythonNetwork::malformed,
                             "Datagrams that were none of LCM's, or from elsewhere where only this host is heard.");
}

}  // namespace takt::bindings
