#pragma once

#include <string>
#include <vector>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The headings of the bounds on the terminal, in order: "at least, 90 %"; of both "90 % from", "to".
std::vector<std::string> bound_headings(const std::string& level, BoundSides sides);

/// The same in the report: "At least, 90 % confidence".
std::vector<std::string> bound_columns(double level, BoundSides sides);

/// What they mean, below the table of a population's quantities. Of a share that fails, a lower bound is none to design with.
std::string bound_sentence(const std::vector<QuantitySummary>& quantities, const std::string& level,
                           BoundSides sides);

/// The first bounded quantity that is none of a population, whose bounds have a table of their own; null if
/// there is none.
const QuantitySummary* first_bounded(const std::vector<QuantitySummary>& quantities);

}  // namespace wearwell
