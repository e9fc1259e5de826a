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
    {"base"},
    {"math", "netcdf", "http"},
    {"prob"},
    {"formula"},
    {"bayes"},
    {"latent"},
    {"infer", "regress"},
    {"physics"},
    {"predict"},
    {"input"},
    {"present"},
    {"study"},
    {"selection", "prognosis", "fleet"},
    {"plan", "in_service"},
    {"joint", "bearing", "clutch", "fatigue", "formula_model", "recurrence"},
    {"models", "monitor", "workbench"},
    {"cli"},
    {"embed"}};

std::size_t rank(const std::string& folder) {
  const auto at = std::find_if(order.begin(), order.end(),
                               [&](const auto& level) { return level.count(folder) > 0; });
  EXPECT_NE(at, order.end()) << "where in the order does " << folder << " stand?";
  return static_cast<std::size_t>(at - order.begin());
}

// Every folder with its path; a trade goes by its own name.
const std::map<std::string, fs::path>& folders() {
  static const auto found = [] {
    std::map<std::string, fs::path> paths;
    for (const fs::path& parent : {source, source / "models"}) {
      for (const auto& entry : fs::directory_iterator(parent)) {
        if (entry.is_directory()) paths[entry.path().filename().string()] = entry.path();
      }
    }
    return paths;
  }();
  return found;
}

// "wearwell/models/joint/archard.h" is of "joint", "wearwell/models/registry.h" of "models", and "wearwell/cli/clutch/..." of "cli".
std::string folder_of(const std::string& included) {
  const fs::path folder = fs::path(included).parent_path();
  const bool in_cli = included.starts_with("wearwell/cli/");
  return in_cli ? "cli" : folder.filename().string();
}

// What a folder's CMakeLists.txt names under USES, and what those use.
const std::set<std::string>& uses(const std::string& folder) {
  static std::map<std::string, std::set<std::string>> known;
  const auto [at, is_new] = known.try_emplace(folder);
  if (!is_new) return at->second;
  std::ifstream file(folders().at(folder) / "CMakeLists.txt");
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
    // Applications stand in folders of models, and are rooms of their own.
    if (folder.filename() == "models" && file.parent_path() != folder) continue;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
      if (!line.starts_with(start)) continue;
      found.emplace_back(file, line.substr(start.size(), line.rfind('"') - start.size()));
    }
  }
  return found;
}

TEST(IncludeOrder, FoldersUseOnlyWhatStandsBelowThem) {
  for (const auto& [folder, path] : folders()) {
    for (const std::string& used : uses(folder)) {
      EXPECT_LT(rank(used), rank(folder)) << folder << " uses " << used;
    }
  }
}

// A wrong include of a header-only library would link.
TEST(IncludeOrder, FilesIncludeOnlyWhatTheirFolderUses) {
  std::size_t all = 0;
  for (const auto& [folder, path] : folders()) {
    for (const auto& [file, included] : includes(path)) {
      ASSERT_TRUE(included.starts_with("wearwell/")) << file << " includes " << included;
      const std::string used = folder_of(included);
      EXPECT_TRUE(used == folder || uses(folder).count(used) > 0)
          << file << " includes " << included << ", but " << folder << " does not use " << used;
      ++all;
    }
  }
  EXPECT_GT(all, 100u);  // the reading itself works
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A source includes its own header before anything else, so that the header is compiled alone there.
TEST(Headers, ComeFirstInTheirSource) {
  int sources = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    fs::path header = entry.path();
    if (header.extension() != ".cpp" || !fs::exists(header.replace_extension(".h"))) continue;
    const std::string text = text_of(entry.path());
    const std::string own =
        "#include \"" + fs::relative(header, source.parent_path()).generic_string() + '"';
    EXPECT_EQ(text.find("#include"), text.find(own)) << entry.path();
    ++sources;
  }
  EXPECT_GT(sources, 100);
}

// What cmake/targets.cmake precompiles, a header would find without asking for it.
TEST(Headers, IncludeWhatIsPrecompiled) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> hidden = {
      {"<array>", {"std::array<"}},
      {"<chrono>", {"std::chrono::"}},
      {"<limits>", {"std::numeric_limits<"}},
      {"<mutex>", {"std::mutex", "std::scoped_lock", "std::unique_lock"}},
      {"<numbers>", {"std::numbers::"}},
      {"<numeric>", {"std::accumulate(", "std::iota("}},
      {"<set>", {"std::set<"}},
      {"<sstream>", {"stringstream"}},
      {"<stop_token>", {"std::stop_token"}},
      {"<unordered_map>", {"std::unordered_map<"}},
      {"<variant>", {"std::variant<", "std::get_if<", "std::visit("}},
      {"<filesystem>", {"std::filesystem::"}},
      {"<fstream>", {"std::ifstream", "std::ofstream"}},
      {"<functional>", {"std::function<"}},
      {"<map>", {"std::map<"}},
      {"<memory>", {"std::shared_ptr<", "std::unique_ptr<"}},
      {"<optional>", {"std::optional<"}},
      {"<span>", {"std::span<"}},
      {"<string>", {"std::string ", "std::string&", "std::string>"}},
      {"<vector>", {"std::vector<"}},
      {"<cmath>", {"std::exp(", "std::log(", "std::sqrt(", "std::isfinite("}},
      {"<algorithm>", {"std::sort(", "std::min(", "std::max(", "std::find("}},
      {"fmt/", {"fmt::format("}},
      {"nlohmann/", {"nlohmann::"}},
      {"Random123/", {"r123::"}},
      {"Eigen/", {"Eigen::"}}};
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    if (entry.path().extension() != ".h") continue;
    // A header that includes others of ours may lean on what they include for their own interface.
    const std::string text = text_of(entry.path());
    if (text.find("#include \"") != text.npos) continue;
    for (const auto& [header, names] : hidden) {
      for (const std::string& name : names) {
        if (text.find(name) == text.npos) continue;
        EXPECT_NE(text.find("#include <" + (header[0] == '<' ? header.substr(1) : header)),
                  text.npos)
            << entry.path() << " uses " << name << " without " << header;
      }
    }
  }
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

// One noun a file: longer ones say on a line of their own why they are one.
TEST(Architecture, LongFilesSayWhyTheyAreLong) {
  constexpr int longest = 350;
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    const auto lines = std::count(text.begin(), text.end(), '\n');
    if (lines <= longest) continue;
    EXPECT_NE(text.find("\n// Longer than others: "), text.npos)
        << entry.path() << " has " << lines << " lines";
  }
}

}  // namespace
