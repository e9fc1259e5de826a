#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "calibration/formula_design.h"
#include "wearwell/base/rng.h"
#include "wearwell/fleet/engine.h"
#include "wearwell/formula/dimension.h"
#include "wearwell/models/formula_model/sql_export.h"

namespace wearwell::formula_model {

/// A row of a table of pads: of a machine and a material, a temperature in degC (and in degF beside it) and a time in h.
struct PadRow {
  int id = 0;
  std::string machine, material;
  double temperature = 0, time = 0;
};

/// Machines and materials that the study knows, and such as it does not.
inline const std::vector<PadRow>& pad_rows() {
  static const std::vector<PadRow> rows = {
      {1, "m0", "PTFE", 20, 3},  {2, "m1", "steel", -40, 5},    {3, "m2", "PA 6'6", 0, 1},
      {4, "new", "PTFE", 80, 7}, {5, "m1", "glass", 20, 2},     {6, "m2", "PA 6'6", -200, 4},
      {7, "m0", "steel", 31, 6}, {8, "another", "steel", 55, 2}};
  return rows;
}

/// Two effects of each machine, a parameter of each material, and temperatures in degC; its posterior is wide, and not fitted.
inline prognosis::CarriedState pad_state() {
  const std::string study = R"toml(
[data.columns]
depth = { column = "h", unit = "um" }
temperature = { column = "T", unit = "degC" }
time = { column = "t", unit = "h" }
material = "mat"
machine = "machine"
[constants]
T0 = "300 K"
[formula]
wear = "a + k[material] * rate * time * exp(theta * (1 - T0 / temperature))"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma"
[prior]
a = { distribution = "normal", mean = "0.5 um", sd = "1 um" }
rate = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
k = { distribution = "lognormal", median = 1, log_sd = 0.5 }
theta = { distribution = "normal", mean = 2, sd = 1 }
sa = { distribution = "half-normal", scale = "1 um" }
sb = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.machine]
a = { distribution = "normal", sd = "sa" }
rate = { distribution = "lognormal", log_sd = "sb" }
)toml";
  const std::string materials[] = {"steel", "PTFE", "PA 6'6"};
  std::vector<double> depth, temperature, time;
  std::vector<std::string> material, machine;
  for (int u = 0; u < 3; ++u) {
    for (int i = 1; i <= 6; ++i) {
      const int m = (u + i) % 3;
      temperature.push_back(20 + 10 * u);
      time.push_back(i);
      material.push_back(materials[m]);
      machine.push_back("m" + std::to_string(u));
      depth.push_back(0.3 * u + (0.7 + 0.3 * m) * (0.9 + 0.2 * u) * i + 0.1 * (i % 2));
    }
  }
  const FormulaDesign design(study,
                             {numbers("h", depth), numbers("T", temperature), numbers("t", time),
                              texts("mat", material), texts("machine", machine)});
  prognosis::CarriedState state;
  state.model = "formula";
  state.source = design.source;
  Rng rng(21, 0);
  const auto count = static_cast<Eigen::Index>(design.model->parameters.size());
  state.posterior.values.resize(400, count);
  state.posterior.weights = Eigen::VectorXd::Constant(400, 1.0 / 400);
  for (Eigen::Index p = 0; p < count; ++p) {
    const std::string& name = design.model->parameters[static_cast<std::size_t>(p)].name;
    state.parameters.push_back(name);
    const double middle = name == "a" || name == "sa" || name == "sigma" ? 0.4e-6
                          : name == "rate"                               ? 1e-6 / 3600
                          : name == "sb"                                 ? 0.3
                                                                         : 1 + 0.3 * double(p);
    for (Eigen::Index i = 0; i < 400; ++i)
      state.posterior.values(i, p) = middle * std::exp(0.15 * rng.normal());
  }
  return state;
}

/// What is asked of the pads: each is a value, a unit for it, and whether temperatures are read in degF.
struct PadValue {
  std::string value, unit;
  bool fahrenheit = false;
};
inline const std::vector<PadValue>& pad_values() {
  static const std::vector<PadValue> values = {
      {"", ""},
      {"", "", true},
      {"temperature + 5 [K] * k[material]", "degC"},
      {"temperature + 5 [K] * k[material]", "degF", true},
      {"a + k[\"steel\"] * rate * time * (material == \"PTFE\")", "nm"},
      {"where(temperature > T0, k[material] / k[\"PTFE\"], rate / (1 [um/h])) + sigma / sa", ""}};
  return values;
}

