// The dependencies of the folders of cpp/takt are acyclic: a folder includes only those that the build names as its
// dependencies.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

namespace {

using Dependencies = std::map<std::string, std::set<std::string>>;

// From cpp/CMakeLists.txt: takt_folder(axis DEPENDS core trajectory LINK ...).
Dependencies FromBuild() {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/cpp/CMakeLists.txt");
  const std::string call = "takt_folder(";
  Dependencies dependencies;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(call)) continue;
    std::istringstream words(line.substr(call.size(), line.find(')') - call.size()));
    std::string folder, list;
    words >> folder;
    dependencies[folder];
    for (std::string word; words >> word;) {
      if (word == "DEPENDS" || word == "LINK" || word == "HEADERS") {
        list = word;
      } else if (list == "DEPENDS") {
        dependencies[folder].insert(word);
      }
    }
  }
  return dependencies;
}

// Returns "axis" for a line that includes takt/axis/...; empty for others.
std::string IncludedFolder(const std::string& line) {
  const std::string include = "#include \"takt/";
  if (!line.starts_with(include)) return "";
  return line.substr(include.size(), line.find('/', include.size()) - include.size());
}

TEST(Arrows, PointOneWay) {
  const Dependencies dependencies = FromBuild();
  ASSERT_GE(dependencies.size(), 6u);
  int seen = 0;
  const std::filesystem::path root = std::string(TAKT_SOURCE_DIR) + "/cpp/takt";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    const std::string folder = entry.path().lexically_relative(root).begin()->string();
    ASSERT_TRUE(dependencies.contains(folder)) << entry.path() << ": the build does not know this folder";
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const std::string other = IncludedFolder(line);
      if (other.empty() || other == folder) continue;
      if (other == "msgs") {  // generated from lcmtypes: only used by one folder
        EXPECT_EQ(folder, "lcm") << entry.path();
        continue;
      }
      ++seen;
      EXPECT_TRUE(dependencies.at(folder).contains(other)) << entry.path() << ": " << line;
    }
  }
  EXPECT_GT(seen, 50);
}

TEST(Arrows, MakeNoLoop) {
  const Dependencies dependencies = FromBuild();
  std::set<std::string> done;
  for (bool progress = true; progress && done.size() < dependencies.size();) {
    progress = false;
    for (const auto& [folder, uses] : dependencies) {
      const bool ready = std::ranges::all_of(uses, [&](const std::string& other) { return done.contains(other); });
      if (ready && done.insert(folder).second) progress = true;
    }
  }
  EXPECT_EQ(done.size(), dependencies.size());
}

}  // namespace
