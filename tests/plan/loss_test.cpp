#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plan/grid_posterior.h"
#include "plan/lives_source.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/plan/next_question.h"

namespace wearwell::plan {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

WeightedDraws lives_posterior() {
  return on_grid(posterior_of(lives_source()), {3600.0 * 40, 3600.0 * 260, 0.4, 7.5, 40});
}

NextQuestion loss_question(const std::string& grid) {
  NextQuestion question;
  question.goal = "B10";
  question.grid = grid;
  question.nodes = 1600;
  question.by = "loss";
  question.failure_cost = "5 EUR";
  question.replacement_cost = "1 EUR";
  return question;
}

// Cost rates of replacement at even ages, and at failure only, in EUR/h: Barlow and Hunter (1960) with
// a plain sum.
std::vector<double> rates_of(double size, double slope) {
  std::vector<double> rates;
  double lived = 0;
  constexpr double step = 1;
  for (double age = step; age < 400; age += step) {
    lived += step * std::exp(-std::pow((age - 0.5 * step) / size, slope));
    const double alive = std::exp(-std::pow(age / size, slope));
    if (std::fmod(age, 4) == 0) rates.push_back((alive + 5 * (1 - alive)) / lived);
  }
  rates.push_back(5 / (size * std::tgamma(1 + 1 / slope)));
  return rates;
}

// By simulation, with densities and cost rates written out.
TEST(NextByLoss, AgreesWithSimulatedDecisions) {
  const WeightedDraws draws = lives_posterior();
  const Eigen::Index n = draws.values.rows();
  std::vector<double> weight;
  Eigen::MatrixXd rates;
  for (Eigen::Index j = 0; j < n; ++j) {
    weight.push_back(draws.weights[j]);
    const auto of = rates_of(draws.values(j, 0) / 3600, draws.values(j, 1));
    if (j == 0) rates.resize(n, std::ssize(of));
    rates.row(j) = Eigen::Map<const Eigen::RowVectorXd>(of.data(), std::ssize(of));
  }
  Eigen::Index best = 0;
  const Eigen::RowVectorXd today = draws.weights.transpose() * rates;
  const double now = today.minCoeff(&best);
  const double known = draws.weights.dot(rates.rowwise().minCoeff());
  constexpr int simulations = 800;
  double sum = 0, squares = 0;
  for (int s = 0; s < simulations; ++s) {
    Rng rng(5, static_cast<std::uint64_t>(s));
    double share = rng.uniform();
    Eigen::Index node = 0;
    while (node + 1 < n && (share -= draws.weights[node]) > 0) ++node;
    Eigen::VectorXd after = draws.weights;
    for (int i = 0; i < 3; ++i) {
      const double life = draws.values(node, 0) / 3600 *
                          std::pow(-std::log(rng.uniform()), 1 / draws.values(node, 1));
      for (Eigen::Index j = 0; j < n; ++j) {
        const double scale = draws.values(j, 0) / 3600, shape = draws.values(j, 1);
        const double hazard = std::pow(std::min(life, 120.0) / scale, shape);
        after[j] *= std::exp(-hazard) * (life < 120 ? shape * hazard : 1);
      }
    }
    after /= after.sum();
    const Eigen::RowVectorXd loss = after.transpose() * rates;
    const double saved = loss[best] - loss.minCoeff();
    sum += saved, squares += saved * saved;
  }
  const double mean = sum / simulations,
               error = std::sqrt((squares / simulations - mean * mean) / simulations);

  NextQuestion question = loss_question("stop = 120 h");
  question.specimens = "3";
  question.samples = 800;
  question.fleet_use = "1e6 h";
  const ordered_json json =
      next_test(state_of(lives_source(), draws), "lives", reading(), question).json;
  const ordered_json& each = json["candidates"][0];
  EXPECT_NEAR(json["loss"]["rate"].get<double>(), now, 0.003 * now);
  EXPECT_NEAR(json["loss"]["rate_known"].get<double>(), known, 0.003 * now);
  EXPECT_NEAR(each["saved"].get<double>(), mean,
              3 * std::hypot(error, each["saved_error"].get<double>()) + 0.05 * mean);
  EXPECT_GT(mean, 5 * error);
  EXPECT_LT(each["saved"].get<double>(), now - known);
  EXPECT_NEAR(each["saving"].get<double>(), 1e6 * each["saved"].get<double>(), 1e-6);
}

TEST(NextByLoss, RanksAndSaysWhetherATestIsWorthIt) {
  const prognosis::CarriedState state = state_of(lives_source(), lives_posterior());
  NextQuestion question = loss_question("stop = 0.001, 60, 1000 h");
  question.nodes = 200;
  question.specimen_cost = 10;
  question.fleet_use = "1e6 h";
  const ordered_json json = next_test(state, "lives", reading(), question).json;
  EXPECT_EQ(json["by"], "loss");
  EXPECT_EQ(json["worth_it"], true);
  double last = 1e9;
  for (const auto& each : json["candidates"]) {
    EXPECT_LE(each["saved"], last);
    last = each["saved"];
    if (each["stop"] == 0.001) {
      EXPECT_NEAR(each["saved"].get<double>(), 0, 1e-6);
    }
  }
  question.fleet_use = "10 h";
  EXPECT_EQ(next_test(state, "lives", reading(), question).json["worth_it"], false);
  question.fleet_use = "";
  question.batch = 2;
  const ordered_json batch = next_test(state, "lives", reading(), question).json;
  EXPECT_EQ(batch["batch"]["chosen"].size(), 2);
  EXPECT_TRUE(batch["candidates"][0]["saving"].is_null());
}

TEST(NextByLoss, NamesWhatIsWrong) {
  const prognosis::CarriedState state = state_of(lives_source(), lives_posterior());
  const auto refusal = [&](const std::function<void(NextQuestion&)>& change) -> std::string {
    NextQuestion question = loss_question("stop = 60 h");
    question.nodes = 100;
    change(question);
    try {
      next_test(state, "lives", reading(), question);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal([](auto& q) { q.goal = "slope"; }),
              HasSubstr("--by loss: slope is not a life"));
  EXPECT_THAT(refusal([](auto& q) { q.failure_cost = ""; }),
              HasSubstr("--failure-cost is missing"));
  EXPECT_THAT(refusal([](auto& q) { q.replacement_cost = "6 EUR"; }),
              HasSubstr("--failure-cost: must be above --replacement-cost"));
  EXPECT_THAT(refusal([](auto& q) { q.replacement_cost = "1 USD"; }), HasSubstr("USD"));
  EXPECT_THAT(refusal([](auto& q) { q.by = "variance"; }),
              HasSubstr("--failure-cost: belongs to --by loss"));
  EXPECT_THAT(refusal([](auto& q) { q.fleet_use = "3 km"; }), HasSubstr("--fleet-use"));
  EXPECT_THAT(refusal([](auto& q) { q.specimen_cost = 3, q.value = 3; }), HasSubstr("--value"));
}

}  // namespace
}  // namespace wearwell::plan
