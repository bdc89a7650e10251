#include "takt/workspace/mesh.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>

#include "takt/core/maths.h"
#include "takt/core/read_file.h"

namespace takt::workspace {
namespace {

using KDL::Vector;

constexpr std::size_t kHeader = 84;  // [bytes] a text and the number of triangles
constexpr std::size_t kRecord = 50;  // [bytes] a normal, three corners, two more bytes
constexpr std::size_t kMostBytes = 256'000'000;
constexpr std::string_view kSpaces = " \t\r\n\f\v";
static_assert(std::endian::native == std::endian::little, "STL counts so");

using Corner = std::array<double, 3>;

// Joins triangles at their common corners.
class Builder {
 public:
  explicit Builder(double scale) : scale_(scale) {}

  // Returns false if a coordinate is not finite.
  bool Add(const std::array<Corner, 3>& corners) {
    std::array<std::size_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      Corner corner = corners[i];
      for (double& x : corner) {
        x *= scale_;
        if (!std::isfinite(x)) return false;
      }
      const auto [place, is_new] = known_.try_emplace(corner, mesh_.vertices.size());
      if (is_new) mesh_.vertices.emplace_back(corner[0], corner[1], corner[2]);
      triangle[i] = place->second;
    }
    const Vector& first = mesh_.vertices[triangle[0]];
    const Vector normal = (mesh_.vertices[triangle[1]] - first) * (mesh_.vertices[triangle[2]] - first);
    if (normal.Norm() > 0) mesh_.triangles.push_back(triangle);
    return true;
  }

  Mesh Take() {
    if (!mesh_.vertices.empty()) mesh_.lower = mesh_.upper = mesh_.vertices.front();
    for (const Vector& vertex : mesh_.vertices) {
      for (int i = 0; i < 3; ++i) {
        mesh_.lower(i) = std::min(mesh_.lower(i), vertex(i));
        mesh_.upper(i) = std::max(mesh_.upper(i), vertex(i));
      }
    }
    return std::move(mesh_);
  }

 private:
  double scale_;
  std::map<Corner, std::size_t> known_;
  Mesh mesh_;
};

std::uint32_t CountOf(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeader - sizeof count, sizeof count);
  return count;
}

// Returns the error; empty if there is none.
std::string ReadBinary(std::string_view bytes, Builder& builder) {
  const std::size_t count = CountOf(bytes);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 12> numbers{};
    std::memcpy(numbers.data(), bytes.data() + kHeader + i * kRecord, sizeof numbers);
    std::array<Corner, 3> corners{};
    for (std::size_t k = 0; k < 9; ++k) corners[k / 3][k % 3] = numbers[3 + k];
    if (!builder.Add(corners)) return "triangle " + std::to_string(i + 1) + " has a corner that is no number";
  }
  return {};
}

std::string Lowered(std::string word) {
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

// Returns true if the text begins with 'solid', in any case, after a byte order mark and blanks.
bool BeginsWithSolid(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  constexpr std::string_view kSolid = "solid";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return Lowered(std::string(text.substr(0, kSolid.size()))) == kSolid;
}

// Returns false if the word is not a number. A leading + is allowed.
bool ReadNumber(std::string_view word, double& number) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [read, error] = std::from_chars(word.data(), end, number);
  return error == std::errc() && read == end;
}

