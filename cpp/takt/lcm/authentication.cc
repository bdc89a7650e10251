#include "takt/lcm/authentication.h"

#include <openssl/core_names.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/params.h>

#include <algorithm>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "takt/core/problem.h"
#include "takt/lcm/channels.h"
#include "takt/lcm/clock.h"

namespace takt::lcm {
namespace {

constexpr std::array<std::uint8_t, 4> kTagMark = {'T', 'K', 'H', '1'};
constexpr std::size_t kHeadBytes = kTagMark.size() + 3 * 8;
constexpr std::size_t kMacBytes = kTagBytes - kHeadBytes;
constexpr std::size_t kMostSenders = 4096;  // above this, senders whose messages would be stale anyhow are forgotten

void AppendNumber(std::vector<std::uint8_t>& bytes, std::uint64_t number) {
  for (int shift = 56; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

std::uint64_t ReadNumber(std::span<const std::uint8_t> bytes) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : bytes.first(8)) number = number << 8 | byte;
  return number;
}

// Returns the absolute difference without overflow.
std::uint64_t Apart(std::int64_t a, std::int64_t b) {
  const auto x = static_cast<std::uint64_t>(a), y = static_cast<std::uint64_t>(b);
  return a > b ? x - y : y - x;
}

std::uint64_t RandomNumber() {
  std::random_device random;
  return std::uint64_t{random()} << 32 | random();
}

}  // namespace

// HMAC-SHA-256 with one key. One thread at a time.
class Mac {
 public:
  explicit Mac(const Key& key) {
    EVP_MAC* const hmac = EVP_MAC_fetch(nullptr, OSSL_MAC_NAME_HMAC, nullptr);
    context_ = EVP_MAC_CTX_new(hmac);
    EVP_MAC_free(hmac);  // the context keeps it
    std::string digest = "SHA256";
    const std::array parameters = {OSSL_PARAM_construct_utf8_string(OSSL_MAC_PARAM_DIGEST, digest.data(), 0),
                                   OSSL_PARAM_construct_end()};
    if (context_ == nullptr || EVP_MAC_init(context_, key.data(), key.size(), parameters.data()) != 1) {
      EVP_MAC_CTX_free(context_);
      throw std::runtime_error("OpenSSL offers no HMAC-SHA-256, which keys need");
    }
  }
  ~Mac() { EVP_MAC_CTX_free(context_); }
  Mac(const Mac&) = delete;
  Mac& operator=(const Mac&) = delete;

  using Value = std::array<std::uint8_t, kMacBytes>;
  // Returns the code of message and tag head, which are contiguous in `bytes`; nothing if OpenSSL fails.
  std::optional<Value> Of(std::string_view channel, std::span<const std::uint8_t> bytes) {
    constexpr std::uint8_t kZero = 0;
    Value value{};
    std::size_t size = 0;
    const bool done = EVP_MAC_init(context_, nullptr, 0, nullptr) == 1 &&  // the same key again
                      Add({reinterpret_cast<const std::uint8_t*>(channel.data()), channel.size()}) &&
                      Add({&kZero, 1}) && Add(bytes) &&
                      EVP_MAC_final(context_, value.data(), &size, value.size()) == 1 && size == value.size();
    return done ? std::optional(value) : std::nullopt;
  }

 private:
  bool Add(std::span<const std::uint8_t> bytes) { return EVP_MAC_update(context_, bytes.data(), bytes.size()) == 1; }

