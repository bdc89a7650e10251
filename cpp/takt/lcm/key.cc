#include "takt/lcm/key.h"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

namespace takt::lcm {
namespace {

constexpr std::size_t kLongestFile = 4096;  // bytes
constexpr std::size_t kDigits = 2 * kKeyBytes;

std::string Mode(mode_t mode) {
  std::string digits = "0";
  for (int shift = 6; shift >= 0; shift -= 3) digits += static_cast<char>('0' + ((mode >> shift) & 7));
  return digits;
}

bool IsSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

// Why this text, which has no space at its end, is no key; empty: it is.
std::string WhyNoKey(const std::string& text) {
  const std::string expected = "expected one key of " + std::to_string(kDigits) + " hexadecimal digits";
  if (text.empty()) return "it is empty; " + expected;
  const bool hex =
      std::ranges::all_of(text, [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0 || IsSpace(c); });
  if (!hex) return expected + ", found other characters";
  const auto digits = text.size() - static_cast<std::size_t>(std::ranges::count_if(text, IsSpace));
  if (digits > kDigits && digits % kDigits == 0) {
    return "holds " + std::to_string(digits / kDigits) + " keys; " + expected;
  }
  if (digits != kDigits) {
    return std::string(digits < kDigits ? "too short: " : "too long: ") + expected + ", found " +
           std::to_string(digits);
  }
  return std::ranges::any_of(text, IsSpace) ? expected + ", found spaces between them" : "";
}

Key FromDigits(const std::string& text) {
  const auto value = [](char c) {
    return c <= '9' ? c - '0' : std::tolower(static_cast<unsigned char>(c)) - 'a' + 10;  // isxdigit holds
  };
  Key key{};
  for (std::size_t i = 0; i < key.size(); ++i) {
    key[i] = static_cast<std::uint8_t>(value(text[2 * i]) << 4 | value(text[2 * i + 1]));
  }
  return key;
}

}  // namespace

std::optional<Key> ReadKey(const std::string& path, std::string& problem) {
  const auto refuse = [&](const std::string& why) {
    problem = "key file " + path + ": " + why;
    return std::nullopt;
  };
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe without a writer hangs nothing
  if (file < 0 && errno == ENOENT) return refuse("there is none; takt key new " + path + " makes one");
  if (file < 0) return refuse(std::strerror(errno));
  struct stat status {};
  std::string text(kLongestFile, '\0');
  const bool plain = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  const bool private_to_owner = (status.st_mode & (S_IRWXG | S_IRWXO)) == 0;
  const ssize_t size = plain && private_to_owner ? read(file, text.data(), text.size()) : 0;
  const int error = errno;
  close(file);
  if (!plain) return refuse("expected a plain file");
  if (!private_to_owner) {
    return refuse("others than its owner may open it (mode " + Mode(status.st_mode) + "); chmod 600 " + path +
                  " makes it private, takt key new makes another key should this one be known already");
  }
  if (size < 0) return refuse(std::strerror(error));
  text.resize(static_cast<std::size_t>(size));
  while (!text.empty() && IsSpace(text.back())) text.pop_back();
  if (const std::string why = WhyNoKey(text); !why.empty()) return refuse(why);
  const Key key = FromDigits(text);
  OPENSSL_cleanse(text.data(), text.size());
  return key;
}

}  // namespace takt::lcm
