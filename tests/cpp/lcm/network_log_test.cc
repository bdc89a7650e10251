#include "takt/lcm/network_log.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <thread>
#include <vector>

#include "test_machine.h"

namespace takt::lcm {
namespace {

using namespace std::chrono_literals;

// Returns the numbers sent on channel "n", as they are in a log.
std::vector<int> Said(const std::string& path) {
  std::vector<int> numbers;
  ::lcm::LogFile log(path, "r");
  for (const ::lcm::LogEvent* event = log.readNextEvent(); event != nullptr; event = log.readNextEvent()) {
    if (event->channel != "n") continue;
    int number = 0;
    std::memcpy(&number, event->data, sizeof number);
    EXPECT_GT(event->timestamp, 1'000'000'000'000'000) << "wall clock in us";
    numbers.push_back(number);
  }
  return numbers;
}

void Say(::lcm::LCM& network, int first, int last) {
  std::array<char, 300> bytes{};
  for (int i = first; i < last; ++i) {
    std::memcpy(bytes.data(), &i, sizeof i);
    network.publish("n", bytes.data(), bytes.size());
  }
}

std::vector<int> Numbers(int last) {
  std::vector<int> numbers;
  for (int i = 0; i < last; ++i) numbers.push_back(i);
  return numbers;
}

// EN-24: all messages sent before the log is closed are in it, and no others of the kind.
TEST(NetworkLog, HoldsAllThatWasSaidBeforeItWasClosed) {
  const TemporaryFile place("takt_network_log_");
  const std::string url = NewUrl();
  const Network client = OpenNetwork(url);
  std::string problem;
  const auto log = NetworkLog::Open(url, place.path, problem);
  ASSERT_TRUE(log) << problem;
  Say(*client.lcm, 0, 100);
  EXPECT_TRUE(log->Close(20s));
  EXPECT_TRUE(log->Close(0s)) << "closed already";
  Say(*client.lcm, 100, 110);
  EXPECT_EQ(Said(place.path), Numbers(100));
}

// EN-24: lcm-logger would hold 30 of them.
TEST(NetworkLog, HoldsAsManyAsComeWhileNobodyTakesThem) {
  const TemporaryFile pipe("takt_network_log_pipe_");
  const TemporaryFile place("takt_network_log_read_");
  ASSERT_EQ(mkfifo(pipe.path.c_str(), 0600), 0);
  const int end = open(pipe.path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(end, 0);
  ASSERT_EQ(fcntl(end, F_SETPIPE_SZ, 4096), 4096);
  ASSERT_EQ(fcntl(end, F_SETFL, 0), 0);  // blocks from now on
  const std::string url = NewUrl();
  const Network client = OpenNetwork(url);
  std::string problem;
  const auto log = NetworkLog::Open(url, pipe.path, problem);
  ASSERT_TRUE(log) << problem;
  constexpr int kMany = 100;  // the pipe holds two dozen, a socket buffer as systems give them more than these
  Say(*client.lcm, 0, kMany);
  std::this_thread::sleep_for(300ms);  // no reader during this time
  std::thread reader([&] {
    std::ofstream file(place.path, std::ios::binary);
    std::array<char, 4096> bytes;
    for (ssize_t count = read(end, bytes.data(), bytes.size()); count > 0;
         count = read(end, bytes.data(), bytes.size()))
      file.write(bytes.data(), count);
  });
  EXPECT_TRUE(log->Close(20s));
  reader.join();
  close(end);
  EXPECT_EQ(Said(place.path), Numbers(kMany)) << Said(place.path).size();
}

TEST(NetworkLog, IsClosedInOrderByWhoForgetsTo) {
  const TemporaryFile place("takt_network_log_left_");
  const std::string url = NewUrl();
  const Network client = OpenNetwork(url);
  std::string problem;
  { ASSERT_TRUE(NetworkLog::Open(url, place.path, problem)) << problem; }
  EXPECT_TRUE(std::filesystem::exists(place.path));
}

// A server of tcpq:// that accepts one client, and ends on request.
class Server {
 public:
  Server() : listening_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(listening_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    EXPECT_EQ(listen(listening_, 1), 0);
    url = "tcpq://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] {
      client_ = accept(listening_, nullptr, nullptr);
      std::array<char, 8> hello;
      EXPECT_EQ(recv(client_, hello.data(), hello.size(), MSG_WAITALL), 8);            // it comes in two parts
      const std::array<std::uint32_t, 2> answer = {htonl(0x287617fa), htonl(0x0100)};  // magic, version
      EXPECT_EQ(write(client_, answer.data(), 8), 8);
    });
  }
  ~Server() { GoAway(); }
  void GoAway() {
    if (!thread_.joinable()) return;
    thread_.join();
    close(client_);
    close(listening_);
  }
  std::string url;

 private:
  int listening_, client_ = -1;
  std::thread thread_;
};

// LCM itself ends a program that continues to listen to a lost server.
TEST(NetworkLog, SaysThatItsServerWentAway) {
  const TemporaryFile place("takt_network_log_server_");
  Server server;
  std::string problem;
  const auto log = NetworkLog::Open(server.url, place.path, problem);
  ASSERT_TRUE(log) << problem;
  server.GoAway();
  std::this_thread::sleep_for(500ms);  // it continues to listen
  EXPECT_FALSE(log->Close(1s));
}

TEST(Network, IsHandledWhenItsServerIsGone) {
  Server server;
  std::string problem;
  const auto network = OpenReceiver(server.url, problem);
  ASSERT_TRUE(network) << problem;
  server.GoAway();
  int heard = 0;
  for (int i = 0; i < 10; ++i) heard = network->Handle(10);
  EXPECT_LT(heard, 0);
}

// Two writers in one file would corrupt it.
TEST(NetworkLog, LeavesAloneWhatIsBeingWritten) {
  const TemporaryFile place("takt_network_log_twice_");
  const std::string url = NewUrl();
  const Network client = OpenNetwork(url);
  std::string problem;
  const auto log = NetworkLog::Open(url, place.path, problem);
  ASSERT_TRUE(log) << problem;
  EXPECT_FALSE(NetworkLog::Open(url, place.path, problem));
  EXPECT_EQ(problem, "log file " + place.path + " is being written already");
  Say(*client.lcm, 0, 20);
  EXPECT_TRUE(log->Close(20s));
  EXPECT_EQ(Said(place.path), Numbers(20));
}

// EN-36: an existing log is kept, each under its own name.
TEST(NetworkLog, ReplacesNoLog) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("takt_kept_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "run.lcm").string(), url = NewUrl();
  const Network client = OpenNetwork(url);
  std::string problem, said;
  for (int run = 1; run <= 3; ++run) {
    testing::internal::CaptureStderr();
    const auto log = NetworkLog::Open(url, path, problem);
    said += testing::internal::GetCapturedStderr();
    ASSERT_TRUE(log) << problem;
    Say(*client.lcm, 0, 10 * run);
    EXPECT_TRUE(log->Close(20s));
  }
  EXPECT_EQ(Said((folder / "run.1.lcm").string()), Numbers(10));
  EXPECT_EQ(Said((folder / "run.2.lcm").string()), Numbers(20));
  EXPECT_EQ(Said(path), Numbers(30));
  const std::string kept = "log file " + path + " is there already: kept as " + (folder / "run.").string();
  EXPECT_EQ(said, kept + "1.lcm\n" + kept + "2.lcm\n");
  std::filesystem::remove_all(folder);
}

TEST(NetworkLog, SaysWhyNot) {
  const TemporaryFile place("takt_network_log_text_");
  std::ofstream(place.path) << "a letter";
  std::string problem;
  EXPECT_FALSE(NetworkLog::Open("udp://nowhere", place.path, problem));
  EXPECT_NE(problem.find("LCM URL 'udp://nowhere': expected one like"), std::string::npos) << problem;
  EXPECT_FALSE(NetworkLog::Open(NewUrl(), place.path, problem));
  EXPECT_EQ(problem, "log file " + place.path + " exists and is no LCM log; it is left as it is");
  EXPECT_FALSE(NetworkLog::Open(NewUrl(), "/there/is/no/such/folder.lcm", problem));
  EXPECT_EQ(problem, "log file /there/is/no/such/folder.lcm cannot be written: No such file or directory");
  std::string text;
  std::ifstream(place.path) >> text;
  EXPECT_EQ(text, "a");
}

}  // namespace
}  // namespace takt::lcm
