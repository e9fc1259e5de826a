#include "wearwell/workbench/comparison_view.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/study/comparison.h"
#include "wearwell/workbench/command_line.h"
#include "wearwell/workbench/folder_files.h"
#include "wearwell/workbench/python_line.h"

namespace wearwell::workbench {
namespace {

constexpr std::size_t most_results = 20;

Comparison comparison_of(const std::filesystem::path& folder,
                         const std::vector<std::string>& names) {
  if (names.size() < 2 || names.size() > most_results)
    throw InputError(
        fmt::format("{} results are chosen: choose 2 to {}", names.size(), most_results));
  std::set<std::string> known;
  std::vector<std::pair<std::string, SavedResult>> results;
  for (const std::string& each : names) {
    if (!known.insert(each).second)
      throw InputError(fmt::format("{} is chosen twice", printable(each)));
    results.emplace_back(each, read_saved_result(path_in(folder, each)));
  }
  return compare(std::move(results));
}

}  // namespace

nlohmann::ordered_json comparison_answer(const std::filesystem::path& folder,
                                         const std::vector<std::string>& names) {
  const Comparison comparison = comparison_of(folder, names);
  // Names of results stand in the answer, so the command is one of their folder.
  std::string command = fmt::format("cd {} && wearwell compare", quoted_word(folder.string()));
  std::string paths, quoted;
  for (const std::string& each : names) {
    command += " " + quoted_word(each.starts_with('-') ? "./" + each : each);
    paths += python_text(path_in(folder, each).string()) + ", ";
    quoted += (quoted.empty() ? "" : ", ") + python_text(each);
  }
  const std::string python =
      fmt::format("import wearwell as ww; print(ww.compare({}names=[{}]))", paths, quoted);
  return {{"text", comparison_text(comparison)},
          {"answer", to_json(comparison)},
          {"command", command},
          {"python", python}};
}

std::string comparison_page_of(const std::filesystem::path& folder,
                               const std::vector<std::string>& names) {
  return comparison_page(comparison_of(folder, names));
}

}  // namespace wearwell::workbench
