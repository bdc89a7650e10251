#include "takt/engine/load_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "takt/core/angle.h"
#include "takt/core/describe.h"
#include "takt/core/scalar.h"
#include "takt/core/yaml_reader.h"
#include "takt/engine/components.h"
#include "takt/environment/params.h"
#include "takt/mover/on_parts.h"
#include "takt/part/params.h"
#include "takt/planar/clearance.h"
#include "takt/planar/environment.h"
#include "takt/planargroup/params.h"

namespace takt::engine {

namespace {

std::string At(const char* list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

// [mm] Rounding: parts that overlap by less are adjacent.
constexpr double kFlush = 1e-6;

// Rounded up, so that the result is never 0.
std::string Micrometres(double mm) {
  return FormatReal(std::ceil(mm * 1000) / 1000);
}

class Checker {
 public:
  Checker(const SourceMap& source, const Machine& machine) : source_(source), machine_(machine) {}

  std::vector<Problem> Run() {
    if (machine_.parts.empty() && !machine_.coordinate_systems.empty()) {
      Add("coordinate_systems", "expected parts in them, found none");
    }
    CheckNames();
    for (std::size_t i = 0; i < machine_.parts.size(); ++i) CheckPart(i);
    if (!problems_.empty()) return std::move(problems_);
    const planar::Parts parts = part::Make(machine_.coordinate_systems, machine_.parts);
    CheckPlaces(parts);
    CheckMovers(parts);
    return std::move(problems_);
  }

 private:
  void Add(const std::string& path, const std::string& message) {
    problems_.push_back(source_.ProblemAt(path, message));
  }

  // Coordinate systems and parts: positions refer to both.
  void CheckNames() {
    std::vector<std::string_view> names{"machine"};
    for (const ComponentKind& kind : ComponentKinds()) {
      if (kind.section == "parts") continue;
      for (std::size_t i = 0; i < kind.count(machine_); ++i) names.push_back(kind.name_of(machine_, i));
    }
    const auto check = [&](const std::string& path, std::string_view name) {
      if (std::ranges::find(names, name) != names.end()) {
        Add(path + ".name", "expected a name that nothing else has, and not machine, found " + Quoted(name));
      }
      names.push_back(name);
    };
    for (std::size_t i = 0; i < machine_.coordinate_systems.size(); ++i) {
      check(At("coordinate_systems", i), machine_.coordinate_systems[i].name);
    }
    for (std::size_t i = 0; i < machine_.parts.size(); ++i) check(At("parts", i), machine_.parts[i].name);
  }

  void CheckPart(std::size_t i) {
    const part::PartParams& part = machine_.parts[i];
    const std::string path = At("parts", i);
    std::vector<std::string_view> systems;
    for (const part::CoordinateSystemParams& system : machine_.coordinate_systems) systems.push_back(system.name);
    for (std::size_t k = 0; k < part.positions.size(); ++k) {
      const std::string& name = part.positions[k].coordinate_system;
      if (std::ranges::find(systems, name) != systems.end()) continue;
      Add(path + At(".positions", k) + ".coordinate_system",
          "expected the name of a coordinate system, found " + Quoted(name) + DidYouMean(name, systems));
    }
    if (part.positions.empty()) {
      Add(path + ".positions", "expected at least one position");
    } else if (part.initial_position > part.positions.size()) {
      Add(path + ".initial_position", "expected the index of one of its " + std::to_string(part.positions.size()) +
                                          " positions, found " + std::to_string(part.initial_position));
    }
    planar::Environment shape;
    const std::vector<planar::Place> stators = part::StatorsOf(part);
    const planar::SurfaceResult made = planar::MakeEnvironment(stators, shape);
    if (made.problem != planar::StatorProblem::kNone) {
      const bool one = made.stator < part.stators.size();
      Add(path + (one ? At(".stators", made.stator) : ".stators"), std::string(planar::Text(made.problem)));
    } else if (!planar::AreConnected(stators)) {
      Add(path + ".stators", "expected stators that hang together, each beside another one");
    }
  }

  // Checks the initial positions of parts, and positions that they can never reach.
  void CheckPlaces(const planar::Parts& parts) {
    const auto overlaps = [&](std::size_t i, std::size_t position, std::size_t k) {
      const planar::Spot& spot = parts.all[i].positions[position];
      return planar::Overlap(parts.all[i], spot, parts.all[k], parts.spot(static_cast<std::uint32_t>(k)));
    };
    for (std::size_t i = 0; i < parts.all.size(); ++i) {
      for (std::size_t position = 0; position < parts.all[i].positions.size(); ++position) {
        for (std::size_t k = 0; k < parts.all.size(); ++k) {
          const bool first = position == parts.now[i].position && k < i;
          const bool always = position != parts.now[i].position && k != i && parts.all[k].positions.size() == 1;
          if (!(first || always) || !overlaps(i, position, k)) continue;
          Add(At("parts", i) + At(".positions", position),
              "expected a place beside other parts, found one on " + Quoted(parts.all[k].name));
        }
      }
    }
  }

  void CheckMovers(const planar::Parts& parts) {
    std::vector<std::optional<planar::Spot>> spots;  // of the preceding movers; none: not known
    for (std::size_t i = 0; i < machine_.movers.size(); ++i) {
      const mover::MoverParams& mover = machine_.movers[i];
      const std::string path = At("movers", i);
      planar::Spot& at = spots.emplace_back(std::in_place).value();
      switch (
          mover::FindSpot(mover, parts, mover.reference, {{mover.initial.x, mover.initial.y}, mover.initial.c}, at)) {
        case ErrorId::kReference:
          Add(path + ".reference", mover.reference.empty()
                                       ? "expected the name of the part or coordinate system of its initial position"
                                       : "expected the name of a part or a coordinate system, found " +
                                             Quoted(mover.reference) + DidYouMean(mover.reference, References(parts)));
          spots.back().reset();
          break;
        case ErrorId::kOffStators:
          Add(path + ".initial", "expected a place where all of the mover is on stators, found " + Described(i, at));
          break;
        default:
          if (parts.none()) CheckOnEnvironment(i, at);
          break;
      }
      for (std::size_t k = 0; k < i && spots.back(); ++k) {
        if (spots[k]) CheckPair(k, *spots[k], i, at);
      }
    }
  }

  // Without parts, the environment of its group limits the positions of a mover.
  void CheckOnEnvironment(std::size_t i, const planar::Spot& at) {
    for (const planargroup::PlanarGroupParams& group : machine_.planar_groups) {
      if (!group.environment || std::ranges::find(group.movers, machine_.movers[i].name) == group.movers.end())
        continue;
      for (const environment::EnvironmentParams& one : machine_.environments) {
        planar::Environment surface;
        if (one.name != *group.environment ||
            planar::MakeEnvironment(one.stators, surface).problem != planar::StatorProblem::kNone ||
            planar::Carries(surface, mover::AreaAt(machine_.movers[i], at.origin, machine_.movers[i].initial.c))) {
          continue;
        }
        Add(At("movers", i) + ".initial", "expected a place where all of the mover is on stators of environment " +
                                              Quoted(one.name) + ", found " + Described(i, at));
      }
    }
  }

  // Returns the area that a mover covers at the start, for messages.
  std::string Described(std::size_t i, const planar::Spot& at) const {
    const mover::MoverParams& mover = machine_.movers[i];
    const planar::Extent extent = planar::ExtentOf(mover::AreaAt(mover, at.origin, mover.initial.c));
    const auto from_to = [](double from, double to) {
      return "from " + FormatReal(std::round(from * 1000) / 1000) + " to " + FormatReal(std::round(to * 1000) / 1000);
    };
    return Quoted(mover.name) + " on X " + from_to(extent.lower.x, extent.upper.x) + " mm, Y " +
           from_to(extent.lower.y, extent.upper.y) + " mm";
  }

  // Movers in two different coordinate systems are independent.
  void CheckPair(std::size_t k, const planar::Spot& at_k, std::size_t i, const planar::Spot& at_i) {
    if (at_k.system != at_i.system) return;
    const mover::MoverParams &one = machine_.movers[k], &other = machine_.movers[i];
    const double apart =
        planar::Separation({.place = at_k.origin, .direction = one.initial.c * kDegree}, {one.width, one.height},
                           {.place = at_i.origin, .direction = other.initial.c * kDegree}, {other.width, other.height});
    if (apart >= -kFlush) return;
    Add(At("movers", i) + ".initial", "expected a place beside other movers, found " + Quoted(other.name) + " on " +
                                          Quoted(one.name) + ": they overlap by " + Micrometres(-apart) + " mm");
  }

  static std::vector<std::string_view> References(const planar::Parts& parts) {
    std::vector<std::string_view> names(parts.systems.begin(), parts.systems.end());
    for (const planar::Part& part : parts.all) names.push_back(part.name);
    return names;
  }

  const SourceMap& source_;
  const Machine& machine_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> CheckParts(const SourceMap& source, const Machine& machine) {
  return Checker(source, machine).Run();
}

}  // namespace takt::engine
