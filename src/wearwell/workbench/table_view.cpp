#include "wearwell/workbench/table_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/date_text.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/readable_cell.h"
#include "wearwell/input/source.h"
#include "wearwell/input/status_words.h"
#include "wearwell/prognosis/unit_table.h"
#include "wearwell/study/guessed_studies.h"
#include "wearwell/study/role_words.h"
#include "wearwell/workbench/folder_files.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t looked_at = 200, most_refused = 1000;

// Shown in the cell, so without its place.
std::string refusal_of(const Table& table, const Column& column, std::size_t row) {
  try {
    static_cast<void>(cell_value(table, column, row));
    return "";
  } catch (const InputError& error) {
    const std::string text = error.what(), before = place(table, column.name, row) + ": ";
    return text.starts_with(before) ? text.substr(before.size()) : text;
  }
}

// NaN where the cell has no value or is refused; `refusal` says why.
double number_in(const Table& table, const Column& column, std::size_t row, std::string* refusal) {
  if (column.is_number) return column.numbers[row];
  if (column.text[row].empty()) return std::numeric_limits<double>::quiet_NaN();
  if (const auto cell = readable_cell(table, column, row)) return cell->number;
  if (refusal) *refusal = refusal_of(table, column, row);
  return std::numeric_limits<double>::quiet_NaN();
}

// Whether a column of text is one of numbers in which some cells are not.
bool is_mostly_numbers(const Table& table, const Column& column) {
  if (column.is_number) return false;
  std::size_t seen = 0, numbers = 0;
  for (std::size_t row = 0; row < table.rows && seen < looked_at; ++row) {
    if (is_absent(column.text[row])) continue;
    ++seen;
    numbers += !std::isnan(number_in(table, column, row, nullptr));
  }
  return 2 * numbers > seen;
}

std::string unit_in(const Column& column) {
  return column.unit.empty() ? read_heading(column.name, "").unit : column.unit;
}

ordered_json column_json(const Table& table, const Column& column) {
  ordered_json json = {{"name", printable(column.name)}, {"unit", printable(unit_in(column))}};
  const bool mostly = is_mostly_numbers(table, column);
  json["kind"] = column.is_number ? "number" : "text";
  std::size_t empty = 0, refused = 0;
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (!column.is_number && (mostly ? is_absent(column.text[row]) : column.text[row].empty())) {
      ++empty;
      continue;
    }
    if (!column.is_number && !mostly) continue;
    if (refused >= most_refused) continue;  // a column of words, nearly
    const double value = number_in(table, column, row, nullptr);
    if (std::isnan(value)) {
      ++(column.is_number ? empty : refused);
    } else {
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
  }
  json["empty"] = empty;
  if (mostly) json["refused"] = refused;
  if (auto dates = date_layouts(column); !dates.empty()) json["dates"] = std::move(dates);
  if (!column.doubt.empty()) json["doubt"] = printable(column.doubt);
  if (least <= largest && refused < most_refused) {
    json["least"] = least;
    json["largest"] = largest;
  }
  return json;
}

const Column& column_at(const Table& table, std::size_t index) {
  if (index >= table.columns.size())
    throw InputError(fmt::format("column {}: the table has {}", index, table.columns.size()));
  return table.columns[index];
}

// Which label each row has: an index of `names`, or the one behind them for rarer labels.
struct Labels {
  std::vector<std::string> names;
  std::vector<std::size_t> of_row;  // empty without a column
};

// The index of each row's value among the different ones, in the order of their first rows.
struct Different {
  std::vector<std::size_t> of_row, first_row, count;

  template <class Value, class At>
  void read(std::size_t rows, const At& value_at) {
    std::unordered_map<Value, std::size_t> index;
    index.reserve(rows);
    of_row.reserve(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto [found, is_new] = index.try_emplace(value_at(row), first_row.size());
      if (is_new) {
        first_row.push_back(row);
        count.push_back(0);
      }
      ++count[found->second];
      of_row.push_back(found->second);
    }
  }
};

