#include "wearwell/study/heading_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/heading.h"

namespace wearwell {
namespace {

std::string plain_powers(std::string text) {
  for (const auto& [raised, plain] : {std::pair{"²", "^2"}, {"³", "^3"}, {"µ", "u"}, {"μ", "u"}}) {
    for (std::size_t at; (at = text.find(raised)) != text.npos;)
      text.replace(at, std::string_view(raised).size(), plain);
  }
  return text;
}

// Accented letters and their plain forms.
std::string without_accents(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 44> plain = {
      {{"ä", "ae"},     {"ö", "oe"},    {"ü", "ue"}, {"Ä", "Ae"}, {"Ö", "Oe"}, {"Ü", "Ue"},
       {"ß", "ss"},     {"à", "a"},     {"á", "a"},  {"â", "a"},  {"ã", "a"},  {"À", "A"},
       {"Á", "A"},      {"Â", "A"},     {"ç", "c"},  {"Ç", "C"},  {"è", "e"},  {"é", "e"},
       {"ê", "e"},      {"ë", "e"},     {"È", "E"},  {"É", "E"},  {"Ê", "E"},  {"ì", "i"},
       {"í", "i"},      {"î", "i"},     {"ï", "i"},  {"Í", "I"},  {"ñ", "n"},  {"Ñ", "N"},
       {"ò", "o"},      {"ó", "o"},     {"ô", "o"},  {"õ", "o"},  {"Ó", "O"},  {"ù", "u"},
       {"ú", "u"},      {"û", "u"},     {"Ú", "U"},  {"Ù", "U"},  {"œ", "oe"}, {"’", "'"},
       {"\u00a0", " "}, {"\u202f", " "}}};
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (static_cast<unsigned char>(text[i]) < 0x80) {
      result += text[i++];
      continue;
    }
    bool found = false;
    for (const auto& [accented, without] : plain) {
      if (!text.substr(i).starts_with(accented)) continue;
      result += without;
      i += accented.size();
      found = true;
      break;
    }
    if (!found) result += text[i++];
  }
  return result;
}

std::string stripped(std::string_view words) {
  return std::string(words.substr(1, words.size() < 2 ? 0 : words.size() - 2));
}

// "wearDepth" is two words; "kN" and "MPa" are not split.
bool begins_word(std::string_view text, std::size_t i) {
  const auto at = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  return i >= 2 && std::isupper(at(i)) && std::islower(at(i - 1)) && std::isalpha(at(i - 2));
}

// Words of letters and digits without accents, each between two blanks.
std::string cased_words(std::string_view text) {
  const std::string plain = without_accents(text);
  std::string words = " ";
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const auto u = static_cast<unsigned char>(plain[i]);
    if (std::isalnum(u) || u >= 0x80) {
      if (begins_word(plain, i)) words += ' ';
      words += plain[i];
    } else if (words.back() != ' ') {
      words += ' ';
    }
  }
  return words.back() == ' ' ? words : words + ' ';
}

std::string lower_case(std::string text) {
  for (char& each : text) each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  return text;
}

std::vector<std::string> words_in(const std::string& words) {
  std::istringstream parts(words);
  std::vector<std::string> all;
  for (std::string each; parts >> each;) all.push_back(each);
  return all;
}

// A prefix before a count: "k" or "K", as users write it, but of millions "M" alone; "m" is milli, or begins another word.
std::string multiple_of(const std::string& prefix) {
  if (prefix == "k" || prefix == "K") return "1e3 ";
  return prefix == "M" ? "1e6 " : "";
}

// Whether a word in lower case begins with the name of something counted; with `hours`, or with one that names a unit of time or of
// distance that has no prefix.
bool is_counting(const std::string& word, bool hours) {
  static constexpr std::string_view counts[] = {
      "cycle",     "stroke",       "closing", "revolution", "turns", "zykl",  "lastwechsel",
      "lastspiel", "schwingspiel", "schalt",  "umdrehung",  "hube",  "takte", "ciclo",
      "cicli",     "tours",        "vuelta",  "revolucion", "giri"};
  static constexpr std::string_view units[] = {"hour",  "stunde", "betriebsstunde", "heure",
                                               "horas", "miles",  "meilen"};
  const auto begins = [&](std::string_view each) { return word.starts_with(each); };
  return std::any_of(std::begin(counts), std::end(counts), begins) ||
         (hours && std::any_of(std::begin(units), std::end(units), begins));
}

}  // namespace

