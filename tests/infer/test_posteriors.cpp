#include "infer/test_posteriors.h"

#include <fmt/format.h>

#include "support/formula.h"
#include "wearwell/models/joint/archard.h"

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

Parameter with_law(const std::string& name, const Family& family, double lower, double upper,
                   double start) {
  return {name, "1", Unit{"1", 1, 0}, "test", make_distribution(family, lower, upper), start, 1};
}

Posterior formula_posterior(std::vector<Parameter> parameters, Formula::F f) {
  const auto dimension = static_cast<int>(parameters.size());
  return Posterior(std::move(parameters), std::make_shared<Formula>(dimension, std::move(f)));
}

// Only the prior: for laws that test transforms.
Posterior prior_only(const Parameter& parameter) {
  return formula_posterior({parameter}, [](auto, std::span<double> gradient) {
    gradient[0] = 0;
    return 0.0;
  });
}

Posterior multivariate_normal(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) {
  std::vector<Parameter> parameters;
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    parameters.push_back(
        flat_parameter(fmt::format("x{}", i + 1), 0.5, std::sqrt(covariance(i, i))));
  }
  const Eigen::MatrixXd precision = covariance.inverse();
  return formula_posterior(parameters, [=](std::span<const double> x, std::span<double> gradient) {
    const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(x.data(), mean.size()) - mean;
    const Eigen::VectorXd slope = -precision * d;
    Eigen::Map<Eigen::VectorXd>(gradient.data(), mean.size()) = slope;
    return 0.5 * d.dot(slope);
  });
}

KnownPosterior correlated(const std::string& name, int d, double correlation) {
  Eigen::VectorXd mean(d), sd(d);
  for (int i = 0; i < d; ++i) {
    mean[i] = i - 1.0;
    sd[i] = std::pow(10.0, i % 3);
  }
  Eigen::MatrixXd covariance(d, d);
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j)
      covariance(i, j) = sd[i] * sd[j] * std::pow(correlation, std::abs(i - j));
  }
  const std::vector<double> means(mean.begin(), mean.end());
  return {name,
          [=] { return multivariate_normal(mean, covariance); },
          means,
          {sd.begin(), sd.end()},
          means};
}

// Four normals with a correlation of 0.9 between neighbours, of sizes from 1e-13 to 1e6.
KnownPosterior scaled() {
  const Eigen::Vector4d mean(7e-13, 0, 2, -3e6), sd(1e-13, 1e-9, 1, 1e6);
  Eigen::Matrix4d covariance;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) covariance(i, j) = sd[i] * sd[j] * std::pow(0.9, std::abs(i - j));
  }
  const std::vector<double> means(mean.begin(), mean.end());
  const auto make = [=] {
    std::vector<Parameter> parameters = multivariate_normal(mean, covariance).parameters();
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      parameters[i].start = mean[at] + 0.5 * sd[at];
    }
    return Posterior(parameters, multivariate_normal(mean, covariance).likelihood());
  };
  return {"Scaled4", make, means, {sd.begin(), sd.end()}, means};
}

// A narrow ridge that bends: x1 ~ N(0, 1), x2 | x1 ~ N(x1^2/2, 0.25), x3 | x2 ~ N(x2, 0.5), x4 ~
// N(0, 1). E x2 = 1/2, var x2 = 1/2 + 1/16, var x3 = var x2 + 1/4.
Posterior bent_ridge() {
  return formula_posterior(
      {flat_parameter("x1", 0.1, 1), flat_parameter("x2", 0.1, 1), flat_parameter("x3", 0.1, 1),
       flat_parameter("x4", 0.1, 1)},
      [](std::span<const double> x, std::span<double> gradient) {
        const double two = x[1] - 0.5 * x[0] * x[0], three = x[2] - x[1];
        gradient[0] = -x[0] + 16 * x[0] * two;
        gradient[1] = -16 * two + 4 * three;
        gradient[2] = -4 * three;
        gradient[3] = -x[3];
        return -0.5 * (x[0] * x[0] + 16 * two * two + 4 * three * three + x[3] * x[3]);
      });
}

// A regression with three coefficients and p(sigma) ~ 1/sigma, 6 degrees of freedom and s = 2: the
// coefficients are N(mean, sigma^2 C), so Student t, 6 s^2/sigma^2 is chi squared. It opens like a
// funnel.
KnownPosterior regression() {
  constexpr double freedom = 6, s = 2;
  Eigen::Matrix3d c;
  c << 1, 0.6, 0.2, 0.6, 1, 0.5, 0.2, 0.5, 1;
  const Eigen::Matrix3d precision = c.inverse();
  const Eigen::Vector3d mean(1, -2, 3);
  const auto make = [=] {
    return formula_posterior(
        {flat_parameter("b0", 0, 1), flat_parameter("b1", 0, 1), flat_parameter("b2", 0, 1),
         with_law("sigma", Jeffreys{}, 0, infinity, 1)},
        [=](std::span<const double> x, std::span<double> gradient) {
          const Eigen::Vector3d d = Eigen::Vector3d(x[0], x[1], x[2]) - mean;
          const Eigen::Vector3d slope = precision * d;
          const double square = d.dot(slope) + freedom * s * s, variance = x[3] * x[3];
          for (std::size_t i = 0; i < 3; ++i)
            gradient[i] = -slope[static_cast<Eigen::Index>(i)] / variance;
          gradient[3] = (square / variance - (freedom + 3)) / x[3];
          return -(freedom + 3) * std::log(x[3]) - 0.5 * square / variance;
        });
  };
  const double of_sigma =
      s * std::sqrt(0.5 * freedom) * std::tgamma(0.5 * (freedom - 1)) / std::tgamma(0.5 * freedom);
  const double square = s * s * freedom / (freedom - 2), wide = std::sqrt(square);
  return {"Regression4",
          make,
          {1, -2, 3, of_sigma},
          {wide, wide, wide, std::sqrt(square - of_sigma * of_sigma)},
          {}};
}

