#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/present/html.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/table.h"
#include "wearwell/prognosis/decisions_report.h"

namespace wearwell::prognosis {

/// Numbers of a report in its user's units.
struct Shown {
  const DecisionsReport& report;

  /// "35.77 × 10^6 cycles"
  std::string age(double si) const { return plain_quantity(at(si), unit()); }
  double at(double si) const { return si / report.lives.unit.scale; }
  double rate(double per_si) const { return per_si * report.lives.unit.scale; }
  const std::string& unit() const { return report.lives.unit.text; }
  std::string rate_unit() const {
    const std::string& money = report.question.currency;
    return fmt::format(
        "{}/{}", money.empty() ? "1" : money,
        unit().find_first_of(" /*") == std::string::npos ? unit() : "(" + unit() + ")");
  }
  std::string money(double amount) const {
    return report.question.currency.empty()
               ? plain_given(amount)
               : fmt::format("{} {}", plain_given(amount), report.question.currency);
  }
};

present::Table policies_table(const DecisionsReport& report);
present::Table units_table(const DecisionsReport& report);
present::Table months_table(const DecisionsReport& report);

/// Long-run cost against the age of replacement, in the user's units, up to a few times the least.
struct CostCurve {
  std::vector<double> age, cost;
  std::optional<double> end =
      {};  ///< of a picture: beyond it the cost is that of replacement at failure
};
CostCurve cost_curve(const DecisionsReport& report);

html::Figure cost_figure(const DecisionsReport& report);
html::Figure months_figure(const DecisionsReport& report);

}  // namespace wearwell::prognosis
