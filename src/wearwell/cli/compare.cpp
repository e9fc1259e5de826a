#include "wearwell/cli/compare.h"

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/present/progress_line.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/family_ranking.h"
#include "wearwell/study/saved_result.h"

namespace wearwell {
namespace {

struct CompareOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path page;
  std::string families;
  bool ranked = false;  // --families stands, perhaps empty
  bool json = false;
};

FamilyRanking ranking_of(const CompareOptions& options, Models models) {
  const std::filesystem::path& study = options.folders.front();
  if (options.folders.size() != 1 || study.extension() != ".toml")
    throw InputError(
        fmt::format("--families: needs one study, FILE.toml, but got {}{}", study.string(),
                    options.folders.size() > 1 ? " and others"
                                               : "; from a table: wearwell new NAME --from TABLE"));
  ProgressLine line(isatty(STDERR_FILENO) ? stderr : nullptr);
  const Monitor monitor{.progress = [&](const Step& step) { line.show(step); }};
  return rank_families(source_of(study), options.families, models, monitor);
}

Comparison compare_folders(const CompareOptions& options) {
  if (options.folders.size() == 1)
    throw InputError(fmt::format(
        "{}: one result cannot be compared; name two or more, or a study with --families",
        options.folders.front().string()));
  std::vector<std::pair<std::string, SavedResult>> results;
  for (const auto& folder : options.folders)
    results.emplace_back(folder.string(), read_saved_result(folder));
  return compare(std::move(results));
}

int run_compare(const CompareOptions& options, Models models) {
  if (!options.page.empty() && options.page.extension() != ".html") {
    throw InputError(fmt::format("-o {}: the page must be named FILE.html", options.page.string()));
  }
  std::optional<FamilyRanking> ranking;
  if (options.ranked) ranking = ranking_of(options, models);
  const Comparison comparison = ranking ? ranking->comparison : compare_folders(options);
  if (!options.page.empty()) write_file(options.page, comparison_page(comparison));
  if (options.json) {
    fmt::print("{}\n",
               printable_json((ranking ? ranking_json(*ranking) : to_json(comparison)).dump(2)));
  } else {
    fmt::print("{}", ranking ? ranking_text(*ranking) : comparison_text(comparison));
    if (!options.page.empty()) fmt::print("The page is {}\n", options.page.string());
  }
  return std::all_of(comparison.studies.begin(), comparison.studies.end(),
                     [](const auto& each) { return each.result.header.trusted; })
             ? 0
             : 1;
}

}  // namespace

void add_compare_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* compare = app.add_subcommand(
      "compare", "Rank fitted studies of the same data by how well they predict");
  compare
      ->add_option("DIR", options->folders,
                   "Folders that `wearwell fit` wrote; or a study, with --families")
      ->required()
      ->expected(1, 100);
  const CLI::Option* const families =
      compare
          ->add_option("--families", options->families,
                       "Fit the study with each of these families of lives and rank them: "
                       "weibull,lognormal,... or all")
          ->type_name("NAMES");
  compare->add_option(
      "-o,--output", options->page,
      "Page to write, FILE.html: the tables, and the posteriors of the parameters overlaid");
  compare->add_flag("--json", options->json, "Print one JSON object and nothing else");
  compare->footer(
      "Examples:\n"
      "  wearwell compare goodman-results gerber-results -o comparison.html\n"
      "  wearwell compare study.toml --families weibull,lognormal\n\n"
      "Studies of different data are shown but not ranked. Exit codes: 0 all studies are trusted; "
      "1 one is not; 2 a\n"
      "folder holds no result, or --families cannot rank the study.");
  compare->callback([options, families, models, &exit_code] {
    options->ranked = families->count() > 0;
    exit_code = run_compare(*options, models);
  });
}

}  // namespace wearwell
