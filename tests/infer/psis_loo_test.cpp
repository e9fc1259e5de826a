#include "wearwell/infer/psis_loo.h"
#include "wearwell/infer/loo_of_many.h"
#include "wearwell/infer/pareto_smoothing.h"

#include <gmock/gmock.h>

#include <fstream>
#include <numbers>
#include <sstream>

#include "infer/test_posteriors.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/left_out.h"
#include "wearwell/math/view.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

// Observations y ~ N(mu, 1), each seen `count` times.
class NormalMean final : public LogDensity {
 public:
  explicit NormalMean(std::vector<double> y, std::vector<int> counts = {})
      : y_(std::move(y)), counts_(std::move(counts)) {
    if (counts_.empty()) counts_.assign(y_.size(), 1);
  }
  int dimension() const override { return 1; }
  double value(std::span<const double> x) const override {
    double sum = 0;
    for (std::size_t i = 0; i < y_.size(); ++i) sum += counts_[i] * term(y_[i], x[0]);
    return sum;
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    gradient[0] = 0;
    for (std::size_t i = 0; i < y_.size(); ++i) gradient[0] += counts_[i] * (y_[i] - x[0]);
    return value(x);
  }
  std::vector<double> pointwise(std::span<const double> x) const override {
    std::vector<double> terms;
    for (const double y : y_) terms.push_back(term(y, x[0]));
    return terms;
  }
  std::vector<int> pointwise_counts() const override { return counts_; }

 private:
  static double term(double y, double mu) {
    return -0.5 * (y - mu) * (y - mu) - 0.5 * std::log(2 * std::numbers::pi);
  }
  std::vector<double> y_;
  std::vector<int> counts_;
};

WeightedDraws draws_of(const std::vector<double>& values) {
  WeightedDraws draws;
  draws.values.resize(static_cast<Eigen::Index>(values.size()), 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    draws.values(static_cast<Eigen::Index>(i), 0) = values[i];
  }
  draws.weights =
      Eigen::VectorXd::Constant(draws.values.rows(), 1.0 / static_cast<double>(values.size()));
  return draws;
}

// tests/golden/psis_loo.R: the same draws and densities through the R package loo.
TEST(PsisLoo, AgreesWithTheRPackage) {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/psis_loo.csv");
  std::string line;
  std::getline(file, line);
  int compared = 0;
  while (std::getline(file, line)) {
    std::vector<double> c;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) c.push_back(std::stod(cell));
    std::vector<double> mu;
    for (int s = 0; s < c[0]; ++s) {
      mu.push_back(c[1] * quantile(StandardDistribution::normal, (s + 0.5) / c[0]));
    }
    const Loo loo = psis_loo(NormalMean({c[2]}), draws_of(mu));
    ASSERT_EQ(loo.terms.size(), 1u);
    EXPECT_NEAR(loo.terms[0].elpd, c[3], 1e-8 * std::abs(c[3])) << line;
    EXPECT_NEAR(loo.terms[0].lpd, c[4], 1e-10 * std::abs(c[4])) << line;
    EXPECT_NEAR(loo.terms[0].khat, c[5], 1e-8) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 45);
}

TEST(PsisLoo, ThresholdGrowsWithTheDraws) {
  EXPECT_DOUBLE_EQ(khat_threshold(100), 0.5);
  EXPECT_DOUBLE_EQ(khat_threshold(1e6), 0.7);
}

