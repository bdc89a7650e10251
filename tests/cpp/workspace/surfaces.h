// STL files for tests.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace takt::workspace::testing {

using Facet = std::array<std::array<float, 3>, 3>;

// The twelve triangles of a box about the origin; the first four are perpendicular to X.
inline std::vector<Facet> BoxFacets(double x, double y, double z, bool inside_out = false) {
  const std::array<double, 3> half{x / 2, y / 2, z / 2};
  std::vector<Facet> facets;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double u, double v) {
        const std::size_t b = (axis + 1) % 3;
        const std::size_t c = (axis + 2) % 3;
        std::array<float, 3> out{};
        out[axis] = static_cast<float>(side * half[axis]);
        out[b] = static_cast<float>(u * half[b]);
        out[c] = static_cast<float>(v * half[c]);
        return out;
      };
      Facet first{corner(-1, -1), corner(1, -1), corner(1, 1)};
      Facet second{corner(-1, -1), corner(1, 1), corner(-1, 1)};
      if ((side < 0) != inside_out) {
        std::swap(first[1], first[2]);
        std::swap(second[1], second[2]);
      }
      facets.push_back(first);
      facets.push_back(second);
    }
  }
  return facets;
}

inline std::string Text(const std::vector<Facet>& facets) {
  std::ostringstream out;
  out << "solid test\n";
  for (const Facet& facet : facets) {
    out << "facet normal 0 0 0\n outer loop\n";
    for (const auto& corner : facet) out << "  vertex " << corner[0] << ' ' << corner[1] << ' ' << corner[2] << '\n';
    out << " endloop\nendfacet\n";
  }
  out << "endsolid test\n";
  return out.str();
}

inline std::string Binary(const std::vector<Facet>& facets) {
  std::string out(80, ' ');
  const auto add = [&](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  add(static_cast<std::uint32_t>(facets.size()));
  for (const Facet& facet : facets) {
    add(std::array<float, 3>{});
    add(facet);
    add(std::uint16_t{0});
  }
  return out;
}

// A temporary folder for each test.
class Folder {
 public:
  Folder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            ("takt_" + std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace takt::workspace::testing
