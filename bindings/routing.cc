// Routes on the free surface: takt.routing asks for them.
#include <pybind11/stl.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "takt/routing/surface.h"

namespace takt::bindings {
namespace {

using routing::CellIndex;
using routing::MoverIndex;
using LegRow = py::typing::Tuple<double, int, int>;
using VisitRow = py::typing::Tuple<int, double, double, int, int>;

void Check(const routing::SurfaceProblem& problem) {
  const std::vector<bool>& blocked = problem.blocked;
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(problem.width > 0 && problem.height > 0 &&
              blocked.size() == static_cast<std::size_t>(problem.width) * static_cast<std::size_t>(problem.height),
          "expected width times height places");
  require(problem.pitch > 0 && problem.dynamics.velocity > 0 && problem.dynamics.acceleration > 0 &&
              problem.dynamics.jerk > 0,
          "expected a pitch and dynamics above 0");
  require(problem.targets.size() == problem.starts.size(), "expected a target for each mover, or none");
  require(problem.pools.empty() || problem.pools.size() == problem.starts.size(), "expected a pool for each mover");
  const auto check = [&](const std::vector<CellIndex>& places, bool may_be_none) {
    std::vector<bool> taken(blocked.size(), false);
    for (const CellIndex place : places) {
      if (place == routing::kNone && may_be_none) continue;
      require(place >= 0 && static_cast<std::size_t>(place) < blocked.size(), "a place is beyond the last one");
      require(!blocked[static_cast<std::size_t>(place)], "a place of a mover is blocked");
      require(!taken[static_cast<std::size_t>(place)], "two movers have one place");
      taken[static_cast<std::size_t>(place)] = true;
    }
  };
  check(problem.starts, false);
  check(problem.targets, true);
}

routing::SurfacePlan Plan(int width, int height, double pitch, double mover_size, double velocity, double acceleration,
                          double jerk, std::vector<bool> blocked, std::vector<CellIndex> starts,
                          std::vector<CellIndex> targets, std::vector<routing::PoolIndex> pools, std::int64_t effort,
                          std::uint64_t seed) {
  const routing::SurfaceProblem problem{.width = width,
                                        .height = height,
                                        .pitch = pitch,
                                        .mover_size = mover_size,
                                        .dynamics = {.velocity = velocity, .acceleration = acceleration, .jerk = jerk},
                                        .blocked = std::move(blocked),
                                        .starts = std::move(starts),
                                        .targets = std::move(targets),
                                        .pools = std::move(pools),
                                        .effort = effort,
                                        .seed = seed};
  Check(problem);
  const py::gil_scoped_release others_go_on;
  return routing::PlanSurface(problem);
}

std::string OutcomeOf(const routing::SurfacePlan& plan) {
  switch (plan.outcome) {
    case routing::Outcome::kPlanned:
      return "planned";
    case routing::Outcome::kUnreachable:
      return "unreachable";
    case routing::Outcome::kImpossible:
      return "impossible";
    case routing::Outcome::kGivenUp:
      break;
  }
  return "given_up";
}

py::typing::List<py::typing::List<LegRow>> LegsOf(const routing::SurfacePlan& plan) {
  py::typing::List<py::typing::List<LegRow>> movers;
  for (const routing::Legs& legs : plan.legs) {
    py::typing::List<LegRow> rows;
    for (const routing::Leg& leg : legs) rows.append(py::make_tuple(leg.departure, leg.from, leg.to));
    movers.append(rows);
  }
  return movers;
}

py::typing::List<py::typing::List<VisitRow>> VisitsOf(const routing::SurfacePlan& plan) {
  py::typing::List<py::typing::List<VisitRow>> movers;
  for (const std::vector<routing::Visit>& visits : plan.visits) {
    py::typing::List<VisitRow> rows;
    for (const routing::Visit& visit : visits) {
      rows.append(py::make_tuple(visit.place, visit.entry, visit.left, visit.before, visit.before_index));
    }
    movers.append(rows);
  }
  return movers;
}

}  // namespace

void BindRouting(py::module_& m) {
  using P = routing::SurfacePlan;
  py::class_<P>(m, "SurfaceRoutes", "Routes on places of the free surface.")
      .def_property_readonly("outcome", &OutcomeOf, "planned, unreachable, impossible or given_up")
      .def_readonly("unreachable", &P::unreachable)
      .def_readonly("targets", &P::targets)
      .def_readonly("sum", &P::sum)
      .def_readonly("first_sum", &P::first_sum)
      .def_readonly("lower_bound", &P::lower_bound)
      .def_property_readonly("legs", &LegsOf, "by mover: departure, place, place")
      .def_property_readonly("visits", &VisitsOf, "by mover: place, entry, left, who before, which of its visits");
  m.def("plan_surface", &Plan, py::kw_only(), py::arg("width"), py::arg("height"), py::arg("pitch"),
        py::arg("mover_size"), py::arg("velocity"), py::arg("acceleration"), py::arg("jerk"), py::arg("blocked"),
        py::arg("starts"), py::arg("targets"), py::arg("pools"), py::arg("effort"), py::arg("seed"));
  m.attr("surface_early_s") = routing::kEarly;
  m.def(
      "run_duration",
      [](double length, double velocity, double acceleration, double jerk) {
        return routing::StraightRun(length, {.velocity = velocity, .acceleration = acceleration, .jerk = jerk})
            .duration();
      },
      py::arg("length"), py::arg("velocity"), py::arg("acceleration"), py::arg("jerk"),
      "s for a straight motion from rest to rest");
}

}  // namespace takt::bindings
