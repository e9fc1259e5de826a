#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/state_bytes.h"
#include "wearwell/models/formula_model/tracked_unit.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_carried = 1000;  // far more than any formula has

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

bool are_log_weights(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return x < infinity; });
}

double one_number(StateReader& from) {
  const std::vector<double> values = from.numbers();
  from.demand(values.size() == 1 && std::isfinite(values[0]));
  return values[0];
}

}  // namespace

std::string TrackedUnit::save() const {
  StateWriter to;
  to.text(tracked_->fingerprint);
  to.text(unit_);
  to.number(readings_);
  to.number(laid_);
  to.number(nodes_.own ? 1 : 0);
  if (nodes_.own) {
    to.number(static_cast<std::size_t>(nodes_.nodes.parameters->rows()));
    to.numbers({nodes_.nodes.parameters->data(),
                static_cast<std::size_t>(nodes_.nodes.parameters->size())});
  }
  to.short_numbers(nodes_.log_point);
  if (!seen_.empty()) to.short_numbers(nodes_.log_seen);
  to.short_numbers(nodes_.shape);
  to.short_numbers(log_weight_);
  to.numbers({&laid_effective_, 1});
  for (const NodePath& each : paths_) {
    to.number((each.begun ? 1 : 0) + (each.measured ? 2 : 0));
    to.numbers(std::array{each.place, each.reading});
    to.number(each.carried.size());
    for (const auto& values : each.carried) to.numbers(values);
    for (const auto* values : {&each.mean, &each.spread, &each.at, &each.variance}) {
      to.numbers(*values);
    }
  }
  to.number(any_row_ ? 1 : 0);
  if (any_row_) {
    to.numbers(last_.row.numbers);
    to.numbers(std::array{last_.place});
    for (const int each : last_.row.labels) to.number(static_cast<std::size_t>(each));
  }
  return to.done();
}

std::unique_ptr<TrackedUnit> TrackedUnit::restore(
    std::shared_ptr<const Tracked> tracked, const std::string& bytes,
    const std::function<std::vector<UnitReading>(const std::string& unit)>& seen) {
  StateReader from(bytes);
  if (from.text() != tracked->fingerprint) {
    throw InputError(
        "the state of a unit is of another population: the study has been fitted again since");
  }
  std::unique_ptr<TrackedUnit> unit(new TrackedUnit(tracked, Bare()));
  unit->unit_ = from.text();
  unit->seen_ = seen(unit->unit_);
  unit->readings_ = from.number();
  unit->laid_ = from.number();
  UnitNodes& nodes = unit->nodes_;
  nodes.own = from.number() == 1;
  nodes.nodes.parameters = tracked->population.few.values;
  if (nodes.own) {
    const std::size_t rows = from.number();
    const std::vector<double> values = from.numbers();
    const auto columns = static_cast<Eigen::Index>(tracked->model->parameters.size());
    from.demand(rows > 0 && values.size() / rows == static_cast<std::size_t>(columns) &&
                values.size() % rows == 0 && all_finite(values));
    nodes.nodes.parameters = std::make_shared<const Points>(
        Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(rows), columns));
  }
  const std::size_t effects = tracked->population.effects();
  nodes.log_point = from.short_numbers();
  nodes.log_seen =
      unit->seen_.empty() ? std::vector<double>(nodes.nodes.lines()) : from.short_numbers();
  nodes.shape = from.short_numbers();
  from.demand(nodes.log_point.size() == nodes.nodes.lines() &&
              nodes.log_seen.size() == nodes.nodes.lines() &&
              nodes.shape.size() == nodes.nodes.lines() * UnitNodes::shape_size(effects));
  from.demand(all_finite(nodes.shape) && are_log_weights(nodes.log_point) &&
              are_log_weights(nodes.log_seen));
  nodes.fill(*tracked->model);
  nodes.log_before.clear();
  nodes.log_before.shrink_to_fit();
  unit->log_weight_ = from.short_numbers();
  from.demand(unit->log_weight_.size() == nodes.nodes.count() &&
              are_log_weights(unit->log_weight_));
  unit->laid_effective_ = one_number(from);
  unit->paths_ = tracked->rows.paths();
  for (NodePath& each : unit->paths_) {
    const std::size_t state = from.number();
    each.begun = (state & 1) != 0;
    each.measured = (state & 2) != 0;
    const std::vector<double> place = from.numbers();
    from.demand(place.size() == 2);
    each.place = place[0];
    each.reading = place[1];
    const std::size_t carried = from.number();
    from.demand(carried <= most_carried);
    each.carried.resize(carried);
    for (auto& values : each.carried) values = from.numbers();
    for (auto* values : {&each.mean, &each.spread, &each.at, &each.variance}) {
      *values = from.numbers();
    }
  }
  from.demand(tracked->rows.fit(unit->paths_, nodes.nodes.count()));
  unit->any_row_ = from.number() == 1;
  if (unit->any_row_) {
    unit->last_.row.numbers = from.numbers();
    unit->last_.place = one_number(from);
    from.demand(unit->last_.row.numbers.size() == tracked->model->row_symbols.columns.size());
    for (const formula::LabelSymbol& label : tracked->model->row_symbols.labels) {
      const std::size_t level = from.number();
      from.demand(level < label.levels.size());
      unit->last_.row.labels.push_back(static_cast<int>(level));
    }
  }
  from.end();
  unit->weigh();
  from.demand(unit->effective_ > 0);
  return unit;
}

}  // namespace wearwell::formula_model
