#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "plan/grid_posterior.h"
#include "plan/lives_source.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/plan/gain.h"
#include "wearwell/plan/goal.h"
#include "wearwell/plan/outcomes.h"

namespace wearwell::plan {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

// y = a + b x with an error of 0.5 mm.
Source line_source() {
  Source source{{"line.toml", R"(title = "Line"
model = "formula"
[data]
file = "line.csv"
[data.columns]
y = { column = "y_mm", unit = "mm" }
x = { column = "x", unit = "1" }
[constants]
noise = "0.5 mm"
[likelihood.y]
family = "normal"
mean = "a + b*x"
sd = "noise"
[prior]
a = { distribution = "normal", mean = "0 mm", sd = "2 mm" }
b = { distribution = "normal", mean = "0 mm", sd = "2 mm" }
[predict]
given = { x = "3" }
[predict.quantities]
at_three = "a + 3*b"
)"}};
  source.tables["line.csv"] = table_of(
      "line.csv", {numbers_column("y_mm", {0.1, 0.9, 1.2}), numbers_column("x", {0, 1, 1.5})});
  return source;
}

// Normal: precision matrix of prior and data.
Eigen::Matrix2d line_precision(const std::vector<double>& more) {
  Eigen::Matrix2d precision = Eigen::Matrix2d::Identity() / 4;
  std::vector<double> all = {0, 1, 1.5};
  all.insert(all.end(), more.begin(), more.end());
  for (const double x : all) {
    const Eigen::Vector2d row(1, x);
    precision += row * row.transpose() / 0.25;
  }
  return precision;
}
double goal_variance(const std::vector<double>& more) {
  const Eigen::Vector2d c(1, 3);
  return c.dot(line_precision(more).inverse() * c);
}

prognosis::CarriedState line_state(int count = 60) {
  const Source source = line_source();
  const Eigen::Matrix2d covariance = line_precision({}).inverse();
  const double sa = 1e-3 * std::sqrt(covariance(0, 0)), sb = 1e-3 * std::sqrt(covariance(1, 1));
  return state_of(source, on_grid(posterior_of(source),
                                  {-6 * sa, 6 * sa, 0.75e-3 - 6 * sb, 0.75e-3 + 6 * sb, count}));
}

NextQuestion line_question(const std::string& grid) {
  NextQuestion question;
  question.goal = "at_three";
  question.grid = grid;
  question.nodes = 4000;
  return question;
}

const ordered_json& at_row(const ordered_json& json, int row, int specimens = 1) {
  for (const auto& each : json["candidates"])
    if (each["row"] == row && each["specimens"] == specimens) return each;
  throw std::runtime_error("no such candidate");
}

TEST(NextTest, IsTheClosedFormForANormalLine) {
  const prognosis::CarriedState state = line_state();
  const ordered_json json =
      next_test(state, "line", reading(), line_question("x = -1, 0, 1, 3, 5")).json;
  EXPECT_EQ(json["goal"]["scale"], "linear");
  const double before = goal_variance({});
  EXPECT_NEAR(1e3 * json["goal"]["sd"].get<double>(), std::sqrt(before),
              0.01 * std::sqrt(before));  // quantities are reported in SI: m
  const double x[] = {-1, 0, 1, 3, 5};
  for (int i = 0; i < 5; ++i) {
    const ordered_json& each = at_row(json, i + 1);
    EXPECT_NEAR(each["variance_left"].get<double>(), goal_variance({x[i]}) / before,
                0.01 * goal_variance({x[i]}) / before)
        << x[i];
    const double information =
        0.5 * std::log(line_precision({x[i]}).determinant() / line_precision({}).determinant());
    EXPECT_NEAR(each["information"].get<double>(), information, 0.01 * information) << x[i];
  }
}

// A gauge is a condition where the data have a column for the standard deviation of a reading.
TEST(NextTest, HasTheGaugeAsACondition) {
  Source source = line_source();
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"sd = \"noise\"", "sd = \"gauge\""},
        {"given = { x = \"3\" }", "given = { x = \"3\", gauge = \"0.5 mm\" }"},
        {"[constants]\nnoise = \"0.5 mm\"\n", ""},
        {"unit = \"1\" }\n",
         "unit = \"1\" }\ngauge = { column = \"gauge_mm\", unit = \"mm\" }\n"}}) {
    const std::size_t at = source.study.text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    source.study.text.replace(at, from.size(), to);
  }
  source.tables["line.csv"].columns.push_back(numbers_column("gauge_mm", {0.5, 0.5, 0.5}));
  const ordered_json json = next_test(state_of(source, line_state().posterior), "line", reading(),
                                      line_question("x = 3; gauge = 0.1, 0.5, 2 mm"))
                                .json;
  const Eigen::Vector2d c(1, 3);
  for (const auto& each : json["candidates"]) {
    const double gauge = each["conditions"]["gauge"];
    const Eigen::Matrix2d after = line_precision({}) + c * c.transpose() / (gauge * gauge);
    EXPECT_NEAR(each["variance_left"].get<double>() * goal_variance({}), c.dot(after.inverse() * c),
                0.02 * c.dot(after.inverse() * c))
        << gauge;
  }
}

