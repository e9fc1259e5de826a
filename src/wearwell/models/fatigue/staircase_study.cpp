#include "wearwell/models/fatigue/staircase_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/prior.h"
#include "wearwell/math/root.h"
#include "wearwell/models/fatigue/read_outcome.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_parameters.h"
#include "wearwell/models/fatigue/staircase.h"
#include "wearwell/models/fatigue/staircase_fit.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/life_levels.h"
#include "wearwell/study/plot_study.h"

// Longer than others: one study, with its tests, limits, next test and figure.
namespace wearwell {
namespace {

using fatigue::StairTest;

struct StairData {
  std::vector<StairTest> tests;
  std::string stress_si = "Pa";  // of the stress quantity
  Unit unit;
  StandardDistribution limit = StandardDistribution::normal;
  std::vector<double> reliabilities = {0.5, 0.9};
  LifeLevels levels;  // of the bounds of the limits
};

// A stress whose logarithm has a posterior.
struct StressQuantiles {
  const QuantityDistribution& log10;
  double quantile(double p) const { return std::pow(10, log10.quantile(p)); }
};

void read_tests(const TomlReader& root, const Source& source, PosteriorStudy& study,
                StairData& data) {
  const TomlReader section = root.required_table("data");
  const TomlReader columns = section.required_table("columns");
  const Table table = read_table(section, source);
  data.stress_si = stated_driver_si(root, table);
  const ColumnChoice stress = required_column(columns, "alternating_stress", data.stress_si, table);
  const auto status = read_life_status(columns, table);
  if (!status) columns.fail("status", "is missing: the column of failures and run-outs");
  const auto count = read_column(columns, "count", "1", table);
  const std::vector<double> stresses = si_numbers(table, stress);
  const std::vector<double> counts = count ? si_numbers(table, *count) : std::vector<double>();
  data.unit = stress.unit;
  for (std::size_t i = 0; i < table.rows; ++i) {
    require(stresses[i] > 0, table, stress, i, "positive");
    const fatigue::Outcome outcome = read_outcome(table, *status, i);
    const bool failed = outcome == fatigue::Outcome::failure;
    if (!failed && outcome != fatigue::Outcome::runout)
      throw InputError(fmt::format("{}: a staircase test has only failure and runout",
                                   place(table, status->column, i)));
    const double n = count ? counts[i] : 1;
    if (count)
      require(n >= 1 && n <= 1e6 && n == std::floor(n), table, *count, i,
              "a whole number of at least 1");
    data.tests.push_back({stresses[i], failed, static_cast<int>(n)});
    study.observed.insert(study.observed.end(), {stresses[i], failed ? 1.0 : 0.0, n});
  }
  study.data_columns.push_back({"alternating_stress", data.stress_si, stress.unit, stresses, true});
  study.data_layout = table.layout;
  study.data_rows = data.tests.size();
  study.density.text = "1";
}

void read_wishes(const TomlReader& root, StairData& data) {
  if (const auto law = root.table("law")) {
    const std::vector<std::string> families = {"normal", "smallest-extreme-value"};
    if (law->choice("limit_family", families) == families[1])
      data.limit = StandardDistribution::smallest_extreme_value;
  }
  const auto predict = root.table("predict");
  if (!predict) return;
  const auto share = [&](const char* key, const Quantity& quantity) {
    if (!(quantity.si() > 0 && quantity.si() < 1))
      predict->fail(key, "must lie between 0 and 1 (or 0 % and 100 %)");
    return quantity.si();
  };
  if (predict->has("reliability")) data.reliabilities.clear();
  for (const Quantity& each : predict->quantities("reliability", "1"))
    data.reliabilities.push_back(share("reliability", each));
  if (predict->has("b_lives"))
    predict->fail("b_lives",
                  "are of lives, but a staircase measures a fatigue limit: write reliability, the "
                  "share that survives");
  data.levels = read_life_levels(*predict);
}

double log10_limit(const StairData& data, const double* x, double reliability) {
  return x[0] + x[1] * quantile(data.limit, 1 - reliability);
}

// The stress [Pa] that the next item survives with this probability.
double next_limit(const StairData& data, const WeightedDraws& draws, double reliability) {
  const auto excess = [&](double log10) {
    double broken = 0;
    for (Eigen::Index i = 0; i < draws.values.rows(); ++i)
      broken +=
          draws.weights[i] * cdf(data.limit, (log10 - draws.values(i, 0)) / draws.values(i, 1));
    return broken - (1 - reliability);
  };
  return std::pow(10, solve_increasing(excess, std::log10(data.tests[0].stress), 0.1,
                                       {.absolute = 1e-9}, -300, 300));
}

void add_limits(const StairData& data, PosteriorStudy& study) {
  const double most = *std::max_element(data.reliabilities.begin(), data.reliabilities.end());
  for (const double reliability : data.reliabilities) {
    QuantityRequest request{};
    request.name = "fatigue limit";
    request.of = "specimen";
    request.at = fmt::format("for {:.6g} % to survive", 100 * reliability);
    request.unit = data.unit;
    ask_bounds(data.levels, request);
    request.safe_end = 0.05;
    request.headline = reliability == most;
    study.quantity_groups.push_back(
        {{request}, [=](const WeightedDraws& draws) {
           const QuantityDistribution limit(
               draws, [&](const double* x) { return log10_limit(data, x, reliability); });
           const StressQuantiles at{limit};
           QuantityQuantiles q{at.quantile(0.05), at.quantile(0.5), at.quantile(0.95), 0, 0, 0};
           q.predictive = next_limit(data, draws, reliability);
           add_bounds(at, data.levels, q);
           return std::vector<QuantityQuantiles>{q};
         }});
  }
}

// The expected remaining uncertainty of the requested limit after one more test at a stress.
struct NextTest {
  double stress = 0, failure = 0;  // Pa, its probability
  double sd = 0;                   // of log10 of the limit, expected after it
};

std::vector<NextTest> next_tests(const StairData& data, const WeightedDraws& draws,
                                 double reliability, double& before) {
  std::set<double> stresses;
  for (const StairTest& test : data.tests) stresses.insert(test.stress);
  const double low = *stresses.begin(), high = *stresses.rbegin();
  const double step = (high - low) / std::max<double>(1, static_cast<double>(stresses.size()) - 1);
  if (step > 0 && low > step) stresses.insert(low - step);
  if (step > 0) stresses.insert(high + step);
  std::vector<NextTest> tests;
  for (const double stress : stresses) {
    // Weight, mean and square of the limit: over all items, and over those that fail.
    double sums[2][3] = {};
    for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
      const double* x = draws.values.row(i).data();
      const double y = log10_limit(data, x, reliability), w = draws.weights[i];
      const double fails = cdf(data.limit, (std::log10(stress) - x[0]) / x[1]);
      for (int k = 0; k < 2; ++k) {
        const double weight = k == 0 ? w * fails : w * (1 - fails);
        sums[k][0] += weight;
        sums[k][1] += weight * y;
        sums[k][2] += weight * y * y;
      }
    }
    NextTest test{stress, sums[0][0], 0};
    double variance = 0;
    for (const auto& s : sums) variance += s[0] > 0 ? s[2] - s[1] * s[1] / s[0] : 0;
    test.sd = std::sqrt(std::max(0.0, variance));
    const double mean = sums[0][1] + sums[1][1];
    before = std::sqrt(std::max(0.0, sums[0][2] + sums[1][2] - mean * mean));
    tests.push_back(test);
  }
  return tests;
}

// The failure probability against stress, with the share of failed tests at each.
html::Figure failure_figure(const StairData& data, const WeightedDraws& all) {
  namespace colour = plot::colour;
  constexpr Eigen::Index most_draws = 4000;
  constexpr int points = 60;
  const WeightedDraws draws = thinned(all, most_draws);
  std::map<double, std::pair<double, double>> levels;  // stress: tests, failures
  for (const StairTest& test : data.tests) {
    levels[test.stress].first += test.count;
    levels[test.stress].second += test.failed ? test.count : 0;
  }
  const double most = *std::max_element(data.reliabilities.begin(), data.reliabilities.end());
  const QuantityDistribution limit(draws,
                                   [&](const double* x) { return log10_limit(data, x, most); });
  const bool lower = has_lower(data.levels.sides);
  const double bound =
      StressQuantiles{limit}.quantile(lower ? data.levels.below() : 1 - data.levels.below());
  const double low =
      std::min(0.95 * levels.begin()->first, std::max(bound, 0.5 * levels.begin()->first) / 1.03);
  const double high = std::max(1.05 * levels.rbegin()->first, lower ? 0 : 1.03 * bound);
  std::vector<double> x, low_share, middle, high_share, at, share, tests;
  for (int i = 0; i <= points; ++i) {
    const double stress = std::lerp(low, high, static_cast<double>(i) / points);
    const QuantityDistribution fails(draws, [&](const double* p) {
      return cdf(data.limit, (std::log10(stress) - p[0]) / p[1]);
    });
    x.push_back(from_si(data.unit, stress));
    low_share.push_back(100 * fails.quantile(0.05));
    middle.push_back(100 * fails.quantile(0.5));
    high_share.push_back(100 * fails.quantile(0.95));
  }
  for (const auto& [stress, counts] : levels) {
    at.push_back(from_si(data.unit, stress));
    share.push_back(100 * counts.second / counts.first);
    tests.push_back(counts.first);
  }
  const std::string unit = html::unit(data.unit.text);
  const std::string bound_name =
      fmt::format("{:.6g} % survive, at {} with {:.6g} %", 100 * most, lower ? "least" : "most",
                  100 * (1 - data.levels.below()));
  return {
      "failure-probability", "Failure probability against stress",
      "The line is the posterior median with its 90 % band. Points are the shares of failed tests "
      "at each stress.",
      plot::plot("Failure probability against alternating stress, with the shares of the tests",
                 {"Alternating stress" + (unit.empty() ? "" : " [" + unit + "]"), false, x.front(),
                  x.back()},
                 {"Fails [%]", false, 0.0, 100.0},
                 {plot::area({{"x", x}, {"y", high_share}, {"y2", low_share}},
                             {colour::posterior, "90 % of the probability", 0.28}),
                  plot::line({{"x", x}, {"y", middle}, {"stress", x}, {"fails [%]", middle}},
                             {colour::posterior, "median", 1, 2}),
                  plot::vertical_line(from_si(data.unit, bound),
                                      {colour::limit, bound_name, 1, 1.5, true}),
                  plot::points({{"x", at}, {"y", share}, {"failed [%]", share}, {"tests", tests}},
                               {colour::measured, "share that failed", 1, 0, false, 70})},
                 320, true)};
}

PresetAddition addition(const StairData& data, const WeightedDraws& draws) {
  PresetAddition added;
  const auto in_unit = [&](double si) { return from_si(data.unit, si); };
  const fatigue::DixonMood classical = fatigue::dixon_mood(data.tests);
  const std::string comparison =
      classical.problem.empty()
          ? fmt::format(
                "Dixon and Mood (1948), by the {} only: mean {:.5g} {}, standard deviation {:.3g} "
                "{}{}. With few tests its standard deviation is usually too small, and it has no "
                "interval.",
                classical.of_failures ? "failures" : "run-outs", in_unit(classical.mean),
                data.unit.text, in_unit(classical.sd), data.unit.text,
                classical.crude_sd ? " (the method gives 0.53 of a step here)" : "")
          : fmt::format("Dixon and Mood's estimate does not apply: {}.", classical.problem);
  const double most = *std::max_element(data.reliabilities.begin(), data.reliabilities.end());
  double before = 0;
  const std::vector<NextTest> tests = next_tests(data, draws, most, before);
  present::Table table{
      "next-test",
      fmt::format("Information of one more test on the limit for {:.6g} %", 100 * most),
      {{"at", data.unit.text},
       {"fails", "%", present::digits(3)},
       {"less spread of log10 limit", "%", present::digits(3)}}};
  std::vector<std::vector<std::string>> rows = {
      {"  at [" + data.unit.text + "]", "fails [%]", "spread of the limit, less [%]"}};
  for (const NextTest& test : tests) {
    const double less = 100 * (1 - test.sd / before);
    table.rows.push_back({in_unit(test.stress), 100 * test.failure, less});
    rows.push_back({"  " + plain_given(in_unit(test.stress)), plain_number(100 * test.failure, 2),
                    plain_number(less, 2)});
  }
  added.blocks["predictions"] = {{present::Prose{comparison}}, {table}};
  added.text = "For comparison\n" + wrapped(comparison, 2, 4) + "\n" +
               fmt::format("Information of one more test on the limit for {:.6g} %\n", 100 * most) +
               text_table(rows);
  nlohmann::ordered_json json;
  if (classical.problem.empty()) {
    json["dixon_mood"] = {{"mean", in_unit(classical.mean)},
                          {"sd", in_unit(classical.sd)},
                          {"unit", data.unit.text},
                          {"crude_sd", classical.crude_sd}};
  } else {
    json["dixon_mood"] = {{"problem", classical.problem}};
  }
  json["next_test"] = nlohmann::ordered_json::array();
  for (const NextTest& test : tests)
    json["next_test"].push_back({{"stress", in_unit(test.stress)},
                                 {"failure", test.failure},
                                 {"sd_ratio", test.sd / before}});
  added.body["staircase"] = std::move(json);
  return added;
}

}  // namespace

