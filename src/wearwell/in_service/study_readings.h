#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::in_service {

/// The readings that a study has of its units: in a table of a fleet they must not count again.
class StudyReadings {
 public:
  StudyReadings(const prognosis::Tracker& tracker, const Source& source);

  bool has(const std::string& unit) const { return units_.contains(unit); }
  enum class Place { beyond, same, unclear };
  /// Of a reading of a unit that the study has: beyond its readings there; one of them, to a relative
  /// 1e-9; or neither, so that it may be one of them with other digits.
  Place place(const std::string& unit, const prognosis::Reading& reading) const;
  double last(const std::string& unit) const { return units_.at(unit).last; }  ///< SI

 private:
  struct OfUnit {
    double last = 0;
    std::vector<prognosis::Reading> readings = {};
  };
  std::size_t axis_ = 0;
  std::map<std::string, OfUnit> units_;
};

}  // namespace wearwell::in_service
