// Random cams and masters.
#pragma once

#include <cmath>
#include <string>

#include "bench.h"
#include "dice.h"

namespace takt::flexcam {

// A smooth cyclic cam through a few points; `rising`: never falling.
inline cam::CamParams RandomCam(Dice& dice, const std::string& name, bool rising) {
  cam::CamParams p;
  p.name = name;
  p.cyclic = true;
  const int points = 2 + dice.Upto(4);
  double y = 0;
  for (int i = 0; i <= points; ++i) {
    p.points.push_back(engine::Rest(360.0 * i / points, y));
    y = rising ? y + dice.Between(0, 40) : (i + 1 == points ? 0 : dice.Between(-40, 40));
  }
  return p;
}

// The web accelerates, decelerates, reverses, or stops.
inline void Drive(Dice& dice, Bench& b) {
  const double velocity = dice.Upto(3) == 0 ? 0 : dice.Between(-800, 800);
  if (velocity == 0) {
    b.Give(Bench::kWeb, axis::Halt{.deceleration = dice.Between(1000, 20000), .jerk = dice.Between(1e4, 1e6)});
    return;
  }
  axis::MoveVelocity move{.velocity = std::abs(velocity)};
  move.direction = velocity < 0 ? axis::Direction::kNegative : axis::Direction::kPositive;
  move.acceleration = dice.Between(500, 20000);
  move.deceleration = move.acceleration;
  move.jerk = dice.Between(1e4, 1e6);
  b.Give(Bench::kWeb, move);
}

}  // namespace takt::flexcam
