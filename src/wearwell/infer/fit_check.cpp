#include "wearwell/infer/fit_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/infer/copied_rows.h"
#include "wearwell/infer/distribution_tests.h"
#include "wearwell/infer/judged_counts.h"
#include "wearwell/infer/residual_tests.h"

namespace wearwell {
namespace {

// Number of tested draws, enough for a median.
constexpr double evaluations = 60'000, most_scores = 4e6;
constexpr Eigen::Index fewest_draws = 40, most_draws = 400;
// A larger table is tested on a random sample of this size, with fewer draws because its posterior is narrow.
constexpr std::size_t most_judged = 20'000;
constexpr Eigen::Index fewest_of_many = 10;
// A passing check mentions a test with a p value below this.
constexpr double noted_below = 0.005;
constexpr std::uint64_t seed = 20261121;  // for the random scores of interval-censored observations
constexpr std::uint64_t of_the_sample = 1ULL << 32, of_the_others = of_the_sample + 1;  // streams

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Ties of the driver are ordered randomly, because tables are often sorted by the observed value,
// which would make neighbours similar.
std::vector<std::size_t> order_along(const std::vector<double>& driver) {
  Rng rng(seed, 0);
  std::vector<double> lot;
  for (std::size_t i = 0; i < driver.size(); ++i) lot.push_back(rng.uniform());
  std::vector<std::size_t> order(driver.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(driver[a], lot[a]) < std::make_pair(driver[b], lot[b]);
  });
  return order;
}

// A random score between the two ends, for an interval.
double drawn(const NormalScore& score, Rng& rng) {
  constexpr double most = 1e6;  // its square does not overflow
  if (score.exact()) return std::clamp(score.low, -most, most);
  const double sign = score.low + score.high > 0 ? -1 : 1;  // in the more accurate tail
  const double a = sign > 0 ? score.low : -score.high, b = sign > 0 ? score.high : -score.low;
  const double low = normal_cdf(a), high = normal_cdf(b);
  const double p = low + (high - low) * rng.uniform();
  if (!(p > 0)) return sign * std::clamp(b, -most, most);
  return sign * normal_score(std::log(p), std::log1p(-p));
}

struct Judged {
  std::string name;
  ResidualTest test;
  std::string finding, advice;
};

std::vector<Judged> tests_of(const FitData& data, const std::vector<std::size_t>& row) {
  const auto each = [&](const std::vector<double>& values) {
    std::vector<double> all;
    for (const std::size_t i : row) all.push_back(values[i]);
    return all;
  };
  const std::string other_distribution =
      "The model does not describe the data: examine the residuals, try another formula or "
      "exponent, or check whether a prior prevents a better fit.";
  std::vector<Judged> tests;
  tests.push_back(
      {"scatter", scatter_test, "the size of the residuals does not match the scatter",
       "The stated scatter is not that of these data: check what it refers to, or fit it."});
  tests.push_back(
      {"location", location_test, "the residuals are not centered at zero", other_distribution});
  for (const Driver& driver : data.drivers) {
    const std::vector<double> values = each(driver.value);
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (!(*least < *most)) continue;
    tests.push_back({"trend with " + driver.name,
                     [values](std::span<const double> z) { return trend_test(z, values); },
                     "residuals have a trend with " + driver.name, other_distribution});
  }
  if (data.drivers.empty()) return tests;
  const std::vector<double> along = each(data.drivers.front().value);
  const std::vector<std::size_t> order = order_along(along);
  tests.push_back({"order along " + data.drivers.front().name,
                   [order](std::span<const double> z) {
                     std::vector<double> ordered;
                     for (const std::size_t i : order) ordered.push_back(z[i]);
                     return neighbour_test(ordered);
                   },
                   "residuals of neighbours along " + data.drivers.front().name + " are correlated",
                   other_distribution});
  if (data.unit.empty()) return tests;
  // Within each unit, or within each measured column if rows are tested separately, because
  // correlations within groups may cancel over all of them.
  const std::string one = data.terms ? "measured column" : "unit";
  std::vector<std::size_t> within = order;
  std::stable_sort(within.begin(), within.end(), [&](std::size_t a, std::size_t b) {
    return data.unit[row[a]] < data.unit[row[b]];
  });
  tests.push_back({"order within " + one + "s",
                   [within](std::span<const double> z) {
                     std::vector<double> ordered;
                     for (const std::size_t i : within) ordered.push_back(z[i]);
                     return neighbour_test(ordered);
                   },
                   "residuals of neighbours within one " + one + " are correlated",
                   other_distribution});
  return tests;
}

// Grubbs' test (1969) of the value farthest from the mean, with Student's t and Bonferroni's bound.
// It does not depend on the population's location and width, which an outlier shifts.
double outsider_test(std::span<const double> z) {
  const auto n = static_cast<double>(z.size());
  if (n < 4) return 1;
  double mean = 0, squares = 0, most = 0;
  for (const double each : z) mean += each / n;
  for (const double each : z) {
    const double square = (each - mean) * (each - mean);
    squares += square;
    most = std::max(most, square);
  }
  const double share = most / squares * n / (n - 1);  // relative to the maximum possible for one
                                                      // value
  if (!(share < 1)) return 0;
  const double t = std::sqrt((n - 2) * share / (1 - share));
  const boost::math::students_t distribution(n - 2);
  return std::min(1.0, 2 * n * boost::math::cdf(boost::math::complement(distribution, t)));
}

// Tests the random effects of the units against their distribution.
void judge_effects(const FitData& data, const std::vector<std::vector<double>>& drawn_effects,
                   FitOutcome& outcome) {
  std::size_t begin = 0;
  for (const UnitEffect& effect : data.effects) {
    const std::size_t count = effect.of.size();
    const auto p_of = [&](const ResidualTest& test) {
      std::vector<double> p;
      for (const auto& z : drawn_effects) p.push_back(test(std::span(z).subspan(begin, count)));
      return std::min(1.0, 2 * median(p));
    };
    const auto middle = [&](std::size_t u) {
      std::vector<double> values;
      for (const auto& z : drawn_effects) values.push_back(z[begin + u]);
      return std::abs(median(values));
    };
    std::size_t farthest = 0;
    for (std::size_t u = 1; u < count; ++u) farthest = middle(u) > middle(farthest) ? u : farthest;
    outcome.tests.push_back(
        {"spread of " + effect.name, p_of(scatter_test),
         fmt::format("the variation of {} between units does not match its scatter", effect.name),
         "The stated scatter between units is not that of these units: check what it refers to, or "
         "give it a wider prior."});
    outcome.tests.push_back(
        {"middle of " + effect.name, p_of(location_test),
         fmt::format("{} of the units is not centered at the population's middle", effect.name),
         "Check the prior of the population's middle: the data contradict it."});
    outcome.tests.push_back(
        {"outermost unit by " + effect.name, p_of(outsider_test),
         fmt::format("{} is an outlier in {} compared with the other units", effect.of[farthest],
                     effect.name),
         "Check whether that unit is of another kind, or whether its rows belong to another unit; "
         "if not, the distribution of the random effect does not describe it."});
    begin += count;
  }
}

std::string suspect(const FitData& data, std::size_t row) {
  const std::string own = fmt::format("{} {}", data.noun, row + 1);
  return (data.names.empty() ? own : data.names[row]) + " is an outlier compared with the others";
}

// Tests the most extreme observation, by its leave-one-out distribution if known.
FitTest extreme(const FitData& data, const Loo& loo, const std::vector<double>& residuals,
                const std::vector<std::vector<double>>& scores) {
  FitTest result{"extreme residual", 1, "",
                 fmt::format("Check that {} for an error of reading, typing or unit; if it is "
                             "correct, the model does not describe it.",
                             data.noun)};
  if (data.terms && data.cheap && loo.terms.size() == residuals.size()) {
    // One impossible observation can make others impossible too; reports the farthest of these.
    constexpr double impossible = 1e-100;
    const auto rank = [&](std::size_t i) {
      return std::make_pair(std::max(loo.terms[i].tail, impossible), -std::abs(residuals[i]));
    };
    std::size_t worst = 0;
    for (std::size_t i = 0; i < loo.terms.size(); ++i) {
      if (rank(i) < rank(worst)) worst = i;
    }
    result.p = std::min(1.0, loo.observations() * loo.terms[worst].tail);
    result.finding = suspect(data, worst);
    return result;
  }
  std::vector<double> p;
  for (const auto& z : scores) p.push_back(extreme_test(z));
  result.p = std::min(1.0, 2 * median(p));
  const auto farthest =
      std::max_element(residuals.begin(), residuals.end(),
                       [](double a, double b) { return std::abs(a) < std::abs(b); });
  result.finding = suspect(data, static_cast<std::size_t>(farthest - residuals.begin()));
  return result;
}

// The log densities of the observations: from leave-one-out, or at a middle draw.
std::optional<CopiedRows> copies(const FitData& data, const WeightedDraws& draws, const Loo& loo) {
  std::vector<double> log_density;
  if (data.measured.log_density) {
    const Eigen::VectorXd x = draws.values.row(draws.values.rows() / 2);
    log_density = data.measured.log_density(x.data());
  } else if (data.terms) {
    for (const LooTerm& term : loo.terms) log_density.push_back(term.lpd);
  }
  if (log_density.size() != data.measured.value.size()) return std::nullopt;
  return copied_rows(data, log_density);
}

void add_copies(const CopiedRows& copies, Findings& findings) {
  constexpr double chance = 1e-4, share_of_many = 0.2;
  if (!(copies.p < chance)) return;
  const bool many =
      static_cast<double>(copies.rows) >= share_of_many * static_cast<double>(copies.of);
  findings.add(
      many ? Verdict::fail : Verdict::warn,
      fmt::format(
          "{} of {} exact rows repeat another row in every number; {:.2g} are expected by chance",
          copies.rows, copies.of, copies.expected),
      "Remove copies: each counts as a separate observation, and intervals become too narrow. If "
      "several observations were really equal, state it in a column `count`.");
}

}  // namespace

