#pragma once

#include <cstddef>
#include <string>

#include "wearwell/prognosis/carried_state.h"

namespace wearwell::formula_model {

/// What is exported, and how.
struct CExportChoice {
  std::string name = "unit";  ///< of files, types and functions: unit_begin, UNIT_NODES
  std::string unit =
      {};  ///< of the study: its nodes are laid about what it showed; empty: a new one
  std::size_t lines = 0;  ///< points of the population's posterior; 0: as many as on line
};

/// A unit of a population as C99 (docs/how-to/edge.md): NAME.h, NAME.c and a test with numbers of our own.
struct CExport {
  std::string header, source, test;
  std::size_t nodes = 0, lines = 0;
  double effective = 0;  ///< nodes that carry the weight at the beginning
  std::size_t table_bytes = 0, unit_bytes = 0, scratch_bytes = 0;  ///< where numbers have 8 bytes
};

/// Throws InputError where the law or its scatter cannot be exported, or the study has no such unit.
CExport c_export(const prognosis::CarriedState& state, const CExportChoice& choice,
                 const std::string& version);

}  // namespace wearwell::formula_model
