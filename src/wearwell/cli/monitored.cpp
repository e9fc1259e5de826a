#include "wearwell/cli/monitored.h"

#include "wearwell/cli/carried.h"
#include "wearwell/cli/followed_result.h"
#include "wearwell/monitor/monitor_run.h"

namespace wearwell {

MonitoredFleet monitored_fleet(const std::filesystem::path& config, Models models) {
  const TomlReader root = TomlReader::parse_file(config);
  const std::filesystem::path result = monitor::read_result_path(root);
  const prognosis::CarriedState state = read_carried(result);
  MonitoredFleet fleet;
  fleet.tracker = tracker_of(state, result, models);
  fleet.fingerprint = prognosis::fingerprint_of(state);
  fleet.trusted = state.trusted;
  fleet.config = monitor::read_monitor_config(root, *fleet.tracker);
  return fleet;
}

std::unique_ptr<monitor::Store> store_to_read(const MonitoredFleet& fleet) {
  return monitor::open_store(fleet.config.store, fleet.config.folder,
                             monitor::store_columns(fleet.config, *fleet.tracker),
                             monitor::Access::read);
}

}  // namespace wearwell
