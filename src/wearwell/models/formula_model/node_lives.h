#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/formula_lives.h"
#include "wearwell/models/formula_model/node_rows.h"

namespace wearwell::formula_model {

/// Places of nodes on the axis of the formula, if the rate of each has its own change: behind
/// `since` its use counts `factor` times (cumulative exposure, Nelson 1990).
struct NodeAxis {
  std::vector<double> since, factor;  ///< by node; `since` SI

  double at(std::size_t i, double place) const {
    return place <= since[i] ? place : since[i] + factor[i] * (place - since[i]);
  }
  /// The place whose `at` this is.
  double back(std::size_t i, double at) const {
    return at <= since[i] ? at : since[i] + (at - since[i]) / factor[i];
  }
};

/// Levels now and remaining lives of nodes, as weighted points in any order.
struct LivesSample {
  std::vector<double> levels, level_weight, lives, life_weight;
  double left_over = 0, all = 0;  ///< weight below the threshold, and of all

  /// Adds another one with this weight.
  void add(const LivesSample& other, double weight);
  prognosis::Forecast forecast() const;            ///< without `now` and `effective`
  prognosis::ForecastQuantiles quantiles() const;  ///< without `now`
};

/// The quantity with the threshold at one place, as weighted values.
struct LevelSample {
  std::vector<double> value, weight;
  double all = 0, lost = 0;  ///< weight of all, and of what is not a number

  void add(double w, double level);
  void add(const LevelSample& other, double weight);
  prognosis::ForecastBand at(double place) const;
};

/// The quantity with the failure threshold, and the future conditions of units: from predict.limit.
class NodeLives {
 public:
  /// Throws InputError if the study has no threshold along an axis.
  NodeLives(const TomlReader& root, std::shared_ptr<const FormulaModel> model);

  const std::string& name() const { return name_; }
  const Quantity& limit() const { return limit_; }
  bool rising() const { return path_.rising; }
  /// The same with the threshold moved by this, SI.
  NodeLives moved(double by) const {
    NodeLives other = *this;
    other.path_.limit += by;
    return other;
  }
  const std::string& noun() const { return noun_; }
  /// The quantity with the threshold, as expressions; for a process its mean and its spread.
  const std::vector<formula::Wanted>& wanted() const { return wanted_; }

  const Conditions& given() const { return given_; }  ///< description of the future conditions
  double begin() const { return path_.begin; }        ///< start of paths on the axis, SI
  double scale() const { return path_.scale; }        ///< of the axis, SI

  /// Why a reading at this position is invalid, if it lies before the start; `follows`: NodeRows.
  /// If the axis of the study begins below 0 its 0 has no meaning, and a formula with independent
  /// rows is valid a little before.
  std::string before_begin(double place, bool follows) const;

  /// A unit without rows: at the start of paths.
  UnitReading before_rows() const;

  /// Of nodes with weights that sum to 1, whose paths are at `paths` (NodeRows) after their last
  /// row.
  prognosis::Forecast forecast(const Nodes& nodes, const std::vector<double>& weight,
                               const UnitReading& last, const std::vector<NodePath>& paths) const;
  prognosis::ForecastQuantiles quantiles(const Nodes& nodes, const std::vector<double>& weight,
                                         const UnitReading& last,
                                         const std::vector<NodePath>& paths) const;
  /// The same before its quantiles. With an axis, nodes are single ones, not lines.
  LivesSample lives(const Nodes& nodes, const std::vector<double>& weight, const UnitReading& last,
                    const std::vector<NodePath>& paths, const NodeAxis* axis = nullptr) const;
  /// The same for each line separately; `weight` sums to 1 over each line, or is 0 on all of it.
  /// `log_likelihood` is not filled.
  prognosis::InPopulations by_line(const Nodes& nodes, const std::vector<double>& weight,
                                   const UnitReading& last,
                                   const std::vector<NodePath>& paths) const;
  /// Of the same nodes: the quantity with the threshold at these positions, ascending and none
  /// before the last row.
  std::vector<prognosis::ForecastBand> ahead(const Nodes& nodes, const std::vector<double>& weight,
                                             const UnitReading& last,
                                             const std::vector<NodePath>& paths,
                                             std::span<const double> places) const;
  /// The same before its quantiles, by place.
  std::vector<LevelSample> levels_ahead(const Nodes& nodes, const std::vector<double>& weight,
                                        const UnitReading& last, const std::vector<NodePath>& paths,
                                        std::span<const double> places,
                                        const NodeAxis* axis = nullptr) const;

 private:
  struct Ahead;
  NodeRow conditions(const NodeRow& last) const;
  /// `lives`, until the next call of this thread.
  const LivesSample& sample(const Nodes& nodes, const std::vector<double>& weight,
                            const UnitReading& last, const std::vector<NodePath>& paths,
                            const NodeAxis* axis = nullptr) const;
  template <class Sums>
  void look_ahead(const Nodes& nodes, const std::vector<double>& weight, const UnitReading& last,
                  const std::vector<NodePath>& paths, std::size_t points, Sums& sums,
                  const NodeAxis* axis = nullptr) const;
  template <class Sums>
  void pass(Ahead& ahead, std::span<const double> own, const double* start, const NodePath& path,
            std::size_t points, Sums& sums) const;

  std::shared_ptr<const FormulaModel> model_;
  Conditions given_;
  std::string name_, noun_;
  Quantity limit_;
  std::size_t column_ = 0;                // of FormulaModel::measured, if it is a process
  const ProcessForm* process_ = nullptr;  // which has the threshold itself
  std::vector<formula::Wanted> wanted_;
  LimitedPath path_;  // limit, rising, begin, scale
  std::shared_ptr<const NodeProgram> program_;
  std::vector<std::size_t> steps_;  // RunningPath::steps
  double row_length_ = 0;
};

}  // namespace wearwell::formula_model
