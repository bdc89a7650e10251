// Surfaces of triangles from STL files. Not for the cycle.
//
// A reader of our own: of Debian's libraries libadmesh is GPL, libassimp brings 10 MB and two libraries more, and
// libopenmesh a whole scene graph.
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
  std::vector<KDL::Vector> vertices;  // mm; each once
  std::vector<std::array<std::size_t, 3>> triangles;
  KDL::Vector lower;  // corners of the box around it
  KDL::Vector upper;
};

// From what an STL file holds, binary or text. `scale`: mm for 1 in the file. Triangles without an area are left out.
// Nothing, and a sentence in `why`, when it is not STL, holds no triangles, or coordinates that are not numbers.
std::optional<Mesh> ReadStl(std::string_view bytes, double scale, std::string& why);

std::optional<Mesh> LoadStl(const std::string& path, double scale, std::string& why);

// Whether the surface goes round the point. Surfaces that are not closed go round what they enclose for the most part.
bool Encloses(const Mesh& mesh, const KDL::Vector& point) noexcept;

}  // namespace takt::workspace
