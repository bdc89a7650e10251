// EN-37, EN-38: STL files as anyone may write them, binary or text.
#include <cmath>
#include <cstdlib>
#include <string>

#include "takt/workspace/mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string why;
  const auto mesh = takt::workspace::ReadStl({reinterpret_cast<const char*>(data), size}, 1, why);
  if (mesh.has_value() != why.empty()) std::abort();
  if (!mesh) return 0;
  for (const auto& triangle : mesh->triangles) {
    for (const std::size_t vertex : triangle) {
      if (vertex >= mesh->vertices.size() || !std::isfinite(mesh->vertices[vertex].Norm())) std::abort();
    }
  }
  takt::workspace::Encloses(*mesh, KDL::Vector(1, 2, 3));
  return 0;
}
