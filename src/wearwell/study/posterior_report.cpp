#include "wearwell/study/posterior_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/study/figures.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/posterior_tables.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

using html::given;
using html::number;
using html::quantity;
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

std::string life_in_words(double x, const std::string& unit_text, int digits = 3) {
  return in_words(x, life_format(unit_text, digits));
}

// The life of the verdict where there is none until a limit: the last that was asked for.
const QuantitySummary* last_life(const PosteriorSummary& result) {
  const auto& all = result.quantities;
  const auto last = std::find_if(all.rbegin(), all.rend(), [](const auto& q) { return q.is_life; });
  return result.life || last == all.rend() ? nullptr : &*last;
}

// What a tribologist would say.
std::string verdict_sentence(const PosteriorSummary& result, const Plots& plots) {
  std::string sentence;
  const auto add = [&](const std::string& clause) {
    sentence += (sentence.empty() ? "" : "; ") + clause;
  };
  if (result.life) {
    const Life& life = result.life->best();
    add(fmt::format("the {} reaches the limit of {} after about {} {} (90 % interval {})",
                    plots.quantity, given_with_unit(result.life->limit, result.life->limit_unit),
                    life_in_words(life.b50, result.life->unit), result.life->unit,
                    range(life.q05, life.q95, 3)));
  }
  if (const QuantitySummary* life = last_life(result)) {
    const QuantityQuantiles& q = life->best();
    const std::string in = unit(life->unit);
    add(
        fmt::format("the {} of a {} {} is {} {} in the median (90 % interval {} to {}), and one in "
                    "ten has less than {} {}",
                    life->name, life->of, life->at, life_in_words(q.q50, life->unit), in,
                    life_in_words(q.q05, life->unit), life_in_words(q.q95, life->unit),
                    life_in_words(q.b10, life->unit), in));
  }
  if (!result.predictions.empty()) {
    const PredictionSummary& p = result.predictions.back();
    add(fmt::format("at {} {} the {} is {} (90 % interval {})", given(p.at), p.at_name,
                    plots.quantity, quantity(p.best().mean, p.unit, 3),
                    interval(p.best().ci05, p.best().ci95, p.unit, 3)));
  }
  const ParameterSummary& first = result.parameters.front();
  const ExactSummary k = first.best();
  add(fmt::format("the {} {} is {} (90 % interval {})", plots.parameters.front().meaning,
                  first.name, quantity(k.mean, first.unit, 3),
                  interval(k.q05, k.q95, first.unit, 3)));
  return html::capital(sentence) + ".";
}

void add_life_tiles(const LifeSummary& summary, std::vector<html::Tile>& tiles) {
  const Life& life = summary.best();
  tiles.push_back({"Life B10", life_in_words(life.b10, summary.unit), summary.unit,
                   fmt::format("one in ten reaches {} earlier",
                               given_with_unit(summary.limit, summary.limit_unit))});
  if (summary.passed_beyond_risk()) {
    tiles.push_back({"Limit passed already", fmt::format("{:.2g}", 100 * life.passed), "%",
                     fmt::format("probability after {}; tolerated: {} %", given(summary.now),
                                 given(100 * summary.risk))});
  }
  tiles.push_back({"Inspect again within", life_in_words(life.inspect_within, summary.unit),
                   summary.unit,
                   fmt::format("after {}, unless the limit is passed already; risk of reaching it "
                               "before: {} %",
                               given(summary.now), given(100 * summary.risk))});
}

Section verdict_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"verdict", "Verdict"};
  section.add(Prose{verdict_sentence(result, plots), true});
  section.add(trust_callout(result.checks));
  std::vector<html::Tile> tiles;
  if (result.life) add_life_tiles(*result.life, tiles);
  if (const QuantitySummary* life = last_life(result)) {
    tiles.push_back({"Life B10", life_in_words(life->best().b10, life->unit), unit(life->unit),
                     fmt::format("{} {}", life->of, life->at)});
  }
  if (!result.predictions.empty()) {
    const PredictionSummary& p = result.predictions.back();
    tiles.push_back(
        {fmt::format("{} at {} {}", html::capital(plots.quantity), given(p.at), p.at_name),
         number(p.best().mean, 3), unit(p.unit),
         fmt::format("one measurement: {}", interval(p.best().pi05, p.best().pi95, p.unit, 3))});
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(2, result.parameters.size()); ++i) {
    const ParameterSummary& p = result.parameters[i];
    const ExactSummary each = p.best();
    tiles.push_back({fmt::format("{}, {}", p.name, plots.parameters[i].meaning),
                     number(each.mean, 3), unit(p.unit),
                     fmt::format("90 % interval {}", range(each.q05, each.q95, 3))});
  }
  section.add(present::Tiles{std::move(tiles)});
  return section;
}

