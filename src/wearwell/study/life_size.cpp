#include "wearwell/study/life_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/status_words.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/study/column_values.h"

namespace wearwell {
namespace {

constexpr double usual_slope = 1.5;
constexpr double usual_log_sd = 2;

// The times of a column of lives; of ">5000", 5000.
struct Times {
  std::vector<double> at;
  std::vector<bool> open;
};

Times times_of(const Table& table, const Column& column) {
  Times times{numbers_of(table, column), std::vector<bool>(table.rows)};
  if (column.is_number || !has_open_ends(column)) return times;
  Column ends = column;
  for (std::size_t row = 0; row < table.rows; ++row) {
    std::string& cell = ends.text[row];
    for (const std::string_view mark : {">=", ">", "\u2265"}) {
      if (!cell.starts_with(mark)) continue;
      cell = cell.substr(mark.size());
      times.open[row] = true;
      break;
    }
  }
  times.at = numbers_of(table, ends);
  return times;
}

bool is_runout(const Table& table, const LifeHeadings& headings, std::size_t row) {
  check_stop();
  if (headings.status) {
    try {
      return seen_in(table, *headings.status, row) == Censoring::right;
    } catch (const InputError&) {
      return false;  // the reader of the study refuses it, and names the cell
    }
  }
  if (headings.mode.empty()) return false;
  const std::string word = cell_word(table.column(headings.mode), row);
  return word.empty() || contains(headings.runouts, word) ||
         censoring_by_word(word) == Censoring::right;
}

std::vector<double> optional_numbers(const Table& table, const std::string& heading,
                                     double otherwise) {
  if (heading.empty()) return std::vector<double>(table.rows, otherwise);
  std::vector<double> values = numbers_of(table, table.column(heading));
  for (double& each : values) {
    if (!std::isfinite(each) || each < 0) each = otherwise;
  }
  return values;
}

// When each row was last seen, and whether it ran then.
Times last_seen(const Table& table, const LifeHeadings& headings) {
  if (!headings.life.empty()) {
    Times times = times_of(table, table.column(headings.life));
    for (std::size_t row = 0; row < table.rows; ++row)
      times.open[row] = times.open[row] || is_runout(table, headings, row);
    return times;
  }
  const std::vector<double> lower = numbers_of(table, table.column(headings.lower)),
                            upper = numbers_of(table, table.column(headings.upper));
  Times times{lower, std::vector<bool>(table.rows)};
  for (std::size_t row = 0; row < table.rows; ++row) {
    times.open[row] = !std::isfinite(upper[row]) || is_runout(table, headings, row);
    if (!times.open[row])
      times.at[row] = ((std::isfinite(lower[row]) ? lower[row] : 0) + upper[row]) / 2;
  }
  return times;
}

double number_of_modes(const Table& table, const LifeHeadings& headings) {
  if (headings.mode.empty()) return 1;
  const std::vector<std::string> kinds = kinds_of(table, table.column(headings.mode));
  const auto modes = std::count_if(kinds.begin(), kinds.end(), [&](const std::string& word) {
    return !contains(headings.runouts, word) && censoring_by_word(word) != Censoring::right;
  });
  return std::max(1.0, static_cast<double>(modes));
}

}  // namespace

LifeHeadings life_headings(const std::string& lines, const Table& table) {
  const TomlReader columns = TomlReader::parse({"", lines});
  const auto heading = [&](const char* key) {
    if (!columns.has(key)) return std::string();
    const std::string name = columns.is_text(key)
                                 ? columns.required_text(key)
                                 : columns.required_table(key).required_text("column");
    return study_column(columns, key, name, table).name;
  };
  LifeHeadings found{heading("life"),  heading("lower"), heading("upper"),
                     heading("count"), heading("entry"), heading("mode")};
  try {
    found.status = read_life_status(columns, table);
  } catch (const InputError&) {  // the reader of the study refuses it, with its line
  }
  return found;
}

LifeSize life_size(const Table& table, const LifeHeadings& headings, double least,
                   const std::vector<std::size_t>& rows) {
  const Times seen = last_seen(table, headings);
  const std::vector<double> counts = optional_numbers(table, headings.count, 1),
                            entries = optional_numbers(table, headings.entry, 0);
  std::vector<std::size_t> used = rows;
  if (used.empty()) {
    used.resize(table.rows);
    std::iota(used.begin(), used.end(), std::size_t{0});
  }
  LifeSize size{least, usual_log_sd};
  double largest = 0, exposure = 0;
  for (const std::size_t row : used) {
    check_stop();
    if (!(seen.at[row] >= 0) || !std::isfinite(seen.at[row])) continue;
    largest = std::max(largest, seen.at[row]);
    exposure += counts[row] * std::max(0.0, std::pow(seen.at[row], usual_slope) -
                                                std::pow(entries[row], usual_slope));
    size.parts += counts[row];
    if (!seen.open[row]) size.failed += counts[row];
  }
  if (!(exposure > 0) || !std::isfinite(exposure)) return size;
  const double failed = std::max(1.0, size.failed / number_of_modes(table, headings));
  const double estimate = std::pow(exposure / failed, 1 / usual_slope);
  const double beyond = std::max(0.0, std::log(estimate / largest));
  if (estimate > largest) size.median = std::max(least, estimate);
  size.log_sd = std::round(2 * usual_log_sd * std::hypot(1, beyond)) / 2;
  return size;
}

LifeSize life_size_under(const Table& table, const LifeHeadings& headings, double least,
                         const std::vector<std::string>& stresses) {
  std::vector<std::size_t> rows(table.rows);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  for (const std::string& each : stresses) {
    const std::vector<double> levels = numbers_of(table, table.column(each));
    double harshest = -std::numeric_limits<double>::infinity();
    for (const double level : levels)
      if (level > harshest) harshest = level;
    std::erase_if(rows, [&](std::size_t row) { return levels[row] != harshest; });
  }
  if (!rows.empty() && !stresses.empty()) {
    const LifeSize harsh = life_size(table, headings, least, rows);
    if (harsh.failed > 0) return harsh;
  }
  return life_size(table, headings, least);
}

std::string words_of(const LifeSize& size) {
  constexpr double normal_95 = 1.6448536269514722;
  const double factor = std::exp(normal_95 * size.log_sd);
  const double place = std::pow(10.0, std::floor(std::log10(factor)) - 1);
  std::string words =
      fmt::format("a factor of {:.0f} to either side", std::round(factor / place) * place);
  if (size.failed == 0)
    words += "; none failed: the data have no upper end of a life, this prior has";
  else if (size.log_sd > usual_log_sd)
    words += fmt::format("; wide: {:.6g} of {:.6g} failed, most lives end beyond the test",
                         size.failed, size.parts);
  return words;
}

}  // namespace wearwell
