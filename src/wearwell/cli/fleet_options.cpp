#include "wearwell/cli/fleet_options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/fleet/clickhouse_engine.h"
#include "wearwell/fleet/duckdb_engine.h"
#include "wearwell/fleet/postgres_engine.h"
#include "wearwell/present/progress_line.h"
#include "wearwell/study/result_writer.h"

namespace wearwell {
namespace {

void refuse_mixed(const FleetOptions& options, const std::string& name) {
  const bool duckdb = name == "duckdb";
  if (duckdb && options.engines.size() > 1)
    throw InputError("--engine duckdb does not combine with other engines; several databases do");
  if (duckdb && (options.files.empty() || !options.table.empty()))
    throw InputError("--engine duckdb reads files: give files and leave out --table");
  if (!duckdb && (!options.files.empty() || options.table.empty() || !options.state.empty()))
    throw InputError(
        "a database needs --table, and takes neither files nor --state: it stores its sums itself");
  if (options.read_only && !name.starts_with("postgres"))
    throw InputError(
        duckdb ? "--read-only is for databases; files are never changed, and sums are stored by "
                 "--state alone"
               : "--read-only works with PostgreSQL alone; in ClickHouse the user needs the right "
                 "to create tables");
}

}  // namespace

bool FleetOptions::has(const std::string& option) const {
  return std::find(given.begin(), given.end(), option) != given.end();
}

std::vector<std::unique_ptr<fleet::Engine>> engines_of(const FleetOptions& options,
                                                       const std::string& unit,
                                                       const std::filesystem::path& spill) {
  std::vector<std::unique_ptr<fleet::Engine>> engines;
  for (const std::string& name : options.engines) {
    refuse_mixed(options, name);
    if (name == "duckdb") {
      engines.push_back(fleet::duckdb_engine({.files = options.files,
                                              .unit = unit,
                                              .state = options.state,
                                              .spill = spill,
                                              .threads = options.threads,
                                              .memory = options.memory,
                                              .skip_bad = options.skip_bad,
                                              .progress = options.statements}));
    } else if (name.starts_with("postgresql://") || name.starts_with("postgres://")) {
      engines.push_back(fleet::postgres_engine(name, options.table, options.read_only));
    } else if (fleet::is_clickhouse(name)) {
      engines.push_back(fleet::clickhouse_engine(name, options.table));
    } else {
      throw InputError(fmt::format(
          "--engine: '{}' is unknown; use 'duckdb', 'postgresql://...' or 'clickhouse://...'",
          printable(shortened(name.substr(0, name.find("://"))))));
    }
  }
  return engines;
}

int show_fleet(const FleetOptions& options, ResultFolder& folder,
               const std::function<Result(const Monitor& monitor)>& find) {
  const Result result = [&] {
    ProgressLine line(!options.quiet && isatty(STDERR_FILENO) ? stderr : nullptr);
    return find(
        {.progress = [&](const Step& step) { line.show(step); }, .threads = options.threads});
  }();
  write_result(result, "", folder);
  if (options.json) {
    fmt::print("{}", summary_text(result));
  } else if (!options.quiet) {
    fmt::print("{}Results are in {}\n", terminal_text(result, terminal_style()),
               folder.path().string());
  }
  return result.header.trusted ? 0 : 1;
}

}  // namespace wearwell
