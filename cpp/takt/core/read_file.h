// Files that a machine file names.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace takt {

// The text of a regular file, at most `most` bytes of it; nothing and a sentence why in `why` if there is none or it
// cannot be read. Devices and pipes, which may never end, are none.
std::optional<std::string> ReadFile(const std::string& path, std::size_t most, std::string& why);

}  // namespace takt
