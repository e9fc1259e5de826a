#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// What may stand around a date in its cell.
constexpr std::string_view date_blanks = " \t";

/// Seconds since 1970-01-01 of a date in a layout of `strptime`: %Y, %y, %m, %d, %H, %M, %S and
/// literal characters. Empty if the text, `date_blanks` around it apart, is not a date of this layout. Years
/// of two digits are 1969 to 2068, as in DuckDB.
std::optional<long long> date_in(std::string_view text, std::string_view layout);

/// The layouts in which most cells of a column of text are dates: none if that is less than half of
/// those that are not empty, two or more if day and month can be exchanged.
std::vector<std::string> date_layouts(const Column& column);

/// "columns 'start', 'end' are dates", or empty where no column is.
std::string columns_of_dates(const Table& table);

/// "%d.%m.%Y" -> "day.month.year".
std::string layout_words(std::string layout);

/// Whether a layout states a time of the day.
bool has_time_of_day(std::string_view layout);

}  // namespace wearwell
