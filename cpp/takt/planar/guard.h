// No two movers ever overlap, whatever moves them.
//
// The invariant, after every cycle, for any two movers in one coordinate system, free, on tracks, moved from outside,
// geared, or brought by a part, with or without a group: their courses (course.h) do not overlap by more than kSame; or
// both are on tracks, and do not overlap in any cycle if both brake from now on. Members of one formation are one
// body, which is rigid. A course is all that a mover covers until it rests if it brakes with its greatest dynamics,
// with all angles of a rotation in progress. A mover that a part is to bring has the area where it will be as well,
// from the command on.
//
// It holds by induction, as that of traffic.h does. A mover that brakes keeps it: the rest of a course is part of it.
// So at first each mover is taken to brake, and then one after the other, in a fixed order, may take its step if the
// course from there keeps the invariant with all others as they are then; else it brakes. What needs an area that no
// braking frees (a rotation, a part with movers) is refused if that is not free, and has it until it is over.
//
// The broad phase is a grid, hashed by its squares: no more than the movers near the course are looked at. The narrow
// phase are separating axes (area.h). All memory is taken when it is made.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/planar/course.h"

namespace takt::planar {

class Guard {
 public:
  explicit Guard(std::size_t movers = 0);

  // What of a mover stays as it goes.
  struct Figure {
    Area kind{.count = 0};     // its sides, all angles that it turns by, and how far it is off its track (EachArea)
    std::uint32_t system = 0;  // the coordinate system that it is in
    std::uint32_t body = 0;    // movers with the same number, from 1, move as one; 0: it moves alone
    bool on_track = false;     // traffic moves it
  };
  Figure& figure(std::uint32_t mover) noexcept { return figures_[mover]; }
  const Figure& figure(std::uint32_t mover) const noexcept { return figures_[mover]; }
  const Course& course(std::uint32_t mover) const noexcept { return entries_[mover].course; }

  // This is its course from now on, in the coordinate system of its figure.
  void Put(std::uint32_t mover, const Course& course) noexcept { Set(mover, figures_[mover].system, course); }
  // Where its part brings it, from the command on until it arrives.
  void PutThere(std::uint32_t mover, std::uint32_t system, const Course& course) noexcept {
    Set(count_ + mover, system, course);
  }
  void ClearThere(std::uint32_t mover) noexcept;

  // The mover with the least number whose course, or area where it is brought, this one would overlap; kNobody: none.
  // Asked of another mover, and whether it is about where that is brought: `skips` before its course is looked at,
  // `passes` if the courses overlap. Where one returns true, it does not count.
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
  static constexpr std::size_t kSquares = 12;  // that an entry is in; a larger one is near everything
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

  // Calls `look` once for each entry whose extent overlaps this one.
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
  std::vector<Entry> entries_;  // of movers, then of places where they are brought
  // Lists of entries by squares, the last one of those that are in too many.
  std::vector<std::uint32_t> heads_;
  std::vector<std::uint32_t> next_, before_, head_of_;  // by node: kSquares for each entry
  std::vector<std::uint64_t> seen_;                     // by entry: the question it was last looked at for
  std::uint64_t asked_ = 0;
};

}  // namespace takt::planar
