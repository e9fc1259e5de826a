#include "wearwell/cli/monitor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/same_file.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/monitored.h"
#include "wearwell/http/tls.h"
#include "wearwell/monitor/backup.h"
#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/export_lives.h"
#include "wearwell/monitor/export_readings.h"
#include "wearwell/monitor/fleet_json.h"
#include "wearwell/monitor/fleet_text.h"
#include "wearwell/monitor/learned_readings.h"
#include "wearwell/monitor/monitor_run.h"
#include "wearwell/monitor/monitor_signals.h"
#include "wearwell/monitor/retention.h"

namespace wearwell {
namespace {

struct MonitorCommand {
  std::filesystem::path config, exported, exported_lives, backup;
  monitor::MonitorOptions run;
  bool check = false, json = false, quiet = false;
};

void export_readings(const MonitoredFleet& read, const MonitorCommand& command) {
  refuse_overwriting({{"the configuration", command.config}}, {{"--export", command.exported}});
  const std::string ending = command.exported.extension().string();
  if (ending != ".parquet" && ending != ".csv")
    throw InputError(
        fmt::format("--export: {} must end in .parquet or .csv", command.exported.string()));
  const auto store = store_to_read(read);
  const monitor::DoubtedParts doubted = monitor::doubted_parts(*store, read.population());
  monitor::ExportCounts counts;
  write_file(command.exported,
             ending == ".csv"
                 ? monitor::readings_as_csv(*store, *read.tracker, doubted, counts)
                 : monitor::readings_as_parquet(*store, *read.tracker, doubted, counts));
  if (command.quiet) return;
  fmt::print("{} readings are in {}\n", counts.readings, command.exported.string());
  if (counts.doubted > 0)
    fmt::print(
        "{} of them are of {} unit{} in doubt (column doubt = 1): their readings do not follow the "
        "forecast. wearwell update refuses them: report what happened to the unit, or remove these "
        "rows; without the column it learns from all\n",
        counts.doubted, doubted.size(), doubted.size() == 1 ? "" : "s");
  const std::size_t units = store->removed().size();
  if (units > 0)
    fmt::print(
        "of {} unit{} parts that have long been out of service have their last reading alone "
        "(store.keep)\n",
        units, units == 1 ? "" : "s");
}

void export_lives(const MonitoredFleet& read, const MonitorCommand& command) {
  refuse_overwriting({{"the configuration", command.config}},
                     {{"--export-lives", command.exported_lives}});
  if (command.exported_lives.extension() != ".csv")
    throw InputError(
        fmt::format("--export-lives: {} must end in .csv", command.exported_lives.string()));
  const auto store = store_to_read(read);
  std::uint64_t count = 0;
  write_file(command.exported_lives, monitor::lives_as_csv(*store, *read.tracker, count));
  if (!command.quiet)
    fmt::print("the lives of {} parts are in {}\n", count, command.exported_lives.string());
}

void back_up(const MonitoredFleet& read, const MonitorCommand& command) {
  monitor::backup_store(read.config.store, read.config.folder,
                        monitor::store_columns(read.config, *read.tracker), command.backup);
  if (!command.quiet) fmt::print("a backup of the store is in {}\n", command.backup.string());
}

std::string in_json(const monitor::FleetReader& fleet) {
  nlohmann::ordered_json json = monitor::json_of(fleet.fleet());
  auto& units = json["list"] = nlohmann::ordered_json::array();
  constexpr std::size_t all = SIZE_MAX;
  for (const monitor::UnitView& each : fleet.units("", 0, all))
    units.push_back(monitor::json_of(each));
  return monitor::text_of(json);
}

void run_monitor(const MonitoredFleet& read, const MonitorCommand& command) {
  const auto started = [&](const monitor::FleetReader& fleet, const std::string& address) {
    if (command.quiet || command.json || command.run.once) return;
    fmt::print("monitoring {} units, {} readings stored{}\n", fleet.fleet().units,
               fleet.fleet().stored,
               address.empty() ? "" : fmt::format("; the page is {}", address));
    std::fflush(stdout);
  };
  const auto ended = [&](const monitor::FleetReader& fleet) {
    if (command.json) {
      fmt::print("{}\n", in_json(fleet));
    } else if (!command.quiet) {
      fmt::print("{}", monitor::fleet_text(fleet));
    }
  };
  try {
    monitor::run_monitor(read.config, read.population(), read.result, command.run, started, ended);
  } catch (const monitor::StoreError& error) {
    throw MachineError(error.what());
  }
}

/// A store as a start would open it; it may be missing, be of an earlier version, or be in use.
void check_store(const MonitoredFleet& read) {
  const std::string& url = read.config.store;
  monitor::check_place(url, read.config.folder);
  std::error_code ignored;
  if (!monitor::is_postgres(url) && !std::filesystem::exists(read.config.folder / url, ignored))
    return;
  std::unique_ptr<monitor::Store> store;
  try {
    store = monitor::open_store(url, read.config.folder,
                                monitor::store_columns(read.config, *read.tracker),
                                monitor::Access::copy);
  } catch (const monitor::NoStoreYet&) {
    if (monitor::is_postgres(url)) return;
    throw;
  }
  bool earlier = false;
  try {
    store_to_read(read);
  } catch (const InputError&) {
    earlier = true;
  }
  try {
    monitor::refuse_learned(*store, read.fingerprint, *read.tracker);
  } catch (const monitor::StoreError&) {
    if (!earlier) throw;  // versions that know of no fit: a start refuses nothing
  }
}

/// The store of a configuration in which something else is wrong.
void check_place_alone(const std::filesystem::path& config) {
  std::string url;
  try {
    url = monitor::read_store(monitor::read_config_file(config));
  } catch (const InputError&) {
    return;  // reported already
  }
  monitor::check_place(url, config.parent_path());
}

/// Reads the configuration as a start would, and what reading it does not show: the certificate and
/// its key, and the store. Throws all problems together.
MonitoredFleet checked_fleet(const std::filesystem::path& config, Models models) {
  monitor::Problems problems;
  std::vector<std::string> failures;  // of the machine
  const auto look = [&](const std::function<void()>& part) {
    try {
      problems.in(part);
    } catch (const monitor::StoreError& error) {
      failures.push_back(error.what());
    } catch (const MachineError& error) {
      failures.push_back(error.what());
    }
  };
  std::optional<MonitoredFleet> read;
  look([&] { read = monitored_fleet(config, models); });
  if (read) {
    look([&] {
      if (read->config.http) tls_of(*read->config.http);
    });
    look([&] { check_store(*read); });
  } else {
    look([&] { check_place_alone(config); });
  }
  if (problems.empty() && !failures.empty())
    throw MachineError(fmt::format("{}", fmt::join(failures, "; ")));
  for (const std::string& each : failures) problems.add(each);
  problems.finish();
  return *read;
}

/// What store.keep means for the store that is there; empty without it.
std::string retention_text(const MonitoredFleet& read) {
  if (!read.config.keep_s) return {};
  const auto in = [&](const char* unit) {
    return from_si(read_unit(unit, "s"), *read.config.keep_s);
  };
  const double years = in("year");
  const bool whole_years = years > 0.5 && std::abs(years - std::round(years)) < 1e-6;
  const double number = whole_years ? years : in("day");
  const std::string rule = fmt::format(
      "readings of parts that have been out of service for {:.6g} {}{} are removed, and forecasts "
      "as old",
      number, whole_years ? "year" : "day", std::abs(number - 1) < 1e-6 ? "" : "s");
  const std::string& url = read.config.store;
  std::error_code ignored;
  if (monitor::is_postgres(url) || !std::filesystem::exists(read.config.folder / url, ignored))
    return rule + "\n";
  try {
    const auto store = store_to_read(read);
    const std::string now =
        monitor::removed_text(monitor::count_old(*store, *read.tracker, *read.config.keep_s));
    return fmt::format("{}: now {}\n", rule, now.empty() ? "no readings" : now);
  } catch (const InputError&) {  // an earlier version, which knows of no removal
    return fmt::format("{}; the store is upgraded first\n", rule);
  }
}

bool runs(const MonitorCommand& command) {
  return !command.check && command.exported.empty() && command.exported_lives.empty() &&
         command.backup.empty();
}

void run(const MonitorCommand& command, Models models) {
  // A reload while the result is read is a reload, not the end.
  std::optional<monitor::HangupNote> note;
  if (runs(command)) note.emplace();
  const MonitoredFleet read = command.check ? checked_fleet(command.config, models)
                                            : monitored_fleet(command.config, models);
  if (command.check) {
    const std::size_t sources = read.config.sources.size();
    if (command.quiet) return;
    fmt::print("{} is valid: {} source{}, store {}\n", command.config.string(), sources,
               sources == 1 ? "" : "s", monitor::shown_store(read.config.store));
    fmt::print("{}", retention_text(read));
  } else if (!runs(command)) {
    try {
      if (!command.backup.empty()) back_up(read, command);
      if (!command.exported.empty()) export_readings(read, command);
      if (!command.exported_lives.empty()) export_lives(read, command);
    } catch (const monitor::StoreError& error) {
      throw MachineError(error.what());
    }
  } else {
    run_monitor(read, command);
  }
}

}  // namespace

void add_monitor_command(CLI::App& app, Models models, int& exit_code) {
  const auto command = std::make_shared<MonitorCommand>();
  CLI::App* monitor = app.add_subcommand(
      "monitor", "Monitor machines: wear, remaining useful life and risk of each");
  monitor->add_option("CONFIG", command->config, "Configuration (TOML, docs/reference/monitor.md)")
      ->required();
  CLI::Option* once = monitor->add_flag(
      "--once", command->run.once,
      "Process the files and standard input, print the fleet and end; no page, no topics");
  CLI::Option* check =
      monitor
          ->add_flag("--check", command->check,
                     "Check the configuration, report everything that is wrong or missing, and end")
          ->excludes(once);
  monitor
      ->add_option("--export", command->exported,
                   "Write all stored readings that count to this file (.parquet, .csv) and end; a "
                   "monitor may be running")
      ->type_name("FILE")
      ->excludes(once)
      ->excludes(check);
  monitor
      ->add_option(
          "--export-lives", command->exported_lives,
          "Write the use of each part at its failure, removal or last reading to this file "
          "(.csv) and end")
      ->type_name("FILE")
      ->excludes(once)
      ->excludes(check);
  monitor
      ->add_option("--backup", command->backup,
                   "Write the store as it is at one moment to this new file and end; a monitor may "
                   "be running (PostgreSQL: pg_dump)")
      ->type_name("FILE")
      ->excludes(once)
      ->excludes(check);
  monitor
      ->add_option("--threads", command->run.threads,
                   "Threads (default: all); results do not depend on the number")
      ->check(CLI::Range(1, 1024));
  CLI::Option* json = monitor->add_flag(
      "--json", command->json, "At the end print the fleet as one JSON object, and nothing else");
  monitor->add_flag("--quiet", command->quiet, "Print errors only")->excludes(json);
  monitor->footer(
      "Sources are standard input, folders of files, MQTT, Sparkplug B and HTTP POST. It ends on "
      "SIGINT or SIGTERM, and at the end of standard input if there is no other source. "
      "Acknowledged\n"
      "readings are stored and survive a kill. Another fit of the study that is written to the "
      "folder of the result takes the place of the present one (SIGHUP: look now).\n\n"
      "Examples:\n"
      "  wearwell monitor fleet.toml\n"
      "  wearwell monitor fleet.toml --once < readings.jsonl\n"
      "  wearwell monitor fleet.toml --export readings.parquet\n"
      "  wearwell monitor fleet.toml --export-lives lives.csv\n"
      "  wearwell monitor fleet.toml --backup fleet-2026-11-22.sqlite\n\n"
      "Exit codes: 0 ended as requested; 2 the configuration is wrong, nothing was started; 3 the "
      "machine failed.");
  monitor->callback([command, models, &exit_code] {
    run(*command, models);
    exit_code = 0;
  });
}

}  // namespace wearwell
