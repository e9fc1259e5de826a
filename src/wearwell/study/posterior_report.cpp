#include "wearwell/study/posterior_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/study/answers.h"
#include "wearwell/study/bound_words.h"
#include "wearwell/study/density_unit.h"
#include "wearwell/study/figures.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/mean_tail.h"
#include "wearwell/study/never_reached.h"
#include "wearwell/study/posterior_tables.h"
#include "wearwell/study/row_tables.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

using html::given;
using html::number;
using html::range;
using html::unit;
using present::Details;
using present::Figures;
using present::Prose;
using present::Section;

std::string interval(double low, double high, const std::string& unit_text, int digits) {
  const std::string u = unit(unit_text);
  return range(low, high, digits) + (u.empty() ? "" : "\u00a0" + u);
}

std::string given_with_unit(double x, const std::string& unit_text) {
  const std::string u = unit(unit_text);
  return u.empty() ? given(x) : given(x) + "\u00a0" + u;
}

std::string life_text(double x, const std::string& unit_text, int digits = 3) {
  return std::isinf(x) ? "never" : description(x, life_format(unit_text, digits));
}

html::Tile life_tile(const std::string& name, double life, const std::string& unit_text,
                     const std::string& note) {
  return {name, life_text(life, unit_text), std::isinf(life) ? "" : unit(unit_text), note};
}

// The answers, one line each.
void add_answers(Section& section, const PosteriorSummary& result) {
  for (const std::string& each : answers(result, Script::page))
    section.add(Prose{html::capital(each) + ".", true});
}

// Adds the model's figures of a section.
std::vector<html::Figure> figures_of(const std::string& section, const Plots& plots) {
  const auto found = plots.figures.find(section);
  return found == plots.figures.end() ? std::vector<html::Figure>() : found->second;
}

void add_figures(Section& section, const Plots& plots) {
  if (auto figures = figures_of(section.id, plots); !figures.empty())
    section.add(Figures{std::move(figures)});
}

void add_life_tiles(const LifeSummary& summary, std::vector<html::Tile>& tiles) {
  const Life& life = summary.best();
  const std::string limit = given_with_unit(summary.limit, summary.limit_unit);
  tiles.push_back(life_tile("Life B10", life.b10, summary.unit,
                            std::isinf(life.b10)
                                ? "fewer than one in ten ever reach " + limit
                                : fmt::format("one in ten reaches {} earlier", limit)));
  if (summary.passed_beyond_risk()) {
    tiles.push_back({"Limit already passed", fmt::format("{:.2g}", 100 * life.passed), "%",
                     fmt::format("probability after {}; tolerated risk: {} %", given(summary.now),
                                 given(100 * summary.risk))});
  }
  tiles.push_back(life_tile(
      summary.now > 0 ? "Inspect again within" : "Inspect within", life.inspect_within,
      summary.unit,
      fmt::format("{}; {} % risk of reaching the limit before",
                  summary.now > 0
                      ? fmt::format("after {}, unless the limit is passed", given(summary.now))
                      : "of a new one",
                  given(100 * summary.risk))));
}

html::Tile headline_tile(const QuantitySummary& each) {
  const QuantityQuantiles& q = each.best();
  const std::string where =
      numbers_text(each.of + (each.at.empty() ? "" : " ") + each.at, Script::page);
  if (each.is_bounded()) {
    const std::string confidence =
        fmt::format("{}, with {} % confidence", where, given(100 * *each.credible_level));
    const bool both = q.bound && q.upper_bound;
    return {
        html::capital(each.name) + (both      ? ""
                                    : q.bound ? ", at least"
                                              : ", at most"),
        both ? range(*q.bound, *q.upper_bound, 3) : number(q.bound ? *q.bound : *q.upper_bound, 3),
        unit(each.unit), confidence};
  }
  if (each.is_life) return life_tile("Life B10", q.b10, each.unit, where);
  return {html::capital(each.name) + ", to design with",
          number(each.safe_end.value_or(0.05) < 0.5 ? q.q05 : q.q95, 3), unit(each.unit), where};
}

constexpr std::size_t most_headline_tiles = 4;