// What the trade shows there beyond that.
void add_exhibits(Section& section, const Plots& plots) {
  const auto found = plots.exhibits.find(section.id);
  if (found != plots.exhibits.end()) section.add(Figures{found->second});
}

Section prediction_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"predictions", "Predictions"};
  section.add(Figures{prediction_figures(result, plots)});
  if (!result.predictions.empty()) section.add(prediction_table(result));
  if (result.life) section.add(life_table(*result.life));
  if (auto table = quantity_table(result.quantities); !table.rows.empty()) section.add(table);
  if (auto table = bound_table(result.quantities); !table.rows.empty()) {
    section.add(Prose{
        "Posterior predictive: what holds for the next one, with all that is unknown averaged in. "
        "Lower bound: what holds for all such items at least, with the stated probability; 5, 50 "
        "and 95 % are of the same."});
    section.add(std::move(table));
  }
  add_exhibits(section, plots);
  if (auto table = stage_prediction_table(result); !table.rows.empty())
    section.add(Details{"Every prediction, data set by data set", {{std::move(table)}}});
  return section;
}

void add_mode(const ModeSummary& mode, Section& section) {
  if (!mode.problem.empty()) {
    section.add(Prose{fmt::format("The posterior has no mode: {}.", mode.problem)});
    return;
  }
  section.add(mode_table(mode));
  if (mode.profile()) {
    section.add(Prose{
        "The profile interval holds all values under which the likelihood, maximized over "
        "everything else, is not far below its maximum (by chi-square's quantile: Venzon and "
        "Moolgavkar 1988). It need not be symmetric, and does not change with the way in which a "
        "parameter is written."});
  }
  section.add(Prose{fmt::format(
      "Log-likelihood {:.3f}, AIC {:.2f}, BIC {:.2f} ({} observations, densities in SI units{}). "
      "Standard errors are those of the curvature there; a parameter on its bound counts as known.",
      mode.log_likelihood, mode.aic, mode.bic, given(mode.observations),
      mode.maximum_likelihood ? "" : "; the likelihood at the mode, not at its own maximum")});
}

Section parameter_section(const PosteriorSummary& result, const Plots& plots) {
  Section section{"parameters", "Parameters"};
  section.add(parameter_table(result.parameters));
  section.add(prior_table(result, plots));
  if (result.mode) add_mode(*result.mode, section);
  if (!result.stages.empty()) section.add(stage_table(result));
  section.add(Figures{parameter_figures(result, plots)});
  add_exhibits(section, plots);
  return section;
}

void add_coverage(const CoverageTable& coverage, Section& section) {
  std::size_t failures = 0, inside = 0;
  for (const CoverageRow& row : coverage.rows) {
    failures += row.failed();
    inside += row.failed() && row.inside();
  }
  section.add(
      Prose{fmt::format("{} of {} failures{} lie within the interval that should hold nine in ten.",
                        inside, failures, chosen_tests(coverage))});
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
        fmt::format("{} of {} measurements{} lie within the interval that should hold nine in ten.",
                    inside, r.at.size(),
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
    section.add(Prose{fmt::format(
        "Leave-one-out: expected log predictive density {:.2f}, standard error {:.2f}, {:.1f} "
        "effective parameters (natural logarithms, densities in SI units). Pareto k up to {:.2f} "
        "is good.",
        loo.elpd(), loo.se(), loo.p_loo(), loo.threshold)});
    section.add(Details{fmt::format("Every {} left out", result.loo->observation),
                        {{loo_table(*result.loo)}}});
  }
  add_exhibits(section, plots);
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
                              result.chains, result.draws, result.warmup)},
       {"Seed", fmt::format("{}", result.seed)}}};
  if (result.log_evidence)
    facts.facts.emplace_back("Log evidence", fmt::format("{:.4f}", *result.log_evidence));
  for (const DataFile& file : plots.files)
    facts.facts.emplace_back(file.name, "SHA-1 " + file.sha1);
  facts.facts.emplace_back("Time taken", fmt::format("{:.2f} s", plots.seconds));
  section.add(std::move(facts));
  if (result.parameters.front().exact) {
    section.add(
        Prose{"Where the posterior can be integrated by quadrature, intervals and predictions are "
              "those of quadrature and carry no sampling noise; the draws check them."});
  }
  section.add(Prose{
      "The same study file, data and seed give the same numbers to the bit, whatever the number of "
      "threads:"});
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
  return {verdict_section(result, plots),   prediction_section(result, plots),
          parameter_section(result, plots), fit_section(result, plots),
          check_section(result, plots),     method_section(result, plots)};
}

}  // namespace wearwell
