#pragma once

#include <string>
#include <string_view>

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

}  // namespace wearwell
