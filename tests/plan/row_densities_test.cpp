#include "wearwell/plan/row_densities.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "plan/grid_posterior.h"
#include "wearwell/base/error.h"
#include "wearwell/plan/new_level_integral.h"

namespace wearwell::plan {
namespace {

Column words_column(const std::string& name, const std::vector<std::string>& words) {
  return {name, false, {}, words};
}

double log_normal_density(double y, double mean, double variance) {
  return -0.5 * (y - mean) * (y - mean) / variance - 0.5 * std::log(2 * M_PI * variance);
}

// y = a + effect of the machine + effect of the operator, all normal.
constexpr double machine_sd = 0.7, operator_sd = 1.5, noise = 0.2;
Source crossed_source() {
  Source source{{"crossed.toml", R"(model = "formula"
[data]
file = "crossed.csv"
rows_of = "machine"
[data.columns]
y = "y"
machine = "machine"
operator = "operator"
[likelihood.y]
family = "normal"
mean = "a"
sd = 0.2
[random_effects.machine]
a = { distribution = "normal", sd = "0.7" }
[random_effects.operator]
a = { distribution = "normal", sd = "1.5" }
[prior]
a = { distribution = "normal", mean = 0, sd = 3 }
)"}};
  source.tables["crossed.csv"] =
      table_of("crossed.csv", {numbers_column("y", {1.2, 0.4, 2.0, 1.1}),
                               words_column("machine", {"M1", "M1", "M2", "M2"}),
                               words_column("operator", {"Ada", "Ben", "Ada", "Ben"})});
  return source;
}

struct Asked {
  std::string machine, operator_name;
  double y = 0;
};

Points crossed_densities(const TestStudy& study, const std::vector<Asked>& asked,
                         const Points& nodes) {
  std::vector<std::string> machines, operators;
  std::vector<std::size_t> rows;
  std::vector<TestOutcome> outcomes;
  for (const Asked& each : asked) {
    machines.push_back(each.machine), operators.push_back(each.operator_name);
    rows.push_back(rows.size());
    outcomes.push_back({each.y, false});
  }
  const Table conditions =
      table_of("asked", {words_column("machine", machines), words_column("operator", operators)});
  return row_densities(study, rows_with_outcomes(study, conditions, rows, outcomes, "planned"),
                       nodes);
}

// Given a and the operators' effects, readings of one machine are jointly normal.
TEST(RowDensities, AreTheClosedFormOfCrossedNormalEffects) {
  const TestStudy study = test_study(crossed_source(), reading());
  ASSERT_EQ(study.parameters.size(), 4u);  // a, two operators, a new one
  EXPECT_EQ(study.unit, "machine");
  Points nodes(2, 4);
  nodes << 1.0, 0.3, -0.8, 5.0,  //
      -0.5, -1.2, 0.4, -5.0;
  std::vector<Asked> asked;
  for (const double y : {-2.0, 0.1, 1.0, 2.6}) {
    asked.push_back({"", "", y});
    asked.push_back({"", "Ada", y});
    asked.push_back({"M1", "Ben", y});
    asked.push_back({"M1", "", y});
  }
  const Points found = crossed_densities(study, asked, nodes);
  const double own = machine_sd * machine_sd, reading_variance = noise * noise;
  for (int j = 0; j < 2; ++j) {
    const double a = nodes(j, 0), ada = a + operator_sd * nodes(j, 1),
                 ben = a + operator_sd * nodes(j, 2);
    // M1's effect given its two readings.
    const double precision = 1 / own + 2 / reading_variance;
    const double effect = ((1.2 - ada) + (0.4 - ben)) / reading_variance / precision;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const double y = asked[i].y;
      const double expected[] = {
          log_normal_density(y, a, own + operator_sd * operator_sd + reading_variance),
          log_normal_density(y, ada, own + reading_variance),
          log_normal_density(y, ben + effect, 1 / precision + reading_variance),
          log_normal_density(y, a + effect,
                             1 / precision + operator_sd * operator_sd + reading_variance)};
      EXPECT_NEAR(found(j, static_cast<Eigen::Index>(i)), expected[i % 4], 1e-5)
          << "node " << j << ", test " << i;
    }
  }
}

// Steps of a Wiener process are normal; a unit goes on from its last reading.
TEST(RowDensities, OfAUnitOfAProcessContinueItsPath) {
  Source source{{"steps.toml", R"toml(model = "formula"
[data]
file = "steps.csv"
[data.columns]
y = "y"
t = "t"
machine = "machine"
[likelihood.y]
family = "wiener-process"
mean = "rate*t"
sd = "s*sqrt(t)"
[prior]
rate = { distribution = "normal", mean = 1, sd = 3 }
s = { distribution = "half-normal", scale = 1 }
[predict]
along = "t"
)toml"}};
  source.tables["steps.csv"] =
      table_of("steps.csv", {numbers_column("y", {1.1, 1.9, 0.8}), numbers_column("t", {1, 2, 1}),
                             words_column("machine", {"A", "A", "B"})});
  TestStudy study = test_study(source, reading());
  const Table conditions =
      table_of("asked", {words_column("machine", {"A", "B", ""}), numbers_column("t", {4, 4, 4})});
  const std::size_t rows[] = {0, 1, 2};
  const TestOutcome outcomes[] = {{3.5}, {3.5}, {3.5}};
  Points node(1, 2);
  node << 1.2, 0.6;
  const Points found =
      row_densities(study, rows_with_outcomes(study, conditions, rows, outcomes, "planned"), node);
  const double variance = 0.36;
  EXPECT_NEAR(found(0, 0), log_normal_density(3.5, 1.9 + 1.2 * 2, variance * 2), 1e-9);
  EXPECT_NEAR(found(0, 1), log_normal_density(3.5, 0.8 + 1.2 * 3, variance * 3), 1e-9);
  EXPECT_NEAR(found(0, 2), log_normal_density(3.5, 1.2 * 4, variance * 4), 1e-9);
}

// What is asked of units that the data have.
TEST(NextTest, RefusesWhatAUnitCannotShow) {
  Source source = crossed_source();
  source.study.text += "[predict.quantities]\nmiddle = \"a\"\n";
  WeightedDraws draws;
  draws.values = Points::Random(60, 4);
  draws.weights = Eigen::VectorXd::Constant(60, 1.0 / 60);
  const prognosis::CarriedState state = state_of(source, draws);
  const auto refusal = [&](const std::string& machine, const std::string& who,
                           const std::function<void(NextQuestion&)>& change) -> std::string {
    NextQuestion question;
    question.goal = "middle";
    question.candidates =
        table_of("asked", {words_column("machine", {machine}), words_column("operator", {who})});
    change(question);
    try {
      next_test(state, "crossed", reading(), question);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto nothing = [](NextQuestion&) {};
  EXPECT_EQ(refusal("M1", "Ada", nothing), "");
  EXPECT_EQ(refusal("", "", nothing), "");
  EXPECT_THAT(refusal("M3", "Ada", nothing),
              testing::AllOf(testing::HasSubstr("asked, row 1, column 'machine': 'M3'"),
                             testing::HasSubstr("leave the cell empty for a new machine")));
  EXPECT_THAT(refusal("M1", "Eve", nothing), testing::HasSubstr("column 'operator': 'Eve'"));
  EXPECT_THAT(refusal("M1", "Ada", [](NextQuestion& question) { question.batch = 2; }),
              testing::HasSubstr("leave out --batch"));
  EXPECT_THAT(refusal("M1", "Ada", [](NextQuestion& question) { question.specimens = "2"; }),
              testing::HasSubstr("2 readings of one machine"));
}

TEST(NewLevelIntegral, IsTheMeanOfNarrowAndWideDensities) {
  for (const double width : {0.05, 0.3, 2.0}) {
    for (const double middle : {-2.5, 0.1, 3.0}) {
      const NewLevelIntegral level(24);
      Eigen::MatrixXd log_density(25, 1);
      for (int k = 0; k < 25; ++k)
        log_density(k, 0) =
            log_normal_density(level.z()[static_cast<std::size_t>(k)], middle, width * width);
      EXPECT_NEAR(level.log_means(log_density)[0], log_normal_density(middle, 0, 1 + width * width),
                  1e-6)
          << width << " at " << middle;
    }
  }
}

}  // namespace
}  // namespace wearwell::plan
