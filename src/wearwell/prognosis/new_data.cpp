#include "wearwell/prognosis/new_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/columns.h"
#include "wearwell/prognosis/carry.h"
#include "wearwell/prognosis/doubted_rows.h"
#include "wearwell/prognosis/matched_rows.h"

namespace wearwell::prognosis {
namespace {

using Places = std::vector<std::size_t>;

// "machine 9" before "machine 10".
int compare_words(std::string_view a, std::string_view b) {
  const auto digits = [](std::string_view text) {
    return std::min(text.find_first_not_of("0123456789"), text.size());
  };
  const auto number = [](std::string_view text) {
    return text.substr(std::min(text.find_first_not_of('0'), text.size()));
  };
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    const std::size_t of_a = digits(a), of_b = digits(b);
    if (of_a > 0 && of_b > 0) {
      const std::string_view x = number(a.substr(0, of_a)), y = number(b.substr(0, of_b));
      if (x.size() != y.size()) return x.size() < y.size() ? -1 : 1;
      if (const int order = x.compare(y)) return order;
      a.remove_prefix(of_a);
      b.remove_prefix(of_b);
    } else {
      if (a.front() != b.front()) return a.front() < b.front() ? -1 : 1;
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty() ? -1 : 1;
  return whole_a.compare(whole_b);
}

int compare_cells(const Column& column, std::size_t a, std::size_t b) {
  if (!column.is_number) return compare_words(column.text[a], column.text[b]);
  const double x = column.numbers[a], y = column.numbers[b];
  if (std::isnan(x) || std::isnan(y)) return std::isnan(x) - std::isnan(y);
  return x < y ? -1 : x > y ? 1 : 0;
}

std::string cell(const Column& column, std::size_t row) {
  if (!column.is_number) return column.text[row];
  return std::isnan(column.numbers[row]) ? "" : fmt::format("{:.10g}", column.numbers[row]);
}

// The cells of a row in some columns.
std::string key(const Table& table, const Places& columns, std::size_t row) {
  check_stop();
  std::string text;
  for (const std::size_t c : columns) text += cell(table.columns[c], row) + '\x1f';
  return text;
}

Places places_of(const Table& table, const std::vector<std::string>& headings) {
  Places places;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (std::find(headings.begin(), headings.end(), table.columns[c].name) != headings.end())
      places.push_back(c);
  }
  return places;
}

Places all_places(const Table& table) {
  Places all(table.columns.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

Table rows_of(const Table& table, const Places& rows) {
  Table some = table;
  some.lines.clear();
  some.rows = rows.size();
  for (Column& column : some.columns) {
    const Column all = std::move(column);
    column = {all.name, all.is_number, {}, {}, all.unit, all.marks, all.doubt};
    for (const std::size_t row : rows) {
      if (all.is_number) {
        column.numbers.push_back(all.numbers[row]);
      } else {
        column.text.push_back(all.text[row]);
      }
    }
  }
  return some;
}

void append(Table& table, const Table& more) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Column& column = table.columns[c];
    const Column& own = more.columns[c];
    column.numbers.insert(column.numbers.end(), own.numbers.begin(), own.numbers.end());
    column.text.insert(column.text.end(), own.text.begin(), own.text.end());
  }
  table.rows += more.rows;
  table.lines.clear();
}

bool same_content(const Table& a, const Table& b) {
  if (a.rows != b.rows || a.columns.size() != b.columns.size()) return false;
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    const Column &x = a.columns[c], &y = b.columns[c];
    if (x.name != y.name || x.is_number != y.is_number || x.text != y.text) return false;
    for (std::size_t i = 0; i < x.numbers.size(); ++i) {
      if (x.numbers[i] != y.numbers[i] && !(std::isnan(x.numbers[i]) && std::isnan(y.numbers[i])))
        return false;
    }
  }
  return true;
}

std::string shown(const Column& column, std::size_t row) {
  return column.is_number ? fmt::format("{:.6g}", column.numbers[row]) : column.text[row];
}

std::string measured_text(const Table& table, const DataRoles& roles, std::size_t row) {
  std::vector<std::string> words;
  for (const std::string& each : roles.measured)
    words.push_back(fmt::format("{} = {}", each, shown(table.column(each), row)));
  return fmt::format("{}", fmt::join(words, ", "));
}

// Rows of `after` that are not in `before`; also a different value in the place of an earlier one.
void compare(const Table& before, const Table& after, JoinedData& joined) {
  std::unordered_map<std::string, std::size_t> left;
  const Places all = all_places(before);
  for (std::size_t i = 0; i < before.rows; ++i) ++left[key(before, all, i)];
  for (std::size_t i = 0; i < after.rows; ++i) {
    const auto found = left.find(key(after, all, i));
    if (found == left.end() || found->second == 0) {
      joined.fresh.push_back(i);
    } else {
      --found->second;
    }
  }
  const DataRoles& roles = joined.roles;
  if (!roles.same_is_same() || roles.measured.empty()) return;
  std::vector<std::string> where = {*roles.axis};
  if (roles.unit) where.push_back(*roles.unit);
  const Places at = places_of(after, where);
  std::unordered_map<std::string, std::string> known;  // columns measured at a place
  for (std::size_t i = 0; i < before.rows; ++i) {
    // Where several readings per place are normal, another one is no contradiction.
    if (!known.emplace(key(before, at, i), measured_text(before, roles, i)).second) return;
  }
  for (const std::size_t row : joined.fresh) {
    const std::string now = measured_text(after, roles, row);
    const auto [there, is_new] = known.emplace(key(after, at, row), now);
    if (is_new) continue;
    joined.contradictions.push_back(
        {row, place_text(after, roles, row),
         fmt::format("{}, where {} is already known", now, there->second)});
  }
}

// Joins the rows of a file; repeated rows count as `repeated` states.
class Joining {
 public:
  Joining(Table table, DataRoles roles, Repeated repeated)
      : table_(std::move(table)), roles_(std::move(roles)), repeated_(repeated) {}

