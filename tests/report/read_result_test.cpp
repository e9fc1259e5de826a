#include "wearwell/report/read_result.h"

#include <gmock/gmock.h>

#include "report/sample.h"
#include "support/json_mutations.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/report/comparison.h"
#include "wearwell/report/csv.h"
#include "wearwell/report/json.h"
#include "wearwell/report/plots_json.h"
#include "wearwell/report/report.h"
#include "wearwell/report/terminal.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

// A result in which everything is there that a folder may hold.
StudyResult full_result() {
  StudyResult result = sample_result();
  const StageSummary first = result.stages[0];
  result.stages = {first, first, first};
  for (std::size_t i = 0; i < 3; ++i) {
    result.stages[i].rows = i + 1;
    result.stages[i].predictions.push_back(first.predictions[0]);
  }
  result.quantities = {
      {"life", "new bearing", "at 1.5 MPa", "h", true, {1, 2, 3, 0.5, 0.8, 2}, {}},
      {"B10", "specimen", "at 300 MPa", "cycles", false, {1, 2, 3, 0, 0, 0, 2.5, 0.7}, {}, 0.95}};
  result.coverage = CoverageTable{
      "cycles",
      {{1, "A", "failure", 5, {}, 0.5, 1, 9, 2}, {2, "B", "interval", 5, 6, 0.5, 1, 9, 2}}};
  const Curve curve{{1, 2, 3}, {0.1, 0.5, 0.2}};
  const History history{{1, 2}, {3, 4}, {2, 3}, {4, 5}, {1, 2}, {5, 6}};
  Plots plots;
  plots.quantity = "worn volume";
  plots.unit = "mm^3";
  plots.at_name = "cycles";
  plots.parameters = {{"wear coefficient", "flat", {{0, 1, 2}, {{1, 0}, {0, 1}}}, curve, curve},
                      {"scatter", "uniform", {{0, 1, 2}, {{1, 0}, {0, 1}}}, {}, curve}};
  plots.joint = DensityGrid{{1, 2}, {3, 4}, {0.1, 0.9, 0.3, 1}};
  plots.stages = {curve, curve, curve};
  plots.history = history;
  plots.history_at = {1, 2};
  plots.history_note = "note";
  plots.replicated = history;
  plots.measured = {3, 4.5};
  plots.life = curve;
  plots.study_text = "title = \"t\"";
  plots.files = {{"study.toml", "da39"}, {"joint.csv", "a3ee"}};
  plots.exhibits["fit"].tables.push_back({"Table", {"a", "b"}, {{"1", "2"}}, false, {"pass"}});
  plots.exhibits["fit"].figures.push_back(
      {"id", "Title", "caption", {{"layer", Json::array({Json::object()})}}});
  result.plots = plots;
  return result;
}

class ReadResult : public ScratchTest {
 protected:
  ReadResult() {
    const StudyResult result = full_result();
    for (std::size_t c = 0; c < 2; ++c)
      write("draws_" + std::to_string(c + 1) + ".csv", draws_csv(result, c));
    put(summary_, plots_);
  }
  void put(const Json& summary, const Json& plots) const {
    write("summary.json", summary.dump());
    write("plots.json", plots.dump());
  }
  std::string refusal() const {
    return message_of<InputError>([&] { read_result(folder()); });
  }
  // All that is done with a result that was read.
  void use() const {
    const StudyResult result = read_result(folder());
    if (result.plots) html_report(result);
    const Comparison comparison = compare({{"a", result}, {"b", result}});
    comparison_text(comparison);
    to_json(comparison);
    comparison_page(comparison);
    terminal_summary(result, {.colour = true, .histograms = true});
  }

  const Json summary_ = to_json(full_result());
  const Json plots_ = to_json(*full_result().plots);
};

TEST_F(ReadResult, LosesNothing) {
  const StudyResult read = read_result(folder());
  EXPECT_EQ(to_json(read).dump(), summary_.dump());
  EXPECT_EQ(to_json(*read.plots).dump(), plots_.dump());
  EXPECT_EQ(read.posterior_draws[1].values, full_result().posterior_draws[1].values);
  EXPECT_TRUE(read.posterior_draws[0].nuts[1].divergent);
  use();
}

class Mutated : public ReadResult {
 protected:
  // Either it is read and can be used, or one message says what is wrong with which file.
  void expect_sane(const std::string& file, const std::string& what) {
    try {
      use();
      ++used_;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr(file), Not(HasSubstr("json.exception")), Not(HasSubstr("\x1b"))))
          << what;
      ++refused_;
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": " << error.what();
    }
  }
  int used_ = 0, refused_ = 0;
};

TEST_F(Mutated, SummaryIsReadOrRefused) {
  mutations(summary_, [&](const std::string& what, const Json& json) {
    put(json, plots_);
    expect_sane("json", what);
  });
  EXPECT_GT(used_, 300);
  EXPECT_GT(refused_, 600);
}

TEST_F(Mutated, PlotsAreReadOrRefused) {
  mutations(plots_, [&](const std::string& what, const Json& json) {
    put(summary_, json);
    expect_sane("plots.json", what);
  });
  EXPECT_GT(used_, 200);
  EXPECT_GT(refused_, 300);
}

TEST_F(ReadResult, NamesFileAndKey) {
  const auto changed = [&](const char* pointer, const Json& value) {
    Json json = summary_;
    json[Json::json_pointer(pointer)] = value;
    put(json, plots_);
    return refusal();
  };
  EXPECT_THAT(changed("/sampler/chains", 0),
              HasSubstr("summary.json is not what wearwell writes: sampler.chains should be a "
                        "whole number from 1 to 1000, and is 0"));
  EXPECT_THAT(changed("/sampler/chains", 3), HasSubstr("plots.json"));
  EXPECT_THAT(changed("/parameters", Json::object()), HasSubstr("parameters is empty"));
  EXPECT_THAT(changed("/mode/parameters/k/at", "<script>"),
              HasSubstr("mode.parameters.k.at should be one of \"inside\""));
  EXPECT_THAT(changed("/stages/1/parameters", Json{{"k", summary_["parameters"]["k"]}}),
              HasSubstr("stages[1].parameters should hold the 2"));
  put(summary_, plots_);
  Json plots = plots_;
  plots["history"]["ci05"].erase(0);
  put(summary_, plots);
  EXPECT_THAT(
      refusal(),
      HasSubstr(
          "plots.json is not what wearwell writes: history should hold 2 values, and holds 1"));
}

TEST_F(ReadResult, DrawsAreOfTheParameters) {
  write("draws_2.csv", "lp__,k,tau\n-1,2,3\n");
  EXPECT_THAT(refusal(),
              HasSubstr("draws_2.csv: its last columns are not the 2 parameters of summary.json"));
  write("draws_2.csv", "lp__,k,sigma\n");
  EXPECT_THAT(refusal(), HasSubstr("draws_2.csv holds no draws"));
  write("draws_2.csv", "lp__,k,sigma\n-1,x,3\n");
  EXPECT_THAT(refusal(),
              HasSubstr("draws_2.csv, draw 1, column 'k': should be a number, and is 'x'"));
  // A chain may wander beyond what a double holds.
  write("draws_2.csv", "lp__,k,sigma\n-inf,inf,3\n-1,nan,2\n-1,2,3\n");
  use();
}

}  // namespace
}  // namespace wearwell
