#include "takt/lcm/outlet.h"

#include <lcm/lcm-cpp.hpp>

namespace takt::lcm {

bool NetworkOutlet::Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t) {
  return network_.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size())) == 0;
}

LogOutlet::LogOutlet(const std::string& path) : file_(std::make_unique<::lcm::LogFile>(path, "w")) {}

LogOutlet::~LogOutlet() = default;

bool LogOutlet::good() const {
  return file_->good();
}

bool LogOutlet::Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) {
  ::lcm::LogEvent event{};
  event.timestamp = utime;
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(bytes.size());
  event.data = const_cast<std::uint8_t*>(bytes.data());  // only read
  return file_->writeEvent(&event) == 0;
}

}  // namespace takt::lcm