FitOutcome judge_fit(const FitData& data, const WeightedDraws& draws, const Loo& loo) {
  FitOutcome outcome;
  const Eigen::VectorXd first = draws.values.row(0);
  std::size_t of_effects = 0;
  for (const UnitEffect& effect : data.effects) of_effects += effect.of.size();
  const std::vector<NormalScore> of_first = data.scores(first.data());
  const std::size_t rows = of_first.size() - of_effects;
  std::vector<bool> exact;
  for (std::size_t i = 0; i < rows; ++i) exact.push_back(of_first[i].exact());
  const std::vector<int> counts = judged_counts(data.counts, rows, most_judged, outcome.share);
  outcome.share *= data.share;
  const std::vector<std::size_t> row = judged_items(counts, most_judged, Rng(seed, of_the_sample));
  const bool sampled = rows > most_judged;
  const Eigen::Index fewest =
      std::clamp(static_cast<Eigen::Index>(most_scores / static_cast<double>(rows)), fewest_of_many,
                 fewest_draws);
  const Eigen::Index count =
      std::min(draws.values.rows(),
               std::clamp(static_cast<Eigen::Index>(evaluations / static_cast<double>(row.size())),
                          fewest, most_draws));
  std::vector<std::vector<double>> scores(static_cast<std::size_t>(count)), effects(scores.size());
  tbb::parallel_for(std::size_t{0}, scores.size(), [&](std::size_t s) {
    check_stop();
    const Eigen::VectorXd x =
        draws.values.row(static_cast<Eigen::Index>(s) * draws.values.rows() / count);
    const std::vector<NormalScore> ends = data.scores(x.data());
    Rng rng(seed, s);
    for (const std::size_t i : row) scores[s].push_back(drawn(ends[i], rng));
    for (std::size_t i = rows; i < ends.size(); ++i) effects[s].push_back(ends[i].low);
  });
  // Of observations that are not judged the score of the first draw.
  Rng lots(seed, of_the_others);
  for (std::size_t i = 0, at = 0; i < rows; ++i) {
    check_stop();
    if (at == row.size() || row[at] != i) {
      outcome.residuals.push_back(drawn(of_first[i], lots));
      continue;
    }
    std::vector<double> values;
    for (const auto& z : scores) values.push_back(z[at]);
    outcome.residuals.push_back(median(values));
    while (at < row.size() && row[at] == i) ++at;
  }

  for (const Judged& judged : tests_of(data, row)) {
    std::vector<double> p(scores.size());
    tbb::parallel_for(std::size_t{0}, scores.size(),
                      [&](std::size_t s) { p[s] = judged.test(scores[s]); });
    outcome.tests.push_back(
        {judged.name, std::min(1.0, 2 * median(p)), judged.finding, judged.advice});
  }
  const std::vector<std::vector<double>> of_all = {outcome.residuals};
  outcome.tests.push_back(extreme(data, loo, outcome.residuals, sampled ? of_all : scores));
  judge_effects(data, effects, outcome);
  if (data.rise) {
    const std::string impossible =
        "No parameters of the model can produce this. Check signs, columns and units, and whether "
        "the measured quantity is wear.";
    outcome.tests.push_back(
        {"fall", fall_test(*data.rise),
         fmt::format("in the model {}, but in the data it decreases", data.rise->expected),
         impossible});
    if (data.rise->from_zero) {
      outcome.tests.push_back(
          {"sign", sign_test(*data.rise),
           fmt::format("in the model {} from zero, but in the data it is negative",
                       data.rise->expected),
           impossible});
    }
  }
  for (FitTest& test : outcome.tests) test.share = 1 / static_cast<double>(outcome.tests.size());
  for (FitTest& test : distribution_tests(data, {scores, row, exact, effects, draws}))
    outcome.tests.push_back(std::move(test));
  for (const FitTest& test : outcome.tests) outcome.p = std::min(outcome.p, test.judged());
  if (!data.measured.value.empty()) outcome.copies = copies(data, draws, loo);
  return outcome;
}

