#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "wearwell/monitor/stored_units.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/next_reading.h"
#include "wearwell/study/model.h"

namespace wearwell {

/// The lives that a question rests on, with what they were read from: `lives` refers to it.
struct LivesInput {
  prognosis::KnownLives lives;
  std::unique_ptr<const prognosis::Tracker> tracker = {};  ///< of a result or a monitored fleet
  std::unique_ptr<monitor::Store> store = {};              ///< of a monitored fleet
  std::map<std::string, monitor::UnitRecord> stored = {};

  /// Units in their present state; `tracker` is null for a table of lives. Refers to this.
  prognosis::FollowedUnits followed() const;
};

/// Reads the folder of a result, the configuration of a monitor (.toml), or a table of lives.
/// Throws InputError, MachineError.
LivesInput read_lives(const std::filesystem::path& path, Models models);

}  // namespace wearwell
