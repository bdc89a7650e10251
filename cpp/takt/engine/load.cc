#include "takt/engine/load.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "takt/axis/following.h"
#include "takt/core/scalar.h"
#include "takt/core/yaml_reader.h"
#include "takt/engine/components.h"
#include "takt/engine/load_buses.h"
#include "takt/engine/load_cams.h"
#include "takt/engine/load_groups.h"
#include "takt/engine/load_parts.h"
#include "takt/engine/load_twin.h"
#include "takt/engine/order.h"
#include "takt/group/zones.h"
#include "takt/planar/environment.h"
#include "takt/track/build.h"
#include "takt/track/ranges.h"
#include "takt/track/tracks.h"

namespace takt::engine {

namespace {

// Names become part of channel names and of commands.
bool GoodName(std::string_view name) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  };
  return !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), good);
}

// For display: everything but control characters.
bool GoodMachineName(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
  });
}

// Checks that the reader cannot make: references between parts of the file.
class CrossCheck {
 public:
  CrossCheck(const Machine& machine, const SourceMap& source) : machine_(machine), source_(source) {}

  std::vector<Problem> Run() {
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) names_.push_back(machine_.axes[i].name);
    if (!GoodMachineName(machine_.name) && !(machine_.name.empty() && !Written("", "name"))) {
      Add("name", "expected 1 to 64 bytes without control characters, found " + Quoted(machine_.name));
    }
    CheckAxes();
    CheckMasters();
    CheckNames("cams", machine_.cams);
    CheckNames("cam_switches", machine_.cam_switches);
    CheckNames("flex_cams", machine_.flex_cams);
    CheckModules();
    CheckNames("groups", machine_.groups);
    CheckNames("paths", machine_.paths);
    CheckGroups();
    CheckNames("zones", machine_.zones);
    CheckZones();
    CheckNames("belts", machine_.belts);
    CheckNames("poses", machine_.poses);
    CheckBelts();
    CheckNames("pick_and_place", machine_.pick_and_place);
    CheckPickPlaces();
    CheckNames("movers", machine_.movers);
    CheckMovers();
    CheckNames("tracks", machine_.tracks);
    CheckNames("coordinate_systems", machine_.coordinate_systems);
    CheckNames("parts", machine_.parts);
    const std::vector<Problem> of_parts = CheckParts(source_, machine_);
    problems_.insert(problems_.end(), of_parts.begin(), of_parts.end());
    CheckTracks(of_parts.empty());
    CheckNames("planar_groups", machine_.planar_groups);
    CheckPlanarGroups();
    CheckNames("environments", machine_.environments);
    CheckEnvironments();
    CheckCamSwitches();
    std::vector<std::string_view> servos;
    for (std::size_t i = 0; i < machine_.simulation.servos.size(); ++i) {
      CheckReference("simulation.servos[" + std::to_string(i) + "].axis", machine_.simulation.servos[i].axis, servos);
    }
    std::vector<std::string_view> external;
    for (std::size_t i = 0; i < machine_.external.drives.size(); ++i) {
      CheckReference("external.drives[" + std::to_string(i) + "].axis", machine_.external.drives[i].axis, external);
    }
    const std::vector<Problem> of_buses = CheckBuses(source_, machine_);
    problems_.insert(problems_.end(), of_buses.begin(), of_buses.end());
    const std::vector<Problem> of_twin = CheckTwin(source_, machine_);
    problems_.insert(problems_.end(), of_twin.begin(), of_twin.end());
    CheckRates();
    return std::move(problems_);
  }

 private:
  void Add(const std::string& path, const std::string& message) {
    problems_.push_back(source_.ProblemAt(path, message));
  }

  void AddIf(const std::string& path, const std::string& message) {
    if (!message.empty()) Add(path, message);
  }

  void CheckAxes() {
    if (ComponentNames(machine_).empty()) {
      Add("axes", "expected at least one axis");
    }
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const std::string path = "axes[" + std::to_string(i) + "]";
      const std::string& name = machine_.axes[i].name;
      if (name.empty() && !Written(path, ".name")) continue;  // reported as missing already
      if (!GoodName(name)) {
        Add(path + ".name", "expected 1 to 40 letters, digits, _ - or ., found " + Quoted(name));
      } else if (name == "machine") {
        Add(path + ".name", "expected another name: machine means the engine itself");
      }
    }
  }

  // Returns true if the key after `path` is written in the text.
  bool Written(const std::string& path, const char* key) const {
    const Place inner = source_.PlaceOf(path + key);
    const Place outer = source_.PlaceOf(path);
    return inner.line != outer.line || inner.column != outer.column;
  }

  void CheckMasters() {
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const axis::AxisParams& axis = machine_.axes[i];
      const std::string& wire = axis.inputs.touch_probe_of;
      if (!wire.empty() && axis::FindAxis(machine_.axes, wire) == axis::kNoAxis) {
        Add("axes[" + std::to_string(i) + "].inputs.touch_probe_of",
            "expected the name of an axis, found " + Quoted(wire) + DidYouMean(wire, names_));
      }
      if (!axis.follows || axis.follows->axis.empty()) continue;
      const std::string path = "axes[" + std::to_string(i) + "].follows.axis";
      const std::optional<std::uint32_t> master = MasterOf(machine_, i);
      if (!master) {
        Add(path, "expected the name of an axis, found " + Quoted(axis.follows->axis) +
                      DidYouMean(axis.follows->axis, names_));
      } else if (std::string why = axis::CannotFollow(axis, machine_.axes[*master]); !why.empty()) {
        Add(path, why);
      }
    }
    Order order(machine_.axes.size());
    const auto master_of = [&](std::uint32_t i, std::uint32_t k) -> std::optional<std::uint32_t> {
      const std::optional<std::uint32_t> followed = MasterOf(machine_, i);
      if (followed && k-- == 0) return followed;
      const std::optional<std::uint32_t> led = MasterOfModule(machine_, i);
      return led && led != i && k == 0 ? led : std::nullopt;  // an axis that leads itself is reported elsewhere
    };
    if (order.Make(master_of)) return;
    std::string members;
    const std::span<const std::uint32_t> loop = order.loop();
    for (const std::uint32_t i : loop) members += machine_.axes[i].name + " -> ";
    Add("axes[" + std::to_string(loop.front()) + "]",
        "expected axes that follow one another in no loop, found " + members + machine_.axes[loop.front()].name);
  }

  // Cam modules and the axes and cams that they refer to.
  void CheckModules() {
    std::vector<std::string_view> slaves;
    std::vector<std::string_view> cams;
    for (const cam::CamParams& cam : machine_.cams) cams.push_back(cam.name);
    for (std::size_t i = 0; i < machine_.flex_cams.size(); ++i) {
      const flexcam::FlexCamParams& module = machine_.flex_cams[i];
      const std::string path = "flex_cams[" + std::to_string(i) + "]";
      if (module.name == "machine" || std::ranges::find(names_, module.name) != names_.end()) {
        Add(path + ".name", "expected a name that no axis has, and not machine, found " + Quoted(module.name));
      }
      CheckReference(path + ".slave", module.slave, slaves);
      std::vector<std::string_view> any;
      const std::vector<std::string> masters = MasterNames(machine_);
      const std::vector<std::string_view> views(masters.begin(), masters.end());
      if (module.master) {
        CheckReference(path + ".master", *module.master, any, views, "axis, a belt or a mover");
      }
      for (const conveyor::BeltParams& belt : machine_.belts) {
        if (module.master != belt.name || module.slave != belt.axis) continue;
        Add(path + ".master", "expected another master than a belt on the slave " + Quoted(module.slave) + ", found " +
                                  Quoted(belt.name));
      }
      for (const axis::AxisParams& axis : machine_.axes) {
        if (axis.name == module.slave && axis.follows) {
          Add(path + ".slave", "expected an axis that does not follow another, found " + Quoted(module.slave));
        }
      }
      for (std::size_t k = 0; k < module.cams.size(); ++k) {
        if (std::ranges::find(cams, module.cams[k]) != cams.end()) continue;
        Add(path + ".cams[" + std::to_string(k) + "]",
            "expected the name of a cam, found " + Quoted(module.cams[k]) + DidYouMean(module.cams[k], cams));
      }
    }
  }

  // Groups and the axes that they refer to.
  void CheckGroups() {
    std::vector<std::string_view> others = names_;
    for (const flexcam::FlexCamParams& module : machine_.flex_cams) others.push_back(module.name);
    std::vector<std::string_view> members;
    for (std::size_t i = 0; i < machine_.groups.size(); ++i) {
      const group::GroupParams& group = machine_.groups[i];
      const std::string path = "groups[" + std::to_string(i) + "]";
      if (group.name == "machine" || std::ranges::find(others, group.name) != others.end()) {
        Add(path + ".name",
            "expected a name that no axis and no cam module has, and not machine, found " + Quoted(group.name));
      }
      for (std::size_t k = 0; k < group.axes.size(); ++k) {
        const std::string place = path + ".axes[" + std::to_string(k) + "]";
        CheckReference(place, group.axes[k], members);
        CheckMember(place, group.axes[k]);
      }
    }
  }

  // Zones and the groups that share them.
  void CheckZones() {
    if (machine_.zones.size() > group::kZones) {
      Add("zones", "expected at most " + std::to_string(group::kZones) + " zones, found " +
                       std::to_string(machine_.zones.size()));
    }
    if (!machine_.zones.empty() && machine_.groups.size() > group::kZoneGroups) {
      Add("zones", "expected at most " + std::to_string(group::kZoneGroups) +
                       " groups in a machine with zones, found " + std::to_string(machine_.groups.size()));
    }
    std::vector<std::string_view> groups, seen;
    for (const group::GroupParams& group : machine_.groups) groups.push_back(group.name);
    for (std::size_t i = 0; i < machine_.zones.size(); ++i) {
      const group::ZoneParams& zone = machine_.zones[i];
      const std::string path = "zones[" + std::to_string(i) + "]";
      if (!zone.name.empty() && std::ranges::find(seen, zone.name) != seen.end()) {
        Add(path + ".name", "expected each zone once, found " + Quoted(zone.name) + " again");
      }
      seen.push_back(zone.name);
      std::vector<std::string_view> sharing;
      for (std::size_t k = 0; k < zone.groups.size(); ++k) {
        const std::string place = path + ".groups[" + std::to_string(k) + "]";
        CheckReference(place, zone.groups[k], sharing, groups, "group");
        for (const group::GroupParams& group : machine_.groups) {
          if (group.name == zone.groups[k] && !group.kinematics) {
            Add(place, "expected a group with kinematics, for only these have a tool, found " + Quoted(group.name));
          }
        }
      }
      if (zone.groups.size() == 1) {
        Add(path + ".groups", "expected at least 2 groups, or none for all of them, found " + Quoted(zone.groups[0]));
      }
    }
  }

  // Belts and the axes that they refer to, which several belts may share; and poses.
  void CheckBelts() {
    for (std::size_t i = 0; i < machine_.belts.size(); ++i) {
      const std::string path = "belts[" + std::to_string(i) + "]";
      CheckUnique("belts", i, machine_.belts[i].name);
      std::vector<std::string_view> any;
      CheckReference(path + ".axis", machine_.belts[i].axis, any);
    }
    for (std::size_t i = 0; i < machine_.poses.size(); ++i) {
      CheckUnique("poses", i, machine_.poses[i].name);
    }
  }

  // Pick and place modules and what they refer to. A group has at most one module.
  void CheckPickPlaces() {
    std::vector<std::string_view> groups, belts, moved;
    for (const group::GroupParams& group : machine_.groups) groups.push_back(group.name);
    for (const conveyor::BeltParams& belt : machine_.belts) belts.push_back(belt.name);
    for (std::size_t i = 0; i < machine_.pick_and_place.size(); ++i) {
      const pickplace::PickPlaceParams& module = machine_.pick_and_place[i];
      const std::string path = "pick_and_place[" + std::to_string(i) + "]";
      CheckUnique("pick_and_place", i, module.name);
      CheckReference(path + ".group", module.group, moved, groups, "group");
      std::vector<std::string_view> used;
      for (std::size_t k = 0; k < module.belts.size(); ++k) {
        const std::string place = path + ".belts[" + std::to_string(k) + "]";
        CheckReference(place + ".belt", module.belts[k].belt, used, belts, "belt");
        const auto belt = std::ranges::find(machine_.belts, module.belts[k].belt, &conveyor::BeltParams::name);
        if (belt == machine_.belts.end()) continue;
        AddIf(place + ".settings.lower_limit", pickplace::DiagnoseRange(module.belts[k].settings, *belt));
        AddIf(place + ".settings.leave", pickplace::DiagnoseLeave(module.belts[k].settings, *belt));
      }
      const pickplace::Settings& settings = module.settings;
      const std::size_t count = module.belts.size();
      AddIf(path + ".settings.tracking_mode", pickplace::DiagnoseMode(settings.tracking_mode, count));
      AddIf(path + ".settings.pick_belt", pickplace::DiagnoseBelt(settings.pick_belt, count, pickplace::kStaticTarget));
      AddIf(path + ".settings.place_belt",
            pickplace::DiagnoseBelt(settings.place_belt, count, pickplace::kStaticTarget));
      for (const group::GroupParams& group : machine_.groups) {
        if (group.name != module.group) continue;
        const std::vector<std::string_view> members(group.axes.begin(), group.axes.end());
        std::vector<std::string_view> homed;
        for (std::size_t k = 0; k < module.homing.size(); ++k) {
          CheckReference(path + ".homing[" + std::to_string(k) + "].axis", module.homing[k].axis, homed, members,
                         "axis of its group");
        }
      }
    }
  }

  void CheckMovers() {
    for (std::size_t i = 0; i < machine_.movers.size(); ++i) {
      const mover::MoverParams& mover = machine_.movers[i];
      CheckUnique("movers", i, mover.name);
      // In any orientation. The default gap depends on the mover's size.
      const double least = std::min(mover.width, mover.height);
      const std::string path = "movers[" + std::to_string(i) + "]";
      if (mover.gap >= least || !Written(path, ".gap")) continue;
      Add(path + ".gap", "expected at least the smaller side of the mover, " + FormatReal(least) + " mm, found " +
                             FormatReal(mover.gap) + " mm");
    }
  }

  // Tracks, their geometry and their links.
  void CheckTracks(bool parts_are_good) {
    for (std::size_t i = 0; i < machine_.tracks.size(); ++i) CheckUnique("tracks", i, machine_.tracks[i].name);
    if (!parts_are_good) return;
    const planar::Parts parts = part::Make(machine_.coordinate_systems, machine_.parts);
    const std::vector<track::BuildProblem> problems = track::Build(machine_.tracks, &parts).problems;
    for (const track::BuildProblem& problem : problems) Add("tracks" + problem.path, problem.message);
    if (problems.empty()) CheckRanges(parts);
  }

  // PL-81: given ranges are no shorter than those that the movers of a track need.
  void CheckRanges(const planar::Parts& parts) {
    const auto is_manual = [](const track::TrackParams& params) {
      return params.collision_range_mode == track::CollisionRangeMode::kManual;
    };
    if (std::ranges::none_of(machine_.tracks, is_manual)) return;
    std::vector<track::TrackParams> automatic = machine_.tracks;
    for (track::TrackParams& params : automatic) params.collision_range_mode = track::CollisionRangeMode::kAutomatic;
    const track::Tracks tracks(automatic, &parts);
    for (std::size_t i = 0; i < automatic.size(); ++i) {
      const track::TrackParams& params = machine_.tracks[i];
      if (!is_manual(params)) continue;
      const track::CollisionRanges least = track::RangesOf(tracks, i);
      const auto check = [&](const char* key, double given, double needed) {
        constexpr double kResolution = 1;  // [mm] of the required range
        if (given >= needed - kResolution) return;
        Add("tracks[" + std::to_string(i) + "]." + key,
            "expected at least " + FormatReal(std::ceil(needed)) + " mm, within which movers of " +
                FormatReal(params.mover_width) + " mm by " + FormatReal(params.mover_height) +
                " mm on tracks that meet there can touch, found " + FormatReal(given) + " mm");
      };
      check("collision_range_at_start", params.collision_range_at_start, least.at_start);
      check("collision_range_at_end", params.collision_range_at_end, least.at_end);
    }
  }

  // Groups of movers and their contents: each object is in at most one group.
  void CheckPlanarGroups() {
    std::vector<std::string_view> movers, tracks, environments, in_groups;
    for (const mover::MoverParams& mover : machine_.movers) movers.push_back(mover.name);
    for (const track::TrackParams& track : machine_.tracks) tracks.push_back(track.name);
    for (const environment::EnvironmentParams& one : machine_.environments) environments.push_back(one.name);
    for (std::size_t i = 0; i < machine_.planar_groups.size(); ++i) {
      const planargroup::PlanarGroupParams& group = machine_.planar_groups[i];
      const std::string path = "planar_groups[" + std::to_string(i) + "]";
      CheckUnique("planar_groups", i, group.name);
      for (std::size_t k = 0; k < group.movers.size(); ++k) {
        CheckReference(path + ".movers[" + std::to_string(k) + "]", group.movers[k], in_groups, movers, "mover");
      }
      for (std::size_t k = 0; k < group.tracks.size(); ++k) {
        CheckReference(path + ".tracks[" + std::to_string(k) + "]", group.tracks[k], in_groups, tracks, "track");
      }
      if (group.environment) {
        CheckReference(path + ".environment", *group.environment, in_groups, environments, "environment");
      }
    }
  }

  void CheckEnvironments() {
    for (std::size_t i = 0; i < machine_.environments.size(); ++i) {
      const environment::EnvironmentParams& environment = machine_.environments[i];
      CheckUnique("environments", i, environment.name);
      if (environment.stators.empty()) continue;
      planar::Environment surface;
      const planar::SurfaceResult surfacing = planar::MakeEnvironment(environment.stators, surface);
      if (surfacing.problem == planar::StatorProblem::kNone) continue;
      std::string path = "environments[" + std::to_string(i) + "].stators";
      if (surfacing.stator < environment.stators.size()) path += "[" + std::to_string(surfacing.stator) + "]";
      Add(path, std::string(planar::Text(surfacing.problem)));
    }
  }

  // Component names are unique; the later one is reported. Names within one section are checked by the reader.
  void CheckUnique(std::string_view section, std::size_t index, std::string_view name) {
    const std::vector<std::string_view> others = NamesBefore(section);
    if (name != "machine" && std::ranges::find(others, name) == others.end()) return;
    Add(std::string(section) + "[" + std::to_string(index) + "].name",
        "expected a name that nothing else has, and not machine, found " + Quoted(name));
  }

  std::vector<std::string_view> NamesBefore(std::string_view section) const {
    std::vector<std::string_view> names;
    for (const ComponentKind& kind : ComponentKinds()) {
      if (kind.section == section) break;
      for (std::size_t i = 0; i < kind.count(machine_); ++i) names.push_back(kind.name_of(machine_, i));
    }
    return names;
  }
  std::vector<std::string_view> Components() const { return ComponentNames(machine_); }

  // A member of a group must not be moved by anything else.
  void CheckMember(const std::string& path, std::string_view name) {
    if (std::string why = WhyNoMember(machine_, name); !why.empty()) Add(path, why);
  }

  // Lists of cam switches that no axis of the machine can have.
  void CheckCamSwitches() {
    for (std::size_t i = 0; i < machine_.cam_switches.size(); ++i) {
      const axis::CamSwitches& list = machine_.cam_switches[i];
      const auto cannot = [&](const axis::AxisParams& axis) { return !axis::DiagnoseCamSwitches(list, axis).empty(); };
      if (machine_.axes.empty() || !std::ranges::all_of(machine_.axes, cannot)) continue;
      Add("cam_switches[" + std::to_string(i) + "].switches",
          "no axis can have this list: " + axis::DiagnoseCamSwitches(list, machine_.axes.front()));
    }
  }

  template <typename T>
  void CheckNames(const std::string& list, const std::vector<T>& elements) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const std::string path = list + "[" + std::to_string(i) + "]";
      const std::string& name = elements[i].name;
      if (!GoodName(name) && !(name.empty() && !Written(path, ".name"))) {
        Add(path + ".name", "expected 1 to 40 letters, digits, _ - or ., found " + Quoted(name));
      }
    }
  }

  // Rates of components of any kind.
  void CheckRates() {
    const std::vector<std::string_view> components = Components();
    std::vector<std::string_view> seen;
    for (std::size_t i = 0; i < machine_.lcm.rates.size(); ++i) {
      CheckReference("lcm.rates[" + std::to_string(i) + "].axis", machine_.lcm.rates[i].axis, seen, components,
                     components.size() == names_.size() ? "axis" : "axis or other component");
    }
  }

  // Checks a name that must be an axis', each at most once.
  void CheckReference(const std::string& path, std::string_view name, std::vector<std::string_view>& seen) {
    CheckReference(path, name, seen, names_, "axis");
  }

  // Checks a name that must be one of `names`, each at most once.
  void CheckReference(const std::string& path, std::string_view name, std::vector<std::string_view>& seen,
                      const std::vector<std::string_view>& names, const std::string& what) {
    if (name.empty()) return;
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      const bool vowel = std::string_view("aeiou").find(what.front()) != std::string_view::npos;
      Add(path, std::string("expected the name of a") + (vowel ? "n " : " ") + what + ", found " + Quoted(name) +
                    DidYouMean(name, names));
    } else if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
      Add(path, "expected each " + what + " once, found " + Quoted(name) + " again");
    }
    seen.push_back(name);
  }

  const Machine& machine_;
  const SourceMap& source_;
  std::vector<std::string_view> names_;
  std::vector<Problem> problems_;
};

}  // namespace

