#include "wearwell/study/terminal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/long_tables.h"

namespace wearwell {
namespace {

std::string number(double x) {
  return fmt::format("{:.4g}", x);
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return printable(unit == "1" ? name : fmt::format("{} [{}]", name, unit));
}

std::string parameter_table(const std::vector<ParameterSummary>& parameters) {
  std::vector<std::vector<std::string>> rows = {
      {"", "mean", "MCSE", "sd", "5 %", "50 %", "95 %", "ESS", "R-hat", "exact mean", "exact sd"}};
  for (const ParameterSummary& p : parameters) {
    rows.push_back({with_unit(p.name, p.unit), number(p.mean), fmt::format("{:.2g}", p.mcse),
                    number(p.sd), number(p.q05), number(p.q50), number(p.q95),
                    fmt::format("{:.0f}", std::min(p.ess_bulk, p.ess_tail)),
                    fmt::format("{:.3f}", p.rhat), p.exact ? number(p.exact->mean) : "-",
                    p.exact ? number(p.exact->sd) : "-"});
  }
  return text_table(rows);
}

std::string profile_ends(const ProfileSummary& profile) {
  const auto end = [](double value, const std::string& open) {
    return open.empty() ? number(value) : "open";
  };
  return end(profile.lower, profile.lower_open) + " .. " + end(profile.upper, profile.upper_open);
}

std::string mode_lines(const ModeSummary& mode) {
  if (!mode.problem.empty()) return fmt::format("  there is none: {}\n", printable(mode.problem));
  std::vector<std::vector<std::string>> rows = {{"", "at", "standard error"}};
  const auto profile = mode.profile();
  if (profile) rows[0].push_back(fmt::format("{:.4g} % profile interval", 100 * profile->level));
  for (const ModeParameter& p : mode.parameters) {
    rows.push_back({with_unit(p.name, p.unit), number(p.value),
                    p.at == "inside" ? number(p.standard_error) : "on its " + p.at});
    if (profile) rows.back().push_back(p.profile ? profile_ends(*p.profile) : "-");
  }
  for (const ModeQuantity& q : mode.quantities) {
    rows.push_back({fmt::format("{} of {}{}{}", with_unit(q.name, q.unit), q.of,
                                q.at.empty() ? "" : " ", q.at),
                    number(q.value), "-", profile_ends(q.profile)});
  }
  return text_table(rows) + fmt::format("  log-likelihood {:.3f}, AIC {:.2f}, BIC {:.2f}{}\n",
                                        mode.log_likelihood, mode.aic, mode.bic,
                                        mode.maximum_likelihood ? "" : ", all at the mode");
}

std::string mode_title(const ModeSummary& mode) {
  return mode.maximum_likelihood ? "Maximum likelihood (mode under flat priors)"
                                 : "Mode of the posterior";
}

std::string loo_lines(const LooSummary& summary) {
  const Loo& loo = summary.loo;
  return fmt::format(
      "  each {} from all others: elpd {:.2f} (standard error {:.2f}), effective parameters "
      "{:.1f}{}\n",
      printable(summary.observation), loo.elpd(), loo.se(), loo.p_loo(),
      loo.by_quadrature ? "" : fmt::format(", Monte Carlo error {:.2g}", loo.error));
}

// The draws of one parameter between their smallest and largest 0.5 %, in blocks of eight heights.
std::string histogram(const Draws& draws, Eigen::Index parameter) {
  static constexpr const char* blocks[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  constexpr std::size_t bins = 32;
  std::vector<double> values;
  for (const Chain& chain : draws) {
    for (const double value : chain.values.col(parameter)) values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 200;
  const double low = values[cut], high = values[values.size() - 1 - cut];
  std::vector<int> counts(bins, 0);
  for (const double value : values) {
    if (value < low || value > high) continue;
    const double share = high > low ? (value - low) / (high - low) : 0;
    ++counts[std::min(bins - 1, static_cast<std::size_t>(share * bins))];
  }
  const int highest = *std::max_element(counts.begin(), counts.end());
  std::string bars;
  for (const int count : counts) bars += blocks[count * 7 / highest];
  return fmt::format("{:>10.4g} {} {:.4g}", low, bars, high);
}

std::string histogram_lines(const PosteriorSummary& result) {
  std::size_t width = 0;
  for (const ParameterSummary& p : result.parameters) {
    width = std::max(width, with_unit(p.name, p.unit).size());
  }
  std::string out;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const ParameterSummary& p = result.parameters[i];
    out += fmt::format("  {:<{}}  {}\n", with_unit(p.name, p.unit), width,
                       histogram(result.posterior_draws, static_cast<Eigen::Index>(i)));
  }
  return out;
}

// The better of the two: quadrature where there is one.
std::string stage_table(const std::vector<StageSummary>& stages) {
  std::vector<std::vector<std::string>> rows = {{"data sets"}};
  for (const ParameterSummary& p : stages.front().parameters) {
    rows[0].push_back(with_unit(p.name, p.unit));
    rows[0].push_back("sd");
  }
  rows[0].push_back("trusted");
  for (const StageSummary& stage : stages) {
    rows.push_back({fmt::format("{}", stage.rows)});
    for (const ParameterSummary& p : stage.parameters) {
      rows.back().push_back(number(p.exact ? p.exact->mean : p.mean));
      rows.back().push_back(number(p.exact ? p.exact->sd : p.sd));
    }
    rows.back().push_back(stage.trusted ? "yes" : "no");
  }
  return text_table(rows);
}

std::string prediction_table(const std::vector<PredictionSummary>& predictions) {
  const PredictionSummary& first = predictions.front();
  std::vector<std::vector<std::string>> rows = {
      {first.at_name, with_unit(first.quantity, first.unit),
       first.mean_of.empty() ? "mean wear 5 %..95 %" : first.mean_of + " 5 %..95 %",
       first.mean_of.empty() ? "measurement 5 %..95 %"
                             : "measurement of a " + first.measured_of + " 5 %..95 %",
       "measured"}};
  for (const PredictionSummary& each : predictions) {
    const Prediction& p = each.best();
    rows.push_back({fmt::format("{}", each.at), number(p.mean),
                    fmt::format("{:.4g} .. {:.4g}", p.ci05, p.ci95),
                    fmt::format("{:.4g} .. {:.4g}", p.pi05, p.pi95),
                    each.measured ? number(*each.measured) : "-"});
  }
  return text_table(rows);
}

std::string quantity_table(const std::vector<QuantitySummary>& quantities) {
  std::vector<std::vector<std::string>> rows = {
      {"", "of the", "5 %", "50 %", "95 %", "safe end", "B1", "B10", "B50"}};
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (q.predictive) continue;
    rows.push_back({with_unit(each.name, each.unit) + " " + each.at, each.of, number(q.q05),
                    number(q.q50), number(q.q95),
                    each.safe_end ? fmt::format("{:.0f} %", 100 * *each.safe_end) : "-"});
    for (const double b : {q.b1, q.b10, q.b50}) {
      rows.back().push_back(each.is_life ? number(b) : "-");
    }
  }
  return rows.size() > 1 ? "\nDerived quantities\n" + text_table(rows) : "";
}

// Properties of all items: of the next one, and how far they can be relied on.
std::string bound_table(const std::vector<QuantitySummary>& quantities) {
  std::vector<std::vector<std::string>> rows;
  for (const QuantitySummary& each : quantities) {
    const QuantityQuantiles& q = each.best();
    if (!q.predictive) continue;
    if (rows.empty()) {
      rows.push_back({"", "of the", "posterior predictive",
                      fmt::format("{:.4g} % lower bound", 100 * *each.credible_level), "5 %",
                      "50 %", "95 %"});
    }
    rows.push_back({with_unit(each.name, each.unit) + (each.at.empty() ? "" : " ") + each.at,
                    each.of, number(*q.predictive), number(*q.bound), number(q.q05), number(q.q50),
                    number(q.q95)});
  }
  return rows.empty() ? ""
                      : "\nFor the next one (posterior predictive), and at least (lower bound)\n" +
                            text_table(rows);
}

// Of a table with a row for each observation; the files hold all.
constexpr std::size_t most_rows = 200;

std::string rest_line(std::size_t rows, const char* file) {
  if (rows <= most_rows) return "";
  return fmt::format("  ... and {} more{}\n", rows - most_rows,
                     rows > most_rows_inline ? fmt::format(" in {}", file) : "");
}

std::string coverage_table(const CoverageTable& table) {
  std::vector<std::vector<std::string>> rows = {{"row", "type", "outcome",
                                                 with_unit("life", table.unit), "share below",
                                                 "90 % predictive interval", "B10", ""}};
  std::size_t failures = 0, inside = 0;
  for (const CoverageRow& row : table.rows) {
    failures += row.failed();
    inside += row.failed() && row.inside();
    if (rows.size() > most_rows) continue;
    rows.push_back(
        {fmt::format("{}", row.row), row.label, row.outcome,
         row.until ? fmt::format("{:.4g} .. {:.4g}", row.life, *row.until) : number(row.life),
         fmt::format("{:.1f} %", 100 * row.probability),
         fmt::format("{:.4g} .. {:.4g}", row.q05, row.q95), number(row.b10),
         !row.failed()     ? ""
         : row.below_b10() ? row.inside() ? "below B10" : "below B10, outside"
         : row.inside()    ? ""
                           : "outside"});
  }
  return fmt::format("{}{}  {} of {} failures{} lie inside the 90 % intervals\n",
                     text_table(rows, true), rest_line(table.rows.size(), coverage_table_file),
                     inside, failures, chosen_tests(table));
}

// The digits that quadrature gives: four of a life, three of the difference of two.
std::string count(double x, int digits = 4) {
  if (std::isnan(x)) return "unknown";
  if (!std::isfinite(x)) return "never";
  const double last = std::pow(10, std::max(0.0, std::floor(std::log10(std::abs(x))) + 1 - digits));
  return fmt::format("{:.0f}", x == 0 ? x : std::round(x / last) * last);
}

std::string life_lines(const LifeSummary& summary) {
  const Life& life = summary.best();
  const std::string unit = printable(summary.unit);
  const std::string lives =
      fmt::format("  {} to {} {}:  B1 {}   B10 {}   B50 {}   (5 %..95 %: {} .. {})\n", unit,
                  number(summary.limit), printable(summary.limit_unit), count(life.b1),
                  count(life.b10), count(life.b50), count(life.q05), count(life.q95));
  const std::string passed = fmt::format(
      "  after {} {} the limit is passed already with a probability of {}{}\n", summary.now, unit,
      probability_in_words(life.passed),
      summary.passed_beyond_risk() ? fmt::format(": more than the risk of {} % that is tolerated",
                                                 number(100 * summary.risk))
                                   : "");
  return lives + passed +
         fmt::format(
             "  if it is not passed, inspect again within {} {}: {} % risk of reaching it before\n",
             count(life.inspect_within, 3), unit, number(100 * summary.risk));
}

std::string pointwise_table(const PointwiseTable& p) {
  std::vector<std::vector<std::string>> rows = {
      {"cycles", with_unit("F", p.force_unit), with_unit("s", p.slip_unit),
       with_unit("V", p.volume_unit), with_unit("k = V/(F s)", p.k_unit)}};
  for (const PointwiseRow& row : p.rows) {
    if (rows.size() > most_rows) break;
    rows.push_back({fmt::format("{}", row.cycles), number(row.force), number(row.slip),
                    number(row.volume), number(row.k)});
  }
  return text_table(rows) + rest_line(p.rows.size(), pointwise_table_file);
}

std::string painted(Verdict verdict, bool colour) {
  static constexpr const char* words[] = {"pass", "WARN", "FAIL"};
  static constexpr const char* codes[] = {"32", "33", "31"};
  const auto i = static_cast<int>(verdict);
  return colour ? fmt::format("\033[{}m{}\033[0m", codes[i], words[i]) : words[i];
}

std::string check_lines(const std::vector<Check>& checks, bool colour) {
  std::string out;
  for (const Check& check : checks) {
    out += fmt::format("  {}  {:<20} {}\n", painted(check.verdict, colour), printable(check.name),
                       printable(check.detail));
    if (!check.advice.empty()) {
      out += fmt::format("  {:>4}  {:<20} -> {}\n", "", "", printable(check.advice));
    }
  }
  return out;
}

}  // namespace

std::string terminal_summary(const PosteriorSummary& result, const TerminalStyle& style) {
  std::string out =
      fmt::format("{}\n  {}\n  {}: {} data sets\n", printable(result.title),
                  printable(result.equation), printable(result.data_file), result.data_rows);
  out += "\nParameters\n" + parameter_table(result.parameters);
  if (style.histograms) {
    out += '\n';
    out += histogram_lines(result);
  }
  if (result.mode)
    out += fmt::format("\n{}\n", mode_title(*result.mode)) + mode_lines(*result.mode);
  if (result.loo) out += "\nLeave-one-out prediction\n" + loo_lines(*result.loo);
  if (result.pointwise)
    out += "\nWear coefficient of each measurement\n" + pointwise_table(*result.pointwise);
  if (!result.stages.empty())
    out += "\nData set by data set (mean, sd)\n" + stage_table(result.stages);
  if (!result.predictions.empty()) out += "\nPredictions\n" + prediction_table(result.predictions);
  if (result.coverage) {
    out +=
        "\nTests, and the lives that the fit predicts of them\n" + coverage_table(*result.coverage);
  }
  out += quantity_table(result.quantities) + bound_table(result.quantities);
  if (result.life) out += "\nLife\n" + life_lines(*result.life);
  // Of all above, the line feeds are ours; below, the colours too.
  out = printable_lines(out);
  out += "\nChecks\n" + check_lines(result.checks, style.colour);
  out += result.trusted ? "\nTrusted: no check failed.\n"
                        : "\nNOT TRUSTED: at least one check failed; the numbers above are not to "
                          "be used as they stand.\n";
  return out;
}

}  // namespace wearwell
