#include "wearwell/base/unit_hint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "wearwell/base/nearest.h"

namespace wearwell {
namespace {

constexpr std::size_t most_letters = 8;

// Common unit names of all dimensions in studies.
constexpr std::array common = {
    "m",    "cm",   "mm",      "um",      "nm",         "km",        "micron", "inch", "mil",
    "mils", "thou", "ft",      "N",       "kN",         "MN",        "kgf",    "lbf",  "Pa",
    "kPa",  "MPa",  "GPa",     "bar",     "psi",        "ksi",       "N/mm^2", "s",    "ms",
    "min",  "h",    "hours",   "days",    "minutes",    "seconds",   "years",  "J",    "kJ",
    "MJ",   "kWh",  "N m",     "Nm",      "kNm",        "m^3",       "cm^3",   "mm^3", "um^3",
    "l",    "ml",   "mm^2",    "m^2",     "m/s",        "mm/s",      "g",      "mg",   "kg",
    "rpm",  "Hz",   "rev/min", "rev/s",   "rad/s",      "K",         "degC",   "degF", "W",
    "kW",   "V",    "kV",      "A",       "deg",        "rad",       "cycles", "revs", "kcycles",
    "rev",  "turn", "strokes", "Mcycles", "mm^3/(N m)", "m^3/(N m)", "um/h",   "mm/h"};

bool has_dimension(const std::string& text, const std::optional<Dimension>& wanted) {
  const auto unit = parse_unit(text);
  return unit && unit->linear && (!wanted || unit->dimension == *wanted);
}

// The same letters in other case, fewest changes first: "MPa" and "mPa" for "mpa".
std::vector<std::string> other_capitals(const std::string& written, const Dimension& wanted) {
  std::vector<std::size_t> letters;
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (std::isalpha(static_cast<unsigned char>(written[i]))) letters.push_back(i);
  }
  if (letters.size() > most_letters) return {};
  std::vector<std::pair<int, std::string>> found;
  for (unsigned change = 1; change < 1U << letters.size(); ++change) {
    std::string candidate = written;
    for (std::size_t i = 0; i < letters.size(); ++i) {
      if (change >> i & 1U) candidate[letters[i]] = static_cast<char>(candidate[letters[i]] ^ 0x20);
    }
    if (has_dimension(candidate, wanted)) found.emplace_back(std::popcount(change), candidate);
  }
  std::sort(found.begin(), found.end());
  constexpr std::size_t most_shown = 2;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(found.size(), most_shown); ++i)
    names.push_back(found[i].second);
  return names;
}

// One edit in a name with the same beginning; short names are near to everything.
std::string near_common(const std::string& written, const std::optional<Dimension>& wanted) {
  const auto first = [](const std::string& text) {
    return std::tolower(static_cast<unsigned char>(text.front()));
  };
  std::vector<std::string> candidates;
  for (const std::string each : common) {
    const bool as_long = each.size() + 1 >= written.size();
    if (as_long && first(each) == first(written) && has_dimension(each, wanted))
      candidates.push_back(each);
  }
  return near_name(written, candidates).value_or("");
}

}  // namespace

std::string without_times(const std::string& written) {
  for (const std::string_view times : {"x", "X", "*", "\u00d7", "\u00b7"}) {
    if (!written.starts_with(times)) continue;
    const std::size_t at = written.find_first_not_of(' ', times.size());
    const bool number = at != written.npos && std::isdigit(static_cast<unsigned char>(written[at]));
    if (number) return written.substr(at);
  }
  return written;
}

std::string unit_hint(const std::string& written, const std::optional<Dimension>& wanted) {
  if (written.empty()) return "";
  std::vector<std::string> names;
  if (wanted) names = other_capitals(written, *wanted);
  const std::string factor = without_times(written);
  if (names.empty() && factor != written && has_dimension(factor, wanted)) names = {factor};
  const bool is_unit = parse_unit(written).has_value();
  if (names.empty() && !is_unit) names = {near_common(written, wanted)};
  if (names.empty() || names.front().empty()) return "";
  return fmt::format("; did you mean '{}'{}?", names.front(),
                     names.size() > 1 ? fmt::format(" or '{}'", names[1]) : "");
}

}  // namespace wearwell
