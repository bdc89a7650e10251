// The guard: no two movers ever overlap, whatever moves them.
//
// The invariant, after every cycle, for any two movers in one coordinate system, free, on tracks, moved from outside,
// geared, or brought by a part, with or without a group: their courses (course.h) do not overlap by more than kSame; or
// both are on tracks, and do not overlap in any cycle if both brake from now on. Members of one formation are one rigid
// body. A course is all that a mover covers until it rests if it brakes with its maximum dynamics, with all angles of a
// rotation in progress. A mover that a part is to bring has its area at the destination as well, from the command on.
//
// It holds by induction, like that of traffic.h. A mover that brakes keeps it: the rest of a course is part of the
// course. So each mover is first assumed to brake; then one after the other, in a fixed order, may take its step if the
// course from there keeps the invariant against all other movers as assumed at that time; else it brakes. A motion that
// needs an area which braking does not free (a rotation, a part with movers) is refused unless that area is free, and
// keeps it until its end.
//
// The broad phase is a grid whose squares are hashed: only movers near the course are tested. The narrow phase uses
// separating axes (area.h). All memory is allocated by the constructor.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/planar/course.h"

namespace takt::planar {

class Guard {
 public:
  explicit Guard(std::size_t movers = 0);

  // Properties of a mover that do not depend on its position.
  struct Figure {
    Area kind{.count = 0};     // sides, all angles that it turns through, and offsets from its track (EachArea)
    std::uint32_t system = 0;  // its coordinate system, from 0
    std::uint32_t body = 0;    // movers with the same number, from 1, move as one body; 0: it moves alone
    bool on_track = false;     // moved by traffic
  };
  Figure& figure(std::uint32_t mover) noexcept { return figures_[mover]; }
  const Figure& figure(std::uint32_t mover) const noexcept { return figures_[mover]; }
  const Course& course(std::uint32_t mover) const noexcept { return entries_[mover].course; }

  // Sets its course from now on, in the coordinate system of its figure.
  void Put(std::uint32_t mover, const Course& course) noexcept { Set(mover, figures_[mover].system, course); }
  // Sets its area at the position to which its part brings it, from the command until the arrival.
  void PutThere(std::uint32_t mover, std::uint32_t system, const Course& course) noexcept {
    Set(count_ + mover, system, course);
  }
  void ClearThere(std::uint32_t mover) noexcept;

  // Returns the mover with the least number whose course, or area at the destination of its part, would overlap
  // `course`; kNobody if there is none. `skips` and `passes` receive a mover, and whether the entry is its area at a
  // destination; `skips` before the courses are compared, `passes` if they overlap. If one of them returns true, the
  // entry is ignored.
  template <typename Skips, typename Passes>
  std::uint32_t Find(std::uint32_t mover, std::uint32_t system, const Course& course, const Skips& skips,
                     const Passes& passes) noexcept {
    std::uint32_t found = kNobody;
    EachNear(system, course.extent, [&](std::uint32_t entry) {
      const bool there = entry >= count_;
      const std::uint32_t other = there ? entry - count_ : entry;
      if (other >= found || other == mover) return;
      const std::uint32_t body = figures_[other].body;
      if (body != 0 && body == figures_[mover].body) return;
      if (skips(other, there)) return;
      if (Overlap(course, entries_[entry].course) && !passes(other, there)) found = other;
    });
    return found;
  }
  static bool None(std::uint32_t /*other*/, bool /*there*/) noexcept { return false; }
  std::uint32_t Find(std::uint32_t mover, std::uint32_t system, const Course& course) noexcept {
    return Find(mover, system, course, None, None);
  }
  std::uint32_t Find(std::uint32_t mover, const Course& course) noexcept {
    return Find(mover, figures_[mover].system, course);
  }

 private:
  static constexpr std::size_t kSquares = 12;  // largest number for an entry; a larger one is near everything
  struct Entry {
    bool present = false;
    std::uint32_t system = 0;
    std::int32_t from_x = 0, from_y = 0, to_x = 0, to_y = 0;  // squares
    std::uint32_t nodes = 0;                                  // in lists of squares
    Course course{};
  };
  struct Squares {
    std::int32_t from_x, from_y, to_x, to_y;
    std::size_t count() const noexcept {
      return static_cast<std::size_t>(to_x - from_x + 1) * static_cast<std::size_t>(to_y - from_y + 1);
    }
  };

  static Squares SquaresOf(const Extent& extent) noexcept;
  static bool Overlap(const Course& a, const Course& b) noexcept;
  std::size_t HeadOf(std::uint32_t system, std::int32_t x, std::int32_t y) const noexcept;
  void Set(std::uint32_t entry, std::uint32_t system, const Course& course) noexcept;
  void Unlink(std::uint32_t entry) noexcept;
  void Link(std::uint32_t entry, std::size_t head) noexcept;

  // Calls `look` once for each entry whose extent overlaps `extent`.
  template <typename Look>
  void EachNear(std::uint32_t system, const Extent& extent, const Look& look) noexcept {
    if (entries_.empty()) return;
    ++asked_;
    const auto see = [&](std::uint32_t entry) {
      if (seen_[entry] == asked_) return;
      seen_[entry] = asked_;
      const Entry& one = entries_[entry];
      if (one.present && one.system == system && !Apart(extent, one.course.extent, -kSame)) look(entry);
    };
    const Squares squares = SquaresOf(extent);
    if (squares.count() > entries_.size()) {
      for (std::uint32_t i = 0; i < entries_.size(); ++i) see(i);
      return;
    }
    for (std::int32_t x = squares.from_x; x <= squares.to_x; ++x) {
      for (std::int32_t y = squares.from_y; y <= squares.to_y; ++y) {
        for (std::uint32_t n = heads_[HeadOf(system, x, y)]; n != kNobody; n = next_[n]) see(n / kSquares);
      }
    }
    for (std::uint32_t n = heads_.back(); n != kNobody; n = next_[n]) see(n / kSquares);
  }

  std::uint32_t count_;
  std::vector<Figure> figures_;
  std::vector<Entry> entries_;  // of movers, then of their areas at destinations
  // Lists of entries by square; the last one holds the entries with too many squares.
  std::vector<std::uint32_t> heads_;
  std::vector<std::uint32_t> next_, before_, head_of_;  // by node: kSquares for each entry
  std::vector<std::uint64_t> seen_;                     // by entry: the query that last saw it
  std::uint64_t asked_ = 0;
};

}  // namespace takt::planar
