#include "takt/core/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace takt {

std::optional<std::string> ReadFile(const std::string& path, std::size_t most, std::string& why) {
  std::error_code error;
  if (const auto status = std::filesystem::status(path, error); std::filesystem::exists(status) &&
                                                                !std::filesystem::is_directory(status) &&
                                                                !std::filesystem::is_regular_file(status)) {
    why = "cannot read this: it is a device or a pipe";
    return std::nullopt;
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (file) {
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    text.resize(error ? most : static_cast<std::size_t>(std::min<std::uintmax_t>(most, size)));
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (!file.bad()) return text;
  }
  why = "cannot read this file: " + std::system_category().message(errno);
  return std::nullopt;
}

}  // namespace takt
