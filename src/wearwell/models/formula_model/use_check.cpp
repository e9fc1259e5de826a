#include "wearwell/models/formula_model/use_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {
namespace {

// The share of units at either end that may lie outside the tests.
constexpr double left_out_of_use = 0.01;

void compare_with_tests(const FormulaModel& model, const AskedUse& use, Findings& findings,
                        std::string& passed) {
  const std::string of = use.key == "given" ? "" : fmt::format(" ({})", use.key);
  for (const VariedCondition& each : use.conditions.varied->conditions) {
    const NumberColumn& column = *model.data.number(each.column);
    const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
    const Unit& unit = each.distribution.unit;
    const std::string suffix = unit.text == "1" ? "" : " " + unit.text;
    const auto shown = [&](double si) { return fmt::format("{:.4g}", from_si(unit, si)); };
    const double from = each.quantile(left_out_of_use), to = each.quantile(1 - left_out_of_use);
    const std::string range =
        fmt::format("{} of 98 % of the units{} is {} to {}{}, tested were {} to {}{}", each.column,
                    of, shown(from), shown(to), suffix, shown(*low), shown(*high), suffix);
    passed += (passed.empty() ? "" : "; ") + range;
    if (from < *low || to > *high)
      findings.add(Verdict::warn, range,
                   "Outside the tested range the answer rests on the formula, not on data. Test "
                   "there, or bound the distribution (lower, upper).");
  }
}

// The share of the posterior whose lives scatter too little for the finest rule.
double unresolved_share(const LifeDistribution& life, const WeightedDraws& posterior) {
  constexpr std::size_t points = 50;
  const ThinnedPosterior few(posterior, points);
  LifeAtPoint at = life.at_point();
  double share = 0;
  for (std::size_t i = 0; i < few.weights.size(); ++i) {
    at.move_to(few.values.row(static_cast<Eigen::Index>(i)).data());
    if (!at.resolved()) share += few.weights[i];
  }
  return share;
}

Check use_check(const FormulaModel& model, const std::vector<AskedUse>& uses, const Fit& fit) {
  constexpr double negligible = 0.01;
  Findings findings("use");
  std::string passed;
  for (const AskedUse& each : uses) {
    compare_with_tests(model, each, findings, passed);
    const double share = unresolved_share(*each.life, fit.exact ? fit.exact->nodes : fit.pooled);
    if (share > negligible)
      findings.add(
          Verdict::warn,
          fmt::format("under the conditions of predict.{} lives scatter far less than they differ "
                      "between units (in {:.0f} % of the posterior): the sum over units is coarse, "
                      "and early lives are not exact",
                      each.key, 100 * share),
          "Write the condition as values with shares, or narrow its distribution (lower, upper).");
  }
  return findings.result(passed);
}

}  // namespace

void add_use_check(const std::shared_ptr<const FormulaModel>& model,
                   const std::vector<AskedUse>& uses, PosteriorStudy& study) {
  std::vector<AskedUse> varied;
  for (const AskedUse& each : uses) {
    if (each.life && each.conditions.varied) varied.push_back(each);
  }
  if (varied.empty()) return;
  study.checks = [model, varied, own = study.checks](const Fit& fit) {
    std::vector<Check> all;
    if (own) all = own(fit);
    all.push_back(use_check(*model, varied, fit));
    return all;
  };
}

}  // namespace wearwell::formula_model