// A flat mean of n observations of unit variance: y_i given the others is N(their mean, 1 + 1/(n -
// 1)).
TEST(PsisLoo, NormalMeanByHand) {
  const std::vector<double> y = {-0.7, 0.1, 0.4, 1.2, -1.1, 0.3, 2.2, 0.8};
  const auto n = static_cast<double>(y.size());
  const Posterior posterior({flat_parameter("mu", 0.1, 1)}, std::make_shared<NormalMean>(y));
  FitSettings settings;
  settings.method = Method::exact;
  const Fit exact = fit(posterior, settings);
  const Loo loo = leave_one_out(posterior, exact);
  double sum = 0, p = 0;
  const double all = std::accumulate(y.begin(), y.end(), 0.0);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const auto density = [&](double mean, double variance) {
      return -0.5 * std::pow(y[i] - mean, 2) / variance -
             0.5 * std::log(2 * std::numbers::pi * variance);
    };
    const double elpd = density((all - y[i]) / (n - 1), 1 + 1 / (n - 1));
    EXPECT_NEAR(exact_elpd(posterior, exact.whitening, i), elpd, 2e-5) << i;
    EXPECT_NEAR(loo.terms[i].elpd, elpd, 2e-5) << i;
    EXPECT_NEAR(loo.terms[i].lpd, density(all / n, 1 + 1 / n), 2e-5) << i;
    EXPECT_LT(loo.terms[i].khat, 0.7) << i;
    sum += elpd;
    p += density(all / n, 1 + 1 / n) - elpd;
  }
  EXPECT_NEAR(loo.elpd(), sum, 1e-4);
  EXPECT_NEAR(loo.p_loo(), p, 1e-4);
  EXPECT_TRUE(loo.by_quadrature);
  EXPECT_LT(std::abs(loo.elpd() - sum), loo.error + 1e-5);
  EXPECT_EQ(loo_check(loo, "row", 1).verdict, Verdict::pass);

  // By draws the error is what it is said to be: within four of it.
  Fit drawn = exact;
  drawn.exact.reset();
  const Loo sampled = leave_one_out(posterior, drawn);
  EXPECT_FALSE(sampled.by_quadrature);
  EXPECT_NEAR(sampled.elpd(), sum, 4 * sampled.error);
  EXPECT_LT(sampled.error, 0.05);
}

// The Monte Carlo error of elpd is the scatter of elpd from one run to the next.
TEST(PsisLoo, ErrorIsTheScatterOfRuns) {
  const std::vector<double> y = {-0.7, 0.1, 0.4, 1.2, -1.1, 0.3, 2.2, 0.8};
  const double center = 0.4, sd = 1 / std::sqrt(8.0);
  constexpr int runs = 200;
  double sum = 0, squares = 0, errors = 0;
  for (int run = 0; run < runs; ++run) {
    Rng rng(11, static_cast<std::uint64_t>(run));
    std::vector<double> mu(1000);
    for (double& each : mu) each = center + sd * rng.normal();
    const Loo loo = psis_loo(NormalMean(y), draws_of(mu));
    sum += loo.elpd();
    squares += loo.elpd() * loo.elpd();
    errors += loo.error / runs;
  }
  const double scatter = std::sqrt(squares / runs - std::pow(sum / runs, 2));
  EXPECT_NEAR(errors / scatter, 1, 0.25);
}

// So many terms that they are summed draw by draw. By hand as above, within the stated error; and
// terms one by one.
TEST(PsisLoo, ManyTermsByHand) {
  Rng rng(7, 0);
  std::vector<double> y(terms_are_many);
  for (double& each : y) each = rng.normal();
  y[123] = 9;
  const auto n = static_cast<double>(y.size());
  const double all = std::accumulate(y.begin(), y.end(), 0.0);
  std::vector<double> mu(4000);
  for (double& each : mu) each = all / n + rng.normal() / std::sqrt(n);
  const Scores scores = [&](const double* x) {
    std::vector<NormalScore> z;
    for (const double each : y) z.push_back({each - x[0], each - x[0]});
    return z;
  };
  const Loo loo = psis_loo(NormalMean(y), draws_of(mu), 1, &scores);
  double sum = 0;
  int with_khat = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double mean = (all - y[i]) / (n - 1), variance = 1 + 1 / (n - 1);
    const double elpd = -0.5 * std::pow(y[i] - mean, 2) / variance -
                        0.5 * std::log(2 * std::numbers::pi * variance);
    ASSERT_NEAR(loo.terms[i].elpd, elpd, 5 * std::abs(y[i]) / std::sqrt(n * 400) + 1e-4) << i;
    ASSERT_NEAR(loo.terms[i].tail, 2 * normal_cdf(-std::abs(y[i] - mean) / std::sqrt(variance)),
                0.003)
        << i;
    sum += elpd;
    with_khat += std::isfinite(loo.terms[i].khat);
    EXPECT_FALSE(loo.doubtful(loo.terms[i])) << i;
  }
  EXPECT_EQ(with_khat, 1000);
  EXPECT_TRUE(std::isfinite(loo.terms[123].khat)) << "the one far out moves the mean most";
  EXPECT_LT(loo.terms[123].tail, 1e-17);
  EXPECT_NEAR(loo.elpd(), sum, 4 * loo.error);
  EXPECT_NEAR(loo.p_loo(), 1, 0.3);
  EXPECT_LT(loo.error, 0.1);
}

