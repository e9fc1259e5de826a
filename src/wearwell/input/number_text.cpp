#include "wearwell/input/number_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/predicate.hpp>
#include <cstddef>
#include <vector>

namespace wearwell {
namespace {

constexpr std::size_t longest_number = 64;

/// A multi-byte character and its ASCII equivalent.
struct Stand {
  std::string_view bytes;
  char meant;
};
constexpr std::array<Stand, 6> stands = {{{"\xC2\xA0", ' '},        // no-break space
                                          {"\xE2\x80\xAF", ' '},    // narrow no-break space
                                          {"\xE2\x80\x89", ' '},    // thin space
                                          {"\xE2\x80\x87", ' '},    // figure space
                                          {"\xE2\x80\x99", '\''},   // typographic apostrophe
                                          {"\xE2\x88\x92", '-'}}};  // minus sign

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The cell in ASCII without surrounding blanks; empty if it has other characters.
std::optional<std::string> in_ascii(std::string_view cell) {
  std::string text;
  for (std::size_t i = 0; i < cell.size();) {
    if (static_cast<unsigned char>(cell[i]) < 0x80) {
      text += cell[i++];
      continue;
    }
    const auto stand = std::find_if(stands.begin(), stands.end(), [&](const Stand& each) {
      return cell.substr(i).starts_with(each.bytes);
    });
    if (stand == stands.end()) return {};
    text += stand->meant;
    i += stand->bytes.size();
  }
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  text.erase(0, static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_blank) -
                                         text.begin()));
  return text;
}

/// The digits of a number: groups separated by marks.
struct Groups {
  static constexpr std::size_t most = 24;
  std::size_t count = 0;  ///< of groups
  std::array<std::size_t, most> length{};
  std::array<char, most> mark{};  ///< mark[i] follows group i
  bool leading_zero = false, exponent = false;
};

bool is_word_of_numbers(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  return boost::algorithm::iequals(text, "nan") || boost::algorithm::iequals(text, "inf") ||
         boost::algorithm::iequals(text, "infinity");
}

std::optional<Groups> groups_of(std::string_view text) {
  std::size_t i = !text.empty() && (text[0] == '-' || text[0] == '+');
  Groups groups;
  groups.leading_zero = i < text.size() && text[i] == '0';
  bool any = false;
  for (;;) {
    std::size_t digits = 0;
    while (i < text.size() && is_digit(text[i])) ++i, ++digits;
    any = any || digits > 0;
    groups.length[groups.count] = digits;
    if (i == text.size()) break;
    const char c = text[i];
    if (c != '.' && c != ',' && c != '\'' && c != ' ') break;
    if (groups.count + 2 > Groups::most) return {};
    groups.mark[groups.count++] = c;
    ++i;
  }
  ++groups.count;
  if (!any) return {};
  if (i < text.size()) {
    if (text[i] != 'e' && text[i] != 'E') return {};
    groups.exponent = true;
    ++i;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
    if (i == text.size()) return {};
    if (!std::all_of(text.begin() + static_cast<std::ptrdiff_t>(i), text.end(), is_digit))
      return {};
  }
  return groups;
}

/// Whether the first `count` groups are groups of thousands: "1", "234", "567".
bool in_thousands(const Groups& groups, std::size_t count) {
  if (groups.length[0] < 1 || groups.length[0] > 3 || groups.leading_zero) return false;
  for (std::size_t i = 1; i < count; ++i) {
    if (groups.length[i] != 3 || groups.mark[i - 1] != groups.mark[0]) return false;
  }
  return true;
}

