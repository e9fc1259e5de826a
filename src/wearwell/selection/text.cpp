#include "wearwell/selection/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/input/table.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t most_models = 20;  // of a table on the terminal

std::string number(double x) {
  return plain_number(x);
}

std::string coefficient_table(const SelectionResult& result) {
  Rows rows = {{"", "scaled", "std. error", "original units", "std. error", "in models"}};
  for (const CoefficientRow& each : coefficient_rows(result)) {
    rows.push_back({each.term, each.selected ? number(each.scaled) : "-",
                    each.selected ? number(each.scaled_error) : "-", number(each.original),
                    number(each.original_error),
                    each.selected ? fmt::format("{:.0f} %", 100 * each.inclusion) : "-"});
  }
  return text_table(rows);
}

std::string model_table(const SelectionResult& result) {
  const Selection& selection = result.selection;
  const auto& models = selection.search.models;
  Rows rows = {
      {"rank", "terms", criterion_title(result.settings.search.criterion), "R2", "R2p", "weight"}};
  const bool folds = !selection.k_fold_press.empty();
  if (folds) rows[0].push_back(fmt::format("R2 in {} folds", result.settings.folds));
  rows[0].emplace_back("changes from the best");
  for (std::size_t m = 0; m < std::min(models.size(), most_models); ++m) {
    rows.push_back({fmt::format("{}", m + 1), fmt::format("{}", models[m].terms.size()),
                    fmt::format("{:.6g}", models[m].criterion), number(models[m].r2),
                    number(models[m].r2p), fmt::format("{:.2f}", selection.weights[m])});
    if (folds) rows.back().push_back(number(1 - selection.k_fold_press[m] / selection.fit.tss));
    rows.back().push_back(difference(result, models[m].terms, models.front().terms));
  }
  std::string text = text_table(rows, true);
  if (models.size() > most_models)
    text += fmt::format("  and {} more\n", models.size() - most_models);
  return text;
}

/// Terms of at least one in ten of the models, most frequent first.
std::string support_table(const SelectionResult& result) {
  constexpr double rare = 0.1;
  const auto& support = result.selection.support;
  std::vector<int> terms;
  for (std::size_t t = 0; t < support.size(); ++t) {
    if (support[t].inclusion >= rare) terms.push_back(static_cast<int>(t));
  }
  std::stable_sort(terms.begin(), terms.end(),
                   [&](int a, int b) { return support[a].inclusion > support[b].inclusion; });
  Rows rows = {{"", "in models", "weight"}};
  for (const int t : terms)
    rows.push_back({result.design.terms[t].name,
                    fmt::format("{:.0f} %", 100 * support[t].inclusion),
                    fmt::format("{:.2f}", support[t].weight)});
  return text_table(rows);
}

std::string size_table(const SelectionResult& result) {
  Rows rows = {{"terms", "R2", "R2p", "proven", "changes from the previous size"}};
  std::vector<int> before;
  const auto& sizes = result.selection.search.by_size;
  for (std::size_t size = 1; size < sizes.size(); ++size) {
    if (!sizes[size].model) continue;
    const SubsetModel& model = *sizes[size].model;
    rows.push_back({fmt::format("{}", size), number(model.r2), number(model.r2p),
                    sizes[size].proven ? "yes" : "no", difference(result, model.terms, before)});
    before = model.terms;
  }
  return text_table(rows, true);
}

std::string best_by(Criterion criterion) {
  switch (criterion) {
    case Criterion::loo:
      return "leave-one-out";
    case Criterion::cp:
      return "Mallows' Cp";
    default:
      return criterion_title(criterion);
  }
}

}  // namespace

std::string nested_sentence(const Nested& nested) {
  if (!nested.problem.empty())
    return fmt::format(
        "R2p is that of the best model after a search: rows outside the search are predicted less "
        "well (by an unknown amount: {})",
        nested.problem);
  std::string text = fmt::format(
      "rows left out of the whole search ({} parts): R2 {} +- {}, RMSE {}", nested.folds,
      number(nested.r2), fmt::format("{:.1g}", nested.r2_error), number(nested.rmse));
  if (nested.unproven > 0)
    text += fmt::format("; {} of the searches were cut short and used their best model so far",
                        nested.unproven);
  return text;
}