std::string NotOpened(const std::string& file) {
  return "expected what stands in the file itself, found its name " + Quoted(file) +
         ": a machine that is described over a network or in a log opens no files";
}

LoadResult LoadMachine(std::string_view text, std::string_view file_name, Workspaces workspaces, Files files) {
  Machine machine;
  SourceMap source(file_name);
  std::vector<Problem> problems = ReadYaml(TypeOf<Machine>(), &machine, text, file_name, source);
  const bool readable = problems.size() < kMaxProblems;
  CamLoading cams;
  GroupLoading groups;
  if (problems.empty()) {
    cams = LoadCams(source, machine, files);
    groups = LoadGroups(source, machine, workspaces, files);
  }
  const bool has_any = std::ranges::any_of(ComponentKinds(), [&](const ComponentKind& k) { return k.count(machine); });
  if (readable && has_any) {
    std::vector<Problem> more = CrossCheck(machine, source).Run();
    // A value that could not be read was not stored: the value found in its member is not the one in the file.
    const auto told = [&](const Problem& p) {
      return !p.path.empty() && std::ranges::find(problems, p.path, &Problem::path) != problems.end();
    };
    std::erase_if(more, told);
    problems.insert(problems.end(), more.begin(), more.end());
  } else if (problems.empty()) {
    problems = CrossCheck(machine, source).Run();
  }
  problems.insert(problems.end(), cams.problems.begin(), cams.problems.end());
  problems.insert(problems.end(), groups.problems.begin(), groups.problems.end());
  const auto key = [&](const Problem& p) { return std::tuple(p.source != file_name, p.place.line, p.place.column); };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return key(a) < key(b); });
  LoadResult result;
  result.names_files = cams.files || groups.files;
  for (const Problem& problem : problems) result.problems.push_back(problem.Text());
  for (const Problem& warning : cams.warnings) result.warnings.push_back(warning.Text());
  result.checkers = std::move(groups.checkers);
  if (problems.empty()) {
    AddDrivesOfBuses(machine);
    result.machine = std::move(machine);
  }
  return result;
}

LoadResult LoadMachineFile(const std::string& path) {
  std::string why;
  const std::optional<std::string> text = LoadText(path, why);
  if (!text) return {.machine = std::nullopt, .problems = {path + ": " + why}, .warnings = {}};
  return LoadMachine(*text, path);
}

}  // namespace takt::engine
