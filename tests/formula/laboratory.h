#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/formula/program.h"

namespace wearwell::formula {

/// Symbols, three rows of data and values of parameters for expressions under test.
struct Laboratory {
  Symbols symbols;
  std::vector<std::vector<double>> columns;
  std::vector<std::vector<int>> labels;
  std::vector<std::vector<double>> by_row;  ///< of parameters by row
  std::vector<double> parameters;
  std::vector<std::size_t> paths = {0};
  std::vector<Line> lines = {};

  Laboratory() {
    const auto powers = [](const char* unit) { return read_any_unit(unit).powers; };
    add_column("x", "1", {1.5, 2, 3.25});
    add_column("y", "1", {-0.5, 0.75, 4});
    add_column("force", "N", {10, 20, 30});
    add_column("distance", "m", {1, 2, 4});
    add_column("n", "cycle", {100, 200, 400});
    add_column("phi", "rad", {0.1, 0.2, 0.3});
    add_column("T", "K", {300, 350, 400});
    symbols.columns.push_back({"depth", powers("m"), true});
    columns.push_back({1e-6, 2e-6, 4e-6});
    symbols.labels = {{"material", {"PTFE", "PEEK"}}, {"machine", {"1", "2", "3"}}};
    labels = {{0, 1, 0}, {2, 1, 0}};
    add_parameter("a", "1", {0.7});
    add_parameter("b", "1", {1.9});
    add_parameter("c", "1", {-0.3});
    add_parameter("k", "mm^3/(N m)", {1e-12});
    add_parameter("h0", "um", {5e-6});
    symbols.parameters.push_back({"q", {}, Scope::per_level, "material"});
    parameters.insert(parameters.end(), {2.5, -1.5});
    symbols.parameters.push_back({"u", {}, Scope::per_row});
    by_row = {{0.5, 0.25, -0.75}};
    symbols.constants = {{"area", powers("m^2"), 50e-6}, {"R", powers("J/(mol K)"), 8.314}};
  }

  void add_column(const char* name, const char* unit, std::vector<double> values) {
    symbols.columns.push_back({name, read_any_unit(unit).powers});
    columns.push_back(std::move(values));
  }
  void add_parameter(const char* name, const char* unit, const std::vector<double>& values) {
    symbols.parameters.push_back({name, read_any_unit(unit).powers});
    parameters.insert(parameters.end(), values.begin(), values.end());
  }

  Rows rows() const {
    Rows all;
    all.count = columns.front().size();
    for (const auto& column : columns) all.columns.emplace_back(column);
    for (const auto& label : labels) all.labels.emplace_back(label);
    all.paths = paths;
    return all;
  }

  Program program(const std::vector<std::string>& texts) const {
    std::vector<Wanted> wanted;
    for (std::size_t i = 0; i < texts.size(); ++i)
      wanted.push_back({"output " + std::to_string(i + 1), texts[i]});
    return compile(lines, wanted, symbols);
  }

  std::vector<const double*> pointers() const {
    std::vector<const double*> all;
    for (const auto& each : by_row) all.push_back(each.data());
    return all;
  }

  /// The values of an expression, one for each row also where it is uniform.
  std::vector<double> values(const std::string& text) const {
    const Program made = program({text});
    const Data data = made.bind(rows());
    Workspace work = made.workspace(rows().count);
    const auto at = pointers();
    made.forward(data, 0, rows().count, {parameters, at}, work);
    const auto found = work.values(0);
    if (found.size() == 1) return std::vector<double>(rows().count, found[0]);
    return {found.begin(), found.end()};
  }
  double value(const std::string& text) const { return values(text)[0]; }

  struct Slopes {
    std::vector<double> parameters;
    std::vector<std::vector<double>> by_row;
  };

  /// The derivatives of the sum over rows of weight[row] * output.
  Slopes slopes(const std::string& text, const std::vector<double>& weight) const {
    const Program made = program({text});
    const Data data = made.bind(rows());
    Workspace work = made.workspace(rows().count);
    const auto at = pointers();
    made.forward(data, 0, rows().count, {parameters, at}, work);
    const auto adjoints = work.adjoints(0);
    if (adjoints.size() == 1) {
      adjoints[0] = 0;
      for (const double each : weight) adjoints[0] += each;
    } else {
      std::copy(weight.begin(), weight.end(), adjoints.begin());
    }
    Slopes found;
    found.parameters.assign(parameters.size(), 0);
    std::vector<double*> to;
    for (const auto& each : by_row) found.by_row.emplace_back(each.size(), 0.0);
    for (auto& each : found.by_row) to.push_back(each.data());
    made.reverse(data, 0, rows().count, {parameters, at}, work, found.parameters, to);
    return found;
  }
};

}  // namespace wearwell::formula
