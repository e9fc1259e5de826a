#include "wearwell/cli/select.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <array>
#include <atomic>
#include <cstdio>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/selection/data.h"
#include "wearwell/selection/json.h"
#include "wearwell/selection/report.h"
#include "wearwell/selection/search_line.h"
#include "wearwell/selection/selection_header.h"
#include "wearwell/selection/text.h"
#include "wearwell/study/header_json.h"

namespace wearwell {
namespace {

// Up to this number of free terms, a report shows all models and every size is proven by default.
constexpr int few_terms = 20;

struct SelectOptions {
  SelectData data;
  std::string criterion = "loo";
  SelectionSettings settings;
  std::filesystem::path output;
  bool cloud = false, json = false, quiet = false, no_report = false;
};

std::atomic<bool> stop_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal handler may set it

/// While it lives, the first Ctrl-C stops the search; the second ends the program.
class StopOnInterrupt {
 public:
  StopOnInterrupt() {
    stop_asked = false;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      sigaction(signals[i], nullptr, &before_[i]);
      if (before_[i].sa_handler == SIG_IGN) continue;
      struct sigaction action = {};
      action.sa_handler = [](int) { stop_asked = true; };
      action.sa_flags = SA_RESETHAND;
      sigaction(signals[i], &action, nullptr);
    }
  }
  ~StopOnInterrupt() {
    for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before_[i], nullptr);
  }
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

 private:
  static constexpr std::array signals = {SIGINT, SIGTERM};
  std::array<struct sigaction, signals.size()> before_;
};

void write_folder(const std::filesystem::path& target, const SelectionResult& result,
                  const std::string& summary, bool report) {
  ResultFolder folder(target);
  folder.write("summary.json", summary);
  folder.write("models.csv", models_csv(result));
  if (report) folder.write("report.html", selection_report(result));
  folder.commit();
}

int run_select(const SelectOptions& options) {
  refuse_overwriting({{"the table", options.data.file}}, {{"--output", options.output}});
  SelectionResult result = read_selection(options.data);
  result.version = WEARWELL_VERSION;
  const std::vector<int> forced = result.settings.search.forced;
  result.settings = options.settings;
  SearchSettings& search = result.settings.search;
  search.forced = forced;
  search.criterion = read_criterion(options.criterion);
  const bool writes = !options.output.empty(), draws = writes && !options.no_report;
  const int free = static_cast<int>(result.design.terms.size() - forced.size());
  if (options.cloud || (draws && free <= few_terms)) search.cloud = CloudKind::bins;
  if (free <= few_terms) search.prove_sizes = true;
  if (writes) ResultFolder refused_early(options.output);

  {
    const StopOnInterrupt interrupt;
    SearchLine line(stderr, search.criterion);
    search.stop = &stop_asked;
    if (!options.quiet && isatty(STDERR_FILENO))
      search.progress = [&](const SearchProgress& progress) { line.show(progress); };
    result.selection =
        select_terms(result.design, result.observed, result.weights, result.settings);
    search.stop = nullptr;
    search.progress = nullptr;
  }

  const bool found = !result.selection.search.models.empty();
  nlohmann::ordered_json json = to_json(selection_header(result));
  json.update(to_json(result), true);
  const std::string summary = printable_json(json.dump(2)) + "\n";
  if (writes) write_folder(options.output, result, summary, draws && found);
  if (options.json) {
    fmt::print("{}", summary);
  } else if (!options.quiet) {
    fmt::print("{}", selection_text(result));
    if (writes)
      fmt::print("Results are in {}\n", std::filesystem::absolute(options.output).string());
  }
  return result.selection.search.certified ? 0 : 1;
}

CLI::Validator nested_parts() {
  return CLI::Validator(
      [](std::string& text) {
        const bool fits = CLI::Range(2, 1'000'000)(text).empty() || text == "0";
        return fits ? std::string() : "'" + text + "' must be 0 or 2 to 1000000";
      },
      "0 or 2 to 1000000");
}

