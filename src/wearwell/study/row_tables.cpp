#include "wearwell/study/row_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/present/html.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

using present::Cell;
using present::Column;
using present::count;
using present::digits;
using present::fixed;
using present::given;
using present::Range;
using present::Table;

}  // namespace

Table coverage_table(const CoverageTable& coverage) {
  const std::string& unit = coverage.unit;
  Table table{"coverage",
              "Every test and its predicted life",
              {{"Row", "1", given},
               {"Type"},
               {"Outcome"},
               {"Life", unit},
               {"Until", unit},
               {"Share below", "%", digits(3)},
               Column{"90 % predictive interval", unit, {}, true},
               {"B10", unit},
               {"Where it lies"}}};
  for (const CoverageRow& row : coverage.rows) {
    const char* place = !row.failed()     ? ""
                        : row.below_b10() ? row.inside() ? "below B10" : "below B10, outside"
                        : row.inside()    ? "inside"
                                          : "outside";
    table.rows.push_back({count(row.row), row.label, row.outcome, row.life,
                          row.until ? Cell(*row.until) : Cell(), 100 * row.probability,
                          Range{row.q05, row.q95}, row.b10, place});
  }
  return table;
}

Table pointwise_table(const PointwiseTable& p) {
  Table table{"pointwise",
              shown_caption("Wear coefficient of each measurement for itself", p.rows.size(),
                            "the first", pointwise_table_file),
              {{"cycles", "1", given},
               {"F", p.force_unit},
               {"s", p.slip_unit},
               {"V", p.volume_unit},
               {"k = V/(F s)", p.k_unit}}};
  for (const PointwiseRow& row : p.rows) {
    if (table.rows.size() == most_rows_inline) break;
    table.rows.push_back({row.cycles, row.force, row.slip, row.volume, row.k});
  }
  return table;
}

Table loo_table(const LooSummary& summary) {
  const Loo& loo = summary.loo;
  Table table{"loo",
              shown_caption(
                  fmt::format("How well each {} is predicted from all others", summary.observation),
                  loo.terms.size(), "the least probable", loo_table_file),
              {{html::capital(summary.observation), "1", given},
               {"Alike", "1", given},
               {"Log density", "1", fixed(3)},
               {"Log density with itself", "1", fixed(3)},
               {"Pareto k", "1", fixed(2)},
               {"Remark"}}};
  for (const std::size_t i : shown_terms(loo.terms)) {
    const LooTerm& term = loo.terms[i];
    table.rows.push_back({count(i + 1), static_cast<double>(term.count), term.elpd, term.lpd,
                          std::isinf(term.khat) && term.khat < 0 ? Cell() : Cell(term.khat),
                          term.refitted        ? "refitted"
                          : loo.doubtful(term) ? "Pareto k too large"
                                               : ""});
  }
  return table;
}

}  // namespace wearwell
