#include "takt/engine/load_cams.h"

#include <filesystem>
#include <optional>
#include <string>

#include "takt/cam/build.h"
#include "takt/cam/csv.h"
#include "takt/core/read_file.h"
#include "takt/core/yaml_reader.h"

namespace takt::engine {

namespace {

class CamLoader {
 public:
  CamLoader(const SourceMap& source, std::size_t index, cam::CamParams& cam, Files files, CamLoading& loading)
      : source_(source), path_("cams[" + std::to_string(index) + "]"), cam_(cam), files_(files), loading_(loading) {}

  void Run() {
    if (!cam_.file.empty() && !ReadFile()) return;
    const cam::Built built = cam::Build(cam_);
    for (const cam::Finding& finding : built.errors) loading_.problems.push_back(ProblemOf(finding));
    for (const cam::Finding& finding : built.warnings) {
      loading_.warnings.push_back(ProblemOf({finding.path, "warning: " + finding.message}));
    }
  }

 private:
  bool ReadFile() {
    loading_.files = true;
    if (files_ == Files::kRefuse) {
      loading_.problems.push_back(source_.ProblemAt(path_ + ".file", NotOpened(cam_.file)));
      return false;
    }
    file_ = (std::filesystem::path(source_.file()).parent_path() / cam_.file).string();
    std::string why;
    const std::optional<std::string> text = takt::ReadFile(file_, kMaxYamlBytes + 1, why);
    if (!text || text->size() > kMaxYamlBytes) {
      if (text) why = "holds more than " + std::to_string(kMaxYamlBytes / 1'000'000) + " MB";
      loading_.problems.push_back(source_.ProblemAt(path_ + ".file", file_ + ": " + why));
      return false;
    }
    csv_ = cam::ReadCsv(*text, file_);
    for (Problem& problem : csv_.problems) loading_.problems.push_back(std::move(problem));
    cam_.points = csv_.points;
    cam_.file.clear();
    return csv_.problems.empty();
  }

  Problem ProblemOf(const cam::Finding& finding) const {
    if (file_.empty())
      return source_.ProblemAt(path_ + (finding.path.empty() ? "" : "." + finding.path), finding.message);
    return {file_, cam::PlaceInCsv(csv_, finding.path), path_, finding.message};
  }

  const SourceMap& source_;
  std::string path_;
  cam::CamParams& cam_;
  const Files files_;
  CamLoading& loading_;
  std::string file_;  // of points; empty: none
  cam::CsvPoints csv_;
};

}  // namespace

CamLoading LoadCams(const SourceMap& source, Machine& machine, Files files) {
  CamLoading loading;
  for (std::size_t i = 0; i < machine.cams.size(); ++i) CamLoader(source, i, machine.cams[i], files, loading).Run();
  return loading;
}

}  // namespace takt::engine
