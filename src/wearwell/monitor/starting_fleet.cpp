#include "wearwell/monitor/starting_fleet.h"

namespace wearwell::monitor {

FleetView StartingFleet::fleet() const {
  FleetView view;
  view.started_ms = started_ms_;
  return view;
}

std::vector<UnitView> StartingFleet::units(const std::string&, std::size_t, std::size_t,
                                           std::uint64_t* matching) const {
  if (matching) *matching = 0;
  return {};
}

std::optional<UnitDetail> StartingFleet::unit(const std::string&) const {
  return {};
}

std::optional<UnitView> StartingFleet::view(const std::string&) const {
  return {};
}

std::vector<MovedForecast> StartingFleet::moved(std::size_t, std::size_t,
                                                std::uint64_t* all) const {
  if (all) *all = 0;
  return {};
}

std::vector<std::string> StartingFleet::changed_since(std::uint64_t) const {
  return {};
}

std::string StartingFleet::starting() const {
  return "the monitor is starting: its states take in the stored readings. It accepts readings and "
         "events; ask again later for forecasts";
}

}  // namespace wearwell::monitor
