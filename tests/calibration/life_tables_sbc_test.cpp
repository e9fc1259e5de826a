// Simulation-based calibration (Talts et al. 2018) of lives whose tables change with them: step-stress tests, and returns by month of sale
// and failure mode. Each replication writes a table and reads it as a study. WEARWELL_REPLICATIONS says how many.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "calibration/formula_design.h"
#include "calibration/places_of_truth.h"
#include "calibration/shares.h"
#include "wearwell/base/rng.h"

namespace wearwell::formula_model {
namespace {

constexpr int bins = 10;
constexpr std::uint64_t seed = 20261127;
constexpr double hour = 3600, month = 2629746;  // s

// The table of parameters in the order of the priors, SI.
using MakeTable = std::vector<Column> (*)(const std::vector<double>& x, Rng& rng);

void calibrate(const std::string& name, const std::string& study, const std::vector<double>& any,
               MakeTable make, int otherwise) {
  Rng first(seed, 1u << 30);
  const FormulaDesign design(study, make(any, first));
  std::vector<std::vector<double>> all(static_cast<std::size_t>(replications(otherwise)));
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    Rng rng(seed, i);
    const std::vector<double> x = design.from_priors(rng);
    const FormulaDesign one(study, make(x, rng));
    const auto rows = std::make_shared<const FormulaRows>(one.model, one.model->data.table.rows);
    all[i] = places_of_study(x, rows, i);
  });
  expect_even(name, design.model->parameters, all, bins);
}

double weibull(double scale, double shape, Rng& rng) {
  return scale * std::pow(-std::log(rng.uniform()), 1 / shape);
}

// Ages at which a specimen has used up an exposure, with the steps before; hours.
struct Steps {
  std::vector<std::string> specimen, status;
  std::vector<double> age, voltage;

  void add(std::size_t number, double exposure, const std::vector<double>& x) {
    constexpr double apart = 20, last = 100;
    double used = 0;
    for (double begin = 0, kilovolts = 10; begin < last; begin += apart, kilovolts += 2) {
      const double scale = x[0] / hour * std::pow(kilovolts / 10, -x[1]);
      const bool fails = used + apart / scale >= exposure;
      specimen.push_back(fmt::format("s{}", number));
      age.push_back(fails ? begin + (exposure - used) * scale : begin + apart);
      voltage.push_back(kilovolts);
      status.emplace_back(fails ? "failed" : "survived");
      if (fails) break;
      used += apart / scale;
    }
  }
  std::vector<Column> columns() const {
    return {texts("specimen", specimen), numbers("life", age), numbers("voltage", voltage),
            texts("status", status)};
  }
};

constexpr const char* steps_study = R"toml(
[data.columns]
specimen = "specimen"
life = {{ column = "life", unit = "h" }}
voltage = {{ column = "voltage", unit = "kV" }}
status = "status"
[constants]
reference = "10 kV"
[likelihood.life]
family = "{}"
{} = "life_10 * inverse_power(voltage, reference, n)"
{} = "s"
steps = "specimen"
[prior]
life_10 = {{ distribution = "lognormal", median = "150 h", log_sd = 0.5 }}
n = {{ distribution = "normal", mean = 4, sd = 1 }}
s = {{ distribution = "lognormal", median = {}, log_sd = 0.4 }}
)toml";

constexpr std::size_t specimens = 15;

// Fifteen specimens, of which the voltage rises by 2 kV every 20 h for 100 h.
TEST(LifeTablesCalibration, StepStressOfWeibullLives) {
  calibrate(
      "step-stress test, Weibull", fmt::format(steps_study, "weibull", "scale", "shape", 2),
      {150 * hour, 4, 2},
      [](const std::vector<double>& x, Rng& rng) {
        Steps steps;
        for (std::size_t i = 0; i < specimens; ++i) steps.add(i, weibull(1, x[2], rng), x);
        return steps.columns();
      },
      200);
}

TEST(LifeTablesCalibration, StepStressOfLognormalLives) {
  calibrate(
      "step-stress test, lognormal", fmt::format(steps_study, "lognormal", "median", "log_sd", 0.6),
      {150 * hour, 4, 0.6},
      [](const std::vector<double>& x, Rng& rng) {
        Steps steps;
        for (std::size_t i = 0; i < specimens; ++i) steps.add(i, std::exp(x[2] * rng.normal()), x);
        return steps.columns();
      },
      200);
}

// Units sold in the middle of one of two months, with returns to the fifth; of a quarter of the returns the mode is not known.
std::vector<Column> returns_by_mode(const std::vector<double>& x, Rng& rng) {
  constexpr std::size_t sales = 2, months = 5, modes = 3;
  constexpr int sold = 25;
  static const std::string names[modes] = {"a", "b", ""};
  std::vector<double> sale_of, sold_of;
  std::vector<std::string> mode_of;
  std::vector<std::vector<double>> returned(months, std::vector<double>(sales * modes));
  for (std::size_t sale = 0; sale < sales; ++sale) {
    for (std::size_t mode = 0; mode < modes; ++mode) {
      sale_of.push_back(static_cast<double>(sale + 1));
      sold_of.push_back(sold);
      mode_of.push_back(names[mode]);
    }
    for (int unit = 0; unit < sold; ++unit) {
      const double a = weibull(x[0] / month, x[2], rng), b = weibull(x[1] / month, x[2], rng);
      const auto at = static_cast<double>(sale) + std::floor(std::min(a, b) + 0.5);
      const std::size_t mode = rng.uniform() < 0.25 ? 2 : a < b ? 0 : 1;
      if (at < months) ++returned[static_cast<std::size_t>(at)][sale * modes + mode];
    }
  }
  std::vector<Column> columns = {numbers("sold", sale_of), numbers("units", sold_of),
                                 texts("mode", mode_of)};
  for (std::size_t i = 0; i < months; ++i)
    columns.push_back(numbers(fmt::format("{}", i + 1), returned[i]));
  return columns;
}

TEST(LifeTablesCalibration, ReturnsByFailureMode) {
  calibrate("returns by failure mode", R"toml(
[data.returns]
sold = "sold"
quantity = "units"
mode = "mode"
period = "month"
[failure_modes]
column = "mode"
[likelihood.life]
family = "weibull"
scale = "eta[mode]"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "8 month", log_sd = 0.4 }
beta = { distribution = "lognormal", median = 1.3, log_sd = 0.3 }
)toml",
            {8 * month, 8 * month, 1.3}, returns_by_mode, 100);
}

}  // namespace
}  // namespace wearwell::formula_model
