#include "wearwell/selection/result.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace wearwell {

std::vector<CoefficientRow> coefficient_rows(const SelectionResult& result) {
  const Selection& selection = result.selection;
  const OriginalCoefficients& original = selection.original;
  const auto& terms = selection.search.models.front().terms;
  std::vector<CoefficientRow> rows;
  bool has_constant = false;
  for (std::size_t j = 0; j < terms.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const Term& term = result.design.terms[terms[j]];
    const bool constant = term.factors.empty();
    has_constant = has_constant || constant;
    rows.push_back({term.name, true, selection.fit.coefficients[i],
                    selection.fit.standard_errors[i],
                    constant ? original.intercept : original.coefficients[i],
                    constant ? original.intercept_error : original.standard_errors[i],
                    selection.support[terms[j]].inclusion});
  }
  if (!has_constant)
    rows.push_back({"(intercept)", false, 0, 0, original.intercept, original.intercept_error, 0});
  return rows;
}

std::string criterion_title(Criterion criterion) {
  static constexpr const char* titles[] = {"PRESS", "AIC", "AICc", "BIC", "Cp", "adjusted R2"};
  return titles[static_cast<int>(criterion)];
}

std::string difference(const SelectionResult& result, const std::vector<int>& model,
                       const std::vector<int>& other) {
  std::vector<std::string> changes;
  const auto list = [&](const char* sign, const std::vector<int>& from,
                        const std::vector<int>& to) {
    for (const int term : from) {
      if (std::find(to.begin(), to.end(), term) == to.end())
        changes.push_back(fmt::format("{} {}", sign, result.design.terms[term].name));
    }
  };
  list("-", other, model);
  list("+", model, other);
  return fmt::format("{}", fmt::join(changes, " "));
}

}  // namespace wearwell
