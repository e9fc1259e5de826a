#include <array>
#include <cmath>

#include "wearwell/models/formula_model/rate_change_unit.h"
#include "wearwell/models/formula_model/state_bytes.h"

// The saved state of a unit whose rate may change.
namespace wearwell::formula_model {
namespace {

constexpr std::string_view change_mark = "rate change 1";

}  // namespace

std::string RateChangeUnit::save() const {
  StateWriter to;
  to.text(change_mark);
  to.text(base_->save());
  to.number(updates_);
  to.numbers(std::array{start_, log_unchanged_});
  to.number(changed_.count());
  if (changed_.count() == 0) return to.done();
  const Points& parameters = *changed_.nodes.parameters;
  to.numbers({parameters.data(), static_cast<std::size_t>(parameters.size())});
  for (int e = 0; e < 2; ++e) {
    to.numbers(changed_.nodes.effect[e]);
    to.numbers(changed_.z[e]);
  }
  for (const auto* values :
       {&changed_.axis.since, &changed_.axis.factor, &changed_.score, &changed_.log_weight})
    to.numbers(*values);
  for (const NodePath& each : changed_.paths) {
    to.number((each.begun ? 1 : 0) + (each.measured ? 2 : 0));
    to.numbers(std::array{each.place, each.reading});
    for (const auto* values : {&each.mean, &each.spread, &each.at, &each.variance})
      to.numbers(*values);
  }
  return to.done();
}

std::unique_ptr<RateChangeUnit> RateChangeUnit::restore(
    std::shared_ptr<const RateChanges> shared, const std::string& bytes,
    const std::function<std::vector<UnitReading>(const std::string& unit)>& seen) {
  StateReader from(bytes);
  from.demand(from.text() == change_mark);
  const std::string base = from.text();
  auto unit =
      std::make_unique<RateChangeUnit>(shared, UnchangedUnit::restore(shared->tracked, base, seen));
  unit->updates_ = from.number();
  const std::vector<double> numbers = from.numbers();
  from.demand(numbers.size() == 2 && std::isfinite(numbers[0]) && !std::isnan(numbers[1]));
  unit->start_ = numbers[0];
  unit->log_unchanged_ = numbers[1];
  const std::size_t count = from.number();
  from.demand(count <= 4 * usual);
  if (count == 0) {
    from.end();
    return unit;
  }
  ChangedUnits& changed = unit->changed_;
  const std::size_t effects = shared->tracked->model->effects.size();
  const auto columns = static_cast<Eigen::Index>(shared->tracked->model->parameters.size());
  const auto read = [&](std::vector<double>& to, std::size_t size) {
    to = from.numbers();
    from.demand(to.size() == size);
    for (const double each : to) from.demand(!std::isnan(each));
  };
  std::vector<double> values;
  read(values, count * static_cast<std::size_t>(columns));
  changed.nodes.parameters = std::make_shared<const Points>(
      Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(count), columns));
  for (std::size_t e = 0; e < 2; ++e) {
    read(changed.nodes.effect[e], e < effects ? count : 0);
    read(changed.z[e], e < effects ? count : 0);
  }
  for (auto* each :
       {&changed.axis.since, &changed.axis.factor, &changed.score, &changed.log_weight})
    read(*each, count);
  for (const double each : changed.axis.factor) from.demand(each > 0);
  changed.paths = shared->rows.paths();
  for (NodePath& each : changed.paths) {
    const std::size_t state = from.number();
    each.begun = (state & 1) != 0;
    each.measured = (state & 2) != 0;
    std::vector<double> place;
    read(place, 2);
    each.place = place[0];
    each.reading = place[1];
    for (auto* to : {&each.mean, &each.spread, &each.at, &each.variance}) *to = from.numbers();
  }
  from.demand(shared->rows.fit(changed.paths, count));
  from.end();
  return unit;
}

}  // namespace wearwell::formula_model
