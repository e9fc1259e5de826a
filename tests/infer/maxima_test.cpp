// Posteriors of several modes: mixtures of normal distributions in closed form, and posteriors whose moments are integrated here
// by brute force. What is trusted has to be right.
#include "wearwell/infer/maxima.h"

#include <gmock/gmock.h>

#include <numbers>

#include "infer/gaussian_mixture.h"
#include "support/formula.h"
#include "wearwell/infer/trust.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

Eigen::VectorXd vector(std::initializer_list<double> values) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), x.begin());
  return x;
}

FitSettings exact_settings() {
  FitSettings settings;
  settings.method = Method::exact;
  settings.run.draws = 500;
  return settings;
}

std::string reported(const Posterior& posterior, const Fit& fit) {
  std::string all;
  for (const Check& each : trust_checks(posterior, fit)) {
    if (each.verdict == Verdict::fail || each.name == "computation")
      all += each.name + ": " + each.detail + "\n";
  }
  return all;
}

void expect_shares(const Maxima& maxima, std::vector<double> weights, double tolerance) {
  std::vector<double> shares;
  for (const LocalMaximum& each : maxima.found) shares.push_back(each.share);
  ASSERT_EQ(shares.size(), weights.size());
  std::sort(shares.begin(), shares.end());
  std::sort(weights.begin(), weights.end());
  for (std::size_t k = 0; k < shares.size(); ++k) EXPECT_NEAR(shares[k], weights[k], tolerance);
}

struct Case {
  std::string name;
  GaussianMixture mixture;
  double start = 0.3;
  Family prior = Uniform{};
  double half = 30;
};

std::ostream& operator<<(std::ostream& out, const Case& each) {
  return out << each.name;
}

// The corners of a cube, `count` of them, far apart, of unlike widths.
GaussianMixture corners(int dimension, int count, double apart, double correlation) {
  GaussianMixture mixture;
  double total = 0;
  for (int k = 0; k < count; ++k) {
    Eigen::VectorXd mean(dimension), sd(dimension);
    for (int i = 0; i < dimension; ++i) {
      mean[i] = apart * ((k >> (i % 3)) % 2 == 0 ? -1 : 1) + 0.3 * i + 0.1 * k;
      sd[i] = 0.5 + 0.2 * ((k + i) % 3);
    }
    mixture.means.push_back(mean);
    mixture.sds.push_back(sd);
    mixture.weights.push_back(1 + k % 3);
    total += mixture.weights.back();
  }
  for (double& weight : mixture.weights) weight /= total;
  mixture.correlation = correlation;
  return mixture;
}

std::vector<Case> mixtures() {
  GaussianMixture eight{{}, {}, {}};
  for (int k = 0; k < 8; ++k) {
    eight.weights.push_back((k + 1) / 36.0);
    eight.means.push_back(vector({-20.0 + 5 * k + 0.3 * (k % 3)}));
    eight.sds.push_back(vector({0.05 + 0.03 * k}));
  }
  return {
      {"TwoNarrow",
       {{0.88, 0.12}, {vector({2}), vector({-2})}, {vector({0.03}), vector({0.03})}},
       1.9},
      {"TwoUnlike", {{0.3, 0.7}, {vector({-5}), vector({8})}, {vector({2}), vector({0.01})}}},
      {"TwoThatTouch", {{0.4, 0.6}, {vector({-1.5}), vector({1.5})}, {vector({1}), vector({0.7})}}},
      {"TwoWithoutPrior",
       {{0.5, 0.5}, {vector({-7}), vector({9})}, {vector({0.4}), vector({0.8})}},
       1,
       Flat{},
       infinity},
      {"EightInOneDimension", eight},
      {"FourInTwoDimensions", corners(2, 4, 5, 0.6)},
      {"TwoFarInTwoDimensions",
       {{0.25, 0.75},
        {vector({-20, 10}), vector({15, -12})},
        {vector({0.1, 1}), vector({0.5, 0.05})},
        0.8}},
      {"EightInThreeDimensions", corners(3, 8, 5, 0)},
      {"TwoInThreeDimensionsNormalPrior", corners(3, 2, 3, 0.5), 0.3, Flat{}, infinity},
      {"ThreeInFourDimensions", corners(4, 3, 5, 0.3)},
      {"TwoThatTouchInFourDimensions", corners(4, 2, 1.5, 0)},
  };
}

class OnMixtures : public testing::TestWithParam<Case> {};

