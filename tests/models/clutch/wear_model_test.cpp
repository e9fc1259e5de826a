#include "wearwell/models/clutch/wear_model.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "wearwell/base/rng.h"

namespace wearwell::clutch {
namespace {

/// Points of the paper's design whose wear rates are those of the truth and scatter by `sd`.
WearPoints points_of(bool held_out, double sd, std::uint64_t seed) {
  static const auto design = plan(paper_design());
  const Truth truth = paper_like_truth();
  Rng rng(seed, held_out ? 1 : 0);
  WearPoints points;
  std::vector<double> w;
  for (const DesignPoint& p : design) {
    if ((p.role == Role::validation) != held_out) continue;
    points.number.push_back(p.number);
    points.at.push_back(p.at);
    w.push_back(truth.w(p.at) + sd * rng.normal());
  }
  points.w = Eigen::Map<Eigen::VectorXd>(w.data(), std::ssize(w));
  points.cycles = Eigen::VectorXd::Ones(points.size());
  points.balance_sd = Eigen::VectorXd::Zero(points.size());
  return points;
}

WearMap true_map(const WearPoints& points) {
  // The truth's terms, among the 20 by degree: 1, ds, Td, ds Td, Td Mz, Mz^2, ds ds Td, ds ds Mz,
  // ds Td Mz, Td Td Mz.
  WearMap all = fit_map("all", points, Surrogate::distance, 1.2, 0.5, 3, {});
  std::vector<int> terms;
  for (std::size_t t = 0; t < all.design.terms.size(); ++t) {
    for (const char* name : {"1", "ds", "Td", "ds*Td", "Td*Mz", "Mz*Mz", "ds*ds*Td", "ds*ds*Mz",
                             "ds*Td*Mz", "Td*Td*Mz"}) {
      if (all.design.terms[t].name == name) terms.push_back(static_cast<int>(t));
    }
  }
  EXPECT_EQ(terms.size(), 10u);
  return fit_map("selected", points, Surrogate::distance, 1.2, 0.5, 3, terms);
}

constexpr double sd = 2 * mm3_per_MJ;

TEST(WearModel, IsTheMapThatWasFitted) {
  const WearPoints points = points_of(false, sd, 1);
  const WearMap map = true_map(points);
  RunInFit run_in;
  run_in.run_in = {0.4, 4, 78e6, 6e6};
  run_in.plate_sd = 0.03;
  ScatterSearch scatter;
  scatter.candidates.resize(1);
  scatter.candidates[0].law = {ScatterKind::linear, {sd, 0}};
  scatter.floors = {0.5 * sd};
  const WearModel model = make_model("title", points, map, run_in, scatter, 1e-5);
  const WearPolynomial w = model.polynomial(), same = unscaled(map);
  Rng rng(5, 0);
  for (int i = 0; i < 100; ++i) {
    const OperatingPoint at{rng.uniform(120, 300), rng.uniform(25, 75), rng.uniform(120, 240),
                            rng.uniform(0.9, 3.4)};
    const double expected = map.predict({at})[0];
    EXPECT_NEAR(w(at) / mm3_per_MJ, expected / mm3_per_MJ, 1e-9);
    EXPECT_NEAR(same(at) / mm3_per_MJ, expected / mm3_per_MJ, 1e-9);
  }
  EXPECT_EQ(model.plate_sd, 0.03);
  EXPECT_EQ(model.sigma(-100, {}), sd);
  EXPECT_EQ(model.scatter_floor, 0.5 * sd);
  // The range of the points, widened by a hundredth.
  for (const OperatingPoint& at : points.at) EXPECT_EQ(outside(model, at), 0u);
  OperatingPoint at = points.at[0];
  at.temperature =
      model.highest.temperature + 0.009 * (model.highest.temperature - model.lowest.temperature);
  EXPECT_EQ(outside(model, at), 0u);
  at.temperature += 1;
  at.slip_speed = 1;
  EXPECT_EQ(outside(model, at), 5u);
  EXPECT_EQ(names_of_inputs(outside(model, at)), "slip_speed temperature");
}

// With one standard deviation for all it is that of least squares, but for the estimate of it.
TEST(WearModel, RobustCovarianceOfEqualScatterIsTheOrdinaryOne) {
  const WearPoints points = points_of(false, sd, 2);
  const WearMap map = true_map(points);
  const Eigen::MatrixXd robust =
      robust_covariance(map, Eigen::VectorXd::Constant(points.size(), map.fit.sigma));
  EXPECT_LT((robust - map.fit.covariance).norm(), 1e-9 * map.fit.covariance.norm());
}

TEST(WearModel, ReplicatesDoNotDependOnThreadsAndSurroundTheMap) {
  const WearPoints points = points_of(false, sd, 3);
  const WearMap map = true_map(points);
  RunInFit run_in;
  run_in.run_in = {0.4, 4, 78e6, 6e6};
  std::vector<RunIn> run_ins;
  for (int b = 0; b < 40; ++b) run_ins.push_back({0.4, 3 + 0.05 * b, 78e6, 6e6});
  const Eigen::VectorXd sds = Eigen::VectorXd::Constant(points.size(), sd);
  const auto one = draw_replicates(points, map, sds, run_in, run_ins, {1.2, 0.5}, 7, 1);
  const auto two = draw_replicates(points, map, sds, run_in, run_ins, {1.2, 0.5}, 7, 2);
  ASSERT_EQ(one.size(), 40u);
  const OperatingPoint at{200, 50, 170, 2};
  double mean = 0, square = 0;
  for (std::size_t b = 0; b < 40; ++b) {
    EXPECT_EQ(one[b].w(at), two[b].w(at));
    EXPECT_EQ(one[b].run_in.fast, run_ins[b].fast);
    mean += one[b].w(at) / 40;
    square += one[b].w(at) * one[b].w(at) / 40;
  }
  const double spread = std::sqrt(square - mean * mean);
  EXPECT_NEAR(mean, map.predict({at})[0], 4 * spread / std::sqrt(40));
  EXPECT_GT(spread, 0.1 * sd / std::sqrt(101)) << "a fit to 101 points is uncertain";
  EXPECT_LT(spread, sd);
}

// A run-in that wears twice as much everywhere halves the map that was compensated with it: what
// they predict together stays.
TEST(WearModel, ReplicatesAreCompensatedWithTheirOwnRunIn) {
  WearPoints points = points_of(false, sd, 4);
  const WearMap map = true_map(points);
  RunInFit run_in;
  run_in.run_in = {1, 0, 1e15, 1};  // g = 2, as long as plates last
  for (Eigen::Index j = 0; j < points.size(); ++j) {
    points.plate.push_back(1);
    points.from.push_back(1e6 * static_cast<double>(j));
    points.to.push_back(1e6 * static_cast<double>(j + 1));
  }
  points.factor = Eigen::VectorXd::Constant(points.size(), 2);
  const Eigen::VectorXd sds = Eigen::VectorXd::Constant(points.size(), 0.01 * sd);
  const std::vector<RunIn> run_ins = {{3, 0, 1e15, 1}};  // g = 4
  const auto replicates = draw_replicates(points, map, sds, run_in, run_ins, {1.2, 0.5}, 1, 1);
  const OperatingPoint at{200, 50, 170, 2};
  EXPECT_NEAR(replicates[0].w(at) * 4 / (map.predict({at})[0] * 2), 1, 0.005);
}

// Of 40 sets of held-out points, none spoilt: the 5 % of false alarms for a whole set is 2
// expected, and more than 7 has a probability of 0.001 (R: 1 - pbinom(7, 40, 0.05) = 0.0007).
// One point off by five standard deviations is named in all but few (power above 0.9).
TEST(Validation, NamesThePointThatLiesFarOff) {
  const ScatterLaw law{ScatterKind::linear, {sd, 0}};
  int false_alarms = 0, named = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const WearPoints points = points_of(false, sd, 20 + seed);
    const WearMap map = true_map(points);
    const Eigen::MatrixXd covariance =
        robust_covariance(map, Eigen::VectorXd::Constant(points.size(), sd));
    WearPoints held_out = points_of(true, sd, 20 + seed);
    const Validation clean = validate(map, covariance, law, held_out);
    ASSERT_EQ(clean.points.size(), 20u);
    int outliers = 0;
    for (const ValidationPoint& p : clean.points) outliers += p.outlier;
    false_alarms += outliers > 0;
    EXPECT_EQ(clean.without_outliers.points, 20 - outliers);

    held_out.w[12] = map.predict({held_out.at[12]})[0] + 5 * clean.points[12].sd;
    const Validation spoilt = validate(map, covariance, law, held_out);
    EXPECT_NEAR(spoilt.points[12].t, 5, 1e-9);
    EXPECT_EQ(spoilt.points[12].number, held_out.number[12]);
    named += spoilt.points[12].outlier;
    EXPECT_LT(spoilt.without_outliers.rmse, spoilt.all.rmse);
  }
  EXPECT_LE(false_alarms, 7);
  EXPECT_EQ(named, 40);
}

// R: qt(1 - 0.05/2/20, 91) = 3.109767
TEST(Validation, MetricsByHand) {
  const WearPoints points = points_of(false, sd, 70);
  const WearMap map = true_map(points);
  WearPoints held_out = points_of(true, 0, 70);
  const Eigen::VectorXd predicted = map.predict(held_out.at);
  for (Eigen::Index j = 0; j < 20; ++j)
    held_out.w[j] = predicted[j] + (j % 2 == 0 ? 1 : 3) * 0.1 * sd;
  const Validation v =
      validate(map, Eigen::MatrixXd::Zero(10, 10), {ScatterKind::linear, {sd, 0}}, held_out);
  EXPECT_NEAR(v.critical, 3.109767, 1e-6);
  EXPECT_NEAR(v.points[1].t, 0.3, 1e-9);
  EXPECT_NEAR(v.all.bias / sd, 0.2, 1e-12);
  EXPECT_NEAR(v.all.rmse / sd, std::sqrt(0.05), 1e-12);
  const double total = (held_out.w.array() - held_out.w.mean()).square().sum();
  EXPECT_NEAR(v.all.r2, 1 - 20 * 0.05 * sd * sd / total, 1e-12);
  EXPECT_TRUE(validate(map, Eigen::MatrixXd::Zero(10, 10), {ScatterKind::linear, {sd, 0}}, {})
                  .points.empty());
}

// Two cycles of equal energy at 100 and 200 degrees, w = Td^2: summed 25000, averaged 22500.
TEST(Averaging, ByHand) {
  const WearPolynomial w{1, 1, {{0, 2, 0, 1}}};
  const std::vector<Cycle> cycles = {{1, 1, {200, 50, 100, 2}, 1}, {1, 2, {200, 50, 200, 2}, 1}};
  WornBlock block;
  block.block = Block::point;
  block.point = 4;
  block.last = 2;
  block.mean = {200, 50, 150, 2};
  block.energy = 2;
  const AveragingEffect effect = averaging_effect(w, cycles, {block});
  ASSERT_EQ(effect.change.size(), 1u);
  EXPECT_EQ(effect.point[0], 4);
  EXPECT_NEAR(effect.change[0], -0.1, 1e-12);
  EXPECT_NEAR(effect.total, -0.1, 1e-12);
}

}  // namespace
}  // namespace wearwell::clutch
