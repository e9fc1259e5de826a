#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace wearwell {

/// For options that are plain numbers: NaN and infinity lie in no range.
CLI::Validator number_between(double least, double most);

/// For options that are one of a few words; refuses others with the nearest. The help shows them as
/// "exact|nuts", which shells complete.
CLI::Validator one_of(const std::vector<std::string>& words);

/// For seeds: a whole number of 64 bits, where a larger one would be taken for the largest.
CLI::Validator seed_number();

}  // namespace wearwell
