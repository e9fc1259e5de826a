// Predictions from published lives, against sums over dense grids and closed forms that share no code with them: how
// many of the next items fail (predictive) is more than how many of all do in the median of the posterior.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

class PublishedPredictions : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& text) const {
    return run_study(wearwell::read_posterior_study(write("study.toml", text)),
                     {Method::exact, 1, {}, 200, {}}, {}, false);
  }
  prognosis::UnitLife ask(const std::string& text, const PosteriorSummary& result,
                          const prognosis::LifeQuestion& question) const {
    return prognosis::unit_life(
        source_of(write("study.toml", text)),
        [](const Source& source) { return read_study(source, all_models()); },
        result.fit->exact->nodes, question);
  }
  static const QuantityQuantiles& found(const PosteriorSummary& result, const std::string& name) {
    for (const QuantitySummary& each : result.quantities)
      if (each.name == name) return each.best();
    throw std::logic_error("no " + name);
  }
};

double normal_log_density(double x, double mean, double sd) {
  return -0.5 * (x - mean) * (x - mean) / (sd * sd);
}

// A share of all items over a posterior on a grid: of each line of the grid it rises or falls.
struct KnownShare {
  struct Line {
    std::vector<double> share, weight;
  };
  std::vector<Line> lines;
  double all = 0;

  void add(Line line) {
    for (const double each : line.weight) all += each;
    lines.push_back(std::move(line));
  }
  double mean() const {
    double sum = 0;
    for (const Line& each : lines)
      for (std::size_t i = 0; i < each.share.size(); ++i) sum += each.weight[i] * each.share[i];
    return sum / all;
  }
  // The probability that the share is at most p: between nodes the weight is even.
  double below(double p) const {
    double sum = 0;
    for (const Line& each : lines) {
      for (std::size_t i = 0; i + 1 < each.share.size(); ++i) {
        const double low = std::min(each.share[i], each.share[i + 1]),
                     high = std::max(each.share[i], each.share[i + 1]);
        const double part = p >= high ? 1 : p <= low ? 0 : (p - low) / (high - low);
        sum += part * 0.5 * (each.weight[i] + each.weight[i + 1]);
      }
    }
    return sum / all;
  }
};

// A survival in percent of a share that has failed.
double failed(double survival) {
  return 1 - survival / 100;
}

void expect_quantile(const KnownShare& known, double survival, double p, double tolerance) {
  const double share = failed(survival);
  EXPECT_LT(known.below(share * (1 - tolerance)), 1 - p) << share;
  EXPECT_GT(known.below(share * (1 + tolerance)), 1 - p) << share;
}

// Minutes to breakdown of an insulating fluid between electrodes (Nelson 1972; Nelson 1990, Accelerated Testing, table 3.1 of
// chapter 3; Lawless 2003, section 1.1.5).
struct Breakdown {
  double kilovolt;
  std::vector<double> minutes;
};
const std::vector<Breakdown> breakdowns = {
    {26, {5.79, 1579.52, 2323.70}},
    {28, {68.85, 108.29, 110.29, 426.07, 1067.60}},
    {30, {7.74, 17.05, 20.46, 21.02, 22.66, 43.40, 47.30, 139.07, 144.12, 175.88, 194.90}},
    {32,
     {0.27, 0.40, 0.69, 0.79, 2.75, 3.91, 9.88, 13.95, 15.93, 27.80, 53.24, 82.85, 89.29, 100.58,
      215.10}},
    {34,
     {0.19, 0.78, 0.96, 1.31, 2.78, 3.16, 4.15, 4.67, 4.85, 6.50, 7.35, 8.01, 8.27, 12.06, 31.75,
      32.52, 33.91, 36.71, 72.89}},
    {36,
     {0.35, 0.59, 0.96, 0.99, 1.69, 1.97, 2.07, 2.58, 2.71, 2.90, 3.67, 3.99, 5.35, 13.77, 25.50}},
    {38, {0.09, 0.39, 0.47, 0.73, 0.74, 1.13, 1.40, 2.38}}};

