#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace wearwell {

/// For numeric options: NaN and infinity lie in no range.
CLI::Validator number_between(double least, double most);

/// For options with a few choices; refuses others and names the nearest. The help shows them as
/// "exact|nuts", which shells complete.
CLI::Validator one_of(const std::vector<std::string>& words);

/// For seeds: a 64-bit whole number; larger ones are refused, not clipped.
CLI::Validator seed_number();

}  // namespace wearwell