TEST(NextTest, OrderOfCandidatesAndThreadsDoNotMatter) {
  const prognosis::CarriedState state = line_state();
  NextQuestion question = line_question("x = -1, 2, 4");
  question.specimens = "1, 3";
  question.nodes = 500;
  const ordered_json all = next_test(state, "line", reading(), question).json;
  question.grid = "x = 4, -1, 2";
  ordered_json other;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    other = next_test(state, "line", reading(), question).json;
  }
  for (std::size_t i = 0; i < all["candidates"].size(); ++i) {
    EXPECT_EQ(all["candidates"][i]["name"], other["candidates"][i]["name"]);
    EXPECT_EQ(all["candidates"][i]["narrowing"], other["candidates"][i]["narrowing"]);
    EXPECT_EQ(all["candidates"][i]["information"], other["candidates"][i]["information"]);
  }
  // More specimens tell more.
  for (int row = 1; row <= 3; ++row)
    EXPECT_GT(at_row(all, row, 3)["narrowing"], at_row(all, row, 1)["narrowing"]);
}

TEST(NextTest, BatchesAndTargets) {
  const prognosis::CarriedState state = line_state();
  NextQuestion question = line_question("x = 0, 1, 3, 5");
  question.nodes = 500;
  question.batch = 3;
  question.specimen_cost = 10;
  question.budget = 25;
  question.until = "width <= 2 mm";
  const ordered_json json = next_test(state, "line", reading(), question).json;
  EXPECT_EQ(json["batch"]["chosen"].size(), 2);  // the budget allows two
  EXPECT_EQ(json["batch"]["cost"], 20);
  EXPECT_GT(json["batch"]["narrowing"], json["candidates"][0]["narrowing"]);
  const int tests = json["until"]["tests"];
  const double x = json["candidates"][0]["conditions"]["x"];
  const std::vector<double> enough(static_cast<std::size_t>(tests), x),
      fewer(static_cast<std::size_t>(tests - 1), x);
  EXPECT_LT(3.29 * std::sqrt(goal_variance(enough)), 2 * 1.05);
  EXPECT_GT(3.29 * std::sqrt(goal_variance(fewer)), 2 * 0.95);
  question.until = "width <= 20 mm";
  EXPECT_EQ(next_test(state, "line", reading(), question).json["until"]["reached"], true);
  question.until = "";
  question.value = 0.01;
  EXPECT_EQ(next_test(state, "line", reading(), question).json["worth_it"], false);
}

