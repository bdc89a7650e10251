// Triangle meshes from STL files. Not for use within the cycle.
//
// Our own reader: of Debian's libraries libadmesh is GPL, libassimp is 10 MB with two more libraries, and libopenmesh
// is a whole scene graph.
#pragma once

#include <array>
#include <cstddef>
#include <kdl/frames.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace takt::workspace {

inline constexpr std::size_t kMaxTriangles = 1'000'000;

struct Mesh {
  std::vector<KDL::Vector> vertices;  // [mm] without duplicates
  std::vector<std::array<std::size_t, 3>> triangles;
  KDL::Vector lower;  // corners of the bounding box
  KDL::Vector upper;
};

// Reads the content of an STL file, binary or text. `scale`: [mm] per unit of the file. Triangles without an area are
// left out. Returns nothing, and a sentence in `why`, if it is not STL, has no triangles, or has coordinates that are
// not finite.
std::optional<Mesh> ReadStl(std::string_view bytes, double scale, std::string& why);

std::optional<Mesh> LoadStl(const std::string& path, double scale, std::string& why);

// Returns true if the surface encloses the point. Surfaces that are not closed enclose it if they do for the most part.
bool Encloses(const Mesh& mesh, const KDL::Vector& point) noexcept;

}  // namespace takt::workspace
