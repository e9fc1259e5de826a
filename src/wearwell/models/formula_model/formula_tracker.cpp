#include "wearwell/models/formula_model/formula_tracker.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/rate_change_unit.h"
#include "wearwell/models/formula_model/tracked_unit.h"

namespace wearwell::formula_model {

class FormulaTracker final : public prognosis::Tracker {
 public:
  FormulaTracker(std::shared_ptr<const Tracked> tracked, std::shared_ptr<const RateChanges> changes)
      : tracked_(std::move(tracked)), changes_(std::move(changes)), fresh_(tracked_, "", {}) {
    const FormulaModel& model = *tracked_->model;
    for (const prognosis::ReadingColumn& each : tracked_->reader.columns()) {
      if (each.name == model.along) axis_ = &each;
    }
    if (model.units.size() > 1 || !model.units.front().empty()) seen_ = model.units;
  }

  std::span<const prognosis::ReadingColumn> columns() const override {
    return tracked_->reader.columns();
  }
  std::span<const std::string> labels() const override { return tracked_->reader.labels(); }
  const prognosis::ReadingColumn& axis() const override { return *axis_; }
  const std::string& limited() const override { return tracked_->lives.name(); }
  const Quantity& limit() const override { return tracked_->lives.limit(); }
  bool rising() const override { return tracked_->lives.rising(); }
  const std::string& noun() const override { return tracked_->lives.noun(); }
  double probability_error() const override {
    if (changes_) return 0.03;
    return tracked_->model->effects.size() > 1 ? 0.02 : 0.008;
  }
  bool can_be_restored() const override { return true; }
  std::vector<double> populations() const override {
    if (changes_) return {};
    std::vector<double> weight;
    normalize(tracked_->population.few.log_weight, weight);
    return weight;
  }
  std::span<const std::string> seen() const override { return seen_; }
  std::string problem(const prognosis::Reading& reading) const override {
    UnitReading ignored;
    return tracked_->problem(reading, ignored);
  }

  std::unique_ptr<prognosis::TrackedUnit> begin(const std::string& unit) const override {
    std::unique_ptr<TrackedUnit> begun = unchanged(unit);
    if (!changes_) return begun;
    return std::make_unique<RateChangeUnit>(changes_, std::move(begun));
  }

  std::unique_ptr<prognosis::TrackedUnit> restore(const std::string& bytes) const override {
    if (changes_)
      return RateChangeUnit::restore(changes_, bytes,
                                     [this](const std::string& unit) { return rows_of(unit); });
    return TrackedUnit::restore(tracked_, bytes,
                                [this](const std::string& unit) { return rows_of(unit); });
  }

 private:
  std::unique_ptr<TrackedUnit> unchanged(const std::string& unit) const {
    std::vector<UnitReading> rows = rows_of(unit);
    if (!rows.empty()) return std::make_unique<TrackedUnit>(tracked_, unit, std::move(rows));
    auto fresh = std::make_unique<TrackedUnit>(fresh_);
    fresh->unit_ = unit;
    return fresh;
  }

  // The readings of a unit in the study, along the axis.
  std::vector<UnitReading> rows_of(const std::string& unit) const {
    const auto at = std::find(seen_.begin(), seen_.end(), unit);
    if (at == seen_.end()) return {};
    std::vector<UnitReading> rows =
        tracked_->reader.of_study(static_cast<std::size_t>(at - seen_.begin()));
    sort_along(rows);
    return rows;
  }

  std::shared_ptr<const Tracked> tracked_;
  std::shared_ptr<const RateChanges> changes_;  // null: rates do not change
  const TrackedUnit fresh_;
  const prognosis::ReadingColumn* axis_ = nullptr;
  std::vector<std::string> seen_;
};

std::unique_ptr<const prognosis::Tracker> track_units(const prognosis::CarriedState& state) {
  const TomlReader root = TomlReader::parse(state.source.study);
  const std::shared_ptr<const FormulaModel> model = read_formula_model(root, state.source);
  const auto predict = root.table("predict");
  const bool has_threshold = predict && predict->has("limit");
  if (!has_threshold && !model->along && model->measured.front().form->positive) return nullptr;
  refuse_unsupported(*model, "tracked");
  for (const Measured& each : model->measured) {
    if (!each.process || each.process->process == Process::wiener || each.wanted.size() < 3)
      continue;
    throw InputError(
        fmt::format("{}: a {} with noise cannot be tracked; a wiener-process with noise can",
                    each.column, each.form->name));
  }
  std::vector<std::string> names;
  for (const Parameter& each : model->parameters) names.push_back(each.name);
  prognosis::require_parameters(state, names);
  auto tracked = std::make_shared<const Tracked>(root, model, state.posterior,
                                                 prognosis::population_fingerprint(state));
  std::shared_ptr<const RateChanges> changes;
  if (const auto prior = predict ? read_rate_change(*predict, *model) : std::nullopt)
    changes = std::make_shared<const RateChanges>(tracked, *prior, root);
  return std::make_unique<const FormulaTracker>(std::move(tracked), std::move(changes));
}

}  // namespace wearwell::formula_model