bool is_unit_of(const std::string& text, std::string_view si) {
  if (text.empty()) return false;
  if (si.empty()) return parse_unit(text).has_value();
  try {
    read_unit(text, si);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string bracketed(const std::string& heading) {
  const std::size_t close = heading.find_last_of("])");
  if (close == heading.npos) return "";
  const std::size_t open = heading.rfind(heading[close] == ']' ? '[' : '(', close);
  return open == heading.npos ? "" : bare_unit(heading.substr(open + 1, close - open - 1));
}

std::string stated_unit(const Column& column) {
  if (!column.unit.empty()) return bare_unit(column.unit);
  const Heading heading = read_heading(column.name, "");
  // After '_' a letter may be an index, and "min" may mean minimum.
  const bool index = heading.suffix && (heading.unit.size() < 2 || heading.unit == "min" ||
                                        heading.unit == "in" || heading.unit == "at");
  if (!heading.unit.empty() && !index) return plain_powers(heading.unit);
  const std::string brackets = plain_powers(bracketed(column.name));
  return is_unit_of_heading(brackets, "") ? brackets : "";
}

NameAndUnit name_and_unit(const Column& column, std::string_view si) {
  const std::string& heading = column.name;
  const std::size_t close = heading.find_last_of("])");
  const bool brackets = close != heading.npos && heading.find_first_of("[(") < close;
  Heading found = read_heading(heading, si);
  if (brackets && found.unit.empty()) found = read_heading(heading.substr(0, close + 1), si);
  found.unit = plain_powers(found.unit);
  if (found.certain && !is_unit_of(found.unit, si)) found.unit.clear();
  if (!column.unit.empty())
    found.unit = is_unit_of(plain_powers(bare_unit(column.unit)), si) ? bare_unit(column.unit) : "";
  if (found.unit.empty() && si == "K") {
    const Heading any = read_heading(heading, "");
    const std::string letter = column.unit.empty() ? any.unit : bare_unit(column.unit);
    if (letter == "C") return {any.name, "degC", true};
    if (letter == "F" || letter == "°F") return {any.name, "degF", letter == "F"};
  }
  if (brackets && found.unit.empty() && bracketed(heading) == found.name) found.name = heading;
  if (brackets || !found.unit.empty()) return {found.name, found.unit};
  for (std::size_t at = heading.find(' '); at != heading.npos && at > 0;
       at = heading.find(' ', at + 1)) {
    const std::string unit = plain_powers(heading.substr(at + 1));
    if (unit.find_first_not_of("0123456789") != unit.npos && !si.empty() && is_unit_of(unit, si))
      return {heading.substr(0, at), unit};
  }
  return {found.name, found.unit};
}

std::string with_multiple(const std::string& heading, const std::string& unit,
                          std::string_view word) {
  const std::string words = plain_words(heading);
  const bool has_own =
      !unit.empty() && std::isdigit(static_cast<unsigned char>(unit.front())) && unit != "1";
  const auto says = [&](std::initializer_list<const char*> any) {
    return std::any_of(any.begin(), any.end(), [&](const char* each) {
      return words.find(fmt::format(" {} ", each)) != words.npos;
    });
  };
  const std::string base = unit.empty() || unit == "1" ? "cycles" : unit;
  if (has_own) return unit;
  if (says({"million", "millions", "mio", "millionen", "millones", "milioni"}))
    return "1e6 " + base;
  if (says({"thousand", "thousands", "tsd", "tausend", "milliers", "miles de"}))
    return "1e3 " + base;
  // "cycles to failure" counts cycles; by its unit alone a column counts that.
  const std::vector<std::string> counted =
      words_in(plain_words(!word.empty() || unit == "1" ? word : std::string_view(unit)));
  const auto is_named = [&](const std::string& each) {
    return std::any_of(counted.begin(), counted.end(),
                       [&](const std::string& part) { return each.starts_with(part); }) ||
           (!unit.empty() && !counted.empty() && is_exactly(unit, each));
  };
  std::string before;
  for (const std::string& each : words_in(cased_words(heading))) {
    if (const std::string attached = multiple_of(each.substr(0, 1));
        !attached.empty() && is_counting(lower_case(each.substr(1)), each[0] != 'M'))
      return attached + base;
    if (is_named(lower_case(each))) {
      const std::string apart = multiple_of(before);
      if (!apart.empty() && (before != "M" || is_counting(lower_case(each), false)))
        return apart + base;
      const bool power = before.starts_with('1') && before.size() > 2 &&
                         before.find_first_not_of('0', 1) == before.npos;
      if (power) return fmt::format("1e{} {}", before.size() - 1, base);
      if (before.size() == 3 && before.starts_with("1e")) return before + " " + base;
    }
    before = each;
  }
  return unit;
}

std::string plain_words(std::string_view text) {
  return lower_case(cased_words(text));
}

bool is_called(const std::string& heading, std::string_view word) {
  constexpr std::size_t telling = 5;
  const std::string words = plain_words(heading), wanted = plain_words(word);
  const bool letter = wanted.size() == 3;
  if (letter) return words == wanted;
  if (words.find(wanted) != words.npos) return true;
  const std::string bare = stripped(wanted);
  return bare.size() >= telling && words.find(bare) != words.npos;
}

bool is_exactly(const std::string& heading, std::string_view word) {
  return plain_words(heading) == plain_words(word);
}

}  // namespace wearwell
