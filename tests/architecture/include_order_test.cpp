#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
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
  std::ifstream file(source / folder / "CMakeLists.txt");
  bool listing = false;
  for (std::string word; file >> word;) {
    const bool name = word.front() >= 'a' && word.front() <= 'z';
    if (listing && name) {
      const bool last = word.back() == ')';
      if (last) word.pop_back();
      const std::set<std::string>& below = uses(word);
      at->second.insert(word);
      at->second.insert(below.begin(), below.end());
      if (last) break;
    } else if (listing) {
      break;
    } else {
      listing = word == "USES";
    }
  }
  return at->second;
}

// The files that the files of `folder` include in quotes: (file, included).
std::vector<std::pair<fs::path, std::string>> includes(const fs::path& folder) {
  constexpr std::string_view start = "#include \"";
  std::vector<std::pair<fs::path, std::string>> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path& file = entry.path();
    if (file.extension() != ".h" && file.extension() != ".cpp") continue;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
      if (!line.starts_with(start)) continue;
      found.emplace_back(file, line.substr(start.size(), line.rfind('"') - start.size()));
    }
  }
  return found;
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
  for (const std::string& folder : folders()) {
    for (const auto& [file, included] : includes(source / folder)) {
      const auto parts = fs::path(included);
      auto part = parts.begin();
      ASSERT_EQ(part->string(), "wearwell") << file << " includes " << included;
      const std::string used = (++part)->string();
      EXPECT_TRUE(used == folder || uses(folder).count(used) > 0)
          << file << " includes " << included << ", but " << folder << " does not use " << used;
    }
  }
  EXPECT_GT(includes(source).size(), 100u);  // the reading itself works
}

// Two structs of one name in one namespace are one to the linker: whose destructor is called?
TEST(Architecture, NoTwoHeadersDefineTypesOfOneName) {
  std::map<std::string, fs::path> known;
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    if (entry.path().extension() != ".h") continue;
    std::ifstream stream(entry.path());
    std::string space;
    for (std::string line; std::getline(stream, line);) {
      std::istringstream words(line);
      std::string kind, name;
      words >> kind >> name;
      if (kind == "namespace") space = name;
      // Nested types are indented; a declaration alone ends with a semicolon.
      const bool type = line.starts_with("struct ") || line.starts_with("class ");
      if (!type || line.back() == ';') continue;
      const auto [at, is_new] = known.try_emplace(space + "::" + name, entry.path());
      EXPECT_TRUE(is_new) << at->first << " is defined in " << at->second << " and "
                          << entry.path();
    }
  }
  EXPECT_GT(known.size(), 50u);
}

}  // namespace
