// The error that quadrature says it reached bounds the one it made: over posteriors that bounds cut,
// against sums over dense grids, where the one parameter in which a posterior is normal is integrated
// by formula.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "infer/normal_reference.h"
#include "infer/test_posteriors.h"
#include "support/formula.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/mode.h"
#include "wearwell/math/quadrature.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/models/joint/archard.h"

namespace wearwell {
namespace {

// The error is of mass and all second moments together, so that of one of them may be a few times larger.
constexpr double allowed = 3;

struct Moments {
  std::vector<double> mean, sd;
};

// Of points that come one by one, each with variances of its own.
class Sum {
 public:
  explicit Sum(std::vector<double> about)
      : about_(std::move(about)), first_(about_.size()), second_(first_) {}
  void add(double weight, const std::vector<double>& mean, const std::vector<double>& variance) {
    mass_ += weight;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double t = mean[i] - about_[i];
      first_[i] += weight * t;
      second_[i] += weight * (t * t + variance[i]);
    }
  }
  Moments moments() const {
    Moments all;
    for (std::size_t i = 0; i < about_.size(); ++i) {
      const double m = first_[i] / mass_;
      all.mean.push_back(about_[i] + m);
      all.sd.push_back(std::sqrt(second_[i] / mass_ - m * m));
    }
    return all;
  }

 private:
  std::vector<double> about_, first_, second_;
  double mass_ = 0;
};

Parameter uniform(const std::string& name, double lower, double upper, double start) {
  return {name, "1", Unit{"1", 1, 0}, "test", make_distribution(Uniform{}, lower, upper), start, 1};
}

void compare(const std::string& what, const Posterior& posterior, const Moments& truth) {
  const ExactPosterior exact =
      integrate(posterior, whitening_at(find_mode(posterior, posterior.start())));
  EXPECT_EQ(exact.failure, "") << what;
  EXPECT_LE(exact.error, 1e-5) << what;
  for (std::size_t i = 0; i < truth.mean.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double of_mean = std::abs(exact.mean[at] - truth.mean[i]) / truth.sd[i];
    const double of_square = std::abs(std::pow(exact.sd[at] / truth.sd[i], 2) - 1);
    EXPECT_LE(of_mean, allowed * exact.error) << what << ", mean of parameter " << i;
    EXPECT_LE(of_square, allowed * exact.error) << what << ", variance of parameter " << i;
  }
}

struct Range {
  double lower, upper;
};

// Life tests under a = N^b S with normal scatter of log10 N: given b and sigma, log10_a is normal, cut.
struct SnCase {
  std::vector<double> log10_stress, log10_life;
  Range a, b, sigma;

  Moments truth() const {
    const auto n = static_cast<double>(log10_life.size());
    const GaussLegendre rule = gauss_legendre(12);
    constexpr int panels = 40;
    Sum sum(
        {0.5 * (a.lower + a.upper), 0.5 * (b.lower + b.upper), 0.5 * (sigma.lower + sigma.upper)});
    for (int i = 0; i < 12 * panels; ++i) {
      const auto at = static_cast<std::size_t>(i % 12);
      const double share = (i / 12 + 0.5 * (1 + rule.node[at])) / panels;
      const double slope = b.lower + share * (b.upper - b.lower);
      double mean = 0, squares = 0;
      for (std::size_t k = 0; k < log10_life.size(); ++k)
        mean += (log10_stress[k] - slope * log10_life[k]) / n;
      for (std::size_t k = 0; k < log10_life.size(); ++k) {
        squares += std::pow(log10_stress[k] - slope * log10_life[k] - mean, 2);
      }
      for (int j = 0; j < 12 * panels; ++j) {
        const auto of = static_cast<std::size_t>(j % 12);
        const double along = (j / 12 + 0.5 * (1 + rule.node[of])) / panels;
        const double s = sigma.lower * std::pow(sigma.upper / sigma.lower, along);
        const double sd = s * std::abs(slope) / std::sqrt(n);
        const double lower = (a.lower - mean) / sd, upper = (a.upper - mean) / sd;
        const double inside = below(upper) - below(lower);
        if (!(inside > 1e-12)) continue;
        const double log = -n * std::log(s) - squares / (2 * std::pow(s * slope, 2));
        const double weight =
            std::exp(log - reference_log(n)) * sd * inside * s * rule.weight[at] * rule.weight[of];
        const double shift = (density(lower) - density(upper)) / inside;
        const double tail =
            ((std::isfinite(lower) ? lower * density(lower) : 0) - upper * density(upper)) / inside;
        sum.add(weight, {mean + sd * shift, slope, s},
                {sd * sd * (1 + tail - shift * shift), 0, 0});
      }
    }
    return sum.moments();
  }
  // About the largest log likelihood, whatever the scatter.
  double reference_log(double n) const { return -n * std::log(center_sigma) - 0.5 * n; }
  double center_sigma = 0.2;

