#include "takt/workspace/cell.h"

#include <algorithm>

#include "takt/core/problem.h"

namespace takt::workspace {
namespace {

using kinematics::LinkInfo;

// Names of links are hierarchical: lower_arm_1_a belongs to lower_arm_1 and to lower_arm.
bool BeginsWith(const std::string& longer, const std::string& name) {
  return longer.starts_with(name + "_");
}

std::string NotOneOf(const std::string& found, std::string expected, const std::vector<std::string>& names) {
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  for (std::size_t i = 0; i < names.size(); ++i) expected += (i == 0 ? " (" : ", ") + names[i];
  return "expected " + expected + "), found " + Quoted(found) + DidYouMean(found, candidates);
}

std::vector<std::size_t> LinksMeantBy(const std::string& name, const std::vector<LinkInfo>& links) {
  std::vector<std::size_t> on;
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (links[link].name == name) return {link};
  }
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (BeginsWith(links[link].name, name)) on.push_back(link);
  }
  return on;
}

class CellBuilder {
 public:
  CellBuilder(const WorkspaceParams& params, const kinematics::Kinematics& kinematics, std::string_view folder)
      : params_(params), folder_(folder), links_(kinematics::LinksOf(kinematics)), parts_(PartsOf(params, kinematics)) {
    cell_.kinematics = kinematics;
    cell_.bounds = params.bounds;
    cell_.margin = params.margin;
    cell_.resolution = params.resolution;
  }

  MadeCell Run() && {
    if (!TakeObstacles() || !TakeBodies() || !TakeIgnored())
      return {.cell = std::nullopt, .path = std::move(path_), .problem = std::move(problem_)};
    Introduce();
    if (params_.self_collisions) FindPairs();
    return {.cell = std::move(cell_), .path = {}, .problem = {}};
  }

 private:
  bool Refuse(std::string path, std::string problem) {
    path_ = std::move(path);
    problem_ = std::move(problem);
    return false;
  }

  std::optional<Shape> Made(const SolidParams& solid, const KDL::Vector& span, const std::string& path) {
    MadeShape made = MakeShape(solid, span, folder_);
    if (!made.shape) Refuse(path + (made.path.empty() ? "" : "." + made.path), made.problem);
    return std::move(made.shape);
  }

  bool TakeObstacles() {
    for (std::size_t i = 0; i < params_.obstacles.size(); ++i) {
      const SolidParams& solid = params_.obstacles[i];
      std::optional<Shape> shape = Made(solid, {}, "obstacles[" + std::to_string(i) + "]");
      if (!shape) return false;
      cell_.scene.AddObstacle(*shape);
      cell_.obstacles.push_back({solid.name, std::move(*shape)});
    }
    return true;
  }

  // In the order of their numbers.
  bool TakeBodies() {
    for (std::size_t i = 0; i < params_.links.size(); ++i) {
      const SolidParams& solid = params_.links[i];
      const std::string path = "links[" + std::to_string(i) + "]";
      if (LinksMeantBy(solid.link, links_).empty())
        return Refuse(path + ".link", NotOneOf(solid.link, "a link of this mechanism", LinkNames()));
    }
    for (const Part& part : parts_) {
      const bool of_gripper = part.solid->link.empty();
      const SolidParams* const first = of_gripper ? params_.gripper.data() : params_.links.data();
      const std::string path = (of_gripper ? "gripper[" : "links[") + std::to_string(part.solid - first) + "]";
      std::optional<Shape> shape = Made(*part.solid, of_gripper ? KDL::Vector::Zero() : links_[part.link].span, path);
      if (!shape) return false;
      cell_.scene.AddBody(*shape);
      cell_.bodies.push_back({part.name, part.link, std::move(*shape)});
      given_names_.push_back(part.solid->name);
    }
    return true;
  }

  bool TakeIgnored() {
    names_ = LinkNames();
    for (const Obstacle& obstacle : cell_.obstacles) names_.push_back(obstacle.name);
    for (const std::string& name : given_names_) {
      if (!name.empty()) names_.push_back(name);
    }
    for (std::size_t i = 0; i < params_.ignore.size(); ++i) {
      for (const std::string& name : params_.ignore[i]) {
        if (std::none_of(names_.begin(), names_.end(), [&](const std::string& known) { return Means(name, known); })) {
          return Refuse("ignore[" + std::to_string(i) + "]",
                        NotOneOf(name, "the name of an obstacle, a link or a part of the gripper", names_));
        }
      }
    }
    return true;
  }

