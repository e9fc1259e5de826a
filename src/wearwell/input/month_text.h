#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wearwell {

/// A month of the calendar as its number since January of year 0: 2024-01, 2024-01-31, 01/2024,
/// 202401, Jan-24, January 2024, janv. 2024 (English, German, French and Spanish names). A year of
/// two digits is 1970 to 2069. Empty for any other text, such as 01/02/2024, which has two readings.
std::optional<int> month_in(std::string_view text);

/// "2024-01".
std::string month_text(int month);

}  // namespace wearwell
