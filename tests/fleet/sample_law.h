#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_command.h"
#include "wearwell/fleet/engine.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/sql_export.h"

namespace wearwell::formula_model {

/// A row of a table that the example's law is put to.
struct LawRow {
  int id = 0;
  std::string machine;
  double force = 0, distance = 0;  ///< N, km; below 0: an empty cell
};

inline const std::vector<LawRow>& formula_rows() {
  static const std::vector<LawRow> rows = {
      {1, "1", 20, 10},  {2, "3", 30, 25.5},       {3, "12", 12, 0.001}, {4, "new'; --", 27, 40},
      {5, "2", 20, 150}, {6, "another", 14.5, 33}, {7, "2", -1, 10},     {8, "5", 20, -1}};
  return rows;
}

/// " (1, '1', 20, 10000), ..." of a table (id, machine, F, s).
inline std::string formula_row_values(const char* quote) {
  std::string text;
  const auto cell = [](double x, double scale) {
    return x < 0 ? std::string("null") : fmt::format("{}", scale * x);
  };
  for (const LawRow& each : formula_rows()) {
    std::string machine = each.machine;
    for (std::size_t at = 0; (at = machine.find('\'', at)) != machine.npos; at += 2)
      machine.replace(at, 1, quote);
    text += fmt::format("{} ({}, '{}', {}, {})", text.empty() ? "" : ",", each.id, machine,
                        cell(each.force, 1), cell(each.distance, 1000));
  }
  return text;
}

/// Expressions with everything that a law may hold, but sums over rows and states.
inline const std::vector<std::string>& formula_values() {
  static const std::vector<std::string> values = {
      "",
      R"(min(wear/(10 [um]), 3) + max(log(wear/(1 [nm])), 0.5) * tanh(wear/(50 [um]))^2 + sqrt(wear/(7 [um])))",
      R"(where(force > 25 [N] and not (machine == "3"), expm1(wear/(100 [um])), log1p(wear/(100 [um])))
           + (wear/(10 [um]))^(k/(2e-6 [mm^3/(N m)])) + expm1(wear/(1 [km])) + log1p(wear/(1e6 [km])))",
      R"(abs(sin(wear/(10 [um]) * 1 [rad])) + atan(wear/(3 [um]))/(1 [rad]) + log10(wear/(1 [nm])) - cos(1 [rad])
           + (machine == "2") + exp(-wear/(20 [um])) + (wear/sigma)^-2 + (force <= 20 [N] or machine != "1"))"};
  return values;
}

/// The state of the example's fit without its predictions, made in `folder`.
inline prognosis::CarriedState formula_state(const std::filesystem::path& folder) {
  const std::string example = PROJECT_SOURCE_DIR "/examples/formula/";
  std::ifstream in(example + "study.toml");
  std::stringstream text;
  text << in.rdbuf();
  std::filesystem::copy_file(example + "wear.csv", folder / "wear.csv");
  std::ofstream(folder / "formula.toml") << text.str().substr(0, text.str().find("[predict]"));
  const CommandResult fit = run_wearwell("fit '" + (folder / "formula.toml").string() +
                                         "' --quiet -o '" + (folder / "formula").string() + "'");
  EXPECT_EQ(fit.exit_code, 0) << fit.err;
  return prognosis::read_state(folder / "formula");
}

/// Puts each of `values` to the engine's table, which has formula_rows() as id, machine, F (N), s (m), and holds the answers
/// against the library's own numbers at the same draws.
inline void expect_library(const prognosis::CarriedState& state, fleet::Engine& engine,
                           const std::string& table, const std::vector<std::string>& values) {
  const TomlReader root = TomlReader::parse(state.source.study);
  const std::shared_ptr<const FormulaModel> model = read_formula_model(root, state.source);
  for (const std::string& value : values) {
    const SqlExport made = sql_export(state, {.dialect = engine.dialect(),
                                              .table = table,
                                              .columns = {"distance=s:m"},
                                              .keep = {"id"},
                                              .value = value,
                                              .draws = 40});
    engine.begin();
    engine.run(made.setup, {}, "", 0);
    engine.run(made.setup, {}, "", 0);  // again: nothing changes
    const NodeProgram program(*model, {made.wanted});
    NodeProgram::Scratch scratch(program);
    std::size_t found = 0;
    engine.rows(
        "select id * 1e0, formula_known * 1e0, formula_q05, formula_q50, formula_q95 from (\n" +
            made.query + "\n) as a",
        0, [&](const fleet::Row& row) {
          const auto at =
              std::find_if(formula_rows().begin(), formula_rows().end(),
                           [&](const LawRow& each) { return each.id == row.numbers[0]; });
          ASSERT_NE(at, formula_rows().end());
          ++found;
          auto unit = std::find(made.units.begin(), made.units.end(), at->machine);
          EXPECT_EQ(row.numbers[1], unit != made.units.end());
          if (unit == made.units.end()) unit = made.units.begin();
          if (at->force < 0 || at->distance < 0) {
            for (std::size_t q = 2; q < 5; ++q) EXPECT_TRUE(std::isnan(row.numbers[q]));
            return;
          }
          NodeRow conditions{std::vector<double>(model->row_symbols.columns.size()), {}};
          for (std::size_t c = 0; c < conditions.numbers.size(); ++c) {
            const std::string& name = model->row_symbols.columns[c].name;
            conditions.numbers[c] = name == "force"      ? at->force
                                    : name == "distance" ? 1000 * at->distance
                                                         : 0;
          }
          for (const formula::LabelSymbol& label : model->row_symbols.labels)
            conditions.labels.push_back(
                static_cast<int>(std::find(label.levels.begin(), label.levels.end(), at->machine) -
                                 label.levels.begin()));
          const Nodes& draws = made.draws[static_cast<std::size_t>(unit - made.units.begin())];
          program.evaluate(draws, 0, draws.count(), conditions, nullptr, {}, scratch);
          const auto all = program.values(0, scratch);
          std::vector<double> sorted(all.begin(), all.begin() + 40);
          std::sort(sorted.begin(), sorted.end());
          const double scale = value.empty() ? 1e-6 : 1;  // um
          const double p[] = {0.05, 0.5, 0.95};
          for (std::size_t q = 0; q < 3; ++q) {
            const double expected = quantile_of_draws(sorted, p[q]) / scale;
            EXPECT_NEAR(row.numbers[2 + q] / expected, 1, 1e-9)
                << value << " row " << at->id << ": " << row.numbers[2 + q];
          }
        });
    EXPECT_EQ(found, formula_rows().size());
    engine.commit();
  }
}

}  // namespace wearwell::formula_model
