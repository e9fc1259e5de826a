#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace wearwell::monitor {

/// "2026-11-22T15:04:05.25Z", "...+01:00": Unix time in milliseconds. Empty for another format,
/// without a zone, or outside the years 1970 to 2200.
std::optional<std::int64_t> unix_ms_of_iso(std::string_view text);

/// "2026-11-22T15:04:05.250Z".
std::string iso_of_unix_ms(std::int64_t ms);

/// Now, by the system clock, which may jump.
std::int64_t unix_ms_now();

inline constexpr std::int64_t latest_unix_ms = 7'258'118'400'000;  ///< the year 2200

}  // namespace wearwell::monitor
