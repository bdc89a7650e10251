#include "takt/lcm/service.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "takt/engine/scheduler.h"
#include "takt/lcm/channels.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

using namespace std::chrono_literals;

// The messages that a client has received.
struct Received {
  std::map<std::int64_t, msgs::feedback> last;  // by id
  double position = 0;
  std::set<std::string> channels;

  static void OnFeedback(const ::lcm::ReceiveBuffer*, const std::string&, const msgs::feedback* m, Received* r) {
    r->last[m->id] = *m;
  }
  static void OnAxis(const ::lcm::ReceiveBuffer*, const std::string&, const msgs::axis_state* m, Received* r) {
    r->position = m->set_position;
  }
  static void OnAny(const ::lcm::ReceiveBuffer*, const std::string& channel, Received* r) {
    r->channels.insert(channel);
  }
};

// EN-20, EN-22, EN-25: a client on the same host, over UDP.
TEST(Service, AClientMovesAnAxisOverTheNetwork) {
  engine::Engine engine(TestMachine(), {.publish = true});
  std::string problem;
  const std::string url = NewUrl();
  const auto service = Service::Open(engine, {.url = url, .info = {.run_id = kRunId}}, problem);
  ASSERT_TRUE(service) << problem;
  std::atomic<int> signals{0};
  engine::RunResult result;
  std::thread cycle([&] { result = takt::engine::Run(engine, {.pace = engine::Pace::kPaced}, signals); });

  const Network client = OpenNetwork(url);
  ASSERT_TRUE(client.lcm) << client.problem;
  Received received;
  client.lcm->subscribeFunction(kFeedbackChannel, &Received::OnFeedback, &received);
  client.lcm->subscribeFunction("takt/axis/x", &Received::OnAxis, &received);
  client.lcm->subscribeFunction("takt/.*", &Received::OnAny, &received);
  auto& [last, position, channels] = received;
  std::int64_t id = 0;
  const auto give = [&](const std::string& verb, const std::string& arguments) {
    msgs::command m{};
    m.run_id = kRunId;
    m.client = "test";
    m.session = 1;
    m.id = ++id;
    m.target = "x";
    m.verb = verb;
    m.arguments = arguments;
    const auto until = std::chrono::steady_clock::now() + 5s;
    while (std::chrono::steady_clock::now() < until) {  // repeatedly: harmless
      client.lcm->publish(kCommandChannel, &m);
      for (int i = 0; i < 20; ++i) client.lcm->handleTimeout(5);
      if (last.contains(id) && IsFinal(static_cast<FeedbackState>(last[id].state))) return last[id].state;
    }
    return std::int8_t{-1};
  };
  EXPECT_EQ(give("power", ""), msgs::feedback::STATE_DONE) << last[id].sentence;
  EXPECT_EQ(give("move_relative", "{distance: 7}"), msgs::feedback::STATE_DONE) << last[id].sentence;
  for (int i = 0; i < 50; ++i) client.lcm->handleTimeout(5);
  EXPECT_NEAR(position, 7, 1e-6);  // given once, regardless of the repetitions
  EXPECT_EQ(give("move_relative", "{distance: much}"), msgs::feedback::STATE_ERROR);
  EXPECT_FALSE(last[id].sentence.empty());
  const auto until = std::chrono::steady_clock::now() + 2s;
  while (!channels.contains(kMachineChannel) && std::chrono::steady_clock::now() < until) client.lcm->handleTimeout(50);
  for (const char* channel : {"takt/axis/x", "takt/axis/y", kEngineChannel, kMachineChannel, kFeedbackChannel}) {
    EXPECT_TRUE(channels.contains(channel)) << channel;
  }
  signals = 1;
  cycle.join();
  EXPECT_EQ(result.end, engine::RunEnd::kStopped);
}

