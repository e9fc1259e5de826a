#pragma once

#include <string>

#include "wearwell/models/ownlaw/own_law.h"

namespace wearwell::ownlaw {

/// Throws InputError, with what it is, where the scatter of a measured column has no C of ours, or readings are more than exact
/// numbers.
void refuse_law(const OwnLaw& law);

/// C99 of the slots of all measured columns, of the sum of their log densities, and of whether anything was measured.
void add_likelihood(const OwnLaw& law, std::string& functions, std::string& sum,
                    std::string& measured);

/// Where a measured column stands among the numbers of a row.
std::size_t measured_column(const OwnLaw& law, std::size_t m);

}  // namespace wearwell::ownlaw
