#pragma once

#include <memory>
#include <mutex>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// The fleet as its readers know it, while another one takes its place: versions go on, and all
/// units have changed then. Any thread may ask; the earlier fleet lives as long as it is read.
class CurrentFleet : public FleetReader {
 public:
  explicit CurrentFleet(std::shared_ptr<const FleetReader> fleet) : state_{std::move(fleet), 0} {}
  void exchange(std::shared_ptr<const FleetReader> fleet);

  FleetView fleet() const override;
  std::vector<UnitView> units(const std::string& search, std::size_t offset, std::size_t count,
                              std::uint64_t* matching = nullptr) const override;
  std::optional<UnitDetail> unit(const std::string& name) const override;
  std::optional<UnitView> view(const std::string& name) const override;
  std::vector<MovedForecast> moved(std::size_t offset, std::size_t count,
                                   std::uint64_t* all = nullptr) const override;
  std::uint64_t version() const override;
  std::vector<std::string> changed_since(std::uint64_t version) const override;
  std::string starting() const override { return state().fleet->starting(); }
  std::shared_ptr<const FleetReader> present() const override { return state().fleet; }

 private:
  struct State {
    std::shared_ptr<const FleetReader> fleet;
    std::uint64_t before = 0;  ///< versions of the earlier fleets
  };
  State state() const;

  mutable std::mutex lock_;
  State state_;
};

}  // namespace wearwell::monitor
