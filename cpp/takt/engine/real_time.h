// Makes the calling thread a real-time thread while this object lives (EN-02).
#pragma once

#include <sched.h>

#include <optional>
#include <string>

namespace takt::engine {

class RealTimeThread {
 public:
  // Requests SCHED_FIFO with this priority, locks memory, touches the stack, and pins the thread to `cpu` if given.
  RealTimeThread(int priority, std::optional<int> cpu);
  ~RealTimeThread();
  RealTimeThread(const RealTimeThread&) = delete;
  RealTimeThread& operator=(const RealTimeThread&) = delete;

  // Returns what the system did not permit, and why; empty if it permitted everything.
  const std::string& refused() const { return refused_; }

 private:
  void Check(const std::string& what, int error);

  int policy_before_ = SCHED_OTHER;
  sched_param priority_before_{};
  cpu_set_t cpus_before_{};
  std::string refused_;
};

}  // namespace takt::engine