const char* const fluid = R"toml(
model = "formula"
[data]
file = "fluid.csv"
[data.columns]
life = { column = "minutes", unit = "min" }
voltage = { column = "kilovolt", unit = "kV" }
[likelihood.life]
family = "weibull"
scale = "eta * (voltage / 20 [kV])^-n"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "2000 h", log_sd = 2 }
n = { distribution = "normal", mean = 15, sd = 5 }
beta = { distribution = "lognormal", median = 1, log_sd = 0.5 }
[predict]
given = { voltage = "20 kV" }
survival_to = "100 h"
)toml";

TEST_F(PublishedPredictions, InsulatingFluidAtTwentyKilovolts) {
  std::string rows = "minutes,kilovolt\n";
  double count = 0;
  for (const Breakdown& each : breakdowns) {
    for (const double minutes : each.minutes) {
      rows += fmt::format("{},{}\n", minutes, each.kilovolt);
      ++count;
    }
  }
  ASSERT_EQ(count, 76);
  write("fluid.csv", rows);
  // Over the logarithm of the scale at 33 kV, where the tests lie, the exponent, and the logarithm of the shape; minutes.
  constexpr int scales = 241, others = 61;
  KnownShare known;
  const double middle = std::log(33.0 / 20);
  for (int b = 0; b < others; ++b) {
    const double log_beta = std::log(0.5) + b * std::log(1.2 / 0.5) / (others - 1);
    const double beta = std::exp(log_beta);
    for (int e = 0; e < others; ++e) {
      const double n = 10 + 16.0 * e / (others - 1);
      double logs = 0, powers = 0;  // at a scale of 1 min at 33 kV
      for (const Breakdown& each : breakdowns) {
        const double scale = std::pow(each.kilovolt / 33, -n);
        for (const double minutes : each.minutes) {
          logs += std::log(minutes / scale) * beta - std::log(minutes);
          powers += std::pow(minutes / scale, beta);
        }
      }
      KnownShare::Line line;
      for (int s = 0; s < scales; ++s) {
        const double log_scale = std::log(4.0) + s * std::log(100.0 / 4) / (scales - 1);
        const double log_eta = log_scale + n * middle;
        const double log_f = count * log_beta + logs - count * beta * log_scale -
                             powers * std::exp(-beta * log_scale) +
                             normal_log_density(log_eta, std::log(2000.0 * 60), 2) +
                             normal_log_density(n, 15, 5) + normal_log_density(log_beta, 0, 0.5);
        line.weight.push_back(std::exp(log_f + 299));  // about its maximum
        line.share.push_back(-std::expm1(-std::pow(100 * 60 / std::exp(log_eta), beta)));
      }
      known.add(std::move(line));
    }
  }
  const PosteriorSummary result = run(fluid);
  const QuantityQuantiles& survival = found(result, "survival to 100 h");
  EXPECT_NEAR(failed(*survival.predictive) / known.mean(), 1, 2e-4);
  expect_quantile(known, survival.q50, 0.5, 1e-3);
  expect_quantile(known, survival.q05, 0.05, 1e-3);
  expect_quantile(known, survival.q95, 0.95, 1e-3);
  // What is averaged over all that is unknown is more than the median.
  EXPECT_GT(known.mean(), 1.1 * failed(survival.q50));
  const prognosis::UnitLife life = ask(fluid, result, {.survived = "100 h"});
  EXPECT_NEAR(*life.passed / known.mean(), 1, 2e-4);
}

// Cracks in tubes of heat exchangers of three plants, of 100 tubes each, found in yearly inspections (Nelson 1982; Meeker and
// Escobar 1998, example 1.5 and figure 1.7): 4 of 300 in the first year, 5 of 197 in the second, 2 of 97 in the third.
const char* const tubes = R"toml(
model = "formula"
[data]
file = "tubes.csv"
[data.columns]
lower = { column = "after", unit = "year" }
upper = { column = "until", unit = "year" }
count = "count"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[predict]
survival_to = "4 year"
[prior]
)toml";
const char* const tube_rows = "after,until,count\n,1,4\n1,2,5\n2,3,2\n1,,99\n2,,95\n3,,95\n";