  Posterior posterior() const {
    fatigue::SnLaw law;
    law.correction = fatigue::MeanStress::none;
    fatigue::LifeTests tests;
    for (std::size_t i = 0; i < log10_life.size(); ++i) {
      tests.push_back({{std::pow(10, log10_stress[i]), 0},
                       fatigue::Outcome::failure,
                       std::pow(10, log10_life[i]),
                       0,
                       1});
    }
    const auto middle = [](const Range& r) { return 0.5 * (r.lower + r.upper); };
    const double from = std::clamp(center_sigma, sigma.lower * 1.01, sigma.upper * 0.99);
    return Posterior(
        {uniform("log10_a", a.lower, a.upper, middle(a)), uniform("b", b.lower, b.upper, middle(b)),
         uniform("sigma", sigma.lower, sigma.upper, from)},
        fatigue::sn_likelihood(law, tests, tests.size()));
  }
};

// tests/golden/spring_grid.py
TEST(ExactError, SpringsBySmithWatsonTopper) {
  SnCase springs;
  const double mean[] = {1005.5, 1049.0, 1025.8, 1048.7, 1070.4, 1116.5, 1150.7, 1150.7, 1150.7};
  const double amplitude[] = {271.1, 279.8, 285.9, 276.8, 265.4, 242.0, 259.7, 259.7, 259.7};
  const double life[] = {0.700, 1.153, 0.855, 0.820, 1.020, 0.849, 1.279, 1.153, 1.172};
  for (int i = 0; i < 9; ++i) {
    springs.log10_stress.push_back(0.5 *
                                   std::log10((mean[i] + amplitude[i]) * amplitude[i] * 1e12));
    springs.log10_life.push_back(5 + std::log10(life[i]));
  }
  springs.a = {8, 10};
  springs.b = {-0.1, -0.06};
  springs.sigma = {0.01, 0.6};
  const Moments golden = {{9.2143606217, -0.0873895165788, 0.201083099935},
                          {0.0491956392999, 0.00977894118180, 0.0643253508422}};
  const Moments here = springs.truth();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(here.mean[i], golden.mean[i], 1e-9);
    EXPECT_NEAR(here.sd[i], golden.sd[i], 1e-8 * golden.sd[i]);
  }
  compare("springs", springs.posterior(), golden);
}

