#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "wearwell/monitor/reading_mapping.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// The population of a fit, which forecasts come from.
struct Population {
  std::shared_ptr<const prognosis::Tracker> tracker;
  std::string fingerprint;  ///< SHA-1
  bool trusted = true;
  std::int64_t written_ms = 0;  ///< Unix time of its file state.bin; 0: unknown
};

/// A folder of results, in which another fit may take the place of the present one.
struct ResultSource {
  std::filesystem::path folder;
  /// Reads it. Throws InputError.
  std::function<Population()> read;
};

/// Why forecasts of `now` cannot take the place of those of `present`: other columns, another
/// threshold, a result that is not trusted, a unit of `units` (those with stored readings) that it
/// refuses, or of which it has learned readings (`learned_units`). Empty if they can.
std::string misfit(const Population& present, const Population& now,
                   const std::vector<std::string>& units);

/// What the present population says to readings and events, while another one takes its place.
/// Any thread may ask.
class PopulationChecks {
 public:
  explicit PopulationChecks(std::shared_ptr<const prognosis::Tracker> tracker);
  void set(std::shared_ptr<const prognosis::Tracker> tracker);
  /// From now on the mapping asks these. They must outlive it.
  void bind(ReadingMapping& mapping) const;

 private:
  struct Present {
    std::shared_ptr<const prognosis::Tracker> tracker;
    ReadingMapping mapping;
  };
  std::shared_ptr<const Present> present() const;

  mutable std::mutex lock_;
  std::shared_ptr<const Present> present_;
};

}  // namespace wearwell::monitor
