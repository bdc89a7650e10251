#include "takt/track/params.h"

#include "takt/core/describe.h"
#include "takt/track/texts.h"

namespace takt::track {

std::vector<LinkParams> LinksOf(const std::vector<std::string>& names, const std::vector<LinkParams>& with_positions) {
  std::vector<LinkParams> all;
  for (const std::string& name : names) all.push_back({.track = name});
  all.insert(all.end(), with_positions.begin(), with_positions.end());
  return all;
}

planar::Element ToElement(const ElementParams& p) {
  return {p.shape, p.from.value_or(planar::Place{}), p.to, p.center.value_or(planar::Place{}), p.clockwise};
}

planar::Footprint LargestOn(const TrackParams& params) {
  return {params.mover_width, params.mover_height, true};
}

void describe(Enumeration<CollisionRangeMode>& e) {
  e.about("Where the collision ranges of a track come from.");
  e.value(CollisionRangeMode::kAutomatic, "automatic", "From the size of the movers and the geometry.");
  e.value(CollisionRangeMode::kManual, "manual", "As given.");
}

void describe(Description<ElementParams>& d) {
  using P = ElementParams;
  using planar::ElementShape;
  d.about("A piece that a track is given by. Gaps between pieces are filled without a step of direction or curvature.");
  d.defaulted<&P::shape>("What it is.");
  d.defaulted<&P::from>("Where a line or a circle begins.");
  d.required<&P::to>("Where it ends; the place of a position.");
  d.defaulted<&P::center>("Of a circle.");
  d.defaulted<&P::clockwise>("Which way round a circle goes.");
  d.rule<&P::from>("must be given for a line or a circle, and for no position",
                   [](const P& p) { return p.from.has_value() == (p.shape != ElementShape::kPosition); });
  d.rule<&P::center>("must be given for a circle, and for nothing else",
                     [](const P& p) { return p.center.has_value() == (p.shape == ElementShape::kArc); });
}

void describe(Description<LinkParams>& d) {
  using L = LinkParams;
  d.named("TrackLink");
  d.about("A track that another one starts from or ends at, as their parts are at some of their positions.");
  d.required<&L::track>("Name of that track.");
  d.defaulted<&L::this_position_index>(
      between(0, 1000), "Index of the position of this track's part that this is meant for; 0: its first.");
  d.defaulted<&L::other_position_index>(between(0, 1000), "The same of the other track's part.");
  d.defaulted<&L::only_there>("True: the tracks are linked there alone. False: wherever they meet.");
}

void describe(Description<TrackParams>& d) {
  using P = TrackParams;
  d.about("A track: a way in the plane along which movers go one behind the other.");
  d.required<&P::name>("Of the track; commands go to it.");
  d.defaulted<&P::part>(
      "Name of the part it lies on, whose coordinates its places belong to; needed if there are two.");
  d.defaulted<&P::elements>("What it is given by, in the order of the way; 64 at most.");
  d.defaulted<&P::closed_loop>("It goes on from its last element to its first.");
  d.defaulted<&P::starts_from>("Names of tracks at whose ends it starts.");
  d.defaulted<&P::ends_at>("Names of tracks at whose starts it ends.");
  d.defaulted<&P::starts_from_positions>("Others at whose ends it starts, for positions of the parts of both.");
  d.defaulted<&P::ends_at_positions>("Others at whose starts it ends, for positions of the parts of both.");
  d.defaulted<&P::mover_width>(unit::mm, kSizes, "Width of the largest mover on it.");
  d.defaulted<&P::mover_height>(unit::mm, kSizes, "Height of the largest mover on it.");
  d.defaulted<&P::check_collision_against_static_objects>(
      "In a group of movers: false lets movers go along it although the area of its largest mover touches that of "
      "another "
      "track or the border of the environment. Movers are watched all the same.");
  d.defaulted<&P::collision_range_mode>("Where the collision ranges come from.");
  d.defaulted<&P::collision_range_at_start>(
      unit::mm, kRanges, "So near to its start a mover counts for movers on other tracks; if they are given.");
  d.defaulted<&P::collision_range_at_end>(unit::mm, kRanges, "The same at its end.");
}

}  // namespace takt::track
