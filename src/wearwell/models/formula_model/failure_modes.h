#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/formula/program.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_data.h"

namespace wearwell::formula_model {

/// Failure modes as competing risks: each mode has a life of its own, independent of the others given the
/// parameters; a part fails at the earliest of them, by that mode (Meeker and Escobar 1998, ch. 15).
/// Data of this kind cannot test the independence (Tsiatis 1975, PNAS 72, 20-22).
struct FailureModes {
  std::string name;                ///< of their column in the study: "mode"
  std::vector<std::string> modes;  ///< in the order of their first occurrence
  /// By row of the table: the modes that may have ended this life, as bits in the order of `modes`; 0 for a run-out.
  std::vector<std::uint32_t> possible;

  static constexpr std::size_t most = 20;
};

/// Shorter words that can mean a run-out ("S") can also name a failure mode.
inline constexpr std::size_t shortest_runout_word = 4;

/// A failure whose probability involves the lives of several modes together: its mode is not known, or its
/// life is known to an interval only.
struct JointFailure {
  std::size_t row = 0;         ///< of the table
  std::uint32_t possible = 0;  ///< the modes that may have ended it
  double from = 0, until = 0;  ///< SI: failed after `from`, by `until`; equal for an exact life
};

/// Observations by mode. For one mode, failures by others are run-outs. A joint failure is here a run-out
/// at the beginning of its interval; the factor that this lacks is in `joint`.
struct ObservedModes {
  std::vector<Observed> of;  ///< of each mode
  std::vector<JointFailure> joint;
};

/// Reads [failure_modes] and its column. `all` are the lives of all rows. Throws InputError that names the
/// cell: a run-out with a mode, a cell that can mean a run-out or a mode, a table of a mode that no row has.
FailureModes read_failure_modes(const TomlReader& root, const FormulaData& data,
                                const Observed& all);

/// The names of the modes that have a table, in the order of the file.
std::vector<std::string> modes_with_tables(const TomlReader& failure_modes);

ObservedModes observed_by_mode(const FailureModes& modes, const Observed& all);

}  // namespace wearwell::formula_model
