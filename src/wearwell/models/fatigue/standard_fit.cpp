#include "wearwell/models/fatigue/standard_fit.h"

#include <algorithm>
#include <cmath>

namespace wearwell {

using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::Outcome;
using fatigue::SnLaw;
using fatigue::Stress;

double standard_log10_stress(const SnLaw& law, const Stress& stress) {
  // Known constants only: standard_fit says so.
  const double x[] = {0, 0, 0, 0, 0, 0, 0};
  return law.correction == MeanStress::none ? std::log10(stress.alternating)
                                            : law.log10_reversed(x, stress);
}

StandardFit standard_fit(const SnLaw& law, const SnData& data) {
  StandardFit fit;
  if (law.family != fatigue::LifeFamily::log10_normal) {
    fit.why_not = "they assume normal log10 life, which this study does not";
    return fit;
  }
  if (law.has_strength() || law.has_gamma()) {
    fit.why_not = "the mean-stress correction is unknown here, and they need a known stress";
    return fit;
  }
  std::vector<double> x, y;
  for (const LifeTest& test : data.tests) {
    if (test.outcome != Outcome::failure) {
      fit.left_out += test.count;
      continue;
    }
    for (int i = 0; i < test.count; ++i) {
      x.push_back(standard_log10_stress(law, test.stress));
      y.push_back(std::log10(test.life));
    }
  }
  fit.failures = static_cast<int>(x.size());
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  if (x.size() < 3 || !(*most - *least > 1e-9)) {
    fit.why_not = "they need three failures at two stresses";
    return fit;
  }
  if (!std::all_of(x.begin(), x.end(), [](double each) { return std::isfinite(each); })) {
    fit.why_not = "a test has no fully reversed stress";
    return fit;
  }
  fit.line = fatigue::fit_line(x, y);
  return fit;
}

}  // namespace wearwell
