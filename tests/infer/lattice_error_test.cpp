// The error that the lattice of four parameters says it reached bounds the one it made: over life tests under
// mean stress, whose posterior bounds cut, against sums over dense grids, where log10_a is integrated by formula.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "infer/normal_reference.h"
#include "infer/test_posteriors.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/lattice.h"
#include "wearwell/infer/mode.h"
#include "wearwell/math/quadrature.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell {
namespace {

using Four = Eigen::Array4d;

struct Range {
  double lower, upper;
  double at(double share) const { return lower + share * (upper - lower); }
};

struct Moments {
  Four mean, sd;
};

// log10 N normal about (log10(S_a/(1 - S_m/S_ut)) - log10_a)/b, all priors uniform, that of log10_Sut too.
struct Goodman {
  std::vector<double> mean_stress, amplitude, log10_life;  // Pa, cycles
  Range a{8, 10}, b{-0.1, -0.06}, strength{9.1, 11.2}, sigma{0.01, 0.6};

  // Given the others log10_a is normal, cut to its bounds.
  Moments truth(int panels) const {
    const auto n = static_cast<double>(log10_life.size());
    const GaussLegendre rule = gauss_legendre(12);
    const Four about(a.at(0.5), b.at(0.5), strength.at(0.5), sigma.at(0.5));
    double mass = 0;
    Four first = Four::Zero(), second = Four::Zero();
    const auto share = [&](int i) {
      return (i / 12 + 0.5 * (1 + rule.node[static_cast<std::size_t>(i % 12)])) / panels;
    };
    const auto weight = [&](int i) { return rule.weight[static_cast<std::size_t>(i % 12)]; };
    for (int k = 0; k < 12 * panels; ++k) {
      const double log10_sut = strength.at(share(k)), sut = std::pow(10, log10_sut);
      double s = 0, y = 0, ss = 0, sy = 0, yy = 0;
      for (std::size_t t = 0; t < log10_life.size(); ++t) {
        const double stress = std::log10(amplitude[t] / (1 - mean_stress[t] / sut));
        s += stress / n;
        y += log10_life[t] / n;
        ss += stress * stress;
        sy += stress * log10_life[t];
        yy += log10_life[t] * log10_life[t];
      }
      for (int i = 0; i < 12 * panels; ++i) {
        const double slope = b.at(share(i)), mean = s - slope * y;
        const double squares =
            ss - n * s * s - 2 * slope * (sy - n * s * y) + slope * slope * (yy - n * y * y);
        for (int j = 0; j < 12 * panels; ++j) {
          const double scatter = sigma.lower * std::pow(sigma.upper / sigma.lower, share(j));
          const double sd = scatter * std::abs(slope) / std::sqrt(n);
          const double lower = (a.lower - mean) / sd, upper = (a.upper - mean) / sd;
          const double inside = below(upper) - below(lower);
          if (!(inside > 1e-14)) continue;
          const double log =
              -n * std::log(scatter / 0.2) - squares / (2 * std::pow(scatter * slope, 2)) + 0.5 * n;
          const double here =
              std::exp(log) * sd * inside * scatter * weight(i) * weight(j) * weight(k);
          const double shift = (density(lower) - density(upper)) / inside;
          const double tail = (lower * density(lower) - upper * density(upper)) / inside;
          Four x = Four(mean + sd * shift, slope, log10_sut, scatter) - about;
          mass += here;
          first += here * x;
          second += here * x * x;
          second[0] += here * sd * sd * (1 + tail - shift * shift);
        }
      }
    }
    first /= mass;
    return {about + first, (second / mass - first * first).sqrt()};
  }