Different different_in(const Table& table, const Column& column) {
  Different found;
  // An empty cell is a value of its own: NaN is not equal to itself.
  if (column.is_number)
    found.read<std::uint64_t>(table.rows, [&](std::size_t row) {
      const double x = column.numbers[row];
      return std::bit_cast<std::uint64_t>(std::isnan(x) ? std::nan("") : x == 0 ? 0.0 : x);
    });
  else
    found.read<std::string_view>(
        table.rows, [&](std::size_t row) { return std::string_view(column.text[row]); });
  return found;
}

Labels labels_in(const Table& table, const Column* column) {
  constexpr std::size_t most = 8;
  Labels labels;
  if (!column) return labels;
  const Different different = different_in(table, *column);
  std::vector<std::size_t> chosen(different.count.size());
  std::iota(chosen.begin(), chosen.end(), 0);
  const auto kept = static_cast<std::ptrdiff_t>(std::min(most, chosen.size()));
  std::partial_sort(chosen.begin(), chosen.begin() + kept, chosen.end(),
                    [&](std::size_t a, std::size_t b) {
                      return std::pair(different.count[b], a) < std::pair(different.count[a], b);
                    });
  chosen.resize(static_cast<std::size_t>(kept));
  std::vector<std::pair<std::string, std::size_t>> named;
  for (const std::size_t each : chosen)
    named.emplace_back(prognosis::cell_text(column, different.first_row[each]), each);
  std::sort(named.begin(), named.end());
  std::vector<std::size_t> label(different.count.size(), named.size());
  for (const auto& [name, each] : named) {
    label[each] = labels.names.size();
    labels.names.push_back(name);
  }
  labels.of_row.reserve(different.of_row.size());
  for (const std::size_t each : different.of_row) labels.of_row.push_back(label[each]);
  return labels;
}

ordered_json labels_json(const Labels& labels) {
  ordered_json json = ordered_json::array();
  for (const std::string& each : labels.names)
    json.push_back({{"text", printable(shortened(each, 60))},
                    {"runout", censoring_by_word(each) == Censoring::right}});
  return json;
}

}  // namespace

OpenTable open_table(const std::filesystem::path& folder, const std::string& file,
                     const std::map<std::string, std::string>& settings) {
  const std::filesystem::path path = path_in(folder, file);
  std::map<std::string, std::string> of_file = settings;
  std::optional<std::string> sql;
  if (const auto query = of_file.extract("sql")) sql = query.mapped();
  const std::string text = data_lines(of_file, {});
  const TableSettings read =
      text.empty() ? TableSettings() : read_table_settings(TomlReader::parse({"[data]", text}));
  OpenTable open{file, settings, read_table(path, sql, {}, read)};
  if (!sql) open.wide = wide_table(open.table);
  if (open.wide)
    open.as_stored = std::exchange(open.table, read_table(path, open.wide->sql, {}, read));
  return open;
}

ordered_json table_json(const OpenTable& open) {
  ordered_json json = {{"file", open.file},
                       {"rows", open.table.rows},
                       {"layout", printable(open.table.layout.text)}};
  json["settings"] = open.settings;
  if (open.wide) {
    json["wide"] = printable(wide_description(*open.wide));
    json["sql"] = open.wide->sql;
    json["headings"] = ordered_json::array();
    for (const Column& each : open.as_stored.columns)
      json["headings"].push_back(printable(each.name));
  }
  json["columns"] = ordered_json::array();
  for (const Column& each : open.table.columns)
    json["columns"].push_back(column_json(open.table, each));
  json["roles"] = ordered_json::array();
  json["names"] = ordered_json::array();
  for (const RoleForm& each : role_forms()) {
    json["roles"].push_back(std::string(each.name));
    if (each.cells != Cells::numbers) json["names"].push_back(std::string(each.name));
  }
  return json;
}

ordered_json shown_table(const OpenTable& open) {
  ordered_json json = open.shown;
  json["number"] = open.number;
  return json;
}