Section verdict_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"verdict", "Verdict"};
  add_answers(section, result);
  section.add(trust_callout(result.checks));
  std::vector<html::Tile> tiles;
  if (result.life) add_life_tiles(*result.life, tiles);
  for (const QuantitySummary* each : headlines(result)) {
    if (tiles.size() < most_headline_tiles) tiles.push_back(headline_tile(*each));
  }
  if (!result.predictions.empty()) {
    const PredictionSummary& p = result.predictions.back();
    tiles.push_back(
        {fmt::format("{} at {} {}", html::capital(result.quantity), given(p.at), p.at_word()),
         number(p.best().mean, 3), unit(p.unit),
         fmt::format("mean; one measurement: {}",
                     interval(p.best().pi05, p.best().pi95, p.unit, 3))});
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(2, result.parameters.size()); ++i) {
    const ParameterSummary& p = result.parameters[i];
    const ExactSummary each = p.best();
    if (const auto natural = of_logarithm(p)) {
      const bool has_article = natural->meaning.starts_with("the ");
      tiles.push_back({html::capital(natural->meaning.substr(has_article ? 4 : 0)),
                       number(natural->q50, 3), unit(natural->unit),
                       range(natural->q05, natural->q95, 3) + " (90\u00a0%)"});
      continue;
    }
    const ParameterValue value = headline_value(each);
    tiles.push_back({titled(p), number(value.value, 3), unit(p.unit),
                     (value.is_median ? "median; " : "mean; ") + range(each.q05, each.q95, 3) +
                         " (90\u00a0%)"});
  }
  section.add(present::Tiles{std::move(tiles)});
  std::vector<html::Figure> figures = answer_figures(result, plots);
  for (const html::Figure& each : figures_of(section.id, plots)) figures.push_back(each);
  if (!figures.empty()) section.add(Figures{std::move(figures)});
  if (!result.method_note.empty()) section.add(Prose{result.method_note + "."});
  if (const std::string defaults = default_priors(result.parameters); !defaults.empty()) {
    section.add(
        Prose{fmt::format("These priors are weak defaults: {} (see Parameters). If you know more, "
                          "state it in [prior].",
                          defaults)});
  }
  return section;
}

// Under the table that has the means.
void add_tails(const std::vector<QuantitySummary>& quantities, bool bounds, Section& section) {
  for (const std::string& each : mean_tail_remarks(quantities, bounds))
    section.add(present::Callout{"warn", "Mean", each});
}

// What the columns of the table of design values mean.
std::string design_values_text(const std::vector<QuantitySummary>& quantities) {
  const auto bounded = std::find_if(quantities.begin(), quantities.end(),
                                    [](const auto& each) { return each.best().predictive; });
  return html::capital(bound_sentence(quantities, given(100 * *bounded->credible_level) + " %",
                                      bounded->sides)) +
         " 5, 50 and 95 % are quantiles of the same value. Next one: the value for the next item, "
         "averaged over the posterior (predictive). It has no margin for few tests.";
}

Section prediction_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"predictions", "Predictions"};
  std::vector<html::Figure> figures = prediction_figures(result, plots);
  for (const html::Figure& each : figures_of(section.id, plots)) figures.push_back(each);
  if (!figures.empty()) section.add(Figures{std::move(figures)});
  if (!result.predictions.empty()) section.add(prediction_table(result));
  if (result.life) section.add(life_table(*result.life));
  if (auto table = bound_table(result.quantities); !table.rows.empty()) {
    section.add(Prose{design_values_text(result.quantities)});
    if (const std::string never = never_reached(result.quantities); !never.empty())
      section.add(Prose{never});
    section.add(std::move(table));
    add_tails(result.quantities, true, section);
  }
  if (auto table = quantity_table(result.quantities); !table.rows.empty()) {
    section.add(table);
    add_tails(result.quantities, false, section);
  }
  if (auto table = stage_prediction_table(result); !table.rows.empty())
    section.add(Details{"Every prediction, row by row", {{std::move(table)}}});
  return section;
}

void add_mode(const ModeSummary& mode, Section& section) {
  if (!mode.problem.empty()) {
    section.add(Prose{fmt::format("The posterior has no mode: {}.", mode.problem)});
    return;
  }
  section.add(mode_table(mode));
  if (mode.profile()) {
    section.add(
        Prose{"The profile interval contains the values whose profile likelihood is close to the "
              "maximum, by a quantile of chi-square (Venzon and Moolgavkar 1988). It can be "
              "asymmetric, and it does not depend on the parametrization."});
  }
  const std::string data_unit = DensityUnit::description(mode.density_unit);
  section.add(Prose{fmt::format(
      "Log-likelihood {:.3f}, AIC {:.2f}, BIC {:.2f} ({} observations{}{}). "
      "Standard errors follow from the curvature at the mode; a parameter at its bound counts as "
      "known.",
      mode.log_likelihood, mode.aic, mode.bic, given(mode.observations),
      data_unit.empty() ? "" : ", " + data_unit,
      mode.maximum_likelihood ? "" : "; the likelihood at the mode, not at its own maximum")});
}

