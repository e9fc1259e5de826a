#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/present/html.h"

namespace wearwell {

/// What a report draws beyond the numbers of the summary, in the units of the report.

struct Curve {
  std::vector<double> x, y;
};

/// Density of the draws of each chain between edges: density[c][i] from edges[i] to edges[i + 1].
struct Histogram {
  std::vector<double> edges;
  std::vector<std::vector<double>> density;
};

struct ParameterPlots {
  Histogram histogram;
  std::optional<Curve> exact;  ///< marginal posterior density
  Curve prior;  ///< density; of an improper prior with area one over the curve's range
};

/// The exact density of two parameters at the centres of cells, relative to its largest value:
/// density[i * y.size() + j] at (x[i], y[j]).
struct DensityGrid {
  std::vector<double> x, y, density;
};

/// The mean and one measurement along the history of the component.
struct History {
  std::vector<double> at, mean, ci05, ci95, pi05, pi95;
};

struct DataFile {
  std::string name, sha1;
};

struct Plots {
  std::string unit;     ///< its unit
  std::string at_name;  ///< against what, "cycles"
  std::vector<ParameterPlots> parameters;
  std::optional<DensityGrid> joint;  ///< of the first two parameters
  std::vector<Curve> stages;         ///< density of the first parameter after 1, 2, ... data sets
  History history;
  /// The next three are of the data sets that are drawn: all, or some hundreds evenly among them.
  std::vector<double> history_at;  ///< where each data set lies along it
  History replicated;              ///< each data set as the final posterior would predict it
  std::vector<double> measured;    ///< those data sets
  std::string history_note;        ///< what to know of it
  std::optional<Curve> life;       ///< probability that the limit is reached by then
  std::optional<double> limit;     ///< in `unit`
  std::string study_text;          ///< the study file
  std::vector<DataFile> files;
  double seconds = 0;  ///< that the study took
  /// What the trade shows beyond that, by section: "predictions", "parameters" or "fit".
  std::map<std::string, std::vector<html::Figure>> figures;
};

}  // namespace wearwell