ordered_json rows_json(const OpenTable& open, std::size_t from, std::size_t count,
                       std::size_t from_column, std::size_t columns) {
  const Table& table = open.table;
  const std::size_t last = std::min(table.rows, from + count);
  const std::size_t last_column = std::min(table.columns.size(), from_column + columns);
  std::set<std::size_t> mostly;
  for (std::size_t c = from_column; c < last_column; ++c) {
    if (is_mostly_numbers(table, table.columns[c])) mostly.insert(c);
  }
  ordered_json json = {{"from", from}, {"rows", ordered_json::array()}};
  for (std::size_t row = from; row < last; ++row) {
    ordered_json cells = ordered_json::array(), refused = ordered_json::object();
    for (std::size_t c = from_column; c < last_column; ++c) {
      const Column& column = table.columns[c];
      if (column.is_number) {
        const double value = column.numbers[row];
        if (std::isfinite(value)) {
          cells.push_back(value);
        } else if (std::isnan(value)) {
          cells.push_back(nullptr);
        } else {
          cells.push_back(value > 0 ? "inf" : "-inf");
        }
        continue;
      }
      cells.push_back(printable(shortened(column.text[row], 200)));
      std::string refusal;
      if (mostly.contains(c)) static_cast<void>(number_in(table, column, row, &refusal));
      if (!refusal.empty()) refused[std::to_string(c)] = printable(refusal);
    }
    ordered_json each = {{"row", row + 1}};
    if (!table.lines.empty()) each["line"] = table.lines[row];
    each["cells"] = std::move(cells);
    if (!refused.empty()) each["refused"] = std::move(refused);
    json["rows"].push_back(std::move(each));
  }
  return json;
}

ordered_json plot_json(const OpenTable& open, const PlotAxis& x, const PlotAxis& y,
                       std::optional<std::size_t> by) {
  constexpr std::size_t across = 160, up = 90;
  const Table& table = open.table;
  const PlotAxis* const axes[] = {&x, &y};
  std::vector<double> values[2];
  std::size_t empty = 0, not_positive = 0;
  std::vector<std::size_t> kept;
  for (int a : {0, 1}) {
    const Column* const column = axes[a]->column ? &column_at(table, *axes[a]->column) : nullptr;
    values[a].reserve(table.rows);
    for (std::size_t row = 0; row < table.rows; ++row)
      values[a].push_back(column ? number_in(table, *column, row, nullptr)
                                 : static_cast<double>(row + 1));
  }
  double low[2] = {std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  double high[2] = {-low[0], -low[0]};
  const auto placed = [&](int a, std::size_t row) {
    return axes[a]->log ? std::log10(values[a][row]) : values[a][row];
  };
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (!std::isfinite(values[0][row]) || !std::isfinite(values[1][row])) {
      ++empty;
    } else if ((x.log && !(values[0][row] > 0)) || (y.log && !(values[1][row] > 0))) {
      ++not_positive;
    } else {
      kept.push_back(row);
      for (int a : {0, 1}) {
        low[a] = std::min(low[a], placed(a, row));
        high[a] = std::max(high[a], placed(a, row));
      }
    }
  }
  const auto cell = [&](int a, std::size_t row, std::size_t cells) {
    // Halves, so that the width is finite.
    const double width = 0.5 * high[a] - 0.5 * low[a];
    const double part = width > 0 ? (0.5 * placed(a, row) - 0.5 * low[a]) / width : 0;
    return static_cast<std::size_t>(part * static_cast<double>(cells));
  };
  const Labels labels = labels_in(table, by ? &column_at(table, *by) : nullptr);
  ordered_json points = ordered_json::array();
  std::vector<bool> taken((labels.names.size() + 1) * (across + 1) * (up + 1));
  for (const std::size_t row : kept) {
    const std::size_t label = labels.of_row.empty() ? 0 : labels.of_row[row];
    const std::size_t place =
        (label * (across + 1) + cell(0, row, across)) * (up + 1) + cell(1, row, up);
    if (taken[place]) continue;
    taken[place] = true;
    points.push_back({values[0][row], values[1][row], row + 1});
    if (by) points.back().push_back(label);
  }
  ordered_json json = {{"rows", table.rows},
                       {"shown", points.size()},
                       {"kept", kept.size()},
                       {"left_out", {{"empty", empty}, {"not_positive", not_positive}}}};
  json["points"] = std::move(points);
  json["labels"] = labels_json(labels);
  return json;
}

}  // namespace wearwell::workbench
