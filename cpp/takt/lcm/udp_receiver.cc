#include "takt/lcm/udp_receiver.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <deque>
#include <mutex>
#include <regex>
#include <set>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "takt/lcm/clock.h"
#include "takt/lcm/reassembly.h"

namespace takt::lcm {
namespace {

constexpr std::size_t kLongestDatagram = 1 << 16;
constexpr std::size_t kMostWaiting = 256 << 20;       // [bytes] in the queue
constexpr std::size_t kChannelsKnown = 4096;          // channels whose subscriptions are remembered
constexpr std::int64_t kLookAgainNs = 1'000'000'000;  // between looks at this host's addresses
constexpr int kBurst = 256;                           // datagrams between checks of stop_

class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&&) = delete;
  ~FileDescriptor() {
    if (number_ >= 0) close(number_);
  }
  int operator*() const { return number_; }

 private:
  int number_;
};

// Addresses of this host, read again if an address is unknown, at most once a second.
class OwnAddresses {
 public:
  bool Has(in_addr address) {
    // 0.0.0.0 is the sender if the loopback interface is the only one. The kernel does not accept it, 127.x, or an
    // address of this host from outside.
    if (address.s_addr == 0 || (ntohl(address.s_addr) >> 24) == 127 || known_.contains(address.s_addr)) return true;
    const std::int64_t now = SteadyNs();
    if (now < look_again_ns_) return false;
    look_again_ns_ = now + kLookAgainNs;
    known_.clear();
    ifaddrs* all = nullptr;
    if (getifaddrs(&all) != 0) return false;
    for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
      if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
      known_.insert(reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr);
    }
    freeifaddrs(all);
    return known_.contains(address.s_addr);
  }

 private:
  std::set<in_addr_t> known_;
  std::int64_t look_again_ns_ = 0;
};

class UdpReceiver : public Receiver {
 public:
  UdpReceiver(FileDescriptor socket, FileDescriptor end, FileDescriptor news, bool this_host_only)
      : socket_(std::move(socket)), end_(std::move(end)), news_(std::move(news)), this_host_only_(this_host_only) {
    thread_ = std::thread([this] { Listen(); });
  }
  ~UdpReceiver() override {
    stop_ = true;
    eventfd_write(*end_, 1);
    thread_.join();
  }

  int Subscribe(const std::string& channels, std::size_t capacity, Handler handler) override {
    const std::lock_guard lock(mutex_);
    subscriptions_.push_back({++last_number_, std::regex(channels), capacity, 0, std::move(handler)});
    routes_.clear();
    return last_number_;
  }

  void Unsubscribe(int subscription) override {
    const std::lock_guard lock(mutex_);
    std::erase_if(subscriptions_, [&](const Subscription& s) { return s.number == subscription; });
    routes_.clear();
  }

  void SetCapacity(int number, std::size_t capacity) override {
    const std::lock_guard lock(mutex_);
    for (Subscription& subscription : subscriptions_) {
      if (subscription.number == number) subscription.capacity = capacity;
    }
  }

  int Handle(int wait_ms) override {
    Waiting message;
    std::vector<std::pair<int, Handler>> handlers;
    {
      std::unique_lock lock(mutex_);
      if (queue_.empty()) {
        lock.unlock();
        pollfd news{*news_, POLLIN, 0};
        poll(&news, 1, std::max(0, wait_ms));
        lock.lock();
        if (queue_.empty()) return 0;
      }
      message = std::move(queue_.front());
      queue_.pop_front();
      waiting_ -= message.message.data.size();
      for (Subscription& subscription : subscriptions_) {
        if (!std::ranges::binary_search(message.subscriptions, subscription.number)) continue;
        --subscription.waiting;
        handlers.emplace_back(subscription.number, subscription.handler);
      }
      if (queue_.empty()) {
        eventfd_t ignored = 0;
        eventfd_read(*news_, &ignored);
      }
    }
    for (const auto& [number, handler] : handlers) {
      handler({message.message.channel, message.message.data, message.utime});
    }
    return 1;
  }

  int file() const override { return *news_; }
  std::uint64_t malformed() const override { return malformed_.load(std::memory_order_relaxed); }

 private:
  struct Subscription {
    int number = 0;
    std::regex channels;
    std::size_t capacity = 0;
    std::size_t waiting = 0;  // messages
    Handler handler;
  };
  struct Waiting {
    Reassembly::Message message;
    std::int64_t utime = 0;
    std::vector<int> subscriptions;  // subscriptions that receive it, in ascending order
  };

  void Listen() {
    std::vector<std::uint8_t> buffer(kLongestDatagram);
    while (!stop_) {
      std::array<pollfd, 2> files = {pollfd{*socket_, POLLIN, 0}, pollfd{*end_, POLLIN, 0}};
      poll(files.data(), files.size(), -1);
      for (int i = 0; i < kBurst && !stop_; ++i) {
        if (!ReceiveOne(buffer)) break;
      }
    }
  }

  // Returns false if no datagram was waiting.
  bool ReceiveOne(std::vector<std::uint8_t>& buffer) {
    sockaddr_in from{};
    iovec into{buffer.data(), buffer.size()};
    alignas(cmsghdr) std::array<char, 256> control{};
    msghdr header{};
    header.msg_name = &from;
    header.msg_namelen = sizeof from;
    header.msg_iov = &into;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    const ssize_t size = recvmsg(*socket_, &header, MSG_DONTWAIT);
    if (size < 0) return errno == EINTR;
    const std::span<const std::uint8_t> datagram(buffer.data(), static_cast<std::size_t>(size));
    const bool foreign = this_host_only_ && !addresses_.Has(from.sin_addr);
    if (!foreign) {
      const std::uint64_t sender = std::uint64_t{from.sin_addr.s_addr} << 16 | from.sin_port;
      if (std::optional<Reassembly::Message> message = reassembly_.Take(sender, datagram)) {
        Enqueue(std::move(*message), ArrivalUs(header));
      }
    }
    foreign_ += foreign ? 1 : 0;
    malformed_.store(reassembly_.malformed() + foreign_, std::memory_order_relaxed);
    return true;
  }

