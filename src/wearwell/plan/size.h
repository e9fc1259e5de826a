#pragma once

#include <cstdint>
#include <string>

#include "wearwell/base/monitor.h"
#include "wearwell/input/table.h"
#include "wearwell/plan/answer.h"
#include "wearwell/plan/test_study.h"

namespace wearwell::plan {

/// How many specimens, before any test, as a user asks.
struct SizeQuestion {
  std::string goal;                ///< "B10 at hanger" (goal.h)
  std::string width;               ///< of its interval, at most: "factor 2" (upper / lower end), or
                                   ///< "30 um" (upper - lower end)
  std::string assurance = "80 %";  ///< probability that it is
  std::string level = "90 %";      ///< of the interval
  std::string measure = {};        ///< the measured column, if the study has several
  std::size_t most = 1000;         ///< specimens, the largest number tried
  std::size_t simulations = 200;   ///< campaigns
  std::uint64_t seed = 1;
};

/// The smallest number of specimens, allocated to the rows of `tests`, with which the goal's interval
/// is narrow enough with the assurance: parameters are drawn from the study's priors, campaigns are
/// simulated, and each is fitted by quadrature (Bayesian assurance: O'Hagan, Stevens and Campbell,
/// Pharmaceutical Statistics 4 (2005) 187; average over the prior predictive). `read` reads studies.
/// Throws InputError that begins with the option's name; Cancelled.
Answer size(const SizeQuestion& question, const Source& study, const Table& tests,
            const ReadStudy& read, const Monitor& monitor = {});

}  // namespace wearwell::plan
