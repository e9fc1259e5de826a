// Leave-one-out of very many observations from few points, against its closed form.
#include "wearwell/infer/loo_at_points.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>

#include "infer/test_posteriors.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/psis_loo.h"

namespace wearwell {
namespace {

// Observations y ~ N(x b, sigma), by the coefficients b and log sigma.
class NormalRegression final : public LogDensity {
 public:
  NormalRegression(Eigen::MatrixXd x, Eigen::VectorXd y) : x_(std::move(x)), y_(std::move(y)) {
    products_ = x_.transpose() * x_;
    best_ = products_.llt().solve(x_.transpose() * y_);
    squares_ = (y_ - x_ * best_).squaredNorm();
  }
  int dimension() const override { return static_cast<int>(x_.cols()) + 1; }
  double value(std::span<const double> at) const override {
    const double log_sigma = at.back(), s = std::exp(log_sigma);
    return -count() * (log_sigma + 0.5 * std::log(2 * std::numbers::pi)) -
           0.5 * about(at) / (s * s);
  }
  double value_and_gradient(std::span<const double> at, std::span<double> gradient) const override {
    const double s = std::exp(at.back());
    const Eigen::VectorXd by = products_ * (best_ - coefficients(at)) / (s * s);
    for (Eigen::Index a = 0; a < by.size(); ++a) gradient[static_cast<std::size_t>(a)] = by[a];
    gradient.back() = about(at) / (s * s) - count();
    return value(at);
  }
  std::vector<double> pointwise(std::span<const double> at) const override {
    const double s = std::exp(at.back());
    const Eigen::VectorXd z = (y_ - x_ * coefficients(at)) / s;
    std::vector<double> terms;
    for (const double each : z)
      terms.push_back(-at.back() - 0.5 * std::log(2 * std::numbers::pi) - 0.5 * each * each);
    return terms;
  }
  // Under a prior that is flat in b and log sigma Student's t of all others (Gelman et al. 2013, sec. 14.2), whose residual and sum of
  // squares follow from the leverage (Cook and Weisberg 1982, sec. 2.2).
  double elpd(Eigen::Index i) const {
    const double leverage = x_.row(i) * products_.llt().solve(x_.row(i).transpose());
    const double residual = y_[i] - x_.row(i).dot(best_);
    const double freedom = count() - 1 - static_cast<double>(x_.cols());
    const double squares = squares_ - residual * residual / (1 - leverage);
    const double scale = std::sqrt(squares / freedom / (1 - leverage));
    return std::log(
        boost::math::pdf(boost::math::students_t(freedom), residual / (1 - leverage) / scale) /
        scale);
  }

 private:
  double count() const { return static_cast<double>(y_.size()); }
  Eigen::VectorXd coefficients(std::span<const double> at) const {
    return Eigen::Map<const Eigen::VectorXd>(at.data(), x_.cols());
  }
  double about(std::span<const double> at) const {
    const Eigen::VectorXd off = coefficients(at) - best_;
    return squares_ + off.dot(products_ * off);
  }
  Eigen::MatrixXd x_, products_;
  Eigen::VectorXd y_, best_;
  double squares_ = 0;
};

struct Sample {
  std::shared_ptr<const NormalRegression> likelihood;
  Posterior posterior;
  Fit fitted;
};

Sample sample(int count, int coefficients, double outlier = 0) {
  Rng rng(20261125, 3);
  Eigen::MatrixXd x(count, coefficients);
  Eigen::VectorXd y(count);
  for (int i = 0; i < count; ++i) {
    for (int a = 0; a < coefficients; ++a) x(i, a) = a == 0 ? 1 : rng.normal();
    y[i] = 5 * x.row(i).sum() + 2 * rng.normal();
  }
  if (outlier > 0) y[0] = outlier;
  auto likelihood = std::make_shared<const NormalRegression>(x, y);
  std::vector<Parameter> parameters;
  for (int a = 0; a < coefficients; ++a)
    parameters.push_back(flat_parameter("b" + std::to_string(a), 5, 1));
  parameters.push_back(flat_parameter("log_sigma", 0.7, 1));
  Posterior posterior(parameters, likelihood);
  FitSettings settings;
  settings.method = Method::exact;
  Fit fitted = fit(posterior, settings);
  return {likelihood, posterior, std::move(fitted)};
}

TEST(LooAtPoints, IsTheClosedFormOfARegression) {
  for (const int coefficients : {1, 2, 3}) {
    const Sample s = sample(20'000, coefficients);
    ASSERT_TRUE(s.fitted.exact);
    ASSERT_TRUE(s.fitted.quick);
    const auto loo = loo_at_points(s.posterior, s.fitted, nullptr);
    ASSERT_TRUE(loo);
    EXPECT_TRUE(loo->by_quadrature);
    double exact = 0;
    for (std::size_t i = 0; i < loo->terms.size(); ++i) {
      const double elpd = s.likelihood->elpd(static_cast<Eigen::Index>(i));
      exact += elpd;
      // The posterior of log sigma is skewed, of which observations far out feel most.
      EXPECT_NEAR(loo->terms[i].elpd, elpd, 5e-6) << i;
    }
    EXPECT_NEAR(loo->elpd(), exact, 2 * loo->error);
    EXPECT_LE(loo->error, 0.01);
    EXPECT_NEAR(loo->p_loo(), coefficients + 1, 0.15);  // of a right distribution
    // One observation has 1/n of what is known of a mean; the outermost ones more, of the scatter too.
    EXPECT_GT(loo->khat_max(), 1.0 / 20'000);
    EXPECT_LT(loo->khat_max(), 40.0 / 20'000);
    // What leave_one_out gives.
    EXPECT_EQ(leave_one_out(s.posterior, s.fitted).elpd(), loo->elpd());
  }
}

TEST(LooAtPoints, IsNotForAnObservationThatMovesThePosterior) {
  const Sample s = sample(20'000, 1, 300);
  ASSERT_TRUE(s.fitted.exact);
  EXPECT_FALSE(loo_at_points(s.posterior, s.fitted, nullptr));
}

// Four parameters have polynomials only of so many observations that these pay, and these are the likelihood.
TEST(LooAtPoints, FourParametersHavePolynomialsOfVeryManyObservations) {
  EXPECT_FALSE(sample(19'000, 3).fitted.quick);
  const Sample s = sample(20'000, 3);
  ASSERT_TRUE(s.fitted.quick);
  EXPECT_LE(s.fitted.quick_error, 1e-5);
  Rng rng(20261125, 4);
  Eigen::VectorXd slope(4), slope_there(4);
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXd u(4);
    for (double& each : u) each = rng.normal();
    const Eigen::VectorXd z = s.fitted.whitening(u);
    const std::span<const double> at(z.data(), 4);
    const double truth = s.posterior.value_and_gradient(at, {slope.data(), 4});
    EXPECT_NEAR(s.fitted.quick->value_and_gradient(at, {slope_there.data(), 4}), truth, 1e-5);
    const Eigen::VectorXd off = s.fitted.whitening.scale.transpose() * (slope_there - slope);
    EXPECT_LE(off.cwiseAbs().maxCoeff(), 1e-4);
  }
}

}  // namespace
}  // namespace wearwell