double log_likelihood_of_tubes(double eta, double beta) {
  std::array<double, 4> survival{};
  for (int year = 0; year < 4; ++year) survival[year] = std::exp(-std::pow(year / eta, beta));
  return 4 * std::log(1 - survival[1]) + 5 * std::log(survival[1] - survival[2]) +
         2 * std::log(survival[2] - survival[3]) + 99 * std::log(survival[1]) +
         95 * std::log(survival[2]) + 95 * std::log(survival[3]);
}

TEST_F(PublishedPredictions, HeatExchangerTubes) {
  write("tubes.csv", tube_rows);
  KnownShare known;
  constexpr int scales = 2401, shapes = 401;
  for (int b = 0; b < shapes; ++b) {
    const double log_beta = std::log(0.3) + b * std::log(5 / 0.3) / (shapes - 1);
    const double beta = std::exp(log_beta);
    KnownShare::Line line;
    for (int s = 0; s < scales; ++s) {
      const double log_eta = std::log(2.0) + s * std::log(1e5 / 2) / (scales - 1);
      const double eta = std::exp(log_eta);
      line.weight.push_back(std::exp(log_likelihood_of_tubes(eta, beta) + 60 +
                                     normal_log_density(log_eta, std::log(10.0), 1.5) +
                                     normal_log_density(log_beta, std::log(1.5), 0.5)));
      line.share.push_back(-std::expm1(-std::pow(4 / eta, beta)));
    }
    known.add(std::move(line));
  }
  const std::string study =
      tubes + std::string(
                  "eta = { distribution = \"lognormal\", median = \"10 year\", log_sd = 1.5 }\n"
                  "beta = { distribution = \"lognormal\", median = 1.5, log_sd = 0.5 }\n");
  const PosteriorSummary result = run(study);
  const QuantityQuantiles& survival = found(result, "survival to 4 year");
  EXPECT_NEAR(failed(*survival.predictive) / known.mean(), 1, 2e-4);
  expect_quantile(known, survival.q50, 0.5, 1e-3);
  expect_quantile(known, survival.q05, 0.05, 1e-3);
  expect_quantile(known, survival.q95, 0.95, 1e-3);
  EXPECT_GT(known.mean(), failed(survival.q50));
  const prognosis::UnitLife life = ask(study, result, {.survived = "4 year"});
  EXPECT_NEAR(*life.passed / known.mean(), 1, 2e-4);
}

// BIC takes the logarithm of how many tubes there are, not of how many rows.
TEST_F(PublishedPredictions, InformationCriteriaCountTubes) {
  write("tubes.csv", tube_rows);
  const PosteriorSummary result =
      run(tubes + std::string("eta = { distribution = \"flat\", unit = \"year\" }\n"
                              "beta = { distribution = \"flat\" }\n"));
  ASSERT_TRUE(result.mode && result.mode->problem.empty());
  const double eta = result.mode->parameters[0].value, beta = result.mode->parameters[1].value;
  const double highest = log_likelihood_of_tubes(eta, beta);
  for (const double factor : {0.98, 1.02}) {
    EXPECT_LT(log_likelihood_of_tubes(factor * eta, beta), highest);
    EXPECT_LT(log_likelihood_of_tubes(eta, factor * beta), highest);
  }
  EXPECT_NEAR(result.mode->log_likelihood, highest, 1e-6);
  EXPECT_EQ(result.mode->observations, 300);
  EXPECT_NEAR(result.mode->aic, -2 * highest + 4, 1e-5);
  EXPECT_NEAR(result.mode->bic, -2 * highest + 2 * std::log(300.0), 1e-5);
}

