#pragma once

#include <filesystem>
#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/study/model.h"

namespace wearwell {

/// A result whose units can be followed one by one.
struct FollowedResult {
  std::unique_ptr<const prognosis::Tracker> tracker;
  bool trusted = true;
};

/// The tracker for units of a state read from `result`. Throws InputError that names it if single
/// units of its model cannot be followed.
std::unique_ptr<const prognosis::Tracker> tracker_of(const prognosis::CarriedState& state,
                                                     const std::filesystem::path& result,
                                                     Models models);

/// Reads RESULT/state.bin. Throws InputError if there is none, or if single units of its model
/// cannot be followed.
FollowedResult followed_result(const std::filesystem::path& result, Models models);

}  // namespace wearwell
