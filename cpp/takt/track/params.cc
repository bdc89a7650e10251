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
  e.about("Source of the collision ranges of a track.");
  e.value(CollisionRangeMode::kAutomatic, "automatic", "Computed from the size of the movers and the geometry.");
  e.value(CollisionRangeMode::kManual, "manual", "As given.");
}

void describe(Description<ElementParams>& d) {
  using P = ElementParams;
  using planar::ElementShape;
  d.about("An element of a track. Gaps between elements are filled without a step of direction or curvature.");
  d.defaulted<&P::shape>("Shape of the element.");
  d.defaulted<&P::from>("Start of a line or a circle.");
  d.required<&P::to>("End of a line or a circle; the point of a position.");
  d.defaulted<&P::center>("Centre of a circle.");
  d.defaulted<&P::clockwise>("True: a circle runs clockwise.");
  d.rule<&P::from>("must be given for a line or a circle, and for no position",
                   [](const P& p) { return p.from.has_value() == (p.shape != ElementShape::kPosition); });
  d.rule<&P::center>("must be given for a circle, and for nothing else",
                     [](const P& p) { return p.center.has_value() == (p.shape == ElementShape::kArc); });
}

void describe(Description<LinkParams>& d) {
  using L = LinkParams;
  d.named("TrackLink");
  d.about("A track that another one starts from or ends at, with their parts at given positions.");
  d.required<&L::track>("Name of the linked track.");
  d.defaulted<&L::this_position_index>(
      between(0, 1000),
      "Index of the position of this track's part for which the geometry is made; 0: the initial one.");
  d.defaulted<&L::other_position_index>(
      between(0, 1000),
      "Index of the position of the other track's part for which the geometry is made; 0: the initial one.");
  d.defaulted<&L::only_there>(
      "True: the link holds at these positions only. False: wherever the ends of the tracks meet.");
}

void describe(Description<TrackParams>& d) {
  using P = TrackParams;
  d.about("A track: a path in the plane along which movers move one behind the other.");
  d.required<&P::name>("Name of the track, to which commands are addressed.");
  d.defaulted<&P::part>("Name of the part it lies on, in whose coordinates it is given; required with several parts.");
  d.defaulted<&P::elements>("Elements of the track in their order along it, at most 64.");
  d.defaulted<&P::closed_loop>("True: its last element is joined to its first.");
  d.defaulted<&P::starts_from>("Names of tracks at whose ends it starts.");
  d.defaulted<&P::ends_at>("Names of tracks at whose starts it ends.");
  d.defaulted<&P::starts_from_positions>("More tracks at whose ends it starts, for positions of the parts of both.");
  d.defaulted<&P::ends_at_positions>("More tracks at whose starts it ends, for positions of the parts of both.");
  d.defaulted<&P::mover_width>(unit::mm, kSizes, "Width of the largest mover on it.");
  d.defaulted<&P::mover_height>(unit::mm, kSizes, "Height of the largest mover on it.");
  d.defaulted<&P::check_collision_against_static_objects>(
      "In a group of movers: false: movers may move along it even where the area of its largest mover touches that of "
      "another track or the border of the environment. Movers are still checked.");
  d.defaulted<&P::collision_range_mode>("Source of the collision ranges.");
  d.defaulted<&P::collision_range_at_start>(
      unit::mm, kRanges,
      "Distance from its start within which a mover may collide with movers on other tracks; used if manual.");
  d.defaulted<&P::collision_range_at_end>(
      unit::mm, kRanges,
      "Distance from its end within which a mover may collide with movers on other tracks; used if manual.");
}

}  // namespace takt::track
