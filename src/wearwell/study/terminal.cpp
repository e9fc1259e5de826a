#include "wearwell/study/terminal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "wearwell/base/printable.h"
#include "wearwell/input/table.h"
#include "wearwell/present/html.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/answers.h"
#include "wearwell/study/bound_words.h"
#include "wearwell/study/density_unit.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/mean_tail.h"
#include "wearwell/study/never_reached.h"
#include "wearwell/study/numerical_error.h"
#include "wearwell/study/posterior_tables.h"
#include "wearwell/study/terminal_histogram.h"
#include "wearwell/study/terminal_rows.h"
#include "wearwell/study/trust_blocks.h"

// Longer than others: all parts of one printed result.
namespace wearwell {
namespace {

std::string shown(const std::string& words) {
  return numbers_text(words, Script::terminal);
}

// Quadrature if available, else draws.
std::string parameter_table(const PosteriorSummary& result) {
  std::vector<std::vector<std::string>> rows = {{"", "mean", "sd", "5 %", "50 %", "95 %"}};
  for (const ParameterSummary& p : result.parameters) {
    const ExactSummary b = p.best();
    rows.push_back({printable_heading(p.name, p.unit), plain_number(b.mean), plain_number(b.sd),
                    plain_number(b.q05), plain_number(b.q50), plain_number(b.q95)});
  }
  std::string out = text_table(rows);
  const std::string defaults = default_priors(result.parameters);
  if (!defaults.empty()) {
    out += wrapped("default priors: " + printable(defaults) +
                       "; state what you know in [prior] (docs/reference/priors.md)",
                   2, 4);
  }
  return out;
}

std::string draws_lines(const std::vector<ParameterSummary>& parameters) {
  std::vector<std::vector<std::string>> rows = {{"", "mean", "MCSE", "sd", "ESS", "R-hat"}};
  for (const ParameterSummary& p : parameters) {
    rows.push_back({printable_heading(p.name, p.unit), plain_number(p.mean),
                    plain_number(p.mcse, 2), plain_number(p.sd),
                    plain_given(std::round(std::min(p.ess_bulk, p.ess_tail))),
                    fmt::format("{:.3f}", p.rhat)});
  }
  return text_table(rows);
}

std::string profile_ends(const ProfileSummary& profile) {
  const auto end = [](double value, const std::string& open) {
    return open.empty() ? plain_number(value) : "open";
  };
  if (profile.lower_open.empty() && profile.upper_open.empty())
    return plain_range(profile.lower, profile.upper);
  return end(profile.lower, profile.lower_open) + " to " + end(profile.upper, profile.upper_open);
}

std::string mode_lines(const ModeSummary& mode) {
  if (!mode.problem.empty()) return wrapped("no mode: " + printable(mode.problem), 2, 4);
  std::vector<std::vector<std::string>> rows = {{"", "at", "standard error"}};
  const auto profile = mode.profile();
  if (profile) rows[0].push_back(fmt::format("{:.4g} % profile interval", 100 * profile->level));
  for (const ModeParameter& p : mode.parameters) {
    rows.push_back({printable_heading(p.name, p.unit), plain_number(p.value),
                    p.at == "inside" ? plain_number(p.standard_error) : "on its " + p.at});
    if (profile) rows.back().push_back(p.profile ? profile_ends(*p.profile) : "-");
  }
  for (const ModeQuantity& q : mode.quantities) {
    rows.push_back({fmt::format("{} of {}{}{}", printable_heading(shown(q.name), q.unit), q.of,
                                q.at.empty() ? "" : " ", shown(q.at)),
                    plain_number(q.value), "-", profile_ends(q.profile)});
  }
  const std::string unit = DensityUnit::description(mode.density_unit);
  return text_table(rows) +
         fmt::format("  log-likelihood {:.3f}, AIC {:.2f}, BIC {:.2f}{}{}\n", mode.log_likelihood,
                     mode.aic, mode.bic, unit.empty() ? "" : ", " + printable(unit),
                     mode.maximum_likelihood ? "" : ", all computed at the mode");
}

std::string loo_lines(const LooSummary& summary) {
  const Loo& loo = summary.loo;
  const std::string unit = DensityUnit::description(summary.density_unit);
  return wrapped(
      fmt::format("each {} from all others: elpd {:.2f} ({}{}), effective "
                  "parameters {:.1f}{}",
                  printable(summary.observation), loo.elpd(), standard_error_text(loo),
                  unit.empty() ? "" : ", " + printable(unit), loo.p_loo(),
                  loo.by_quadrature ? "" : fmt::format(", Monte Carlo error {:.2g}", loo.error)),
      2, 4);
}

std::string prediction_rows(std::span<const PredictionSummary> predictions) {
  const PredictionSummary& first = predictions.front();
  std::vector<std::vector<std::string>> rows = {
      {printable_heading(first.at_name, first.at_unit.empty() ? "1" : first.at_unit),
       printable_heading(first.quantity, first.unit),
       first.mean_of.empty() ? "mean wear, 90 %" : first.mean_of + ", 90 %",
       first.mean_of.empty() ? "measurement, 90 %" : "reading of " + first.measured_of + ", 90 %",
       "measured"}};
  for (const PredictionSummary& each : predictions) {
    const Prediction& p = each.best();
    rows.push_back({plain_given(each.at), plain_number(p.mean), plain_range(p.ci05, p.ci95),
                    plain_range(p.pi05, p.pi95),
                    each.measured ? plain_number(*each.measured) : "-"});
  }
  return text_table(rows);
}

// One table for each measured quantity and each observed item.
std::string prediction_table(const std::vector<PredictionSummary>& predictions) {
  std::string tables;
  for (std::size_t begin = 0, end = 0; begin < predictions.size(); begin = end) {
    while (end < predictions.size() && predictions[end].is_like(predictions[begin])) ++end;
    tables += prediction_rows(std::span(predictions).subspan(begin, end - begin));
  }
  return tables;
}

int digits_of(const QuantityQuantiles& q) {
  return digits_within(q.numerical_error.value_or(0));
}

std::string b_value(const QuantitySummary& each, double x) {
  if (!each.is_life) return "-";
  return std::isinf(x) ? "never" : plain_number(x, digits_of(each.best()));
}

// The error of a table whose numbers are summed over few points of the posterior.
std::string error_line(const std::vector<QuantitySummary>& quantities, bool bounds) {
  const auto error = largest_numerical_error(quantities, bounds);
  if (!error) return "";
  return fmt::format("  Numerical error of these numbers: up to {} %\n",
                     plain_number(100 * *error, 2));
}

// Of the means of a table.
std::string tail_lines(const std::vector<QuantitySummary>& quantities, bool bounds) {
  std::string lines;
  for (const std::string& each : mean_tail_remarks(quantities, bounds))
    lines += wrapped(printable(shown(each)), 2, 4);
  return lines;
}

// Quantities of single items (new ones if items vary), grouped by name and condition. If there are
// lower bounds, they are the design values.
std::string quantity_lines(const std::vector<QuantitySummary>& quantities) {
  const QuantitySummary* bounded = first_bounded(quantities);
  const bool bounds = !bounded && std::any_of(quantities.begin(), quantities.end(),
                                              [](const auto& each) { return each.is_bounded(); });
  std::vector<std::vector<std::string>> rows = {{"", "5 %", "50 %", "95 %"}};
  if (bounded) {
    for (const std::string& name :
         bound_headings(fmt::format("{:.6g} %", 100 * *bounded->credible_level), bounded->sides))
      rows[0].push_back(name);
  } else if (!bounds) {
    rows[0].push_back("design with");
  }
  rows[0].insert(rows[0].end(), {"B1", "B10"});
  const bool means = std::any_of(quantities.begin(), quantities.end(),
                                 [](const auto& each) { return each.best().mean.has_value(); });
  if (means) rows[0].push_back("mean");
  std::string above;
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (q.predictive) continue;
    const std::string heading =
        printable_heading(shown(each.name), each.unit) + " " + printable(shown(each.at));
    if (heading != above) rows.push_back({heading});
    above = heading;
    const int digits = digits_of(q);
    const auto shown_value = [&](double x) {
      if (std::isnan(x) && q.mean) return std::string("-");  // only the mean is known
      return std::isinf(x) ? b_value(each, x) : plain_number(x, digits);
    };
    rows.push_back(
        {"  " + printable(each.of), shown_value(q.q05), shown_value(q.q50), shown_value(q.q95)});
    if (bounded) {
      for (const std::optional<double>& bound : {q.bound, q.upper_bound})
        if (bound) rows.back().push_back(shown_value(*bound));
      rows.back().resize(rows[0].size() - (means ? 3 : 2), "-");
    } else if (!bounds) {
      rows.back().push_back(!each.safe_end ? "-"
                                           : shown_value(*each.safe_end < 0.5 ? q.q05 : q.q95));
    }
    for (const double b : {q.b1, q.b10}) rows.back().push_back(b_value(each, b));
    if (means)
      rows.back().push_back(!q.mean              ? "-"
                            : is_endless_mean(q) ? not_finite_text
                                                 : shown_value(*q.mean));
  }
  if (rows.size() == 1) return "";
  return fmt::format("\n{}\n", bounds ? "Next item (predictive)" : results_title(quantities)) +
         text_table(rows) + error_line(quantities, false) + tail_lines(quantities, false);
}

// "never" for the life by which a share has failed, if it is not reached; a mean life is then not finite.
std::string share_life(const QuantitySummary& each, double x, int digits) {
  if (std::isinf(x) && x > 0 && is_b_life(each)) return "never";
  return std::isinf(x) && each.best().mean_tail ? not_finite_text : plain_number(x, digits);
}

// Properties of the population: the value for the next item and the bounds.
std::string bound_lines(const std::vector<QuantitySummary>& quantities) {
  std::vector<std::vector<std::string>> rows;
  std::string above, level;
  BoundSides sides = BoundSides::lower;
  bool seen = false;
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (!q.predictive) continue;
    level = fmt::format("{:.4g} %", 100 * *each.credible_level);
    sides = each.sides;
    seen |= each.name.ends_with("remaining useful life");
    if (rows.empty()) {
      rows.push_back({""});
      for (const std::string& name : bound_headings(level, sides)) rows.back().push_back(name);
      for (const char* name : {"5 %", "50 %", "95 %", "next one"}) rows.back().push_back(name);
    }
    const bool alone = each.at.starts_with("for ");  // a question of its own
    const std::string heading =
        alone ? printable_heading(shown(each.name), each.unit)
              : printable(each.of + (each.at.empty() ? "" : " ") + shown(each.at));
    if (heading != above) rows.push_back({heading});
    above = heading;
    const int digits = digits_of(q);
    rows.push_back({"  " + (alone ? printable(shown(each.at))
                                  : printable_heading(shown(each.name), each.unit))});
    for (const std::optional<double>& bound : {q.bound, q.upper_bound})
      if (bound) rows.back().push_back(share_life(each, *bound, digits));
    for (const double x : {q.q05, q.q50, q.q95}) rows.back().push_back(share_life(each, x, digits));
    rows.back().push_back(is_endless_mean(q) ? not_finite_text
                                             : share_life(each, *q.predictive, digits));
  }
  if (rows.empty()) return "";
  const std::string never = never_reached(quantities);
  return "\nDesign values\n" + text_table(rows) + error_line(quantities, true) +
         tail_lines(quantities, true) + (never.empty() ? "" : wrapped(never, 2, 4)) +
         wrapped(bound_sentence(quantities, level, sides), 2, 4) +
         wrapped(
             "next one: the value for the next item, averaged over the posterior (predictive). It "
             "has no margin for few tests: do not design with it.",
             2, 4) +
         (seen ? wrapped("For an item with readings, both refer to its own remaining useful life.",
                         2, 4)
               : "");
}

