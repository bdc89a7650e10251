// EN-04: after start the cycle allocates nothing, takes no lock and makes no system call. Proven with every kind of
// component in motion, with faults, full queues and a shutdown: the thread counts its calls of all allocating functions
// and of pthread_mutex_lock, and a kernel filter reports every system call that it makes.
#include <gtest/gtest.h>

#ifndef TAKT_SANITIZED

#include <dlfcn.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <thread>

#include "remote_plant.h"

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
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* calloc(std::size_t count, std::size_t size) {
  if (watching) ++allocations;
  return __libc_calloc(count, size);
}
extern "C" void* __libc_realloc(void* block, std::size_t size);
extern "C" void* realloc(void* block, std::size_t size) {
  if (watching) ++allocations;
  return __libc_realloc(block, size);
}
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (watching) ++allocations;
  return __libc_memalign(alignment, size);
}
extern "C" int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  if (watching) ++allocations;
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
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

// From here on every system call of this thread ends in CountSystemCall, except those that answering the signal and
// EndThread need.
bool WatchSystemCalls() {
  struct sigaction action {};
  action.sa_sigaction = CountSystemCall;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  constexpr unsigned kAllowed[] = {SYS_rt_sigreturn, SYS_exit};
  std::vector<sock_filter> filter = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const unsigned allowed : kAllowed) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, allowed, 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

// Bypasses the C library, whose thread exit makes more system calls than the filter permits.
void EndThread() {
  syscall(SYS_exit, 0);
}

TEST(QuietCycle, AllocatesNothingLocksNothingCallsNobody) {
  Machine machine = FullMachine();
  machine.external.drives = {{.axis = "z"}, {.axis = "y1"}};
  const auto commands = Scenario(machine);
  Engine engine(machine,
                {.publish = true, .every_cycle = true, .drives = true, .journal = true, .snapshot_queue = 4096});
  RemotePlant plant(machine);
  bool silent = false;
  plant.answers = [&](const DriveSample& s) { return !(silent && machine.axes[s.axis].name == "z"); };
  bool lost = false;
  bool filtered = false;
  bool moved = false;
  bool group_moved = false;
  bool failed = false;
  bool linked = false;
  bool made = false;
  std::atomic<bool> ended{false};
  std::atomic<long> rounds{0};  // of the thread that builds cams and tracks
  const Command flood = ToAxis(machine, "z", axis::Halt{});
  long cycle_allocations = -1;
  long cycle_locks = -1;
  std::thread thread([&] {
    filtered = WatchSystemCalls();
    watching = true;
    for (std::uint64_t c = 0; c < 5000; ++c) {
      for (const auto& [when, command] : commands) {
        if (when == c || when + 3000 == c) engine.Submit(command);  // the second time with full queues
      }
      if (c >= 2550 && c < 3200) {
        while (engine.Submit(flood)) {
        }
      }
      if (c == 3800) engine.RequestShutdown();
      silent = c >= 920 && c < 1200;                  // an external drive is lost in motion ...
      if (c < 4000 || c > 4100) plant.Serve(engine);  // ... and its set points have no reader
      lost |= engine.outputs(AxisNamed(machine, "z")).error == ErrorId::kDrive;
      // Cams and tracks must be built even if the host gives their thread no processor: this thread makes no system
      // calls, so it spins.
      if (c % 50 == 0) {
        for (const long now = rounds; rounds < now + 2;) {
        }
      }
      const bool late = c >= 2800 && c < 2800 + machine.cycle.overruns_in_a_row;
      engine.RunCycle({500, 5000, late});
      moved |= engine.outputs(AxisNamed(machine, "c")).set_velocity > 1000;
      group_moved |= engine.group_outputs(0).path_velocity > 100;
      made |= engine.flex_cam_outputs(0).cam_number > machine.cams.size();
      linked |= engine.tracks().outputs[1].length > 400 && engine.tracks().outputs[1].subsequent_tracks == 1;
      failed |= engine.outputs(AxisNamed(machine, "c")).error == ErrorId::kOverrun;
    }
    watching = false;
    cycle_allocations = allocations;
    cycle_locks = locks;
    EndThread();
  });
  std::thread maker([&] {
    while (!ended) {
      engine.MakeTracks();
      while (const auto result = engine.BuildCam()) engine.Answer(result->built);
      ++rounds;
    }
  });
  thread.join();
  ended = true;
  maker.join();
  EXPECT_TRUE(filtered) << "the kernel refused the filter: system calls were not watched";
  EXPECT_TRUE(moved);
  EXPECT_TRUE(group_moved);
  EXPECT_TRUE(failed);
  EXPECT_TRUE(linked);
  EXPECT_TRUE(made);
  EXPECT_TRUE(lost);
  EXPECT_GT(engine.figures().set_points_dropped, 0u);
  EXPECT_TRUE(engine.all_disabled());
  EXPECT_GT(engine.figures().snapshots_dropped, 0u);
  EXPECT_GT(engine.figures().feedback_dropped, 0u);
  EXPECT_GT(engine.figures().journal_dropped, 0u);
  EXPECT_GT(engine.figures().commands_refused, 0u);
  EXPECT_EQ(cycle_allocations, 0);
  EXPECT_EQ(cycle_locks, 0);
  EXPECT_EQ(system_calls, 0) << "the last one was number " << last_system_call;
}

