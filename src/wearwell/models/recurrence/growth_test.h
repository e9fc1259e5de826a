#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/recurrence/process.h"

namespace wearwell::recurrence {

/// Whether and when a failure mode is fixed: modes A, BC and BD of MIL-HDBK-189C.
enum class FixClass { none, during, delayed };

/// A failure mode of a growth test.
struct FailureMode {
  std::string name;
  FixClass fix = FixClass::none;
  std::vector<double> ages = {};  ///< of its failures in all units [SI], ascending
  /// Of a delayed fix: the share of the mode's intensity that it removes, one number or equally probable quantiles of its
  /// distribution.
  std::vector<double> effectiveness = {};
  std::string stated = {};  ///< the effectiveness as the study states it: "0.7", "beta"

  double mean_effectiveness() const;
};

/// A test of units from age 0 to one common end, with all failure modes that were seen.
struct GrowthTest {
  std::size_t units = 1;
  double end = 0;  ///< [SI]
  std::vector<FailureMode> modes;

  double time() const { return static_cast<double>(units) * end; }  ///< of all units together
  std::vector<const FailureMode*> of(FixClass fix) const;
  std::size_t failures(FixClass fix) const;
  double mean_effectiveness() const;  ///< of the modes with a delayed fix
};

/// Reads [fixes]: the modes that are not fixed (none), fixed during the test (during), and fixed after it, each with its
/// effectiveness factor. Empty without [fixes]. Throws InputError for a mode without a class or with two, one that the data
/// lack, a factor outside 0 to 1, and for a test without one common end of observation by time.
std::optional<GrowthTest> read_growth_test(const TomlReader& root, const RecurrenceData& data,
                                           const Process& process);

}  // namespace wearwell::recurrence
