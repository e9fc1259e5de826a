#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/models/formula_model/node_lives.h"
#include "wearwell/models/formula_model/unit_nodes.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::formula_model {

/// The parts that all units of one population share: made once, never changed.
struct Tracked {
  std::shared_ptr<const FormulaModel> model;
  ReadingReader reader;
  NodeLives lives;
  NodeRows rows;
  NodePopulation population;
  std::string fingerprint;  ///< of study and posterior: states of others are refused

  Tracked(const TomlReader& root, std::shared_ptr<const FormulaModel> formula_model,
          const WeightedDraws& posterior, std::string print);

  /// Fills `reading`, or returns why it is invalid for every unit.
  std::string problem(const prognosis::Reading& from, UnitReading& reading) const;
};

/// A tracked unit: nodes with their posterior weights. `log_weight` is a sum over readings, so it
/// does not depend on their order, except through the time when nodes were rebuilt.
class TrackedUnit final : public prognosis::TrackedUnit {
 public:
  /// `seen`: the unit's rows in the study, along the axis; empty for a new one.
  TrackedUnit(std::shared_ptr<const Tracked> tracked, std::string unit,
              std::vector<UnitReading> seen);
  /// Throws InputError.
  static std::unique_ptr<TrackedUnit> restore(
      std::shared_ptr<const Tracked> tracked, const std::string& bytes,
      const std::function<std::vector<UnitReading>(const std::string& unit)>& seen);

  prognosis::UpdateResult update(const prognosis::Reading& reading,
                                 const prognosis::History& history) override;
  prognosis::Forecast forecast() const override;
  prognosis::ForecastQuantiles quantiles() const override;
  std::vector<prognosis::PredictiveTails> predictive(
      const prognosis::Reading& reading) const override;
  std::vector<prognosis::ForecastBand> ahead(std::span<const double> places) const override;
  std::optional<prognosis::InPopulations> in_populations(
      const prognosis::History& history) const override;
  void set_restored(double amount) override;
  std::size_t readings() const override { return readings_; }
  std::string save() const override;

  double effective() const { return effective_; }
  std::size_t laid() const { return laid_; }  ///< number of contradictions

 private:
  friend class FormulaTracker;
  friend class RateChangeUnit;
  struct Bare {};
  TrackedUnit(std::shared_ptr<const Tracked> tracked, Bare) : tracked_(std::move(tracked)) {}

  void rebuild(std::vector<UnitReading> all);
  std::vector<NodePath> look_at_all(const UnitNodes& nodes, const std::vector<UnitReading>& all,
                                    std::vector<double>& log_weight) const;
  bool rebuild_with(const UnitReading& reading, const prognosis::History& history);
  void weigh();
  ReadingPrediction predict(const UnitReading& reading, std::span<double> value,
                            std::vector<NodePath>* after) const;
  ReadingPrediction predict_by_all(const UnitReading& reading) const;
  const NodeLives& lives() const { return restored_ ? *restored_ : tracked_->lives; }
  bool is_late(const UnitReading& reading) const;
  std::vector<UnitReading> all_of(const prognosis::History& history) const;
  std::string two_at_one_place(const UnitReading& reading, const prognosis::History& history) const;

  std::shared_ptr<const Tracked> tracked_;
  std::string unit_;
  std::vector<UnitReading> seen_;
  UnitNodes nodes_;
  std::vector<double> log_weight_;
  std::vector<NodePath> paths_;
  UnitReading last_;           // the row farthest along the axis
  bool any_row_ = false;       // whether `last_` is set
  NodeRows::Sample sample_;    // representatives of all nodes, where accurate enough
  double effective_ = 0;       // nodes
  double laid_effective_ = 0;  // when they were built
  std::size_t readings_ = 0, laid_ = 0;
  double moved_ = 0;                           // of the threshold by repairs, SI
  std::shared_ptr<const NodeLives> restored_;  // null: not moved
};

}  // namespace wearwell::formula_model
