// Checks that a text is well-formed XML that a recursive parser survives (EN-37). TinyXML, which reads URDF, calls
// itself for each level and takes time with the square of their number: 30,000 levels end the program. So texts that
// are not plainly well formed, or nest too deeply, are refused before TinyXML reads them; of a well-formed text both
// see the same levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace takt::kinematics {

enum class XmlCheck : std::uint8_t { kGood, kMalformed, kTooDeep };

// Checks tags, attributes, comments and CDATA sections; document types may declare nothing. Elements may nest in up to
// `most_levels` levels.
XmlCheck ShapeOf(std::string_view text, std::size_t most_levels);

}  // namespace takt::kinematics
