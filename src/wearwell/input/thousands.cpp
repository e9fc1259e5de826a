#include "wearwell/input/thousands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/algorithm/string/erase.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <regex>
#include <vector>

namespace wearwell {
namespace {

constexpr std::size_t longest_number = 64;
constexpr const char* advice =
    "write numbers without marks for thousands and with a dot before decimals";

std::string without(std::string text, const std::string& mark) {
  boost::algorithm::erase_all(text, mark);
  return text;
}

}  // namespace

bool may_have_thousands_mark(std::string_view cell) {
  static const std::regex pattern(thousands_pattern);
  return cell.size() <= longest_number && std::regex_match(cell.begin(), cell.end(), pattern);
}

std::string two_readings(std::string_view cell) {
  std::string text = boost::algorithm::trim_copy(std::string(cell));
  std::string decimal = text;
  // "35.000" is 35, "1.250" is 1.25; "1.234.567" has the one reading only.
  if (std::count(decimal.begin(), decimal.end(), '.') == 1) {
    decimal.erase(decimal.find_last_not_of('0') + 1);
    if (decimal.back() == '.') decimal.pop_back();
  }
  return fmt::format("'{}' can mean {} or, with a mark for thousands, {}; {}", text, decimal,
                     without(text, "."),
                     "write it without the mark, or with one decimal more or less");
}

std::string not_a_number(std::string_view cell) {
  const std::string refused = fmt::format("'{}' is not a number", cell);
  if (cell.size() > longest_number) return refused;
  std::string text = boost::algorithm::trim_copy(std::string(cell));
  for (const char* space : {"\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89"})
    boost::algorithm::replace_all(text, space, " ");
  boost::algorithm::replace_all(text, "\xE2\x80\x99", "'");

  std::vector<std::string> readings;
  static const std::regex grouped(R"([+-]?[0-9]{1,3}(([,.' ])[0-9]{3})(\2[0-9]{3})*([.,][0-9]+)?)");
  static const std::regex comma(R"([+-]?[0-9]*,[0-9]+)");
  std::smatch parts;
  if (std::regex_match(text, parts, grouped) &&
      (!parts[4].matched || parts[4].str()[0] != parts[2].str()[0])) {
    std::string whole = without(text.substr(0, text.size() - parts[4].length()), parts[2].str());
    if (parts[4].matched) whole += "." + parts[4].str().substr(1);
    readings.push_back(whole);
  }
  if (std::regex_match(text, comma))
    readings.push_back(boost::algorithm::replace_all_copy(text, ",", "."));
  if (readings.empty()) return refused;
  return fmt::format("{}; it may mean {}: {}", refused, fmt::join(readings, " or "), advice);
}

}  // namespace wearwell