// The tail of y_i given all others, by hand: N(their mean, 1 + 1/(n - 1)).
TEST(PsisLoo, TailsByHand) {
  const std::vector<double> y = {-0.7, 0.1, 0.4, 1.2, -1.1, 0.3, 7.2, 0.8};
  const Scores scores = [&](const double* x) {
    std::vector<NormalScore> z;
    for (const double each : y) z.push_back({each - x[0], each - x[0]});
    return z;
  };
  const auto n = static_cast<double>(y.size());
  const Posterior posterior({flat_parameter("mu", 0.1, 1)}, std::make_shared<NormalMean>(y));
  const Loo loo = leave_one_out(posterior, fit(posterior, {}), &scores);
  const double all = std::accumulate(y.begin(), y.end(), 0.0);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double z = (y[i] - (all - y[i]) / (n - 1)) / std::sqrt(1 + 1 / (n - 1));
    const double tail = 2 * normal_cdf(-std::abs(z));
    EXPECT_NEAR(loo.terms[i].tail / tail, 1, 0.02) << i;
  }
}

TEST(PsisLoo, MoreParametersThanThereAreFail) {
  Loo loo;
  for (int i = 0; i < 3; ++i) loo.terms.push_back({-10, -1, 0.1});
  EXPECT_EQ(loo_check(loo, "row", 1).verdict, Verdict::fail);
  EXPECT_EQ(loo_check(loo, "row", 2).verdict, Verdict::warn);
  EXPECT_THAT(loo_check(loo, "row", 2).detail,
              HasSubstr("27, is much larger than the number of parameters, 2"));
  EXPECT_EQ(loo_check(loo, "row", 30).verdict, Verdict::pass);
}

// Every row of the joint study left out by quadrature: draws say the same where k-hat is good.
TEST(PsisLoo, AgreesWithFittingAnew) {
  for (const bool lognormal : {false, true}) {
    const Posterior posterior = joint_posterior(lognormal, false, lognormal ? 7 : 15, 6);
    FitSettings settings;
    settings.method = Method::exact;
    settings.run.draws = 10'000;
    const Fit whole = fit(posterior, settings);
    const Loo loo = psis_loo(*posterior.likelihood(), whole.pooled);
    ASSERT_EQ(loo.terms.size(), 6u);
    int good = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      if (loo.doubtful(loo.terms[i])) continue;
      EXPECT_NEAR(loo.terms[i].elpd, exact_elpd(posterior, whole.whitening, i),
                  loo.terms[i].khat < 0.5 ? 0.05 : 0.15)
          << lognormal << i << " k " << loo.terms[i].khat;
      ++good;
    }
    EXPECT_GE(good, 4);
  }
}

// On the nodes of the quadrature they agree to the third digit after the point.
TEST(PsisLoo, NodesAgreeWithFittingAnew) {
  for (const bool lognormal : {false, true}) {
    const Posterior posterior = joint_posterior(lognormal, false, lognormal ? 7 : 15, 6);
    const Fit whole = fit(posterior, {});
    const Loo loo = leave_one_out(posterior, whole);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(loo.terms[i].elpd, exact_elpd(posterior, whole.whitening, i), 2e-3)
          << lognormal << i << " k " << loo.terms[i].khat << loo.terms[i].refitted;
    }
  }
}