// Four independent normals, each cut to [0.5, 2].
Posterior truncated() {
  std::vector<Parameter> parameters;
  for (int i = 1; i <= 4; ++i) {
    parameters.push_back(with_law(fmt::format("x{}", i), Normal{0, 1}, 0.5, 2, 1));
  }
  return formula_posterior(parameters, [](auto, std::span<double> gradient) {
    for (double& each : gradient) each = 0;
    return 0.0;
  });
}

// x1 ~ N(0, 1), x2 | x1 ~ N(x1^2/2, 1): E x2 = 1/2, var x2 = 1/2 + 1.
Posterior banana() {
  return formula_posterior({flat_parameter("x1", 0.1, 1), flat_parameter("x2", 0.1, 1)},
                           [](std::span<const double> x, std::span<double> gradient) {
                             const double z = x[1] - 0.5 * x[0] * x[0];
                             gradient[0] = -x[0] + x[0] * z;
                             gradient[1] = -z;
                             return -0.5 * (x[0] * x[0] + z * z);
                           });
}

// Half N(-2, 1), half N(2, 1).
Posterior bimodal() {
  return formula_posterior(
      {flat_parameter("x", 0.3, 1)}, [](std::span<const double> x, std::span<double> gradient) {
        const double right = 1 / (1 + std::exp(-4 * x[0]));  // weight of the right mode
        gradient[0] = -x[0] - 2 + 4 * right;
        const double far = std::abs(x[0]);
        return -0.5 * std::pow(far - 2, 2) + std::log1p(std::exp(-4 * far));
      });
}

}  // namespace

Parameter flat_parameter(const std::string& name, double start, double scale) {
  Parameter parameter = with_law(name, Flat{}, -infinity, infinity, start);
  parameter.scale = scale;
  return parameter;
}

Posterior joint_posterior(bool lognormal, bool tribometer, double upper, std::size_t rows) {
  joint::Inspections inspections;
  for (const double cycles : {1., 100., 1000., 5000., 10000., 20585.}) {
    inspections.work.push_back(cycles * 5.966);
  }
  for (const double volume : {4.44, 5.105, 8.825, 24.175, 45.31, 92.73}) {
    inspections.volume.push_back(volume * 1e-9);
  }
  const Unit rate{"mm^3/(N m)", 1e-9, 0}, volume{"mm^3", 1e-9, 0};
  const Family k_prior = tribometer ? Family(Normal{5.05e-13, 0.74e-13}) : Family(Flat{});
  const Family sigma_prior = std::isfinite(upper) ? Family(Uniform{}) : Family(Flat{});
  std::vector<Parameter> parameters = {
      {"k", "m^3/(N m)", rate, "", make_distribution(k_prior, 0, infinity), 8e-13, 1e-13, 0,
       infinity},
      {"sigma", "m^3", volume, "", make_distribution(sigma_prior, 0, upper * 1e-9), 3e-9, 1e-9, 0,
       infinity}};
  const auto family = lognormal ? ObservationFamily::lognormal : ObservationFamily::normal;
  return Posterior(std::move(parameters), joint::archard_likelihood({}, family, inspections, rows));
}

const std::vector<KnownPosterior>& known_posteriors() {
  static const std::vector<KnownPosterior> list = {
      correlated("Normal", 1, 0),
      correlated("Correlated2", 2, 0.95),
      correlated("Correlated5", 5, 0.7),
      correlated("Correlated4", 4, 0.9),
      scaled(),
      {"BentRidge4",
       bent_ridge,
       {0, 0.5, 0.5, 0},
       {1, std::sqrt(0.5625), std::sqrt(0.8125), 1},
       {}},
      regression(),
      // As "Truncated" below, four times.
      {"Truncated4", truncated, std::vector<double>(4, 1.04299333414245),
       std::vector<double>(4, 0.387661606931559), std::vector<double>(4, 0.971523471729424)},
      {"Banana", banana, {0, 0.5}, {1, std::sqrt(1.5)}, {}},
      {"Bimodal", bimodal, {0}, {std::sqrt(5.0)}, {0}},
      {"HalfBounded",
       [] {
         return prior_only(with_law("x", Gamma{2, 3}, 0, infinity, 4));
       },
       {6},
       {std::sqrt(18.0)},
       {5.03504097004998}},  // R: qgamma(0.5, 2, scale = 3)
      // Normal(0, 1) on [0.5, 2]; R: (dnorm(.5) - dnorm(2))/(pnorm(2) - pnorm(.5)) and so on.
      {"Truncated",
       [] {
         return prior_only(with_law("x", Normal{0, 1}, 0.5, 2, 1));
       },
       {1.04299333414245},
       {0.387661606931559},
       {0.971523471729424}},
      {"StudentTail",
       [] {
         return prior_only(with_law("x", StudentT{5, 1, 2}, -infinity, infinity, 0));
       },
       {1},
       {2 * std::sqrt(5.0 / 3)},
       {1}},
      {"JointNormal",
       [] { return joint_posterior(false, false, 15, 5); },
       {7.75918e-13, 5.63111e-9},
       {0.920453e-13, 2.50923e-9},
       {}},
      {"JointLognormal",
       [] { return joint_posterior(true, false, 7, 6); },
       {7.6352e-13, 3.03436e-9},
       {0.236842e-13, 1.35395e-9},
       {}},
  };
  return list;
}

}  // namespace wearwell
