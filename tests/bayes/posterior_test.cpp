#include "wearwell/bayes/posterior.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "support/between.h"
#include "wearwell/base/error.h"
#include "wearwell/bayes/observation.h"
#include "wearwell/bayes/posterior_along.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// y_i = offset + rate t_i with scatter sigma; parameters rate, sigma, offset, of which the last may
// be left out (0), and sigma too (1).
class Line final : public LogDensity {
 public:
  Line(int dimension, ObservationFamily family) : dimension_(dimension), y_(family, {1.4, 2.5}) {}

  int dimension() const override { return dimension_; }
  double value(std::span<const double> x) const override {
    const double padded[] = {x[0], dimension_ > 1 ? x[1] : 0, dimension_ > 2 ? x[2] : 0};
    return formula(padded);
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<3>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }

 private:
  template <class T>
  T formula(const T* x) const {
    return y_.log_likelihood([&](std::size_t i) { return x[2] + x[0] * (1.0 + 1.5 * i); },
                             dimension_ > 1 ? x[1] : T(1));
  }

  int dimension_;
  Observations y_;
};

std::shared_ptr<const LogDensity> line(int dimension,
                                       ObservationFamily family = ObservationFamily::normal) {
  return std::make_shared<Line>(dimension, family);
}

Parameter parameter(const std::string& name, const Distribution& prior, double start) {
  Parameter p{name, "1", Unit{"1", 1, 0}, "", prior};
  p.start = start;
  p.scale = 0.7;
  return p;
}

const std::vector<Distribution>& rates() {
  static const std::vector<Distribution> distributions = {
      make_distribution(Flat{}, 0, infinity),       make_distribution(Normal{1, 0.5}, 0, infinity),
      make_distribution(Lognormal{1, 1}, 0, 7),     make_distribution(Gamma{2, 0.6}, 0, infinity),
      make_distribution(StudentT{3, 1, 2}, 0.1, 4), make_distribution(Normal{1, 2}, 0, infinity),
      make_distribution(Jeffreys{}, 0.01, infinity)};
  return distributions;
}
const std::vector<Distribution>& sigmas() {
  static const std::vector<Distribution> distributions = {
      make_distribution(Uniform{}, 0, 5), make_distribution(StudentT{1, 0, 1}, 0, infinity),
      make_distribution(InverseGamma{2, 1}, 0, infinity),
      make_distribution(Jeffreys{}, 0, infinity), make_distribution(Gamma{1, 2}, 0, infinity)};
  return distributions;
}
const std::vector<Distribution>& offsets() {
  static const std::vector<Distribution> distributions = {
      make_distribution(Normal{0, 1}, -infinity, infinity),
      make_distribution(StudentT{4, 0, 1}, -infinity, 1), make_distribution(Beta{2, 3}, 0, 1),
      make_distribution(Flat{}, -infinity, infinity)};
  return distributions;
}

const Distribution& any(const std::vector<Distribution>& distributions) {
  return distributions[*rc::gen::inRange<std::size_t>(0, distributions.size())];
}

