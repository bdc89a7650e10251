// One planar mover, stage by stage of the cycle. Free functions over plain state; nothing here allocates, locks, throws
// or reads a clock.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "takt/core/cycle.h"
#include "takt/core/feedback.h"
#include "takt/mover/commands.h"
#include "takt/mover/outputs.h"
#include "takt/mover/params.h"
#include "takt/mover/state.h"
#include "takt/mover/track_network_state.h"
#include "takt/planar/group_registry.h"
#include "takt/trajectory/planner.h"

namespace takt::mover {

struct SurfaceRoutes;  // route.h

// What a star can do with its planets (mover/formation.h): X and Y or C alone, and both at once.
struct Body {
  // With room for so many planets.
  Body(const MoverParams& params, std::size_t most) : alone(params), both(params) { planets.reserve(most); }

  std::vector<std::uint32_t> planets{};  // their numbers
  MoverParams alone;
  MoverParams both;
};

// All movers, as those of a formation see each other; by number.
struct Fleet {
  std::span<const MoverParams> params{};
  std::span<const State> states{};
  std::span<Body> bodies{};         // what follows from the planets of each
  SurfaceRoutes* routes = nullptr;  // of all
};

// What every stage gets besides the mover itself.
struct Context {
  const MoverParams& params;
  Cycle cycle;
  trajectory::Planner& planner;
  FeedbackSink& feedback;
  TrackNetworkState& streets;
  planar::GroupRegistry& grounds;
  std::uint32_t index = 0;  // of the mover
  Fleet fleet{};

  planar::Rider& rider() const noexcept { return streets.riders[index]; }
};

// What is measured, at the beginning of a cycle.
struct Inputs {
  Place actual;
};

// What an ideal mover measures after this cycle: it is where it is to be.
Inputs Simulate(const State& s) noexcept;

// command: carries it out or refuses it; reports either way.
void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept;

// move
void Step(const Context& c, const Inputs& inputs, State& s) noexcept;

// Where it is at the start, for others.
void Arrive(const Context& c, const State& s) noexcept;

// Comes to rest with the maximum dynamics, and is in Error then. `aborts`: a reset leads to Disabled.
void Fail(const Context& c, ErrorId error, State& s, bool aborts = false, const ObjectInfo& object = {}) noexcept;

void Publish(const Context& c, const Inputs& inputs, const State& s, Outputs& out) noexcept;

bool AtRest(const State& s) noexcept;
// At rest and without power: disabled, or after a fault that leads there.
bool IsOff(const State& s) noexcept;

void describe(Description<Inputs>&);

}  // namespace takt::mover