  std::vector<std::string> LinkNames() const {
    std::vector<std::string> names;
    for (const LinkInfo& link : links_) names.push_back(link.name);
    return names;
  }

  // `name` of `ignore` means the object of that name; only if there is none, all whose names begin with it.
  bool Means(const std::string& name, const std::string& known) const {
    const bool exact = std::find(names_.begin(), names_.end(), name) != names_.end();
    return exact ? known == name : BeginsWith(known, name);
  }

  bool Called(const std::string& name, std::size_t body) const {
    return Means(name, links_[cell_.bodies[body].link].name) || Means(name, given_names_[body]);
  }

  // `first` and `second` return true if a name means the first and the second object.
  bool Ignored(const auto& first, const auto& second) const {
    return std::any_of(params_.ignore.begin(), params_.ignore.end(), [&](const auto& pair) {
      return (first(pair[0]) && second(pair[1])) || (first(pair[1]) && second(pair[0]));
    });
  }

  // Bodies on the base are as fixed as the obstacles: they are not checked against them.
  void Introduce() {
    cell_.obstacles_of.resize(cell_.bodies.size());
    for (std::size_t b = 0; b < cell_.bodies.size(); ++b) {
      for (std::size_t o = 0; o < cell_.obstacles.size(); ++o) {
        const bool ignored = cell_.bodies[b].link == 0 ||
                             Ignored([&](const std::string& name) { return Called(name, b); },
                                     [&](const std::string& name) { return Means(name, cell_.obstacles[o].name); });
        if (ignored) {
          cell_.scene.Ignore(b, o);
        } else {
          cell_.obstacles_of[b].push_back(o);
        }
      }
    }
  }

  bool Neighbours(std::size_t a, std::size_t b) const {
    const std::vector<std::size_t>& beside = links_[a].neighbours;
    return a == b || std::find(beside.begin(), beside.end(), b) != beside.end();
  }

  void FindPairs() {
    kinematics::Joints rest{};
    for (std::size_t i = 0; i < cell_.kinematics.count; ++i) rest[i] = cell_.kinematics.scales[i].zero;
    kinematics::LinkFrameArray frames;
    const bool at_rest = kinematics::LinkFrames(cell_.kinematics, rest, frames) == kinematics::Reason::kNone;
    for (std::size_t a = 0; a < cell_.bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < cell_.bodies.size(); ++b) {
        const std::size_t link_a = cell_.bodies[a].link;
        const std::size_t link_b = cell_.bodies[b].link;
        const bool ignored = Ignored([&](const std::string& name) { return Called(name, a); },
                                     [&](const std::string& name) { return Called(name, b); });
        if (Neighbours(link_a, link_b) || ignored) continue;
        const bool near =
            at_rest && cell_.scene.Between(a, frames[link_a], b, frames[link_b], cell_.margin) < cell_.margin;
        (near ? cell_.near_at_rest : cell_.pairs).push_back({a, b});
      }
    }
  }

  const WorkspaceParams& params_;
  std::string_view folder_;
  std::vector<LinkInfo> links_;
  std::vector<Part> parts_;
  std::vector<std::string> given_names_;  // of the bodies; empty: no name
  std::vector<std::string> names_;        // to which `ignore` may refer
  Cell cell_;
  std::string path_;
  std::string problem_;
};

}  // namespace

std::vector<Part> PartsOf(const WorkspaceParams& params, const kinematics::Kinematics& kinematics) {
  const std::vector<LinkInfo> links = kinematics::LinksOf(kinematics);
  std::vector<Part> parts;
  for (const SolidParams& solid : params.links) {
    const std::vector<std::size_t> on = LinksMeantBy(solid.link, links);
    for (const std::size_t link : on) {
      std::string name = solid.name.empty() ? links[link].name : solid.name;
      if (on.size() > 1 && !solid.name.empty()) name += " on " + links[link].name;
      parts.push_back({std::move(name), link, &solid});
    }
  }
  for (const SolidParams& solid : params.gripper) parts.push_back({solid.name, links.size() - 1, &solid});
  return parts;
}

MadeCell MakeCell(const WorkspaceParams& params, const kinematics::Kinematics& kinematics, std::string_view folder) {
  return CellBuilder(params, kinematics, folder).Run();
}

}  // namespace takt::workspace
