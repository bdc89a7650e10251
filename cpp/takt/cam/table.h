// A cam for evaluation: immutable, replaced as a whole (CAM-05). Made by Build (build.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/cam/curve.h"
#include "takt/cam/params.h"

namespace takt::cam {

class Table {
 public:
  // An unused entry: size() is 0, and no other query is allowed.
  Table() = default;
  // Requires: `begins` in ascending order, the last piece up to `end`; finite numbers (Build checks them). The last y
  // is that of the source, without rounding, so that the stroke does not accumulate a drift (CAM-21).
  Table(CamParams source, std::span<const double> begins, std::span<const Curve> curves, double end);

  const std::string& name() const noexcept { return source_.name; }
  // The description from which it was built, points of a file included (CAM-71).
  const CamParams& source() const noexcept { return source_; }
  bool cyclic() const noexcept { return source_.cyclic; }
  // Unique in a machine: from 1 in the order of its file, then in the order in which cams are made at run time.
  std::uint64_t number() const noexcept { return number_; }
  void SetNumber(std::uint64_t number) noexcept { number_ = number; }
  // Its name refers to another table, or to none; axes and modules that refer to it continue.
  bool superseded() const noexcept { return superseded_; }
  void Supersede() noexcept { superseded_ = true; }

  double begin() const noexcept { return begin_; }               // [x]
  double end() const noexcept { return end_; }                   // [x]
  double length() const noexcept { return end_ - begin_; }       // [x] of a cycle
  double lowest() const noexcept { return lowest_; }             // [y]
  double highest() const noexcept { return highest_; }           // [y]
  double stroke() const noexcept { return last_.y - first_.y; }  // [y] At(end()).y - At(begin()).y

  // O(1): the cost does not depend on the number of points, unless they are clustered (CAM-04). Does not allocate. At a
  // joint: the piece after it; at the end: the last piece. Outside the cam: the value at the near end, derivatives
  // included (a caller that holds the end position must set them to 0); NaN: the value at begin().
  Value At(double x) const noexcept;

  // The pieces.
  std::size_t size() const noexcept { return pieces_.size(); }
  std::size_t PieceAt(double x) const noexcept;
  double BeginOf(std::size_t piece) const noexcept { return pieces_[piece].x; }
  double EndOf(std::size_t piece) const noexcept { return piece + 1 < size() ? pieces_[piece + 1].x : end_; }
  Curve CurveOf(std::size_t piece) const noexcept;  // over the distance from BeginOf

 private:
  static constexpr std::uint32_t kPlain = 0xffffffff;

  // One cache line.
  struct alignas(64) Piece {
    double x = 0;
    double c[6] = {};
    std::uint32_t more = kPlain;  // index into more_
  };
  // Coefficients that only a few laws need.
  struct More {
    bool polynomial = false;  // of a degree above 5
    double c6 = 0, c7 = 0, c8 = 0;
    double amplitude = 0, frequency = 0, phase = 0;
    double amplitude2 = 0, phase2 = 0;
  };

  std::size_t BucketOf(double x) const noexcept { return static_cast<std::size_t>((x - begin_) * buckets_per_x_); }
  static void Add(const More& more, double d, Value& value) noexcept;

  double begin_ = 0;
  double end_ = 0;
  double lowest_ = 0, highest_ = 0;
  double buckets_per_x_ = 0;
  Value first_, last_;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> before_;  // for each bucket: number of pieces that begin in buckets before it
  std::vector<More> more_;
  CamParams source_;
  std::uint64_t number_ = 0;
  bool superseded_ = false;
};

// Returns the index of the table that a name refers to; nothing if there is none. The last one of several: a cam made
// at run time hides one of the machine file.
std::optional<std::uint32_t> Find(std::span<const Table> tables, std::string_view name) noexcept;

}  // namespace takt::cam
