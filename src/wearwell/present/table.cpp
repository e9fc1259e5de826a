#include "wearwell/present/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/present/number.h"
#include "wearwell/present/text_table.h"

namespace wearwell::present {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

int digits_of_life(double x, int digits) {
  const int whole = x >= 1 && std::isfinite(x) ? static_cast<int>(std::log10(x)) + 1 : digits;
  return std::min(digits, whole);
}

// Spreadsheets execute cells that begin like a formula.
bool looks_like_formula(const std::string& text) {
  return !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
}

std::string quoted(const std::string& text) {
  const std::string shown = printable(text, "\n\t");
  const std::string safe = looks_like_formula(shown) ? "'" + shown : shown;
  if (safe.find_first_of(",\"\n\r") == safe.npos) return safe;
  std::string out = "\"";
  for (const char c : safe) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string full(double x) {
  return std::isnan(x) ? "" : fmt::format("{}", x);
}

std::string file_cell(const Cell& cell, bool is_range) {
  const std::string second = is_range ? "," : "";
  return std::visit(
      Overloaded{[&](std::monostate) { return second; },
                 [&](const std::string& text) { return quoted(text) + second; },
                 [&](double x) { return full(x) + second; },
                 [&](const Range& range) { return full(range.low) + ',' + full(range.high); },
                 [&](const Badge& badge) { return quoted(badge.kind) + second; }},
      cell);
}

std::string shown(double x, const Format& format, Script script) {
  switch (format.kind) {
    case Format::Kind::given:
      return given_text(x, script);
    case Format::Kind::fixed:
      return fixed_text(x, format.digits, script);
    case Format::Kind::life:
      return std::isinf(x) && x > 0 ? "never"
                                    : shown_number(x, digits_of_life(x, format.digits), script);
    case Format::Kind::significant:
      break;
  }
  return shown_number(x, format.digits, script);
}

// "2 to 3.580 × 10^12" could be read with one power for both ends.
bool could_share_power(const Range& range) {
  return range.low != 0 && std::abs(range.low) < 10 && std::abs(range.high) >= 1e7;
}

std::string shown(const Range& range, const Format& format, Script script) {
  const bool finite = std::isfinite(range.low) && std::isfinite(range.high);
  return finite && (format.kind == Format::Kind::significant ||
                    (format.kind == Format::Kind::life && could_share_power(range)))
             ? range_text(range.low, range.high, format.digits, script)
             : shown(range.low, format, script) + " to " + shown(range.high, format, script);
}

std::string shown(const Cell& cell, const Format& format, Script script) {
  const bool page = script == Script::page;
  return std::visit(Overloaded{[&](std::monostate) { return std::string(page ? "–" : "-"); },
                               [&](const std::string& text) { return powers_text(text, script); },
                               [&](double x) { return shown(x, format, script); },
                               [&](const Range& range) { return shown(range, format, script); },
                               [&](const Badge& badge) { return page ? badge.word : badge.kind; }},
                    cell);
}

}  // namespace

std::string heading(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : fmt::format("{} [{}]", name, unit);
}

std::string heading(const Column& column) {
  return heading(column.name, column.unit);
}

std::string description(double x, const Format& format, Script script) {
  return shown(x, format, script);
}

std::string description(const Cell& cell, const Column& column) {
  return shown(cell, column.format, Script::page);
}

std::string csv(const Table& table) {
  std::string out;
  const char* separator = "";
  for (const Column& column : table.columns) {
    out += separator;
    if (column.is_range) {
      Column low = column, high = column;
      low.name += ", from";
      high.name += ", to";
      out += quoted(heading(low)) + ',' + quoted(heading(high));
    } else {
      out += quoted(heading(column));
    }
    separator = ",";
  }
  out += "\r\n";
  for (const auto& row : table.rows) {
    check_stop();
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) out += ',';
      out += file_cell(row[c], table.columns[c].is_range);
    }
    out += "\r\n";
  }
  return out;
}

std::string text(const Table& table) {
  std::vector<std::vector<std::string>> rows(1);
  for (const Column& column : table.columns) rows.front().push_back(heading(column));
  for (const auto& row : table.rows) {
    if (rows.size() > most_rows_shown) break;
    rows.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c)
      rows.back().push_back(shown(row[c], table.columns[c].format, Script::terminal));
  }
  std::string out = fmt::format("{}\n{}", printable(table.caption), text_table(rows, table.words));
  if (table.rows.size() > most_rows_shown)
    out +=
        fmt::format("  the first {} of {}; all are in tables/{}.csv\n",
                    given_text(most_rows_shown, Script::terminal),
                    given_text(static_cast<double>(table.rows.size()), Script::terminal), table.id);
  return out;
}

}  // namespace wearwell::present
