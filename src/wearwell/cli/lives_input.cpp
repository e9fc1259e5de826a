#include "wearwell/cli/lives_input.h"

#include <CLI/CLI.hpp>

#include "wearwell/base/error.h"
#include "wearwell/cli/carried.h"
#include "wearwell/cli/monitored.h"
#include "wearwell/input/table.h"
#include "wearwell/prognosis/result_lives.h"

namespace wearwell {
namespace {

// All readings of a unit that its state has processed; the store outlives it.
prognosis::History history_of(monitor::Store& store, const monitor::UnitRecord& record) {
  return monitor::counted_history(record, record.place, store);
}

bool in_service(const monitor::UnitRecord& record) {
  return record.events->part().service == monitor::Service::in_service;
}

// Units of a monitored fleet, as its store holds them.
void read_fleet(const std::filesystem::path& path, Models models, LivesInput& input) {
  MonitoredFleet fleet = monitored_fleet(path, models);
  try {
    input.store = store_to_read(fleet);
    input.stored = monitor::stored_units(*input.store, fleet.population());
  } catch (const monitor::StoreError& error) {
    throw MachineError(error.what());
  }
  input.lives = prognosis::lives_of_new(*fleet.tracker, path.string(), fleet.trusted);
  for (const auto& [name, record] : input.stored) {
    if (!in_service(record)) continue;
    // `stored` must stay alive as long as lives are requested.
    const std::shared_ptr<const prognosis::TrackedUnit> unit(std::shared_ptr<void>(),
                                                             record.state.get());
    input.lives.units.push_back(
        prognosis::known_unit(name, unit, history_of(*input.store, record)));
  }
  input.tracker = std::move(fleet.tracker);
}

}  // namespace

prognosis::FollowedUnits LivesInput::followed() const {
  if (!tracker) return {};
  prognosis::FollowedUnits units = prognosis::units_of_study(*tracker);
  if (!store) return units;
  units.source = "fleet";
  std::erase_if(units.names, [&](const std::string& name) { return stored.contains(name); });
  for (const auto& [name, record] : stored) {
    if (in_service(record)) units.names.push_back(name);
  }
  units.unit = [this, of_study = units.unit](const std::string& name) {
    const auto at = stored.find(name);
    return at == stored.end() ? of_study(name) : tracker->restore(at->second.state->save());
  };
  units.history = [this, of_study = units.history](const std::string& name) {
    const auto at = stored.find(name);
    return at == stored.end() ? of_study(name) : history_of(*store, at->second);
  };
  return units;
}

void add_lives_options(CLI::App& command, LivesOptions& options) {
  command.add_option("--at", options.point,
                     "Which life of [predict], for a study that measures lives: 'softer spring'");
  command.add_option(
      "--in-service", options.in_service,
      "Running units of such a study: table with columns unit, 'age [h]', and "
      "in_study (yes where the study's table has the unit as a run-out of this age)");
}

LivesInput read_lives(const LivesOptions& options, Models models) {
  LivesInput input;
  const std::filesystem::path& path = options.path;
  const bool is_result = std::filesystem::is_directory(path);
  if (!options.point.empty() && !is_result)
    throw InputError("--at: names a life of a study; only a folder of wearwell fit has one");
  if (path.extension() == ".toml") {
    if (!options.in_service.empty())
      throw InputError("--in-service: the running units of a monitor are those of its store");
    read_fleet(path, models, input);
    return input;
  }
  if (!is_result) {
    if (!options.in_service.empty())
      throw InputError("--in-service: a table of lives has its running units in rows with `unit`");
    input.lives = prognosis::lives_of_table(read_table(path));
    return input;
  }
  prognosis::ResultLives result =
      prognosis::lives_of_result(read_carried(path), models, path.string(), options.point);
  if (!options.in_service.empty())
    prognosis::add_units_in_service(result, read_table(options.in_service));
  input.tracker = std::move(result.tracker);
  input.lives = std::move(result.lives);
  return input;
}

}  // namespace wearwell