// Thousands of miles at which locomotive controls failed; 59 others had run 135 (Nelson 1982, Applied Life Data Analysis; Lawless 2003).
const std::vector<double> controls = {
    22.5,  37.5,  46.0,  48.5,  51.5,  53.0,  54.5,  57.5,  66.5,  68.0,  69.5,  76.5,  77.0,
    78.5,  80.0,  81.5,  82.0,  83.0,  84.0,  91.5,  93.5,  102.5, 107.0, 108.5, 112.5, 113.5,
    116.0, 117.0, 118.5, 119.0, 120.0, 122.5, 123.0, 127.5, 131.0, 132.5, 134.0};

double powers_of_controls(double beta) {
  double sum = 59 * std::pow(135, beta);
  for (const double each : controls) sum += std::pow(each, beta);
  return sum;
}
double log_likelihood_of_controls(double eta, double beta) {
  double logs = 0;
  for (const double each : controls) logs += std::log(each);
  return 37 * (std::log(beta) - beta * std::log(eta)) + (beta - 1) * logs -
         powers_of_controls(beta) * std::pow(eta, -beta);
}
// Highest over eta, which is known then.
double profile_of_shape(double beta) {
  return log_likelihood_of_controls(std::pow(powers_of_controls(beta) / 37, 1 / beta), beta);
}

double root(const std::function<double(double)>& f, double low, double high) {
  const bool rising = f(high) > 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0) == rising ? high : low) = middle;
  }
  return low;
}
double highest(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 300; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (f(a) < f(b) ? low : high) = f(a) < f(b) ? a : b;
  }
  return 0.5 * (low + high);
}

TEST_F(PublishedPredictions, LocomotiveControlsUnderFlatPriors) {
  ASSERT_EQ(controls.size(), 37u);
  std::string rows = "miles [km],status,count\n";
  for (const double each : controls) rows += fmt::format("{},failure,1\n", each);
  write("controls.csv", rows + "135,runout,59\n");
  const std::string study = R"toml(
model = "formula"
[data]
file = "controls.csv"
[data.columns]
life = "miles"
status = "status"
count = "count"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[predict]
survival_to = "80 km"
[prior]
eta = { distribution = "flat", unit = "km" }
beta = { distribution = "flat" }
)toml";
  const PosteriorSummary result = run(study);
  ASSERT_TRUE(result.mode && result.mode->maximum_likelihood);
  // Published: 183.9 and 2.33.
  const double shape = highest(profile_of_shape, 0.5, 8);
  const double top = profile_of_shape(shape);
  EXPECT_NEAR(shape, 2.33, 0.01);
  EXPECT_NEAR(result.mode->parameters[1].value, shape, 1e-5 * shape);
  EXPECT_NEAR(result.mode->parameters[0].value, std::pow(powers_of_controls(shape) / 37, 1 / shape),
              2e-3);
  EXPECT_NEAR(result.mode->bic, -2 * top + 2 * std::log(96.0), 1e-5);
  const double far =
      top - 0.5 * 2.705543454095404;  // chi-square's 90 % quantile, one degree of freedom
  const auto& of_shape = *result.mode->parameters[1].profile;
  const auto below_shape = [&](double b) { return profile_of_shape(b) - far; };
  EXPECT_NEAR(of_shape.lower / root(below_shape, 0.5, shape), 1, 1e-4);
  EXPECT_NEAR(of_shape.upper / root(below_shape, shape, 8), 1, 1e-4);
  const auto of_scale = [&](double eta) {
    const auto of = [&](double beta) { return log_likelihood_of_controls(eta, beta); };
    return of(highest(of, 0.3, 10)) - far;
  };
  const double scale = result.mode->parameters[0].value;
  const auto& profile = *result.mode->parameters[0].profile;
  EXPECT_NEAR(profile.lower / root(of_scale, 100, scale), 1, 1e-4);
  EXPECT_NEAR(profile.upper / root(of_scale, scale, 1000), 1, 1e-4);
  // For shapes below 1/37 the likelihood falls too slowly with the scale: no posterior, and no quadrature of one.
  EXPECT_FALSE(result.fit->exact);
  EXPECT_FALSE(result.trusted);
}

}  // namespace
}  // namespace wearwell