// The number of covered tests, and those outside.
std::string coverage_lines(const CoverageTable& table) {
  constexpr std::size_t most_named = 12;
  std::size_t failures = 0, inside = 0, outside = 0;
  std::string names;
  for (const CoverageRow& row : table.rows) {
    failures += row.failed();
    inside += row.failed() && row.inside();
    if (!row.failed() || row.inside() || ++outside > most_named) continue;
    names += fmt::format("{}row {}{} ({})", names.empty() ? "" : ", ", row.row,
                         row.label.empty() ? "" : " " + printable(row.label),
                         row.life < row.q05 ? "shorter" : "longer");
  }
  if (outside > most_named) names += fmt::format(" and {} more", outside - most_named);
  return wrapped(
      fmt::format("{} of {} failures{} lie inside their 90 % intervals{}", inside, failures,
                  chosen_tests(table), names.empty() ? "" : "; outside: " + names),
      2, 4);
}

std::string life_lines(const LifeSummary& summary) {
  const Life& life = summary.best();
  const std::string unit = printable(summary.unit);
  const auto count = [&](double x, int digits = 4) {
    if (std::isnan(x)) return std::string("unknown");
    return description(x, life_format(summary.unit, digits), Script::terminal);
  };
  const std::string lives = fmt::format(
      "{}{} to {} {}: B1 {}, B10 {}, B50 {}; {} to {} (90 %)", unit, printable(of_whom(summary)),
      plain_given(summary.limit), printable(summary.limit_unit), count(life.b1), count(life.b10),
      count(life.b50), count(life.q05), count(life.q95));
  const std::string passed = fmt::format(
      "after {} {} the limit is already passed with a probability of {}{}",
      plain_given(summary.now), unit, probability_text(life.passed),
      summary.passed_beyond_risk() ? fmt::format(", which exceeds the tolerated risk of {} %",
                                                 plain_given(100 * summary.risk))
                                   : "");
  const bool used = summary.now > 0;
  return wrapped(lives, 2, 4) + (used ? wrapped(passed, 2, 4) : "") +
         wrapped(fmt::format("inspect {} within {} {}{}: {} % risk of reaching the limit before",
                             used ? "again" : "a new one", count(life.inspect_within, 3), unit,
                             used ? ", unless the limit is passed" : "",
                             plain_given(100 * summary.risk)),
                 2, 4);
}