// EN-08, EN-20: the log is closed in order and reads back.
TEST(Service, TheLogReadsBack) {
  const TemporaryFile log("takt_service_test.lcmlog");
  engine::Engine engine(TestMachine(), {.publish = true, .every_cycle = true, .journal = true});
  std::string problem;
  const auto service = Service::Open(engine, {.log_path = log.path, .info = {"name: test", "1", 2}}, problem);
  ASSERT_TRUE(service) << problem;
  const std::atomic<int> signals{0};
  takt::engine::Run(engine, {.pace = engine::Pace::kFast, .duration_s = 20, .wait_for_reader = true}, signals);
  const Losses losses = service->Close();
  EXPECT_EQ(losses.messages, 0u);
  EXPECT_FALSE(losses.log);
  EXPECT_EQ(engine.figures().snapshots_dropped, 0u);

  ::lcm::LogFile file(log.path, "r");
  ASSERT_TRUE(file.good());
  std::map<std::string, int> counts;
  std::int64_t last_timestamp = 0, hashes = 0;
  for (const ::lcm::LogEvent* event = file.readNextEvent(); event != nullptr; event = file.readNextEvent()) {
    ++counts[event->channel];
    EXPECT_GE(event->timestamp, last_timestamp);
    last_timestamp = event->timestamp;
    if (event->channel == kJournalHashesChannel) {
      msgs::journal_hashes m{};
      ASSERT_GT(m.decode(event->data, 0, event->datalen), 0);
      hashes += m.count;
    }
  }
  EXPECT_EQ(counts["takt/axis/x"], 20'000);
  EXPECT_EQ(counts["takt/axis/y"], 20'000);
  EXPECT_EQ(counts[kJournalStartChannel], 1);
  EXPECT_EQ(counts[kMachineChannel], 1);
  EXPECT_EQ(hashes, 20'000);
}

TEST(Service, ALogThatCannotBeWrittenIsSaidInOneLine) {
  engine::Engine engine(TestMachine());
  std::string problem;
  EXPECT_FALSE(Service::Open(engine, {.log_path = "/no/such/folder/log"}, problem));
  EXPECT_EQ(problem, "log file /no/such/folder/log cannot be written: No such file or directory");
}

// EN-07, EN-20: a log with losses is an error, reported in one line when it first occurs.
TEST(Service, ADiskThatIsFullIsSaidInOneLine) {
  engine::Engine engine(TestMachine(), {.publish = true, .every_cycle = true, .journal = true});
  std::string problem;
  testing::internal::CaptureStderr();
  const auto service = Service::Open(engine, {.log_path = "/dev/full"}, problem);
  ASSERT_TRUE(service) << problem;
  for (int i = 0; i < 1000; ++i) engine.RunCycle();
  EXPECT_TRUE(service->Close().log);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "log file /dev/full is incomplete: No space left on device\n");
}

// The small rest in the buffer is only lost at the end.
TEST(Service, ADiskThatIsFullAtTheEndIsSaid) {
  engine::Engine engine(TestMachine());
  std::string problem;
  const auto service = Service::Open(engine, {.log_path = "/dev/full"}, problem);
  ASSERT_TRUE(service) << problem;
  EXPECT_TRUE(service->Close().log);
}

TEST(Service, AFileThatIsNoLogIsNotOverwritten) {
  engine::Engine engine(TestMachine());
  const TemporaryFile file("takt_service_test.yaml");
  std::string problem;
  std::ofstream(file.path) << "name: test\n";
  EXPECT_FALSE(Service::Open(engine, {.log_path = file.path}, problem));
  EXPECT_EQ(problem, "log file " + file.path + " exists and is no LCM log; it is left as it is");
  EXPECT_EQ(std::filesystem::file_size(file.path), 11u);
  std::filesystem::resize_file(file.path, 0);
  EXPECT_TRUE(Service::Open(engine, {.log_path = file.path}, problem));
  EXPECT_GT(std::filesystem::file_size(file.path), 100u);
  EXPECT_TRUE(Service::Open(engine, {.log_path = file.path}, problem));  // now it is one
}

TEST(Network, WrongUrlsAreSaidInOneLine) {
  for (const char* url :
       {"", "nonsense", "http://example", "udpm://", "udpm://239.255.76.67", "udpm://239.255.76.67:0",
        "udpm://239.255.76.67:99999", "udpm://somewhere:7667", "udpm://10.0.0.1:7667", "udpm://239.255.76.67:7667x"}) {
    const Network network = OpenNetwork(url);
    EXPECT_FALSE(network.lcm) << url;
    EXPECT_NE(network.problem.find(url), std::string::npos);
    EXPECT_NE(network.problem.find("udpm://239.255.76.67:7667?ttl=0"), std::string::npos);
    EXPECT_EQ(network.problem.find('\n'), std::string::npos);
  }
}

// No network: in a network namespace without an interface that is up, a child process tries to join.
TEST(Network, AnAbsentNetworkNamesTheRouteCommand) {
  const pid_t child = fork();
  if (child == 0) {
    if (unshare(CLONE_NEWNET) != 0) _exit(77);
    const Network network = OpenNetwork(NewUrl());
    _exit(!network.lcm && network.problem.find("ip route add 224.0.0.0/4 dev lo") != std::string::npos &&
                  network.problem.find('\n') == std::string::npos
              ? 0
              : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "no right to make a network of one's own";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace takt::lcm
