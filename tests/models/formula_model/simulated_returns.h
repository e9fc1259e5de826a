#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "calibration/formula_design.h"
#include "wearwell/models/formula_model/returns_report.h"

namespace wearwell::formula_model {

/// A triangle whose parameters are drawn from the priors of its study, and what its forecast says of
/// the months that are held out.
struct SimulatedReturns {
  static constexpr int sales = 12, held_out = 6, months = sales + held_out;

  /// Whether the 90 % intervals hold the returns of the first held-out month, and of all.
  bool first = false, all = false;
  double expected = 0, returned = 0;  ///< in all

  double place[2] = {};  ///< of the true scale and shape in the posterior, 0 to 1

  /// `few` units a month, and as many for `later` months of sale that are held out; `delayed`: a unit starts after a delay of
  /// mean 1 month, and its failure is reported after one that is 0.25 or 3 months.
  SimulatedReturns(double few, int later, std::uint64_t stream, bool delayed = false) {
    Rng rng(20261128, stream);
    const double shape = std::exp(std::log(1.3) + 0.3 * rng.normal()),
                 scale = std::exp(std::log(60.0) + 0.4 * rng.normal());
    Table table = heading();
    for (int sale = 1; sale <= sales + later; ++sale) {
      const double sold = std::round(few * rng.uniform(0.7, 1.3));
      std::vector<double> returns(months + 1);
      for (int unit = 0; unit < sold; ++unit) {
        const double life = scale * std::pow(-std::log(rng.uniform()), 1 / shape);
        const double late = delayed ? delay(rng) : 0;
        const double at = sale + std::floor(late + life + 0.5);  // sold in the middle of the month
        if (at <= months) ++returns[static_cast<std::size_t>(at)];
      }
      add(table, sale, sold, returns);
    }
    judge({{"study.toml", study(delayed)}, {{"d.csv", table}, {"delays.csv", delays()}}},
          {scale * month, shape});
  }

 private:
  static constexpr double month = 2629746;  // s

  static double delay(Rng& rng) {
    const double to_use = -0.5 * std::log(rng.uniform()) - 0.5 * std::log(rng.uniform());
    return to_use + (rng.uniform() < 0.8 ? 0.25 : 3);
  }

  static Table delays() {
    Table table;
    table.source = "delays.csv";
    table.rows = 2;
    table.columns = {numbers("months", {0.25, 3}), numbers("share", {0.8, 0.2})};
    return table;
  }

  static std::string study(bool delayed) {
    return fmt::format(R"(model = "formula"
[data]
file = "d.csv"
[data.returns]
sold = "sold"
quantity = "units"
period = "month"
{}hold_out = "{} month"
[likelihood.life]
family = "weibull"
scale = "scale"
shape = "shape"
[prior]
shape = {{ distribution = "lognormal", median = 1.3, log_sd = 0.3 }}
scale = {{ distribution = "lognormal", median = "60 month", log_sd = 0.4 }}
)",
                       delayed ? "delay_to_use = { distribution = \"gamma\", shape = 2, scale = "
                                 "\"0.5 month\" }\ndelay_of_report = { file = \"delays.csv\", "
                                 "delay = { column = \"months\", unit = \"month\" }, share = "
                                 "\"share\" }\n"
                               : "",
                       static_cast<int>(held_out));
  }

  static Table heading() {
    Table table;
    table.source = "d.csv";
    table.columns = {numbers("sold", {}), numbers("units", {})};
    for (int month = 1; month <= months; ++month)
      table.columns.push_back(numbers(fmt::format("{}", month), {}));
    return table;
  }

  static void add(Table& table, int sale, double sold, const std::vector<double>& returns) {
    ++table.rows;
    table.columns[0].numbers.push_back(sale);
    table.columns[1].numbers.push_back(sold);
    for (int month = 1; month <= months; ++month)
      table.columns[static_cast<std::size_t>(month) + 1].numbers.push_back(
          returns[static_cast<std::size_t>(month)]);
  }

  void judge(const Source& source, const std::vector<double>& truth) {
    const TomlReader root = TomlReader::parse(source.study);
    const std::shared_ptr<const FormulaModel> model = read_formula_model(root, source);
    const auto rows = std::make_shared<const FormulaRows>(model, model->data.table.rows);
    constexpr double tolerance = 3e-3;
    const ExactPosterior posterior = exact_posterior(rows, tolerance);
    for (std::size_t p = 0; p < 2; ++p) {
      const bool is_scale = model->parameters[p].name == "scale";
      place[is_scale ? 0 : 1] = QuantityDistribution(posterior.nodes, [p](const double* x) {
                                  return x[p];
                                }).cdf(truth[is_scale ? 0 : 1]);
    }
    const ReturnsResult result =
        returns_result(read_asked_returns(root, source, model), posterior.nodes);
    for (const ReturnsPeriod& each : result.forecast) returned += *each.observed;
    const ReturnsPeriod& next = result.forecast.front();
    first = *next.observed >= next.number.count_low && *next.observed <= next.number.count_high;
    const ReturnsCount& until = result.forecast.back().until;
    expected = until.expected;
    all = returned >= until.count_low && returned <= until.count_high;
  }
};

}  // namespace wearwell::formula_model
