#include "wearwell/cli/compare.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/saved_result.h"

namespace wearwell {
namespace {

struct CompareOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path page;
  bool json = false;
};

int run_compare(const CompareOptions& options) {
  if (!options.page.empty() && options.page.extension() != ".html") {
    throw InputError(fmt::format("-o {}: the page must be named FILE.html", options.page.string()));
  }
  std::vector<std::pair<std::string, SavedResult>> results;
  for (const auto& folder : options.folders) {
    results.emplace_back(folder.string(), read_saved_result(folder));
  }
  const Comparison comparison = compare(std::move(results));
  if (!options.page.empty()) write_file(options.page, comparison_page(comparison));
  if (options.json) {
    fmt::print("{}\n", printable_json(to_json(comparison).dump(2)));
  } else {
    fmt::print("{}", comparison_text(comparison));
    if (!options.page.empty()) fmt::print("The page is {}\n", options.page.string());
  }
  return std::all_of(comparison.studies.begin(), comparison.studies.end(),
                     [](const auto& each) { return each.result.header.trusted; })
             ? 0
             : 1;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* compare = app.add_subcommand(
      "compare", "Rank fitted studies of the same data by how well they predict");
  compare->add_option("DIR", options->folders, "Folders that `wearwell fit` wrote")
      ->required()
      ->expected(2, 100);
  compare->add_option(
      "-o,--output", options->page,
      "Page to write, FILE.html: the tables, and the posteriors of the parameters overlaid");
  compare->add_flag("--json", options->json, "Print one JSON object and nothing else");
  compare->footer(
      "Example:\n"
      "  wearwell compare goodman-results gerber-results -o comparison.html\n\n"
      "Studies of different data are shown but not ranked. Exit codes: 0 all studies are trusted; "
      "1 one is not; 2 a\n"
      "folder holds no result.");
  compare->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace wearwell