Check fit_check(const FitOutcome& outcome) {
  Findings findings("fit");
  std::vector<FitTest> sorted = outcome.tests;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const FitTest& a, const FitTest& b) { return a.judged() < b.judged(); });
  for (const FitTest& test : sorted) {
    if (!(test.judged() < fit_warns_below)) break;
    findings.add(test.may_fail && test.judged() < fit_fails_below ? Verdict::fail : Verdict::warn,
                 fmt::format("{} (p = {:.1g})", test.finding, test.p), test.advice);
  }
  if (outcome.copies) add_copies(*outcome.copies, findings);
  std::string of_what = outcome.residuals.empty() ? "the outcomes" : "the residuals";
  if (outcome.residuals.size() > most_judged)
    of_what += fmt::format(" of {} rows, sampled from {},", most_judged, outcome.residuals.size());
  if (outcome.share < 1)
    of_what += fmt::format(" of {:.2g} % of the items of each row", 100 * outcome.share);
  const FitTest& least = *std::min_element(
      sorted.begin(), sorted.end(), [](const FitTest& a, const FitTest& b) { return a.p < b.p; });
  std::string passed =
      fmt::format("the smallest p value of {} {} of {} is {:.2g} ({})", outcome.tests.size(),
                  outcome.tests.size() == 1 ? "test" : "tests", of_what, least.p, least.name);
  // Within chance among so many tests, but what an engineer sees.
  if (least.p < noted_below && !least.finding.empty())
    passed += fmt::format("; not significant among so many tests, but note: {}", least.finding);
  return findings.result(passed);
}

}  // namespace wearwell
