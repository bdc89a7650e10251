// Ways of travelling past cam switches, and what they put out on them.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "takt/axis/cam_switch.h"
#include "takt/core/kinematic_state.h"

namespace takt::axis {

// Position and velocity at a time.
using Way = std::function<KinematicState(double)>;

inline Way Constant(double start, double velocity) {
  return [=](double t) { return KinematicState{start + velocity * t, velocity, 0}; };
}

inline CamSwitchInputs At(const KinematicState& x, double modulus, int cycle, double period_s = 0.001) {
  return {.position = x.position,
          .velocity = x.velocity,
          .sense = x.velocity < 0 ? -1 : 1,
          .modulus = modulus,
          .cycle = static_cast<std::uint64_t>(cycle),
          .period_s = period_s};
}

// The outputs in each cycle of a way, cycle 0 first.
inline std::vector<std::uint32_t> OutputsOn(const CamSwitches& list, const Way& way, int cycles, double modulus = 0) {
  CamSwitchState state;
  std::vector<std::uint32_t> outputs;
  for (int k = 0; k < cycles; ++k) outputs.push_back(Step(list, At(way(k * 0.001), modulus, k), state));
  return outputs;
}

inline bool Bit(std::uint32_t outputs, int track) {
  return (outputs >> (track - 1) & 1) != 0;
}

inline double Modulo(double x, double modulus) {
  return x - modulus * std::floor(x / modulus);
}

// A list of switches of track 1 with these options.
inline CamSwitches ListOf(std::vector<CamSwitch> switches, const CamTrack& options = {}) {
  CamSwitches list;
  list.name = "list";
  list.tracks = {options};
  list.switches = std::move(switches);
  return list;
}

}  // namespace takt::axis
