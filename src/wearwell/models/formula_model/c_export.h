#pragma once

#include <cstddef>
#include <string>

#include "wearwell/prognosis/carried_state.h"

namespace wearwell::formula_model {

/// What to export, and how.
struct CExportChoice {
  std::string name = "unit";  ///< prefix of files, types and functions: unit_begin, UNIT_NODES
  std::string unit =
      {};  ///< a unit of the study, whose nodes are built from its readings; empty: a new unit
  std::size_t lines = 0;  ///< points of the population's posterior; 0: as many as in the monitor
};

/// A unit of a population as C99 (docs/how-to/edge.md): NAME.h, NAME.c and a test with reference
/// numbers.
struct CExport {
  std::string header, source, test;
  std::size_t nodes = 0, lines = 0;
  double effective = 0;  ///< effective number of nodes at the start
  std::size_t table_bytes = 0, unit_bytes = 0, scratch_bytes = 0;  ///< if numbers have 8 bytes
};

/// Throws InputError if the formula or its scatter cannot be exported, or the study has no such
/// unit.
CExport c_export(const prognosis::CarriedState& state, const CExportChoice& choice,
                 const std::string& version);

}  // namespace wearwell::formula_model
