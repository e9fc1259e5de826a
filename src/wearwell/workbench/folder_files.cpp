#include "wearwell/workbench/folder_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <system_error>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::workbench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 200, most_of_kind = 500;

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return c < 128 ? std::tolower(c) : c; });
  return text;
}

}  // namespace

fs::path path_in(const fs::path& folder, const std::string& name) {
  const bool plain = !name.empty() && name.size() <= longest_name && name.front() != '.' &&
                     name.find('/') == name.npos && valid_utf8(name) == name &&
                     printable(name) == name;
  if (!plain)
    throw InputError(
        fmt::format("\"{}\" is not a name of a file in {}: no slashes, no dot at its beginning, at "
                    "most {} bytes",
                    printable(shortened(name)), printable(folder.string()), longest_name));
  const fs::path path = folder / name;
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  if (error || real.parent_path() != fs::weakly_canonical(folder, error))
    throw InputError(
        fmt::format("{} leads out of {}", printable(name), printable(folder.string())));
  return path;
}

bool is_table_name(const fs::path& file) {
  static const std::set<std::string> tables = {".csv",  ".tsv",    ".txt",   ".dat",     ".asc",
                                               ".json", ".ndjson", ".jsonl", ".parquet", ".xlsx"};
  std::string extension = lower_case(file.extension().string());
  if (extension == ".gz") extension = lower_case(file.stem().extension().string());
  return tables.contains(extension);
}

bool is_study_name(const fs::path& file) {
  return lower_case(file.extension().string()) == ".toml";
}

std::string kind_of(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    return fs::is_regular_file(file / "summary.json", error) ? "result" : "";
  if (!fs::is_regular_file(file, error)) return "";
  if (is_study_name(file)) return "study";
  return is_table_name(file) ? "table" : "";
}

std::string stamp_of(const fs::path& file) {
  std::error_code no_size, no_time;
  const auto size = fs::file_size(file, no_size);
  const auto time = fs::last_write_time(file, no_time);
  if (no_size || no_time) return "";
  return fmt::format("{} {}", size, time.time_since_epoch().count());
}

nlohmann::ordered_json listed_files(const fs::path& folder) {
  std::map<std::string, std::vector<std::string>> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with('.') || printable(name) != name || valid_utf8(name) != name) continue;
    const std::string kind = kind_of(at->path());
    if (!kind.empty()) names[kind].push_back(name);
  }
  nlohmann::ordered_json json;
  for (const auto& [kind, key] : {std::pair{"table", "tables"}, std::pair{"study", "studies"},
                                  std::pair{"result", "results"}}) {
    std::vector<std::string>& all = names[kind];
    std::sort(all.begin(), all.end());
    if (all.size() > most_of_kind) all.resize(most_of_kind);
    json[key] = all;
  }
  return json;
}

}  // namespace wearwell::workbench