TEST_P(OnMixtures, QuadratureCoversAllModes) {
  const Case& each = GetParam();
  const Posterior posterior = each.mixture.posterior(each.start, each.prior, each.half);
  const Fit found = fit(posterior, exact_settings());
  ASSERT_TRUE(found.exact) << found.no_exact << "\n" << reported(posterior, found);
  EXPECT_TRUE(trusted(trust_checks(posterior, found))) << reported(posterior, found);
  EXPECT_LT(found.exact->error, 1e-3);
  const Eigen::VectorXd mean = each.mixture.mean(), sd = each.mixture.sd();
  const double close = std::max(3e-5, 2 * found.exact->error);
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    EXPECT_NEAR(found.exact->mean[i], mean[i], close * sd[i]);
    EXPECT_NEAR(found.exact->sd[i], sd[i], close * sd[i]);
    const QuantityDistribution& marginal = found.marginals[static_cast<std::size_t>(i)];
    EXPECT_NEAR(marginal.mean(), mean[i], 5e-3 * sd[i]);
  }
  // Those that touch share what lies between them.
  expect_shares(found.maxima, each.mixture.weights,
                each.name.find("Touch") == std::string::npos ? 2e-3 : 0.08);
  EXPECT_THAT(reported(posterior, found), HasSubstr(" maxima, at x1 = "));
}

INSTANTIATE_TEST_SUITE_P(, OnMixtures, testing::ValuesIn(mixtures()),
                         [](const auto& each) { return each.param.name; });

// Beyond quadrature chains start about each maximum and jump between them.
TEST(Maxima, ChainsGoBetweenModesOfFiveAndSixParameters) {
  for (const auto& [dimension, count] : {std::pair{5, 3}, {6, 2}, {6, 8}}) {
    const GaussianMixture mixture = corners(dimension, count, 6, 0.3);
    const Posterior posterior = mixture.posterior(0.3, Uniform{}, 30);
    const Fit found = fit(posterior, {});
    EXPECT_TRUE(mixed(found)) << reported(posterior, found);
    EXPECT_TRUE(trusted(trust_checks(posterior, found))) << reported(posterior, found);
    const Eigen::VectorXd mean = mixture.mean(), sd = mixture.sd();
    for (Eigen::Index i = 0; i < mean.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_NEAR(found.marginals[at].mean(), mean[i], 4.5 * found.diagnostics[at].mcse_mean);
      EXPECT_NEAR(found.marginals[at].sd(), sd[i], 0.1 * sd[i]);
    }
    expect_shares(found.maxima, mixture.weights, 0.06);
  }
}

// Metropolis' chains do not jump: they stay where they start, and that ends trust.
TEST(Maxima, ChainsThatDoNotMixAreNotTrusted) {
  const GaussianMixture mixture = corners(5, 2, 6, 0);
  const Posterior posterior = mixture.posterior(0.3, Uniform{}, 30);
  FitSettings settings;
  settings.method = Method::metropolis;
  settings.run.warmup = 2000;
  settings.run.draws = 2000;
  const Fit found = fit(posterior, settings);
  const std::vector<Check> checks = trust_checks(posterior, found);
  EXPECT_FALSE(trusted(checks));
  EXPECT_EQ(checks.back().verdict, Verdict::fail);
  EXPECT_THAT(checks.back().detail, HasSubstr("search for other maxima: "));
  EXPECT_THAT(checks.back().detail, HasSubstr("2 maxima, at x1 = "));
}

// By the trapezoidal rule over [lower, upper].
struct Moments {
  double mean, sd;
};
template <class LogDensityOf>
Moments brute_force(const LogDensityOf& log_density, double lower, double upper) {
  constexpr int nodes = 2'000'000;
  double top = -INFINITY;
  for (int i = 0; i <= nodes; i += 10)
    top = std::max(top, log_density(lower + (upper - lower) * i / nodes));
  double sums[3] = {};
  for (int i = 0; i <= nodes; ++i) {
    const double x = lower + (upper - lower) * i / nodes;
    const double f = std::exp(log_density(x) - top) * (i == 0 || i == nodes ? 0.5 : 1);
    sums[0] += f;
    sums[1] += f * x;
    sums[2] += f * x * x;
  }
  const double mean = sums[1] / sums[0];
  return {mean, std::sqrt(sums[2] / sums[0] - mean * mean)};
}

// y ~ normal(f(x), sd) in one parameter.
struct Response {
  std::function<double(double, double)> f, slope;  // of the parameter, and of the row
  std::vector<double> y;
  double sd;

