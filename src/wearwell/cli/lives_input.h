#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "wearwell/monitor/stored_units.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/next_reading.h"
#include "wearwell/study/model.h"

namespace CLI {
class App;
}

namespace wearwell {

/// The lives that a question rests on, with what they were read from: `lives` refers to it.
struct LivesInput {
  prognosis::KnownLives lives;
  std::shared_ptr<const prognosis::Tracker> tracker = {};  ///< of a result or a monitored fleet
  std::unique_ptr<monitor::Store> store = {};              ///< of a monitored fleet
  std::map<std::string, monitor::UnitRecord> stored = {};

  /// Units in their present state; `tracker` is null for a table of lives. Refers to this.
  prognosis::FollowedUnits followed() const;
};

/// Where lives come from.
struct LivesOptions {
  std::filesystem::path path;  ///< folder of a result, monitor's configuration, table of lives
  std::string point = {};      ///< --at: which life of [predict]
  std::filesystem::path in_service = {};  ///< --in-service: table of units and their ages
};

/// The options --at and --in-service.
void add_lives_options(CLI::App& command, LivesOptions& options);

/// Throws InputError, MachineError.
LivesInput read_lives(const LivesOptions& options, Models models);

}  // namespace wearwell
