#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// "35.000" is 35 to three decimals, or 35000 with a mark for thousands. Only other cells can tell,
/// so these are regular expressions (of whole cells) for SQL and for C++ alike.
inline constexpr const char* thousands_pattern = R"([+-]?[1-9][0-9]{0,2}(\.[0-9]{3})+)";
/// A comma that can be nothing but a decimal mark: "12,5", "1.234,567".
inline constexpr const char* decimal_comma_pattern =
    R"([+-]?([0-9]+,([0-9]{1,2}|[0-9]{4,})|[0-9]{1,3}(\.[0-9]{3})+,[0-9]+))";

bool may_have_thousands_mark(std::string_view cell);

/// "'35.000' can mean 35 or, with a mark for thousands, 35000; ...": why a cell is refused.
std::string two_readings(std::string_view cell);

/// "'1,234' is not a number; it may mean 1234 or 1.234 ...", with what it may mean, if anything.
std::string not_a_number(std::string_view cell);

}  // namespace wearwell
