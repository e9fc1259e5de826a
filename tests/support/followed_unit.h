#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/prognosis/tracker.h"

namespace wearwell {

/// A unit on line with all that it was given.
struct FollowedUnit {
  std::unique_ptr<prognosis::TrackedUnit> unit;
  std::vector<prognosis::Reading> taken;

  FollowedUnit(const prognosis::Tracker& tracker, const std::string& name)
      : unit(tracker.begin(name)) {}

  prognosis::UpdateResult update(const prognosis::Reading& reading) {
    const prognosis::UpdateResult result =
        unit->update(reading, [&](const std::function<void(const prognosis::Reading&)>& visit) {
          for (const prognosis::Reading& each : taken) visit(each);
        });
    if (result.counted) taken.push_back(reading);
    return result;
  }
  prognosis::UpdateResult update(const std::vector<double>& numbers,
                                 const std::vector<std::string>& labels = {}) {
    return update({numbers, labels});
  }
};

}  // namespace wearwell
