// Reads files that a machine file names.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace takt {

// Returns the text of a regular file, at most its first `most` bytes; nothing, and a sentence in `why`, if it does not
// exist or cannot be read. Devices and pipes, which may never end, are refused.
std::optional<std::string> ReadFile(const std::string& path, std::size_t most, std::string& why);

}  // namespace takt
