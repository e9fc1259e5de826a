#pragma once

#include <string>
#include <string_view>

namespace wearwell {

enum class Allowed { any, positive, not_negative };

/// A quantity given as an option, in SI. Throws InputError that begins with the option's name: not
/// a number, another dimension, not allowed, or too large.
double option_value(const std::string& option, const std::string& text, std::string_view si,
                    Allowed allowed = Allowed::any);

/// The value of an option's text, in SI. Throws InputError that names both unless it is finite and
/// allowed.
double checked_option(const std::string& option, const std::string& text, double value,
                      Allowed allowed);

}  // namespace wearwell
