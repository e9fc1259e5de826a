#include "wearwell/study/comparison.h"

#include <gmock/gmock.h>

#include "study/sample.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/study/comparison_overlays.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

SavedResult sample(std::vector<LooTerm> terms, const std::string& fingerprint = "da39a3ee") {
  PosteriorSummary result = sample_result();
  result.trusted = true;
  result.data_fingerprint = fingerprint;
  result.loo->loo.terms = std::move(terms);
  return saved(result);
}

std::vector<std::string> names(const Comparison& comparison) {
  std::vector<std::string> all;
  for (const auto& each : comparison.studies) all.push_back(each.name);
  return all;
}

// Differences 1 and 3 of the worse: sum 4, and sqrt(2) times their standard deviation sqrt(2).
TEST(Comparison, RanksByElpd) {
  const Comparison comparison = compare({{"worse", sample({{-3, 0, 0.1}, {-5, 0, 0.1}})},
                                         {"better", sample({{-2, 0, 0.1}, {-2, 0, 0.1}})}});
  EXPECT_TRUE(comparison.comparable);
  EXPECT_THAT(names(comparison), ElementsAre("better", "worse"));
  EXPECT_EQ(comparison.studies[0].behind->value, 0);
  EXPECT_DOUBLE_EQ(comparison.studies[1].behind->value, 4);
  EXPECT_DOUBLE_EQ(comparison.studies[1].behind->se, 2);
  const auto json = to_json(comparison);
  EXPECT_EQ(json["studies"][1]["behind"]["elpd"].get<double>(), 4);
  EXPECT_NEAR(json["studies"][0]["weight"].get<double>(), 1, 1e-6);
  EXPECT_EQ(json["studies"][1]["mode"]["bic"].get<double>(), 44.25);
  EXPECT_EQ(json["studies"][0]["parameters"]["k"]["mean"].get<double>(), 7.51e-4);
  const std::string text = comparison_text(comparison);
  EXPECT_THAT(text, HasSubstr("better"));
  EXPECT_THAT(text, HasSubstr("Log densities (elpd, AIC, BIC): data in mm^3"));
  EXPECT_THAT(text, HasSubstr("7.510\u00a0×\u00a010^-4 +- 1.100\u00a0×\u00a010^-5"));
  EXPECT_THAT(text, HasSubstr("AIC and BIC of worse are computed at the mode"));
  EXPECT_THAT(text, HasSubstr("With 2 observations"));
}

// The same data in another unit: log densities differ by that alone.
TEST(Comparison, NeverRanksLogDensitiesInDifferentUnits) {
  SavedResult other = sample({{-3, 0, 0.1}, {-5, 0, 0.1}});
  other.loo->density_unit = "m^3";
  const Comparison comparison =
      compare({{"a", sample({{-2, 0, 0.1}, {-2, 0, 0.1}})}, {"b", other}});
  EXPECT_FALSE(comparison.comparable);
  EXPECT_THAT(comparison.obstacle,
              HasSubstr("Log densities of a are for data in mm^3, those of b for data in m^3"));
}

// Each of two predicts half of the observations: they share the weight, whoever is best in sum.
TEST(Comparison, WeighsByWhatAMixtureWouldPredict) {
  const Comparison comparison = compare({{"early", sample({{-1, 0, 0.1}, {-5, 0, 0.1}})},
                                         {"late", sample({{-4.9, 0, 0.1}, {-1, 0, 0.1}})}});
  double sum = 0;
  for (const auto& each : comparison.studies) {
    EXPECT_NEAR(each.weight, 0.5, 0.01);
    sum += each.weight;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_THAT(comparison_text(comparison), HasSubstr("(stacking): late 0.5"));
}

// Differences within twice the errors of both are not known: those studies stay as given.
TEST(Comparison, NeverRanksWithinTheError) {
  const auto with = [](double elpd, double error) {
    SavedResult result = sample({{elpd, 0, 0.1}, {elpd, 0, 0.1}});
    result.loo->loo.error = error;
    return result;
  };
  const Comparison near =
      compare({{"worst", with(-9, 0.1)}, {"first", with(-2.05, 0.1)}, {"second", with(-2, 0.1)}});
  EXPECT_THAT(names(near), ElementsAre("first", "second", "worst"));
  EXPECT_THAT(comparison_text(near), HasSubstr("The order of first, second is unknown"));
  EXPECT_NEAR(near.studies[0].behind->value, 0.1, 1e-12);
  EXPECT_EQ(near.studies[1].behind->value, 0);
  const Comparison far = compare({{"first", with(-2.05, 0.01)}, {"second", with(-2, 0.01)}});
  EXPECT_THAT(names(far), ElementsAre("second", "first"));
  EXPECT_THAT(comparison_text(far), Not(HasSubstr("is unknown")));
}

TEST(Comparison, NeverRanksDifferentData) {
  const Comparison comparison =
      compare({{"one", sample({{-3, 0, 0.1}})}, {"other", sample({{-2, 0, 0.1}}, "b6589fc6")}});
  EXPECT_FALSE(comparison.comparable);
  EXPECT_THAT(names(comparison), ElementsAre("one", "other"));
  EXPECT_THAT(comparison.obstacle, HasSubstr("one and other use different data"));
  EXPECT_THAT(comparison_text(comparison), Not(HasSubstr("elpd  ")));
  EXPECT_FALSE(to_json(comparison)["studies"][1].contains("behind"));
  const std::string page = comparison_page(comparison);
  EXPECT_THAT(page, HasSubstr("Not ranked."));
  EXPECT_THAT(page, HasSubstr("Histograms of k in each study"));
}

TEST(Comparison, NeverRanksDifferentObservationsOfTheSameData) {
  SavedResult bearings = sample({{-3, 0, 0.1}});
  bearings.loo->observation = "bearing";
  EXPECT_THAT(compare({{"a", sample({{-3, 0, 0.1}, {-1, 0, 0.1}})}, {"b", bearings}}).obstacle,
              HasSubstr("a leaves out one row at a time, b one bearing"));
  SavedResult improper = sample({});
  improper.loo.reset();
  EXPECT_THAT(compare({{"a", sample({{-3, 0, 0.1}})}, {"b", improper}}).obstacle,
              HasSubstr("b has no leave-one-out prediction"));
}

TEST(Comparison, NamesDoubtAndDistrust) {
  SavedResult bad = sample({{-3, 0, 0.9}});
  bad.header.trusted = false;
  const Comparison comparison = compare({{"good", sample({{-2, 0, 0.1}})}, {"bad", bad}});
  const std::string text = comparison_text(comparison);
  EXPECT_THAT(text, HasSubstr("bad is not trusted"));
  EXPECT_THAT(text, HasSubstr("elpd of bad is unreliable: Pareto k exceeds 0.70 for 1 of 1"));
}

TEST(Comparison, NamesAreTextAndNotMarkup) {
  const std::string evil = "</script><img src=x onerror=alert(1)>";
  const std::string page =
      comparison_page(compare({{evil, sample({{-3, 0, 0.1}})}, {"b", sample({{-2, 0, 0.1}})}}));
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, HasSubstr("&lt;img src=x"));
}

