#include "wearwell/regress/selection.h"

#include <algorithm>

#include "wearwell/regress/k_fold.h"
#include "wearwell/regress/stacking.h"

namespace wearwell {
namespace {

/// The search has determined the rank; rounding must not change that here.
LinearFit fit_of(const SubsetModel& model, const Design& design, const Eigen::VectorXd& response,
                 const Eigen::VectorXd& weights) {
  return fit_least_squares(design.columns(Eigen::all, model.terms), response, weights, {},
                           0.5 * rank_tolerance);
}

std::vector<double> stack(const std::vector<SubsetModel>& models, std::size_t count,
                          const Design& design, const Eigen::VectorXd& response,
                          const Eigen::VectorXd& weights) {
  std::vector<std::size_t> usable;
  Eigen::MatrixXd residuals(response.size(), static_cast<Eigen::Index>(count));
  for (std::size_t m = 0; m < count; ++m) {
    const auto fit = fit_of(models[m], design, response, weights);
    if (!fit.loo_residuals.allFinite()) continue;
    residuals.col(static_cast<Eigen::Index>(usable.size())) = fit.loo_residuals;
    usable.push_back(m);
  }
  std::vector<double> stacked(count, 0);
  if (usable.empty()) return stacked;
  const auto found =
      stacking_weights(residuals.leftCols(static_cast<Eigen::Index>(usable.size())), weights);
  for (std::size_t i = 0; i < usable.size(); ++i)
    stacked[usable[i]] = found[static_cast<Eigen::Index>(i)];
  return stacked;
}

Nested nest(const Design& design, const Eigen::VectorXd& response, const Eigen::VectorXd& weights,
            const SelectionSettings& settings, const SearchResult& search) {
  Nested none;
  int folds = settings.nested;
  if (search.submodels <= 1) {
    none.problem = "there is nothing to search";
  } else if (folds == 0) {
    none.problem = "it was not requested";
  } else if (folds < 0 && response.size() > SelectionSettings::most_nested_rows) {
    none.problem = "with so many rows a search is hardly optimistic";
  } else if (!search.certified) {
    none.problem = "the search was stopped";
  }
  if (!none.problem.empty()) return none;
  if (folds < 0) folds = SelectionSettings::usual_nested;
  SearchSettings left = settings.search;
  left.seconds -= search.seconds;
  return nested_search(design.columns, response, weights, left, folds, settings.seed);
}

}  // namespace

Selection select_terms(const Design& design, const Eigen::VectorXd& response,
                       const Eigen::VectorXd& weights, const SelectionSettings& settings) {
  Selection selection;
  selection.search = search_subsets(design.columns, response, weights, settings.search);
  const auto& models = selection.search.models;
  selection.support.resize(design.terms.size());
  if (models.empty()) return selection;
  selection.fit = fit_of(models.front(), design, response, weights);
  selection.original = original_coefficients(design, models.front().terms,
                                             selection.fit.coefficients, selection.fit.covariance);
  const std::size_t count = std::min(models.size(), Selection::most_stacked);
  selection.weights = stack(models, count, design, response, weights);
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (const int term : models[m].terms) {
      ++selection.support[term].inclusion;
      if (m < count) selection.support[term].weight += selection.weights[m];
    }
  }
  for (TermSupport& each : selection.support) each.inclusion /= static_cast<double>(models.size());
  for (std::size_t m = 0; settings.folds > 0 && m < count; ++m) {
    selection.k_fold_press.push_back(k_fold_press(design.columns(Eigen::all, models[m].terms),
                                                  response, weights, settings.folds,
                                                  settings.fold_repeats, settings.seed));
  }
  selection.nested = nest(design, response, weights, settings, selection.search);
  return selection;
}

}  // namespace wearwell