/// Puts each value to the engine's table, pad_rows() as id, machine, mat, T (degC), TF (degF), hours, and holds the answers
/// against the library's own numbers at the same draws.
inline void expect_pads(fleet::Engine& engine, const std::string& table) {
  const prognosis::CarriedState state = pad_state();
  const TomlReader root = TomlReader::parse(state.source.study);
  const std::shared_ptr<const FormulaModel> model = read_formula_model(root, state.source);
  for (const PadValue& asked : pad_values()) {
    SqlExportChoice choice;
    choice.dialect = engine.dialect();
    choice.table = table;
    if (asked.value.empty() || asked.value.find("time") != std::string::npos)
      choice.columns = {"time=hours:h"};
    if (asked.fahrenheit) choice.columns.push_back("temperature=TF:degF");
    choice.keep = {"id"};
    choice.value = asked.value;
    choice.unit = asked.unit;
    choice.draws = 60;
    const SqlExport made = sql_export(state, choice);
    ASSERT_EQ(made.units.size(), 4u);
    engine.begin();
    engine.run(made.setup, {}, "", 0);
    const NodeProgram program(*model, {made.wanted});
    NodeProgram::Scratch scratch(program);
    const Unit unit = formula::read_any_unit(made.unit).unit;
    std::size_t found = 0;
    engine.rows(
        "select id * 1e0, formula_known * 1e0, formula_q05, formula_q50, formula_q95 from (\n" +
            made.query + "\n) as a",
        0, [&](const fleet::Row& row) {
          const PadRow& at = pad_rows().at(static_cast<std::size_t>(row.numbers[0]) - 1);
          ++found;
          auto known = std::find(made.units.begin(), made.units.end(), at.machine);
          EXPECT_EQ(row.numbers[1], known != made.units.end());
          if (known == made.units.end()) known = made.units.begin();
          NodeRow conditions;
          for (const auto& column : model->row_symbols.columns)
            conditions.numbers.push_back(column.name == "temperature" ? at.temperature + 273.15
                                         : column.name == "time"      ? 3600 * at.time
                                                                      : 0);
          bool whole = true;
          for (const formula::LabelSymbol& label : model->row_symbols.labels) {
            const std::string& text = label.name == "material" ? at.material : at.machine;
            const auto level = std::find(label.levels.begin(), label.levels.end(), text);
            whole = whole && (label.name == "machine" || level != label.levels.end());
            conditions.labels.push_back(static_cast<int>(level - label.levels.begin()));
          }
          const Nodes& draws = made.draws[static_cast<std::size_t>(known - made.units.begin())];
          std::vector<double> sorted;
          if (whole) {
            program.evaluate(draws, 0, draws.count(), conditions, nullptr, {}, scratch);
            const auto all = program.values(0, scratch);
            sorted.assign(all.begin(), all.begin() + 60);
            std::sort(sorted.begin(), sorted.end());
            for (const double x : sorted) whole = whole && std::isfinite(x);
          }
          const double p[] = {0.05, 0.5, 0.95};
          for (std::size_t q = 0; q < 3; ++q) {
            const double answer = row.numbers[2 + q];
            if (!whole) {
              EXPECT_TRUE(std::isnan(answer)) << asked.value << " row " << at.id << ": " << answer;
              continue;
            }
            const double si = quantile_of_draws(sorted, p[q]);
            const double expected = (si - unit.offset) / unit.scale;
            // Of temperatures what counts is the absolute one.
            EXPECT_NEAR(answer, expected, 1e-9 * std::abs(si / unit.scale))
                << asked.value << " row " << at.id;
          }
        });
    EXPECT_EQ(found, pad_rows().size());
    engine.commit();
  }
}

/// "(1, 'm0', 'PTFE', 20, 68, 3), ..." of the table, with a quote in a text written as `quote`.
inline std::string pad_row_values(const std::string& quote) {
  std::string text;
  const auto word = [&](std::string from) {
    for (std::size_t at = 0; (at = from.find('\'', at)) != from.npos; at += quote.size())
      from.replace(at, 1, quote);
    return "'" + from + "'";
  };
  for (const PadRow& each : pad_rows())
    text += fmt::format("{} ({}, {}, {}, {}, {}, {})", text.empty() ? "" : ",", each.id,
                        word(each.machine), word(each.material), each.temperature,
                        32 + 1.8 * each.temperature, each.time);
  return text;
}

}  // namespace wearwell::formula_model