  double log_likelihood(double p) const {
    double sum = 0;
    for (std::size_t i = 0; i < y.size(); ++i)
      sum -= 0.5 * std::pow((y[i] - f(p, static_cast<double>(i))) / sd, 2);
    return sum;
  }
  Posterior posterior(const Family& prior, double lower, double upper, double start) const {
    Parameter parameter = flat_parameter("th", start, 1);
    parameter.prior = make_distribution(prior, lower, upper);
    return Posterior(
        {parameter}, std::make_shared<Formula>(1, [self = *this](auto x, std::span<double> g) {
          g[0] = 0;
          for (std::size_t i = 0; i < self.y.size(); ++i) {
            const auto row = static_cast<double>(i);
            g[0] += (self.y[i] - self.f(x[0], row)) / (self.sd * self.sd) * self.slope(x[0], row);
          }
          return self.log_likelihood(x[0]);
        }));
  }
};

void expect_moments(const Posterior& posterior, const Moments& right) {
  const Fit found = fit(posterior, exact_settings());
  ASSERT_TRUE(found.exact) << found.no_exact;
  EXPECT_NEAR(found.exact->mean[0], right.mean, 1e-4 * right.sd) << reported(posterior, found);
  EXPECT_NEAR(found.exact->sd[0], right.sd, 1e-4 * right.sd) << reported(posterior, found);
  EXPECT_TRUE(found.maxima.several());
}

TEST(Maxima, ASquareHasTwoRoots) {
  const Response square{[](double p, double) { return p * p; },
                        [](double p, double) { return 2 * p; },
                        {3.9, 4.1, 4.05},
                        0.2};
  const Moments right = brute_force(
      [&](double p) { return square.log_likelihood(p) - 0.5 * std::pow(p - 0.5, 2); }, -8, 8);
  EXPECT_NEAR(right.mean, 1.526, 1e-3);
  EXPECT_NEAR(right.sd, 1.297, 1e-3);
  const Posterior posterior = square.posterior(Normal{0.5, 1}, -infinity, infinity, 0.5);
  expect_moments(posterior, right);
  const Fit found = fit(posterior, exact_settings());
  EXPECT_THAT(reported(posterior, found),
              HasSubstr("2 maxima, at th = 2.003 (88 %) and th = -2.002 (12 %)"));
}

// The search from the start value begins on the top of the barrier, or in a place where the density is flat.
TEST(Maxima, AStartBetweenTheRoots) {
  const Response square{[](double p, double) { return p * p; },
                        [](double p, double) { return 2 * p; },
                        {3.9, 4.1, 4.05},
                        0.2};
  for (const double start : {0.0, 1e-9, 5.0}) {
    const Posterior posterior = square.posterior(Normal{0, 1}, -infinity, infinity, start);
    const Fit found = fit(posterior, exact_settings());
    ASSERT_TRUE(found.exact) << found.no_exact;
    EXPECT_NEAR(found.exact->mean[0], 0, 1e-4);
    EXPECT_NEAR(found.exact->sd[0], 2, 0.01);
    EXPECT_TRUE(trusted(trust_checks(posterior, found))) << reported(posterior, found);
    expect_shares(found.maxima, {0.5, 0.5}, 1e-3);
  }
}

TEST(Maxima, ACubicHasThreeRoots) {
  for (const double y : {-0.3, 0.2, 1.0}) {
    const Response cubic{[](double p, double) { return p * p * p - 3 * p; },
                         [](double p, double) { return 3 * p * p - 3; },
                         {y, y + 0.1, y - 0.15},
                         0.1};
    const Moments right = brute_force(
        [&](double p) { return cubic.log_likelihood(p) - 0.5 * std::pow(p / 2, 2); }, -8, 8);
    expect_moments(cubic.posterior(Normal{0, 2}, -infinity, infinity, 0.1), right);
  }
}

// Sampled every half second or at uneven times: frequencies that differ by the sampling rate look alike.
TEST(Maxima, AliasesOfAFrequency) {
  for (const double uneven : {0.0, 0.02, 0.1}) {
    const auto time = [=](double i) { return 0.5 * (i + 1) + uneven * std::sin(7 * i); };
    Response wave{[=](double w, double i) { return std::sin(w * time(i)); },
                  [=](double w, double i) { return time(i) * std::cos(w * time(i)); },
                  {},
                  0.3};
    for (int i = 0; i < 8; ++i) wave.y.push_back(std::sin(3 * time(i)) + 0.2 * std::cos(11.0 * i));
    const Moments right = brute_force([&](double w) { return wave.log_likelihood(w); }, 0, 30);
    expect_moments(wave.posterior(Uniform{}, 0, 30, 3), right);
  }
}

