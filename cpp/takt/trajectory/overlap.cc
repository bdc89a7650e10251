#include "takt/trajectory/overlap.h"

#include <algorithm>
#include <cmath>

namespace takt::trajectory {

double OverlapTime(const Profile& first, const Profile& second, double turn, double deviation) noexcept {
  const double most = 0.5 * std::min(first.duration(), second.duration());
  if (!(deviation > 0)) return 0;
  const double begin = second.start().position;
  const double length = std::abs(second.end().position - begin);
  if (deviation >= turn * length) return most;
  const double there = begin + std::copysign(deviation / turn, second.end().position - begin);
  const double half = second.TimeAt(there);
  return std::isnan(half) ? most : std::min(most, 2 * half);
}

ReferenceRate OverlapRate(const Profile& first, const Profile& second, double overlap_s, double t, double inside,
                          double first_slope, double second_slope) noexcept {
  const double before = first.duration() - overlap_s;
  const KinematicState one = first.At(before + t);
  const KinematicState two = second.At(t);
  return {first_slope * one.velocity + second_slope * two.velocity,
          first_slope * one.acceleration + second_slope * two.acceleration,
          first_slope * first.JerkAt(before + inside) + second_slope * second.JerkAt(inside)};
}

ReferenceRate ArcRate(std::span<const ReferenceRate> coordinates) noexcept {
  double speed = 0, along = 0, square = 0;  // x'x', x'x'', x''x'' + x'x'''
  for (const ReferenceRate& c : coordinates) {
    speed += c.first * c.first;
    along += c.first * c.second;
    square += c.second * c.second + c.first * c.third;
  }
  if (!(speed > 0)) return {};
  speed = std::sqrt(speed);
  const double second = along / speed;
  return {speed, second, (square - second * second) / speed};
}

}  // namespace takt::trajectory
