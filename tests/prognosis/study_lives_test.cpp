#include "wearwell/prognosis/study_lives.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/prognosis/decisions.h"
#include "wearwell/prognosis/named_life.h"

namespace wearwell::prognosis {
namespace {

using testing::HasSubstr;

double failed_by(double t, const double* x) {
  return -std::expm1(-std::pow(t / x[0], x[1]));
}

// Lives that are Weibull with characteristic life x[0] (h) and shape x[1]; of two suppliers.
PosteriorStudy weibull_study(std::vector<std::string> of) {
  PosteriorStudy study;
  for (const std::string& each : of) {
    QuantityGroup group;
    QuantityRequest request{"life", "new " + each, "", Unit{"h", 3600, 0}, true, true, {}, {}, {}};
    group.requests.push_back(request);
    group.lives = [](const WeightedDraws& draws) {
      const double scale = draws.values(0, 0), shape = draws.values(0, 1);
      LifeDistribution one{[=](double t) {
                             const double x[] = {scale, shape};
                             return failed_by(t, x);
                           },
                           [=](double p) { return scale * std::pow(-std::log1p(-p), 1 / shape); }};
      return std::vector<PredictiveLife>{{one}};
    };
    study.quantity_groups.push_back(group);
  }
  return study;
}

WeightedDraws points(const std::vector<std::pair<double, double>>& each) {
  WeightedDraws draws;
  draws.values.resize(static_cast<Eigen::Index>(each.size()), 2);
  for (std::size_t i = 0; i < each.size(); ++i)
    draws.values.row(static_cast<Eigen::Index>(i)) << each[i].first, each[i].second;
  draws.weights = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(each.size()),
                                            1 / static_cast<double>(each.size()));
  return draws;
}

class StudyLives : public ScratchTest {
 protected:
  Table ages(const std::string& csv) const { return read_table(write("ages.csv", csv)); }
};

// ReliaSoft's example of age replacement: Weibull of shape 2.5 and 1000 h, costs 5 and 1: 493 h.
TEST_F(StudyLives, AKnownDistributionHasThePublishedAge) {
  const PosteriorStudy study = weibull_study({"part"});
  const KnownLives lives = lives_of_study(study, points({{1000 * 3600.0, 2.5}}), "study", true, "");
  ASSERT_EQ(lives.fresh.lives.size(), 1U);
  const AgeReplacement best = cheapest_age(lives.fresh, Costs{5, 1, 0});
  EXPECT_NEAR(best.age / 3600, 493.05, 3);
  // Its cost, by quadrature in R: see tests/cli/decide_test.cpp for the age.
  EXPECT_NEAR(best.failing, 1 - std::exp(-std::pow(0.49305, 2.5)), 0.002);
}

TEST_F(StudyLives, PointsHaveTheDistributionFarIntoItsTails) {
  const PosteriorStudy study = weibull_study({"part"});
  const double x[] = {500.0, 1.7};
  const KnownLives lives = lives_of_study(study, points({{x[0], x[1]}}), "study", true, "");
  for (const double p : {1e-5, 1e-3, 0.02, 0.3, 0.9, 0.999}) {
    const double t = x[0] * std::pow(-std::log1p(-p), 1 / x[1]);
    EXPECT_NEAR(lives.fresh.lives[0].cdf(t), p, 0.02 * std::min(p, 1 - p)) << p;
  }
}

// The survivor of a mixture is more likely of the population that lives longer.
TEST_F(StudyLives, SurvivalIsEvidenceUnlessTheStudyHasIt) {
  const PosteriorStudy study = weibull_study({"part"});
  const std::vector<std::pair<double, double>> two = {{1000 * 3600.0, 2}, {3000 * 3600.0, 2}};
  const KnownLives fresh = lives_of_study(study, points(two), "study", true, "");
  const auto failing = [&](const std::string& in_study) {
    KnownLives lives = fresh;
    add_units_in_service(lives, ages("unit,age [h],in_study\nA,1500," + in_study + "\n"));
    return lives.units.at(0).remaining.cdf(500 * 3600.0);
  };
  const auto exact = [&](bool counted) {
    double weight = 0, sum = 0;
    for (const auto& [scale, shape] : two) {
      const double x[] = {scale, shape};
      const double survival = 1 - failed_by(1500 * 3600.0, x);
      const double w = counted ? 1 : survival;
      weight += w;
      sum += w * (1 - (1 - failed_by(2000 * 3600.0, x)) / survival);
    }
    return sum / weight;
  };
  EXPECT_NEAR(failing("no"), exact(false), 0.003);
  EXPECT_NEAR(failing("yes"), exact(true), 0.003);
  EXPECT_GT(exact(true), exact(false) + 0.05);
}

TEST_F(StudyLives, WarrantyIsTheQuantileOfTheMixtureAndOfPopulations) {
  const PosteriorStudy study = weibull_study({"part"});
  std::vector<std::pair<double, double>> many;
  for (int i = 0; i < 100; ++i) many.emplace_back(1000 + 10.0 * i, 2);
  const KnownLives lives = lives_of_study(study, points(many), "study", true, "");
  const Warranty warranty = longest_warranty(lives.fresh, 0.02);
  double share = 0;
  for (const auto& [scale, shape] : many) {
    const double x[] = {scale, shape};
    share += 0.01 * failed_by(warranty.length, x);
  }
  EXPECT_NEAR(share, 0.02, 2e-4);
  const double b2 = std::pow(-std::log1p(-0.02), 0.5);
  EXPECT_NEAR(warranty.sure, 1045 * b2, 10 * b2);  // of the fifth of a hundred
}

// Units whose age alone is known: at the fleet's age; where they are past it, at once, or at failure if the survivors are
// of a population of long lives; never at an age far in the tail.
TEST_F(StudyLives, UnitsInServiceAreReplacedAtTheFleetsAgeOrNow) {
  const PosteriorStudy study = weibull_study({"part"});
  const double h = 3600;
  for (const double longest : {1500.0, 1e6}) {
    KnownLives lives =
        lives_of_study(study, points({{1000 * h, 3}, {longest * h, 3}}), "s", true, "");
    add_units_in_service(lives, ages("unit,age [h]\nyoung,10\nold,1600\n"));
    Question question;
    question.costs = {10, 1, 0};
    const Decisions decisions = decide(lives, question);
    ASSERT_LT(decisions.age->age, 1600 * h);
    for (const UnitDecision& each : decisions.units) {
      const bool old = each.unit->name == "old";
      EXPECT_EQ(each.past_optimum, old);
      if (!old) {
        EXPECT_NEAR(each.best.after, decisions.age->age - 10 * h, 1) << longest;
      } else {
        // At 1600 h one of the lives of 1e6 h is as good as new.
        EXPECT_EQ(each.best.after, longest > 1e5 ? INFINITY : 0.0);
      }
    }
  }
}

TEST_F(StudyLives, NamesWhatIsWrong) {
  const PosteriorStudy study = weibull_study({"supplier A", "supplier B"});
  const WeightedDraws draws = points({{1000 * 3600.0, 2}});
  const auto refused = [&](const auto& of) { return message_of<InputError>(of); };
  EXPECT_THAT(refused([&] { lives_of_study(study, draws, "s", true, ""); }),
              HasSubstr("--at: which life is meant, that of supplier A, supplier B?"));
  EXPECT_THAT(refused([&] { lives_of_study(study, draws, "s", true, "suplier B"); }),
              HasSubstr("it has those of supplier A, supplier B; did you mean 'supplier B'?"));
  KnownLives lives = lives_of_study(study, draws, "s", true, "B");
  EXPECT_EQ(lives.noun, "supplier B");
  const auto of_table = [&](const std::string& csv) {
    return refused([&] { add_units_in_service(lives, ages(csv)); });
  };
  EXPECT_THAT(of_table("unit,age\nA,5\n"), HasSubstr("needs its unit in the heading: 'age [h]'"));
  EXPECT_THAT(of_table("unit,age [mm]\nA,5\n"), HasSubstr("ages.csv: column 'age"));
  EXPECT_THAT(of_table("unit,age [h]\nA,-5\n"), HasSubstr("must be at least 0"));
  EXPECT_THAT(of_table("unit,age [h]\nA,5\nA,6\n"), HasSubstr("'A' has a row already"));
  EXPECT_THAT(of_table("unit,age [h],colour\nA,5,red\n"), HasSubstr("'colour' is unknown"));
  EXPECT_THAT(of_table("unit,age [h],in_study\nA,5,perhaps\n"), HasSubstr("use yes or no"));
  EXPECT_THAT(of_table("unit,age [h]\nA,1e6\n"), HasSubstr("no unit survives to"));
}

}  // namespace
}  // namespace wearwell::prognosis
