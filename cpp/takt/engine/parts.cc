#include "takt/engine/parts.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/mover/area_reservation.h"
#include "takt/mover/formation.h"
#include "takt/mover/on_parts.h"
#include "takt/planar/nearest.h"
#include "takt/track/pending_edits.h"

namespace takt::engine {

namespace {

using part::MoveBlocker;
using planar::ObjectState;

part::Context ContextOfPart(World& w, std::size_t i) {
  return {w.parts[i], w.cycle, w.feedback};
}

MoveBlocker By(ErrorId error, ObjectKind kind, std::size_t index) {
  return {error, ObjectAt(kind, index)};
}

// Makes a change of a part's state visible to movers and tracks.
void Show(World& w, std::size_t i) {
  planar::PartNow& now = w.surface.now[i];
  const planar::PartNow before = now;
  now = part::Show(w.part_states[i]);
  if (now.position == before.position && now.commanded == before.commanded && now.away == before.away) return;
  planar::MakeBorders(w.surface);
  track::MakeNodes(w.tracks);
}

bool IsOnTrackOf(const World& w, std::size_t mover, std::size_t part) {
  const planar::Rider& rider = w.streets.riders[mover];
  return rider.on && w.tracks.part_of[rider.route.first()] == part;
}

bool TouchesPart(World& w, std::size_t mover, std::size_t part) {
  const mover::Cover cover = mover::CoverOf(MoverContext(w, mover), w.mover_states[mover]);
  return std::ranges::any_of(cover.all(), [&](const planar::Area& area) {
    return planar::Touches(w.surface.all[part], w.surface.spot(static_cast<std::uint32_t>(part)),
                           w.mover_states[mover].system, area);
  });
}

// Returns true if the mover is on the part, or its route leads over it.
bool Uses(World& w, std::size_t mover, std::size_t part) {
  if (w.mover_states[mover].part == part || TouchesPart(w, mover, part) ||
      mover::LeadsOver(MoverContext(w, mover), w.mover_states[mover], static_cast<std::uint32_t>(part))) {
    return true;
  }
  const planar::Rider& rider = w.streets.riders[mover];
  return rider.on &&
         std::ranges::any_of(rider.route.all(), [&](std::uint32_t track) { return w.tracks.part_of[track] == part; });
}

void FailMoversOn(World& w, std::size_t part, ErrorId error) {
  for (std::size_t i = 0; i < w.movers.size(); ++i) {
    if (Uses(w, i, part)) mover::Fail(MoverContext(w, i), error, w.mover_states[i], true);
  }
}

constexpr double kStride = 10;  // [mm]

// Returns a position on a track, with its part at its commanded position.
planar::Place PlaceOn(const World& w, std::uint32_t track, double s) {
  return planar::PlaceAt(*w.tracks.ways[track], s) + w.tracks.goal(track).origin;
}

// Returns true if a mover at rest on one track would be too close to another mover between two positions on another
// track.
bool IsTooNear(const World& w, const planar::Rider& one, double gap, std::uint32_t track, double from, double to) {
  const track::Tracks& t = w.tracks;
  const std::uint32_t own = one.route.first();
  if (t.goal(own).system != t.goal(track).system) return false;
  const double at = one.at.position, rest = t.states[own].length - at, length = t.states[track].length;
  const planar::Place place = PlaceOn(w, own, at);
  const double reach = w.streets.tracks[own].reach;
  // Consecutive tracks.
  if (t.end_nodes[own] == t.start_nodes[track] && rest + from < gap) return true;
  if (t.end_nodes[track] == t.start_nodes[own] && length - to + at < gap) return true;
  // Both after a node, or before it: where they may touch, or are near the node, they also keep the gap along the
  // tracks.
  const bool touch =
      planar::NearestTo(*t.ways[track], place - t.goal(track).origin).distance < reach + planar::kRangeSlack;
  const auto beside = [&](double its, double least, double most) {
    const bool active = touch || (its < gap && least < gap);
    return active && std::max(least - its, its - most) < gap;
  };
  if (t.start_nodes[own] == t.start_nodes[track] && beside(at, from, to)) return true;
  if (t.end_nodes[own] == t.end_nodes[track] && beside(rest, length - to, length - from)) return true;
  const auto strides = static_cast<int>(std::ceil((to - from) / kStride));
  for (int i = 0; touch && i <= strides; ++i) {
    const planar::Place off = PlaceOn(w, track, strides == 0 ? from : from + (to - from) * i / strides) - place;
    if (maths::Hypot(off.x, off.y) < reach + (strides == 0 ? 0 : kStride / 2)) return true;
  }
  return false;
}

// Returns true if two movers on tracks of different parts would be closer than allowed: one that its part carries, at
// rest, and another that may be moving, and stops as soon as it can.
bool AreTooNear(const World& w, const planar::Rider& one, const planar::Rider& other) {
  const double gap = std::max(one.gap, other.gap);
  double least = other.at.position, most = least;
  if (!planar::Rests(other.at)) {
    const planar::Braking braking = planar::Brake(other.at, planar::BrakesOf(other));
    least = braking.lowest;
    most = braking.highest;
  }
  double begin = 0;  // begin of the track, relative to the begin of the route's first track
  for (const std::uint32_t track : other.route.all()) {
    if (begin > most) break;
    const double length = w.tracks.states[track].length;
    const auto within = [&](double s) { return std::clamp(s - begin, 0.0, length); };
    if (IsTooNear(w, one, gap, track, within(least), within(most))) return true;
    begin += length;
  }
  return false;
}

// Returns the object of a mover's group that the mover would collide with at its part's new position: of all objects
// that do not move along, and that movers on tracks do not avoid by themselves.
MoveBlocker InGroup(const World& w, std::size_t mover, std::uint32_t part, const planar::Spot& from,
                    const planar::Spot& to) {
  const planar::GroupRegistry& g = w.grounds;
  const std::uint32_t group = g.Watching(g.group_of_mover[mover]);
  if (group == 0) return {};
  const planar::Reservations& r = g.grounds[group - 1].reserved;
  const planar::Reservation& own = r.movers[mover];
  const planar::Area there = Shifted(planar::AreaOf(own), to.origin - from.origin);
  const planar::Extent extent = planar::ExtentOf(there);
  for (std::size_t k = 0; k < r.movers.size(); ++k) {
    const planar::Reservation& other = r.movers[k];
    if (!other.present || other.level != to.system || w.mover_states[k].part == part) continue;
    if (planar::Apart(extent, other.extent, planar::kSame)) continue;
    if (planar::Near(there, planar::AreaOf(other), planar::kSame)) {
      return By(ErrorId::kPartMover, ObjectKind::kMover, k);
    }
  }
  const planar::TrackArea* below = own.linked ? w.tracks.areas[w.streets.riders[mover].route.first()] : nullptr;
  for (std::size_t k = 0; k < r.tracks.size(); ++k) {
    const planar::TrackArea* track = w.tracks.areas[k];
    const planar::Spot& spot = w.tracks.goal(k);
    if (!track || !r.tracks[k].moving || w.tracks.part_of[k] == part || spot.system != to.system) continue;
    if (below && below->network == track->network) continue;
    const planar::Area in_its = Shifted(there, planar::Place{} - spot.origin);
    if (planar::Near(in_its, planar::ExtentOf(in_its), *track, planar::kSame)) {
      return By(ErrorId::kPartTrack, ObjectKind::kTrack, k);
    }
  }
  return {};
}

// Returns the object that would be too close to a mover that the part carries, at the new position.
MoveBlocker TooNear(World& w, std::uint32_t part, std::uint32_t position) {
  const planar::PartNow before = w.surface.now[part];
  const planar::Spot from = w.surface.spot(part), to = w.surface.all[part].positions[position];
  w.surface.now[part].commanded = position;
  track::MakeNodes(w.tracks);
  MoveBlocker found;
  for (std::size_t i = 0; i < w.movers.size() && found.error == ErrorId::kNone; ++i) {
    if (w.mover_states[i].part == part) found = InGroup(w, i, part, from, to);
    if (!IsOnTrackOf(w, i, part) || found.error != ErrorId::kNone) continue;
    for (std::size_t k = 0; k < w.movers.size(); ++k) {
      if (!w.streets.riders[k].on || IsOnTrackOf(w, k, part) ||
          !AreTooNear(w, w.streets.riders[i], w.streets.riders[k]))
        continue;
      found = By(ErrorId::kPartMover, ObjectKind::kMover, k);
      break;
    }
  }
  w.surface.now[part] = before;
  track::MakeNodes(w.tracks);
  return found;
}

// Returns true if a mover prevents a part from leaving its position: a mover on it that moves or extends over its
// border, or another one that extends over it.
bool Holds(World& w, std::size_t mover, std::uint32_t part, const mover::Cover& cover) {
  const mover::State& s = w.mover_states[mover];
  const auto touches = [&](std::uint32_t k) {
    return std::ranges::any_of(cover.all(), [&](const planar::Area& area) {
      return planar::Touches(w.surface.all[k], w.surface.spot(k), s.system, area);
    });
  };
  if (s.part != part) return touches(part) || mover::LeadsOver(MoverContext(w, mover), s, part);
  if (!mover::IsStill(MoverContext(w, mover), s)) return true;
  for (std::uint32_t k = 0; k < w.surface.all.size(); ++k) {
    if (k != part && !w.surface.now[k].away && touches(k)) return true;
  }
  return false;
}

// Returns true if a mover on the part belongs to a formation that is not completely on it.
bool IsTorn(World& w, std::size_t mover, std::uint32_t part) {
  const auto body = [&](std::size_t i) { return mover::BodyOf(MoverContext(w, i), w.mover_states[i]); };
  if (w.mover_states[mover].part != part || body(mover) == 0) return false;
  for (std::size_t i = 0; i < w.movers.size(); ++i) {
    if (w.mover_states[i].part != part && body(i) == body(mover)) return true;
  }
  return false;
}

// Returns true if another part carries a mover to the target position of this one.
bool ComesUnder(const World& w, std::size_t mover, const planar::Part& shape, const planar::Spot& to) {
  const planar::MoverView& now = w.grounds.movers[mover];
  return now.comes && planar::Touches(shape, to, now.goal.system, planar::AreaThere(now));
}

MoveBlocker HindranceOf(World& w, std::uint32_t part, std::uint32_t position) {
  const planar::Part& shape = w.surface.all[part];
  const planar::Spot& from = w.surface.spot(part);
  const planar::Spot& to = shape.positions[position];
  for (std::uint32_t k = 0; k < w.surface.all.size(); ++k) {
    if (k == part) continue;
    const planar::Part& other = w.surface.all[k];
    const planar::Spot& its = other.positions[w.surface.now[k].commanded];
    if (Overlap(shape, to, other, w.surface.spot(k)) || Overlap(shape, to, other, its)) {
      return By(ErrorId::kPartPlace, ObjectKind::kPart, k);
    }
  }
  for (std::size_t k = 0; k < w.tracks.states.size(); ++k) {
    const mover::TrackUse& use = w.streets.uses[k];
    if (w.tracks.part_of[k] == part && use.moving + use.configuring > 0)
      return By(ErrorId::kPartTrack, ObjectKind::kTrack, k);
  }
  for (std::size_t i = 0; i < w.movers.size(); ++i) {
    const mover::State& s = w.mover_states[i];
    const mover::Cover cover = mover::CoverOf(MoverContext(w, i), s);
    if (Holds(w, i, part, cover) || IsTorn(w, i, part)) return By(ErrorId::kPartMover, ObjectKind::kMover, i);
    const bool below = std::ranges::any_of(
        cover.all(), [&](const planar::Area& area) { return planar::Touches(shape, to, s.system, area); });
    if (s.part != part && (below || ComesUnder(w, i, shape, to))) return By(ErrorId::kPartMover, ObjectKind::kMover, i);
    if (s.part != part) continue;
    // Movers that are there already, or will be; and those that could not stop before it.
    const auto goes_along = [&](std::uint32_t k, bool) { return w.mover_states[k].part == part; };
    planar::Course brought;
    for (const planar::Area& area : cover.all()) planar::Add(Shifted(area, to.origin - from.origin), brought);
    const std::uint32_t near =
        w.grounds.guard.Find(static_cast<std::uint32_t>(i), to.system, brought, goes_along, planar::Guard::None);
    if (near != planar::kNobody) return By(ErrorId::kPartMover, ObjectKind::kMover, near);
    for (const planar::Area& area : cover.all()) {
      const planar::Area there = Shifted(area, to.origin - from.origin);
      const ObjectInfo comes = planar::MoverArrivingAt(static_cast<std::uint32_t>(i), to.system, there, w.grounds);
      if (comes) return {ErrorId::kPartMover, comes};
      const planar::Extent extent = planar::ExtentOf(there);
      for (std::size_t k = 0; k < w.movers.size(); ++k) {
        const mover::State& other = w.mover_states[k];
        if (other.part == part || other.system != to.system) continue;
        const mover::Cover its = mover::CoverOf(MoverContext(w, k), other);
        const auto near = [&](const planar::Area& b) {
          return !planar::Apart(extent, planar::ExtentOf(b), planar::kSame) && planar::Near(there, b, planar::kSame);
        };
        if (std::ranges::any_of(its.all(), near)) return By(ErrorId::kPartMover, ObjectKind::kMover, k);
      }
    }
  }
  return TooNear(w, part, position);
}

part::Around AroundOf(World& w, std::uint32_t part) {
  const ObjectState state = w.part_states[part].state;
  const bool ends = state == ObjectState::kDisabling || state == ObjectState::kErrorPending;
  part::Around around;
  for (std::size_t i = 0; i < w.movers.size(); ++i) {
    const mover::State& s = w.mover_states[i];
    if (s.system == w.surface.spot(part).system) {
      around.wanted |= mover::NeedsParts(s);
      around.reset |= s.state == ObjectState::kResetting;
    }
    if (!ends || !Uses(w, i, part)) continue;
    around.movers_rest &= mover::AtRest(s);
    around.movers_failed &= s.state != ObjectState::kErrorPending;
  }
  return around;
}

}  // namespace

void ApplyToPart(World& w, std::size_t i, Ticket ticket, const part::Command& command) noexcept {
  MoveBlocker hindrance;
  const auto* goes = std::get_if<part::ActivatePosition>(&command);
  if (goes && goes->index >= 1 && goes->index <= w.parts[i].positions.size()) {
    hindrance = HindranceOf(w, static_cast<std::uint32_t>(i), goes->index - 1);
  }
  part::Apply(ContextOfPart(w, i), ticket, command, hindrance, w.part_states[i]);
  Show(w, i);
  // From now on the movers on the part also reserve an area at its target position.
  for (std::size_t k = 0; goes && k < w.movers.size(); ++k) {
    if (w.mover_states[k].part == i) mover::Stand(MoverContext(w, k), w.mover_states[k]);
  }
  if (std::holds_alternative<part::ForceDisable>(command)) FailMoversOn(w, i, ErrorId::kPartDisabled);
}

void StepParts(World& w) noexcept {
  for (std::uint32_t i = 0; i < w.parts.size(); ++i) {
    const planar::Spot from = w.surface.spot(i);
    const bool gone = part::Arrive(ContextOfPart(w, i), w.part_inputs[i], w.part_states[i]);
    Show(w, i);
    for (std::size_t k = 0; gone && k < w.movers.size(); ++k) {
      if (w.mover_states[k].part != i) continue;
      mover::ShiftWithPart(MoverContext(w, k), from, w.surface.spot(i), w.mover_inputs[k], w.mover_states[k]);
    }
  }
  for (std::uint32_t i = 0; i < w.parts.size(); ++i) {
    part::State& s = w.part_states[i];
    part::Step(ContextOfPart(w, i), AroundOf(w, i), s);
    Show(w, i);
    if (s.state == ObjectState::kErrorPending) FailMoversOn(w, i, s.error);
  }
}

void PublishParts(World& w) noexcept {
  for (std::uint32_t i = 0; i < w.parts.size(); ++i) {
    const auto on = std::ranges::count(w.mover_states, i, &mover::State::part);
    part::Publish(w.surface.spot(i), static_cast<std::uint32_t>(on), w.part_states[i], w.part_outputs[i]);
  }
}

void SimulateParts(World& w) noexcept {
  for (std::size_t i = 0; i < w.parts.size(); ++i) {
    w.part_inputs[i] = part::Simulate(ContextOfPart(w, i), w.part_states[i]);
    const PartFaults& faults = w.part_faults[i];
    const bool goes = w.part_states[i].commanded != w.part_states[i].position;
    if (faults.lost || (faults.stuck && goes)) w.part_inputs[i].position = 0;
    w.part_inputs[i].fault = faults.fault;
  }
}

}  // namespace takt::engine
