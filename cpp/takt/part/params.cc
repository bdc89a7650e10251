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
  d.about("A plane with coordinates of its own, in which parts lie.");
  d.required<&CoordinateSystemParams::name>("Name of the coordinate system, to which positions refer.");
}

void describe(Description<PositionParams>& d) {
  using P = PositionParams;
  d.named("PartPosition");
  d.about("A position of a part.");
  d.required<&P::coordinate_system>("Name of the coordinate system.");
  d.defaulted<&P::x>(unit::mm, between(-1e6, 1e6), "X of the origin of the part in the coordinate system.");
  d.defaulted<&P::y>(unit::mm, between(-1e6, 1e6), "Y of the origin of the part in the coordinate system.");
}

void describe(Description<PartParams>& d) {
  using P = PartParams;
  d.about("A part of the surface that movers float on: stators connected by their sides.");
  d.required<&P::name>("Name of the part, to which commands are addressed and positions refer.");
  d.defaulted<&P::columns>(between(1, 1000), "Number of stators in a row, squares of 240 mm.");
  d.defaulted<&P::rows>(between(1, 1000), "Number of rows, from the origin of the part upwards.");
  d.defaulted<&P::stators>(
      "Lower left corners of the stators in the coordinates of the part, instead of columns and rows.");
  d.required<&P::positions>("Positions that the part can take; the first has the index 1.");
  d.defaulted<&P::initial_position>(between(1, 1000), "Index of the position at the start.");
  d.defaulted<&P::travel_time_s>(unit::s, between(0, 3600), "Travel time of a simulated part between two positions.");
}

}  // namespace takt::part
