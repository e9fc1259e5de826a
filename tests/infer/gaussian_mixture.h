#pragma once

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <vector>

#include "infer/test_posteriors.h"
#include "support/formula.h"

namespace wearwell {

/// A posterior of several modes in closed form: normal distributions with known weights. Component k has the mean `means[k]` and
/// the covariance sds[k]^2 with `correlation` between neighbouring axes.
struct GaussianMixture {
  std::vector<double> weights;
  std::vector<Eigen::VectorXd> means;
  std::vector<Eigen::VectorXd> sds;
  double correlation = 0;

  Eigen::Index dimension() const { return means.front().size(); }

  Eigen::VectorXd mean() const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(dimension());
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * means[k];
    return sum;
  }
  Eigen::VectorXd sd() const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(dimension());
    for (std::size_t k = 0; k < weights.size(); ++k)
      sum += weights[k] * (sds[k].cwiseAbs2() + (means[k] - mean()).cwiseAbs2());
    return sum.cwiseSqrt();
  }

  Eigen::MatrixXd covariance(std::size_t k) const {
    Eigen::MatrixXd all(dimension(), dimension());
    for (Eigen::Index i = 0; i < dimension(); ++i) {
      for (Eigen::Index j = 0; j < dimension(); ++j)
        all(i, j) = sds[k][i] * sds[k][j] * std::pow(correlation, std::abs(i - j));
    }
    return all;
  }

  /// Searches start at `start`; every prior is `prior` between -half and half.
  Posterior posterior(double start, const Family& prior, double half) const {
    std::vector<Parameter> parameters;
    for (Eigen::Index i = 0; i < dimension(); ++i) {
      parameters.push_back(flat_parameter(fmt::format("x{}", i + 1), start, 1));
      parameters.back().prior = make_distribution(prior, -half, half);
    }
    struct Component {
      Eigen::VectorXd mean;
      Eigen::MatrixXd precision;
      double log_height;
    };
    std::vector<Component> components;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const Eigen::MatrixXd c = covariance(k);
      components.push_back(
          {means[k], c.inverse(), std::log(weights[k]) - 0.5 * std::log(c.determinant())});
    }
    const auto d = static_cast<int>(dimension());
    return Posterior(
        std::move(parameters),
        std::make_shared<Formula>(d, [=](std::span<const double> x, std::span<double> gradient) {
          const Eigen::Map<const Eigen::VectorXd> at(x.data(), d);
          std::vector<double> terms;
          std::vector<Eigen::VectorXd> slopes;
          double top = -INFINITY, sum = 0;
          for (const Component& each : components) {
            slopes.emplace_back(-each.precision * (at - each.mean));
            terms.push_back(each.log_height + 0.5 * (at - each.mean).dot(slopes.back()));
            top = std::max(top, terms.back());
          }
          Eigen::VectorXd slope = Eigen::VectorXd::Zero(d);
          for (std::size_t k = 0; k < terms.size(); ++k) {
            sum += std::exp(terms[k] - top);
            slope += std::exp(terms[k] - top) * slopes[k];
          }
          Eigen::Map<Eigen::VectorXd>(gradient.data(), d) = slope / sum;
          return top + std::log(sum);
        }));
  }
};

}  // namespace wearwell
