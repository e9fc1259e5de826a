#include "wearwell/monitor/time_text.h"

#include <fmt/format.h>

#include <charconv>
#include <chrono>

namespace wearwell::monitor {
namespace {

using std::chrono::milliseconds;

/// Reads exactly this many digits from the front.
std::optional<int> digits(std::string_view& text, std::size_t count) {
  if (text.size() < count) return {};
  int value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (text[i] < '0' || text[i] > '9') return {};
    value = 10 * value + (text[i] - '0');
  }
  text.remove_prefix(count);
  return value;
}

bool skip(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == any_of.npos) return false;
  text.remove_prefix(1);
  return true;
}

/// Milliseconds of ".25"; finer digits are dropped.
int fraction(std::string_view& text) {
  int value = 0, scale = 100;
  for (; !text.empty() && text.front() >= '0' && text.front() <= '9'; text.remove_prefix(1)) {
    value += scale * (text.front() - '0');
    scale /= 10;
  }
  return value;
}

/// Minutes east of Greenwich.
std::optional<int> zone(std::string_view text) {
  if (text == "Z" || text == "z") return 0;
  if (text.empty()) return {};
  const int sign = text.front() == '-' ? -1 : 1;
  if (!skip(text, "+-")) return {};
  const auto hours = digits(text, 2);
  skip(text, ":");
  const auto minutes = digits(text, 2);
  if (!hours || !minutes || !text.empty() || *hours > 14 || *minutes > 59) return {};
  return sign * (60 * *hours + *minutes);
}

}  // namespace

std::optional<std::int64_t> unix_ms_of_iso(std::string_view text) {
  const auto year = digits(text, 4);
  if (!year || !skip(text, "-")) return {};
  const auto month = digits(text, 2);
  if (!month || !skip(text, "-")) return {};
  const auto day = digits(text, 2);
  if (!day || !skip(text, "Tt ")) return {};
  const auto hour = digits(text, 2);
  if (!hour || !skip(text, ":")) return {};
  const auto minute = digits(text, 2);
  if (!minute) return {};
  int second = 0, ms = 0;
  if (skip(text, ":")) {
    const auto read = digits(text, 2);
    if (!read) return {};
    second = *read;
    if (skip(text, ".,")) ms = fraction(text);
  }
  const auto east = zone(text);
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!east || !date.ok() || *hour > 23 || *minute > 59 || second > 60) return {};
  const std::int64_t days = std::chrono::sys_days{date}.time_since_epoch().count();
  const std::int64_t minutes = (days * 24 + *hour) * 60 + *minute - *east;
  const std::int64_t value = (minutes * 60 + second) * 1000 + ms;
  if (value < 0 || value > latest_unix_ms) return {};
  return value;
}

std::string iso_of_unix_ms(std::int64_t ms) {
  const auto time = std::chrono::sys_time<milliseconds>(milliseconds(ms));
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date{day};
  const std::int64_t rest = (time - day).count();
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     rest / 3'600'000, rest / 60'000 % 60, rest / 1000 % 60, rest % 1000);
}

std::int64_t unix_ms_now() {
  return std::chrono::duration_cast<milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace wearwell::monitor
