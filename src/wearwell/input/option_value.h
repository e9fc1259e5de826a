#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell {

enum class Allowed { any, positive, not_negative };

/// A quantity given as an option, in SI. Throws InputError that begins with the option's name: no
/// number, another dimension, not allowed, or too large to be counted with.
double option_value(const std::string& option, const std::string& text, std::string_view si,
                    Allowed allowed = Allowed::any);

/// The value that an option's text means, in SI. Throws InputError that names both unless it is
/// finite and allowed.
double checked_option(const std::string& option, const std::string& text, double value,
                      Allowed allowed);

/// For options that are plain numbers: NaN and infinity lie in no range.
CLI::Validator number_between(double least, double most);

/// For options that are one of a few words; refuses others with the nearest. The help shows them as
/// "exact|nuts", which shells complete.
CLI::Validator one_of(const std::vector<std::string>& words);

/// For seeds: a whole number of 64 bits, where a larger one would be taken for the largest.
CLI::Validator seed_number();

}  // namespace wearwell
