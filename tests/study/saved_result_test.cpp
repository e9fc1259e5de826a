#include "wearwell/study/saved_result.h"

#include <gmock/gmock.h>

#include "study/sample.h"
#include "support/json_mutations.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/present/section_json.h"
#include "wearwell/study/comparison.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

// A result in which everything is there that a folder may hold.
PosteriorSummary full_result() {
  PosteriorSummary result = sample_result();
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
  result.quantity = "worn volume";
  plots.unit = "mm^3";
  plots.at_name = "cycles";
  plots.parameters = {{{{0, 1, 2}, {{1, 0}, {0, 1}}}, curve, curve},
                      {{{0, 1, 2}, {{1, 0}, {0, 1}}}, {}, curve}};
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
  plots.figures["fit"].push_back(
      {"id", "Title", "caption", {{"layer", Json::array({Json::object()})}}});
  result.plots = plots;
  return result;
}

class SavedResults : public ScratchTest {
 protected:
  SavedResults() {
    for (const auto& [name, content] : full_.files) write(name, content);
    put(summary_, report_);
  }
  void put(const Json& summary, const Json& report) const {
    write("summary.json", summary.dump());
    write("report.json", report.dump());
  }
  std::string refusal() const {
    return message_of<InputError>([&] { use(); });
  }
  // All that is done with a result that was read.
  void use() const {
    const SavedReport report = read_saved_report(folder());
    report_html(report.header, report.sections);
    const SavedResult result = read_saved_result(folder());
    const Comparison comparison = compare({{"a", result}, {"b", result}});
    comparison_text(comparison);
    to_json(comparison);
    comparison_page(comparison);
  }

  const Result full_ = posterior_result(full_result());
  const Json summary_ = summary_json(full_);
  const Json report_ = present::to_json(full_.sections);
};

TEST_F(SavedResults, LoseNothing) {
  const SavedReport report = read_saved_report(folder());
  EXPECT_EQ(report_html(report.header, report.sections), report_html(full_.header, full_.sections));
  EXPECT_THAT(report_html(report.header, report.sections),
              HasSubstr("rows of joint.csv; 1 hidden row left out (3)"));
  const SavedResult read = read_saved_result(folder());
  const PosteriorSummary full = full_result();
  EXPECT_EQ(to_json(compare({{"a", read}, {"b", read}})).dump(),
            to_json(compare({{"a", saved(full)}, {"b", saved(full)}})).dump());
  EXPECT_EQ(read.draws[1].values, full.posterior_draws[1].values);
  EXPECT_TRUE(read.draws[0].nuts[1].divergent);
  use();
}

// Results of the versions before there was a schema.
TEST_F(SavedResults, OldOnesAreRefusedInWords) {
  Json old = summary_;
  old.erase("schema");
  old["wearwell"] = "0.1.0";
  put(old, report_);
  EXPECT_THAT(refusal(),
              HasSubstr("was written by wearwell 0.1.0 with schema 0, and this one reads "
                        "schema 1: fit the study again"));
}

class Mutated : public SavedResults {
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
    write("summary.json", json.dump());
    expect_sane("json", what);
  });
  EXPECT_GT(used_, 300);
  EXPECT_GT(refused_, 500);
}

TEST_F(Mutated, ReportIsReadOrRefused) {
  mutations(report_, [&](const std::string& what, const Json& json) {
    write("report.json", json.dump());
    expect_sane("report.json", what);
  });
  EXPECT_GT(used_, 200);
  EXPECT_GT(refused_, 300);
}

TEST_F(SavedResults, NamesFileAndKey) {
  const auto changed = [&](const char* pointer, const Json& value) {
    Json json = summary_;
    json[Json::json_pointer(pointer)] = value;
    put(json, report_);
    return refusal();
  };
  EXPECT_THAT(changed("/sampler/chains", 0),
              HasSubstr("summary.json is not what wearwell writes: sampler.chains should be a "
                        "whole number from 1 to 1000, and is 0"));
  EXPECT_THAT(changed("/sampler/chains", 3), HasSubstr("draws_3.csv"));
  EXPECT_THAT(changed("/parameters", Json::object()), HasSubstr("parameters is empty"));
  EXPECT_THAT(changed("/mode/parameters/k/at", "<script>"),
              HasSubstr("mode.parameters.k.at should be one of \"inside\""));
  Json report = report_;
  Json& table = report["sections"][1]["blocks"][1];
  ASSERT_TRUE(table.contains("table")) << table.dump();
  table["rows"][0].erase(0);
  put(summary_, report);
  EXPECT_THAT(refusal(),
              HasSubstr("report.json is not what wearwell writes: sections[1].blocks[1].rows[0] "
                        "has 5 cells, but the table has 6 columns"));
}

TEST_F(SavedResults, DrawsAreOfTheParameters) {
  write("draws_2.csv", "lp__,k,tau\n-1,2,3\n");
  EXPECT_THAT(refusal(),
              HasSubstr("draws_2.csv: its last columns are not the 2 parameters of summary.json"));
  write("draws_2.csv", "lp__,k,sigma\n");
  EXPECT_THAT(refusal(), HasSubstr("draws_2.csv does not contain draws"));
  write("draws_2.csv", "lp__,k,sigma\n-1,x,3\n");
  EXPECT_THAT(refusal(),
              HasSubstr("draws_2.csv, draw 1, column 'k': should be a number, and is 'x'"));
  // A chain may wander beyond what a double holds.
  write("draws_2.csv", "lp__,k,sigma\n-inf,inf,3\n-1,nan,2\n-1,2,3\n");
  use();
}

}  // namespace
}  // namespace wearwell