std::string painted(Verdict verdict, bool colour) {
  static constexpr const char* words[] = {"pass", "WARN", "FAIL"};
  static constexpr const char* codes[] = {"32", "33", "31"};
  const auto i = static_cast<int>(verdict);
  return colour ? fmt::format("\033[{}m{}\033[0m", codes[i], words[i]) : words[i];
}

std::string check_lines(const std::vector<Check>& checks, bool colour) {
  constexpr std::size_t name_width = 20, indent = 2 + 4 + 2 + name_width + 1;
  std::string out;
  for (const Check& check : checks) {
    const std::string detail =
        wrapped(printable(powers_text(check.detail, Script::terminal)), indent);
    out += fmt::format("  {}  {:<{}} {}", painted(check.verdict, colour), printable(check.name),
                       name_width, detail.substr(std::min(indent, detail.size() - 1)));
    if (!check.advice.empty()) out += wrapped("-> " + printable(check.advice), indent, indent + 3);
  }
  return out;
}

std::string answer_lines(const PosteriorSummary& result) {
  std::string out;
  for (const std::string& each : answers(result, Script::terminal))
    out += wrapped(html::capital(printable(each)) + ".", 2, 4);
  return out;
}

}  // namespace

std::string terminal_summary(const PosteriorSummary& result, const TerminalStyle& style) {
  std::string out = wrapped(printable(result.title), 0, 2) +
                    wrapped(printable(powers_text(result.equation, Script::terminal)), 2, 4) +
                    wrapped(fmt::format("{}: {} rows{}", printable(result.data_file),
                                        plain_given(static_cast<double>(result.data_rows)),
                                        printable(remarks_suffix(result.data_remarks))),
                            2, 4);
  if (!result.method_note.empty()) out += wrapped(result.method_note, 2, 4);
  const std::string trust = printable(trust_line(result.checks));
  out += "\n" + wrapped(trust, 0, 2);
  out += "\nAnswers\n" + answer_lines(result);
  if (result.life) out += "\nLife\n" + life_lines(*result.life);
  if (!result.predictions.empty()) out += "\nPredictions\n" + prediction_table(result.predictions);
  out += bound_lines(result.quantities) + quantity_lines(result.quantities);
  if (!result.added.text.empty()) out += "\n" + result.added.text;
  out += "\nParameters\n" + parameter_table(result);
  if (style.histograms) {
    out += '\n';
    out += histogram_lines(result);
  }
  if (result.mode)
    out += fmt::format("\n{}\n", result.mode->maximum_likelihood
                                     ? "Maximum likelihood (mode under flat priors)"
                                     : "Mode of the posterior") +
           mode_lines(*result.mode);
  if (result.loo) out += "\nLeave-one-out prediction\n" + loo_lines(*result.loo);
  if (result.coverage) out += "\nTests compared with the fit\n" + coverage_lines(*result.coverage);
  out += fmt::format("\nDraws ({}, {} chains of {})\n", result.method, result.chains,
                     plain_given(result.draws)) +
         draws_lines(result.parameters);
  out += row_tables(result, style.rows);
  // The text above may contain only line feeds as control characters; the text below also contains
  // colors.
  out = printable_lines(out);
  return out + "\nChecks\n" + check_lines(result.checks, style.colour) + "\n" +
         wrapped(trust, 0, 2);
}

}  // namespace wearwell