Section parameter_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"parameters", "Parameters"};
  section.add(parameter_table(result.parameters));
  section.add(prior_table(result.parameters));
  if (result.mode) add_mode(*result.mode, section);
  if (!result.stages.empty()) section.add(stage_table(result));
  section.add(Figures{parameter_figures(result, plots)});
  add_figures(section, plots);
  return section;
}

void add_coverage(const CoverageTable& coverage, Section& section) {
  std::size_t failures = 0, inside = 0;
  for (const CoverageRow& row : coverage.rows) {
    failures += row.failed();
    inside += row.failed() && row.inside();
  }
  section.add(Prose{fmt::format("{} of {} failures{} lie within their 90 % intervals.", inside,
                                failures, chosen_tests(coverage))});
  section.add(coverage_table(coverage));
}

Section fit_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"fit", "Fit"};
  section.add(Prose{html::raised(result.equation) + "."});
  const History& r = plots.replicated;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < r.at.size(); ++i)
    inside += r.pi05[i] <= plots.measured[i] && plots.measured[i] <= r.pi95[i];
  if (!r.at.empty()) {
    const bool all = r.at.size() >= result.data_rows;
    section.add(Prose{
        fmt::format("{} of {} measurements{} lie within their 90 % intervals.", inside, r.at.size(),
                    all ? ""
                        : fmt::format(", evenly among the {}, ",
                                      given(static_cast<double>(result.data_rows))))});
    section.add(fit_table(plots));
    section.add(Figures{fit_figures(plots)});
  }
  if (result.coverage) add_coverage(*result.coverage, section);
  if (result.pointwise) section.add(pointwise_table(*result.pointwise));
  if (result.loo) {
    const Loo& loo = result.loo->loo;
    const std::string data_unit = DensityUnit::description(result.loo->density_unit);
    section.add(
        Prose{fmt::format("Leave-one-out: expected log predictive density {:.2f}, {}, {:.1f} "
                          "effective parameters (natural logarithms{}). Pareto k up to {:.2f} "
                          "is good.",
                          loo.elpd(), standard_error_text(loo), loo.p_loo(),
                          data_unit.empty() ? "" : ", " + data_unit, loo.threshold)});
    section.add(Details{fmt::format("Every {} left out", result.loo->observation),
                        {{loo_table(*result.loo)}}});
  }
  add_figures(section, plots);
  return section;
}

Section check_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"checks", "Checks"};
  section.add(checks_table(result.checks));
  section.add(draws_table(result.parameters));
  section.add(Figures{sampler_figures(result, plots)});
  return section;
}

Section method_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"method", "Method", {}, "Method and reproducibility"};
  present::Facts facts{
      {{"Program", "wearwell " + result.version},
       {"Model", result.model},
       {"Method", fmt::format("{}, {} chains of {} draws after {} of warm-up", result.method,
                              result.chains, given(result.draws), given(result.warmup))},
       {"Seed", fmt::format("{}", result.seed)}}};
  if (result.log_evidence)
    facts.facts.emplace_back("Log evidence",
                             fmt::format("{:.4f} {}", *result.log_evidence,
                                         DensityUnit::description(result.density_unit)));
  for (const DataFile& file : plots.files)
    facts.facts.emplace_back(file.name, "SHA-1 " + file.sha1);
  facts.facts.emplace_back("Time taken", fmt::format("{:.2f} s", plots.seconds));
  section.add(std::move(facts));
  if (result.parameters.front().exact) {
    section.add(
        Prose{"Intervals and predictions are computed by quadrature and carry no sampling noise; "
              "the draws check them."});
  }
  section.add(Prose{
      "The same study file, data and seed give identical numbers for any number of threads:"});
  section.add(present::Verbatim{
      fmt::format("wearwell fit {} --method {} --chains {} --warmup {} --draws {} --seed {}",
                  plots.files.front().name, result.method, result.chains, result.warmup,
                  result.draws, result.seed)});
  section.add(Details{"Study file", {{present::Verbatim{plots.study_text}}}});
  return section;
}

}  // namespace

std::vector<Section> report_sections(const PosteriorSummary& result) {
  const Plots& plots = *result.plots;
  std::vector<Section> sections = {
      verdict_section(result, plots),   prediction_section(result, plots),
      parameter_section(result, plots), fit_section(result, plots),
      check_section(result, plots),     method_section(result, plots)};
  for (Section& section : sections) {
    const auto added = result.added.blocks.find(section.id);
    if (added == result.added.blocks.end()) continue;
    section.blocks.insert(section.blocks.end(), added->second.begin(), added->second.end());
  }
  return sections;
}

}  // namespace wearwell
