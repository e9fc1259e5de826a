#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// A fit from which a monitor has forecast, as its store keeps it.
struct StoredFit {
  std::int64_t number = 0;      ///< in the order of use, from 1
  std::string population = {};  ///< SHA-1 of the fit
  std::int64_t since_ms = 0;    ///< Unix time from which forecasts come from it
  std::int64_t written_ms = 0;  ///< Unix time of its file state.bin
  bool trusted = true;
};

/// What a moved forecast says beside its unit, as JSON for a store and for the API. Numbers are in
/// the units of the study, which it names.
std::string content_of(const MovedForecast& moved);
/// Throws StoreError if the text is damaged.
MovedForecast moved_forecast(const std::string& unit, const std::string& content);

/// The forecasts of the units that both know, by the earlier fit and by the later one, the largest
/// relative change of the median remaining useful life first (`sort_by_change`).
std::vector<MovedForecast> moved_forecasts(const FleetReader& before, const FleetReader& after);

void sort_by_change(std::vector<MovedForecast>& moved);

/// "12 units; the median remaining useful life of 'M7' changes most, from 820 to 610 km", for a log.
std::string moved_text(const std::vector<MovedForecast>& moved);

/// The relative change of the median remaining useful life; infinite if one of the two never ends
/// or is not known, 0 if neither is known.
double change_of(const MovedForecast& moved);

}  // namespace wearwell::monitor
