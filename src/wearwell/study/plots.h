#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/present/html.h"

namespace wearwell {

/// The plot data of a report, in its units, beyond the numbers of the summary.

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
  Curve prior;                 ///< density; an improper prior has area one over the curve's range
};

/// The exact density of two parameters at the centers of cells, relative to its largest value:
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
  std::string at_name;  ///< the axis, "cycles"
  std::vector<ParameterPlots> parameters;
  std::optional<DensityGrid> joint;  ///< of the first two parameters
  std::vector<Curve> stages;         ///< density of the first parameter after 1, 2, ... data sets
  History history;
  /// The next three describe the plotted data sets: all, or some hundreds, evenly chosen.
  std::vector<double> history_at;  ///< position of each data set along the history
  History replicated;              ///< prediction of each data set by the final posterior
  std::vector<double> measured;    ///< measured values of those data sets
  std::string history_note;        ///< remarks on the history
  std::optional<Curve> life;       ///< probability that the limit is reached
  std::optional<double> limit;     ///< in `unit`
  std::string study_text;          ///< the study file
  std::vector<DataFile> files;
  double seconds = 0;  ///< run time of the study
  /// Additional figures of the model, by section: "predictions", "parameters" or "fit".
  std::map<std::string, std::vector<html::Figure>> figures;
};

}  // namespace wearwell
