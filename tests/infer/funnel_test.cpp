// As many rows as the mean has parameters: the density rises without end towards sigma = 0, the mass does not.
#include "wearwell/infer/funnel.h"

#include <gmock/gmock.h>

#include <array>

#include "support/formula.h"
#include "wearwell/infer/constrained_mode.h"
#include "wearwell/infer/trust.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

using Rows = std::vector<std::array<double, 2>>;

constexpr double sd_of_a = 2, sd_of_b = 1, scale_of_sigma = 1.5;

Parameter parameter(const std::string& name, const Distribution& prior, double start) {
  const double natural_lower = prior.lower == 0 ? 0 : -infinity;
  return {name, "1", Unit{"1", 1, 0}, "", prior, start, 1, natural_lower, infinity};
}

// y = a + b x with normal scatter; every prior is proper.
Posterior line(const Rows& rows, double sigma_start) {
  return {
      {parameter("a", make_distribution(Normal{0, sd_of_a}, -infinity, infinity), 0.3),
       parameter("b", make_distribution(Normal{0, sd_of_b}, -infinity, infinity), -0.2),
       parameter("sigma", make_distribution(Normal{0, scale_of_sigma}, 0, infinity), sigma_start)},
      std::make_shared<Formula>(3, [=](std::span<const double> p, std::span<double> gradient) {
        double sum = 0;
        gradient[0] = gradient[1] = gradient[2] = 0;
        for (const auto& [x, y] : rows) {
          const double z = (y - p[0] - p[1] * x) / p[2];
          sum -= 0.5 * z * z + std::log(p[2]) + half_log_two_pi;
          gradient[0] += z / p[2];
          gradient[1] += z * x / p[2];
          gradient[2] += (z * z - 1) / p[2];
        }
        return sum;
      })};
}

struct Moments {
  double log_evidence, mean, sd;  // of sigma
};

// With a and b integrated out in closed form: y is normal about 0 with covariance X S X' + sigma^2.
Moments reference(const Rows& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd spread(n, n);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    y[i] = rows[static_cast<std::size_t>(i)][1];
    for (Eigen::Index j = 0; j < n; ++j) {
      spread(i, j) = sd_of_a * sd_of_a + sd_of_b * sd_of_b * rows[static_cast<std::size_t>(i)][0] *
                                             rows[static_cast<std::size_t>(j)][0];
    }
  }
  double mass = 0, first = 0, second = 0;
  constexpr double step = 1e-3;
  for (double sigma = 0.5 * step; sigma < 12; sigma += step) {
    const Eigen::LLT<Eigen::MatrixXd> root(spread +
                                           sigma * sigma * Eigen::MatrixXd::Identity(n, n));
    const double log_determinant =
        2 * root.matrixL().toDenseMatrix().diagonal().array().log().sum();
    const double prior = 2 / (scale_of_sigma * std::sqrt(2 * M_PI)) *
                         std::exp(-0.5 * std::pow(sigma / scale_of_sigma, 2));
    const double density = prior * std::exp(-0.5 * y.dot(root.solve(y)) - 0.5 * log_determinant -
                                            static_cast<double>(n) * half_log_two_pi);
    mass += step * density;
    first += step * density * sigma;
    second += step * density * sigma * sigma;
  }
  return {std::log(mass), first / mass, std::sqrt(second / mass - std::pow(first / mass, 2))};
}

struct Outcome {
  Fit fit;
  NaturalMode mode;
  std::vector<Check> checks;
};

Outcome outcome(const Posterior& posterior) {
  FitSettings settings;
  settings.extend = true;
  settings.run.warmup = 300;
  settings.run.draws = 500;
  Fit found = fit(posterior, settings);
  NaturalMode mode = constrained_mode(posterior, found);
  for (StageDiagnostic& each : later_stage_diagnostics(posterior, found, mode)) {
    found.stage_diagnostics.push_back(std::move(each));
  }
  std::vector<Check> checks = trust_checks(posterior, found);
  return {std::move(found), std::move(mode), std::move(checks)};
}

TEST(Funnel, TwoRowsOfALineAreRightAndTrusted) {
  const Rows rows = {{1, 0.7}, {2, 1.4}};
  for (const double start : {1e-12, 0.01, 1.0, 5.0}) {  // however far in the throat
    SCOPED_TRACE(start);
    const Outcome here = outcome(line(rows, start));
    ASSERT_TRUE(here.fit.exact) << here.fit.no_exact;
    const Moments exact = reference(rows);
    EXPECT_NEAR(*here.fit.exact->log_evidence, exact.log_evidence, 1e-4);
    EXPECT_NEAR(here.fit.exact->mean[2], exact.mean, 1e-3 * exact.sd);
    EXPECT_NEAR(here.fit.exact->sd[2], exact.sd, 1e-3 * exact.sd);
    EXPECT_TRUE(trusted(here.checks));
    EXPECT_THAT(here.mode.problem, HasSubstr("is unbounded as sigma approaches its lower bound"));
    EXPECT_FALSE(here.mode.fell_short);
    EXPECT_EQ(here.fit.method, Method::exact);
    ASSERT_EQ(here.fit.stage_diagnostics.size(), 1u);
    EXPECT_EQ(here.fit.stage_diagnostics[0].verdict, Verdict::warn);
    EXPECT_THAT(here.fit.stage_diagnostics[0].what, HasSubstr("the draws are those of quadrature"));
  }
}

// The middle lies where the marginal density of log sigma is highest, the others at their conditional mode.
TEST(Funnel, ItsMiddleIsThatOfTheMass) {
  const Rows rows = {{1, 0.7}, {2, 1.4}};
  const Posterior posterior = line(rows, 0.01);
  const auto funnel = funnel_middle(posterior, posterior.start());
  ASSERT_TRUE(funnel);
  EXPECT_EQ(funnel->scale, 2);
  std::vector<double> x(3);
  posterior.to_natural({funnel->middle.position.data(), 3}, x);
  const Moments exact = reference(rows);
  EXPECT_GT(x[2], 0.3 * exact.mean);
  EXPECT_LT(x[2], 2 * exact.mean);
}

// Three rows hold sigma: there is a mode, and no throat.
TEST(Funnel, MoreRowsThanParametersHaveNone) {
  const Outcome here = outcome(line({{1, 0.7}, {2, 1.4}, {3, 1.6}}, 1));
  EXPECT_EQ(here.mode.problem, "");
  EXPECT_TRUE(here.fit.stage_diagnostics.empty());
  EXPECT_EQ(here.fit.method, Method::nuts);
}

// Points exactly on a line beyond what its parameters need: mass without end at sigma = 0, proper priors or not.
TEST(Funnel, PointsOnALineStayImproper) {
  for (const double start : {0.01, 1.0}) {
    const Outcome here = outcome(line({{1, 0.5}, {2, 1}, {3, 1.5}}, start));
    EXPECT_EQ(here.checks[0].name, "proper-posterior");
    EXPECT_EQ(here.checks[0].verdict, Verdict::fail);
    EXPECT_FALSE(trusted(here.checks));
  }
}

}  // namespace
}  // namespace wearwell
