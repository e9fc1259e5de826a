#include "wearwell/monitor/current_fleet.h"

#include <utility>

namespace wearwell::monitor {

CurrentFleet::State CurrentFleet::state() const {
  const std::lock_guard lock(lock_);
  return state_;
}

void CurrentFleet::exchange(std::shared_ptr<const FleetReader> fleet) {
  std::shared_ptr<const FleetReader> old;  // destroyed, perhaps, outside the lock
  const std::lock_guard lock(lock_);
  state_.before += state_.fleet->version() + 1;
  old = std::exchange(state_.fleet, std::move(fleet));
}

FleetView CurrentFleet::fleet() const {
  return state().fleet->fleet();
}

std::vector<UnitView> CurrentFleet::units(const std::string& search, std::size_t offset,
                                          std::size_t count, std::uint64_t* matching) const {
  return state().fleet->units(search, offset, count, matching);
}

std::optional<UnitDetail> CurrentFleet::unit(const std::string& name) const {
  return state().fleet->unit(name);
}

std::optional<UnitView> CurrentFleet::view(const std::string& name) const {
  return state().fleet->view(name);
}

std::vector<MovedForecast> CurrentFleet::moved(std::size_t offset, std::size_t count,
                                               std::uint64_t* all) const {
  return state().fleet->moved(offset, count, all);
}

std::uint64_t CurrentFleet::version() const {
  const State now = state();
  return now.before + now.fleet->version();
}

std::vector<std::string> CurrentFleet::changed_since(std::uint64_t version) const {
  const State now = state();
  return now.fleet->changed_since(version > now.before ? version - now.before : 0);
}

}  // namespace wearwell::monitor
