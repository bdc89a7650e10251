// Speed ceilings for a motion along a path of which a window is known: never so fast that a limit ahead could not be
// kept.
//
// The motion is made in two steps. A raw motion, with accelerations that may step, keeps all limits of velocity and
// acceleration; the commanded motion is its mean over the time T in which accelerations build up. So the acceleration
// takes at least T from one value to another, and its bound follows from the jerk allowed along the path and from that
// of the coordinates (AccelerationCapAt). The mean comes to rest T after the raw motion does.
//
// From the end of the window backwards each node gets its ceiling: the largest speed of the raw motion from which the
// rest of the window can still be travelled within all limits, down to a stop at its end. While the speed is below the
// ceiling, an admissible acceleration exists that keeps it below in the next cycle. When more of the path becomes known
// ceilings rise, except at the nodes just before the new part, from which the mean reaches into it.
//
// On bends the mean of the raw accelerations is not the acceleration of the mean, so for coordinates all this is only
// approximately right: PathRehearsal checks the result and weakens stretches where it is too much.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/trajectory/path_limits.h"

namespace takt::trajectory {

// Remaining shares of the limits of a stretch.
struct PathShares {
  double square = 1;        // of the squared speed
  double acceleration = 1;  // of the coordinates' acceleration
  double strength = 1;      // of the acceleration that the coordinates' jerk allows
};

struct PathNode {
  PathPoint at;
  AccelerationBounds bounds;
  double build_up_s = 0;         // T
  AccelerationCap own_strength;  // from the bends at this node; bounds.strength includes those of nearby nodes
  // Squared speeds [mm²/s²].
  double own = 0;      // from the limits at this node
  double cap = 0;      // including the limits of nodes so near that the mean is taken over them, too
  double ceiling = 0;  // largest one from which everything ahead can be kept
  double coast = 0;    // largest one from which there is time to remove an acceleration first
  bool stop = false;   // the motion stops here; the path continues with a node at the same arc length
};

// A queue of nodes. Allocates only in the constructor.
class PathWindow {
 public:
  // Requires: `capacity` >= 2.
  PathWindow(std::size_t capacity, const CoordinateLimits& limits, double period_s);

  void Clear() noexcept;
  // Sets T for nodes appended from now on, behind a stop.
  void SetBuildUp(double build_up_s) noexcept { build_up_s_ = build_up_s; }
  double build_up_s() const noexcept { return build_up_s_; }
  void SetLimits(const CoordinateLimits& limits) noexcept { limits_ = limits; }
  const CoordinateLimits& limits() const noexcept { return limits_; }

  // Nodes are numbered consecutively from the first one ever appended.
  std::uint64_t begin() const noexcept { return begin_; }
  std::uint64_t end() const noexcept { return end_; }
  // Returns the number after the last node that the ceilings take into account.
  std::uint64_t known() const noexcept { return known_; }
  std::size_t room() const noexcept { return nodes_.size() - static_cast<std::size_t>(end_ - begin_); }
  const PathNode& operator[](std::uint64_t i) const noexcept { return nodes_[i % nodes_.size()]; }

  // Appends a node; the ceilings do not take it into account yet. `stop`: the motion stops there; the next node begins
  // another motion at the same arc length. Requires: room() > 0, s does not fall.
  void Append(const PathPoint& point, bool stop = false) noexcept;
  // Takes all appended nodes into account, with a stop at the last node as long as none follows.
  void Close() noexcept;
  // Updates the ceilings of at most `nodes` nodes. Returns true if the sweep is complete.
  bool Sweep(std::size_t nodes) noexcept;
  bool swept() const noexcept { return next_ == low_; }
  // Returns the first node at which Sweep has changed anything since Close or Weaken.
  std::uint64_t changed_from() const noexcept { return low_; }
  // Returns the last node whose ceiling a longer path would not raise.
  std::uint64_t free_until() const noexcept;
  // Reduces the limits between two arc lengths, from the node `first` on and for at most 64 nodes, and sweeps.
  // Requires: swept().
  void Weaken(double from, double to, std::uint64_t first, const PathShares& shares) noexcept;
  // Undoes the last Weaken.
  void TakeBack() noexcept;
  void DropBefore(std::uint64_t node) noexcept;
  // Makes the end of the known path a stop for good.
  void Stay() noexcept;
  // Removes everything behind this node, at which the path now stops; ceilings before it are lowered at once.
  void CutBehind(std::uint64_t node) noexcept;

 private:
  PathNode& Node(std::uint64_t i) noexcept { return nodes_[i % nodes_.size()]; }
  bool IsFirst(std::uint64_t i) const noexcept { return i == begin_ || (*this)[i - 1].stop; }
  void Spread(std::uint64_t i) noexcept;
  bool Raise(std::uint64_t i) noexcept;
  double CoastFrom(std::uint64_t i) const noexcept;
  void SweepFrom(std::uint64_t behind) noexcept;

  std::vector<PathNode> nodes_;
  std::vector<PathNode> kept_;  // nodes as they were before Weaken, the last node first
  std::uint64_t kept_from_ = 0;
  CoordinateLimits limits_;
  double period_s_;
  double build_up_s_ = 0;
  std::uint64_t begin_ = 0, end_ = 0;
  std::uint64_t known_ = 0;
  std::uint64_t next_ = 0;    // node after the one that Sweep updates next, descending to ...
  std::uint64_t low_ = 0;     // ... this one, or further while ceilings still change
  std::uint64_t lowest_ = 0;  // first node that was lowered by those appended since Close
};

}  // namespace takt::trajectory
