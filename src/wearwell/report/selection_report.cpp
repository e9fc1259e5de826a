#include "wearwell/report/selection_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/report/html.h"
#include "wearwell/report/page.h"
#include "wearwell/report/selection_figures.h"
#include "wearwell/report/selection_text.h"

namespace wearwell {
namespace {

using html::escape;
using html::number;

constexpr std::size_t most_models = 100;  // of the table

std::string terms_of(const SelectionResult& result, const SubsetModel& model) {
  return fmt::format("{}", fmt::join(result.names(model.terms), " + "));
}

std::string verdict_section(const SelectionResult& result) {
  const SearchResult& search = result.selection.search;
  const SubsetModel& best = search.models.front();
  const LinearFit& fit = result.selection.fit;
  std::string out = fmt::format("<p class=\"verdict\">{} = {}</p>\n", escape(result.response),
                                escape(terms_of(result, best)));
  out += search.certified
             ? html::callout("pass", "Proven.",
                             fmt::format("None of the {} submodels of {} terms has a better {}.",
                                         html::given(search.submodels), result.design.terms.size(),
                                         criterion_title(result.settings.search.criterion)))
             : html::callout("fail", "Not proven.", gap_sentence(result));
  out +=
      html::tiles({{"Terms", fmt::format("{}", best.terms.size()), "",
                    fmt::format("of {} candidates", result.design.terms.size())},
                   {"R2", number(fit.r2), "", fmt::format("adjusted {}", number(fit.adjusted_r2))},
                   {"R2p", number(fit.r2p), "", "each row predicted without itself"},
                   {"RMSE", number(fit.rmse), "",
                    fmt::format("RMSEp, each row without itself: {}", number(fit.rmsep))}});
  if (search.submodels > 1)
    out += fmt::format("<p>Honest for data to come: {}.</p>\n",
                       escape(nested_sentence(result.selection.nested)));
  if (lacks_constant(result)) out += fmt::format("<p>{}</p>\n", escape(constant_sentence));
  return out;
}

std::string size_section(const SelectionResult& result) {
  const SearchResult& search = result.selection.search;
  html::Table table{"Best model of each size",
                    {"Terms", criterion_title(result.settings.search.criterion), "R2", "R2p",
                     "Proven", "Changes from the size before"},
                    {}};
  std::vector<int> before;
  for (std::size_t size = 1; size < search.by_size.size(); ++size) {
    if (!search.by_size[size].model) continue;
    const SubsetModel& model = *search.by_size[size].model;
    table.rows.push_back({fmt::format("{}", size), number(model.criterion), number(model.r2),
                          number(model.r2p), search.by_size[size].proven ? "yes" : "no",
                          difference(result, model.terms, before)});
    before = model.terms;
  }
  std::string out = html::figures(size_figures(result)) + html::table(table);
  if (std::any_of(search.by_size.begin() + 1, search.by_size.end(),
                  [](const SizeBest& each) { return each.model && !each.proven; }))
    out +=
        "<p>Where it is not proven, this is the best model of that size that was found; the proof "
        "of "
        "the best model does not need it.</p>\n";
  return out;
}

std::string coefficient_section(const SelectionResult& result) {
  html::Table table{
      "Coefficients of the best model",
      {"Term", "Scaled", "Standard error", "Original units", "Standard error", "In models found"},
      {}};
  for (const CoefficientRow& each : coefficient_rows(result)) {
    table.rows.push_back({each.term, each.selected ? number(each.scaled) : "–",
                          each.selected ? number(each.scaled_error) : "–", number(each.original),
                          number(each.original_error),
                          each.selected ? fmt::format("{:.0f} %", 100 * each.inclusion) : "–"});
  }
  std::string out =
      "<p>Each term is scaled to run from 0 to 1 over the data, so that the scaled coefficients "
      "compare: how much the response changes over the range of the term. Standard errors take the "
      "choice of terms for granted and are too small by what the search has used up.</p>\n";
  return out + html::table(table);
}

std::string model_section(const SelectionResult& result) {
  const Selection& selection = result.selection;
  const auto& models = selection.search.models;
  html::Table table{
      "Models found, best first",
      {"Rank", "Terms", criterion_title(result.settings.search.criterion), "R2", "R2p", "Weight"},
      {}};
  if (!selection.k_fold_press.empty())
    table.heading.push_back(fmt::format("R2 in {} folds", result.settings.folds));
  table.heading.push_back("Changes from the best");
  for (std::size_t m = 0; m < std::min(models.size(), most_models); ++m) {
    table.rows.push_back({fmt::format("{}", m + 1), fmt::format("{}", models[m].terms.size()),
                          number(models[m].criterion, 6), number(models[m].r2),
                          number(models[m].r2p), fmt::format("{:.2f}", selection.weights[m])});
    if (!selection.k_fold_press.empty())
      table.rows.back().push_back(number(1 - selection.k_fold_press[m] / selection.fit.tss));
    table.rows.back().push_back(m == 0 ? ""
                                       : difference(result, models[m].terms, models.front().terms));
  }
  std::string out = html::figures(support_figures(result)) + html::table(table);
  if (models.size() > most_models)
    out += fmt::format("<p>And {} more in models.csv.</p>\n", models.size() - most_models);
  return out;
}

std::string method_section(const SelectionResult& result) {
  const SearchResult& search = result.selection.search;
  const SearchSettings& settings = result.settings.search;
  std::vector<std::pair<std::string, std::string>> facts = {
      {"Program", "wearwell " + result.version},
      {result.data_file, "SHA-1 " + result.data_sha1},
      {"Rows", fmt::format("{}", result.observed.size())},
      {"Criterion", criterion_title(settings.criterion)},
      {"Submodels", html::given(search.submodels)},
      {search.cloud.sizes.empty() ? "Branches looked at" : "Models looked at",
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
  std::string out = "<dl class=\"facts\">\n";
  for (const auto& [name, value] : facts)
    out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape(name), escape(value));
  return out + "</dl>\n";
}

}  // namespace

std::string selection_report(const SelectionResult& result) {
  return html_page({result.version,
                    fmt::format("Terms of {}", result.response),
                    fmt::format("{} rows of {}", result.observed.size(), result.data_file),
                    {{"verdict", "Verdict", verdict_section(result)},
                     {"sizes", "All models", size_section(result), "Models by their size"},
                     {"fit", "Fit", html::figures(selection_fit_figures(result))},
                     {"coefficients", "Coefficients", coefficient_section(result)},
                     {"models", "Near the best", model_section(result), "Models near the best"},
                     {"method", "Method", method_section(result)}}});
}

}  // namespace wearwell
