#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace wearwell {

/// A piece of printed text: a word, or a number with the size of one unit of its last printed digit.
struct PrintedToken {
  std::string text;
  std::optional<double> value;
  double last_digit = 0;
};

/// Words and numbers of a text. White space separates them and is left out: columns move with the width of a number. Groups of three
/// digits ("18 200", blank or narrow blank) are one number, as is one with its power of ten ("7.76 × 10^-4").
inline std::vector<PrintedToken> printed_tokens(const std::string& text) {
  // a group of digits is no number where it is a part of a word (sha1, Q4) or of a longer sequence
  static const std::regex number(
      "(\\d{1,3}(?:(?: "
      "|\u202f)\\d{3})+(?!\\d)|\\d+)(\\.\\d+)?(e[+-]?\\d+)?(?:\u00a0×\u00a010\\^(-?\\d+))?");
  static const std::regex word(R"([A-Za-z_][A-Za-z_0-9]*|[^\s\w])");
  std::vector<PrintedToken> tokens;
  for (auto at = text.cbegin(); at != text.cend();) {
    std::smatch found;
    if (std::isspace(static_cast<unsigned char>(*at))) {
      ++at;
    } else if (std::regex_search(at, text.cend(), found, number,
                                 std::regex_constants::match_continuous)) {
      std::string digits = found[1];
      std::erase_if(digits,
                    [](char c) { return std::isdigit(static_cast<unsigned char>(c)) == 0; });
      const std::string exponent = found[4].matched ? "e" + found[4].str() : found[3].str();
      const int places = found[2].matched ? static_cast<int>(found[2].length()) - 1 : 0;
      const int power = exponent.empty() ? 0 : std::atoi(exponent.c_str() + 1);
      tokens.push_back({found[0],
                        std::strtod((digits + found[2].str() + exponent).c_str(), nullptr),
                        std::pow(10.0, power - places)});
      at = found[0].second;
    } else if (std::regex_search(at, text.cend(), found, word,
                                 std::regex_constants::match_continuous)) {
      tokens.push_back({found[0], std::nullopt, 0});
      at = found[0].second;
    } else {
      tokens.push_back({std::string(1, *at++), std::nullopt, 0});
    }
  }
  return tokens;
}

/// Whether two printed texts say the same: words exactly, numbers to one unit of their last printed digit. Empty where they do, else
/// the first two tokens that differ.
inline std::string printed_difference(const std::string& printed, const std::string& expected) {
  const auto a = printed_tokens(printed), b = printed_tokens(expected);
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const std::string left = i < a.size() ? a[i].text : "(end)";
    const std::string right = i < b.size() ? b[i].text : "(end)";
    if (left == right) continue;
    if (i < a.size() && i < b.size() && a[i].value && b[i].value) {
      const double unit = std::max(a[i].last_digit, b[i].last_digit);
      if (std::abs(*a[i].value - *b[i].value) <= 1.001 * unit) continue;
    }
    return "printed \"" + left + "\" where \"" + right + "\" is documented";
  }
  return "";
}

}  // namespace wearwell
