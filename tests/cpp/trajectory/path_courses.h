// Coordinates over an arc length, as formulas, and motion along them with everything a group does with a window: the
// fixture of the tests of path timing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "takt/trajectory/path_pace.h"
#include "takt/trajectory/path_rehearsal.h"
#include "takt/trajectory/path_sampling.h"
#include "takt/trajectory/path_window.h"

namespace takt::trajectory::testing {

inline constexpr double kPeriod = 0.001;
// Shares that a group leaves of the limits of its members.
inline constexpr double kLimitShare = 0.98;

// q(s) = slope s + sum of amplitude sin(frequency s + phase).
struct Formula {
  struct Wave {
    double amplitude = 0, frequency = 0, phase = 0;
  };
  double slope = 0;
  std::vector<Wave> waves;

  double Derivative(int order, double s) const {
    double sum = order == 0 ? slope * s : (order == 1 ? slope : 0);
    for (const Wave& w : waves) {
      sum += w.amplitude * std::pow(w.frequency, order) *
             std::sin(w.frequency * s + w.phase + order * std::numbers::pi / 2);
    }
    return sum;
  }
};

struct Course {
  std::string name;
  double length = 0;
  AlongPath along;
  std::vector<Formula> formulas;
  CoordinateLimits limits;

  bool Slopes(double s, PathSlopes& slopes) const {
    for (std::size_t k = 0; k < formulas.size(); ++k) {
      slopes.first[k] = formulas[k].Derivative(1, s);
      slopes.second[k] = formulas[k].Derivative(2, s);
    }
    return true;
  }
  PathPoint At(double s) const {
    PathPoint point;
    point.s = s;
    point.limits = along;
    Slopes(s, point.slopes);
    return point;
  }
  CoordinateLimits Shared() const {
    CoordinateLimits shared = limits;
    for (auto& one : shared.of) {
      one = {one.velocity * kLimitShare, one.acceleration * kLimitShare, one.jerk * kLimitShare};
    }
    return shared;
  }
};

inline double Uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline double Between(std::mt19937_64& random, double low, double high) {  // uniform in the logarithm
  return std::exp(Uniform(random, std::log(low), std::log(high)));
}

// Winding paths of realistic drives: speeds of 0.2 to 3 m/s, 2 to 30 m/s², accelerations built up in 5 to 60 ms.
inline Course RandomCourse(std::mt19937_64& random) {
  Course course;
  course.length = Between(random, 30, 800);
  const auto limits = [&] {
    const double acceleration = Between(random, 2000, 30000);
    return CoordinateLimits::One{Between(random, 200, 3000), acceleration, acceleration / Between(random, 0.005, 0.06)};
  };
  const CoordinateLimits::One along = limits();
  course.along = {along.velocity, along.acceleration, along.acceleration * Between(random, 0.3, 2), along.jerk};
  course.limits.count = 1 + random() % 4;
  for (std::size_t k = 0; k < course.limits.count; ++k) {
    course.limits.of[k] = limits();
    Formula formula{.slope = Uniform(random, -0.7, 0.7), .waves = {}};
    for (auto n = random() % 4; n > 0; --n) {
      const double frequency = 2 * std::numbers::pi / course.length * Uniform(random, 0.5, 5);
      formula.waves.push_back({Uniform(random, 0.1, 0.5) / frequency, frequency, Uniform(random, 0, 6.3)});
    }
    course.formulas.push_back(formula);
  }
  return course;
}

// The largest shares of limits that were used, along the path and by coordinates; and steps of positions [mm] that
// speeds and accelerations do not explain.
struct Worst {
  double velocity = 0, acceleration = 0, jerk = 0;
  double along_velocity = 0, along_acceleration = 0, along_jerk = 0;
  double step = 0;

