#include "takt/engine/masters.h"

#include <algorithm>
#include <optional>
#include <variant>

#include "takt/engine/carriers.h"
#include "takt/engine/mover_masters.h"

namespace takt::engine {

namespace {

// kFirst: groups step after all belts, as far as no group moves those, since they may ride on any of them.
enum class Belts : std::uint8_t { kFirst, kAnywhere };

// Finds the n-th master that is passed to See.
struct Nth {
  const World& world;
  const Wanted& wanted;
  std::uint32_t n;
  std::uint32_t movers;  // the common number of all movers
  std::optional<std::uint32_t> found{};

  void See(std::uint32_t master) {
    const std::uint32_t first = StepsBefore(world, master);
    if (!found && first != axis::kNoAxis && n-- == 0) found = first;
  }
  // Returns the number of the group that an axis belongs to, or will; 0: none.
  std::uint32_t GroupOf(std::uint32_t axis) const { return axis == wanted.added ? wanted.group : world.group_of[axis]; }
};

void SeeMasters(const axis::CouplingRequest& r, Nth& nth) {
  for (const axis::CouplingTerm& term : r.terms) nth.See(term.master);
}

// The masters of the paths of a group, without consecutive duplicates.
void SeeMasters(const group::State& s, Nth& nth) {
  std::uint32_t last = 0;
  for (std::uint32_t i = 0; i < s.queue.count && !nth.found; ++i) {
    const std::uint32_t master = s.queue.moves[(s.queue.first + i) % group::kQueue].master;
    if (master != 0 && master != last) nth.See(master - 1);
    last = master;
  }
}

void SeeMembers(const World& w, std::size_t group, Nth& nth) {
  for (const std::uint32_t member : w.group_states[group].members) {
    if (member != 0) nth.See(member - 1);
  }
  if (nth.wanted.group == group + 1) nth.See(nth.wanted.added);
}

// The axes of belts by set position.
void SeeBelts(const World& w, Nth& nth) {
  for (const Belt& belt : w.belts) {
    if (!IsMeasured(belt.params) && nth.GroupOf(belt.axis) == 0) nth.See(belt.axis);
  }
}

// The axes that move a carrier, given its number; measured belts need none.
void SeeCarrier(const World& w, std::uint32_t number, Nth& nth) {
  if (number == 0) return;
  std::size_t i = number - 1;
  if (i < w.belts.size()) {
    if (!IsMeasured(w.belts[i].params)) nth.See(w.belts[i].axis);
    return;
  }
  i -= w.belts.size();
  if (i < w.groups.size()) SeeMembers(w, i, nth);
}

// The carriers that a group rides on, or may ride on at any time.
void SeeCarriers(const World& w, std::size_t group, Nth& nth) {
  const group::State& s = w.group_states[group];
  std::uint32_t last = 0;  // to skip consecutive duplicates
  const auto see = [&](const group::CarriedTarget& cargo) {
    if (cargo.carrier != last) SeeCarrier(w, cargo.carrier, nth);
    last = cargo.carrier;
  };
  for (const std::uint32_t carrier : s.ridden) SeeCarrier(w, carrier, nth);
  std::ranges::for_each(s.cargoes, see);
  see(s.track.cargo);
  for (std::uint32_t i = 0; i < s.queue.count && !nth.found; ++i) {
    see(s.queue.moves[(s.queue.first + i) % group::kQueue].cargo);
  }
}

// Returns the n-th axis that movers follow.
std::optional<std::uint32_t> MasterOfMovers(const World& w, Nth nth) {
  for (std::size_t i = 0; i < w.movers.size(); ++i) {
    const planar::Rider& rider = w.streets.riders[i];
    if (rider.on && rider.aim == planar::Aim::kFollow) nth.See(w.mover_states[i].gear.axis);
  }
  nth.See(nth.wanted.movers);
  return nth.found;
}

// Returns the k-th axis that axis i must not step before: the one it follows by the machine file or by a cam module,
// those it is coupled to, those it will be coupled to by buffered commands, those that its group follows or rides on,
// the members of the group that it follows itself. Last come those of `wanted`.
std::optional<std::uint32_t> MasterOf(const World& w, std::uint32_t i, std::uint32_t k, const Wanted& wanted,
                                      Belts belts) {
  Nth nth{w, wanted, k, static_cast<std::uint32_t>(w.axis_states.size())};
  if (i == nth.movers) return MasterOfMovers(w, nth);
  const axis::State& s = w.axis_states[i];
  if (w.axis_masters[i]) nth.See(*w.axis_masters[i]);
  if (w.module_of[i] != 0) nth.See(w.flex_cams[w.module_of[i] - 1].master.value_or(axis::kNoAxis));
  SeeMasters(s.active.coupling, nth);
  for (std::size_t b = 0; b < s.buffered; ++b) SeeMasters(s.buffer[b].coupling, nth);
  const std::uint32_t group = nth.GroupOf(i);
  if (group != 0) SeeMasters(w.group_states[group - 1], nth);
  if (group != 0) SeeCarriers(w, group - 1, nth);
  if (group != 0 && belts == Belts::kFirst) SeeBelts(w, nth);
  for (std::size_t leader = 0; leader < w.groups.size(); ++leader) {
    for (const group::SyncedAxis& synced : w.group_states[leader].synced) {
      if (synced.axis == i + 1) SeeMembers(w, leader, nth);
    }
  }
  if (wanted.coupling != nullptr && i == wanted.of) SeeMasters(*wanted.coupling, nth);
  if (wanted.group != 0 && group == wanted.group) {
    nth.See(wanted.master);
    SeeCarrier(w, wanted.carrier, nth);
  }
  if (i == wanted.synced) SeeMembers(w, wanted.group - 1, nth);
  return nth.found;
}

}  // namespace

bool MakeOrder(World& w, const Wanted& wanted) noexcept {
  const auto make = [&](Belts belts) {
    return w.axis_order.Make([&](std::uint32_t i, std::uint32_t k) { return MasterOf(w, i, k, wanted, belts); });
  };
  return make(Belts::kFirst) || make(Belts::kAnywhere);
}

Wanted WantedBy(World& w, const group::Command& command, std::size_t index) noexcept {
  const auto carrier = [&](const Name& name) { return CarriersFor(w.riders[index]).Find(name.view()); };
  Wanted wanted{.group = static_cast<std::uint32_t>(index + 1)};
  if (const auto* path = std::get_if<group::MovePathSynchronized>(&command)) {
    wanted.master = axis::FindAxis(w.axis_params, path->master.view());
  } else if (const auto* sync = std::get_if<group::SyncAxis>(&command)) {
    wanted.synced = axis::FindAxis(w.axis_params, sync->axis.view());
  } else if (const auto* add = std::get_if<group::AddAxis>(&command)) {
    const std::uint32_t axis = axis::FindAxis(w.axis_params, add->axis.view());
    if (axis != axis::kNoAxis && w.group_of[axis] == 0) wanted.added = axis;
  } else if (const auto* transform = std::get_if<group::SetDynCoordTransform>(&command)) {
    wanted.carrier = carrier(transform->carrier);
  } else if (const auto* belt = std::get_if<group::TrackConveyorBelt>(&command)) {
    wanted.carrier = carrier(belt->belt);
  } else if (const auto* table = std::get_if<group::TrackRotaryTable>(&command)) {
    wanted.carrier = carrier(table->table);
  }
  return wanted;
}

}  // namespace takt::engine