  // Returns the arrival time at the kernel: the datagram may have waited long for this thread.
  static std::int64_t ArrivalUs(msghdr& header) {
    for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
      if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMP) continue;
      timeval at{};
      std::copy_n(CMSG_DATA(part), sizeof at, reinterpret_cast<unsigned char*>(&at));
      return at.tv_sec * 1'000'000 + at.tv_usec;
    }
    return WallClockUs();
  }

  void Enqueue(Reassembly::Message message, std::int64_t utime) {
    const std::lock_guard lock(mutex_);
    const std::vector<int>* route = Route(message.channel);
    Waiting waiting{std::move(message), utime, {}};
    const std::size_t bytes = waiting.message.data.size();
    if (route->empty() || waiting_ + bytes > kMostWaiting) return;
    for (Subscription& subscription : subscriptions_) {
      if (!std::ranges::binary_search(*route, subscription.number)) continue;
      if (subscription.capacity != kAll && subscription.waiting >= subscription.capacity) continue;
      ++subscription.waiting;
      waiting.subscriptions.push_back(subscription.number);
    }
    if (waiting.subscriptions.empty()) return;
    waiting_ += bytes;
    queue_.push_back(std::move(waiting));
    if (queue_.size() == 1) eventfd_write(*news_, 1);
  }

  // Returns the subscriptions that receive a channel, in ascending order. The cache is bounded, as channels may be
  // arbitrary.
  const std::vector<int>* Route(const std::string& channel) {
    if (const auto known = routes_.find(channel); known != routes_.end()) return &known->second;
    std::vector<int> numbers;
    for (const Subscription& subscription : subscriptions_) {
      if (std::regex_match(channel, subscription.channels)) numbers.push_back(subscription.number);
    }
    if (routes_.size() >= kChannelsKnown) routes_.clear();
    return &(routes_[channel] = std::move(numbers));
  }

  const FileDescriptor socket_, end_, news_;
  const bool this_host_only_;

  // Used by the thread only.
  Reassembly reassembly_;
  OwnAddresses addresses_;
  std::uint64_t foreign_ = 0;

  std::mutex mutex_;  // guards the members up to last_number_
  std::vector<Subscription> subscriptions_;
  std::unordered_map<std::string, std::vector<int>> routes_;
  std::deque<Waiting> queue_;
  std::size_t waiting_ = 0;  // [bytes] in the queue
  int last_number_ = 0;

  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

bool Set(int socket, int level, int option, int value) {
  return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

template <typename Number>
bool ParseNumber(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

std::optional<UdpAddress> ParseUdp(const std::string& url) {
  constexpr std::string_view kScheme = "udpm://";
  if (!url.starts_with(kScheme)) return {};
  std::string_view rest = std::string_view(url).substr(kScheme.size());
  const std::size_t question = rest.find('?');
  std::string_view options = question == std::string_view::npos ? "" : rest.substr(question + 1);
  rest = rest.substr(0, question);
  const std::size_t colon = rest.find(':');
  UdpAddress address;
  if (colon == std::string_view::npos || !ParseNumber(rest.substr(colon + 1), address.port) || address.port == 0 ||
      inet_pton(AF_INET, std::string(rest.substr(0, colon)).c_str(), &address.group) != 1 ||
      !IN_MULTICAST(ntohl(address.group.s_addr))) {
    return {};
  }
  while (!options.empty()) {
    const std::size_t end = options.find('&');
    const std::string_view option = options.substr(0, end);
    options = end == std::string_view::npos ? "" : options.substr(end + 1);
    const std::size_t equals = option.find('=');
    if (equals == std::string_view::npos) continue;
    int number = 0;
    if (!ParseNumber(option.substr(equals + 1), number)) continue;
    if (option.substr(0, equals) == "ttl") address.this_host_only = number == 0;
    if (option.substr(0, equals) == "recv_buf_size") address.buffer = number;
  }
  return address;
}

std::unique_ptr<Receiver> OpenUdpReceiver(const UdpAddress& address) {
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr = address.group;
  at.sin_port = htons(address.port);
  ip_mreqn group{};
  group.imr_multiaddr = address.group;
  // As in liblcm, whose sockets share the port with this one.
  if (*socket < 0 || !Set(*socket, SOL_SOCKET, SO_REUSEADDR, 1) || !Set(*socket, SOL_SOCKET, SO_REUSEPORT, 1) ||
      !Set(*socket, SOL_SOCKET, SO_TIMESTAMP, 1) || !Set(*socket, IPPROTO_IP, IP_MULTICAST_ALL, 0) ||
      (address.buffer > 0 && !Set(*socket, SOL_SOCKET, SO_RCVBUF, address.buffer)) ||
      bind(*socket, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
      setsockopt(*socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0) {
    return nullptr;
  }
  FileDescriptor end(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)), news(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (*end < 0 || *news < 0) return nullptr;
  return std::make_unique<UdpReceiver>(std::move(socket), std::move(end), std::move(news), address.this_host_only);
}

}  // namespace takt::lcm
