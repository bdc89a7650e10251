#include "takt/part/params.h"

#include <algorithm>
#include <utility>

#include "takt/core/describe.h"

namespace takt::part {

std::vector<planar::Place> StatorsOf(const PartParams& params) {
  if (!params.stators.empty()) return params.stators;
  std::vector<planar::Place> stators;
  for (std::uint32_t row = 0; row < params.rows; ++row) {
    for (std::uint32_t column = 0; column < params.columns; ++column) {
      stators.push_back({column * planar::kStatorSide, row * planar::kStatorSide});
    }
  }
  return stators;
}

planar::Parts Make(const std::vector<CoordinateSystemParams>& systems, const std::vector<PartParams>& parts) {
  std::vector<std::string> names;
  for (const CoordinateSystemParams& system : systems) names.push_back(system.name);
  std::vector<planar::Part> made;
  std::vector<planar::PartNow> now;
  for (const PartParams& params : parts) {
    planar::Part& part = made.emplace_back();
    part.name = params.name;
    planar::MakeEnvironment(StatorsOf(params), part.shape);
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
  d.named("PlanarCoordinateSystem");
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
  d.defaulted<&P::columns>(between(1, 1000), "So many stators side by side, squares of 240 mm.");
  d.defaulted<&P::rows>(between(1, 1000), "So many such rows, from the part's origin upwards.");
  d.defaulted<&P::stators>("Instead of columns and rows: lower left corners of its stators, from the part's origin.");
  d.required<&P::positions>("Where it can be; the first has the index 1.");
  d.defaulted<&P::initial_position>(between(1, 1000), "Index of that where it is at the start.");
  d.defaulted<&P::travel_time_s>(unit::s, between(0, 3600),
                                 "So long a simulated part takes from position to position.");
}

}  // namespace takt::part