void read_staircase_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  StairData data;
  read_wishes(root, data);
  read_tests(root, source, study, data);
  if (study.stages)
    root.required_table("update").fail("stages", "is not possible for model \"staircase\"");
  double mean = 0, tests = 0, failed = 0;
  for (const StairTest& test : data.tests) {
    mean += test.count * std::log10(test.stress);
    tests += test.count;
    failed += test.failed ? test.count : 0;
  }
  mean /= tests;
  const auto priors = root.table("prior");
  const auto read = [&](ParameterSpec spec, DefaultPrior fallback) {
    spec.fallback = std::move(fallback);
    return read_driver_prior(root, priors, spec, data.stress_si, data.unit);
  };
  // For a plain number, a strain or a share of the strength, logarithms are plain numbers too.
  const bool plain = data.stress_si == "1";
  study.parameters.push_back(
      read({"log10_limit", plain ? "1" : fmt::format("log10({})", data.stress_si), -INFINITY,
            INFINITY, mean},
           {"normal", Normal{mean, 0.3}, plain ? "1" : fmt::format("log10({})", data.unit.text)}));
  study.parameters.push_back(
      read({"sigma_limit", "1", 0, INFINITY, 0.03}, {"half-normal", HalfNormal{0.1}, "1"}));
  study.meanings = {"logarithm of the median fatigue limit",
                    "scatter of the logarithm of the fatigue limit"};
  study.equation =
      data.limit == StandardDistribution::normal
          ? "a test fails if the stress is above its item's limit; log10 of the limit is normal"
          : "a test fails if the stress is above its item's limit; log10 of the limit has a "
            "smallest extreme value distribution";
  study.quantity = "outcome";
  study.data_notes = {
      fmt::format("{:.0f} tests: {:.0f} failures, {:.0f} run-outs", tests, failed, tests - failed)};
  if (failed == 0 || failed == tests) {
    const bool failures = failed > 0;
    study.nothing_seen = {
        failures ? "no-run-outs" : "no-failures",
        fmt::format("no {} was observed among {:.0f} test{}: the data only exclude {} limits, and "
                    "the {} end of every limit rests on the prior",
                    failures ? "run-out" : "failure", tests, tests == 1 ? "" : "s",
                    failures ? "high" : "low", failures ? "lower" : "upper"),
        fmt::format("Test at {} stresses, until both outcomes occur.",
                    failures ? "lower" : "higher")};
  }
  study.likelihood = [=](std::size_t rows) {
    return fatigue::staircase_likelihood(
        data.limit, {data.tests.begin(), data.tests.begin() + static_cast<std::ptrdiff_t>(rows)});
  };
  add_limits(data, study);
  const fatigue::StairFit check{data.limit, data.tests, study.parameters[0].prior,
                                study.parameters[1].prior, data.unit};
  study.checks = [=](const Fit& fit) -> std::vector<Check> {
    if (!proper(fit)) return {};
    return {staircase_fit_check(check, fit.exact ? fit.exact->nodes : fit.pooled)};
  };
  study.figures = [=](const Fit& fit) {
    return std::map<std::string, std::vector<html::Figure>>{
        {"verdict", {failure_figure(data, fit.exact ? fit.exact->nodes : fit.pooled)}}};
  };
  study.addition = [=](const Fit& fit) {
    return addition(data, fit.exact ? fit.exact->nodes : fit.pooled);
  };
}

}  // namespace wearwell