NumberForm form_of(std::string_view text) {
  if (text.empty()) return {NumberForm::Kind::empty};
  constexpr NumberForm none{NumberForm::Kind::text};
  if (text.size() > longest_number) return none;
  const auto groups = groups_of(text);
  if (!groups) return {is_word_of_numbers(text) ? NumberForm::Kind::number : none.kind};
  NumberForm form{NumberForm::Kind::number};
  if (groups->count == 1) return form;
  const char first = groups->mark[0], last = groups->mark[groups->count - 2];
  const bool may_be_decimal = last == '.' || last == ',';
  const bool all_thousands = !groups->exponent && in_thousands(*groups, groups->count);
  if (groups->count == 2) {
    if (all_thousands) {
      (may_be_decimal ? form.doubtful : form.thousands) = first;
    } else if (may_be_decimal) {
      form.decimal = last;
    } else {
      return none;
    }
    return form;
  }
  if (all_thousands) {
    form.thousands = first;
    return form;
  }
  if (!may_be_decimal || last == first || groups->exponent ||
      !in_thousands(*groups, groups->count - 1))
    return none;
  form.thousands = first;
  form.decimal = last;
  return form;
}

std::string shown_without(std::string text, char mark) {
  std::erase(text, mark);
  return text;
}

}  // namespace

NumberForm number_form(std::string_view cell) {
  // Most cells are numbers in C format and need no copy.
  bool simple = true;
  for (const char c : cell)
    simple = simple && static_cast<unsigned char>(c) < 0x80 && c != ' ' && c != '\t';
  if (simple) return form_of(cell);
  const auto text = in_ascii(cell);
  return text ? form_of(*text) : NumberForm{NumberForm::Kind::text};
}

std::optional<std::string> plain_number(std::string_view cell, const NumberMarks& marks) {
  const auto text = in_ascii(cell);
  if (!text) return {};
  NumberForm form = form_of(*text);
  if (form.kind != NumberForm::Kind::number) return {};
  if (form.doubtful)
    (form.doubtful == marks.decimal ? form.decimal : form.thousands) = form.doubtful;
  if (form.decimal && form.decimal != marks.decimal) return {};
  if (form.thousands && (form.thousands == marks.decimal ||
                         (marks.thousands != '*' && form.thousands != marks.thousands)))
    return {};
  std::string plain;
  for (const char c : *text) {
    if (c == form.thousands) continue;
    plain += c == form.decimal ? '.' : c;
  }
  if (plain.starts_with('+')) plain.erase(0, 1);
  return plain;
}

std::string mark_name(char mark) {
  switch (mark) {
    case '.':
      return "point";
    case ',':
      return "comma";
    case '\'':
      return "apostrophe";
    case ' ':
      return "blank";
    default:
      return fmt::format("'{}'", mark);
  }
}

std::string two_readings(std::string_view cell) {
  const std::string text = in_ascii(cell).value_or(std::string(cell));
  const char mark = text.find(',') == text.npos ? '.' : ',';
  std::string decimal = text;
  std::replace(decimal.begin(), decimal.end(), ',', '.');
  // "35.000" becomes 35 and "1.250" becomes 1.25; "1.234.567" is not ambiguous.
  if (std::count(decimal.begin(), decimal.end(), '.') == 1) {
    decimal.erase(decimal.find_last_not_of('0') + 1);
    if (decimal.back() == '.') decimal.pop_back();
  }
  return fmt::format("'{}' can mean {} or, with a thousands separator, {}; {}", text, decimal,
                     shown_without(text, mark),
                     "write it without the separator, or with one decimal more or less");
}

std::string not_a_number(std::string_view cell) {
  const std::string refused = fmt::format("'{}' is not a number", cell);
  std::vector<std::string> readings;
  for (const char decimal : {'.', ','}) {
    const auto plain = plain_number(cell, {decimal, '*'});
    if (plain && std::find(readings.begin(), readings.end(), *plain) == readings.end())
      readings.push_back(*plain);
  }
  if (readings.empty()) return refused;
  // The reading without the mark first.
  std::sort(readings.begin(), readings.end(),
            [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
  return fmt::format("{}; it may mean {}: {}", refused, fmt::join(readings, " or "),
                     "write numbers without thousands separators and with a decimal point");
}

}  // namespace wearwell
