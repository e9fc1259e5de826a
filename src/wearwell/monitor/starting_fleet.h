#pragma once

#include <string>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// What readers see until the states include the stored readings: no units, and the reason.
class StartingFleet : public FleetReader {
 public:
  explicit StartingFleet(std::int64_t started_ms) : started_ms_(started_ms) {}

  FleetView fleet() const override;
  std::vector<UnitView> units(const std::string& search, std::size_t offset, std::size_t count,
                              std::uint64_t* matching = nullptr) const override;
  std::optional<UnitDetail> unit(const std::string& name) const override;
  std::optional<UnitView> view(const std::string& name) const override;
  std::vector<MovedForecast> moved(std::size_t offset, std::size_t count,
                                   std::uint64_t* all = nullptr) const override;
  std::uint64_t version() const override { return 0; }
  std::vector<std::string> changed_since(std::uint64_t version) const override;
  std::string starting() const override;

 private:
  std::int64_t started_ms_;
};

}  // namespace wearwell::monitor
