// The numerical error that lives are reported with is at least what they differ by from the same lives over many more
// points of the posterior.
#include <gtest/gtest.h>

#include <cmath>

#include "models/formula_model/watched.h"
#include "wearwell/base/rng.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::formula_model {
namespace {

const std::vector<double> shares = {0.01, 0.1, 0.5};

std::vector<Column> lines(const std::vector<double>& offsets, double noise) {
  const std::vector<double> rates = {0.8, 1.3, 1.0, 0.6, 1.1};
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  Rng rng(7, 0);
  for (std::size_t u = 0; u < rates.size(); ++u) {
    for (int i = 1; i <= 5; ++i) {
      time.push_back(i);
      depth.push_back(offsets[u] + rates[u] * i + noise * rng.normal());
      unit.push_back("u" + std::to_string(u));
    }
  }
  return {numbers("depth", depth), numbers("time", time), texts("unit", unit)};
}

// Random steps that only rise.
std::vector<Column> steps() {
  const std::vector<double> rates = {0.8, 1.3, 1.0, 0.6, 1.1};
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  Rng rng(9, 0);
  for (std::size_t u = 0; u < rates.size(); ++u) {
    double path = 0;
    for (int i = 1; i <= 5; ++i) {
      path += rates[u] * (0.4 - 0.6 * std::log(rng.uniform()));
      time.push_back(i);
      depth.push_back(path);
      unit.push_back("u" + std::to_string(u));
    }
  }
  return {numbers("depth", depth), numbers("time", time), texts("unit", unit)};
}

const std::string process = R"(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
unit = "unit"
[likelihood.depth]
family = "gamma-process"
mean = "b * time"
scale = "u"
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
scatter = { distribution = "half-normal", scale = 0.5 }
u = { distribution = "half-normal", scale = "1 um" }
[random_effects.unit]
b = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
limit = { depth = "12 um" }
)";

const std::string two_effects = R"(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
unit = "unit"
[formula]
wear = "a + b * time"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "0.2 [um]"
[prior]
a = { distribution = "normal", mean = "1 um", sd = "0.5 um" }
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
b_scatter = { distribution = "half-normal", scale = 0.5 }
[random_effects.unit]
a = { distribution = "normal", sd = "0.4 [um]" }
b = { distribution = "lognormal", log_sd = "b_scatter" }
[predict]
along = "time"
limit = { wear = "12 um" }
)";

QuantityQuantiles quantiles_of(const CellMixture& life) {
  const double middle = life.quantile(0.5);
  return {life.quantile(0.05), middle, life.quantile(0.95), life.quantile(0.01),
          life.quantile(0.1),  middle};
}

// Of a new unit, each one seen, and of shares of all.
std::vector<QuantityQuantiles> answers_of(const LimitedLives& lives) {
  std::vector<QuantityQuantiles> all = {quantiles_of(lives.next)};
  for (const CellMixture& each : lives.remaining) all.push_back(quantiles_of(each));
  for (std::size_t i = 0; i < lives.by_share.size(); ++i) {
    all.push_back(quantiles_of(lives.by_share[i]));
    all.back().b1 = all.back().b10 = all.back().b50 = 0;
    if (i < lives.share_misfit.size()) all.back().numerical_error = lives.share_misfit[i];
  }
  return all;
}

double largest_difference(const QuantityQuantiles& a, const QuantityQuantiles& b) {
  double largest = 0;
  for (const auto each : {&QuantityQuantiles::q05, &QuantityQuantiles::q50, &QuantityQuantiles::q95,
                          &QuantityQuantiles::b1, &QuantityQuantiles::b10})
    largest = std::max(largest, relative_difference(a.*each, b.*each, a.q50));
  return largest;
}

// `many`: times as many points as lives are summed over.
void expect_bounded(const std::string& study, const std::vector<Column>& columns, double many,
                    double most) {
  const Watched watched(study, columns);
  const WeightedDraws posterior = watched.fitted();
  const auto lives = [&](double share) {
    return answers_of(lives_of_fit(watched, posterior, true, share, shares));
  };
  std::vector<QuantityQuantiles> answers = lives(1);
  estimate_numerical_errors(answers, lives(fewer_points));
  const std::vector<QuantityQuantiles> fine = lives(many);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const double off = largest_difference(answers[i], fine[i]);
    EXPECT_LE(off, std::max(*answers[i].numerical_error, least_numerical_error)) << i;
    EXPECT_LE(*answers[i].numerical_error, most) << i;  // a bound that says anything
    ::testing::Test::RecordProperty(
        "answer " + std::to_string(i),
        fmt::format("off {:.2g}, estimated {:.2g}", off, *answers[i].numerical_error));
  }
}

TEST(FormulaNumericalError, OfUnitsThatDiffer) {
  expect_bounded(straight, lines({0, 0, 0, 0, 0}, 0.3), 10, 0.05);
}

TEST(FormulaNumericalError, OfUnitsThatDifferTwofold) {
  expect_bounded(two_effects, lines({1.2, 0.7, 1.0, 1.5, 0.9}, 0.2), 2, 0.1);
}

TEST(FormulaNumericalError, OfProcesses) {
  expect_bounded(process, steps(), 3, 0.2);
}

}  // namespace
}  // namespace wearwell::formula_model