// EN-04, PL-72: movers on routes that begin, are held, and are changed in motion.
TEST(QuietCycle, AllocatesNothingForRoutes) {
  LoadResult loaded =
      LoadMachine("name: plane\naxes: []\nmovers: [{name: a}, {name: b, initial: {x: 120}}]\n", "plane.yaml");
  ASSERT_TRUE(loaded.machine.has_value());
  const Machine machine = *loaded.machine;
  Engine engine(machine, {.publish = true, .journal = true});
  const auto along = [](int first, int places, int from, bool behind) {
    mover::SetRoute route{.first = static_cast<std::uint64_t>(first), .visits = {}};
    for (int k = 0; k < places; ++k) {
      mover::Visit visit{.x = 120.0 * (from + k)};
      if (behind && k > 0) visit.after = 2, visit.after_visit = static_cast<std::uint64_t>(first + k - 1);
      if (k == 0) visit.departure_time = 0;
      if (k == places - 1) visit.arrival_time = 1;
      route.visits.Add(visit);
    }
    return mover::Command(route);
  };
  const auto to = [](std::uint32_t target, const CommandBody& body) { return Command{.target = target, .body = body}; };
  const auto all = [](const MachineCommand& body) { return Command{.body = body}; };
  const std::vector<std::pair<int, Command>> commands = {
      {0, to(1, mover::Command(mover::Enable{}))},
      {0, to(2, mover::Command(mover::Enable{}))},
      {20, to(1, along(0, 6, 0, true))},
      {20, to(2, along(0, 7, 1, false))},
      {30, all(mover::StartRoutes{.velocity = 600})},
      {200, all(mover::HoldRoutes{})},
      {700, to(1, mover::Command(mover::Halt{}))},
      {750, to(1, mover::Command(mover::ContinueRoute{}))},
      {800, all(mover::HoldRoutes{.hold = false})},
      {801, all(mover::StartRoutes{})},
  };
  allocations = locks = 0;
  std::uint64_t hash = 0;
  watching = true;
  for (int cycle = 0; cycle < 4000; ++cycle) {
    for (const auto& [when, command] : commands) {
      if (when == cycle) engine.Submit(command);
    }
    engine.RunCycle();
    if (cycle % 100 == 0) hash ^= engine.StateHash();
  }
  watching = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  EXPECT_NE(hash, 0u);
  EXPECT_EQ(engine.mover_outputs(0).route_visit, 5u);
  EXPECT_EQ(engine.mover_outputs(1).route_visit, 6u);
}

// The detectors themselves work.
TEST(QuietCycle, WatchersSee) {
  std::thread thread([] {
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    watching = true;
    free(malloc(10));
    free(realloc(calloc(1, 10), 20));
    free(aligned_alloc(64, 64));
    void* block = nullptr;
    if (posix_memalign(&block, 64, 64) == 0) free(block);
    pthread_mutex_lock(&mutex);
    pthread_mutex_unlock(&mutex);
    watching = false;
    EXPECT_EQ(allocations, 5);
    EXPECT_EQ(locks, 1);
    const int before = system_calls;
    if (WatchSystemCalls()) {
      syscall(SYS_getppid);
      EXPECT_EQ(system_calls, before + 1);
      EXPECT_EQ(last_system_call, SYS_getppid);
    }
    EndThread();
  });
  thread.join();
  system_calls = 0;
}

}  // namespace
}  // namespace takt::engine

#endif
