#include "wearwell/selection/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/input/table.h"
#include "wearwell/present/page.h"
#include "wearwell/present/section.h"
#include "wearwell/selection/figures.h"
#include "wearwell/selection/text.h"

namespace wearwell {
namespace {

using html::number;
using present::Cell;
using present::count;
using present::digits;
using present::Figures;
using present::fixed;
using present::given;
using present::Prose;
using present::Section;
using present::Table;

constexpr std::size_t most_models = 100;  // of the table

std::string terms_of(const SelectionResult& result, const SubsetModel& model) {
  return fmt::format("{}", fmt::join(result.names(model.terms), " + "));
}

constexpr std::size_t figures_of_verdict = 2;  // of those by size

Section verdict_section(const SelectionResult& result) {
  const SearchResult& search = result.selection.search;
  const SubsetModel& best = search.models.front();
  const LinearFit& fit = result.selection.fit;
  Section section{"verdict", "Verdict"};
  section.add(Prose{fmt::format("{} = {}", result.response, terms_of(result, best)), true});
  section.add(
      search.certified
          ? present::Callout{"pass", "Proven.",
                             fmt::format("None of the {} submodels of {} terms has a better {}.",
                                         html::given(search.submodels), result.design.terms.size(),
                                         criterion_title(result.settings.search.criterion))}
          : present::Callout{"fail", "Not proven.", gap_sentence(result)});
  section.add(present::Tiles{
      {{"Terms", fmt::format("{}", best.terms.size()), "",
        fmt::format("of {} candidates", result.design.terms.size())},
       {"R2", number(fit.r2), "", fmt::format("adjusted {}", number(fit.adjusted_r2))},
       {"R2p", number(fit.r2p), "", "each row predicted without itself"},
       {"RMSE", number(fit.rmse), "",
        fmt::format("RMSEp, each row predicted without itself: {}", number(fit.rmsep))}}});
  std::vector<html::Figure> all = size_figures(result);
  all.resize(std::min(all.size(), figures_of_verdict));
  if (!all.empty()) section.add(Figures{std::move(all)});
  if (search.submodels > 1) {
    section.add(
        Prose{fmt::format("Unbiased for new data: {}.", nested_sentence(result.selection.nested))});
  }
  if (lacks_constant(result)) section.add(Prose{constant_sentence});
  return section;
}

Section size_section(const SelectionResult& result) {
  const SearchResult& search = result.selection.search;
  Table table{"sizes",
              "Best model of each size",
              {{"Terms", "1", given},
               {criterion_title(result.settings.search.criterion)},
               {"R2"},
               {"R2p"},
               {"Proven"},
               {"Changes from the previous size"}}};
  std::vector<int> before;
  for (std::size_t size = 1; size < search.by_size.size(); ++size) {
    if (!search.by_size[size].model) continue;
    const SubsetModel& model = *search.by_size[size].model;
    table.rows.push_back({count(size), model.criterion, model.r2, model.r2p,
                          search.by_size[size].proven ? "yes" : "no",
                          difference(result, model.terms, before)});
    before = model.terms;
  }
  Section section{"sizes", "All models", {}, "Models by their size"};
  std::vector<html::Figure> all = size_figures(result);
  all.erase(all.begin(), all.begin() + static_cast<long>(std::min(all.size(), figures_of_verdict)));
  if (!all.empty()) section.add(Figures{std::move(all)});
  section.add(std::move(table));
  if (std::any_of(search.by_size.begin() + 1, search.by_size.end(),
                  [](const SizeBest& each) { return each.model && !each.proven; })) {
    section.add(
        Prose{"If it is not proven, this is the best model found of that size; the proof of the "
              "best model does not depend on it."});
  }
  return section;
}

Section coefficient_section(const SelectionResult& result) {
  Table table{"coefficients",
              "Coefficients of the best model",
              {{"Term"},
               {"Scaled"},
               {"Standard error, scaled"},
               {"Original units"},
               {"Standard error"},
               {"In models found", "%", fixed(0)}}};
  for (const CoefficientRow& each : coefficient_rows(result)) {
    const auto of_scaled = [&](double x) { return each.selected ? Cell(x) : Cell(); };
    table.rows.push_back({each.term, of_scaled(each.scaled), of_scaled(each.scaled_error),
                          each.original, each.original_error, of_scaled(100 * each.inclusion)});
  }
  Section section{"coefficients", "Coefficients"};
  section.add(
      Prose{"Each term is scaled to the range 0 to 1 over the data, so that scaled coefficients "
            "are comparable: they give the change of the response over the range of the term. "
            "Standard errors ignore the selection of terms and are therefore too small."});
  section.add(std::move(table));
  return section;
}

Section model_section(const SelectionResult& result) {
  const Selection& selection = result.selection;
  const auto& models = selection.search.models;
  const bool folded = !selection.k_fold_press.empty();
  Table table{"models-found",
              "Models found, best first",
              {{"Rank", "1", given},
               {"Terms", "1", given},
               {criterion_title(result.settings.search.criterion), "1", digits(6)},
               {"R2"},
               {"R2p"},
               {"Weight", "1", fixed(2)}}};
  if (folded) table.columns.push_back({fmt::format("R2 in {} folds", result.settings.folds)});
  table.columns.push_back({"Changes from the best"});
  for (std::size_t m = 0; m < std::min(models.size(), most_models); ++m) {
    table.rows.push_back({count(m + 1), count(models[m].terms.size()), models[m].criterion,
                          models[m].r2, models[m].r2p, selection.weights[m]});
    if (folded) table.rows.back().emplace_back(1 - selection.k_fold_press[m] / selection.fit.tss);
    table.rows.back().emplace_back(
        m == 0 ? "" : difference(result, models[m].terms, models.front().terms));
  }
  Section section{"models", "Near the best", {}, "Models near the best"};
  section.add(Figures{support_figures(result)});
  section.add(std::move(table));
  if (models.size() > most_models)
    section.add(Prose{fmt::format("And {} more in models.csv.", models.size() - most_models)});
  return section;
}

Section method_section(const SelectionResult& result) {
  const SearchResult& search = result.selection.search;
  const SearchSettings& settings = result.settings.search;
  std::vector<std::pair<std::string, std::string>> facts = {
      {"Program", "wearwell " + result.version},
      {result.data_file, "SHA-1 " + result.data_sha1},
      {"Rows", fmt::format("{}", result.observed.size())},
      {"Criterion", criterion_title(settings.criterion)},
      {"Submodels", html::given(search.submodels)},
      {search.cloud.sizes.empty() ? "Branches visited" : "Models evaluated",
       html::given(search.nodes)},
      {"Lower bound", fmt::format("{:.10g}", search.lower_bound)},
      {"Time taken", fmt::format("{:.2f} s", search.seconds)}};
  if (!result.sql.empty()) facts.emplace_back("SQL", result.sql);
  if (!result.weights_column.empty()) facts.emplace_back("Rows weighted by", result.weights_column);
  if (!settings.forced.empty())
    facts.emplace_back("In every model",
                       fmt::format("{}", fmt::join(result.names(settings.forced), ", ")));
  for (const Dependence& each : search.dependences) {
    facts.emplace_back("Linearly dependent", fmt::format("{} is a combination of {}",
                                                         result.design.terms[each.column].name,
                                                         fmt::join(result.names(each.on), ", ")));
  }
  Section section{"method", "Method"};
  section.add(present::Facts{std::move(facts)});
  return section;
}

}  // namespace

std::string selection_report(const SelectionResult& result) {
  Section fit{"fit", "Fit"};
  fit.add(Figures{selection_fit_figures(result)});
  return html_page({result.version,
                    fmt::format("Terms of {}", result.response),
                    fmt::format("{} rows of {}{}", result.observed.size(), result.data_file,
                                remarks_suffix(result.data_remarks)),
                    {verdict_section(result), size_section(result), fit,
                     coefficient_section(result), model_section(result), method_section(result)}});
}

}  // namespace wearwell
