#include "wearwell/study/long_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>

#include "wearwell/base/stop_scope.h"
#include "wearwell/input/csv_reader.h"

namespace wearwell {
namespace {

std::string loo_csv(const Loo& loo) {
  std::string out = "observation,elpd,lpd,khat,count,refitted,tail\n";
  auto end = std::back_inserter(out);
  for (std::size_t i = 0; i < loo.terms.size(); ++i) {
    check_stop();
    const LooTerm& term = loo.terms[i];
    fmt::format_to(end, "{},{},{},{},{},{},{}\n", i + 1, term.elpd, term.lpd, term.khat, term.count,
                   term.refitted ? 1 : 0, term.tail);
  }
  return out;
}

std::string coverage_csv(const CoverageTable& table) {
  std::string out = "row,label,outcome,life,until,probability,q05,q95,b10\n";
  auto end = std::back_inserter(out);
  for (const CoverageRow& row : table.rows) {
    check_stop();
    fmt::format_to(end, "{},{},{},{},{},{},{},{},{}\n", row.row, printable_csv_cell(row.label),
                   row.outcome, row.life, row.until ? fmt::format("{}", *row.until) : "",
                   row.probability, row.q05, row.q95, row.b10);
  }
  return out;
}

std::string pointwise_csv(const PointwiseTable& table) {
  std::string out = "cycles,force,slip,volume,k\n";
  auto end = std::back_inserter(out);
  for (const PointwiseRow& row : table.rows) {
    check_stop();
    fmt::format_to(end, "{},{},{},{},{}\n", row.cycles, row.force, row.slip, row.volume, row.k);
  }
  return out;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> long_tables(const PosteriorSummary& result) {
  std::vector<std::pair<std::string, std::string>> tables;
  if (result.loo && result.loo->loo.terms.size() > most_rows_inline) {
    tables.emplace_back(loo_table_file, loo_csv(result.loo->loo));
  }
  if (result.coverage && result.coverage->rows.size() > most_rows_inline) {
    tables.emplace_back(coverage_table_file, coverage_csv(*result.coverage));
  }
  if (result.pointwise && result.pointwise->rows.size() > most_rows_inline) {
    tables.emplace_back(pointwise_table_file, pointwise_csv(*result.pointwise));
  }
  return tables;
}

std::string shown_caption(const std::string& what, std::size_t rows, const char* which,
                          const char* file) {
  if (rows <= most_rows_inline) return what;
  return fmt::format("{}: {} of {}, {}; all are in {}", what, most_rows_inline, rows, which, file);
}

std::vector<std::size_t> shown_terms(const std::vector<LooTerm>& terms) {
  std::vector<std::size_t> order(terms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (order.size() <= most_rows_inline) return order;
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(most_rows_inline);
  std::nth_element(order.begin(), end, order.end(), [&](std::size_t a, std::size_t b) {
    return terms[a].elpd != terms[b].elpd ? terms[a].elpd < terms[b].elpd : a < b;
  });
  order.erase(end, order.end());
  std::sort(order.begin(), order.end());
  return order;
}

std::string chosen_tests(const CoverageTable& table) {
  if (table.tests <= table.rows.size()) return "";
  return fmt::format(" among {} of {} tests, evenly chosen,", table.rows.size(), table.tests);
}

std::vector<LooTerm> read_loo_table(const std::filesystem::path& folder) {
  CsvReader csv(folder / loo_table_file);
  const std::size_t elpd = csv.column("elpd"), lpd = csv.column("lpd"), khat = csv.column("khat"),
                    count = csv.column("count"), refitted = csv.column("refitted"),
                    tail = csv.column("tail");
  std::vector<LooTerm> terms;
  while (csv.next()) {
    check_stop();
    const long long alike = csv.integer(count);
    if (alike < 1 || alike > std::numeric_limits<int>::max()) csv.fail(count, "1 or more");
    terms.push_back({csv.number(elpd), csv.number(lpd), csv.number(khat), static_cast<int>(alike),
                     csv.flag(refitted), csv.number(tail)});
  }
  return terms;
}

}  // namespace wearwell
