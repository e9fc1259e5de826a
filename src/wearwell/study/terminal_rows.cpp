#include "wearwell/study/terminal_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "wearwell/base/printable.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/table.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

// The better of the two: quadrature where there is one.
std::string stage_table(const std::vector<StageSummary>& stages) {
  std::vector<std::vector<std::string>> rows = {{"rows"}};
  for (const ParameterSummary& p : stages.front().parameters) {
    rows[0].push_back(printable_heading(p.name, p.unit));
    rows[0].push_back("sd");
  }
  rows[0].push_back("trusted");
  for (const StageSummary& stage : stages) {
    rows.push_back({fmt::format("{}", stage.rows)});
    for (const ParameterSummary& p : stage.parameters) {
      rows.back().push_back(plain_number(p.exact ? p.exact->mean : p.mean));
      rows.back().push_back(plain_number(p.exact ? p.exact->sd : p.sd));
    }
    rows.back().push_back(trust_word(stage.checks));
  }
  return text_table(rows);
}

// Shows the first rows of a table with a row for each observation; the files have all.
constexpr std::size_t most_rows = 200;

std::string rest_line(std::size_t rows, const char* file) {
  if (rows <= most_rows) return "";
  return fmt::format("  ... and {} more{}\n", rows - most_rows,
                     rows > most_rows_inline ? fmt::format(" in {}", file) : "");
}

const char* place_of(const CoverageRow& row) {
  if (!row.failed()) return "";
  if (row.below_b10()) return row.inside() ? "below B10" : "below B10, outside";
  return row.inside() ? "" : "outside";
}

std::string coverage_table(const CoverageTable& table) {
  std::vector<std::vector<std::string>> rows = {{"row", "type", "outcome",
                                                 printable_heading("life", table.unit),
                                                 "share below", "90 % interval", "B10", ""}};
  for (const CoverageRow& row : table.rows) {
    if (rows.size() > most_rows) break;
    rows.push_back({fmt::format("{}", row.row), row.label, row.outcome,
                    row.until ? plain_range(row.life, *row.until) : plain_number(row.life),
                    fmt::format("{:.1f} %", 100 * row.probability), plain_range(row.q05, row.q95),
                    plain_number(row.b10), place_of(row)});
  }
  return text_table(rows, true) + rest_line(table.rows.size(), coverage_table_file);
}

std::string pointwise_table(const PointwiseTable& p) {
  std::vector<std::vector<std::string>> rows = {
      {"cycles", printable_heading("F", p.force_unit), printable_heading("s", p.slip_unit),
       printable_heading("V", p.volume_unit), printable_heading("k = V/(F s)", p.k_unit)}};
  for (const PointwiseRow& row : p.rows) {
    if (rows.size() > most_rows) break;
    rows.push_back({plain_given(row.cycles), plain_number(row.force), plain_number(row.slip),
                    plain_number(row.volume), plain_number(row.k)});
  }
  return text_table(rows) + rest_line(p.rows.size(), pointwise_table_file);
}

}  // namespace

// Tables with a line for each row of the data, or the names of their files.
std::string printable_heading(const std::string& name, const std::string& unit) {
  // "1e6 cycles" as "10^6 cycles".
  constexpr std::string_view power = "1e";
  const bool multiple = unit.starts_with(power) && unit.size() > power.size() &&
                        unit[power.size()] >= '0' && unit[power.size()] <= '9';
  return printable(present::heading(name, multiple ? "10^" + unit.substr(power.size()) : unit));
}

std::string row_tables(const PosteriorSummary& result, bool shown) {
  std::string out;
  std::vector<std::string> files;
  const auto add = [&](const char* title, const char* id, const auto& table) {
    if (shown) {
      out += fmt::format("\n{}\n{}", title, table());
    } else {
      files.push_back(fmt::format("tables/{}.csv", id));
    }
  };
  if (result.pointwise) {
    add("Wear coefficient of each measurement", "pointwise",
        [&] { return pointwise_table(*result.pointwise); });
  }
  if (!result.stages.empty()) {
    add("Row by row (mean, sd)", "parameters-by-data-set",
        [&] { return stage_table(result.stages); });
  }
  if (result.coverage) {
    add("Tests and their predicted lives", "coverage",
        [&] { return coverage_table(*result.coverage); });
  }
  if (!files.empty()) {
    out += "\nRow by row\n" +
           wrapped(fmt::format("with --rows here, or in {}", fmt::join(files, ", ")), 2, 4);
  }
  return out;
}

}  // namespace wearwell