  Posterior posterior() const {
    fatigue::SnLaw law;
    law.correction = fatigue::MeanStress::goodman;
    fatigue::LifeTests tests;
    for (std::size_t i = 0; i < log10_life.size(); ++i) {
      tests.push_back({{amplitude[i], mean_stress[i]},
                       fatigue::Outcome::failure,
                       std::pow(10, log10_life[i]),
                       0,
                       1});
    }
    const auto uniform = [](const char* name, const Range& range) {
      return Parameter{name,
                       "1",
                       Unit{"1", 1, 0},
                       "test",
                       make_distribution(Uniform{}, range.lower, range.upper),
                       range.at(0.5),
                       1};
    };
    return Posterior({uniform("log10_a", a), uniform("b", b), uniform("log10_Sut", strength),
                      uniform("sigma", sigma)},
                     fatigue::sn_likelihood(law, tests, tests.size()));
  }
};

void compare(const std::string& what, const Goodman& study, int panels) {
  const Posterior posterior = study.posterior();
  const Moments truth = study.truth(panels);
  const ExactPosterior exact =
      integrate_on_lattice(posterior, whitening_at(find_mode(posterior, posterior.start())), {});
  ASSERT_EQ(exact.failure, "") << what;
  const Four of_mean = (exact.mean.array() - truth.mean).abs() / truth.sd;
  const Four of_square = ((exact.sd.array() / truth.sd).square() - 1).abs();
  EXPECT_LE(exact.error, 1e-5) << what;
  EXPECT_LE(of_mean.maxCoeff(), exact.error) << what << ": " << of_mean.transpose();
  EXPECT_LE(of_square.maxCoeff(), exact.error) << what << ": " << of_square.transpose();
}

Goodman springs(std::size_t n) {
  constexpr double mean[] = {1005.5, 1049.0, 1025.8, 1048.7, 1070.4,
                             1116.5, 1150.7, 1150.7, 1150.7};
  constexpr double amplitude[] = {271.1, 279.8, 285.9, 276.8, 265.4, 242.0, 259.7, 259.7, 259.7};
  constexpr double life[] = {0.700, 1.153, 0.855, 0.820, 1.020, 0.849, 1.279, 1.153, 1.172};
  Goodman study;
  for (std::size_t i = 0; i < n; ++i) {
    study.mean_stress.push_back(mean[i] * 1e6);
    study.amplitude.push_back(amplitude[i] * 1e6);
    study.log10_life.push_back(5 + std::log10(life[i]));
  }
  return study;
}

// The examples case1 and case2.
TEST(LatticeError, Springs) {
  compare("case 1", springs(6), 12);
  compare("case 2", springs(9), 12);
}

// Bounds from half a standard deviation to many about what made the lives. Even steps would leave a
// mass of 0.0015 beyond the lattice of the first.
TEST(LatticeError, LifeTestsUnderMeanStressThatBoundsCut) {
  for (const std::uint64_t seed : {1, 3, 4}) {
    Rng rng(20261123, seed);
    Goodman study;
    const double b = -0.06 - 0.1 * rng.uniform(), sigma = 0.1 + 0.3 * rng.uniform();
    const double a = 9.1, log10_sut = 9.3;
    const int n = 5 + static_cast<int>(10 * rng.uniform());
    for (int i = 0; i < n; ++i) {
      study.mean_stress.push_back(1e9 * rng.uniform());
      study.amplitude.push_back((250e6 + 250e6 * rng.uniform()) *
                                (1 - study.mean_stress.back() / std::pow(10, log10_sut)));
      const double stress = std::log10(study.amplitude.back()) -
                            std::log10(1 - study.mean_stress.back() / std::pow(10, log10_sut));
      study.log10_life.push_back((stress - a) / b + sigma * rng.normal());
    }
    const auto reach = [&](double most) { return most * std::exp(-2 * rng.uniform()); };
    study.a = {a - reach(1), a + reach(1)};
    study.b = {b - reach(0.05), b + reach(0.05)};
    study.strength = {std::max(log10_sut - reach(0.25), 9.01), log10_sut + reach(2)};
    study.sigma = {sigma * (0.1 + 0.4 * rng.uniform()), sigma * (1.5 + 3 * rng.uniform())};
    compare(fmt::format("study {}", seed), study, 16);
  }
}

}  // namespace
}  // namespace wearwell
