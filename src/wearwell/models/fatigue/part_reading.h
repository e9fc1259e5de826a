#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::fatigue {

/// What a reading of a part on line brings: the cycles that it has survived, and the stress under which it
/// runs, in the columns that the study's table has for it; what is the same for all stands in the study's [conditions].
class PartReading {
 public:
  PartReading(const TomlReader& root, const SnData& data, MeanStress correction);

  const std::vector<prognosis::ReadingColumn>& columns() const { return columns_; }
  std::size_t axis() const { return 0; }

  /// Why this is no reading; empty where it is one. `stress` has nothing where the reading brings none of its columns.
  std::string read(const std::vector<double>& numbers, double& cycles,
                   std::optional<Stress>& stress) const;

  /// The stress of every part, where [conditions] has all of it.
  const std::optional<Stress>& only() const { return only_; }

 private:
  std::string stress_of(const std::vector<double>& numbers, Stress& stress) const;
  std::optional<double> given(const std::string& name, const std::vector<double>& numbers) const;

  std::vector<prognosis::ReadingColumn> columns_;
  std::vector<std::pair<std::string, double>> constants_;  // SI
  std::optional<HelicalSpring> spring_;
  bool tension_ = false;  // the largest stress has to be one
  std::optional<Stress> only_;
};

/// What may stand for the stress: "alternating_stress", ..., in the order in which they are read.
const std::vector<std::string>& stress_names();

}  // namespace wearwell::fatigue
