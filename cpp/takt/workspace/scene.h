// Distances between the shapes of a cell, computed by FCL, which only scene.cc uses. Allocates; not for use within the
// cycle, and not thread-safe.
#pragma once

#include <cstddef>
#include <memory>

#include "takt/kinematics/frames.h"
#include "takt/workspace/shape.h"

namespace takt::workspace {

// [mm] largest error of FCL's distances, for objects of up to a few metres.
inline constexpr double kDistanceError = 0.02;

class Scene {
 public:
  Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  // Both return numbers from 0. Obstacles are fixed at their pose; bodies are at the frames given in queries.
  std::size_t AddObstacle(const Shape& shape);
  std::size_t AddBody(const Shape& shape);
  // From now on this pair is not checked.
  void Ignore(std::size_t body, std::size_t obstacle);

  struct Nearest {
    double distance = 0;       // [mm] 0: they touch or overlap; at most `within`
    std::size_t obstacle = 0;  // its number, if nearer than `within`
  };
  // `at`: the frame to which the body is fixed. A small `within` saves time.
  Nearest NearestObstacle(std::size_t body, const kinematics::Frame& at, double within);
  double Between(std::size_t a, const kinematics::Frame& a_at, std::size_t b, const kinematics::Frame& b_at,
                 double within);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace takt::workspace
