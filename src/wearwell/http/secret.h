#pragma once

#include <array>
#include <string>
#include <string_view>

namespace wearwell {

/// HMAC-SHA-256.
std::array<unsigned char, 32> hmac(std::string_view key, std::string_view text);

/// 128 random bits as 32 hexadecimal digits.
std::string random_token();

/// Compares texts in a time that does not depend on where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// The value of a cookie of `Cookie: a=1; b=2`; "" if it is not there.
std::string_view cookie_value(std::string_view field, std::string_view name);

}  // namespace wearwell
