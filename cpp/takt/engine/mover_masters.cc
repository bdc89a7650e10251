#include "takt/engine/mover_masters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <variant>

#include "takt/mover/run.h"

namespace takt::engine {

namespace {

// The masters that a mover offers to axes: its position along tracks, under its own name, and its coordinates.
constexpr std::array kCoordinates = {mover::kX, mover::kY, mover::kC};
constexpr std::array kSuffixes = {"", ".x", ".y", ".c"};

}  // namespace

void NameMasters(World& w) {
  for (const axis::AxisParams& params : w.axis_params) {
    w.streets.masters.push_back({.name = params.name, .turn = params.turn()});
  }
  for (const mover::MoverParams& params : w.movers) {
    w.streets.movers.push_back({.name = params.name});
    for (const char* suffix : kSuffixes) {
      const bool turns = std::string_view(suffix) == ".c";
      const double velocity = turns ? params.c.maximum.velocity : params.xy.maximum.velocity;
      w.mover_masters.push_back({.name = params.name + suffix, .velocity = velocity});
    }
  }
  for (const Belt& belt : w.belts) {
    const double velocity = std::abs(belt.params.ratio) * w.axis_params[belt.axis].limits.velocity;
    w.mover_masters.push_back({.name = belt.params.name, .velocity = velocity});
  }
  ShowAxesToMovers(w);
  ShowMovers(w);
}

void ShowBelt(World& w, std::uint32_t i) noexcept {
  axis::OutsideMaster& master = w.mover_masters[kSuffixes.size() * w.movers.size() + i];
  master.known = w.belt_states[i].known;
  master.at = w.belt_states[i].travel;
}

std::uint32_t StepsBefore(const World& w, std::uint32_t master) noexcept {
  const std::size_t axes = w.axis_states.size();
  if (master == axis::kNoAxis || master < axes) return master;
  const std::size_t outside = master - axes;
  const std::size_t coordinates = kSuffixes.size() * w.movers.size();
  if (outside < coordinates) return static_cast<std::uint32_t>(axes);
  const Belt& belt = w.belts[outside - coordinates];
  return IsMeasured(belt.params) ? axis::kNoAxis : belt.axis;
}

void ShowAxesToMovers(World& w) noexcept {
  for (std::size_t i = 0; i < w.streets.masters.size(); ++i) {
    const axis::State& s = w.axis_states[i];
    mover::Master& master = w.streets.masters[i];
    master.known = axis::IsKnown(s, axis::MasterSource::kSetValue);
    master.at = s.setpoint;
    master.at.position += s.origin;
    master.origin = s.origin;
    master.turn = w.axis_params[i].turn();
  }
}

void ShowMovers(World& w) noexcept {
  for (std::size_t i = 0; i < w.movers.size(); ++i) {
    const mover::State& s = w.mover_states[i];
    const planar::Rider& rider = w.streets.riders[i];
    const bool enabled = s.state == planar::ObjectState::kEnabled;
    const bool on_track = rider.on && mover::IsOnTrack(s);
    w.streets.movers[i].enabled = enabled;
    w.streets.movers[i].on_track = on_track;
    axis::OutsideMaster* const masters = &w.mover_masters[kSuffixes.size() * i];
    masters[0].known = enabled && on_track;
    masters[0].at = rider.at;
    masters[0].at.position += rider.origin;
    const std::array carried = {s.carried.x, s.carried.y, 0.0};
    for (std::size_t k = 0; k < kCoordinates.size(); ++k) {
      masters[k + 1].known = enabled;
      masters[k + 1].at = s.set_point[kCoordinates[k]];
      masters[k + 1].at.position -= carried[k];
      masters[k + 1].origin = -carried[k];
    }
  }
}

std::uint32_t AxisFollowedBy(const World& w, const mover::Command& command) noexcept {
  const auto* gear = std::get_if<mover::GearInPosOnTrack>(&command);
  return gear ? axis::FindAxis(w.axis_params, gear->master.view()) : axis::kNoAxis;
}

}  // namespace takt::engine