// Few tests at two to five stresses; the bounds of b lie from half a standard deviation to six of them
// about where it would be without, not in the middle.
TEST(ExactError, SnPosteriorsThatBoundsCut) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    Rng rng(20261201, seed);
    SnCase test;
    const int levels = 2 + static_cast<int>(4 * rng.uniform()),
              each = 2 + static_cast<int>(3 * rng.uniform());
    const double b = -0.05 - 0.15 * rng.uniform(), sigma = 0.05 + 0.3 * rng.uniform();
    double spread = 0;
    for (int i = 0; i < levels * each; ++i) {
      const double s = std::log10(250e6) + 0.25 * (i % levels) / (levels - 1);
      test.log10_stress.push_back(s);
      test.log10_life.push_back((s - 9.2) / b + sigma * rng.normal());
      spread += std::pow((s - std::log10(250e6) - 0.125) / b, 2);
    }
    const double sd = std::abs(b) * sigma / std::sqrt(spread);
    const auto reach = [&] { return sd * 0.5 * std::exp(2.5 * rng.uniform()); };
    test.b = {b - reach(), std::min(b + reach(), -0.01)};
    test.b.lower = std::max(test.b.lower, 3 * b);
    const double width = rng.uniform() < 0.5 ? 0.05 : 2;
    test.a = {9.2 - width * (0.3 + rng.uniform()), 9.2 + width * (0.3 + rng.uniform())};
    test.sigma = {0.2 * sigma, sigma * (1.5 + 4 * rng.uniform())};
    test.center_sigma = sigma;
    compare(fmt::format("study {}", seed), test.posterior(), test.truth());
  }
}

// Wear at a few inspections, k and sigma uniform within bounds that cut either.
TEST(ExactError, JointPosteriorsThatBoundsCut) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    Rng rng(20261202, seed);
    const int n = 2 + static_cast<int>(12 * rng.uniform());
    const double k = 7e-13, sigma = 3e-9 * (0.3 + rng.uniform());
    joint::Inspections inspections;
    double squares = 0;
    for (int i = 0; i < n; ++i) {
      inspections.work.push_back(1.2e5 * (i + 1) / n);
      inspections.volume.push_back(k * inspections.work.back() + sigma * rng.normal());
      squares += std::pow(inspections.work.back(), 2);
    }
    const double sd = sigma / std::sqrt(squares);
    const auto reach = [&] { return sd * 0.5 * std::exp(3 * rng.uniform()); };
    const Range of_k = {std::max(k - reach(), 0.01 * k), k + reach()};
    const Range of_sigma = {0.2 * sigma * rng.uniform() + 0.02 * sigma,
                            sigma * (1.2 + 4 * rng.uniform())};
    const GaussLegendre rule = gauss_legendre(12);
    constexpr int panels = 60;
    Sum sum({k, sigma});
    for (int i = 0; i < 12 * panels; ++i) {
      const auto at = static_cast<std::size_t>(i % 12);
      const double x =
          of_k.lower + (i / 12 + 0.5 * (1 + rule.node[at])) / panels * (of_k.upper - of_k.lower);
      double residuals = 0;
      for (std::size_t r = 0; r < inspections.work.size(); ++r) {
        residuals += std::pow(inspections.volume[r] - x * inspections.work[r], 2);
      }
      for (int j = 0; j < 12 * panels; ++j) {
        const auto of = static_cast<std::size_t>(j % 12);
        const double along = (j / 12 + 0.5 * (1 + rule.node[of])) / panels;
        const double s = of_sigma.lower * std::pow(of_sigma.upper / of_sigma.lower, along);
        const double log = -n * std::log(s / sigma) - residuals / (2 * s * s) + 0.5 * n;
        sum.add(std::exp(log) * s * rule.weight[at] * rule.weight[of], {x, s}, {0, 0});
      }
    }
    const auto middle = [](const Range& r, double inside) {
      return inside > r.lower && inside < r.upper ? inside : 0.5 * (r.lower + r.upper);
    };
    Parameter of_rate = uniform("k", of_k.lower, of_k.upper, middle(of_k, k));
    Parameter of_scatter =
        uniform("sigma", of_sigma.lower, of_sigma.upper, middle(of_sigma, sigma));
    of_rate.scale = k;
    of_scatter.scale = sigma;
    const Posterior posterior({of_rate, of_scatter},
                              joint::archard_likelihood({}, ObservationFamily::normal, inspections,
                                                        static_cast<std::size_t>(n)));
    compare(fmt::format("study {}", seed), posterior, sum.moments());
  }
}

}  // namespace
}  // namespace wearwell