// The words of a text, and the lines they are in, which end in LF, CR LF or CR.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  // Returns the next word; empty at the end.
  std::string_view Next() {
    const auto is_space = [](char c) { return kSpaces.find(c) != std::string_view::npos; };
    for (; at_ < text_.size() && is_space(text_[at_]); ++at_) {
      const bool within = text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n';
      if (text_[at_] == '\n' || (text_[at_] == '\r' && !within)) ++line_;
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  std::string Place() const { return "line " + std::to_string(line_) + ": "; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

// The layout is free: only the vertices of each `facet` count. Keywords may be of any case.
std::string ReadText(std::string_view text, Builder& builder) {
  Words words(text);
  std::array<Corner, 3> corners{};
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  bool in_facet = false;  // outside, a word may be part of the name
  for (std::string_view next = words.Next(); !next.empty(); next = words.Next()) {
    const std::string word = Lowered(std::string(next));
    if (word == "facet") {
      if (vertices > 0) return words.Place() + "a facet begins within another";
      in_facet = true;
    } else if (word == "vertex" && in_facet) {
      if (vertices == 3) return words.Place() + "a facet has more than three vertices";
      const std::string place = words.Place();
      for (double& x : corners[vertices]) {
        if (!ReadNumber(words.Next(), x)) return place + "expected three numbers behind 'vertex'";
      }
      ++vertices;
    } else if (word == "endfacet" && in_facet) {
      if (vertices != 3)
        return words.Place() + "a facet has " + std::to_string(vertices) + " vertices instead of three";
      if (++triangles > kMaxTriangles) return "more than " + std::to_string(kMaxTriangles) + " triangles";
      if (!builder.Add(corners)) return words.Place() + "a facet has a vertex that is no number";
      vertices = 0;
      in_facet = false;
    }
  }
  return in_facet ? "the text ends within a facet" : std::string();
}

}  // namespace

std::optional<Mesh> ReadStl(std::string_view bytes, double scale, std::string& why) {
  why.clear();
  Builder builder(scale);
  // Binary files may begin with "solid", too: their length decides.
  const bool binary = bytes.size() >= kHeader && bytes.size() == kHeader + kRecord * std::size_t{CountOf(bytes)};
  if (binary && CountOf(bytes) > kMaxTriangles) {
    why = "more than " + std::to_string(kMaxTriangles) + " triangles";
  } else if (binary) {
    why = ReadBinary(bytes, builder);
  } else if (BeginsWithSolid(bytes) && bytes.find('\0') == std::string_view::npos) {
    why = ReadText(bytes, builder);
  } else if (bytes.size() >= kHeader) {
    why = "this is no STL: " + std::to_string(CountOf(bytes)) + " triangles would need " +
          std::to_string(kHeader + kRecord * std::size_t{CountOf(bytes)}) + " bytes, found " +
          std::to_string(bytes.size());
  } else {
    why = "this is no STL: neither a text that begins with 'solid' nor long enough for a binary file";
  }
  if (!why.empty()) return std::nullopt;
  Mesh mesh = builder.Take();
  if (mesh.triangles.empty()) why = "this STL holds no triangles";
  return why.empty() ? std::optional(std::move(mesh)) : std::nullopt;
}

std::optional<Mesh> LoadStl(const std::string& path, double scale, std::string& why) {
  const std::optional<std::string> bytes = ReadFile(path, kMostBytes + 1, why);
  if (!bytes) return std::nullopt;
  if (bytes->size() > kMostBytes) {
    why = "holds more than " + std::to_string(kMostBytes / 1'000'000) + " MB";
    return std::nullopt;
  }
  return ReadStl(*bytes, scale, why);
}

// Sums the solid angles of all triangles: 4 pi inside, 0 outside.
bool Encloses(const Mesh& mesh, const Vector& point) noexcept {
  for (int i = 0; i < 3; ++i) {
    if (point(i) < mesh.lower(i) || point(i) > mesh.upper(i)) return false;
  }
  double angle = 0;
  for (const std::array<std::size_t, 3>& triangle : mesh.triangles) {
    const Vector a = mesh.vertices[triangle[0]] - point;
    const Vector b = mesh.vertices[triangle[1]] - point;
    const Vector c = mesh.vertices[triangle[2]] - point;
    const double volume = dot(a, b * c);
    const double rest =
        a.Norm() * b.Norm() * c.Norm() + dot(a, b) * c.Norm() + dot(b, c) * a.Norm() + dot(c, a) * b.Norm();
    angle += 2 * maths::Atan2(volume, rest);
  }
  return std::abs(angle) > 2 * std::numbers::pi;
}

}  // namespace takt::workspace
