#include "wearwell/models/clutch/next_point.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/life.h"

namespace wearwell::clutch {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using nlohmann::ordered_json;
using testing::HasSubstr;

constexpr double unit = mm3_per_MJ;

// w = 10 + 20 Td' + 15 (Mz ds)' in mm^3/MJ, the covariance that of 20 measured points.
WearModel sample_model() {
  WearModel model = constant_model(10 * unit, 80 * unit, {0.4, 4, 78e6, 6e6});
  model.title = "Sample";
  model.terms.push_back({"Td", 0, 1, 0, 100, 150, 20 * unit});
  model.terms.push_back({"ds*Mz", 1, 0, 1, 1000, 40'000, 15 * unit});
  model.covariance = Matrix3d{{0.9, -0.5, -0.4}, {-0.5, 1.2, 0.1}, {-0.4, 0.1, 1.5}} * unit * unit;
  model.scatter = {ScatterKind::linear, {50 * unit, 2}};
  model.plate_sd = 0.04;
  return model;
}

Vector3d row_at(const OperatingPoint& at) {
  return {1, (at.temperature - 100) / 150,
          (at.slip_speed * at.closing_time * at.torque - 1000) / 40'000};
}

const OperatingPoint goal_point{200, 50, 170, 2};
const std::string goal =
    "slip_speed = 200 rad/s, torque = 50 N m, temperature = 443.15 K, closing_time = 2 s";

plan::NextQuestion question(const std::string& grid) {
  plan::NextQuestion asked;
  asked.goal = "wear rate at " + goal;
  asked.grid = grid;
  return asked;
}
const std::string grid =
    "slip_speed = 120, 280 rad/s; torque = 30, 70 N m; temperature = 120, 240 degC; closing_time = "
    "2 s; cycles = 400";

// The variance of a candidate's wear rate, by hand: sigma_w = 50 + 2 w, 4 % of a new plate.
double error_variance(const OperatingPoint& at, double closings) {
  const double w = Vector3d(10, 20, 15).dot(row_at(at)), sigma = 50 + 2 * w;
  return sigma * sigma / closings + 0.04 * w * 0.04 * w;
}

OperatingPoint point_of(const ordered_json& candidate) {
  const auto& at = candidate["conditions"];
  return {at["slip_speed"], at["torque"], at["temperature"], at["closing_time"]};
}

// By inversion of the precision of coefficients, which is not how the plan computes it.
TEST(NextPoint, IsTheConjugateUpdateOfTheMap) {
  const WearModel model = sample_model();
  const Matrix3d before = (model.covariance / (unit * unit)).inverse();
  const Vector3d c = row_at(goal_point);
  const double variance = c.dot(before.inverse() * c);
  plan::NextQuestion asked = question(grid);
  asked.specimens = "1, 3";
  const ordered_json json = next_point(model, true, asked).json;
  EXPECT_NEAR(json["goal"]["sd"].get<double>(), std::sqrt(variance), 1e-6);
  EXPECT_NEAR(json["goal"]["q50"].get<double>(), Vector3d(10, 20, 15).dot(c), 1e-9);
  EXPECT_NEAR(json["goal"]["q95"].get<double>() - json["goal"]["q50"].get<double>(),
              1.6448536 * std::sqrt(variance), 1e-6);
  ASSERT_EQ(json["candidates"].size(), 16);
  double last = 1;
  for (const auto& each : json["candidates"]) {
    const OperatingPoint at = point_of(each);
    const Vector3d x = row_at(at);
    const double tests = each["specimens"];
    const Matrix3d after = before + tests / error_variance(at, 400) * x * x.transpose();
    EXPECT_NEAR(each["variance_left"].get<double>(), c.dot(after.inverse() * c) / variance, 1e-9);
    EXPECT_NEAR(each["information"].get<double>(),
                0.5 * std::log(after.determinant() / before.determinant()), 1e-9);
    EXPECT_EQ(each["error"], 0);
    EXPECT_LE(each["narrowing"], last);
    last = each["narrowing"];
  }
}

TEST(NextPoint, CountsClosingsAndTheBalance) {
  const WearModel model = sample_model();
  plan::NextQuestion asked = question(
      "slip_speed = 280 rad/s; torque = 70 N m; temperature = 240 degC; closing_time = 2 s; cycles "
      "= 100, 1000; volume_sd = 0, 2 mm^3");
  const ordered_json json = next_point(model, true, asked).json;
  const Vector3d c = row_at(goal_point), x = row_at({280, 70, 240, 2});
  const Matrix3d covariance = model.covariance / (unit * unit);
  for (const auto& each : json["candidates"]) {
    const double closings = each["conditions"]["cycles"];
    const double sd = each["conditions"]["volume_sd"];
    const double energy = 0.5 * 280 * 70 * 2 * closings / 1e6;  // MJ
    const double error = error_variance({280, 70, 240, 2}, closings) + std::pow(sd / energy, 2);
    const double left = 1 - std::pow(c.dot(covariance * x), 2) / (x.dot(covariance * x) + error) /
                                c.dot(covariance * c);
    EXPECT_NEAR(each["variance_left"].get<double>(), left, 1e-9) << closings << " " << sd;
    EXPECT_EQ(each["test"], closings);
  }
}

// A life is a function of the wear rate: the same narrowing, and its quantiles are those of the
// prediction with another wear rate.
TEST(NextPoint, PlansForALife) {
  const WearModel model = sample_model();
  plan::NextQuestion asked = question(grid);
  const ordered_json rate = next_point(model, true, asked).json;
  asked.goal = "Life at " + goal;
  const ordered_json life = next_point(model, true, asked).json;
  for (std::size_t i = 0; i < rate["candidates"].size(); ++i)
    EXPECT_NEAR(life["candidates"][i]["narrowing"].get<double>(),
                rate["candidates"][i]["narrowing"].get<double>(), 1e-12);
  const std::vector<Cycle> duty = {{1, 1, goal_point, closing_energy(goal_point)}};
  EXPECT_NEAR(
      life["goal"]["q50"].get<double>() / predict_life(model, duty, {1}).levels[0].repetitions, 1,
      1e-9);
  WearModel faster = model;
  const double factor = rate["goal"]["q95"].get<double>() / rate["goal"]["q50"].get<double>();
  for (ModelTerm& each : faster.terms) each.coefficient *= factor;
  EXPECT_NEAR(
      life["goal"]["q05"].get<double>() / predict_life(faster, duty, {1}).levels[0].repetitions, 1,
      1e-6);
}

TEST(NextPoint, ChoosesBatchesAndStops) {
  plan::NextQuestion asked = question(grid);
  asked.batch = 3;
  asked.specimen_cost = 100;
  asked.use_cost = 1;
  asked.until = "width <= 1 mm^3/MJ";
  const ordered_json json = next_point(sample_model(), true, asked).json;
  EXPECT_EQ(json["candidates"][0]["cost"], 500);
  ASSERT_EQ(json["batch"]["chosen"].size(), 3);
  EXPECT_GT(json["batch"]["narrowing"], json["candidates"][0]["narrowing"]);
  EXPECT_EQ(json["until"]["reached"], false);
}

TEST(NextPoint, WarnsWhereTermsMatterMore) {
  WearModel model = sample_model();
  const auto warned = [&] {
    const ordered_json json = next_point(model, true, question(grid)).json;
    return std::any_of(json["checks"].begin(), json["checks"].end(),
                       [](const auto& check) { return check["name"] == "terms"; });
  };
  EXPECT_FALSE(warned());
  for (int i = 0; i < 20; ++i)
    model.replicates.push_back({{1, 1, {{0, 0, 0, (20 + i) * unit}}}, model.run_in});
  EXPECT_TRUE(warned());
}

TEST(NextPoint, NamesWhatIsWrong) {
  const auto refusal = [&](const std::function<void(plan::NextQuestion&)>& change) -> std::string {
    plan::NextQuestion asked = question(grid);
    change(asked);
    try {
      next_point(sample_model(), true, asked);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal([](auto& q) { q.goal = "B10"; }), HasSubstr("a clutch map predicts"));
  EXPECT_THAT(refusal([](auto& q) { q.goal = "wear rate at torque = 50 N m"; }),
              HasSubstr("--goal: slip_speed is missing"));
  EXPECT_THAT(refusal([](auto& q) { q.goal = "life at torqe = 50 N m"; }),
              HasSubstr("did you mean 'torque'"));
  EXPECT_THAT(refusal([](auto& q) { q.goal += ", torque = 3 N m"; }), HasSubstr("given twice"));
  EXPECT_THAT(refusal([](auto& q) { q.goal = "life at torque = 50 s"; }),
              HasSubstr("--goal: torque"));
  EXPECT_THAT(refusal([](auto& q) { q.grid = "torque = 50 N m; cycles = 3"; }),
              HasSubstr("has no column 'slip_speed [rpm]'"));
  EXPECT_THAT(refusal([](auto& q) { q.grid += "; stop = 4 s"; }), HasSubstr("is not a life"));
  EXPECT_THAT(refusal([](auto& q) { q.grid += "; speed = 4 s"; }),
              HasSubstr("'speed [s]' is unknown"));
  EXPECT_THAT(refusal([](auto& q) { q.by = "loss", q.failure_cost = q.replacement_cost = "1"; }),
              HasSubstr("--by: 'loss'"));
  EXPECT_THAT(refusal([](auto& q) { q.measure = "w"; }), HasSubstr("--measure"));
  EXPECT_THAT(refusal([](auto& q) {
                q.grid =
                    "slip_speed = 120 rad/s; torque = 30; temperature = 120 degC; closing_time = "
                    "2 s; cycles = 400";
              }),
              HasSubstr("'torque': needs its unit"));
  EXPECT_THAT(refusal([](auto& q) {
                q.grid =
                    "slip_speed = 120 rad/s; torque = 30 N m; temperature = 120 degC; "
                    "closing_time = 2 s; cycles = 0, 400";
              }),
              HasSubstr("row 1, column 'cycles': 0 must be positive"));
}

class NextPointOfFolder : public ScratchTest {};

TEST_F(NextPointOfFolder, ReadsTheModel) {
  EXPECT_FALSE(is_clutch_result(folder()));
  std::ofstream(folder() / "model.json") << to_json(sample_model()).dump();
  std::ofstream(folder() / "summary.json") << R"({"model": "clutch-wear", "trusted": false})";
  EXPECT_TRUE(is_clutch_result(folder()));
  const plan::Answer answer = next_point(folder(), question(grid));
  EXPECT_FALSE(answer.trusted);
  const WearModel read = read_model_text(to_json(sample_model()).dump(), "model.json");
  EXPECT_EQ(answer.json["candidates"], next_point(read, true, question(grid)).json["candidates"]);
  EXPECT_THROW(read_model_text("{", "model.json"), InputError);
}

}  // namespace
}  // namespace wearwell::clutch
