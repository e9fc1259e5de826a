#include "wearwell/input/idle_status.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/input/status_words.h"

namespace wearwell {
namespace {

using Words = std::set<std::string>;

bool is_code(const std::string& word) {
  static const Words others = {"-1", "2", "3"};
  return truth_in(word) || others.contains(word);
}

bool is_word(const std::string& word) {
  return censoring_by_word(word).has_value();
}

bool is_failure(const std::string& word) {
  return censoring_by_word(word) == Censoring::none;
}

template <class Property>
bool all(const Words& words, const Property& property) {
  return std::all_of(words.begin(), words.end(), property);
}

// The distinct cells in lower case; empty if there are too many to be statuses.
std::optional<Words> kinds_in(const Column& column, std::size_t rows) {
  constexpr std::size_t most = 6;
  Words words;
  for (std::size_t i = 0; i < rows; ++i) {
    std::string word = cell_word(column, i);
    boost::algorithm::trim(word);
    boost::algorithm::to_lower(word);
    if (word.empty()) continue;
    words.insert(std::move(word));
    if (words.size() > most) return {};
  }
  if (words.empty()) return {};
  return words;
}

// Whether a heading contains a word for a status.
bool is_named_status(const std::string& heading) {
  if (failure_code_of(heading)) return true;
  const std::string letters = letters_of(heading);
  static const Words whole = {"status",   "state", "outcome",  "result", "ended",    "end",
                              "ergebnis", "etat",  "resultat", "estado", "resultado"};
  return whole.contains(letters) || letters.find("status") != letters.npos ||
         letters.find("cens") != letters.npos || letters.find("suspen") != letters.npos;
}

// Whether it marks every row as a failure, which is the default of the study.
bool says_failure_throughout(const Column& column, const Words& kinds) {
  if (kinds.size() != 1) return false;
  const std::string& word = *kinds.begin();
  if (is_failure(word)) return true;
  if (!is_code(word)) return false;
  // An unclear heading cannot mean that all lives are censored.
  const std::optional<int> code = failure_code_of(column.name);
  return !code || truth_in(word) == (*code == 1);
}

// Failure modes with a word for run-outs; a short word, such as S, can be a mode or anything else.
bool has_run_outs_among_modes(const Words& kinds) {
  constexpr std::size_t shortest = 4;
  return kinds.size() > 1 && std::any_of(kinds.begin(), kinds.end(), [](const std::string& each) {
           return each.size() >= shortest && censoring_by_word(each) == Censoring::right;
         });
}

bool looks_like_status(const Column& column, const Words& kinds, RowKind kind) {
  const bool codes = all(kinds, is_code), words = all(kinds, is_word);
  const bool truth_values = kinds.size() == 2 && truth_in(*kinds.begin()).has_value() &&
                            truth_in(*kinds.rbegin()) == !*truth_in(*kinds.begin());
  if (kind == RowKind::life && !words && has_run_outs_among_modes(kinds)) return true;
  if (is_named_status(column.name)) {
    return (codes || words) && !says_failure_throughout(column, kinds);
  }
  if (kind != RowKind::life) return false;
  const bool both_ends =
      words && kinds.size() > 1 && std::any_of(kinds.begin(), kinds.end(), is_failure);
  return truth_values || both_ends;
}

// Headings named by keys of [data.columns].
std::set<std::string> named_columns(const TomlReader& columns, const Table& table) {
  std::set<std::string> names;
  for (const std::string& key : columns.keys()) {
    std::optional<std::string> heading;
    if (columns.is_text(key)) {
      heading = columns.text(key);
    } else if (const auto choice = columns.table(key)) {
      heading = choice->text("column");
    }
    if (!heading) continue;
    try {
      names.insert(table.column(*heading).name);
    } catch (const InputError&) {  // its reader reports this error
    }
  }
  return names;
}

std::string bare(const Column& column) {
  const std::string name = column.name.substr(0, column.name.find_first_of("[("));
  return boost::algorithm::trim_copy(name);
}

std::string reading_as_status(const Column& column, const Words& kinds) {
  if (!all(kinds, is_code) && !all(kinds, is_word)) {
    return fmt::format("mode = \"{}\" and [failure_modes] column = \"mode\" in a formula study",
                       column.name);
  }
  if (!all(kinds, is_code)) {
    return fmt::format("status = \"{}\" (its words: failure, runout, left, interval, or F and S)",
                       column.name);
  }
  if (failure_code_of(column.name)) return fmt::format("status = \"{}\"", column.name);
  const auto truth = std::find_if(kinds.begin(), kinds.end(),
                                  [](const std::string& each) { return truth_in(each) == true; });
  return fmt::format(
      "status = {{ column = \"{}\", failure = 1 }} if {} is a failure, or failure = 0 if it is a "
      "runout",
      column.name, truth == kinds.end() ? "1" : *truth);
}

}  // namespace

void refuse_idle_status(const TomlReader& data, const Table& table, RowKind kind) {
  const std::vector<std::string> unused = data.texts("unused");
  const TomlReader columns = data.required_table("columns");
  const std::set<std::string> named = named_columns(columns, table);
  const std::string sql = data.text("sql").value_or("");
  for (const Column& column : table.columns) {
    if (named.contains(column.name)) continue;
    if (std::any_of(unused.begin(), unused.end(), [&](const std::string& each) {
          return each == column.name || each == bare(column);
        }))
      continue;
    if (!sql.empty() && boost::algorithm::icontains(sql, bare(column))) continue;
    const std::optional<Words> kinds = kinds_in(column, table.rows);
    if (!kinds || !looks_like_status(column, *kinds, kind)) continue;
    columns.fail("status",
                 fmt::format("is missing, and column '{}' of {} ({}) may state how each life "
                             "ended; without it all {} rows count as failures. If it states that, "
                             "write {}. If not, write unused = [\"{}\"] under [data]",
                             column.name, table.source, fmt::join(*kinds, ", "), table.rows,
                             reading_as_status(column, *kinds), column.name));
  }
}

}  // namespace wearwell
