#include "wearwell/models/fatigue/sn_scores.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/random_limit.h"

namespace wearwell::fatigue {
namespace {

double cdf_above(StandardDistribution law, double z) {
  return std::exp(log_survival(law, z));
}

// Of one life [cycles] under a fully reversed stress.
double score(const SnLaw& law, const double* x, double log10_reversed, double life) {
  const double at = law.logarithmic() ? std::log10(life) : life;
  if (law.integrated()) {
    const LimitedLife<double> item = limited_life(law, x, log10_reversed);
    return normal_score(log_probability(item, Outcome::left, at, at),
                        log_probability(item, Outcome::runout, at, at));
  }
  constexpr double most = 300;  // decades; a longer life overflows
  const double center_of_all = law.log10_life(x, log10_reversed);
  double center = std::min(center_of_all, most);
  if (!law.logarithmic()) center = std::pow(10, center);
  const double z = (at - center) / law.sigma_at(x, center_of_all);
  if (law.limit) {
    const double w = law.limit_place(x, log10_reversed);
    const double failing = cdf(*law.limit, w), failed = cdf(law.standard(), z);
    return normal_score(
        std::log(failing * failed),
        std::log(cdf_above(*law.limit, w) + failing * cdf_above(law.standard(), z)));
  }
  if (law.standard() == StandardDistribution::normal) return z;
  return normal_score(log_cdf(law.standard(), z), log_survival(law.standard(), z));
}

}  // namespace

Scores sn_scores(const SnLaw& law, const LifeTests& tests) {
  std::vector<double> log10_alternating;
  for (const LifeTest& test : tests)
    log10_alternating.push_back(std::log10(test.stress.alternating));
  return [law, tests, log10_alternating](const double* x) {
    std::vector<NormalScore> scores;
    scores.reserve(tests.size());
    const double strength = law.strength_at(x), gamma = law.gamma_at(x);
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const LifeTest& test = tests[i];
      const double log10_reversed =
          log10_alternating[i] + log10_factor(law.correction, test.stress, strength, gamma);
      const double at = score(law, x, log10_reversed, test.life);
      switch (test.outcome) {
        case Outcome::failure:
          scores.push_back({at, at});
          break;
        case Outcome::runout:
          scores.push_back({at, infinity});
          break;
        case Outcome::left:
          scores.push_back({-infinity, at});
          break;
        case Outcome::interval:
          scores.push_back({at, score(law, x, log10_reversed, test.until)});
      }
    }
    return scores;
  };
}

}  // namespace wearwell::fatigue
