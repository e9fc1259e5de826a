// The check of fit of a wear map: what it asks, and that it can fail.
#include "wearwell/models/clutch/map_fit.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/regress/least_squares.h"

namespace wearwell::clutch {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int plates = 6, of_each = 12;

/// Wear rates that rise with torque, with errors of 4 mm^3/MJ times `error(j, plate, rng)`.
template <class Error>
WearPoints points_with(const Error& error) {
  Rng rng(1, 0);
  WearPoints points;
  points.w.resize(plates * of_each);
  points.cycles = Eigen::VectorXd::Constant(plates * of_each, 1000);
  points.balance_sd = Eigen::VectorXd::Constant(plates * of_each, 0.1 * mm3_per_MJ);
  for (int j = 0; j < plates * of_each; ++j) {
    points.number.push_back(101 + j);
    points.plate.push_back(1 + j / of_each);
    points.at.push_back(
        {rng.uniform(120, 300), rng.uniform(25, 75), rng.uniform(120, 240), rng.uniform(0.9, 3.4)});
    points.w[j] =
        (10 + 0.5 * points.at.back().torque + 4 * error(j, points.plate.back(), rng)) * mm3_per_MJ;
  }
  return points;
}

FitOutcome judged(const WearPoints& points) {
  const WearMap map = fit_map("linear", points, Surrogate::distance, 1, 1, 1, {});
  const ScatterLaw law = fit_scatter(points, map).candidates[1].law;
  return judge_map(points, map, law);
}

const auto normal = [](int, int, Rng& rng) { return rng.normal(); };

TEST(MapFit, AsksWhatOtherFitsAreAsked) {
  const FitOutcome outcome = judged(points_with(normal));
  std::vector<std::string> names;
  for (const FitTest& test : outcome.tests) names.push_back(test.name);
  for (const char* name : {"location", "trend with temperature", "order along slip_speed",
                           "extreme residual", "distribution of residuals", "scatter along torque",
                           "scatter along closing_time", "scatter between levels of plate"})
    EXPECT_THAT(names, Contains(name));
  const Check check = fit_check(outcome);
  EXPECT_EQ(check.name, "fit");
  EXPECT_EQ(check.verdict, Verdict::pass) << check.detail;
  EXPECT_FALSE(outcome.copies);
}

// A search for the best predictions omits small terms on purpose.
TEST(MapFit, WarnsOfATrendAndFailsForScatter) {
  const auto outcome = judged(points_with(normal));
  for (const FitTest& test : outcome.tests)
    EXPECT_EQ(test.may_fail, !test.name.starts_with("trend") && !test.name.starts_with("order"))
        << test.name;
  FitOutcome shown = outcome;
  for (FitTest& test : shown.tests)
    if (test.name.starts_with("trend")) test.p = 1e-9;
  EXPECT_EQ(fit_check(shown).verdict, Verdict::warn);
}

// The median scores over draws are the residuals of weighted least squares over their standard deviation.
TEST(MapFit, JudgesTheResiduals) {
  const WearPoints points = points_with(normal);
  const WearMap map = fit_map("linear", points, Surrogate::distance, 1, 1, 1, {});
  const ScatterLaw law{ScatterKind::linear, {20 * mm3_per_MJ, 3}};
  const Eigen::VectorXd sd = point_sd(law, points, map.fit.fitted);
  const LinearFit weighted = fit_least_squares(map.design.columns(Eigen::all, map.terms), points.w,
                                               sd.cwiseAbs2().cwiseInverse());
  const FitOutcome outcome = judge_map(points, map, law);
  for (Eigen::Index j = 0; j < points.size(); ++j) {
    const double error = 1.2533 * std::sqrt(weighted.leverages[j] / 400);  // of a median of 400
    EXPECT_NEAR(outcome.residuals[static_cast<std::size_t>(j)], weighted.residuals[j] / sd[j],
                6 * error);
  }
}

TEST(MapFit, NamesThePointThatLiesFarOut) {
  const Check check = fit_check(
      judged(points_with([](int j, int, Rng& rng) { return j == 40 ? 12 : rng.normal(); })));
  EXPECT_EQ(check.verdict, Verdict::fail);
  EXPECT_THAT(check.detail, HasSubstr("point 141 lies farther out than the others let expect"));
}

TEST(MapFit, SeesPlatesThatScatterDifferently) {
  const Check check = fit_check(judged(points_with(
      [](int, int plate, Rng& rng) { return (plate % 2 == 0 ? 0.15 : 1) * rng.normal(); })));
  EXPECT_EQ(check.verdict, Verdict::fail);
  EXPECT_THAT(check.detail, HasSubstr("residuals scatter differently between levels of plate"));
}

TEST(MapFit, SeesErrorsThatAreNotNormal) {
  const Check check = fit_check(
      judged(points_with([](int, int, Rng& rng) { return -1.5 * std::log(rng.uniform()); })));
  EXPECT_NE(check.verdict, Verdict::pass);
  EXPECT_THAT(check.detail, HasSubstr("do not follow their distribution"));
}

// Blocks that stand twice on a plate, also where each is compensated by another factor.
TEST(MapFit, TellsCopiedBlocks) {
  WearPoints points = points_with(normal);
  points.factor.resize(points.size());
  for (Eigen::Index j = 0; j < points.size(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    points.factor[j] = 1 + 0.01 * static_cast<double>(j % 7);
    if (j % of_each != 0 && j % 3 == 0) {
      points.at[at] = points.at[at - 1];
      points.w[j] = points.w[j - 1] * points.factor[j - 1];
    } else {
      points.w[j] = std::round(1e3 * points.w[j] / mm3_per_MJ) / 1e3 * mm3_per_MJ;
    }
    points.w[j] /= points.factor[j];
  }
  const Check check = fit_check(judged(points));
  EXPECT_EQ(check.verdict, Verdict::fail);
  EXPECT_THAT(check.detail, HasSubstr("exact rows repeat another row in every number"));
}

}  // namespace
}  // namespace wearwell::clutch
