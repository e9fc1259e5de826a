#include "wearwell/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/report/figures.h"
#include "wearwell/report/html.h"
#include "wearwell/report/long_tables.h"
#include "wearwell/report/page.h"

namespace wearwell {
namespace {

using html::escape;
using html::given;
using html::number;
using html::quantity;
using html::range;
using html::unit;

std::string with_unit(const std::string& name, const std::string& unit_text) {
  return unit_text == "1" ? name : fmt::format("{} [{}]", name, unit(unit_text));
}

std::string interval(double low, double high, const std::string& unit_text, int digits) {
  const std::string u = unit(unit_text);
  return range(low, high, digits) + (u.empty() ? "" : "\u00a0" + u);
}

std::string names_of(const std::vector<Check>& checks, Verdict verdict) {
  std::string names;
  for (const Check& check : checks) {
    if (check.verdict == verdict) names += (names.empty() ? "" : ", ") + check.name;
  }
  return names;
}

const char* kind(Verdict verdict) {
  static constexpr const char* kinds[] = {"pass", "warn", "fail"};
  return kinds[static_cast<int>(verdict)];
}

const char* word(Verdict verdict) {
  static constexpr const char* words[] = {"Passed", "Warning", "Failed"};
  return words[static_cast<int>(verdict)];
}

Verdict worst(const StudyResult& result) {
  Verdict verdict = Verdict::pass;
  for (const Check& check : result.checks) verdict = std::max(verdict, check.verdict);
  return verdict;
}

std::string given(double x, const std::string& unit_text) {
  const std::string u = unit(unit_text);
  return u.empty() ? given(x) : given(x) + "\u00a0" + u;
}

// A life: no fraction of a cycle, but of a hundred thousand of them.
std::string life_number(double x, const std::string& unit_text, int digits = 4) {
  if (std::isinf(x)) return "never";
  if (unit_text.starts_with("1e")) return number(x, digits);
  const int whole = x >= 1 && std::isfinite(x) ? static_cast<int>(std::log10(x)) + 1 : digits;
  return number(x, std::min(digits, whole));
}

// The life that the verdict tells where there is none until a limit: the last that was asked for.
const QuantitySummary* told_life(const StudyResult& result) {
  const auto& all = result.quantities;
  const auto last = std::find_if(all.rbegin(), all.rend(), [](const auto& q) { return q.is_life; });
  return result.life || last == all.rend() ? nullptr : &*last;
}

// What a tribologist would say.
std::string verdict_sentence(const StudyResult& result, const Plots& plots) {
  std::string sentence;
  const auto add = [&](const std::string& clause) {
    sentence += (sentence.empty() ? "" : "; ") + clause;
  };
  if (result.life) {
    const Life& life = result.life->best();
    add(fmt::format("the {} reaches the limit of {} after about {} {} (90 % interval {})",
                    plots.quantity, given(result.life->limit, result.life->limit_unit),
                    life_number(life.b50, result.life->unit, 3), result.life->unit,
                    range(life.q05, life.q95, 3)));
  }
  if (const QuantitySummary* life = told_life(result)) {
    const QuantityQuantiles& q = life->best();
    const std::string in = unit(life->unit);
    add(
        fmt::format("the {} of a {} {} is {} {} in the median (90 % interval {} to {}), and one in "
                    "ten has less than {} {}",
                    life->name, life->of, life->at, life_number(q.q50, life->unit, 3), in,
                    life_number(q.q05, life->unit, 3), life_number(q.q95, life->unit, 3),
                    life_number(q.b10, life->unit, 3), in));
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

std::string trust_callout(const StudyResult& result) {
  const Verdict verdict = worst(result);
  if (!result.trusted) {
    std::string advice;
    for (const Check& check : result.checks) {
      if (check.verdict == Verdict::fail && !check.advice.empty()) advice += " " + check.advice;
    }
    return html::callout("fail", "Not trusted.",
                         fmt::format("Do not use these numbers as they stand: {} failed.{}",
                                     names_of(result.checks, Verdict::fail), advice));
  }
  if (verdict == Verdict::warn) {
    return html::callout(
        "warn", "Trusted, with a warning.",
        fmt::format("No check failed; look at {}.", names_of(result.checks, Verdict::warn)));
  }
  return html::callout("pass", "Trusted.",
                       fmt::format("All {} checks passed.", result.checks.size()));
}

std::string quantity_value(const QuantitySummary& summary, double x, int digits = 4) {
  return summary.is_life ? life_number(x, summary.unit, digits) : number(x, digits);
}

std::string verdict_section(const StudyResult& result, const Plots& plots) {
  std::string out =
      fmt::format("<p class=\"verdict\">{}</p>\n", escape(verdict_sentence(result, plots)));
  out += trust_callout(result);
  std::vector<html::Tile> tiles;
  if (result.life) {
    const LifeSummary& summary = *result.life;
    const Life& life = summary.best();
    tiles.push_back(
        {"Life B10", life_number(life.b10, summary.unit, 3), summary.unit,
         fmt::format("one in ten reaches {} earlier", given(summary.limit, summary.limit_unit))});
    if (summary.passed_beyond_risk()) {
      tiles.push_back({"Limit passed already", fmt::format("{:.2g}", 100 * life.passed), "%",
                       fmt::format("probability after {}; tolerated: {} %", given(summary.now),
                                   given(100 * summary.risk))});
    }
    tiles.push_back({"Inspect again within", life_number(life.inspect_within, summary.unit, 3),
                     summary.unit,
                     fmt::format("after {}, unless the limit is passed already; risk of reaching it before: {} %",
                                 given(summary.now), given(100 * summary.risk))});
  }
  if (const QuantitySummary* told = told_life(result)) {
    tiles.push_back({"Life B10", life_number(told->best().b10, told->unit, 3), unit(told->unit),
                     fmt::format("{} {}", told->of, told->at)});
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
  return out + html::tiles(tiles);
}

std::string prediction_table(const std::string& caption,
                             const std::vector<std::pair<std::size_t, PredictionSummary>>& rows) {
  const PredictionSummary& first = rows.front().second;
  html::Table table{caption,
                    {"Data sets", first.at_name, with_unit(first.quantity, first.unit),
                     "90 % of the " + (first.mean_of.empty() ? "mean" : first.mean_of),
                     first.mean_of.empty() ? "90 % of measurements"
                                           : "90 % of measurements of a " + first.measured_of,
                     "Measured"},
                    {}};
  for (const auto& [data_sets, p] : rows) {
    const Prediction& b = p.best();
    table.rows.push_back({fmt::format("{}", data_sets), given(p.at), number(b.mean),
                          range(b.ci05, b.ci95), range(b.pi05, b.pi95),
                          p.measured ? number(*p.measured) : "–"});
  }
  return html::table(table);
}

std::string life_table(const LifeSummary& summary) {
  const Life& life = summary.best();
  return html::table(
      {fmt::format("Life in {} until {}", summary.unit, given(summary.limit, summary.limit_unit)),
       {"B1", "B10", "B50", "90 % interval",
        fmt::format("Passed already [after {}]", given(summary.now)),
        fmt::format("If not, inspect within [risk {} %]", given(100 * summary.risk))},
       {{life_number(life.b1, summary.unit), life_number(life.b10, summary.unit),
         life_number(life.b50, summary.unit), range(life.q05, life.q95),
         probability_in_words(life.passed),
         fmt::format("{} after {}", life_number(life.inspect_within, summary.unit),
                     given(summary.now))}}});
}

std::string quantity_table(const std::vector<QuantitySummary>& quantities) {
  html::Table table{"What follows from the parameters",
                    {"Quantity", "Of", "Where", "5 %", "50 %", "95 %", "Safe end", "B1", "B10"},
                    {}};
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (q.predictive) continue;
    const auto value = [&](double x) { return quantity_value(each, x); };
    table.rows.push_back({with_unit(each.name, each.unit), each.of, html::raised(each.at),
                          value(q.q05), value(q.q50), value(q.q95),
                          each.safe_end ? fmt::format("{:.0f} %", 100 * *each.safe_end) : "–",
                          each.is_life ? value(q.b1) : "–", each.is_life ? value(q.b10) : "–"});
  }
  return table.rows.empty() ? "" : html::table(table);
}

// Properties of all items, for the next one and with a lower bound: two columns that are not to be
// mistaken for each other.
std::string bound_table(const std::vector<QuantitySummary>& quantities) {
  html::Table table;
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (!q.predictive) continue;
    if (table.heading.empty()) {
      table.heading = {"Quantity",
                       "Of",
                       "Where",
                       "Posterior predictive",
                       fmt::format("{} % lower bound", given(100 * *each.credible_level)),
                       "5 %",
                       "50 %",
                       "95 %"};
    }
    table.rows.push_back({with_unit(each.name, each.unit), each.of, html::raised(each.at),
                          number(*q.predictive), number(*q.bound), number(q.q05), number(q.q50),
                          number(q.q95)});
  }
  if (table.rows.empty()) return "";
  table.caption = "For the next one, and at least";
  return "<p>Posterior predictive: what holds for the next one, with all that is unknown averaged "
         "in. Lower bound: what holds for all such items at least, with the stated probability; 5, "
         "50 and 95 % are of the same.</p>\n" +
         html::table(table);
}

// Of a table with a row for each observation; the files hold all.
constexpr std::size_t most_rows = 1000;

std::string rest_note(std::size_t rows, const char* file) {
  if (rows <= most_rows) return "";
  return fmt::format("<p>The first {} of {}; all are in {}.</p>\n", given(most_rows),
                     given(static_cast<double>(rows)),
                     rows > most_rows_inline ? file : "summary.json");
}

std::string coverage_table(const CoverageTable& coverage) {
  html::Table table{"Every test, and the life that the fit predicts of it",
                    {"Row", "Type", "Outcome", with_unit("Life", coverage.unit), "Share below",
                     "90 % predictive interval", "B10", "Where it lies"},
                    {}};
  std::size_t failures = 0, inside = 0;
  for (const CoverageRow& row : coverage.rows) {
    failures += row.failed();
    inside += row.failed() && row.inside();
    if (table.rows.size() == most_rows) continue;
    table.rows.push_back({fmt::format("{}", row.row), row.label, row.outcome,
                          row.until ? range(row.life, *row.until) : number(row.life),
                          number(100 * row.probability, 3) + "\u00a0%", range(row.q05, row.q95),
                          number(row.b10),
                          !row.failed()     ? "–"
                          : row.below_b10() ? row.inside() ? "below B10" : "below B10, outside"
                          : row.inside()    ? "inside"
                                            : "outside"});
  }
  return fmt::format(
             "<p>{} of {} failures{} lie within the interval that should hold nine in ten.</p>\n",
             inside, failures, chosen_tests(coverage)) +
         html::table(table) + rest_note(coverage.rows.size(), coverage_table_file);
}

// What the trade shows there beyond that.
std::string exhibits(const Plots& plots, const std::string& section) {
  const auto found = plots.exhibits.find(section);
  if (found == plots.exhibits.end()) return "";
  std::string out = html::figures(found->second.figures);
  for (const html::Table& table : found->second.tables) out += html::table(table);
  return out;
}

std::string prediction_section(const StudyResult& result, const Plots& plots) {
  std::string out = html::figures(prediction_figures(result, plots));
  if (!result.predictions.empty()) {
    std::vector<std::pair<std::size_t, PredictionSummary>> rows;
    for (const PredictionSummary& p : result.predictions) rows.emplace_back(result.data_rows, p);
    out += prediction_table("Predictions from all data sets", rows);
  }
  if (result.life) out += life_table(*result.life);
  out += quantity_table(result.quantities) + bound_table(result.quantities);
  out += exhibits(plots, "predictions");
  if (!result.stages.empty()) {
    std::vector<std::pair<std::size_t, PredictionSummary>> rows;
    for (const StageSummary& stage : result.stages) {
      for (const PredictionSummary& p : stage.predictions) rows.emplace_back(stage.rows, p);
    }
    if (!rows.empty())
      out += html::details("Every prediction, data set by data set",
                           prediction_table("Predictions, data set by data set", rows));
  }
  return out;
}

std::string mode_table(const ModeSummary& mode) {
  if (!mode.problem.empty()) {
    return fmt::format("<p>The posterior has no mode: {}.</p>\n", escape(mode.problem));
  }
  html::Table table{mode.maximum_likelihood
                        ? "Maximum likelihood: where the density is highest under these flat priors"
                        : "Mode: where the posterior density is highest",
                    {"Parameter", "Mode", "Standard error"},
                    {}};
  const auto profile = mode.profile();
  const auto ends = [](const ProfileSummary& p) {
    const auto end = [](double value, const std::string& open) {
      return open.empty() ? number(value) : "open: " + open;
    };
    return std::vector<std::string>{end(p.lower, p.lower_open), end(p.upper, p.upper_open)};
  };
  if (profile) {
    const double percent = 100 * profile->level;
    table.heading.push_back(fmt::format("{:.4g} % profile interval from", percent));
    table.heading.emplace_back("to");
  }
  const auto add = [&](std::vector<std::string> row, const std::optional<ProfileSummary>& p) {
    if (profile) {
      const auto cells = p ? ends(*p) : std::vector<std::string>{"–", "–"};
      row.insert(row.end(), cells.begin(), cells.end());
    }
    table.rows.push_back(std::move(row));
  };
  for (const ModeParameter& p : mode.parameters) {
    add({with_unit(p.name, p.unit), number(p.value),
         p.at == "inside" ? number(p.standard_error, 3) : "on its " + p.at},
        p.profile);
  }
  for (const ModeQuantity& q : mode.quantities) {
    add({fmt::format("{} of {}{}{}", with_unit(q.name, q.unit), q.of, q.at.empty() ? "" : " ",
                     q.at),
         number(q.value), "–"},
        q.profile);
  }
  const std::string of_profile =
      profile ? "<p>The profile interval holds all values under which the likelihood, maximized "
                "over everything else, is not far below its maximum (by chi-square's quantile: "
                "Venzon and Moolgavkar 1988). It need not be symmetric, and does not change with "
                "the way in which a parameter is written.</p>\n"
              : "";
  return html::table(table) + of_profile +
         fmt::format(
             "<p>Log-likelihood {:.3f}, AIC {:.2f}, BIC {:.2f} ({} observations, densities in SI "
             "units{}). Standard errors are those of the curvature there; a parameter on its bound "
             "counts as known.</p>\n",
             mode.log_likelihood, mode.aic, mode.bic, given(mode.observations),
             mode.maximum_likelihood ? "" : "; the likelihood at the mode, not at its own maximum");
}

std::string loo_table(const LooSummary& summary) {
  const Loo& loo = summary.loo;
  html::Table table{
      fmt::format("How well each {} is predicted from all others", summary.observation),
      {html::capital(summary.observation), "Log density", "Log density with itself", "Pareto k"},
      {}};
  for (std::size_t i = 0; i < std::min(loo.terms.size(), most_rows); ++i) {
    const LooTerm& term = loo.terms[i];
    table.rows.push_back(
        {fmt::format("{}{}", i + 1, term.count == 1 ? "" : fmt::format(" ({}×)", term.count)),
         fmt::format("{:.3f}", term.elpd), fmt::format("{:.3f}", term.lpd),
         fmt::format("{:.2f}{}", term.khat,
                     term.refitted        ? ", fitted anew"
                     : loo.doubtful(term) ? ", too large"
                                          : "")});
  }
  return fmt::format(
             "<p>Leave-one-out: expected log predictive density {:.2f}, standard error {:.2f}, "
             "{:.1f} "
             "effective parameters (natural logarithms, densities in SI units). Pareto k up to "
             "{:.2f} is good.</p>\n",
             loo.elpd(), loo.se(), loo.p_loo(), loo.threshold) +
         html::details(fmt::format("Every {} left out", summary.observation),
                       html::table(table) + rest_note(loo.terms.size(), loo_table_file));
}

std::string parameter_section(const StudyResult& result, const Plots& plots) {
  html::Table table{
      "Parameters after all data sets",
      {"Parameter", "Mean", "MCSE", "Sd", "5 %", "50 %", "95 %", "Exact mean", "Exact sd"},
      {}};
  for (const ParameterSummary& p : result.parameters) {
    table.rows.push_back({with_unit(p.name, p.unit), number(p.mean), number(p.mcse, 2),
                          number(p.sd), number(p.q05), number(p.q50), number(p.q95),
                          p.exact ? number(p.exact->mean) : "–",
                          p.exact ? number(p.exact->sd) : "–"});
  }
  html::Table priors{"What was believed before", {"Parameter", "Meaning", "Prior"}, {}, true};
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    priors.rows.push_back({result.parameters[i].name, plots.parameters[i].meaning,
                           html::raised(plots.parameters[i].prior_in_words)});
  }
  std::string out = html::table(table) + html::table(priors);
  if (result.mode) out += mode_table(*result.mode);
  if (!result.stages.empty()) {
    html::Table stages{"Parameters, data set by data set", {"Data sets"}, {}};
    for (const ParameterSummary& p : result.parameters) {
      stages.heading.push_back(with_unit(p.name, p.unit));
      stages.heading.push_back("Sd");
      stages.heading.push_back("90 % interval");
    }
    stages.heading.push_back("Trusted");
    for (const StageSummary& stage : result.stages) {
      stages.rows.push_back({fmt::format("{}", stage.rows)});
      for (const ParameterSummary& p : stage.parameters) {
        const ExactSummary b = p.best();
        stages.rows.back().insert(stages.rows.back().end(),
                                  {number(b.mean), number(b.sd), range(b.q05, b.q95)});
      }
      std::string failed = names_of(stage.checks, Verdict::fail);
      stages.rows.back().push_back(stage.trusted ? "yes" : "no: " + failed);
    }
    out += html::table(stages);
  }
  return out + html::figures(parameter_figures(result, plots)) + exhibits(plots, "parameters");
}

std::string fit_section(const StudyResult& result, const Plots& plots) {
  std::string out =
      fmt::format("<p>{}</p>\n", escape(fmt::format("{}.", html::raised(result.equation))));
  const History& r = plots.replicated;
  const std::string at = plots.at_name, u = plots.unit;
  html::Table table{
      "Data, and what the fit says of them",
      {at, with_unit("Measured", u), "Fitted mean", "90 % of the mean", "90 % of measurements"},
      {}};
  std::size_t inside = 0;
  for (std::size_t i = 0; i < r.at.size(); ++i) {
    const double y = plots.measured[i];
    inside += r.pi05[i] <= y && y <= r.pi95[i];
    table.rows.push_back({given(r.at[i]), number(y), number(r.mean[i], 3),
                          range(r.ci05[i], r.ci95[i], 3), range(r.pi05[i], r.pi95[i], 3)});
  }
  if (!r.at.empty()) {
    const bool all = r.at.size() >= result.data_rows;
    out += fmt::format(
        "<p>{} of {} measurements{} lie within the interval that should hold nine in ten.</p>\n",
        inside, r.at.size(),
        all ? ""
            : fmt::format(", evenly among the {}, ", given(static_cast<double>(result.data_rows))));
    out += html::table(table) + html::figures(fit_figures(plots));
  }
  if (result.coverage) out += coverage_table(*result.coverage);
  if (result.pointwise) {
    const PointwiseTable& p = *result.pointwise;
    html::Table pointwise{"Wear coefficient of each measurement for itself",
                          {"cycles", with_unit("F", p.force_unit), with_unit("s", p.slip_unit),
                           with_unit("V", p.volume_unit), with_unit("k = V/(F s)", p.k_unit)},
                          {}};
    for (const PointwiseRow& row : p.rows) {
      if (pointwise.rows.size() == most_rows) break;
      pointwise.rows.push_back({given(row.cycles), number(row.force), number(row.slip),
                                number(row.volume), number(row.k)});
    }
    out += html::table(pointwise) + rest_note(p.rows.size(), pointwise_table_file);
  }
  if (result.loo) out += loo_table(*result.loo);
  return out + exhibits(plots, "fit");
}

std::string check_section(const StudyResult& result, const Plots& plots) {
  html::Table table{
      "Checks of the final posterior", {"Check", "Verdict", "What was found"}, {}, true};
  for (const Check& check : result.checks) {
    const std::string advice = check.advice.empty() ? "" : "\n" + html::raised(check.advice);
    table.rows.push_back({check.name, word(check.verdict), html::raised(check.detail) + advice});
    table.badges.push_back(kind(check.verdict));
  }
  html::Table draws{"Draws of each parameter",
                    {"Parameter", "R-hat", "Effective draws, centre", "Effective draws, tails"},
                    {}};
  for (const ParameterSummary& p : result.parameters) {
    draws.rows.push_back({p.name, fmt::format("{:.4f}", p.rhat), fmt::format("{:.0f}", p.ess_bulk),
                          fmt::format("{:.0f}", p.ess_tail)});
  }
  return html::table(table) + html::table(draws) + html::figures(sampler_figures(result, plots));
}

std::string method_section(const StudyResult& result, const Plots& plots) {
  std::vector<std::pair<std::string, std::string>> facts = {
      {"Program", "wearwell " + result.version},
      {"Model", result.model},
      {"Method", fmt::format("{}, {} chains of {} draws after {} of warm-up", result.method,
                             result.chains, result.draws, result.warmup)},
      {"Seed", fmt::format("{}", result.seed)}};
  if (result.log_evidence) {
    facts.emplace_back("Log evidence", fmt::format("{:.4f}", *result.log_evidence));
  }
  for (const DataFile& file : plots.files) facts.emplace_back(file.name, "SHA-1 " + file.sha1);
  facts.emplace_back("Time taken", fmt::format("{:.2f} s", plots.seconds));
  std::string out = "<dl class=\"facts\">\n";
  for (const auto& [name, value] : facts) {
    out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape(name), escape(value));
  }
  out += "</dl>\n";
  if (result.parameters.front().exact) {
    out +=
        "<p>Where the posterior can be integrated by quadrature, intervals and predictions are "
        "those of quadrature and carry no sampling noise; the draws check them.</p>\n";
  }
  out += fmt::format(
      "<p>The same study file, data and seed give the same numbers to the bit, whatever the number "
      "of threads: <code>wearwell fit {} --method {} --chains {} --warmup {} --draws {} "
      "--seed {}</code></p>\n",
      escape(plots.files.front().name), escape(result.method), result.chains, result.warmup,
      result.draws, result.seed);
  return out + html::details("Study file", fmt::format("<pre tabindex=\"0\">{}</pre>\n",
                                                       escape(plots.study_text)));
}

}  // namespace

std::string html_report(const StudyResult& result) {
  const Plots& plots = *result.plots;
  return html_page(
      {result.version,
       result.title,
       fmt::format("{}, {} data sets of {}", result.model, result.data_rows, result.data_file),
       {{"verdict", "Verdict", verdict_section(result, plots)},
        {"predictions", "Predictions", prediction_section(result, plots)},
        {"parameters", "Parameters", parameter_section(result, plots)},
        {"fit", "Fit", fit_section(result, plots)},
        {"checks", "Checks", check_section(result, plots)},
        {"method", "Method", method_section(result, plots), "Method and reproducibility"}}});
}

}  // namespace wearwell