TEST(NextTest, CountsTestsDoneSinceTheFit) {
  // Reweighting needs some hundred effective nodes.
  const prognosis::CarriedState state = line_state(200);
  NextQuestion question = line_question("x = 3");
  question.tests = {table_of("log.csv", {numbers_column("y_mm", {1.5}), numbers_column("x", {2})})};
  const ordered_json json = next_test(state, "line", reading(), question).json;
  EXPECT_EQ(json["tests_done"], 1);
  EXPECT_NEAR(1e3 * json["goal"]["sd"].get<double>(), std::sqrt(goal_variance({2})),
              0.01 * std::sqrt(goal_variance({2})));
}

constexpr Grid weibull_grid{3600.0 * 40, 3600.0 * 260, 0.4, 7.5, 40};

double variance_after(const Source& source, std::span<const double> values) {
  const WeightedDraws draws = on_grid(posterior_of(source), weibull_grid);
  std::vector<std::pair<double, double>> nodes;
  for (Eigen::Index j = 0; j < draws.values.rows(); ++j)
    nodes.emplace_back(values[static_cast<std::size_t>(j)], draws.weights[j]);
  std::sort(nodes.begin(), nodes.end());
  std::vector<double> value, weight;
  for (const auto& [v, w] : nodes) value.push_back(v), weight.push_back(w);
  const double sd = goal_spread(value, weight).sd;
  return sd * sd;
}

TEST(NextTest, AgreesWithSimulatedTablesThatAreReadAsData) {
  const Source source = lives_source();
  const WeightedDraws draws = on_grid(posterior_of(source), weibull_grid);
  const auto whole = reading()(source);
  const Goal goal = goal_of(require_posterior_study(*whole), "B10");
  std::vector<double> weights(draws.weights.data(), draws.weights.data() + draws.weights.size());
  const GoalValues values = goal_values(goal, draws.values, weights);
  // The closed form of B10.
  EXPECT_NEAR(std::exp(values.value[700]),
              draws.values(700, 0) / 3600 * std::pow(-std::log(0.9), 1 / draws.values(700, 1)),
              1e-6 * std::exp(values.value[700]));
  const double now = variance_after(source, values.value);
  NextQuestion question;
  question.goal = "B10";
  question.grid = "stop = 90 h";
  question.specimens = "3";
  question.nodes = 1600;
  question.samples = 400;
  const ordered_json json = next_test(state_of(source, draws), "lives", reading(), question).json;
  const ordered_json& best = json["candidates"][0];

  const TestStudy study = test_study(source, reading());
  const Table conditions = table_of("planned", {numbers_column("hours", {NAN})});
  constexpr int simulations = 150;
  double sum = 0, squares = 0, runouts = 0;
  for (int s = 0; s < simulations; ++s) {
    Rng rng(11, static_cast<std::uint64_t>(s));
    double share = rng.uniform();
    Eigen::Index node = 0;
    while (node + 1 < draws.weights.size() && (share -= draws.weights[node]) > 0) ++node;
    std::vector<TestOutcome> outcomes;
    for (int i = 0; i < 3; ++i) {
      const double life = draws.values(node, 0) / 3600 *
                          std::pow(-std::log(rng.uniform()), 1 / draws.values(node, 1));
      outcomes.push_back({std::min(life, 90.0), life > 90});
      runouts += life > 90 ? 1 : 0;
    }
    const std::vector<std::size_t> rows(3, 0);
    const Source joined =
        with_rows(study, rows_with_outcomes(study, conditions, rows, outcomes, "planned"));
    const double left = variance_after(joined, values.value) / now;
    sum += left;
    squares += left * left;
  }
  const double mean = sum / simulations;
  const double error = std::sqrt((squares / simulations - mean * mean) / simulations) +
                       best["variance_error"].get<double>();
  EXPECT_NEAR(best["variance_left"].get<double>(), mean, 3 * error);
  EXPECT_LT(mean, 1 - 4 * error);
  EXPECT_NEAR(best["runouts"].get<double>(), runouts / (3 * simulations), 0.09);
}

