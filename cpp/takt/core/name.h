// A short text without heap memory: for names inside commands, which pass to the cycle without allocation.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace takt {

// Up to 40 bytes; longer texts are truncated by Of() and refused in text that users write.
struct Name {
  static constexpr std::size_t kCapacity = 40;

  std::array<char, kCapacity> bytes{};  // zero from index `size` on
  std::uint8_t size = 0;

  static constexpr Name Of(std::string_view text) noexcept {
    Name name;
    name.size = static_cast<std::uint8_t>(std::min(text.size(), kCapacity));
    std::copy_n(text.begin(), name.size, name.bytes.begin());
    return name;
  }
  constexpr std::string_view view() const noexcept { return {bytes.data(), size}; }
  constexpr bool empty() const noexcept { return size == 0; }
  constexpr bool operator==(const Name&) const = default;
};

}  // namespace takt
