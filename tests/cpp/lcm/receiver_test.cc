// The receiver at the socket.
#include "takt/lcm/receiver.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <numeric>
#include <random>
#include <thread>

#include "packets.h"
#include "takt/lcm/authentication.h"
#include "takt/lcm/clock.h"
#include "takt/lcm/network.h"
#include "takt/lcm/udp_receiver.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

using namespace std::chrono_literals;

// A socket of which nobody knows what comes out.
class Anybody {
 public:
  explicit Anybody(const std::string& url, const char* host = nullptr) {
    const UdpAddress address = *ParseUdp(url);
    to_.sin_family = AF_INET;
    to_.sin_port = htons(address.port);
    to_.sin_addr = address.group;
    if (host != nullptr) inet_pton(AF_INET, host, &to_.sin_addr);
    const unsigned char ttl = 0;
    if (host == nullptr) setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~Anybody() { close(socket_); }
  void Send(const Packet& packet) const {
    sendto(socket_, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }

 private:
  const int socket_ = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to_{};
};

std::unique_ptr<Receiver> Open(const std::string& url) {
  std::string problem;
  auto receiver = OpenReceiver(url, problem);
  EXPECT_TRUE(receiver) << problem;
  return receiver;
}

// EN-30: short and long messages sent by liblcm are received.
TEST(Receiver, HearsWhatLiblcmSends) {
  const std::string url = NewUrl();
  const auto receiver = Open(url);
  std::map<std::string, std::size_t> heard;
  receiver->Subscribe("takt/.*", Receiver::kAll, [&](const Heard& message) {
    heard[message.channel] = message.data.size();
    EXPECT_LT(std::abs(WallClockUs() - message.utime), 5'000'000);
  });
  receiver->Subscribe("takt/two", Receiver::kAll, [&](const Heard& message) {
    heard["again"] = static_cast<std::size_t>(std::accumulate(message.data.begin(), message.data.end(), 0));
  });
  const Network sender = OpenNetwork(url);
  Packet bytes(300'000, 1);
  sender.lcm->publish("takt/one", bytes.data(), 5);
  sender.lcm->publish("other", bytes.data(), 5);
  for (int i = 0; i < 200 && heard.size() < 3; ++i) {  // the system's buffer may be too small for all fragments at once
    sender.lcm->publish("takt/two", bytes.data(), static_cast<unsigned>(bytes.size()));
    while (receiver->Handle(50) > 0) {
    }
  }
  EXPECT_EQ(heard, (std::map<std::string, std::size_t>{{"takt/one", 5}, {"takt/two", 300'000}, {"again", 300'000}}));
}

// Messages beyond a subscription's capacity are dropped; other subscriptions still get them.
TEST(Receiver, KeepsToTheCapacity) {
  const std::string url = NewUrl();
  const auto receiver = Open(url);
  int few = 0, all = 0;
  receiver->Subscribe("c", 10, [&](const Heard&) { ++few; });
  receiver->Subscribe("c", Receiver::kAll, [&](const Heard&) { ++all; });
  const int gone = receiver->Subscribe("c", Receiver::kAll, [&](const Heard&) { ADD_FAILURE(); });
  receiver->Unsubscribe(gone);
  const Anybody sender(url);
  for (std::uint32_t i = 0; i < 100; ++i) sender.Send(ShortPacket(i, "c", {1}));
  std::this_thread::sleep_for(200ms);
  while (receiver->Handle(50) > 0) {
  }
  EXPECT_EQ(few, 10);
  EXPECT_EQ(all, 100);
}

// EN-25, EN-30: the socket has the group's address: datagrams to this host itself are not received.
TEST(Receiver, HearsTheGroupAlone) {
  const std::string url = NewUrl();
  const auto receiver = Open(url);
  std::vector<std::string> heard;
  receiver->Subscribe(".*", Receiver::kAll, [&](const Heard& message) { heard.push_back(message.channel); });
  for (const char* host : {"127.0.0.1", "127.0.0.2"}) Anybody(url, host).Send(ShortPacket(1, "unicast", {1}));
  Anybody(url).Send(ShortPacket(1, "group", {1}));
  while (receiver->Handle(200) > 0) {
  }
  EXPECT_EQ(heard, std::vector<std::string>{"group"});
}

TEST(Receiver, ReadsUrls) {
  EXPECT_TRUE(ParseUdp("udpm://239.255.76.67:7667")->this_host_only);
  EXPECT_TRUE(ParseUdp("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1000")->this_host_only);
  EXPECT_EQ(ParseUdp("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1000")->buffer, 1000);
  EXPECT_FALSE(ParseUdp("udpm://239.255.76.67:7667?recv_buf_size=1000&ttl=1")->this_host_only);
  for (const char* wrong : {"udpm://239.255.76.67", "udpm://239.255.76.67:0", "udpm://239.255.76.67:65536",
                            "udpm://10.0.0.1:7667", "udpm://host:7667", "tcpq://127.0.0.1:7700", ""}) {
    EXPECT_FALSE(ParseUdp(wrong)) << wrong;
  }
}

// EN-30: several senders send valid and malformed data; the valid messages still arrive. With TAKT_LONG by the million.
TEST(Receiver, FuzzAtTheSocket) {
  const std::string url = NewUrl();
  const auto receiver = Open(url + "&recv_buf_size=4194304");
  std::mt19937 random(30);
  const auto uniform = [&](std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random);
  };
  std::uint64_t heard = 0, sent = 0, right = 0;
  Packet data(5000);
  std::iota(data.begin(), data.end(), std::uint8_t{0});
  receiver->Subscribe("genuine", Receiver::kAll, [&](const Heard& message) {
    ++heard;
    right += std::ranges::equal(message.data, data) ? 1 : 0;
  });
  receiver->Subscribe(".*", 100, [](const Heard&) {});
  const std::vector<std::unique_ptr<Anybody>> senders = [&] {
    std::vector<std::unique_ptr<Anybody>> all;
    for (int i = 0; i < 5; ++i) all.push_back(std::make_unique<Anybody>(url));
    return all;
  }();
  const std::uint32_t rounds = std::getenv("TAKT_LONG") ? 10'000'000 : 4'000;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    FragmentHeader header{uniform(0, 3), static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()),
                          static_cast<std::uint16_t>(uniform(0, 3)), static_cast<std::uint16_t>(uniform(0, 4))};
    if (uniform(0, 2) > 0) header.size = uniform(0, 100'000);
    if (uniform(0, 2) > 0) header.offset = uniform(0, 100'000);
    Packet packet = FragmentPacket(header, std::string(uniform(0, 70), static_cast<char>(uniform(1, 255))),
                                   Packet(uniform(0, 3) == 0 ? uniform(0, 60'000) : uniform(0, 300), 0xab));
    if (uniform(0, 3) == 0) packet.resize(uniform(0, static_cast<std::uint32_t>(packet.size())));
    senders[uniform(1, 4)]->Send(packet);
    if (round % 100 == 0) {
      for (const Packet& fragment : Fragments(round, "genuine", data, 2000)) senders[0]->Send(fragment);
      ++sent;
      while (receiver->Handle(0) > 0) {
      }
      for (int i = 0; i < 100 && heard < sent; ++i) receiver->Handle(10);
    }
  }
  EXPECT_EQ(heard, right);
  EXPECT_GE(heard, sent * 9 / 10) << "of " << sent;  // a loaded host may lose some
  EXPECT_GT(receiver->malformed(), rounds / 4);
}

// EN-30, EN-31: with a key: messages of its holders arrive once, short or in fragments, among copies that were changed,
// truncated, repeated, moved to another channel or tagged with another key; nothing else arrives. With TAKT_LONG by the
// million.
TEST(Receiver, FuzzAtTheSocketWithAKey) {
  const std::string url = NewUrl();
  std::map<TagState, std::uint64_t> refused;
  const Key key{1, 2, 3}, other{3, 2, 1};
  const auto receiver = WithKey(Open(url + "&recv_buf_size=4194304"), {.own = key, .other = {}},
                                [&](std::string_view, TagState state) { ++refused[state]; });
  std::mt19937 random(31);
  const auto uniform = [&](std::size_t low, std::size_t high) {
    return std::uniform_int_distribution<std::size_t>(low, high)(random);
  };
  std::map<Packet, int> heard;  // how often
  std::uint64_t open = 0;
  receiver->Subscribe("takt/command", Receiver::kAll,
                      [&](const Heard& message) { ++heard[Packet(message.data.begin(), message.data.end())]; });
  receiver->Subscribe("takt/axis/x", Receiver::kAll, [&](const Heard&) { ++open; });
  receiver->Subscribe("takt/.*", 100, [](const Heard&) {});
  std::vector<std::unique_ptr<Anybody>> senders;
  for (int i = 0; i < 5; ++i) senders.push_back(std::make_unique<Anybody>(url));
  Signer signer(key), foreign(other);
  const auto send = [&](const Anybody& sender, std::size_t number, const std::string& channel, const Packet& data) {
    if (data.size() < 400 && number % 2 == 0) {
      return sender.Send(ShortPacket(static_cast<std::uint32_t>(number), channel, data));
    }
    for (const Packet& piece : Fragments(static_cast<std::uint32_t>(number), channel, data, 300)) sender.Send(piece);
  };
  std::vector<Packet> said;
  const std::size_t rounds = std::getenv("TAKT_LONG") ? 200'000 : 1'000;
  for (std::size_t round = 0; round < rounds; ++round) {
    Packet message(uniform(8, 1500), 0xab);
    for (std::size_t i = 0; i < 8; ++i) message[i] = static_cast<std::uint8_t>(round >> (8 * i));
    said.push_back(message);
    Packet tagged = message;
    signer.Sign("takt/command", tagged);
    send(*senders[0], round, "takt/command", tagged);
    for (std::size_t i = 0; i < 4; ++i) {  // the others
      Packet copy = tagged;
      std::string channel = "takt/command";
      switch (uniform(0, 6)) {
        case 0:
          copy[uniform(0, copy.size() - 1)] ^= static_cast<std::uint8_t>(1 << uniform(0, 7));
          break;
        case 1:
          copy.resize(uniform(0, copy.size() - 1));
          break;
        case 2:
          copy.insert(copy.end(), tagged.end() - static_cast<std::ptrdiff_t>(kTagBytes), tagged.end());
          break;
        case 3:
          channel = uniform(0, 1) == 0 ? "takt/heartbeat" : "takt/axis/x";
          break;
        case 4:
          copy = message;
          foreign.Sign(channel, copy);
          break;
        case 5:
          copy = message;
          break;
        default:  // repeated unchanged
          break;
      }
      std::ranges::shuffle(senders.begin() + 1, senders.end(), random);
      send(*senders[1], uniform(0, 1'000'000), channel, copy);
    }
    while (receiver->Handle(0) > 0) {
    }
    for (int i = 0; i < 100 && !heard.contains(message); ++i) receiver->Handle(10);
  }
  while (receiver->Handle(50) > 0) {
  }
  std::size_t once = 0;
  for (const Packet& message : said) once += heard.contains(message) ? 1 : 0;
  EXPECT_EQ(heard.size(), once);  // nothing else
  for (const auto& [message, times] : heard) EXPECT_EQ(times, 1);
  EXPECT_GE(once, rounds * 9 / 10);  // a loaded host may lose some
  EXPECT_GT(open, rounds / 20);
  for (const TagState state : {TagState::kMissing, TagState::kForeign, TagState::kReplayed}) {
    EXPECT_GT(refused[state], rounds / 20) << Text(state);
  }
}

}  // namespace
}  // namespace takt::lcm
