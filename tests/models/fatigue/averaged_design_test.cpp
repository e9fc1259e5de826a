// Design curves averaged over models: shares of draws counted one by one, and what follows from the definition.
#include "wearwell/models/fatigue/averaged_design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "wearwell/base/error.h"
#include "wearwell/models/fatigue/life.h"

namespace wearwell::fatigue {
namespace {

SnResult basquin(int draws, std::uint64_t seed) {
  SnResult result;
  result.law.correction = MeanStress::none;
  result.parameters = {"log10_a", "b", "sigma"};
  result.stress_unit = read_unit("MPa", "Pa");
  result.tested = {200e6, 450e6, 0, 0, 1e4, 2e6, 25, 22};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Points& values = result.posterior.values;
  values.resize(draws, 3);
  result.posterior.weights.setConstant(draws, 1.0 / draws);
  for (int i = 0; i < draws; ++i) {
    const double u = normal(random);
    auto row = values.row(i);
    row[0] = std::log10(2000e6) + 0.02 * u;
    row[1] = -0.12 - 0.003 * u + 0.001 * normal(random);
    row[2] = 0.18 * std::exp(0.12 * normal(random));
  }
  return result;
}

// k = 8, knee at a million cycles and 380 MPa.
SnResult knee(int draws) {
  SnResult result = basquin(draws, 5);
  result.law.curve = SnCurve::knee;
  result.law.second_slope = SecondSlope::haibach;
  result.parameters = {"k", "log10_N_D", "log10_S_D", "sigma"};
  const Points old = result.posterior.values;
  result.posterior.values.resize(draws, 4);
  for (int i = 0; i < draws; ++i) {
    const double u = (old(i, 0) - std::log10(2000e6)) / 0.02;
    result.posterior.values.row(i) << 8 + 0.3 * u, 6, std::log10(380e6) + 0.004 * u, old(i, 2);
  }
  return result;
}

const std::vector<DesignLevel> levels = {{"90/90", 0.9, 0.9}, {"A-basis", 0.99, 0.95}};
const DesignQuestion question{{450e6, 300e6, 200e6}, {}, levels};

TEST(AveragedDesign, ShareOfWeightThatOutlastsItIsTheConfidence) {
  const std::vector<WeightedModel> models = {{"basquin", 0.35, basquin(3000, 11)},
                                             {"knee", 0.65, knee(1700)}};
  const std::vector<DesignPoint> points = averaged_design(models, question);
  ASSERT_EQ(points.size(), 3u);
  for (const DesignPoint& point : points) {
    for (std::size_t l = 0; l < levels.size(); ++l) {
      double share = 0;
      for (const WeightedModel& model : models) {
        const auto n = model.result.posterior.values.rows();
        for (Eigen::Index i = 0; i < n; ++i) {
          const double life = std::pow(
              10, life_quantile(model.result.law, model.result.posterior.values.row(i).data(),
                                point.stress, 1 - levels[l].reliability));
          if (life > point.averaged[l]) share += model.weight / static_cast<double>(n);
        }
      }
      EXPECT_NEAR(share, levels[l].confidence, 2 * 0.65 / 1700)
          << point.stress.alternating << levels[l].name;
      const auto [least, most] = std::minmax(point.models[0][l], point.models[1][l]);
      EXPECT_GE(point.averaged[l], least * (1 - 1e-9));
      EXPECT_LE(point.averaged[l], most * (1 + 1e-9));
      EXPECT_EQ(point.cautious[l], least);
    }
    EXPECT_LT(point.averaged[1], point.averaged[0]);
    EXPECT_LT(point.averaged[0], point.median);
  }
  // Less stress, longer life.
  EXPECT_LT(points[0].averaged[0], points[1].averaged[0]);
  EXPECT_LT(points[1].averaged[0], points[2].averaged[0]);
}

TEST(AveragedDesign, AModelWithAllTheWeightIsItself) {
  const std::vector<WeightedModel> models = {{"basquin", 1, basquin(2000, 11)},
                                             {"knee", 0, knee(2000)}};
  for (const DesignPoint& point : averaged_design(models, question)) {
    for (std::size_t l = 0; l < levels.size(); ++l) {
      EXPECT_NEAR(point.averaged[l] / point.models[0][l], 1, 1e-12);
      // Without weight a model is no candidate for caution.
      EXPECT_EQ(point.cautious[l], point.models[0][l]);
    }
  }
}

TEST(AveragedDesign, TheSameModelTwiceIsTheModel) {
  const std::vector<WeightedModel> models = {{"one", 0.3, basquin(4000, 11)},
                                             {"again", 0.7, basquin(4000, 11)}};
  for (const DesignPoint& point : averaged_design(models, question))
    for (std::size_t l = 0; l < levels.size(); ++l)
      EXPECT_NEAR(point.averaged[l] / point.models[0][l], 1, 2e-3);
}

TEST(AveragedDesign, TheLineOfTheTestsOrItIsAsked) {
  std::vector<WeightedModel> models = {{"a", 0.5, basquin(10, 1)}, {"b", 0.5, basquin(10, 2)}};
  EXPECT_EQ(design_line(models).mean, 0);
  SnResult& with_mean = models[1].result;
  with_mean.law.correction = MeanStress::swt;
  with_mean.tested.mean_low = 200e6 * 11.0 / 9;
  with_mean.tested.mean_high = 450e6 * 11.0 / 9;
  EXPECT_NEAR(design_line(models).ratio.value(), 0.1, 1e-12);
  with_mean.tested.mean_high = 300e6;
  EXPECT_THROW(design_line(models), InputError);
  with_mean.tested.mean_low = 300e6;
  EXPECT_EQ(design_line(models).mean, 300e6);
  EXPECT_EQ(design_stresses(models).size(), 21u);
  EXPECT_DOUBLE_EQ(design_stresses(models).front(), 450e6);
  EXPECT_DOUBLE_EQ(design_stresses(models).back(), 200e6);
}

}  // namespace
}  // namespace wearwell::fatigue
