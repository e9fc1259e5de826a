#include <cmath>
#include <limits>

#include "core.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/embed/memory_table.h"
#include "wearwell/models/formula_model/straight_line.h"
#include "wearwell/study/life_size.h"

namespace wearwell::r {
namespace {

// A vector of doubles, or of texts in UTF-8; NA is an empty cell.
Column column_of(const std::string& heading, const std::string& unit, SEXP values) {
  Column column;
  column.name = heading;
  column.unit = unit;
  const R_xlen_t n = Rf_xlength(values);
  column.is_number = TYPEOF(values) == REALSXP;
  if (column.is_number) {
    const double* from = REAL(values);
    column.numbers.assign(from, from + n);
    for (double& each : column.numbers) {
      if (std::isnan(each)) each = std::numeric_limits<double>::quiet_NaN();
    }
  } else {
    column.text.reserve(static_cast<std::size_t>(n));
    for (R_xlen_t i = 0; i < n; ++i) {
      SEXP each = STRING_ELT(values, i);
      column.text.emplace_back(each == NA_STRING ? "" : CHAR(each));
    }
  }
  return column;
}

SEXP table_of(const std::string& name, const std::vector<std::string>& headings,
              const std::vector<std::string>& units, const Rcpp::List& columns) {
  Table table;
  table.source = name;
  for (std::size_t c = 0; c < headings.size(); ++c) {
    SEXP values = columns[static_cast<R_xlen_t>(c)];
    embed::add_column(table, column_of(headings[c], units[c], values));
  }
  embed::refuse_no_table(table);
  return hold(std::move(table));
}

SEXP table_of_file(const std::string& file, const std::vector<std::string>& headings,
                   const std::vector<std::string>& units) {
  const embed::ForkGuard guard;
  Table table = read_table(file);
  std::map<std::string, std::string> reported;
  for (std::size_t i = 0; i < headings.size(); ++i) reported[headings[i]] = units[i];
  embed::add_units(table, reported);
  return hold(std::move(table));
}

SEXP headings(SEXP table) {
  std::vector<std::string> names;
  for (const Column& each : held<Table>(table).columns) names.push_back(each.name);
  return texts_of(names);
}

// Median and log_sd of the default prior of a life, and the words for both. `lines`: of [data.columns].
SEXP size_of_lives(SEXP table, const std::string& lines, const std::vector<std::string>& runouts,
                   double least, const std::vector<std::string>& stresses) {
  const Table& lives = held<Table>(table);
  LifeHeadings headings = life_headings(lines, lives);
  headings.runouts = runouts;
  const LifeSize size = life_size_under(lives, headings, least, stresses);
  return named_list({{"median", Rcpp::Shield<SEXP>(Rf_ScalarReal(size.median))},
                     {"log_sd", Rcpp::Shield<SEXP>(Rf_ScalarReal(size.log_sd))},
                     {"why", Rcpp::Shield<SEXP>(text_of(words_of(size)))}});
}

// What `wearwell new --from` proposes a prior of a path with; `unit` is "" for one unit.
SEXP line_of(SEXP table, const std::string& axis, const std::string& measured,
             const std::string& unit) {
  const Table& readings = held<Table>(table);
  const formula_model::StraightLine line =
      formula_model::straight_line(readings, readings.column(axis), readings.column(measured),
                                   unit.empty() ? nullptr : &readings.column(unit));
  return named_list({{"at_zero", Rcpp::Shield<SEXP>(Rf_ScalarLogical(line.begins_at_zero))},
                     {"falls", Rcpp::Shield<SEXP>(Rf_ScalarLogical(line.falls))},
                     {"rate", Rcpp::Shield<SEXP>(Rf_ScalarReal(line.rate))}});
}

SEXP rows_of_family(SEXP table, const std::string& axis, const std::string& measured,
                    const std::string& family) {
  const Table& readings = held<Table>(table);
  formula_model::require_rows_of_family(readings, readings.column(axis), readings.column(measured),
                                        family);
  return R_NilValue;
}

}  // namespace

void add_tables(Doors& doors) {
  doors.push_back(door<&table_of>("table_of"));
  doors.push_back(door<&table_of_file>("table_of_file"));
  doors.push_back(door<&headings>("headings"));
  doors.push_back(door<&size_of_lives>("life_size"));
  doors.push_back(door<&line_of>("straight_line"));
  doors.push_back(door<&rows_of_family>("require_rows_of_family"));
}

}  // namespace wearwell::r
