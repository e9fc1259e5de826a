#include "wearwell/input/summary_words.h"

#include <algorithm>
#include <boost/algorithm/string/trim.hpp>
#include <set>

#include "wearwell/input/cell_text.h"
#include "wearwell/input/number_text.h"
#include "wearwell/input/status_words.h"

namespace wearwell {
namespace {

constexpr std::size_t longest_word = 30;

bool is_summary_word(std::string_view cell) {
  static const std::set<std::string, std::less<>> words = {
      "mean", "average", "avg", "sum", "total", "std", "stdev", "stddev", "sd", "standarddeviation",
      "min", "max", "minimum", "maximum", "median", "variance", "cv",
      // German
      "mittelwert", "mittel", "mw", "durchschnitt", "summe", "gesamt", "standardabweichung",
      "stabw", "standardabw", "varianz", "variationskoeffizient",
      // French
      "moyenne", "moy", "somme", "ecarttype", "mediane",
      // Spanish
      "media", "promedio", "suma", "desviacionestandar", "desviaciontipica", "desvest", "mediana"};
  if (cell == "\u00d8" || cell == "\u2300") return true;  // the symbol of a mean in German tables
  return words.contains(folded_word(cell));
}

}  // namespace

std::string summary_in(const std::vector<std::string_view>& cells, const TableSettings& settings) {
  if (settings.summary_rows == false) return {};
  const auto first =
      std::find_if(cells.begin(), cells.end(), [](std::string_view cell) { return !cell.empty(); });
  if (first == cells.end() || first->size() > longest_word) return {};
  const char begin = first->front();
  if ((begin >= '0' && begin <= '9') || begin == '-') return {};  // most rows
  const std::string word = boost::algorithm::trim_copy(std::string(*first));
  if (!is_summary_word(word)) return {};
  const bool has_number = std::any_of(first + 1, cells.end(), [](std::string_view cell) {
    return number_form(cell).kind == NumberForm::Kind::number || cell_text(cell);
  });
  return has_number ? word : std::string();
}

bool is_units_word(std::string_view cell) {
  static const std::set<std::string, std::less<>> words = {
      "unit", "units", "einheit", "einheiten", "unite", "unites", "unidad", "unidades"};
  return cell.size() <= longest_word && words.contains(folded_word(cell));
}

}  // namespace wearwell