void add_data_options(CLI::App* select, SelectData& data) {
  select->add_option("DATA", data.file, "Table: CSV, TSV, Parquet or JSON")->required();
  select->add_option("--sql", data.sql, "Query over the view `data`, instead of all its rows");
  select->add_option("--response", data.response, "Column to explain")->type_name("COLUMN");
  select->add_option("--inputs", data.inputs, "Columns whose products up to --degree are the terms")
      ->delimiter(',')
      ->type_name("A,B,C");
  select->add_option("--degree", data.degree, "Degree of the polynomial (default 1)")
      ->type_name("D");
  select
      ->add_option(
          "--terms", data.terms,
          "Terms, instead of --inputs: columns and products like A*A*B; the constant is added")
      ->delimiter(',')
      ->type_name("A,B,A*B");
  select->add_option("--force", data.forced, "Terms of every model; the constant is 1")
      ->delimiter(',')
      ->type_name("T,T");
  select->add_option("--weights", data.weights, "Column of weights: 1 / variance of a row")
      ->type_name("COLUMN");
}

void add_search_options(CLI::App* select, SelectOptions& options) {
  SearchSettings& search = options.settings.search;
  select
      ->add_option("--criterion", options.criterion,
                   "loo (PRESS, so R2p), aic, aicc, bic, cp or adjr2")
      ->capture_default_str()
      ->type_name("NAME");
  select->add_option("--keep", search.keep, "Number of best models")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  select
      ->add_option("--near", search.near,
                   "Also every model this near to the best: for loo relative (0.01: PRESS 1 % "
                   "above), else in units of the criterion")
      ->check(number_between(0, 1e9));
  select->add_flag(
      "--cloud", options.cloud,
      "Evaluate every model, for the report's figure of all models (up to 30 free terms)");
  select->add_flag("--prove-sizes", search.prove_sizes,
                   "Prove the best model of every size too (default for up to 20 free terms); may "
                   "take much longer");
  select
      ->add_option(
          "--folds", options.settings.folds,
          "k-fold cross-validation of the models found; a heuristic in addition to the criterion")
      ->check(CLI::Range(2, 1'000'000))
      ->type_name("K");
  select
      ->add_option(
          "--nested", options.settings.nested,
          "Number of folds of the nested cross-validation, which repeats the whole search without "
          "each fold to estimate the prediction error; 0: none (default: 10, up to 2000 rows)")
      ->check(nested_parts())
      ->type_name("K");
  select->add_option("--seed", options.settings.seed, "Seed of folds (default 1)")
      ->check(seed_number());
  select->add_option("--time", search.seconds, "Stop after this many seconds, proven or not")
      ->check(number_between(0, 1e9))
      ->type_name("S");
  select
      ->add_option("--threads", search.threads,
                   "Threads (default: all); results do not depend on the number")
      ->check(CLI::Range(1, 1024));
}

}  // namespace

void add_select_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SelectOptions>();
  CLI::App* select =
      app.add_subcommand("select", "Find the best subset of regression terms, proven optimal");
  add_data_options(select, options->data);
  add_search_options(select, *options);
  CLI::Option* json =
      select->add_flag("--json", options->json, "Print summary.json and nothing else");
  select->add_flag("--quiet", options->quiet, "Print nothing but errors")->excludes(json);
  select->add_option("-o,--output", options->output,
                     "Folder for summary.json, models.csv and report.html (default: none)");
  select->add_flag("--no-report", options->no_report, "Write no report.html");
  select->footer(
      "Examples:\n"
      "  wearwell select wear.csv --response w --inputs ds,Td,Mz --degree 3 -o selection\n"
      "  wearwell select wear.csv --response w --terms Td,Mz,Td*Mz --criterion bic --json\n\n"
      "Exit codes: 0 the best model, proven; 1 stopped by --time or Ctrl-C: the best found and the "
      "gap to the\n"
      "bound; 2 the request or the data is wrong, nothing written; 3 the machine failed.");
  select->callback([options, &exit_code] { exit_code = run_select(*options); });
}

}  // namespace wearwell
