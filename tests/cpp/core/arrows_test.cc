// The folders of cpp/takt form a list, and arrows point one way: a folder includes only those the build names as its
// dependencies.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

using Dependencies = std::map<std::string, std::set<std::string>>;

// From cpp/CMakeLists.txt: takt_folder(axis DEPENDS core trajectory ...).
Dependencies FromBuild() {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/cpp/CMakeLists.txt");
  const std::regex folder(R"(^takt_folder\((\w+)(?:[^)]*?DEPENDS((?: [a-z_]+)+))?.*)");
  const std::regex word(R"([a-z_]+)");
  Dependencies dependencies;
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, folder)) continue;
    const std::string names = match[2];
    dependencies[match[1]] = {std::sregex_token_iterator(names.begin(), names.end(), word),
                              std::sregex_token_iterator()};
  }
  return dependencies;
}

TEST(Arrows, PointOneWay) {
  const Dependencies dependencies = FromBuild();
  ASSERT_GE(dependencies.size(), 6u);
  const std::regex include(R"x(^#include "takt/(\w+)/.*)x");
  int seen = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(TAKT_SOURCE_DIR) + "/cpp/takt")) {
    if (!entry.is_regular_file()) continue;
    const std::string folder = entry.path().parent_path().filename();
    ASSERT_TRUE(dependencies.contains(folder)) << entry.path() << ": the build does not know this folder";
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      std::smatch match;
      if (!std::regex_match(line, match, include) || match[1] == folder) continue;
      if (match[1] == "msgs") {  // made from lcmtypes: the affair of one folder
        EXPECT_EQ(folder, "lcm") << entry.path();
        continue;
      }
      ++seen;
      EXPECT_TRUE(dependencies.at(folder).contains(match[1])) << entry.path() << ": " << line;
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
      const bool ready =
          std::all_of(uses.begin(), uses.end(), [&](const std::string& other) { return done.contains(other); });
      if (ready && done.insert(folder).second) progress = true;
    }
  }
  EXPECT_EQ(done.size(), dependencies.size());
}

}  // namespace
