#include "wearwell/infer/distribution_tests.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/infer/residual_shape.h"
#include "wearwell/infer/row_sample.h"
#include "wearwell/infer/score_tests.h"
#include "wearwell/infer/studentized_scores.h"

namespace wearwell {
namespace {

// Shares of the check's level; the tests of location, trend and order have their own.
constexpr double shape_share = 0.25, scatter_share = 0.15, offset_share = 0.05;
// Credited fraction of the variance between draws; the full variance would make offset tests with
// few rows reject too often.
constexpr double credited_offset = 0.6;
// Above this p value the correction for dependent residuals is skipped, because it only increases
// p.
constexpr double in_question = 0.02;
// A larger data set is tested by a random sample of this size.
constexpr std::size_t most_observations = 20'000;
constexpr std::uint64_t seed = 20261124;

using ScoreTest = std::function<double(std::span<const double>)>;

// A test of all draws together.
struct OverDraws {
  double p = 1;
  double mean = 0;  ///< of the scores of the draws
};

// The score of each draw.
std::vector<double> each_draw(const std::vector<std::vector<double>>& scores,
                              const ScoreTest& test) {
  std::vector<double> each(scores.size());
  tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t s) {
    check_stop();
    each[s] = test(scores[s]);
  });
  return each;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

template <class Value>
std::vector<Value> taken(const std::vector<Value>& values, const std::vector<std::size_t>& which) {
  std::vector<Value> some;
  some.reserve(which.size());
  for (const std::size_t i : which) some.push_back(values[i]);
  return some;
}

// Residuals depend on each other through shared parameters, so the scores vary more than standard
// normal.
OverDraws over_draws(const StudentizedScores& residuals, const ScoreTest& test, bool two_sided) {
  std::vector<double> each = each_draw(residuals.scores, test);
  OverDraws all{combined_p(each, two_sided), mean(each)};
  if (!(all.p < in_question)) return all;
  const double size = null_size(residuals, test);
  if (!(size > 1)) return all;
  for (double& score : each) score /= size;
  all.p = combined_p(each, two_sided);
  return all;
}

std::vector<double> middles(const std::vector<std::vector<double>>& scores) {
  std::vector<double> middle(scores.front().size());
  for (const auto& z : scores) {
    for (std::size_t i = 0; i < z.size(); ++i)
      middle[i] += z[i] / static_cast<double>(scores.size());
  }
  return middle;
}

FitTest shape_test(const std::string& of, const StudentizedScores& residuals,
                   const Remedies& remedies, double share) {
  FitTest test{"distribution of " + of, over_draws(residuals, shape_score, false).p, "", "", share};
  if (!(test.judged() < 1)) return test;
  const ResidualShapeFound found = shape_of(middles(residuals.scores));
  test.finding = fmt::format("{} do not follow their distribution: {}", of,
                             description(found, residuals.scores.front().size()));
  test.advice = advice_on(found.shape, remedies);
  return test;
}

std::string advice_on_scatter(const FitData& data) {
  if (!data.remedies.scatter.empty()) return data.remedies.scatter;
  return "If the scatter grows with the mean, try a lognormal family, or a standard deviation that "
         "depends on the mean or the driver.";
}

// A variable along which the scatter may change, with its name.
struct Along {
  std::string name;
  std::vector<double> rank;
};

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto dot = [](const auto& x, const auto& y) {
    return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
  };
  return dot(a, b) / std::sqrt(dot(a, a) * dot(b, b));
}

std::vector<Along> what_scatter_may_follow(const FitData& data, const ScoreSample& sample,
                                           const std::vector<std::size_t>& row) {
  const std::vector<std::size_t> column =
      data.column.empty() ? std::vector<std::size_t>{} : taken(data.column, row);
  std::vector<Along> all;
  // Variables with equal ranks are tested once.
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    if (!std::all_of(values.begin(), values.end(), [](double v) { return !std::isnan(v); })) return;
    std::vector<double> rank = centered_ranks(values, column);
    if (std::all_of(rank.begin(), rank.end(), [](double r) { return r == 0; })) return;
    constexpr double alike = 0.99;
    for (Along& other : all) {
      if (std::abs(correlation(other.rank, rank)) > alike) return;
    }
    all.push_back({name, std::move(rank)});
  };
  for (const Driver& driver : data.drivers) add(driver.name, taken(driver.value, row));
  if (data.fitted) {
    const Eigen::VectorXd x = sample.draws.values.row(sample.draws.values.rows() / 2);
    const std::vector<double> fitted = data.fitted(x.data());
    add("the fitted value", taken(fitted, row));
  }
  return all;
}

