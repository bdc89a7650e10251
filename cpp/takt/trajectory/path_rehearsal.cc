#include "takt/trajectory/path_rehearsal.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"

namespace takt::trajectory {

namespace {

constexpr int kRounds = 4;
// How often a stretch that was weakened is run again at once.
constexpr int kTries = 6;
// Distance between saved states, as a multiple of T.
constexpr int kApart = 1;
// Reduced a little more than necessary, so that the next round need not do it again.
constexpr double kMore = 0.002;
constexpr double kLeastShare = 0.5;  // least share applied by one round
// Share of a jerk limit that bends alone may use before the speed has to fall.
constexpr double kBendShare = 0.9;
// Multiple of T for which the motion runs ahead before a longer path makes a difference.
constexpr double kBefore = 2;

}  // namespace

void PathRehearsal::Clear() noexcept {
  started_ = marked_ = weakened_ = trouble_ = again_ = measuring_ = false;
  through_ = true;
  end_cycle_ = 0;
  rounds_ = 0;
}

void PathRehearsal::GoOn(const PathWindow& window) noexcept {
  through_ = measuring_ = false;
  end_cycle_ = 0;
  rounds_ = 0;
  if (started_ && here_.pace.node >= window.changed_from()) {
    if (marked_ && mark_.pace.node < window.changed_from()) {
      here_ = mark_;
    } else {
      started_ = false;
    }
  }
  marked_ = false;
  free_until_ = window[window.free_until()].at.s;
}

double PathRehearsal::AheadOf(std::uint64_t cycle, double period_s) const noexcept {
  return here_.cycle > cycle ? static_cast<double>(here_.cycle - cycle) * period_s : 0;
}

void PathRehearsal::StartFrom(const PathPace& pace, std::uint64_t cycle) noexcept {
  here_.pace = pace;
  here_.cycle = cycle;
  here_.positions.fill(std::numeric_limits<double>::quiet_NaN());
  started_ = true;
  marked_ = weakened_ = trouble_ = again_ = false;
  here_.accelerations.fill(std::numeric_limits<double>::quiet_NaN());
  tries_ = 0;
  tried_to_ = pace.raw.position;
  saved_.fill(here_);
  until_save_ = 0;
}

void PathRehearsal::Save() noexcept {
  if (--until_save_ > 0) return;
  saved_[save_to_] = here_;
  save_to_ = (save_to_ + 1) % saved_.size();
  until_save_ = kApart * static_cast<int>(here_.pace.cycles);
}

bool PathRehearsal::Run(PathWindow& window, const PathPace& now, int cycles, std::uint64_t cycle, double period_s,
                        const PathProbe& probe) noexcept {
  if (!window.swept()) return through_;
  for (; cycles > 0 && !through_; --cycles) {
    if (again_) GoBack(window);
    if (!started_ || here_.pace.passed < now.passed) StartFrom(now, cycle);
    if (here_.pace.raw_stands && Stands(here_.pace)) {
      if (trouble_) {
        EndTrouble(window, now, period_s);
      } else if (window[here_.pace.node].stop && here_.pace.node + 2 < window.known()) {
        BeginAt(window, here_.pace.node + 1, period_s, here_.pace);  // behind a stop the next motion begins
        // Accelerations in the previous cycle: 0, or those of the carriers.
        const double before_s = std::max(0.0, AheadOf(cycle, period_s) - period_s);
        PathCoordinateValues velocities;
        const bool probed = probe.look && probe.look(probe.owner, here_.pace.now, before_s, here_.positions, velocities,
                                                     here_.accelerations);
        if (!probed) here_.accelerations.fill(0);
      } else {
        if (!weakened_) {
          through_ = true;
          end_cycle_ = here_.cycle - 1;
        } else if (++rounds_ >= kRounds) {
          measuring_ = true;
        }
        started_ = false;
      }
      continue;
    }
    Save();
    const KinematicState before = here_.pace.now;
    const double from = here_.pace.last[here_.pace.oldest].position;
    if (trouble_ && from > to_) {
      EndTrouble(window, now, period_s);
      continue;
    }
    Advance(window, kFullSpeed, period_s, here_.pace);
    const double ahead_s = AheadOf(cycle, period_s);
    ++here_.cycle;
    if (!measuring_) Look(window, before, ahead_s, period_s, probe);
    const double ahead = kBefore * here_.pace.raw.velocity * period_s * here_.pace.cycles;
    if (!marked_ && here_.pace.raw.position + ahead >= free_until_) {
      mark_ = here_;
      marked_ = true;
    }
  }
  return through_;
}

// Checks what this cycle demands of the coordinates.
void PathRehearsal::Look(const PathWindow& window, const KinematicState& before, double ahead_s, double period_s,
                         const PathProbe& probe) noexcept {
  const CoordinateLimits& limits = window.limits();
  const PathNode& node = window[here_.pace.passed];
  const PathNode& next = here_.pace.passed + 1 < window.known() ? window[here_.pace.passed + 1] : node;
  const KinematicState& mean = here_.pace.now;
  const double length = next.at.s - node.at.s;
  const double x = mean.position - node.at.s;
  const double part = length > 0 ? std::clamp(x / length, 0.0, 1.0) : 0;
  const double jerk = (mean.acceleration - before.acceleration) / period_s;
  PathShares shares;
  PathCoordinateValues velocities, accelerations;
  KinematicState place = mean;
  // At a stop: on the path that leads there, not on the one that begins there.
  if (here_.pace.raw_stands && Stands(here_.pace)) {
    place.position = std::min(place.position, std::nextafter(window[here_.pace.node].at.s, -kFullSpeed));
  }
  const bool probed = probe.look && probe.look(probe.owner, place, ahead_s, here_.positions, velocities, accelerations);
  for (std::size_t k = 0; k < limits.count; ++k) {
    const PathSlopes &a = node.at.slopes, &b = next.at.slopes;
    const double bend = b.second[k] - a.second[k];
    const double second = a.second[k] + part * bend;
    // The second slope is linear between the nodes; the remaining gap between their first slopes is rounding.
    const double gap = b.first[k] - a.first[k] - length * (a.second[k] + 0.5 * bend);
    const double first = a.first[k] + x * (a.second[k] + 0.5 * part * bend) + part * gap;
    const double by_way = first * mean.acceleration + second * mean.velocity * mean.velocity;
    const double acceleration = probed ? accelerations[k] : by_way;
    const double total = std::abs(acceleration - here_.accelerations[k]) / period_s;
    here_.accelerations[k] = acceleration;
    const Left &here = node.at.left[k], &there = next.at.left[k];
    const double left = probed ? 1 : std::lerp(here.acceleration, there.acceleration, part);
    const double over = std::abs(acceleration) / (left * limits.of[k].acceleration);
    const double most = (probed ? 1 : std::lerp(here.jerk, there.jerk, part)) * limits.of[k].jerk;
    if (probed && std::abs(velocities[k]) > limits.of[k].velocity) {
      const double speed = limits.of[k].velocity / std::abs(velocities[k]);
      shares.square = std::min(shares.square, speed * speed);
    }
    if (over > 1) {
      shares.square = std::min(shares.square, 1 / over);
      shares.acceleration = std::min(shares.acceleration, 1 / over);
    }
    if (!(total > most)) continue;
    // The share due to accelerations along the path, and the rest, which remains without them.
    const double turning = std::abs(first * jerk + 3 * second * mean.velocity * mean.acceleration);
    const double bends = std::max(0.0, total - turning);
    const double room = std::max(most - bends, (1 - kBendShare) * most);
    if (turning > room) shares.strength = std::min(shares.strength, room / turning);
    if (bends > kBendShare * most) {
      const double speed = maths::Cbrt(kBendShare * most / bends);
      shares.square = std::min(shares.square, speed * speed);
    }
  }
  if (shares.square >= 1 && shares.strength >= 1) return;
  if (!trouble_) {
    trouble_ = true;
    from_ = here_.pace.last[here_.pace.oldest].position;
    shares_ = {};
  }
  to_ = here_.pace.raw.position;
  const auto take = [](double& share, double more) {
    if (more < 1) share = std::min(share, std::max(kLeastShare, more - kMore));
  };
  take(shares_.square, shares.square);
  take(shares_.acceleration, shares.acceleration);
  take(shares_.strength, shares.strength);
}

// Returns to the last saved state that the present change does not affect.
void PathRehearsal::GoBack(const PathWindow& window) noexcept {
  again_ = false;
  for (std::size_t i = 0; i < saved_.size(); ++i) {
    save_to_ = (save_to_ + saved_.size() - 1) % saved_.size();
    if (saved_[save_to_].pace.node >= window.changed_from()) continue;
    here_ = saved_[save_to_];
    until_save_ = 0;
    return;
  }
}

void PathRehearsal::EndTrouble(PathWindow& window, const PathPace& now, double period_s) noexcept {
  trouble_ = false;
  window.Weaken(from_, to_, now.node + 1, shares_);
  if (!GoesOn(window, now, period_s)) return window.TakeBack();  // too near: the motion could no longer keep it
  weakened_ = true;
  if (from_ > tried_to_) tries_ = 0;
  tried_to_ = std::max(tried_to_, to_);
  again_ = tries_++ < kTries;
}

}  // namespace takt::trajectory
