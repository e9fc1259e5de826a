#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/bearing_data.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::bearing {

/// One inspection of a bearing.
struct ReadingRow {
  Duty duty;
  double depth = 0;             ///< m
  double place = 0;             ///< along the axis: revolutions, or s
  std::optional<double> speed;  ///< rev/s, where revolutions are speed x time
};

/// How readings become inspections: their columns are those of the study, the rest comes from
/// [conditions].
class ReadingRows {
 public:
  /// Throws InputError if no column has the use of a bearing.
  ReadingRows(const TomlReader& root, const BearingData& data, ObservationFamily family);

  const std::vector<prognosis::ReadingColumn>& columns() const { return columns_; }
  const std::vector<std::string>& labels() const { return labels_; }
  std::size_t axis() const { return axis_; }
  bool in_time() const { return in_time_; }  ///< whether the axis is time

  /// Why this is not an inspection; empty if it is one, which is then in `row`.
  std::string read(const prognosis::Reading& reading, ReadingRow& row) const;

 private:
  double value(const prognosis::Reading& reading, const std::string& name) const;

  ObservationFamily family_;
  std::vector<prognosis::ReadingColumn> columns_;
  std::vector<std::string> labels_;
  std::map<std::string, std::size_t> column_;
  std::map<std::string, double> constant_;  // SI
  std::optional<Contact> contact_;
  std::size_t axis_ = 0;
  bool in_time_ = false;
};

}  // namespace wearwell::bearing
