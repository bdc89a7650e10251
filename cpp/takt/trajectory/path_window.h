// How fast something may go along a path of which a window is known: never so fast that a limit ahead could not be
// kept.
//
// The motion is made in two steps. A raw motion, with accelerations that may step, keeps all limits of velocity and
// acceleration; what is gone is its mean over the time T in which accelerations build up. So the acceleration takes at
// least T from one value to another, and what it may be at all follows from the jerk allowed along the way, and from
// that of the coordinates (AccelerationCapAt). The mean comes to rest T after the raw motion does.
//
// From the end of the window backwards each node gets its ceiling: the largest speed of the raw motion from which the
// rest of the window can still be gone within all limits, down to a stop at its end. Whoever is beneath the ceiling in
// one cycle finds an acceleration within the limits that leads beneath it in the next one. Where more of the path
// becomes known ceilings rise, but for those just before it, which the mean reaches from there.
//
// On bends the mean of the raw accelerations is not the acceleration of the mean, so all this is only nearly right for
// coordinates: PathRehearsal looks at what comes of it and weakens places where it is too much.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/trajectory/path_limits.h"

namespace takt::trajectory {

// What is left of the limits of a stretch.
struct PathShares {
  double square = 1;        // of the speed
  double acceleration = 1;  // of the coordinates
  double strength = 1;      // of what their jerk allows
};

struct PathNode {
  PathPoint at;
  AccelerationBounds bounds;
  double build_up_s = 0;         // T
  AccelerationCap own_strength;  // what the bends at this place say; those of bounds hold for places near by, too
  // Squares of speeds.
  double own = 0;      // what the limits at this place say
  double cap = 0;      // and those of places so near that the mean is taken over them, too
  double ceiling = 0;  // from where all that is ahead can be kept
  double coast = 0;    // from where there is time to take an acceleration back before
  bool stop = false;   // the motion stops here; what comes behind begins with a node at the same place
};

// A queue of nodes. Takes memory only when it is made.
class PathWindow {
 public:
  // `capacity` >= 2.
  PathWindow(std::size_t capacity, const CoordinateLimits& limits, double period_s);

  void Clear() noexcept;
  // T for what is appended from now on, behind a stop.
  void SetBuildUp(double build_up_s) noexcept { build_up_s_ = build_up_s; }
  double build_up_s() const noexcept { return build_up_s_; }
  void SetLimits(const CoordinateLimits& limits) noexcept { limits_ = limits; }
  const CoordinateLimits& limits() const noexcept { return limits_; }

  // Nodes are numbered through from the first one ever appended.
  std::uint64_t begin() const noexcept { return begin_; }
  std::uint64_t end() const noexcept { return end_; }
  // Behind the last node that ceilings know of.
  std::uint64_t known() const noexcept { return known_; }
  std::size_t room() const noexcept { return nodes_.size() - static_cast<std::size_t>(end_ - begin_); }
  const PathNode& operator[](std::uint64_t i) const noexcept { return nodes_[i % nodes_.size()]; }

  // There must be room, s must not fall. No ceiling knows of the node yet. `stop`: the motion stops there, the next
  // node begins another one at the same place.
  void Append(const PathPoint& point, bool stop = false) noexcept;
  // Takes everything appended into the ceilings, with a stop at the last node for as long as nothing comes behind it.
  void Close() noexcept;
  // Works on the ceilings of so many nodes at most. True: it is through.
  bool Sweep(std::size_t nodes) noexcept;
  bool swept() const noexcept { return next_ == low_; }
  // The first node at which Sweep has changed anything since Close or Weaken.
  std::uint64_t changed_from() const noexcept { return low_; }
  // The last node whose ceiling a longer path would not raise.
  std::uint64_t free_until() const noexcept;
  // Leaves less to what lies between two places, to some 64 nodes at most, from a node on; and sweeps. Only once Sweep
  // is through.
  void Weaken(double from, double to, std::uint64_t first, const PathShares& shares) noexcept;
  // Undoes the last Weaken.
  void TakeBack() noexcept;
  void DropBefore(std::uint64_t node) noexcept;
  // The end that is known is a stop for good.
  void Stay() noexcept;
  // Forgets everything behind this node, at which the path stops now: ceilings there are lowered at once.
  void CutBehind(std::uint64_t node) noexcept;

 private:
  PathNode& Node(std::uint64_t i) noexcept { return nodes_[i % nodes_.size()]; }
  bool IsFirst(std::uint64_t i) const noexcept { return i == begin_ || (*this)[i - 1].stop; }
  void Spread(std::uint64_t i) noexcept;
  bool Raise(std::uint64_t i) noexcept;
  double CoastFrom(std::uint64_t i) const noexcept;
  void SweepFrom(std::uint64_t behind) noexcept;

  std::vector<PathNode> nodes_;
  std::vector<PathNode> kept_;  // what was before Weaken, the last node first
  std::uint64_t kept_from_ = 0;
  CoordinateLimits limits_;
  double period_s_;
  double build_up_s_ = 0;
  std::uint64_t begin_ = 0, end_ = 0;
  std::uint64_t known_ = 0;
  std::uint64_t next_ = 0;    // behind the node that Sweep looks at next, going down to ...
  std::uint64_t low_ = 0;     // ... this one, unless nothing changes any more
  std::uint64_t lowest_ = 0;  // the first node that what was appended since has lowered
};

}  // namespace takt::trajectory
