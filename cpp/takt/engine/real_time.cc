#include "takt/engine/real_time.h"

#include <pthread.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

namespace takt::engine {
namespace {

// The cycle's calls never go deeper than this; its pages are mapped before the first cycle.
[[gnu::noinline]] void TouchStack() {
  constexpr std::size_t kBytes = 256 * 1024;
  std::byte stack[kBytes];
  std::memset(stack, 0, kBytes);
  asm volatile("" : : "r"(stack) : "memory");  // keeps the compiler from removing the array
}

}  // namespace

RealTimeThread::RealTimeThread(int priority, std::optional<int> cpu) {
  const pthread_t self = pthread_self();
  pthread_getschedparam(self, &policy_before_, &priority_before_);
  pthread_getaffinity_np(self, sizeof cpus_before_, &cpus_before_);

  sched_param wanted{};
  wanted.sched_priority = priority;
  Check("SCHED_FIFO priority " + std::to_string(priority), pthread_setschedparam(self, SCHED_FIFO, &wanted));
  Check("locked memory", mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno);
  if (cpu) {
    cpu_set_t one;
    CPU_ZERO(&one);
    if (*cpu >= 0 && *cpu < CPU_SETSIZE) CPU_SET(static_cast<unsigned>(*cpu), &one);
    Check("CPU " + std::to_string(*cpu), pthread_setaffinity_np(self, sizeof one, &one));
  }
  TouchStack();
}

RealTimeThread::~RealTimeThread() {
  munlockall();
  pthread_setaffinity_np(pthread_self(), sizeof cpus_before_, &cpus_before_);
  pthread_setschedparam(pthread_self(), policy_before_, &priority_before_);
}

void RealTimeThread::Check(const std::string& what, int error) {
  if (error == 0) return;
  if (!refused_.empty()) refused_ += ", ";
  refused_ += what + " (" + std::strerror(error) + ")";
}

}  // namespace takt::engine