bool lacks_constant(const SelectionResult& result) {
  const auto& terms = result.selection.search.models.front().terms;
  return std::none_of(terms.begin(), terms.end(), [&](int term) {
    return result.design.terms[static_cast<std::size_t>(term)].factors.empty();
  });
}

std::string gap_sentence(const SelectionResult& result) {
  const SearchResult& search = result.selection.search;
  const std::string title = criterion_title(result.settings.search.criterion);
  if (search.models.empty()) return "The search was stopped before it found a model.";
  const double best = search.models.front().criterion;
  if (result.settings.search.criterion == Criterion::adjr2)
    return fmt::format(
        "The search was stopped: the best model found has {} = {:.6g}; no model has a value above "
        "{:.6g}.",
        title, best, search.lower_bound);
  std::string gap = fmt::format("{:.4g}", best - search.lower_bound);
  if (result.settings.search.criterion == Criterion::loo)
    gap = fmt::format("{:.3g} %", 100 * (1 - search.lower_bound / best));
  return fmt::format(
      "The search was stopped: the best model found has {} = {:.6g}; no model has a value below "
      "{:.6g}, a gap of {}.",
      title, best, search.lower_bound, gap);
}

std::string selection_text(const SelectionResult& result) {
  const Selection& selection = result.selection;
  const SearchResult& search = selection.search;
  if (search.models.empty()) return gap_sentence(result) + "\n";
  const LinearFit& fit = selection.fit;
  constexpr double most_exact = 1e9;
  const std::string submodels = search.submodels < most_exact ? plain_given(search.submodels)
                                                              : plain_number(search.submodels);
  std::string text =
      fmt::format("{} = {}\n", result.response,
                  fmt::format("{}", fmt::join(result.names(search.models.front().terms), " + ")));
  text += fmt::format("  {} of {} terms, the best of {} submodels by {}{}\n",
                      search.models.front().terms.size(), result.design.terms.size(), submodels,
                      best_by(result.settings.search.criterion),
                      search.certified ? ": proven" : " found: NOT PROVEN");
  text += fmt::format(
      "  {} rows of {}{}{}\n", result.observed.size(), result.data_file,
      result.weights_column.empty() ? "" : fmt::format(", weighted by {}", result.weights_column),
      remarks_suffix(result.data_remarks));
  text += fmt::format("  R2 {}   R2p {}   RMSE {}   RMSEp {}\n", number(fit.r2), number(fit.r2p),
                      number(fit.rmse), number(fit.rmsep));
  if (search.submodels > 1) text += "  " + nested_sentence(selection.nested) + "\n";
  if (lacks_constant(result)) text += "  " + std::string(constant_sentence) + "\n";
  text += "\nCoefficients\n" + coefficient_table(result);
  text += "\nModels, best first\n" + model_table(result);
  if (result.settings.search.near > 0)
    text +=
        fmt::format("\nTerms of these {} models\n", search.models.size()) + support_table(result);
  if (search.truncated)
    text += fmt::format("  More than {} models are within the distance of {}.\n",
                        result.settings.search.near_most, result.settings.search.near);
  text += "\nBest of each size\n" + size_table(result);
  for (const Dependence& each : search.dependences) {
    text += fmt::format(
        "\n"
        "{} is a combination of {}: models with all of them were skipped.\n",
        result.design.terms[each.column].name, fmt::join(result.names(each.on), ", "));
  }
  text += '\n';
  if (!search.certified) text += gap_sentence(result) + "\n";
  text += fmt::format("{:.0f} {} in {:.2f} s\n", search.nodes,
                      search.cloud.sizes.empty() ? "nodes" : "models", search.seconds);
  return printable_lines(text);
}

}  // namespace wearwell