TEST(NextTest, TestsStoppedAtOnceShowNothing) {
  const Source source = lives_source();
  NextQuestion question;
  question.goal = "B10";
  question.grid = "stop = 0.001, 60, 1000 h";
  question.nodes = 500;
  const ordered_json json = next_test(state_of(source, on_grid(posterior_of(source), weibull_grid)),
                                      "lives", reading(), question)
                                .json;
  EXPECT_NEAR(at_row(json, 1)["narrowing"].get<double>(), 0, 2e-3);
  EXPECT_NEAR(at_row(json, 1)["information"].get<double>(), 0, 2e-3);
  EXPECT_GT(at_row(json, 1)["runouts"], 0.99);
  EXPECT_LT(at_row(json, 2)["information"], at_row(json, 3)["information"]);
  EXPECT_NEAR(at_row(json, 1)["test"].get<double>(), 0.001, 1e-5);
}

TEST(NextTest, NamesWhatIsWrong) {
  const prognosis::CarriedState state = line_state();
  const auto refusal = [&](const std::function<void(NextQuestion&)>& change) -> std::string {
    NextQuestion question = line_question("x = 1");
    question.nodes = 200;
    change(question);
    try {
      next_test(state, "line", reading(), question);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto candidates = [](const std::vector<Column>& columns) {
    return [=](NextQuestion& question) {
      question.grid = "";
      question.candidates = table_of("tests.csv", columns);
    };
  };
  EXPECT_THAT(refusal([](auto& q) { q.goal = "B10 at hanger"; }), HasSubstr("no life"));
  EXPECT_THAT(
      refusal([](auto& q) { q.goal = "at_thre"; }),
      testing::AllOf(HasSubstr("did you mean 'at_three'"), HasSubstr("at_three of population")));
  EXPECT_THAT(refusal([](auto& q) { q.grid = ""; }), HasSubstr("either --candidates"));
  EXPECT_THAT(refusal([](auto& q) { q.grid = "z = 1"; }), HasSubstr("'z' is unknown"));
  EXPECT_THAT(refusal([](auto& q) { q.grid = "x = 5 to 1 by 1"; }), HasSubstr("does not lead"));
  EXPECT_THAT(refusal([](auto& q) { q.grid = "x = 1; stop = 3 h"; }), HasSubstr("is not a life"));
  EXPECT_THAT(refusal([](auto& q) { q.grid = "x = 1; y = 3 mm"; }), HasSubstr("what a test shows"));
  EXPECT_THAT(refusal([](auto& q) { q.by = "volume"; }), HasSubstr("--by: 'volume'"));
  EXPECT_THAT(refusal([](auto& q) { q.budget = 3; }), HasSubstr("needs costs"));
  EXPECT_THAT(refusal([](auto& q) { q.specimens = "0"; }), HasSubstr("--specimens: '0'"));
  EXPECT_THAT(refusal([](auto& q) { q.measure = "x"; }), HasSubstr("no measured column 'x'"));
  EXPECT_THAT(refusal(candidates({numbers_column("x", {1, NAN})})), HasSubstr("row 2"));
  EXPECT_THAT(refusal(candidates({numbers_column("x", {1, 1})})), HasSubstr("rows 1 and 2"));
  EXPECT_THAT(refusal(candidates({numbers_column("x", {})})), HasSubstr("has no candidates"));
  EXPECT_THAT(refusal(candidates({numbers_column("x [mm]", {1})})), HasSubstr("x [mm]"));
  EXPECT_THAT(refusal([&](auto& q) {
                candidates({numbers_column("x", {1, 2}), numbers_column("cost", {5, -1})})(q);
                q.cost = "cost";
              }),
              HasSubstr("row 2, column 'cost': -1 must be positive"));
  EXPECT_THAT(refusal(candidates({numbers_column("x", {1}), numbers_column("specimens", {1.5})})),
              HasSubstr("whole number"));
}

}  // namespace
}  // namespace wearwell::plan
