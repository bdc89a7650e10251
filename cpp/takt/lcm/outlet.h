// Destinations of encoded messages: the network or a log file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "takt/lcm/authentication.h"

namespace lcm {
class LCM;
class LogFile;
}  // namespace lcm

namespace takt::lcm {

class Outlet {
 public:
  virtual ~Outlet() = default;
  // `utime`: wall clock [µs]. Returns false if the message was not accepted. May block; never called by the cycle's
  // thread.
  virtual bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) = 0;
  // Writes out buffered messages.
  virtual void Flush() {}
};

class NetworkOutlet : public Outlet {
 public:
  // `network` must outlive this object. With a key, messages of tagged channels are tagged.
  explicit NetworkOutlet(::lcm::LCM& network, const std::optional<Key>& key = {});
  bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) override;

 private:
  ::lcm::LCM& network_;
  std::optional<Signer> signer_;
  std::vector<std::uint8_t> tagged_;
};

// An LCM log, as lcm-logger writes it. The first write error is reported in one line on stderr.
class LogOutlet : public Outlet {
 public:
  explicit LogOutlet(const std::string& path);
  ~LogOutlet() override;
  // Returns true if the file could be opened.
  bool good() const;
  bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) override;
  // Passes buffered data to the operating system, so that it is in the file even if the program is killed.
  void Flush() override;
  // Returns true if something could not be written.
  bool failed() const { return failed_; }

 private:
  void Fail();

  const std::string path_;
  std::unique_ptr<::lcm::LogFile> file_;
  bool failed_ = false;
};

// Opens a log at this path if nothing is there, or an LCM log that no process is writing, or something that is not a
// regular file. An existing log is kept (EN-36): it gets the next free number, run.lcm becomes run.1.lcm, which is
// reported in one line on stderr. Returns null, and the reason in `problem`, on failure.
std::unique_ptr<LogOutlet> OpenLog(const std::string& path, std::string& problem);

}  // namespace takt::lcm
