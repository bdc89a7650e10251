// EN-30, EN-31: datagrams as they come from the network, to the decoders. The input is a row of datagrams, each behind
// a byte that tells its sender and two that tell its length; what they complete goes through the tag's check with every
// other sender, then to the decoder of its channel.
#include <algorithm>
#include <cstdlib>
#include <span>

#include "takt/lcm/authentication.h"
#include "takt/lcm/messages.h"
#include "takt/lcm/reassembly.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace takt::lcm;
  constexpr Reassembly::Limits kLimits{.messages = 4, .bytes = 1 << 16};
  Reassembly reassembly(kLimits);
  Verifier verifier({.own = Key{}, .other = Key{1}});
  std::span<const std::uint8_t> rest(data, size);
  while (rest.size() >= 3) {
    const std::uint8_t sender = rest[0];
    const std::size_t length = std::min<std::size_t>(rest[1] << 8 | rest[2], rest.size() - 3);
    // Memory of its own size, so that a read beyond it is found.
    const std::vector<std::uint8_t> datagram(rest.begin() + 3, rest.begin() + 3 + static_cast<std::ptrdiff_t>(length));
    rest = rest.subspan(3 + length);
    const auto message = reassembly.Take(sender % 4, datagram);
    if (reassembly.held_bytes() > kLimits.bytes) std::abort();
    if (!message) continue;
    std::span<const std::uint8_t> bytes = message->data;
    if (sender % 8 >= 4 && verifier.Open(message->channel, bytes, 0) == TagState::kGood) std::abort();  // nobody has it
    DecodeCommand(bytes);
    DecodeHeartbeat(bytes);
    DecodeMachine(bytes);
    DecodeDriveFeedback(bytes);
  }
  return 0;
}
