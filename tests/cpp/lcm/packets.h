// LCM's packets on UDP, by the specification (LC02, LC03), for tests that send valid and invalid ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace takt::lcm {

using Packet = std::vector<std::uint8_t>;

inline void Append(Packet& packet, std::uint64_t number, int bytes) {
  while (bytes-- > 0) packet.push_back(static_cast<std::uint8_t>(number >> (8 * bytes)));
}
inline void AppendChannel(Packet& packet, const std::string& channel) {
  packet.insert(packet.end(), channel.begin(), channel.end());
  packet.push_back(0);
}

inline Packet ShortPacket(std::uint32_t number, const std::string& channel, const Packet& data) {
  Packet packet;
  Append(packet, 0x4c433032, 4);
  Append(packet, number, 4);
  AppendChannel(packet, channel);
  packet.insert(packet.end(), data.begin(), data.end());
  return packet;
}

struct FragmentHeader {
  std::uint32_t number = 0, size = 0, offset = 0;
  std::uint16_t fragment = 0, fragments = 0;
};
inline Packet FragmentPacket(const FragmentHeader& header, const std::string& channel, const Packet& data) {
  Packet packet;
  Append(packet, 0x4c433033, 4);
  Append(packet, header.number, 4);
  Append(packet, header.size, 4);
  Append(packet, header.offset, 4);
  Append(packet, header.fragment, 2);
  Append(packet, header.fragments, 2);
  if (header.fragment == 0) AppendChannel(packet, channel);
  packet.insert(packet.end(), data.begin(), data.end());
  return packet;
}

// A message in fragments of `most` bytes of data.
inline std::vector<Packet> Fragments(std::uint32_t number, const std::string& channel, const Packet& data,
                                     std::size_t most) {
  std::vector<Packet> packets;
  const std::size_t count = std::max<std::size_t>(1, (data.size() + most - 1) / most);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * most, end = std::min(data.size(), begin + most);
    packets.push_back(FragmentPacket(
        {number, static_cast<std::uint32_t>(data.size()), static_cast<std::uint32_t>(begin),
         static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(count)},
        channel,
        Packet(data.begin() + static_cast<std::ptrdiff_t>(begin), data.begin() + static_cast<std::ptrdiff_t>(end))));
  }
  return packets;
}

}  // namespace takt::lcm