class CompareCommand : public ScratchTest {};

TEST_F(CompareCommand, OfTheJointStudies) {
  const std::string examples = PROJECT_SOURCE_DIR "/examples/joint/";
  const std::string one = (folder() / "normal").string(), two = (folder() / "tribometer").string(),
                    page = (folder() / "page.html").string();
  ASSERT_EQ(
      run_wearwell("fit " + examples + "normal_flat.toml --quiet --no-report -o " + one).exit_code,
      0);
  run_wearwell("fit " + examples + "normal_tribometer.toml --quiet --no-report -o " + two);
  const CommandResult run = run_wearwell("compare --json -o " + page + " " + two + " " + one);
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["comparable"], true) << run.out;
  EXPECT_EQ(json["studies"].size(), 2u);
  EXPECT_TRUE(std::filesystem::exists(page));
  // The prior that contradicts the data fails a check, so the comparison is no clean one.
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run_wearwell("compare " + one).exit_code, 2);
  EXPECT_EQ(run_wearwell("compare " + one + " " + folder().string()).exit_code, 2);
  EXPECT_EQ(run_wearwell("compare -o page.txt " + one + " " + two).exit_code, 2);
}

// Curves of both studies over one pair of axes, each study in its colour there and in the histograms;
// and the lives of both side by side.
TEST(Comparison, PageHasCurvesAndLivesOverEachOther) {
  const auto with_curve = [](double slope) {
    SavedResult result = sample({{-2, 0, 0.1}, {-2, 0, 0.1}});
    result.figures.push_back({"sn-curve", "S-N curve", "",
                              plot::plot("", {"Life", true}, {"Stress", true},
                                         {plot::line({{"x", {1e3, 1e6}}, {"y", {500, 500 * slope}}},
                                                     {"#111111", "half"}),
                                          plot::line({{"x", {1e2, 1e5}}, {"y", {500, 500 * slope}}},
                                                     {"#222222", "at least", 1, 2, true})})});
    result.quantities = {{"B10 life",
                          "shaft",
                          "at 400 MPa",
                          "cycles",
                          false,
                          {1, 2, 3, 0, 0, 0, 2000 * slope, 1000 * slope},
                          {}}};
    return result;
  };
  Comparison comparison = compare({{"steep", with_curve(0.25)}, {"flat", with_curve(0.5)}});
  const std::vector<html::Figure> figures = curve_figures(comparison);
  ASSERT_EQ(figures.size(), 1u);
  const auto& layers = figures[0].specification["layer"];
  ASSERT_EQ(layers.size(), 4u);
  EXPECT_EQ(layers[0]["data"]["values"], "x,y\n1000,500\n1e+06,125");
  EXPECT_EQ(layers[2]["data"]["values"], "x,y\n1000,500\n1e+06,250");
  EXPECT_TRUE(layers[1]["mark"].contains("strokeDash"));
  EXPECT_EQ(layers[0]["encoding"]["y"]["scale"]["type"], "log");
  EXPECT_THAT(layers[0]["encoding"]["color"]["scale"]["domain"], ElementsAre("steep", "flat"));
  EXPECT_THAT(layers[0]["encoding"]["color"]["scale"]["range"],
              ElementsAre(look_of_study(0, "").colour, look_of_study(1, "").colour));
  EXPECT_EQ(layers[1]["mark"]["stroke"], look_of_study(0, "").colour);
  const present::Table lives = life_table(comparison);
  ASSERT_EQ(lives.rows.size(), 2u);
  EXPECT_EQ(std::get<double>(lives.rows[0][4]), 250);
  EXPECT_EQ(std::get<double>(lives.rows[1][4]), 500);
  EXPECT_THAT(comparison_page(comparison), HasSubstr("overlay-sn-curve"));
  // One study alone has no overlay.
  comparison.studies[1].result.figures.clear();
  EXPECT_TRUE(curve_figures(comparison).empty());
}

}  // namespace
}  // namespace wearwell
