#include "takt/lcm/reassembly.h"

#include <algorithm>
#include <utility>

namespace takt::lcm {
namespace {

constexpr std::uint32_t kShort = 0x4c433032;     // "LC02"
constexpr std::uint32_t kFragment = 0x4c433033;  // "LC03"
constexpr std::size_t kShortHeader = 8;          // magic, sequence
constexpr std::size_t kFragmentHeader = 20;      // magic, sequence, size, offset, fragment, fragments
constexpr std::size_t kPerPiece = 64;            // [bytes] overhead of a piece

std::uint32_t Number(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i) number = number << 8 | bytes[at + i];
  return number;
}

// Removes the channel and its terminating zero from the front. Returns false if there is none.
bool TakeChannel(std::span<const std::uint8_t>& rest, std::string& channel) {
  const auto longest = rest.first(std::min(rest.size(), kLongestChannel + 1));
  const auto end = std::ranges::find(longest, std::uint8_t{0});
  if (end == longest.end() || end == longest.begin()) return false;
  channel.assign(longest.begin(), end);
  rest = rest.subspan(channel.size() + 1);
  return true;
}

}  // namespace

std::optional<Reassembly::Message> Reassembly::Take(std::uint64_t sender, std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kShortHeader) return Malformed();
  const std::uint32_t magic = Number(datagram, 0, 4);
  if (magic == kShort) return TakeShort(datagram);
  if (magic == kFragment) return TakeFragment(sender, datagram);
  return Malformed();
}

std::optional<Reassembly::Message> Reassembly::TakeShort(std::span<const std::uint8_t> packet) {
  Message message;
  std::span<const std::uint8_t> rest = packet.subspan(kShortHeader);
  if (!TakeChannel(rest, message.channel)) return Malformed();
  message.data.assign(rest.begin(), rest.end());
  return message;
}

std::optional<Reassembly::Message> Reassembly::TakeFragment(std::uint64_t sender,
                                                            std::span<const std::uint8_t> packet) {
  if (packet.size() < kFragmentHeader) return Malformed();
  const Key key{sender, Number(packet, 4, 4)};
  const std::uint32_t size = Number(packet, 8, 4), offset = Number(packet, 12, 4);
  const auto fragment = static_cast<std::uint16_t>(Number(packet, 16, 2));
  const auto fragments = static_cast<std::uint16_t>(Number(packet, 18, 2));
  std::span<const std::uint8_t> rest = packet.subspan(kFragmentHeader);
  std::string channel;
  if (fragment == 0 && !TakeChannel(rest, channel)) return Malformed();
  if (size > kLongestMessage || fragment >= fragments || offset > size || rest.size() > size - offset) {
    return Malformed();
  }

  auto known = by_key_.find(key);
  if (known != by_key_.end() && (known->second->size != size || known->second->fragments != fragments)) {
    ++unfinished_;  // the sender began another message with this number
    Drop(known->second);
    known = by_key_.end();
  }
  if (known == by_key_.end()) {
    Partial begun;
    begun.key = key;
    begun.size = size;
    begun.fragments = fragments;
    known = by_key_.emplace(key, partials_.insert(partials_.end(), std::move(begun))).first;
  }
  const Partials::iterator partial = known->second;
  partials_.splice(partials_.end(), partials_, partial);
  if (partial->pieces.contains(fragment)) return {};  // received twice
  partial->pieces[fragment] = {offset, {rest.begin(), rest.end()}};
  partial->held += rest.size() + kPerPiece;
  held_ += rest.size() + kPerPiece;
  if (fragment == 0) partial->channel = std::move(channel);
  if (partial->pieces.size() == fragments) {
    std::optional<Message> message = Join(*partial);
    Drop(partial);
    return message ? std::move(message) : Malformed();
  }
  while (partials_.size() > limits_.messages || held_ > limits_.bytes) {
    ++unfinished_;
    Drop(partials_.begin());
  }
  return {};
}

std::optional<Reassembly::Message> Reassembly::Join(Partial& partial) {
  Message message{std::move(partial.channel), {}};
  message.data.reserve(std::min<std::size_t>(partial.size, partial.held));
  for (const auto& [number, piece] : partial.pieces) {
    if (piece.offset != message.data.size()) return {};
    message.data.insert(message.data.end(), piece.data.begin(), piece.data.end());
  }
  if (message.data.size() != partial.size) return {};
  return message;
}

void Reassembly::Drop(Partials::iterator partial) {
  held_ -= partial->held;
  by_key_.erase(partial->key);
  partials_.erase(partial);
}

std::nullopt_t Reassembly::Malformed() {
  ++malformed_;
  return std::nullopt;
}

}  // namespace takt::lcm
