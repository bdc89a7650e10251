#include "takt/lcm/key.h"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

namespace takt::lcm {
namespace {

constexpr std::size_t kLongestFile = 4096;  // [bytes]
constexpr std::size_t kDigits = 2 * kKeyBytes;
constexpr std::size_t kMostKeys = 2;

std::string Mode(mode_t mode) {
  std::string digits = "0";
  for (int shift = 6; shift >= 0; shift -= 3) digits += static_cast<char>('0' + ((mode >> shift) & 7));
  return digits;
}

bool IsSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

// Returns why this line, which has no trailing space, is no key; empty if it is one.
std::string WhyNoKey(std::string_view line) {
  const std::string expected = "expected one key of " + std::to_string(kDigits) + " hexadecimal digits";
  const bool hex =
      std::ranges::all_of(line, [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0 || IsSpace(c); });
  if (!hex) return expected + ", found other characters";
  const auto digits = line.size() - static_cast<std::size_t>(std::ranges::count_if(line, IsSpace));
  if (digits != kDigits) {
    return std::string(digits < kDigits ? "too short: " : "too long: ") + expected + ", found " +
           std::to_string(digits);
  }
  return std::ranges::any_of(line, IsSpace) ? expected + ", found spaces between them" : "";
}

Key FromDigits(std::string_view text) {
  const auto value = [](char c) {
    return c <= '9' ? c - '0' : std::tolower(static_cast<unsigned char>(c)) - 'a' + 10;  // isxdigit holds
  };
  Key key{};
  for (std::size_t i = 0; i < key.size(); ++i) {
    key[i] = static_cast<std::uint8_t>(value(text[2 * i]) << 4 | value(text[2 * i + 1]));
  }
  return key;
}

// Returns the non-empty lines, without trailing spaces.
std::vector<std::string_view> LinesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    while (!line.empty() && IsSpace(line.back())) line.remove_suffix(1);
    if (!line.empty()) lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// Returns the keys in the text of a file; nothing, and the reason in `why`, on failure.
std::optional<Keys> KeysIn(std::string_view text, std::string& why) {
  const std::vector<std::string_view> lines = LinesOf(text);
  if (lines.empty()) why = "it is empty; expected one key of " + std::to_string(kDigits) + " hexadecimal digits";
  if (lines.size() > kMostKeys) {
    why = "holds " + std::to_string(lines.size()) + " keys; expected one, or two while the key is changed";
  }
  for (std::size_t i = 0; why.empty() && i < lines.size(); ++i) {
    why = WhyNoKey(lines[i]);
    if (!why.empty() && lines.size() > 1) why = "key " + std::to_string(i + 1) + ": " + why;
  }
  if (!why.empty()) return {};
  Keys keys{.own = FromDigits(lines[0]), .other = {}};
  if (lines.size() == kMostKeys) keys.other = FromDigits(lines[1]);
  if (keys.other != keys.own) return keys;
  why = "holds the same key twice";
  return {};
}

}  // namespace

std::optional<Keys> ReadKeys(const std::string& path, std::string& problem) {
  const auto refuse = [&](const std::string& why) {
    problem = "key file " + path + ": " + why;
    return std::nullopt;
  };
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe without a writer does not block
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
  std::string why;
  const std::optional<Keys> keys = KeysIn(text, why);
  OPENSSL_cleanse(text.data(), text.size());
  if (!keys) return refuse(why);
  return keys;
}

}  // namespace takt::lcm
