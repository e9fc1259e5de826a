#include "wearwell/models/fatigue/design_curve_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/models/fatigue/design_curve.h"
#include "wearwell/models/fatigue/life.h"
#include "wearwell/models/fatigue/lives_under.h"

namespace wearwell {
namespace {

using fatigue::LifeTest;
using fatigue::SnLaw;
using fatigue::Stress;
using fatigue::StressLine;

constexpr std::size_t table_points = 21;
// A random limit makes a mixture of each point of the posterior.
constexpr std::size_t table_points_with_limit = 9;

}  // namespace

std::vector<CurvePoint> curve_points(const SnLaw& law, const SnData& data,
                                     const WeightedDraws& draws, const StandardFit& standard) {
  double low = INFINITY, high = 0;
  for (const LifeTest& test : data.tests) {
    low = std::min(low, test.stress.alternating);
    high = std::max(high, test.stress.alternating);
  }
  const StressLine line = line_of_tests(law, data);
  const auto& levels = design_levels();
  std::vector<CurvePoint> points(!(high > low)      ? 1
                                 : law.integrated() ? table_points_with_limit
                                                    : table_points);
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    CurvePoint& at = points[i];
    const double share =
        points.size() == 1 ? 0 : static_cast<double>(i) / static_cast<double>(points.size() - 1);
    at.stress = i == 0 ? high : i + 1 == points.size() ? low : high * std::pow(low / high, share);
    const Stress stress = line.at(at.stress);
    at.mean = stress.mean;
    const fatigue::LivesUnder lives(law, draws, stress);
    at.median = fatigue::cycles(law, lives.outlasted(0.5, std::array{0.5}).front());
    for (auto level = levels.begin(); level != levels.end();) {
      const double reliability = level->reliability;
      std::vector<double> below;
      for (; level != levels.end() && level->reliability == reliability; ++level)
        below.push_back(1 - level->confidence);
      for (const double life : lives.outlasted(reliability, below))
        at.posterior.push_back(fatigue::cycles(law, life));
    }
    for (const DesignLevel& level : levels) {
      if (!standard.line) continue;
      const double x = standard_log10_stress(law, stress);
      at.iso.push_back(std::pow(
          10, fatigue::iso_12107_limit(*standard.line, x, level.reliability, level.confidence)));
      at.owen.push_back(std::pow(
          10, fatigue::owen_limit(*standard.line, x, level.reliability, level.confidence)));
    }
    if (standard.line)
      at.band = std::pow(
          10, fatigue::astm_e739_band(*standard.line, standard_log10_stress(law, stress), 0.95));
  });
  return points;
}

}  // namespace wearwell
