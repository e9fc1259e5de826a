#include "wearwell/models/formula_model/use_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace wearwell::formula_model {
namespace {

// The share of units at either end that may lie outside the tests.
constexpr double left_out_of_use = 0.01;

Check use_check(const FormulaModel& model, const VariedConditions& varied) {
  Findings findings("use");
  std::string passed;
  for (const VariedCondition& each : varied.conditions) {
    const NumberColumn& column = *model.data.number(each.column);
    const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
    const Unit& unit = each.distribution.unit;
    const std::string suffix = unit.text == "1" ? "" : " " + unit.text;
    const auto shown = [&](double si) { return fmt::format("{:.4g}", from_si(unit, si)); };
    const double from = each.quantile(left_out_of_use), to = each.quantile(1 - left_out_of_use);
    const std::string range =
        fmt::format("{} of 98 % of the units is {} to {}{}, tested were {} to {}{}", each.column,
                    shown(from), shown(to), suffix, shown(*low), shown(*high), suffix);
    passed += (passed.empty() ? "" : "; ") + range;
    if (from < *low || to > *high)
      findings.add(Verdict::warn, range,
                   "Outside the tested range the answer rests on the formula, not on data. Test "
                   "there, or bound the distribution (lower, upper).");
  }
  return findings.result(passed);
}

}  // namespace

void add_use_check(const std::shared_ptr<const FormulaModel>& model, const Conditions& given,
                   PosteriorStudy& study) {
  if (!given.varied) return;
  std::vector<std::string> words;
  for (const VariedCondition& each : given.varied->conditions) words.push_back(description(each));
  study.equation += fmt::format("; in use {} over the units, each of which keeps its own for life",
                                fmt::join(words, ", "));
  study.checks = [model, varied = given.varied, own = study.checks](const Fit& fit) {
    std::vector<Check> all;
    if (own) all = own(fit);
    all.push_back(use_check(*model, *varied));
    return all;
  };
}

}  // namespace wearwell::formula_model
