// EN-04: after start the cycle allocates nothing, takes no lock and makes no system call. Proven with every kind of
// component at work: the thread counts its calls of malloc and of pthread_mutex_lock, and a filter of the kernel
// reports every system call it makes.
#include <gtest/gtest.h>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <dlfcn.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <csignal>
#include <cstddef>
#include <thread>

#include "machines.h"

namespace {

thread_local bool watching = false;
thread_local long allocations = 0;
thread_local long locks = 0;
volatile std::sig_atomic_t system_calls = 0;
volatile std::sig_atomic_t last_system_call = 0;

}  // namespace

extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  if (watching) ++allocations;
  return __libc_malloc(size);
}
extern "C" int __pthread_mutex_lock(pthread_mutex_t* mutex);
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) {
  using Lock = int (*)(pthread_mutex_t*);
  static const Lock real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  if (watching) ++locks;
  return real(mutex);
}

namespace takt::engine {
namespace {

void CountSystemCall(int, siginfo_t* info, void*) {
  system_calls = system_calls + 1;
  last_system_call = info->si_syscall;
}

// From here on every system call of this thread ends in CountSystemCall, but for those a thread needs to end and to
// answer the signal.
bool WatchSystemCalls() {
  struct sigaction action {};
  action.sa_sigaction = CountSystemCall;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  constexpr unsigned kAllowed[] = {SYS_rt_sigreturn, SYS_exit, SYS_futex, SYS_munmap, SYS_madvise, SYS_rt_sigprocmask};
  std::vector<sock_filter> filter = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const unsigned allowed : kAllowed) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, allowed, 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

TEST(QuietCycle, AllocatesNothingLocksNothingCallsNobody) {
  const Machine machine = FullMachine();
  const auto commands = Scenario(machine);
  Engine engine(machine, {.publish = true, .every_cycle = true, .journal = true});
  bool filtered = false;
  bool moved = false;
  long cycle_allocations = -1;
  long cycle_locks = -1;
  std::thread thread([&] {
    filtered = WatchSystemCalls();
    watching = true;
    for (std::uint64_t c = 0; c < 3000; ++c) {
      for (const auto& [when, command] : commands) {
        if (when == c) engine.Submit(command);
      }
      engine.RunCycle({500, 5000, false});
      moved |= engine.outputs(AxisNamed(machine, "c")).set_velocity > 1000;
    }
    watching = false;
    cycle_allocations = allocations;
    cycle_locks = locks;
  });
  thread.join();
  EXPECT_TRUE(filtered) << "the kernel refused the filter: system calls were not watched";
  EXPECT_TRUE(moved);
  EXPECT_EQ(cycle_allocations, 0);
  EXPECT_EQ(cycle_locks, 0);
  EXPECT_EQ(system_calls, 0) << "the last one was number " << last_system_call;
}

// The watchers themselves see what they are there for.
TEST(QuietCycle, WatchersSee) {
  std::thread thread([] {
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    watching = true;
    free(malloc(10));
    pthread_mutex_lock(&mutex);
    pthread_mutex_unlock(&mutex);
    watching = false;
    EXPECT_EQ(allocations, 1);
    EXPECT_EQ(locks, 1);
    const int before = system_calls;
    if (WatchSystemCalls()) {
      syscall(SYS_getppid);
      EXPECT_EQ(system_calls, before + 1);
      EXPECT_EQ(last_system_call, SYS_getppid);
    }
  });
  thread.join();
  system_calls = 0;
}

}  // namespace
}  // namespace takt::engine

#endif
