#include "takt/engine/load_twin.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "takt/core/yaml_reader.h"

namespace takt::engine {

namespace {

class TwinChecker {
 public:
  TwinChecker(const SourceMap& source, const Machine& machine)
      : source_(source), machine_(machine), twin_(*machine.twin), made_(twin_.model.empty()) {}

  std::vector<Problem> Run() {
    if (twin_.axes.empty()) Add("twin.axes", "expected at least one axis");
    for (std::size_t i = 0; i < twin_.axes.size(); ++i) CheckAxis(i);
    for (std::size_t i = 0; i < twin_.mechanisms.size(); ++i) CheckMechanism(i);
    for (std::size_t i = 0; i < twin_.belts.size(); ++i) CheckBelt(i);
    if (!made_ && twin_.products) Add("twin.products", "expected no products beside a model that is given");
    return std::move(problems_);
  }

 private:
  void Add(const std::string& path, const std::string& message) {
    problems_.push_back(source_.ProblemAt(path, message));
  }

  // Returns true if `name` is one of `names` and not in `seen` yet.
  bool Known(const std::string& path, const std::string& what, std::string_view name,
             const std::vector<std::string_view>& names, std::vector<std::string_view>& seen) {
    if (name.empty()) return false;  // reported as missing already
    if (std::ranges::find(names, name) == names.end()) {
      Add(path, "expected the name of " + what + ", found " + Quoted(name) + DidYouMean(name, names));
      return false;
    }
    if (std::ranges::find(seen, name) != seen.end()) {
      Add(path, "expected each name once, found " + Quoted(name) + " again");
      return false;
    }
    seen.push_back(name);
    return true;
  }

  const group::GroupParams* GroupOf(std::string_view axis) const {
    for (const group::GroupParams& group : machine_.groups) {
      if (group.kinematics && std::ranges::find(group.axes, axis) != group.axes.end()) return &group;
    }
    return nullptr;
  }

  void CheckAxis(std::size_t i) {
    const plant::TwinAxis& axis = twin_.axes[i];
    const std::string path = "twin.axes[" + std::to_string(i) + "]";
    std::vector<std::string_view> names;
    for (const axis::AxisParams& one : machine_.axes) names.push_back(one.name);
    if (!Known(path + ".axis", "an axis", axis.axis, names, axes_)) return;
    if (made_ && !axis.joint.empty()) {
      Add(path + ".joint", "expected a model that has joints (twin.model), found none");
    }
    if (!made_ && axis.joint.empty()) Add(path, "expected the joint of the model that this axis moves (joint)");
    if (!made_) return;
    const group::GroupParams* group = GroupOf(axis.axis);
    const bool weighed = group && group->kinematics->serial;  // its file defines the masses
    if (!weighed && !axis.mass) Add(path, "expected the mass of the body that this axis moves (mass)");
    if (weighed && axis.mass) Add(path + ".mass", "expected no mass: the URDF of group " + group->name + " has it");
    if (group) return;
    const auto at = std::ranges::find(machine_.axes, axis.axis, &axis::AxisParams::name);
    if (at->unit == "mm" || at->unit == "deg") return;
    Add(path, "expected an axis in mm or deg, or one of a group's kinematics; the unit of " + axis.axis + " is " +
                  Quoted(at->unit));
  }

  void CheckMechanism(std::size_t i) {
    const plant::TwinMechanism& mechanism = twin_.mechanisms[i];
    const std::string path = "twin.mechanisms[" + std::to_string(i) + "]";
    std::vector<std::string_view> names;
    for (const group::GroupParams& group : machine_.groups) {
      if (group.kinematics) names.push_back(group.name);
    }
    if (!Known(path + ".group", "a group with kinematics", mechanism.group, names, groups_)) return;
    const auto group = std::ranges::find(machine_.groups, mechanism.group, &group::GroupParams::name);
    for (const std::string& axis : group->axes) {
      if (std::ranges::find(axes_, axis) != axes_.end()) continue;
      Add(path, "expected all axes of group " + group->name + " in twin.axes, found no " + Quoted(axis));
    }
    if (made_ && !mechanism.tool.empty()) {
      Add(path + ".tool", "expected a model that has it (twin.model), found none");
    }
    if (mechanism.gripper) CheckGripper(*group, path + ".gripper");
    if (!made_) return;
    if (group->kinematics->core_xy) {
      Add(path + ".group",
          "expected a gantry, SCARA, Delta, six axes or URDF, found core_xy, whose motors move both "
          "axes: give a model (twin.model)");
    }
    const bool delta = group->kinematics->delta.has_value();
    const auto check = [&](const std::optional<double>& mass, const char* key, const char* what) {
      if (delta && !mass) Add(path, std::string("expected the mass of ") + what + " (" + key + ")");
      if (!delta && mass) Add(path + "." + key, "expected this of a Delta only");
    };
    check(mechanism.platform_mass, "platform_mass", "the platform");
    check(mechanism.rod_mass, "rod_mass", "each rod");
  }

  void CheckGripper(const group::GroupParams& group, const std::string& path) {
    if (!made_ || group.kinematics->serial) {
      Add(path, "expected a mechanism that is made of kinematics, found one whose model is given");
    } else if (!twin_.products) {
      Add(path, "expected products that it can hold (twin.products), found none");
    }
  }

  void CheckBelt(std::size_t i) {
    const plant::TwinBelt& belt = twin_.belts[i];
    const std::string path = "twin.belts[" + std::to_string(i) + "]";
    std::vector<std::string_view> names;
    for (const conveyor::BeltParams& one : machine_.belts) names.push_back(one.name);
    if (!Known(path + ".belt", "a belt", belt.belt, names, belts_)) return;
    const auto at = std::ranges::find(machine_.belts, belt.belt, &conveyor::BeltParams::name);
    if (!made_) Add(path, "expected no belts beside a model that is given");
    if (at->kind != conveyor::BeltKind::kStraight) Add(path + ".belt", "expected a straight belt, found a table");
    if (at->ratio != 1) Add(path + ".belt", "expected a belt whose ratio is 1, found " + std::to_string(at->ratio));
    if (std::ranges::find(axes_, at->axis) == axes_.end()) {
      Add(path + ".belt", "expected its axis in twin.axes, found no " + Quoted(at->axis));
    }
    for (std::size_t k = 0; k < i; ++k) {
      const auto other = std::ranges::find(machine_.belts, twin_.belts[k].belt, &conveyor::BeltParams::name);
      if (other != machine_.belts.end() && other->axis == at->axis) {
        Add(path + ".belt",
            "expected an axis of its own, found that " + Quoted(at->axis) + " moves " + Quoted(other->name) + ", too");
      }
    }
    if (!(belt.from < belt.to)) Add(path + ".to", "expected an end behind the beginning (from)");
  }

  const SourceMap& source_;
  const Machine& machine_;
  const plant::TwinParams& twin_;
  const bool made_;
  std::vector<std::string_view> axes_;
  std::vector<std::string_view> groups_;
  std::vector<std::string_view> belts_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> CheckTwin(const SourceMap& source, const Machine& machine) {
  return machine.twin ? TwinChecker(source, machine).Run() : std::vector<Problem>{};
}

}  // namespace takt::engine