RC_GTEST_PROP(Posterior, GradientIsTheDifferenceQuotient, ()) {
  const auto family = *rc::gen::element(ObservationFamily::normal, ObservationFamily::lognormal);
  std::vector<Parameter> parameters = {parameter("rate", any(rates()), 1),
                                       parameter("sigma", any(sigmas()), 0.8),
                                       parameter("offset", any(offsets()), 0.3)};
  parameters.resize(*rc::gen::inRange<std::size_t>(1, 4));
  const int n = static_cast<int>(parameters.size());
  const Posterior posterior(parameters, line(n, family));
  Eigen::VectorXd z = posterior.start(), gradient(n), x(n);
  for (double& each : z) each += *between(0.01, 2) - 1;
  const double value = posterior.value_and_gradient(view(z), view(gradient));
  RC_ASSERT(value == posterior.value(view(z)) ||
            std::abs(value - posterior.value(view(z))) < 1e-12 * std::abs(value));
  // A lognormal mean at 0 is a singularity; differences near it say nothing.
  posterior.to_natural(view(z), view(x));
  if (n == 3 && family == ObservationFamily::lognormal && x[0] + x[2] < 0.2) return;
  RC_ASSERT(std::isfinite(value));
  const double h = 1e-4;
  for (int i = 0; i < n; ++i) {
    Eigen::VectorXd left = z, right = z;
    left[i] -= h;
    right[i] += h;
    const double quotient = (posterior.value(view(right)) - posterior.value(view(left))) / (2 * h);
    // The neglected third derivative, and the rounding of the values.
    RC_ASSERT(std::abs(quotient - gradient[i]) <
              1e-5 * (1 + std::abs(value) + std::abs(gradient[i])));
  }
}

// Along each axis, inside and where doubles end.
RC_GTEST_PROP(Posterior, AlongAnAxisItIsTheSame, ()) {
  std::vector<Parameter> parameters = {parameter("rate", any(rates()), 1),
                                       parameter("sigma", any(sigmas()), 0.8),
                                       parameter("offset", any(offsets()), 0.3)};
  parameters.resize(*rc::gen::inRange<std::size_t>(1, 4));
  const int n = static_cast<int>(parameters.size());
  const Posterior posterior(parameters, line(n));
  Eigen::VectorXd z = posterior.start(), x(n);
  for (double& each : z) each += *between(0.01, 2) - 1;
  if (*rc::gen::inRange(0, 8) == 0) z[n - 1] = -1e4;
  for (int axis = 0; axis < n; ++axis) {
    PosteriorAlong along(posterior, view(z), static_cast<std::size_t>(axis));
    for (const double at : {z[axis], z[axis] + *between(0.01, 2), -1e4, 1e4}) {
      Eigen::VectorXd there = z;
      there[axis] = at;
      RC_ASSERT(along.value(at) == posterior.value(view(there)));
      posterior.to_natural(view(there), view(x));
      for (int i = 0; i < n; ++i) RC_ASSERT(along.natural()[static_cast<std::size_t>(i)] == x[i]);
    }
  }
}

double integral(const std::function<double(double)>& f, double lower, double upper) {
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, lower, upper, 12, 1e-10);
}

// The Jacobian keeps the mass: in z and in x the same integral.
TEST(Posterior, MassInOneDimension) {
  const std::vector<Distribution> distributions = {
      make_distribution(Normal{0, 2}, -infinity, infinity),
      make_distribution(Gamma{2.5, 1}, 0, infinity),
      make_distribution(Lognormal{1, 1}, 0.5, infinity),
      make_distribution(StudentT{3, 0, 1}, -infinity, 1.5), make_distribution(Uniform{}, -1, 3)};
  for (std::size_t i = 0; i < distributions.size(); ++i) {
    const Posterior posterior({parameter("rate", distributions[i], 1)}, line(1));
    const double in_z = integral(
        [&](double z) {
          return std::exp(posterior.value({&z, 1}));
        },
        -infinity, infinity);
    const double in_x = integral(
        [&](double x) {
          return std::exp(posterior.natural_value({&x, 1}));
        },
        distributions[i].lower, distributions[i].upper);
    EXPECT_NEAR(in_z / in_x, 1, 1e-8) << i;
  }
}

