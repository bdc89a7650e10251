#include "takt/lcm/outlet.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>

namespace takt::lcm {
namespace {

bool MayBecomeLog(const std::string& path) {
  constexpr std::array<char, 4> kSyncWord = {'\xED', '\xA1', '\xDA', '\x01'};  // before every event of a log
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return true;
  std::array<char, 4> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return file.gcount() == 0 || begin == kSyncWord;
}

// The writer of a log holds a lock on it: two writers would corrupt it.
bool IsTaken(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  const int file = open(path.c_str(), O_WRONLY);
  if (file < 0) return false;
  const bool taken = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return taken;
}

// Renames an existing log to an unused name. Returns false, with errno set, on failure.
bool KeepOld(const std::string& path) {
  std::error_code none;
  const std::filesystem::path old = path;
  if (!std::filesystem::is_regular_file(old, none) || std::filesystem::file_size(old, none) == 0) return true;
  for (int number = 1; number > 0; ++number) {
    std::filesystem::path kept = old;
    kept.replace_filename(old.stem().string() + "." + std::to_string(number) + old.extension().string());
    if (link(old.c_str(), kept.c_str()) != 0) {  // unlike rename(), it replaces nothing
      if (errno == EEXIST) continue;
      return false;
    }
    std::fprintf(stderr, "log file %s is there already: kept as %s\n", path.c_str(), kept.c_str());
    return unlink(old.c_str()) == 0;
  }
  return false;
}

}  // namespace

NetworkOutlet::NetworkOutlet(::lcm::LCM& network, const std::optional<Key>& key) : network_(network) {
  if (key) signer_.emplace(*key);
}

bool NetworkOutlet::Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t) {
  if (signer_ && IsTaggedChannel(channel)) {
    tagged_.assign(bytes.begin(), bytes.end());
    signer_->Sign(channel, tagged_);
    bytes = tagged_;
  }
  return network_.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size())) == 0;
}

LogOutlet::LogOutlet(const std::string& path) : path_(path), file_(std::make_unique<::lcm::LogFile>(path, "w")) {
  if (good()) flock(fileno(file_->getFilePtr()), LOCK_EX | LOCK_NB);  // until it is closed
}

LogOutlet::~LogOutlet() = default;

bool LogOutlet::good() const {
  return file_->good();
}

bool LogOutlet::Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) {
  ::lcm::LogEvent event{};
  event.timestamp = utime;
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(bytes.size());
  event.data = const_cast<std::uint8_t*>(bytes.data());  // not modified
  if (file_->writeEvent(&event) == 0) return true;
  Fail();
  return false;
}

void LogOutlet::Flush() {
  std::FILE* file = file_->getFilePtr();
  if (std::fflush(file) != 0 || std::ferror(file) != 0) Fail();
}

void LogOutlet::Fail() {
  if (!failed_) std::fprintf(stderr, "log file %s is incomplete: %s\n", path_.c_str(), std::strerror(errno));
  failed_ = true;
}

std::unique_ptr<LogOutlet> OpenLog(const std::string& path, std::string& problem) {
  if (!MayBecomeLog(path)) {
    problem = "log file " + path + " exists and is no LCM log; it is left as it is";
    return nullptr;
  }
  if (IsTaken(path)) {
    problem = "log file " + path + " is being written already";
    return nullptr;
  }
  if (KeepOld(path)) {
    auto log = std::make_unique<LogOutlet>(path);
    if (log->good()) return log;
  }
  problem = "log file " + path + " cannot be written: " + std::strerror(errno);
  return nullptr;
}

}  // namespace takt::lcm