  void add(const Table& fresh, const std::vector<std::string>& needed, JoinedData& joined) {
    refuse_doubted_rows(fresh, table_);
    const MatchedRows matched = matched_rows(fresh, roles_, needed, table_);
    for (const std::string& note : matched.notes) joined.notes.push_back(note);
    Places given;
    for (std::size_t c = 0; c < matched.given.size(); ++c) {
      if (matched.given[c]) given.push_back(c);
    }
    if (given.empty())
      throw InputError(fmt::format("{} has none of the columns of the study's data", fresh.source));
    std::unordered_map<std::string, std::size_t> known;
    for (std::size_t i = 0; i < table_.rows; ++i) known.emplace(key(table_, given, i), i);
    Places counted;
    for (std::size_t i = 0; i < matched.table.rows; ++i) {
      const auto [there, is_new] = known.emplace(key(matched.table, given, i), table_.rows + i);
      if (is_new || repeated_ == Repeated::another) {
        counted.push_back(i);
        continue;
      }
      if (repeated_ == Repeated::ask && !roles_.same_is_same()) refuse(fresh, i, there->second);
      ++joined.repeated;
    }
    joined.counted += counted.size();
    append(table_, rows_of(matched.table, counted));
  }

  const Table& table() const { return table_; }

 private:
  [[noreturn]] void refuse(const Table& fresh, std::size_t row, std::size_t there) const {
    throw InputError(fmt::format(
        "{}, row {} equals {}: it may be the same {} again, or another one with an equal result; "
        "add --repeated once or --repeated another",
        fresh.source, row + 1,
        there < table_.rows ? fmt::format("row {} of the known data", there + 1)
                            : fmt::format("row {} of the same file", there - table_.rows + 1),
        roles_.unit ? "reading" : roles_.noun));
  }

