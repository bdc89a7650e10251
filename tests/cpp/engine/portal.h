// A portal of two axes with an auxiliary one, and two more axes that move a belt and a table, on an engine in virtual
// time.
#pragma once

#include <stdexcept>
#include <string>

#include "line.h"

namespace takt::engine {

inline const char* kPortal = R"(
name: portal
axes:
  - {name: a0, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -300, upper: 300}}
  - {name: a1, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -300, upper: 300}}
  - {name: a2, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: a3, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: a4, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: portal
    axes: [a0, a1, a2]
    kinematics: {gantry: {axes: [x, y]}}
    path: {velocity: 300, acceleration: 3000, jerk: 60000}
belts:
  - {name: belt, axis: a3}
  - {name: table, kind: turning, axis: a4}
poses:
  - {name: mover}
paths:
  - name: square
    elements:
      - {shape: line, to: {x: 50, y: 0, z: 0}}
      - {shape: line, to: {x: 50, y: 50, z: 0}}
      - {shape: arc, via_x: 25, via_y: 75, via_z: 0, to: {x: 0, y: 50, z: 0}}
      - {shape: line, to: {x: 0, y: 0, z: 0}}
)";

inline Machine PortalMachine() {
  LoadResult loaded = LoadMachine(kPortal, "portal.yaml");
  if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
  return *loaded.machine;
}

// Powers all axes and enables the group.
class Portal : public Line {
 public:
  Portal() : Line(PortalMachine()) {
    Tell(group::Enable{});
    Run(5);
  }

  Ticket Tell(const group::Command& body) { return engine.Submit(ToGroup(machine, body)); }
  const group::Outputs& group() const { return engine.group_outputs(0); }
};

}  // namespace takt::engine
