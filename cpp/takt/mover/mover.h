// One planar mover, stage by stage of the cycle. Free functions over plain state; they do not allocate, lock, throw or
// read a clock.
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

// The parameters of a star with its planets (mover/formation.h): for X and Y or C alone, and for both at once.
struct Body {
  // Reserves memory for `most` planets.
  Body(const MoverParams& params, std::size_t most) : alone(params), both(params) { planets.reserve(most); }

  std::vector<std::uint32_t> planets{};  // indices
  MoverParams alone;
  MoverParams both;
};

// All movers, by index, as members of a formation see each other.
struct Fleet {
  std::span<const MoverParams> params{};
  std::span<const State> states{};
  std::span<Body> bodies{};         // derived from the planets of each
  SurfaceRoutes* routes = nullptr;  // of all movers
};

// Context of every stage, in addition to the mover's own state.
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

// Measured values at the beginning of a cycle.
struct Inputs {
  Place actual;
};

// Returns the values of an ideal mover after this cycle: the actual pose is the set pose.
Inputs Simulate(const State& s) noexcept;

// Cycle stage command: executes or refuses a command and reports the result.
void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept;

// Cycle stage move.
void Step(const Context& c, const Inputs& inputs, State& s) noexcept;

// Publishes the pose at the start to the other movers.
void Arrive(const Context& c, const State& s) noexcept;

// Brings the mover to rest with the maximum dynamics, then to Error. `aborts`: a reset leads to Disabled.
void Fail(const Context& c, ErrorId error, State& s, bool aborts = false, const ObjectInfo& object = {}) noexcept;

void Publish(const Context& c, const Inputs& inputs, const State& s, Outputs& out) noexcept;

bool AtRest(const State& s) noexcept;
// Returns true if the mover is at rest and without power: Disabled, or after a fault whose reset leads there.
bool IsOff(const State& s) noexcept;

void describe(Description<Inputs>&);

}  // namespace takt::mover
