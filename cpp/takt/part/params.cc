#include "takt/part/params.h"

#include <algorithm>
#include <utility>

#include "takt/core/describe.h"

namespace takt::part {

planar::Parts Make(const std::vector<CoordinateSystemParams>& systems, const std::vector<PartParams>& parts) {
  std::vector<std::string> names;
  for (const CoordinateSystemParams& system : systems) names.push_back(system.name);
  std::vector<planar::Part> made;
  std::vector<planar::PartNow> now;
  for (const PartParams& params : parts) {
    planar::Part& part = made.emplace_back();
    part.name = params.name;
    planar::MakeEnvironment(params.stators, part.shape);
    for (const PositionParams& p : params.positions) {
      const auto system = std::ranges::find(names, p.coordinate_system) - names.begin();
      part.positions.push_back({static_cast<std::uint32_t>(system), {p.x, p.y}});
    }
    const std::uint32_t first = params.initial_position - 1;
    now.push_back({.position = first, .commanded = first});
  }
  return {std::move(names), std::move(made), std::move(now)};
}

void describe(Description<CoordinateSystemParams>& d) {
  d.named("CoordinateSystem");
  d.about("A plane of its own, in which parts lie.");
  d.required<&CoordinateSystemParams::name>("Of the coordinate system; positions refer to it.");
}

void describe(Description<PositionParams>& d) {
  using P = PositionParams;
  d.named("PartPosition");
  d.about("Where a part can be.");
  d.required<&P::coordinate_system>("Name of the coordinate system.");
  d.defaulted<&P::x>(unit::mm, between(-1e6, 1e6), "X of the part's origin in it.");
  d.defaulted<&P::y>(unit::mm, between(-1e6, 1e6), "Y of it.");
}

void describe(Description<PartParams>& d) {
  using P = PartParams;
  d.about("A part of the surface that movers float on: stators that hang together.");
  d.required<&P::name>("Of the part; commands go to it, and positions refer to it.");
  d.defaulted<&P::stators>("Lower left corners of its stators, squares of 240 mm, from the part's origin.");
  d.required<&P::positions>("Where it can be; the first has the index 1.");
  d.defaulted<&P::initial_position>(between(1, 1000), "Index of that where it is at the start.");
}

}  // namespace takt::part
