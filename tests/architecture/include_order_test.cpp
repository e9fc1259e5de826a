#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path source = PROJECT_SOURCE_DIR "/src/wearwell";

// Each folder may include those before it, but none of its own line.
const std::vector<std::set<std::string>> order = {
    {"base"},    {"math"},
    {"table"},   {"prob"},
    {"bayes"},   {"infer", "regress"},
    {"physics"}, {"joint", "bearing", "clutch", "fatigue"},
    {"predict"}, {"report"},
    {"study"},   {"cli"}};

std::size_t rank(const std::string& folder) {
  const auto at = std::find_if(order.begin(), order.end(),
                               [&](const auto& level) { return level.count(folder) > 0; });
  EXPECT_NE(at, order.end()) << "where in the order does " << folder << " stand?";
  return static_cast<std::size_t>(at - order.begin());
}

std::string content(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> folders() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(source)) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  return names;
}

// What a folder's CMakeLists.txt names under USES, and what those use.
const std::set<std::string>& uses(const std::string& folder) {
  static std::map<std::string, std::set<std::string>> known;
  const auto [at, is_new] = known.try_emplace(folder);
  if (!is_new) return at->second;
  const std::string text = content(source / folder / "CMakeLists.txt");
  std::smatch list;
  if (std::regex_search(text, list, std::regex("USES\\s+([a-z_\\s]+)"))) {
    const std::string names = list[1];
    const std::regex word("[a-z_]+");
    for (std::sregex_iterator each(names.begin(), names.end(), word), end; each != end; ++each) {
      const std::set<std::string>& below = uses(each->str());
      at->second.insert(each->str());
      at->second.insert(below.begin(), below.end());
    }
  }
  return at->second;
}

TEST(IncludeOrder, FoldersUseOnlyWhatStandsBelowThem) {
  for (const std::string& folder : folders()) {
    for (const std::string& used : uses(folder)) {
      EXPECT_LT(rank(used), rank(folder)) << folder << " uses " << used;
    }
  }
}

// A wrong include of a header-only library would link.
TEST(IncludeOrder, FilesIncludeOnlyWhatTheirFolderUses) {
  const std::regex include("#include \"wearwell/([a-z_]+)/");
  int includes = 0;
  for (const std::string& folder : folders()) {
    for (const auto& entry : fs::recursive_directory_iterator(source / folder)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".h" && file.extension() != ".cpp") continue;
      const std::string text = content(file);
      for (std::sregex_iterator each(text.begin(), text.end(), include), end; each != end; ++each) {
        ++includes;
        const std::string used = (*each)[1];
        EXPECT_TRUE(used == folder || uses(folder).count(used) > 0)
            << file << " includes " << used << ", which " << folder << " does not use";
      }
    }
  }
  EXPECT_GT(includes, 100);  // the reading itself works
}

TEST(IncludeOrder, OwnFilesAreNamedInFull) {
  const std::regex local("#include \"(?!wearwell/)");
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    const fs::path& file = entry.path();
    if (file.extension() != ".h" && file.extension() != ".cpp") continue;
    EXPECT_FALSE(std::regex_search(content(file), local)) << file;
  }
}

}  // namespace