TEST(PsisLoo, DoubtfulTermsAreFittedAnewOrNamed) {
  // The last inspection alone says how steep the line is.
  const Posterior posterior = joint_posterior(false, false, 15, 4);
  Fit whole = fit(posterior, {});
  const Loo loo = leave_one_out(posterior, whole);
  ASSERT_TRUE(loo.terms[3].refitted) << loo.terms[3].khat;
  EXPECT_NEAR(loo.terms[3].elpd, exact_elpd(posterior, whole.whitening, 3), 1e-12);
  EXPECT_EQ(loo_check(loo, "row", 2).verdict, Verdict::pass);
  EXPECT_THAT(loo_check(loo, "row", 2).detail, HasSubstr("row 4"));

  whole.exact.reset();
  const Check warning = loo_check(leave_one_out(posterior, whole), "bearing", 2);
  EXPECT_EQ(warning.verdict, Verdict::warn);
  EXPECT_THAT(warning.detail, HasSubstr("bearing 4"));
}

TEST(PsisLoo, CountsAreRepetitions) {
  std::vector<double> mu;
  for (int s = 0; s < 1000; ++s)
    mu.push_back(0.3 * quantile(StandardDistribution::normal, (s + 0.5) / 1000));
  const WeightedDraws draws = draws_of(mu);
  const Loo counted = psis_loo(NormalMean({0.5, 1.5}, {3, 1}), draws);
  const Loo repeated = psis_loo(NormalMean({0.5, 0.5, 0.5, 1.5}), draws);
  EXPECT_DOUBLE_EQ(counted.observations(), 4);
  EXPECT_NEAR(counted.elpd(), repeated.elpd(), 1e-12);
  EXPECT_NEAR(counted.se(), repeated.se(), 1e-12);
  EXPECT_NEAR(counted.p_loo(), repeated.p_loo(), 1e-12);
}

// The density of a unit with many readings in metres is e^400 and more: another unit of y shifts both means of log p by a constant.
TEST(LeftOutSums, DoNotDependOnTheUnitOfTheReadings) {
  const std::vector<double> weights = {0.2, 0.5, 0.3}, log_p = {-1.5, 0.25, -3};
  double with = 0, inverse = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    with += weights[i] * std::exp(log_p[i]);
    inverse += weights[i] * std::exp(-log_p[i]);
  }
  for (const double shift : {-3000.0, -400.0, 0.0, 400.0, 3000.0}) {
    LeftOut first, second;
    for (std::size_t i = 0; i < weights.size(); ++i)
      (i < 2 ? first : second).add(std::log(weights[i]), log_p[i] + shift, nullptr);
    first.add(second);
    EXPECT_NEAR(first.lpd() - shift, std::log(with), 1e-11) << shift;
    EXPECT_NEAR(first.elpd() - shift, -std::log(inverse), 1e-11) << shift;
  }
}

// By hand: differences 1, 2, 6 have the standard deviation sqrt(7).
TEST(ElpdDifference, ByHand) {
  const std::vector<LooTerm> a = {{-1, 0, 0}, {-2, 0, 0}, {-3, 0, 0}},
                             b = {{-2, 0, 0}, {-4, 0, 0}, {-9, 0, 0}};
  const ElpdDifference ab = elpd_difference(a, b);
  EXPECT_DOUBLE_EQ(ab.value, 9);
  EXPECT_DOUBLE_EQ(ab.se, std::sqrt(3. * 7));
  EXPECT_DOUBLE_EQ(elpd_difference(a, a).se, 0);
  EXPECT_THROW(elpd_difference(a, std::span(b).first(2)), std::invalid_argument);
}

}  // namespace
}  // namespace wearwell
