#include "takt/routing/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace takt::routing {
namespace {

constexpr double kSampled = 5e-4;    // s
constexpr int kSamples = 60;         // of the time in which both of a lane move
constexpr double kLagMargin = 5e-4;  // s, for what lies between the samples

}  // namespace

Grid::Grid(int width, int height, double pitch, const Dynamics& dynamics, std::vector<bool> blocked)
    : width_(width),
      height_(height),
      pitch_(pitch),
      blocked_(std::move(blocked)),
      beside_(blocked_.size()),
      room_(blocked_.size()) {
  for (PlaceIndex place = 0; place < size(); ++place) {
    if (this->blocked(place)) continue;
    Beside& its = beside_[static_cast<std::size_t>(place)];
    for (const Direction direction : kDirections) {
      int& room = room_[static_cast<std::size_t>(place)][static_cast<std::size_t>(direction)];
      for (PlaceIndex at = place;;) {
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
  for (int count = 0; count < longest; ++count) {
    Lane lane{
        .run = StraightRun(count * pitch, dynamics), .duration = 0, .entry = {}, .exit = {}, .at = {}, .stop = {}};
    lane.duration = lane.run.duration();
    for (int k = 0; k <= count; ++k) {
      lane.entry.push_back(std::max(0.0, lane.run.LastStopWithin((k - 1) * pitch) - kEarly));
      lane.exit.push_back(lane.run.TimeAt((k + 1) * pitch));
    }
    for (double t = 0; count > 0 && t < lane.duration; t += kSampled) {
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

std::vector<std::int32_t> Grid::StepsTo(PlaceIndex target) const {
  std::vector<std::int32_t> steps(blocked_.size(), kUnreachable);
  std::vector<PlaceIndex> queue{target};
  steps[static_cast<std::size_t>(target)] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const PlaceIndex next : beside(queue[i])) {
      if (steps[static_cast<std::size_t>(next)] < kUnreachable) continue;
      steps[static_cast<std::size_t>(next)] = steps[static_cast<std::size_t>(queue[i])] + 1;
      queue.push_back(next);
    }
  }
  return steps;
}

// Dijkstra over runs.
std::vector<double> Grid::TimesTo(PlaceIndex target) const {
  std::vector<double> times(blocked_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, PlaceIndex>;
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
        const PlaceIndex from = place + count * Step(direction);
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

Direction Grid::Towards(PlaceIndex from, PlaceIndex to) const noexcept {
  if (from == to) return Direction::kNone;
  if (from / width_ == to / width_) return to > from ? Direction::kRight : Direction::kLeft;
  if (from % width_ == to % width_) return to > from ? Direction::kUp : Direction::kDown;
  return Direction::kNone;
}

PlaceIndex Grid::Step(Direction direction) const noexcept {
  switch (direction) {
    case Direction::kRight:
      return 1;
    case Direction::kLeft:
      return -1;
    case Direction::kUp:
      return width_;
    case Direction::kDown:
      return -width_;
    case Direction::kNone:
      break;
  }
  return 0;
}

int Grid::Count(PlaceIndex from, PlaceIndex to) const noexcept {
  const int between = std::abs(to - from);
  return from / width_ == to / width_ ? between : between / width_;
}

int Grid::Along(Direction direction, PlaceIndex place) const noexcept {
  switch (direction) {
    case Direction::kRight:
      return place % width_;
    case Direction::kLeft:
      return -(place % width_);
    case Direction::kUp:
      return place / width_;
    case Direction::kDown:
      return -(place / width_);
    case Direction::kNone:
      break;
  }
  return 0;
}

double Grid::Sample(const std::vector<double>& samples, double t) noexcept {
  if (t <= 0) return samples.front();
  const double scaled = t / kSampled;
  const auto i = static_cast<std::size_t>(scaled);
  if (i + 1 >= samples.size()) return samples.back();
  return samples[i] + (samples[i + 1] - samples[i]) * (scaled - static_cast<double>(i));
}

double Grid::Lag(int leader, int follower, int ahead) const {
  const auto n = lanes_.size();
  double& known = lags_[(static_cast<std::size_t>(leader) * n + static_cast<std::size_t>(follower)) * (2 * n + 1) +
                        static_cast<std::size_t>(ahead + static_cast<int>(n))];
  if (!std::isnan(known)) return known;
  const Lane& front = lane(leader);
  const Lane& back = lane(follower);
  const double offset = ahead * pitch_, least = pitch_ - kSampling / 2;
  const auto apart = [&](double lag) {
    const double from = std::max(0.0, lag), to = std::min(front.duration, lag + back.duration);
    for (int i = 0; from < to && i <= kSamples; ++i) {
      const double t = from + (to - from) * i / kSamples;
      if (offset + Sample(front.at, t) - Sample(back.at, t - lag) < least) return false;
      if (offset + Sample(front.stop, t) - Sample(back.stop, t - lag + kEarly) < least) return false;
    }
    return true;
  };
  double low = -back.duration, high = front.duration;
  if (ahead > 0 && (ahead - follower) * pitch_ >= least && apart(low + kSampled)) {
    return known = -1e6;  // it ends behind where the leader starts
  }
  constexpr int kHalvings = 18;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (apart(middle) ? high : low) = middle;
  }
  return known = high + kLagMargin;
}

}  // namespace takt::routing
