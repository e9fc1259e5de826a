#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::fatigue {

/// A reading of a tracked part: the survived cycles, and its stress, in the columns of the study's
/// table; values that are the same for all are in the study's [conditions].
class PartReading {
 public:
  PartReading(const TomlReader& root, const SnData& data, MeanStress correction);

  const std::vector<prognosis::ReadingColumn>& columns() const { return columns_; }
  std::size_t axis() const { return 0; }

  /// Why this reading is invalid; empty if it is valid. `stress` is empty if the reading has none
  /// of its columns.
  std::string read(const std::vector<double>& numbers, double& cycles,
                   std::optional<Stress>& stress) const;

  /// The stress of every part, if [conditions] has all of it.
  const std::optional<Stress>& only() const { return only_; }

 private:
  std::string stress_of(const std::vector<double>& numbers, Stress& stress) const;
  std::optional<double> given(const std::string& name, const std::vector<double>& numbers) const;

  std::vector<prognosis::ReadingColumn> columns_;
  std::vector<std::pair<std::string, double>> constants_;  // SI
  std::optional<HelicalSpring> spring_;
  bool tension_ = false;  // for corrections that need the largest stress to be tensile
  std::optional<Stress> only_;
};

/// The quantities that may give the stress: "alternating_stress", ..., in the order in which they
/// are read.
const std::vector<std::string>& stress_names();

}  // namespace wearwell::fatigue