  Table table_;
  DataRoles roles_;
  Repeated repeated_;
};

TableSection data_section(const Source& source) {
  for (TableSection& each : table_sections(source.study)) {
    if (each.path == "data") return each;
  }
  throw InputError(fmt::format("{} has no data.file: new rows have no table to join",
                               source.study.path.string()));
}

// Columns of the file that a query names.
std::vector<std::string> named_in(const std::string& sql, const Table& table) {
  std::vector<std::string> names;
  for (const Column& each : table.columns) {
    if (sql.find(each.name) != sql.npos) names.push_back(each.name);
  }
  return names;
}

std::vector<std::string> used_columns(const DataRoles& roles) {
  std::vector<std::string> names;
  for (const DataRoles::Named& each : roles.used) names.push_back(each.column);
  return names;
}

// The result of the query on `file`; unchanged if the rows are unchanged.
Table asked_anew(const TableSection& section, const Table& before, const Table& was,
                 const Table& now, const DataRoles& roles) {
  const Table again = query_table(before, *section.sql);
  if (!same_content(in_order(again, roles), in_order(was, roles)))
    throw InputError(fmt::format(
        "data.sql gives another result on the saved rows of {} than on the file: it uses something "
        "that a table of numbers and texts does not hold. Add the rows to the file and fit again",
        section.file));
  Table asked = query_table(now, *section.sql);
  asked.source = was.source;
  return asked;
}

}  // namespace

std::string place_text(const Table& table, const DataRoles& roles, std::size_t row) {
  std::string words;
  if (roles.unit) words = roles.noun + " " + cell_word(table.column(*roles.unit), row);
  if (roles.axis) {
    words += fmt::format("{}{} = {}", words.empty() ? "" : " at ", *roles.axis,
                         cell_word(table.column(*roles.axis), row));
  }
  return words.empty() ? fmt::format("row {}", row + 1) : words;
}

Table in_order(const Table& table, const DataRoles& roles) {
  Places columns;
  for (const auto& first : {roles.unit, roles.axis}) {
    if (!first) continue;
    const Places place = places_of(table, {*first});
    columns.insert(columns.end(), place.begin(), place.end());
  }
  const Places all = all_places(table);
  columns.insert(columns.end(), all.begin(), all.end());
  Places rows(table.rows);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    check_stop();
    for (const std::size_t c : columns) {
      if (const int order = compare_cells(table.columns[c], a, b)) return order < 0;
    }
    return false;
  });
  return rows_of(table, rows);
}

const Table& data_table(const Source& source) {
  return source.tables.at(data_section(source).as_read);
}

Table read_new_data(const Source& source, const std::filesystem::path& file) {
  const TomlReader root = TomlReader::parse(source.study);
  const bool alike =
      file.extension() == std::filesystem::path(data_section(source).file).extension();
  return wearwell::read_table(
      file, {}, {}, alike ? read_table_settings(root.required_table("data")) : TableSettings{});
}

Table joined_table(const Table& was, const std::vector<Table>& fresh, Repeated repeated,
                   JoinedData& joined) {
  Joining joining(was, joined.roles, repeated);
  joined.before += was.rows;
  const std::vector<std::string> needed = used_columns(joined.roles);
  for (const Table& each : fresh) joining.add(each, needed, joined);
  Table now = in_order(joining.table(), joined.roles);
  compare(was, now, joined);
  return now;
}

JoinedData joined_data(const Source& source, const std::vector<Table>& fresh, Repeated repeated) {
  const TableSection section = data_section(source);
  const auto found = source.tables.find(section.as_read);
  if (found == source.tables.end())
    throw InputError(fmt::format("the state has no table '{}'", printable(section.file)));
  const Table& was = found->second;
  const TomlReader root = TomlReader::parse(source.study);
  JoinedData joined{source, data_roles(root, was)};
  if (!section.sql) {
    joined.source.tables[section.as_read] = joined_table(was, fresh, repeated, joined);
    return joined;
  }
  const auto raw = source.tables.find(section.before_sql);
  if (raw == source.tables.end())
    throw InputError(fmt::format("the state has no table '{}'", printable(section.file)));
  DataRoles of_file = joined.roles;  // a query computes its own columns
  of_file.used.clear(), of_file.words.clear();
  const std::vector<std::string> needed = named_in(*section.sql, raw->second);
  Joining joining(raw->second, of_file, repeated);
  joined.before = raw->second.rows;
  for (const Table& each : fresh) joining.add(each, needed, joined);
  const Table file = in_order(joining.table(), DataRoles{});
  const Table now =
      in_order(asked_anew(section, raw->second, was, file, joined.roles), joined.roles);
  compare(was, now, joined);
  joined.source.tables[section.as_read] = now;
  joined.source.tables[section.before_sql] = file;
  return joined;
}

}  // namespace wearwell::prognosis