// Lives of two kinds, a half each, whose middles may change places: the posterior is the same either way round.
TEST(Maxima, LabelsThatChangePlaces) {
  const std::vector<double> y = {-3.2, -2.6, -3.9, -2.9, -3.1, 2.2, 3.4, 2.8, 3.3};
  const auto log_density = [&](double a, double b) {
    double sum = -0.5 * (a * a + b * b) / 100;
    for (const double each : y)
      sum += std::log(0.5 * std::exp(-0.5 * std::pow(each - a, 2)) +
                      0.5 * std::exp(-0.5 * std::pow(each - b, 2)));
    return sum;
  };
  constexpr int n = 1600;
  double sums[3] = {};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double a = -8 + 16.0 * i / n, b = -8 + 16.0 * j / n, f = std::exp(log_density(a, b));
      sums[0] += f;
      sums[1] += f * a;
      sums[2] += f * a * a;
    }
  }
  const double mean = sums[1] / sums[0], sd = std::sqrt(sums[2] / sums[0] - mean * mean);
  std::vector<Parameter> parameters;
  for (const char* name : {"a", "b"}) {
    parameters.push_back(flat_parameter(name, name[0] == 'a' ? 2 : -1, 1));
    parameters.back().prior = make_distribution(Normal{0, 10}, -infinity, infinity);
  }
  const Posterior posterior(parameters,
                            std::make_shared<Formula>(2, [=](auto x, std::span<double> g) {
                              double sum = 0;
                              g[0] = g[1] = 0;
                              for (const double each : y) {
                                const double a = std::exp(-0.5 * std::pow(each - x[0], 2)),
                                             b = std::exp(-0.5 * std::pow(each - x[1], 2));
                                sum += std::log(0.5 * (a + b));
                                g[0] += a / (a + b) * (each - x[0]);
                                g[1] += b / (a + b) * (each - x[1]);
                              }
                              return sum;
                            }));
  const Fit found = fit(posterior, exact_settings());
  ASSERT_TRUE(found.exact) << found.no_exact;
  for (const Eigen::Index i : {0, 1}) {
    EXPECT_NEAR(found.exact->mean[i], mean, 2e-4 * sd) << reported(posterior, found);
    EXPECT_NEAR(found.exact->sd[i], sd, 2e-4 * sd);
  }
  expect_shares(found.maxima, {0.5, 0.5}, 1e-3);
}

// NUTS as a study asks for it takes its draws from the quadrature that covers all modes.
TEST(Maxima, DrawsAreQuadraturesWhereThatCoversAllModes) {
  const GaussianMixture mixture = corners(2, 3, 8, 0);
  const Posterior posterior = mixture.posterior(0.3, Uniform{}, 30);
  FitSettings settings;
  settings.extend = true;
  const Fit found = fit(posterior, settings);
  EXPECT_EQ(found.method, Method::exact);
  const QuantityDistribution drawn(found.pooled, [](const double* x) { return x[0]; });
  EXPECT_NEAR(drawn.mean(), mixture.mean()[0], 4 * mixture.sd()[0] / std::sqrt(4000.0));
}

// 400 modes of one height: more than are searched for, and that is said.
TEST(Maxima, MoreThanSearchesFindAreSaid) {
  std::vector<Parameter> parameters = {flat_parameter("x", 0.3, 1), flat_parameter("y", 0.3, 1)};
  for (Parameter& each : parameters) each.prior = make_distribution(Uniform{}, -10, 10);
  const double turn = 2 * std::numbers::pi;
  const Posterior posterior(parameters,
                            std::make_shared<Formula>(2, [=](auto x, std::span<double> g) {
                              for (const std::size_t i : {0, 1})
                                g[i] = -10 * turn * std::sin(turn * x[i]);
                              return 10 * (std::cos(turn * x[0]) + std::cos(turn * x[1]));
                            }));
  const Maxima maxima = find_maxima(posterior, find_mode(posterior, posterior.start()));
  EXPECT_GT(maxima.left, 30);
  const Fit found = fit(posterior, exact_settings());
  const Check last = trust_checks(posterior, found).back();
  EXPECT_NE(last.verdict, Verdict::pass);
  EXPECT_THAT(last.detail, HasSubstr("more probably exist that no search has found"));
}

// A posterior of one mode is searched as well, and few searches suffice.
TEST(Maxima, OneModeTakesFewSearches) {
  for (const KnownPosterior& known : known_posteriors()) {
    const Posterior posterior = known.make();
    const Mode mode = find_mode(posterior, posterior.start());
    ASSERT_TRUE(mode.found) << known.name;
    const Maxima maxima = find_maxima(posterior, mode);
    EXPECT_EQ(maxima.found.size(), known.name == "Bimodal" ? 2u : 1u) << known.name;
    EXPECT_LE(maxima.starts, 41) << known.name;
    EXPECT_LT(maxima.left, 0.5) << known.name;
    EXPECT_EQ(maxima.found.front().mode.position, mode.position);
  }
}

}  // namespace
}  // namespace wearwell
