#include "wearwell/models/formula_model/returns_scaffold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/input/prior.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/returns_triangle.h"

namespace wearwell::formula_model {
namespace {

// What the prefix of numbered periods says of their length: "KW" are weeks.
std::string period_of_prefix(const std::string& prefix) {
  const std::string word = folded_word(prefix);
  for (const char* each : {"w", "kw", "week", "woche", "semaine"})
    if (word == each) return "week";
  for (const char* each : {"m", "month", "monat", "mois", "mes"})
    if (word == each) return "month";
  return "";
}

// The end of a triangle, as a number of periods.
double length_of(const Table& table) {
  constexpr std::size_t others = 2;
  return std::max<double>(1, static_cast<double>(table.columns.size() - others));
}

}  // namespace

std::optional<Scaffold> first_returns_study(ColumnRoles& roles) {
  const Table& table = roles.table();
  const auto columns = triangle_columns(table);
  if (!columns) return {};
  Scaffold study;
  study.reading = "returns triangle (Nevada table): units sold and their returns by period";
  study.fit = ReadingFit::specific;
  if (!roles.choices().columns.empty()) study.fit = ReadingFit::none;
  study.taken = {
      fmt::format("sold: column '{}'", columns->period),
      fmt::format("quantity: column '{}'", columns->quantity),
      fmt::format("periods of return: columns '{}' to '{}'", columns->first, columns->last)};
  study.guesses = {"a unit starts in the middle of its period of sale; an empty cell is no return"};
  for (const std::string& each : columns->unread)
    study.guesses.push_back(fmt::format("column '{}' is not used", each));
  std::string unit = "month", line;
  if (!columns->calendar) {
    unit = period_of_prefix(columns->prefix);
    line = unit.empty() ? roles.unstated_line("period", "the length of a period", "month")
                        : fmt::format("period   = {}\n", toml_text(unit));
    if (unit.empty()) unit = "month";
  }
  study.unstated = roles.unstated;
  study.text = fmt::format(
      "title = {}\nmodel = \"formula\"\n\n{}"
      "[data.returns]                           # a row is a period of sale, a column a period of "
      "return\nsold     = {}\nquantity = {}\n{}"
      "ages     = \"middle\"                      # of the period of sale; or start, end, whole "
      "(docs/reference/warranty.md)\n"
      "# warranty = \"36 {}\"                  # in use; later failures are not claimed\n\n"
      "[likelihood.life]\nfamily = \"weibull\"                       # or lognormal, loglogistic, "
      "gamma (docs/reference/formula-models.md)\n"
      "scale  = \"characteristic\"                # 63.2 % have failed by then\nshape  = "
      "\"slope\"\n\n"
      "# Prior knowledge: PROPOSED as weak priors from the length of the table. Replace them with "
      "what you know.\n[prior]\n"
      "characteristic = {{ distribution = \"lognormal\", median = \"{} {}\", log_sd = 2 }}    # a "
      "factor of 27 to either side\n"
      "slope = {{ distribution = \"lognormal\", median = 1.2, log_sd = 0.5 }}    # below 1: early "
      "failures, above: wear-out\n\n"
      "[predict]\nnext = \"12 {}\"                        # returns to come\n"
      "# cost_per_return = \"180 EUR\"\n"
      "# planned_sales = {{ file = \"planned_sales.csv\" }}    # columns: period of sale, units\n",
      toml_text("Returns, from " + roles.file()), roles.data_section(), toml_text(columns->period),
      toml_text(columns->quantity), line, unit, rounded_up(10 * length_of(table)), unit, unit);
  return study;
}

}  // namespace wearwell::formula_model
