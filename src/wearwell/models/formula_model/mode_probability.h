#pragma once

#include <cstdint>
#include <span>

#include "wearwell/prob/response.h"

namespace wearwell::formula_model {

/// The lives of the failure modes of one part, independent of each other.
struct ModeLives {
  std::span<const ResponseFamily> families;
  const double* family_parameters;  ///< `most_response_parameters` for each mode, SI
};

/// A log probability or log density with its derivatives by the parameters.
struct ModeTerm {
  double value = 0;
  double open = 0;  ///< its estimated error: the rule's, of an interval
};

/// log of the sum of the hazards of the `possible` modes (bits) at a life: what a failure of unknown mode
/// adds to the survival of all modes until then. `slope` has one entry for each of the lives' parameters; empty if
/// it is not wanted.
ModeTerm log_hazard(const ModeLives& lives, std::uint32_t possible, double life,
                    std::span<double> slope);

/// For each set of modes in `possible`: log probability that a part that has survived to `from` fails by `until` by
/// one of them. The probability of a failure by any mode has a closed form; the share of a set in it is a ratio of two integrals by
/// one rule, which is refined until it reproduces that closed form, and serves all sets. `slopes` has those of one set after
/// another; empty if they are not wanted.
void log_failures(const ModeLives& lives, std::span<const std::uint32_t> possible, double from,
                  double until, std::span<ModeTerm> terms, std::span<double> slopes);

}  // namespace wearwell::formula_model
