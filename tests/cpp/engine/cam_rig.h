// Cams for tests, with their closed forms.
#pragma once

#include <cmath>

#include "line.h"

namespace takt::engine {

// y and its derivatives over the share s of a length of 1, raised by 1: the polynomial 3-4-5.
struct Polynomial345 {
  static double Y(double s) { return s * s * s * (10 - 15 * s + 6 * s * s); }
  static double Dy(double s) { return 30 * s * s * (1 - s) * (1 - s); }
  static double Ddy(double s) { return 60 * s * (1 - s) * (1 - 2 * s); }
};

inline cam::CamPoint Rest(double x, double y) {
  return {x, y, 0.0, 0.0};
}
// Rises by 20 within 100.
inline cam::CamParams Lift() {
  cam::CamParams p;
  p.name = "lift";
  p.points = {Rest(0, 0), Rest(100, 20)};
  return p;
}
// Cyclic; each cycle advances by 20.
inline cam::CamParams Feed() {
  cam::CamParams p = Lift();
  p.name = "feed";
  p.cyclic = true;
  return p;
}
// Rises by 20 within 50, and falls again within 50.
inline cam::CamParams Stroke() {
  cam::CamParams p;
  p.name = "stroke";
  p.cyclic = true;
  p.points = {Rest(0, 0), Rest(50, 20), Rest(100, 0)};
  return p;
}
inline double StrokeAt(double x) {
  const double in = x - 100 * std::floor(x / 100);
  return 20 * Polynomial345::Y(in < 50 ? in / 50 : (100 - in) / 50);
}
inline double FeedAt(double x) {
  const double cycle = std::floor(x / 100);
  return 20 * (cycle + Polynomial345::Y(x / 100 - cycle));
}

inline Machine WithCams(Machine machine) {
  machine.cams = {Lift(), Feed(), Stroke()};
  return machine;
}

inline axis::CamIn Cam(const char* master, const char* cam) {
  axis::CamIn c;
  c.master = Name::Of(master);
  c.cam = Name::Of(cam);
  return c;
}

}  // namespace takt::engine
