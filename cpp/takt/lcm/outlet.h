// Where encoded messages go: the network or a log file.
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
  // `utime` is the wall clock in µs. False: not taken. May block; never called by the cycle's thread.
  virtual bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) = 0;
  // Lets go of what is held back.
  virtual void Flush() {}
};

class NetworkOutlet : public Outlet {
 public:
  // `network` must outlive this. With a key, messages of tagged channels are tagged.
  explicit NetworkOutlet(::lcm::LCM& network, const std::optional<Key>& key = {});
  bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) override;

 private:
  ::lcm::LCM& network_;
  std::optional<Signer> signer_;
  std::vector<std::uint8_t> tagged_;
};

// An LCM log, as lcm-logger writes it. The first thing that cannot be written is said
// in one line on stderr.
class LogOutlet : public Outlet {
 public:
  explicit LogOutlet(const std::string& path);
  ~LogOutlet() override;
  // The file could be opened.
  bool good() const;
  bool Send(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utime) override;
  // Hands what is still held back to the system: it is in the file then, should the program be killed.
  void Flush() override;
  // Something could not be written.
  bool failed() const { return failed_; }

 private:
  void Fail();

  const std::string path_;
  std::unique_ptr<::lcm::LogFile> file_;
  bool failed_ = false;
};

// A log there, where nothing is yet, or an LCM log that nobody writes, or something that is no plain file. A log that
// is there is kept (EN-36): it gets the next free number, run.lcm becomes run.1.lcm, which is said in one line on
// stderr. Null: `problem` says why.
std::unique_ptr<LogOutlet> OpenLog(const std::string& path, std::string& problem);

}  // namespace takt::lcm
