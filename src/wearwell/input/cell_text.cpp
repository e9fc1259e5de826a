#include "wearwell/input/cell_text.h"

#include <algorithm>
#include <array>
#include <string>

#include "wearwell/base/trimmed.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/number_text.h"

namespace wearwell {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::string capitals(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 0x20) : c; });
  return result;
}

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view text) {
  return std::find(words.begin(), words.end(), capitals(text)) != words.end();
}

/// Removes a leading "<", ">=" or "≤" and returns its sign; 0 if there is none.
char take_sign(std::string_view& text) {
  constexpr std::array<std::pair<std::string_view, char>, 6> signs = {
      {{"<=", '<'}, {">=", '>'}, {"<", '<'}, {">", '>'}, {"\u2264", '<'}, {"\u2265", '>'}}};
  for (const auto& [written, sign] : signs) {
    if (!text.starts_with(written)) continue;
    text = trimmed(text.substr(written.size()));
    return sign;
  }
  return 0;
}

bool is_number(std::string_view text) {
  return number_form(text).kind == NumberForm::Kind::number;
}

/// Where a number ends and its unit begins: at a letter that is not an exponent, or at a unit
/// symbol.
std::size_t unit_begin(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool exponent =
        (c == 'e' || c == 'E') && i > 0 && i + 1 < text.size() &&
        std::string_view("0123456789+-").find(text[i + 1]) != std::string_view::npos;
    if (exponent) continue;
    const std::string_view rest = text.substr(i);
    if (is_letter(c) || c == '%' || rest.starts_with("\u00b0") || rest.starts_with("\u00b5") ||
        rest.starts_with("\u03bc") || rest.starts_with("\u2030"))
      return i;
  }
  return text.npos;
}

}  // namespace

std::optional<CellText> cell_text(std::string_view cell) {
  // Names of the limits of detection and quantification, in English, German and French.
  constexpr std::array<std::string_view, 9> limits = {"LOD", "LOQ", "LLOD", "LLOQ", "MDL",
                                                      "DL",  "BG",  "NWG",  "LD"};
  std::string_view text = trimmed(cell);
  CellText found;
  found.sign = take_sign(text);
  if (found.sign && is_number(text)) {
    found.number = text;
    return found;
  }
  if (found.sign == '<' && is_one_of(limits, text)) return found;
  const std::size_t at = unit_begin(text);
  if (at == text.npos || at == 0) return {};
  found.number = trimmed(text.substr(0, at));
  found.unit = text.substr(at);
  // "304L" is the name of a steel, so a unit of one letter needs a space before it.
  const bool apart = found.number.size() < at || found.unit.size() > 1 || found.unit == "%";
  if (!apart || !is_number(found.number) || !is_unit_cell(found.unit)) return {};
  return found;
}

bool is_blank(std::string_view cell) {
  return cell.find_first_not_of(" \t") == cell.npos;
}

bool is_missing_mark(std::string_view cell) {
  constexpr std::array<std::string_view, 18> marks = {
      "NA", "N/A", "N.A.", "#N/A", "#NV",     "#N/D",   "NULL",   "NONE",   "-",
      "--", "?",   ".",    "K.A.", "MISSING", "\u2013", "\u2014", "\u2026", "..."};
  return is_one_of(marks, trimmed(cell));
}

bool is_absent(std::string_view cell) {
  return is_blank(cell) || is_missing_mark(cell);
}

}  // namespace wearwell
