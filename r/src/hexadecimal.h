#pragma once

#include <string>

namespace wearwell::r {

/// Texts of R hold no zeros: bytes go over as hexadecimal digits.
std::string in_digits(const std::string& bytes);
std::string of_digits(const std::string& text);

}  // namespace wearwell::r