  void Take(const Worst& w) {
    velocity = std::max(velocity, w.velocity);
    acceleration = std::max(acceleration, w.acceleration);
    jerk = std::max(jerk, w.jerk);
    along_velocity = std::max(along_velocity, w.along_velocity);
    along_acceleration = std::max(along_acceleration, w.along_acceleration);
    along_jerk = std::max(along_jerk, w.along_jerk);
    step = std::max(step, w.step);
  }
};

inline KinematicState Of(const Formula& q, const KinematicState& way) {
  const double first = q.Derivative(1, way.position);
  return {q.Derivative(0, way.position), first * way.velocity,
          first * way.acceleration + q.Derivative(2, way.position) * way.velocity * way.velocity};
}

// Use of the limits in one cycle. Jerks are differences of accelerations over the cycle.
inline Worst UseOf(const Course& course, const KinematicState& before, const KinematicState& now) {
  Worst w;
  w.along_velocity = std::max(now.velocity, -1e6 * now.velocity) / course.along.velocity;  // never backwards
  w.along_acceleration =
      std::max(now.acceleration / course.along.acceleration, -now.acceleration / course.along.deceleration);
  w.along_jerk = std::abs(now.acceleration - before.acceleration) / kPeriod / course.along.jerk;
  const auto step = [&](const KinematicState& a, const KinematicState& b) {
    return std::abs(b.position - a.position - kPeriod * 0.5 * (a.velocity + b.velocity) +
                    kPeriod * kPeriod / 12 * (b.acceleration - a.acceleration));
  };
  w.step = step(before, now);
  for (std::size_t k = 0; k < course.formulas.size(); ++k) {
    const KinematicState a = Of(course.formulas[k], before), b = Of(course.formulas[k], now);
    const CoordinateLimits::One& limits = course.limits.of[k];
    w.velocity = std::max(w.velocity, std::abs(b.velocity) / limits.velocity);
    w.acceleration = std::max(w.acceleration, std::abs(b.acceleration) / limits.acceleration);
    w.jerk = std::max(w.jerk, std::abs(b.acceleration - a.acceleration) / kPeriod / limits.jerk);
    w.step = std::max(w.step, step(a, b));
  }
  return w;
}

// Motion along a course.
class Motion {
 public:
  explicit Motion(const Course& c) : course(c), window(4096, c.Shared(), kPeriod) {}

  // T as a group finds it, from samples of the whole path.
  void FindBuildUp(double length) {
    BuildUp build_up;
    const int places = std::clamp(static_cast<int>(std::ceil(length / 8)), 4, 64);
    for (int i = 0; i <= places; ++i) build_up.Add(course.At(sampled_to + length * i / places), window.limits());
    window.SetBuildUp(build_up.For(length, kPeriod, kMostBuildUpCycles));
  }
  void SampleBegin() {
    last = course.At(sampled_to);
    window.Append(last);
  }
  // Appends one more node, at `end` at most.
  void SampleNext(double end, bool stop_at_end = false) {
    const PathPoint before = last;
    NextPoint(
        before, end, window.limits(), window.build_up_s(), kPeriod, BendSearch::kInAcceleration,
        [&](double s, PathPoint& point) { return course.Slopes(s, point.slopes); }, last);
    window.Append(last, stop_at_end && last.s >= end);
    sampled_to = last.s;
  }
  void Know() {
    window.Close();
    window.Sweep(1000000);
  }
  // Appends everything, from rest to rest.
  void Plan() {
    FindBuildUp(course.length);
    SampleBegin();
    while (sampled_to < course.length) SampleNext(course.length, true);
    Know();
    BeginAt(window, window.begin(), kPeriod, pace);
    rehearsal.GoOn(window);
    while (!rehearsal.Run(window, pace, 1000, 0, kPeriod)) {
    }
  }
  void Cycle(double wish) {
    const KinematicState before = pace.now;
    Advance(window, wish, kPeriod, pace);
    worst.Take(UseOf(course, before, pace.now));
    ++cycles;
  }
  // Returns false if it does not come to rest.
  bool ToRest(double wish, int most_cycles = 20000) {
    for (int i = 0; i < most_cycles; ++i) {
      if (Stands(pace) && (pace.raw_stands || wish == 0)) return true;
      Cycle(wish);
    }
    return false;
  }

  const Course& course;
  PathWindow window;
  PathRehearsal rehearsal;
  PathPace pace;
  PathPoint last;
  double sampled_to = 0;
  Worst worst;
  int cycles = 0;
};

}  // namespace takt::trajectory::testing
