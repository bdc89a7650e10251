// Where encoded messages go: the network or a log file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace lcm {
class LCM;
class LogFile;
}  // namespace lcm

namespace takt::lcm {

class Outlet {
 public:
  virtual ~Outlet() = default;
  // `utime` is the wall clock in µs. False: not taken. May block; never called by the cycle's thread.
  virtual bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) = 0;
};

class NetworkOutlet : public Outlet {
 public:
  // `network` must outlive this.
  explicit NetworkOutlet(::lcm::LCM& network) : network_(network) {}
  bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) override;

 private:
  ::lcm::LCM& network_;
};

// An LCM log, as lcm-logger writes it. An existing log is written anew. The first thing that cannot be written is said
// in one line on stderr.
class LogOutlet : public Outlet {
 public:
  explicit LogOutlet(const std::string& path);
  ~LogOutlet() override;
  // The file could be opened.
  bool good() const;
  bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) override;
  // Writes what is still held back.
  void Flush();
  // Something could not be written.
  bool failed() const { return failed_; }

 private:
  void Fail();

  const std::string path_;
  std::unique_ptr<::lcm::LogFile> file_;
  bool failed_ = false;
};

// A log there, where nothing is yet, or an LCM log that nobody writes, or something that is no plain file. Null:
// `problem` says why.
std::unique_ptr<LogOutlet> OpenLog(const std::string& path, std::string& problem);

}  // namespace takt::lcm
