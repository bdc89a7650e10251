// Distances between the shapes of a cell. FCL does the work, in scene.cc and nowhere else. Allocates; not for the
// cycle, and not for two threads at a time.
#pragma once

#include <cstddef>
#include <memory>

#include "takt/kinematics/frames.h"
#include "takt/workspace/shape.h"

namespace takt::workspace {

// How far FCL may be wrong about a distance, mm, for things of up to a few metres.
inline constexpr double kDistanceError = 0.02;

class Scene {
 public:
  Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  // Both count from 0. Obstacles stand still where their pose says; bodies are wherever one asks.
  std::size_t AddObstacle(const Shape& shape);
  std::size_t AddBody(const Shape& shape);
  // From now on the two do not see each other.
  void Ignore(std::size_t body, std::size_t obstacle);

  struct Nearest {
    double distance = 0;       // mm, 0: they touch or overlap; at most `within`
    std::size_t obstacle = 0;  // which, if nearer than `within`
  };
  // `at`: the frame of what the body is fixed to. Looking no further than `within` saves time.
  Nearest NearestObstacle(std::size_t body, const kinematics::Frame& at, double within);
  double Between(std::size_t a, const kinematics::Frame& a_at, std::size_t b, const kinematics::Frame& b_at,
                 double within);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace takt::workspace
