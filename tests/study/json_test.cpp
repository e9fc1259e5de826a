#include "wearwell/study/result.h"

#include <gmock/gmock.h>

#include <cmath>

#include "study/sample.h"

namespace wearwell {
namespace {

using testing::IsSupersetOf;
using Json = nlohmann::ordered_json;

Json whole(const PosteriorSummary& result) {
  return summary_json(posterior_result(result));
}

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

// What programs that read summary.json rely on.
TEST(SummaryJson, HasTheKeysOfTheContract) {
  const Json json = whole(sample_result());
  EXPECT_THAT(keys(json),
              IsSupersetOf({"parameters", "stages", "predictions", "life", "checks", "trusted"}));
  for (const Json& parameters : {json["parameters"], json["stages"][0]["parameters"]}) {
    EXPECT_THAT(keys(parameters["k"]),
                IsSupersetOf({"unit", "mean", "sd", "q05", "q50", "q95", "by", "draws"}));
    EXPECT_THAT(
        keys(parameters["k"]["draws"]),
        IsSupersetOf({"mean", "sd", "mcse", "q05", "q50", "q95", "ess_bulk", "ess_tail", "rhat"}));
    EXPECT_EQ(parameters["k"]["by"], "quadrature");
    EXPECT_EQ(parameters["sigma"]["by"], "draws");
    EXPECT_FALSE(parameters["k"].contains("exact"));
  }
  EXPECT_THAT(keys(json["predictions"][0]),
              IsSupersetOf({"cycles", "mean", "ci05", "ci95", "pi05", "pi95", "by", "draws"}));
  EXPECT_THAT(keys(json["life"]),
              IsSupersetOf({"unit", "limit", "limit_unit", "now", "risk", "b1", "b10", "b50", "q05",
                            "q95", "inspect_within", "passed"}));
  for (const Json& check : json["checks"]) {
    EXPECT_THAT(keys(check), IsSupersetOf({"name", "verdict", "detail"}));
  }
  EXPECT_EQ(json["trusted"], false);
}

// What every result begins with, whatever the model.
TEST(SummaryJson, BeginsWithTheHeader) {
  const Json json = whole(sample_result());
  const std::vector<std::string> names = keys(json);
  ASSERT_GE(names.size(), 9u);
  EXPECT_THAT((std::vector<std::string>(names.begin(), names.begin() + 9)),
              testing::ElementsAre("wearwell", "schema", "title", "model", "equation", "data",
                                   "seed", "trusted", "checks"));
  EXPECT_EQ(json["data"]["files"], (Json{"joint.csv"}));
  EXPECT_EQ(json["data"]["file"], "joint.csv");
  EXPECT_EQ(json["seed"].get<std::uint64_t>(), 18446744073709551615u);
}

TEST(SummaryJson, HoldsWhatWasFound) {
  const PosteriorSummary result = sample_result();
  const Json json = Json::parse(whole(result).dump(2));
  // The plain names hold the best values: by quadrature where there is one.
  EXPECT_EQ(json["parameters"]["k"]["mean"].get<double>(), 7.51e-4);
  EXPECT_EQ(json["parameters"]["k"]["sd"].get<double>(), 1.1e-5);
  EXPECT_EQ(json["parameters"]["k"]["draws"]["mean"].get<double>(), 7.5e-4);
  EXPECT_EQ(json["parameters"]["sigma"]["mean"].get<double>(), 2);
  EXPECT_EQ(json["parameters"]["sigma"]["draws"]["mean"].get<double>(), 2);
  EXPECT_EQ(json["predictions"][0]["pi95"].get<double>(), 101.5);
  EXPECT_EQ(json["predictions"][0]["draws"]["pi95"].get<double>(), 101);
  EXPECT_EQ(json["life"]["by"], "draws");  // nothing else stands beside it
  EXPECT_FALSE(json["life"].contains("draws"));
  EXPECT_FALSE(json["predictions"][0].contains("measured"));
  EXPECT_EQ(json["stages"][0]["rows"].get<int>(), 1);
  EXPECT_EQ(json["stages"][0]["predictions"][0]["measured"].get<double>(), 92.73);
  EXPECT_EQ(json["sampler"]["seed"].get<std::uint64_t>(), result.seed);
  EXPECT_EQ(json["log_evidence"].get<double>(), -12.25);
  EXPECT_EQ(json["density_unit"], "mm^3");
  std::vector<std::string> verdicts;
  for (const Json& check : json["checks"]) verdicts.push_back(check["verdict"]);
  EXPECT_THAT(verdicts, testing::ElementsAre("pass", "warn", "fail"));
}

TEST(SummaryJson, HoldsTheModeAndLeaveOneOut) {
  PosteriorSummary result = sample_result();
  const Json json = Json::parse(whole(result).dump());
  const Json& mode = json["mode"];
  EXPECT_EQ(mode["parameters"]["k"]["value"].get<double>(), 7.4e-4);
  EXPECT_EQ(mode["parameters"]["k"]["standard_error"].get<double>(), 9e-6);
  EXPECT_EQ(mode["parameters"]["sigma"]["at"], "upper bound");
  EXPECT_TRUE(mode["parameters"]["sigma"]["standard_error"].is_null());
  EXPECT_EQ(mode["log_likelihood"].get<double>(), -20.5);
  EXPECT_EQ(mode["density_unit"], "mm^3");
  EXPECT_EQ(json["loo"]["density_unit"], "mm^3");
  EXPECT_EQ(mode["aic"].get<double>(), 45);
  EXPECT_EQ(mode["maximum_likelihood"], false);
  const Json& loo = json["loo"];
  EXPECT_EQ(loo["elpd"].get<double>(), -7.5);  // the second was seen twice
  EXPECT_EQ(loo["p_loo"].get<double>(), 2.25);
  EXPECT_EQ(loo["khat_max"].get<double>(), 0.875);
  EXPECT_EQ(loo["pointwise"][1]["count"].get<int>(), 2);
  EXPECT_EQ(loo["pointwise"][1]["refitted"], true);
  EXPECT_EQ(json["data"]["fingerprint"], "da39a3ee");
  EXPECT_EQ(json["data"]["remarks"], Json::array({"1 hidden row left out (3)"}));
  result.mode->problem = "the density still rises";
  EXPECT_EQ(whole(result)["mode"], (Json{{"problem", "the density still rises"}}));
}

TEST(SummaryJson, WhatIsNoNumberIsNull) {
  PosteriorSummary result = sample_result();
  result.parameters[0].rhat = std::nan("");
  const Json json = Json::parse(whole(result).dump());
  EXPECT_TRUE(json["parameters"]["k"]["draws"]["rhat"].is_null());
  EXPECT_TRUE(json["life"]["q95"].is_null());  // a life that never ends
}

TEST(SummaryJson, LeavesOutWhatTheStudyDidNotAsk) {
  PosteriorSummary result = sample_result();
  result.life.reset();
  result.pointwise.reset();
  result.log_evidence.reset();
  result.stages.clear();
  result.predictions.clear();
  const Json json = whole(result);
  EXPECT_FALSE(json.contains("life"));
  EXPECT_FALSE(json.contains("pointwise"));
  EXPECT_FALSE(json.contains("log_evidence"));
  EXPECT_EQ(json["stages"], Json::array());
  EXPECT_EQ(json["predictions"], Json::array());
}

}  // namespace
}  // namespace wearwell
