#include "tracks.h"

#include <algorithm>
#include <cmath>

namespace takt::planar::testing {

Element Line(const Place& start, const Place& end) {
  return {ElementShape::kLine, start, end};
}

Element Position(const Place& place) {
  return {ElementShape::kPosition, {}, place};
}

Element Arc(const Place& start, const Place& end, const Place& center, bool clockwise) {
  return {ElementShape::kArc, start, end, center, clockwise};
}

Place Ahead(const Place& from, double direction, double distance) {
  return {from.x + distance * std::cos(direction), from.y + distance * std::sin(direction)};
}

double Distance(const Place& a, const Place& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

Track Make(const Layout& layout) {
  Track track;
  EXPECT_EQ(MakeTrack(layout, track).problem, Problem::kNone);
  return track;
}

Layout RandomLayout(Random& random) {
  Layout layout;
  layout.closed = random.Below(3) == 0;
  Place place{random.Between(-500, 500), random.Between(-500, 500)};
  double direction = random.Between(-3.1, 3.1);
  const int count = 1 + random.Below(7);
  for (int i = 0; i < count; ++i) {
    const int shape = random.Below(3);
    if (shape == 0) {
      layout.elements.push_back(Position(place));
    } else if (shape == 1) {
      const Place start = place;
      place = Ahead(place, direction, random.Between(20, 300));
      layout.elements.push_back(Line(start, place));
    } else {
      const Place start = place;
      const bool clockwise = random.Coin();
      const double side = clockwise ? -1 : 1;
      const double radius = random.Between(30, 200);
      const double angle = side * random.Between(0.2, 4);
      const Place center = Ahead(start, direction + side * M_PI / 2, radius);
      direction += angle;
      place = Ahead(center, direction - side * M_PI / 2, radius);
      layout.elements.push_back(Arc(start, place, center, clockwise));
    }
    place = Ahead(place, direction + random.Between(-1, 1), random.Between(30, 200));
    direction += random.Between(-1.7, 1.7);
  }
  return layout;
}

Track RandomTrack(Random& random) {
  for (int i = 0; i < 100; ++i) {
    Track track;
    if (MakeTrack(RandomLayout(random), track).problem == Problem::kNone) return track;
  }
  ADD_FAILURE() << "none of 100";
  return {};
}

TrackPoint StartOf(const Track& track) {
  return At(track, 0);
}

TrackPoint EndOf(const Track& track) {
  return At(track.pieces.back(), track.pieces.back().segment.length);
}

double LengthTo(const Track& track, double s) {
  double sum = 0;
  for (const Piece& piece : track.pieces) {
    const double rest = std::min(s - piece.start, piece.segment.length);
    if (rest <= 0) break;
    const auto lines = [&](double from, double to, int count) {
      double length = 0;
      Place last = At(piece, from).place;
      for (int i = 1; i <= count; ++i) {
        const Place next = At(piece, std::lerp(from, to, static_cast<double>(i) / count)).place;
        length += Distance(last, next);
        last = next;
      }
      return length;
    };
    double from = 0;
    while (from < rest) {
      const double to = std::min(rest, from + 5);
      const double one = lines(from, to, 50), two = lines(from, to, 100), four = lines(from, to, 200);
      const double better = two + (two - one) / 3, best = four + (four - two) / 3;
      sum += best + (best - better) / 15;
      from = to;
    }
  }
  return sum;
}

}  // namespace takt::planar::testing
