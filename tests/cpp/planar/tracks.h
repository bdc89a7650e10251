// Random tracks, and measurements of them.
#pragma once

#include <gtest/gtest.h>

#include <numbers>
#include <ostream>
#include <random>
#include <vector>

#include "takt/planar/builder.h"
#include "takt/planar/track.h"

namespace takt::planar {

inline void PrintTo(Problem problem, std::ostream* stream) {
  *stream << '"' << (problem == Problem::kNone ? "none" : Text(problem)) << '"';
}

namespace testing {

inline constexpr double kPi = std::numbers::pi;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Between(double lower, double upper) { return std::uniform_real_distribution<>(lower, upper)(engine_); }
  bool Coin() { return engine_() % 2 == 0; }
  int Below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937 engine_;
};

Element Line(const Place& start, const Place& end);
Element Position(const Place& place);
Element Arc(const Place& start, const Place& end, const Place& center, bool clockwise);
Place Ahead(const Place& from, double direction, double distance);
double Distance(const Place& a, const Place& b);

// Makes a track that must be valid.
Track Make(const Layout& layout);

// Random lines, arcs and positions with gaps, as users leave them, some of them invalid; about a third closed.
Layout RandomLayout(Random& random);
// A random valid layout.
Track RandomTrack(Random& random);

TrackPoint StartOf(const Track& track);
TrackPoint EndOf(const Track& track);

// Returns the length [mm] from the start to s, from points only: sums of chords, finer and finer.
double LengthTo(const Track& track, double s);

}  // namespace testing
}  // namespace takt::planar