void add_scatter_tests(const FitData& data, const ScoreSample& sample,
                       const std::vector<std::size_t>& row, const StudentizedScores& residuals,
                       std::vector<FitTest>& tests) {
  const std::size_t first = tests.size();
  for (const Along& along : what_scatter_may_follow(data, sample, row)) {
    const OverDraws trend = over_draws(
        residuals,
        [&](std::span<const double> z) { return scatter_trend_score(sizes(z), along.rank); }, true);
    tests.push_back({"scatter along " + along.name, trend.p,
                     fmt::format("residuals scatter more for {} {}",
                                 trend.mean > 0 ? "larger" : "smaller", along.name),
                     advice_on_scatter(data)});
  }
  for (const Label& label : data.labels) {
    const std::vector<std::size_t> level = taken(label.level, row);
    const OverDraws between = over_draws(
        residuals,
        [&](std::span<const double> z) { return scatter_between_score(sizes(z), level); }, false);
    tests.push_back({"scatter between levels of " + label.name, between.p,
                     fmt::format("residuals scatter differently between levels of {}", label.name),
                     fmt::format("Examine each level of {}; give each level its own standard "
                                 "deviation, or fit the levels separately.",
                                 label.name)});
  }
  for (std::size_t i = first; i < tests.size(); ++i) {
    tests[i].share = scatter_share / static_cast<double>(tests.size() - first);
  }
}

}  // namespace

std::vector<FitTest> distribution_tests(const FitData& data, const ScoreSample& sample) {
  const std::size_t draws = sample.scores.size();
  const std::vector<std::size_t> which =
      row_sample(sample.row.size(), most_observations, Rng(seed, 0));
  const std::vector<std::size_t> row = taken(sample.row, which);
  std::vector<bool> exact;
  for (const std::size_t i : row) exact.push_back(sample.exact[i]);
  std::vector<std::vector<double>> scores(draws);
  tbb::parallel_for(std::size_t{0}, draws,
                    [&](std::size_t s) { scores[s] = taken(sample.scores[s], which); });
  const StudentizedScores residuals = studentized_scores(scores, exact);

  std::vector<FitTest> tests;
  const double shares = data.effects.empty() ? 1 : 2;
  tests.push_back(shape_test("residuals", residuals, data.remedies, shape_share / shares));
  std::size_t begin = 0;
  for (const UnitEffect& effect : data.effects) {
    const auto end = static_cast<std::ptrdiff_t>(begin + effect.of.size());
    std::vector<std::vector<double>> own(draws);
    for (std::size_t s = 0; s < draws; ++s) {
      const auto all = sample.effects[s].begin();
      own[s].assign(all + static_cast<std::ptrdiff_t>(begin), all + end);
    }
    begin += effect.of.size();
    tests.push_back(
        shape_test(effect.name + " of the units",
                   studentized_scores(std::move(own), std::vector<bool>(effect.of.size(), true)),
                   {}, shape_share / shares / static_cast<double>(data.effects.size())));
  }
  add_scatter_tests(data, sample, row, residuals, tests);
  if (data.rise && data.rise->from_zero) {
    const std::vector<double> driver = taken(data.drivers.front().value, row);
    // Tests each draw, because the test is exact for the scores of one draw; with means over draws
    // a few rows have too much influence.
    const std::vector<double> each =
        each_draw(scores, [&](std::span<const double> z) { return offset_score(z, driver); });
    tests.push_back({"offset", combined_p(each, true, credited_offset),
                     fmt::format("the data start {} zero: the residuals share an offset",
                                 mean(each) > 0 ? "above" : "below"),
                     data.remedies.offset.empty() ? "Look for an error of the zero point, or for "
                                                    "running-in that the model does not include."
                                                  : data.remedies.offset,
                     offset_share});
  }
  return tests;
}

}  // namespace wearwell
