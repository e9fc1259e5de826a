#include "wearwell/cli/monitored.h"

#include "wearwell/base/error.h"
#include "wearwell/cli/carried.h"
#include "wearwell/cli/followed_result.h"
#include "wearwell/monitor/monitor_run.h"
#include "wearwell/monitor/result_watch.h"

namespace wearwell {

namespace {

monitor::Population population_in(const std::filesystem::path& result, Models models) {
  // Before it is read: what is written meanwhile is newer.
  const std::int64_t written = monitor::written_ms(result);
  const prognosis::CarriedState state = read_carried(result);
  return {tracker_of(state, result, models), prognosis::fingerprint_of(state), state.trusted,
          written};
}

}  // namespace

monitor::Population MonitoredFleet::population() const {
  return {tracker, fingerprint, trusted, written_ms};
}

MonitoredFleet monitored_fleet(const std::filesystem::path& config, Models models) {
  const TomlReader root = monitor::read_config_file(config);
  MonitoredFleet fleet;
  fleet.result.folder = monitor::read_result_path(root);
  fleet.result.read = [folder = fleet.result.folder, models] {
    return population_in(folder, models);
  };
  monitor::Population population;
  try {
    population = fleet.result.read();
  } catch (const InputError& error) {
    monitor::refuse_result(root, error.what());
  }
  fleet.tracker = population.tracker;
  fleet.fingerprint = population.fingerprint;
  fleet.trusted = population.trusted;
  fleet.written_ms = population.written_ms;
  fleet.config = monitor::read_monitor_config(root, *fleet.tracker);
  return fleet;
}

std::unique_ptr<monitor::Store> store_to_read(const MonitoredFleet& fleet) {
  return monitor::open_store(fleet.config.store, fleet.config.folder,
                             monitor::store_columns(fleet.config, *fleet.tracker),
                             monitor::Access::read);
}

}  // namespace wearwell
