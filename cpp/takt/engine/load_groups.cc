#include "takt/engine/load_groups.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "takt/core/read_file.h"
#include "takt/core/yaml_reader.h"
#include "takt/group/path_table.h"
#include "takt/kinematics/kinematics.h"
#include "takt/workspace/urdf_links.h"

namespace takt::engine {

namespace {

class Loader {
 public:
  Loader(const SourceMap& source, Machine& machine, Workspaces workspaces, Files files)
      : source_(source),
        machine_(machine),
        workspaces_(workspaces == Workspaces::kMake && files == Files::kOpen),
        files_(files) {}

  GroupLoading Run() {
    loading_.checkers.resize(machine_.groups.size());
    for (std::size_t i = 0; i < machine_.groups.size(); ++i) {
      LoadGroup(i, "groups[" + std::to_string(i) + "]", machine_.groups[i]);
    }
    for (std::size_t i = 0; i < machine_.paths.size(); ++i) {
      LoadPath("paths[" + std::to_string(i) + "]", machine_.paths[i]);
    }
    return std::move(loading_);
  }

 private:
  void Add(const std::string& path, const std::string& message) {
    loading_.problems.push_back(source_.ProblemAt(path, message));
  }

  std::filesystem::path Folder() const { return std::filesystem::path(source_.file()).parent_path(); }
  std::string Beside(const std::string& file) const { return (Folder() / file).string(); }

  // Returns the text of the file that the key `path` names.
  std::optional<std::string> Read(const std::string& path, const std::string& file) {
    loading_.files = true;
    if (files_ == Files::kRefuse) {
      Add(path, NotOpened(file));
      return {};
    }
    std::string why;
    std::optional<std::string> text = ReadFile(file, kMaxYamlBytes + 1, why);
    if (text && text->size() > kMaxYamlBytes) {
      why = "holds more than " + std::to_string(kMaxYamlBytes / 1'000'000) + " MB";
      text.reset();
    }
    if (!text) Add(path, file + ": " + why);
    return text;
  }

  void LoadGroup(std::size_t index, const std::string& path, group::GroupParams& group) {
    if (!group.kinematics) return;
    kinematics::KinematicsParams& params = *group.kinematics;
    std::string file;
    std::string urdf_folder;
    if (params.serial && !kinematics::IsUrdfText(params.serial->urdf)) {
      urdf_folder = std::filesystem::path(params.serial->urdf).parent_path().string();
      file = Beside(params.serial->urdf);
      std::optional<std::string> text = Read(path + ".kinematics.serial.urdf", file);
      if (!text) return;
      if (std::optional<Problem> problem = kinematics::CheckUrdfFile(*text, file)) {
        problem->path = path + ".kinematics.serial.urdf";
        return loading_.problems.push_back(std::move(*problem));
      }
      params.serial->urdf = std::move(*text);
    }
    const kinematics::MakeResult made = kinematics::Make(params);
    if (!made.kinematics) {
      const bool of_file = made.path.starts_with("serial") && !file.empty();
      Add(path + ".kinematics" + (made.path.empty() ? "" : "." + made.path),
          (of_file ? file + ": " : "") + made.problem);
    } else if (made.kinematics->count > group.axes.size()) {
      Add(path + ".axes", "expected the names of the " + std::to_string(made.kinematics->count) +
                              " axes of the kinematics, found " + std::to_string(group.axes.size()));
    } else if (group.workspace) {
      if (params.serial && group.workspace->links.empty()) {
        workspace::UrdfLinks urdf =
            workspace::LinksOfUrdf(*params.serial, *made.kinematics, Folder().string(), urdf_folder);
        group.workspace->links = std::move(urdf.links);
        if (!urdf.problem.empty()) return Add(path + ".workspace.links", urdf.problem);
      }
      if (workspaces_) LoadWorkspace(path + ".workspace", group, *made.kinematics, loading_.checkers[index]);
    }
  }

  void LoadWorkspace(const std::string& path, const group::GroupParams& group, const kinematics::Kinematics& kinematics,
                     std::optional<workspace::Checker>& checker) {
    workspace::MakeResult made =
        workspace::Make(*group.workspace, kinematics, Folder().string(), kinematics::ToFrame(group.tool).p);
    if (!made.checker) Add(path + (made.path.empty() ? "" : "." + made.path), made.problem);
    checker = std::move(made.checker);
  }

  void LoadPath(const std::string& path, group::PathParams& params) {
    std::optional<group::PathCsv> csv;
    std::string file;
    if (!params.file.empty()) {
      file = Beside(params.file);
      const std::optional<std::string> text = Read(path + ".file", file);
      if (!text) return;
      csv = group::ReadPathCsv(*text, file);
      if (csv->problems.empty() && csv->elements.empty()) Add(path + ".file", file + ": expected at least one element");
      loading_.problems.insert(loading_.problems.end(), csv->problems.begin(), csv->problems.end());
      if (!csv->problems.empty()) return;
      params.elements = csv->elements;
      params.file.clear();
    }
    const group::PathTableResult made = group::MakePathTable(params);
    if (made.table) return;
    if (csv) {
      loading_.problems.push_back({file, group::PlaceInCsv(*csv, made.path), path, made.problem});
    } else {
      Add(path + "." + made.path, made.problem);
    }
  }

  const SourceMap& source_;
  Machine& machine_;
  const bool workspaces_;
  const Files files_;
  GroupLoading loading_;
};

}  // namespace

GroupLoading LoadGroups(const SourceMap& source, Machine& machine, Workspaces workspaces, Files files) {
  return Loader(source, machine, workspaces, files).Run();
}

}  // namespace takt::engine