  EVP_MAC_CTX* context_ = nullptr;
};

bool IsTaggedChannel(std::string_view channel) {
  return channel == kCommandChannel || channel == kHeartbeatChannel || channel == kFeedbackChannel ||
         channel == kMachineChannel || channel == kEngineChannel || channel.starts_with(kDriveChannels);
}

bool HasTag(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kTagBytes && std::ranges::equal(bytes.last(kTagBytes).first(kTagMark.size()), kTagMark);
}

std::string_view Text(TagState state) {
  switch (state) {
    case TagState::kGood:
      return "";
    case TagState::kMissing:
      return "no authentication tag: its sender has no key";
    case TagState::kForeign:
      return "tagged with another key, or changed on the way";
    case TagState::kReplayed:
      return "heard before: replayed";
    case TagState::kStale:
      return "tagged more than 2 s before or after its arrival: replayed, or the clocks of the hosts differ";
  }
  return "";
}

Signer::Signer(const Key& key) : sender_(RandomNumber()), mac_(std::make_unique<Mac>(key)) {}
Signer::~Signer() = default;

void Signer::Sign(std::string_view channel, std::vector<std::uint8_t>& message) {
  const std::lock_guard lock(mutex_);
  message.reserve(message.size() + kTagBytes);
  message.insert(message.end(), kTagMark.begin(), kTagMark.end());
  AppendNumber(message, sender_);
  AppendNumber(message, ++counter_);
  AppendNumber(message, static_cast<std::uint64_t>(WallClockUs()));
  if (const auto mac = mac_->Of(channel, message)) message.insert(message.end(), mac->begin(), mac->end());
}

Verifier::Verifier(const Keys& keys) {
  macs_.push_back(std::make_unique<Mac>(keys.own));
  if (keys.other) macs_.push_back(std::make_unique<Mac>(*keys.other));
}
Verifier::~Verifier() = default;

TagState Verifier::Open(std::string_view channel, std::span<const std::uint8_t>& bytes, std::int64_t heard_us) {
  if (!HasTag(bytes)) return TagState::kMissing;
  const auto message = bytes.first(bytes.size() - kTagBytes), tag = bytes.last(kTagBytes);
  const bool good = std::ranges::any_of(macs_, [&](const auto& of_key) {
    const auto mac = of_key->Of(channel, bytes.first(bytes.size() - kMacBytes));
    return mac && CRYPTO_memcmp(mac->data(), tag.data() + kHeadBytes, kMacBytes) == 0;
  });
  if (!good) return TagState::kForeign;
  // From here on the message is known to come from a holder of the key.
  const std::uint64_t number = ReadNumber(tag.subspan(4)), counter = ReadNumber(tag.subspan(12));
  const auto utime = static_cast<std::int64_t>(ReadNumber(tag.subspan(20)));
  if (Apart(utime, heard_us) > kFreshUs) return TagState::kStale;
  if (senders_.size() >= kMostSenders && !senders_.contains(number)) {
    std::erase_if(senders_, [&](const auto& sender) { return Apart(sender.second.utime, heard_us) > kFreshUs; });
  }
  Sender& sender = senders_[number];
  if (!Take(sender, counter)) return TagState::kReplayed;
  sender.utime = std::max(sender.utime, utime);
  bytes = message;
  return TagState::kGood;
}

bool Verifier::Take(Sender& sender, std::uint64_t counter) {
  if (counter > sender.newest) {  // counters begin with 1
    const std::uint64_t ahead = counter - sender.newest;
    sender.taken = ahead < kWindow ? sender.taken << ahead | 1 : 1;
    sender.newest = counter;
    return true;
  }
  const std::uint64_t behind = sender.newest - counter;
  if (counter == 0 || behind >= kWindow || (sender.taken >> behind & 1) != 0) return false;
  sender.taken |= std::uint64_t{1} << behind;
  return true;
}

Authentication::Authentication(const Keys& keys, Complain complain) : keys_(keys), complain_(std::move(complain)) {}

void Authentication::Refuse(std::string_view channel, TagState state) {
  if (refused_[static_cast<std::size_t>(state)].fetch_add(1, std::memory_order_relaxed) != 0) return;
  complain_("ignored a message on " + Quoted(channel) + ", " + std::string(Text(state)) +
            " (said once; all are counted in takt/engine)");
}

std::uint64_t Authentication::refused(TagState state) const {
  return refused_[static_cast<std::size_t>(state)].load(std::memory_order_relaxed);
}

namespace {

class KeyedReceiver : public Receiver {
 public:
  KeyedReceiver(std::unique_ptr<Receiver> receiver, const Keys& keys, OnRefused refused)
      : receiver_(std::move(receiver)), keys_(keys), refused_(std::move(refused)) {}

  // One verifier per subscription: a message that several of them receive reaches each of them once.
  int Subscribe(const std::string& channels, std::size_t capacity, Handler handler) override {
    const auto verifier = std::make_shared<Verifier>(keys_);
    return receiver_->Subscribe(channels, capacity, [this, verifier, handler = std::move(handler)](const Heard& heard) {
      Heard opened = heard;
      if (IsTaggedChannel(heard.channel)) {
        const TagState state = verifier->Open(heard.channel, opened.data, heard.utime);
        if (state != TagState::kGood) return refused_(heard.channel, state);
      }
      handler(opened);
    });
  }
  void Unsubscribe(int subscription) override { receiver_->Unsubscribe(subscription); }
  void SetCapacity(int subscription, std::size_t capacity) override { receiver_->SetCapacity(subscription, capacity); }
  int Handle(int wait_ms) override { return receiver_->Handle(wait_ms); }
  int file() const override { return receiver_->file(); }
  std::uint64_t malformed() const override { return receiver_->malformed(); }

 private:
  const std::unique_ptr<Receiver> receiver_;
  const Keys keys_;
  const OnRefused refused_;
};

}  // namespace

std::unique_ptr<Receiver> WithKey(std::unique_ptr<Receiver> receiver, const Keys& keys, OnRefused refused) {
  return std::make_unique<KeyedReceiver>(std::move(receiver), keys, std::move(refused));
}

}  // namespace takt::lcm