TEST(Posterior, MassInTwoDimensions) {
  const Distribution rate = make_distribution(Lognormal{1, 0.5}, 0, infinity),
                     sigma = make_distribution(Uniform{}, 0.2, 3);
  const Posterior posterior({parameter("rate", rate, 1), parameter("sigma", sigma, 1)}, line(2));
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  const auto nested = [](const auto& f, double a, double b, double c, double d) {
    return Rule::integrate(
        [&](double u) {
          return Rule::integrate([&](double v) { return std::exp(f(u, v)); }, c, d, 6, 1e-8);
        },
        a, b, 6, 1e-8);
  };
  const double in_z = nested(
      [&](double u, double v) {
        const double z[] = {u, v};
        return posterior.value(z);
      },
      -infinity, infinity, -infinity, infinity);
  const double in_x = nested(
      [&](double u, double v) {
        const double x[] = {u, v};
        return posterior.natural_value(x);
      },
      rate.lower, rate.upper, sigma.lower, sigma.upper);
  EXPECT_NEAR(in_z / in_x, 1, 1e-6);
}

TEST(Posterior, NaturalValueIsPriorTimesLikelihood) {
  const Distribution rate = make_distribution(Normal{1, 0.5}, 0, infinity),
                     sigma = make_distribution(Uniform{}, 0, 4);
  const Posterior posterior({parameter("rate", rate, 1), parameter("sigma", sigma, 1)}, line(2));
  const std::vector<double> x{1.2, 0.5};
  // R 4.2.2: dnorm(1.2, 1, .5, TRUE) - pnorm(2, log = TRUE) - log(4)
  //          sum(dnorm(c(1.4, 2.5), 1.2 * c(1, 2.5), .5, TRUE))
  EXPECT_NEAR(posterior.log_prior(x), -1.6690728044356544, 1e-14);
  EXPECT_NEAR(posterior.natural_value(x), -1.6690728044356544 - 1.0315827052894548, 1e-14);
}

TEST(Posterior, OutsideTheSupport) {
  const Posterior posterior({parameter("rate", make_distribution(Flat{}, 0, infinity), 1),
                             parameter("sigma", make_distribution(Uniform{}, 0, 4), 1)},
                            line(2));
  const std::vector<std::vector<double>> outside = {{0, 1}, {-1, 1}, {1, 0}, {1, 4}, {1, 5}};
  for (const auto& x : outside) EXPECT_EQ(posterior.natural_value(x), -infinity);
  std::vector<double> gradient(2);
  // Where doubles end: exp(+-1e4), and a sigma that rounds to its bound.
  const std::vector<std::vector<double>> far = {{1e4, 0}, {-1e4, 0}, {0, 50}, {0, -1e4}};
  for (const auto& z : far) {
    EXPECT_EQ(posterior.value(z), -infinity);
    EXPECT_EQ(posterior.value_and_gradient(z, gradient), -infinity);
  }
}

TEST(Posterior, NaturalAndReal) {
  const Posterior posterior({parameter("rate", make_distribution(Flat{}, 0, infinity), 1),
                             parameter("sigma", make_distribution(Uniform{}, 0, 4), 1)},
                            line(2));
  const std::vector<double> x{2.5, 3.5};
  const Eigen::VectorXd z = posterior.to_real(x);
  std::vector<double> back(2);
  posterior.to_natural(view(z), back);
  EXPECT_DOUBLE_EQ(back[0], 2.5);
  EXPECT_DOUBLE_EQ(back[1], 3.5);
  EXPECT_DOUBLE_EQ(posterior.start()[0], 0);
  EXPECT_DOUBLE_EQ(posterior.start()[1], std::log(1. / 3));
}

TEST(Posterior, RefusesWhatCannotBeFitted) {
  const Distribution positive = make_distribution(Flat{}, 0, infinity);
  EXPECT_THROW(Posterior({parameter("rate", positive, -1)}, line(1)), InputError);
  EXPECT_THROW(Posterior({parameter("rate", positive, 1)}, line(2)), std::logic_error);
  // A lognormal line that falls below 0 wherever the prior allows.
  const Distribution negative = make_distribution(Flat{}, -infinity, -1);
  EXPECT_THROW(Posterior({parameter("rate", negative, -2)}, line(1, ObservationFamily::lognormal)),
               InputError);
}

}  // namespace
}  // namespace wearwell
