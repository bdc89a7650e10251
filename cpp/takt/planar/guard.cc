#include "takt/planar/guard.h"

#include <algorithm>
#include <bit>

namespace takt::planar {
namespace {

constexpr double kSquare = 320;  // [mm]

// std::floor() is a library call on baseline x86-64.
std::int32_t SquareOf(double at) noexcept {
  const double square = at / kSquare;
  const auto down = static_cast<std::int32_t>(square);
  return square < down ? down - 1 : down;
}

}  // namespace

Guard::Guard(std::size_t movers)
    : count_(static_cast<std::uint32_t>(movers)),
      figures_(movers),
      entries_(2 * movers),
      heads_(std::bit_ceil(8 * movers + 1) + 1, kNobody),
      next_(2 * movers * kSquares, kNobody),
      before_(2 * movers * kSquares, kNobody),
      head_of_(2 * movers * kSquares),
      seen_(2 * movers) {}

void Guard::ClearThere(std::uint32_t mover) noexcept {
  Entry& one = entries_[count_ + mover];
  if (!one.present) return;
  Unlink(count_ + mover);
  one.present = false;
}

Guard::Squares Guard::SquaresOf(const Extent& extent) noexcept {
  return {SquareOf(extent.lower.x), SquareOf(extent.lower.y), SquareOf(extent.upper.x), SquareOf(extent.upper.y)};
}

bool Guard::Overlap(const Course& a, const Course& b) noexcept {
  for (std::uint32_t i = 0; i < a.count; ++i) {
    if (Apart(a.extents[i], b.extent, -kSame)) continue;
    for (std::uint32_t k = 0; k < b.count; ++k) {
      if (!Apart(a.extents[i], b.extents[k], -kSame) && Near(a.areas[i], b.areas[k], -kSame)) return true;
    }
  }
  return false;
}

std::size_t Guard::HeadOf(std::uint32_t system, std::int32_t x, std::int32_t y) const noexcept {
  const std::uint64_t key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
                             static_cast<std::uint64_t>(static_cast<std::uint32_t>(y))) +
                            0x9e3779b97f4a7c15ULL * system;
  return static_cast<std::size_t>(key * 0xff51afd7ed558ccdULL >> 32) & (heads_.size() - 2);
}

void Guard::Set(std::uint32_t entry, std::uint32_t system, const Course& course) noexcept {
  Entry& one = entries_[entry];
  const Squares to = SquaresOf(course.extent);
  const bool stays = one.present && one.system == system && one.from_x == to.from_x && one.from_y == to.from_y &&
                     one.to_x == to.to_x && one.to_y == to.to_y;
  one.course.count = course.count;
  one.course.extent = course.extent;
  std::copy_n(course.areas.begin(), course.count, one.course.areas.begin());
  std::copy_n(course.extents.begin(), course.count, one.course.extents.begin());
  if (stays) return;
  if (one.present) Unlink(entry);
  one.present = true;
  one.system = system;
  one.from_x = to.from_x;
  one.from_y = to.from_y;
  one.to_x = to.to_x;
  one.to_y = to.to_y;
  if (to.count() > kSquares) return Link(entry, heads_.size() - 1);
  for (std::int32_t x = to.from_x; x <= to.to_x; ++x) {
    for (std::int32_t y = to.from_y; y <= to.to_y; ++y) Link(entry, HeadOf(system, x, y));
  }
}

void Guard::Link(std::uint32_t entry, std::size_t head) noexcept {
  const auto node = static_cast<std::uint32_t>(entry * kSquares + entries_[entry].nodes++);
  head_of_[node] = static_cast<std::uint32_t>(head);
  before_[node] = kNobody;
  next_[node] = heads_[head];
  if (heads_[head] != kNobody) before_[heads_[head]] = node;
  heads_[head] = node;
}

void Guard::Unlink(std::uint32_t entry) noexcept {
  for (std::uint32_t i = 0; i < entries_[entry].nodes; ++i) {
    const auto node = static_cast<std::uint32_t>(entry * kSquares + i);
    if (before_[node] != kNobody) {
      next_[before_[node]] = next_[node];
    } else {
      heads_[head_of_[node]] = next_[node];
    }
    if (next_[node] != kNobody) before_[next_[node]] = before_[node];
  }
  entries_[entry].nodes = 0;
}

}  // namespace takt::planar
