#include "takt/routing/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace takt::routing {
namespace {

constexpr double kSampled = 5e-4;  // [s], at least
// of the longest run at most: bounds time and memory for slow movers
constexpr double kMostSamples = 20'000;
constexpr double kNoLag = -1e6;  // [s] the run ends behind the start of the leader

}  // namespace

Grid::Grid(int width, int height, double pitch, double mover_size, const Dynamics& dynamics, std::vector<bool> blocked)
    : width_(width),
      height_(height),
      pitch_(pitch),
      mover_size_(mover_size),
      blocked_(std::move(blocked)),
      beside_(blocked_.size()),
      steps_{0, 1, -1, width, -width},
      room_(blocked_.size()) {
  for (CellIndex place = 0; place < size(); ++place) {
    const int column = place % width_, row = place / width_;
    along_.push_back({0, column, -column, row, -row});
    if (this->blocked(place)) continue;
    Beside& its = beside_[static_cast<std::size_t>(place)];
    for (const Direction direction : kDirections) {
      int& room = room_[static_cast<std::size_t>(place)][static_cast<std::size_t>(direction)];
      for (CellIndex at = place;;) {
        const int x = at % width_, y = at / width_;
        const bool last = direction == Direction::kRight  ? x + 1 == width_
                          : direction == Direction::kLeft ? x == 0
                          : direction == Direction::kUp   ? y + 1 == height_
                                                          : y == 0;
        if (last) break;
        at += Step(direction);
        if (this->blocked(at)) break;
        ++room;
      }
      if (room > 0) its.places[its.count++] = place + Step(direction);
    }
  }
  const int longest = std::max(width_, height_);
  sampled_ = std::max(kSampled, StraightRun((longest - 1) * pitch, dynamics).duration() / kMostSamples);
  for (int count = 0; count < longest; ++count) {
    Lane lane{.run = StraightRun(count * pitch, dynamics),
              .duration = 0,
              .entry = {},
              .exit = {},
              .middle = {},
              .at = {},
              .stop = {}};
    lane.duration = lane.run.duration();
    for (int k = 0; k <= count; ++k) {
      lane.entry.push_back(std::max(0.0, lane.run.LastStopWithin((k - 1) * pitch) - kEarly));
      lane.exit.push_back(lane.run.TimeAt(k * pitch + (pitch + mover_size) / 2));
      lane.middle.push_back(lane.run.TimeAt(k * pitch));
    }
    for (double t = 0; count > 0 && t < lane.duration; t += sampled_) {
      lane.at.push_back(lane.run.At(t));
      lane.stop.push_back(lane.run.StopAt(t));
    }
    lane.at.push_back(lane.run.length());
    lane.stop.push_back(lane.run.length());
    lanes_.push_back(std::move(lane));
  }
  const auto n = static_cast<std::size_t>(longest);
  lags_.assign(n * n * (2 * n + 1), std::numeric_limits<double>::quiet_NaN());
}

std::vector<std::int32_t> Grid::StepsTo(CellIndex target) const {
  std::vector<std::int32_t> steps(blocked_.size(), kUnreachable);
  std::vector<CellIndex> queue{target};
  steps[static_cast<std::size_t>(target)] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const CellIndex next : beside(queue[i])) {
      if (steps[static_cast<std::size_t>(next)] < kUnreachable) continue;
      steps[static_cast<std::size_t>(next)] = steps[static_cast<std::size_t>(queue[i])] + 1;
      queue.push_back(next);
    }
  }
  return steps;
}

// Dijkstra over runs.
std::vector<double> Grid::TimesTo(CellIndex target) const {
  std::vector<double> times(blocked_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, CellIndex>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  times[static_cast<std::size_t>(target)] = 0;
  open.emplace(0.0, target);
  while (!open.empty()) {
    const auto [time, place] = open.top();
    open.pop();
    if (time > times[static_cast<std::size_t>(place)]) continue;
    for (const Direction direction : kDirections) {
      const int room = Room(direction, place);
      for (int count = 1; count <= room; ++count) {
        const CellIndex from = place + count * Step(direction);
        double& known = times[static_cast<std::size_t>(from)];
        if (const double one = time + Duration(count); one < known) {
          known = one;
          open.emplace(one, from);
        }
      }
    }
  }
  return times;
}

Direction Grid::Towards(CellIndex from, CellIndex to) const noexcept {
  if (from == to) return Direction::kNone;
  if (from / width_ == to / width_) return to > from ? Direction::kRight : Direction::kLeft;
  if (from % width_ == to % width_) return to > from ? Direction::kUp : Direction::kDown;
  return Direction::kNone;
}

int Grid::Count(CellIndex from, CellIndex to) const noexcept {
  const int between = std::abs(to - from);
  return from / width_ == to / width_ ? between : between / width_;
}

double Grid::Lag(int leader, int follower, int ahead) const {
  const auto n = lanes_.size();
  double& known = lags_[(static_cast<std::size_t>(leader) * n + static_cast<std::size_t>(follower)) * (2 * n + 1) +
                        static_cast<std::size_t>(ahead + static_cast<int>(n))];
  if (!std::isnan(known)) return known;
  const Lane& front = lane(leader);
  const Lane& back = lane(follower);
  const double behind = mover_size_ - ahead * pitch_;
  double lag = kNoLag;
  // Both functions increase, so the time of one sample and the position of the next one give a bound between two
  // samples.
  std::size_t k = 0;
  for (std::size_t i = 0; i < back.stop.size(); ++i) {
    const double place = back.stop[i] + behind;  // position that the leader must have reached by then
    if (place <= 0) continue;
    while (k < front.at.size() && front.at[k] < place) ++k;
    const double there = std::min(static_cast<double>(k) * sampled_, front.duration);
    lag = std::max(lag, there - static_cast<double>(i > 0 ? i - 1 : 0) * sampled_ + kEarly);
  }
  return known = lag;
}

}  // namespace takt::routing
