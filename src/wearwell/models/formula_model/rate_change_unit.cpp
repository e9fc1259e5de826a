#include "wearwell/models/formula_model/rate_change_unit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/math/constants.h"
#include "wearwell/math/log_sum_exp.h"
#include "wearwell/models/formula_model/node_points.h"
#include "wearwell/models/formula_model/rate_change_moves.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t proposed = 1024;  // particles that have changed since the last reading
constexpr std::size_t least_born = 32;  // of them kept, at least
constexpr std::size_t most_particles = 2 * RateChangeUnit::usual;
constexpr double least_diverse = 0.5;     // of `usual`: a smaller effective number is resampled
constexpr double of_interest = 1e-4;      // a smaller probability of a change needs no moves
constexpr std::uint64_t seed = 20070518;  // any; streams are numbered by updates
constexpr double hardly = 1e-4;           // TrackedUnit: a smaller p-value contradicts

}  // namespace

RateChangeUnit::RateChangeUnit(std::shared_ptr<const RateChanges> shared,
                               std::unique_ptr<UnchangedUnit> unchanged)
    : shared_(std::move(shared)), base_(std::move(unchanged)) {
  start_ = last_place();
}

double RateChangeUnit::last_place() const {
  return base_->any_row_ ? base_->last_.place : shared_->tracked->lives.begin();
}

UnitReading RateChangeUnit::last_row() const {
  return base_->any_row_ ? base_->last_ : shared_->tracked->lives.before_rows();
}

double RateChangeUnit::probability() const {
  if (changed_.count() == 0) return 0;
  const double changed = log_sum_exp(changed_.log_weight);
  return 1 / (1 + std::exp(log_unchanged_ - changed));
}

// Particles at nodes of the unit without a change; within its cell of the line, where no path
// depends on it.
ChangedUnits RateChangeUnit::drawn_from_base(const std::vector<std::size_t>& which,
                                             Rng& rng) const {
  const Tracked& tracked = *shared_->tracked;
  const FormulaModel& model = *tracked.model;
  const UnitNodes& nodes = base_->nodes_;
  const std::size_t d = model.effects.size(), per_line = nodes.nodes.per_line;
  ChangedUnits born;
  auto rows = std::make_shared<Points>(static_cast<Eigen::Index>(which.size()),
                                       nodes.nodes.parameters->cols());
  PopulationAt population_at(model);
  for (std::size_t i = 0; i < which.size(); ++i) {
    const auto line = static_cast<Eigen::Index>(which[i] / per_line);
    rows->row(static_cast<Eigen::Index>(i)) = nodes.nodes.parameters->row(line);
    if (d == 0) continue;
    const Population population = population_at(nodes.nodes.parameters->row(line).data());
    double z[2] = {};
    nodes.scores(d, which[i], z);
    if (d == 1 && !model.has_process())
      z[0] += (rng.uniform() - 0.5) * nodes.shape[static_cast<std::size_t>(line) * 2 + 1];
    for (std::size_t e = 0; e < d; ++e) {
      born.z[e].push_back(z[e]);
      born.nodes.effect[e].push_back(population.value(model, e, z));
    }
  }
  born.nodes.parameters = std::move(rows);
  born.log_weight.assign(which.size(), 0);
  born.paths = base_->paths_;
  for (std::size_t m = 0; m < born.paths.size(); ++m) {
    const NodePath& from = base_->paths_[m];
    born.paths[m].mean = picked(from.mean, which);
    born.paths[m].spread = picked(from.spread, which);
    born.paths[m].at = picked(from.at, which);
    born.paths[m].variance = picked(from.variance, which);
  }
  return born;
}

// Units that have changed between the last reading and `until`.
ChangedUnits RateChangeUnit::newborn(double until, Rng& rng) const {
  const double from = last_place(), length = until - from;
  if (!(length > 0)) return {};
  const double changes = -std::expm1(-shared_->prior.hazard * length);
  const double turn_since = rng.uniform(), turn_score = rng.uniform();
  ChangedUnits born = drawn_from_base(resampled(base_->log_weight_, proposed, rng.uniform()), rng);
  // Nodes follow each other along the line: places and factors must not follow them, too.
  for (std::size_t i = 0; i < born.count(); ++i) {
    const auto [place, score] = change_fractions(i);
    const double u = std::fmod(place + turn_since, 1.0), v = std::fmod(score + turn_score, 1.0);
    const double z = normal_quantile(std::clamp(v, 1e-12, 1 - 1e-12));
    born.axis.since.push_back(from - std::log1p(-u * changes) / shared_->prior.hazard);
    born.axis.factor.push_back(shared_->prior.factor(z));
    born.score.push_back(z);
    born.log_weight[i] = log_unchanged_ + std::log(changes / static_cast<double>(born.count()));
  }
  return born;
}

// Log-likelihoods of a reading, after which the paths of the particles are.
RateChangeUnit::Likelihoods RateChangeUnit::likelihoods(const UnitReading& reading,
                                                        ChangedUnits& born) {
  const auto look = [&](ChangedUnits& units) {
    std::vector<double> value(units.count());
    if (value.empty()) return value;
    std::vector<NodePath> after = units.paths;
    const std::vector<double> places = units.places(reading.place);
    shared_->rows.look(units.nodes, reading, units.paths, &after, value, nullptr, nullptr,
                       places.data());
    units.paths = std::move(after);
    return value;
  };
  Likelihoods found{look(changed_), look(born), 0};
  std::vector<double> value(base_->log_weight_.size());
  shared_->tracked->rows.look(base_->nodes_.nodes, reading, base_->paths_, nullptr, value, nullptr,
                              nullptr);
  const double before = log_sum_exp(base_->log_weight_);
  for (std::size_t i = 0; i < value.size(); ++i) value[i] += base_->log_weight_[i];
  found.unchanged = log_sum_exp(value) - before;
  return found;
}

// Keeps new particles in proportion to their share of all that have changed.
void RateChangeUnit::thin(ChangedUnits& born, Rng& rng) const {
  const double mass = log_sum_exp(born.log_weight);
  const double offset = rng.uniform();
  if (!(mass > -infinity)) {
    born = {};
    return;
  }
  const double old = changed_.count() > 0 ? log_sum_exp(changed_.log_weight) : -infinity;
  const double share = 1 / (1 + std::exp(old - mass));
  const auto count = static_cast<std::size_t>(std::ceil(share * usual));
  const std::vector<std::size_t> which =
      resampled(born.log_weight, std::clamp(count, least_born, usual), offset);
  born = born.taken(which);
  born.log_weight.assign(born.count(), mass - std::log(static_cast<double>(born.count())));
}

// All readings along the axis, this one at the end.
std::vector<UnitReading> RateChangeUnit::all_readings(const UnitReading& last,
                                                      const prognosis::History& history) const {
  std::vector<UnitReading> all = base_->all_of(history);
  all.insert(all.begin(), base_->seen_.begin(), base_->seen_.end());
  sort_along(all);
  all.push_back(last);
  return all;
}

// Weights after a reading; resampled and moved where few particles carry them, or there are too many.
void RateChangeUnit::weigh(const UnitReading& reading, Likelihoods of, ChangedUnits born,
                           const prognosis::History& history, Rng& rng) {
  std::vector<double> after;
  for (const auto& [units, values] : {std::pair(&changed_, &of.changed), {&born, &of.born}})
    for (std::size_t i = 0; i < values->size(); ++i)
      after.push_back(units->log_weight[i] + (*values)[i]);
  const double mass = after.empty() ? -infinity : log_sum_exp(after);
  if (!(mass > -infinity)) {
    changed_ = {};
    return;
  }
  const bool matters = mass - log_unchanged_ > std::log(of_interest);
  const bool many = changed_.count() + least_born > most_particles;
  if (matters && (many || effective_number(after) < least_diverse * static_cast<double>(usual))) {
    changed_.append(born);
    of.changed.insert(of.changed.end(), of.born.begin(), of.born.end());
    const RateChangeMoves moves(*shared_, all_readings(reading, history), base_->seen_, start_);
    moves.take_last(changed_, std::move(of.changed), usual, rng);
    return;
  }
  std::copy_n(after.begin(), changed_.count(), changed_.log_weight.begin());
  std::copy(after.begin() + static_cast<std::ptrdiff_t>(changed_.count()), after.end(),
            born.log_weight.begin());
  if (born.count() > 0) thin(born, rng);
  if (born.count() > 0) changed_.append(born);
  if (!many) return;
  changed_ = changed_.taken(resampled(changed_.log_weight, usual, rng.uniform()));
  changed_.log_weight.assign(usual, mass - std::log(static_cast<double>(usual)));
}

prognosis::UpdateResult RateChangeUnit::update(const prognosis::Reading& reading,
                                               const prognosis::History& history) {
  UnitReading y;
  const bool valid = shared_->tracked->problem(reading, y).empty();
  if (valid && base_->is_late(y)) return run_again(reading, history);
  return update_in_order(reading, history);
}

prognosis::UpdateResult RateChangeUnit::update_in_order(const prognosis::Reading& reading,
                                                        const prognosis::History& history) {
  UnitReading y;
  if (!shared_->tracked->problem(reading, y).empty()) return base_->update(reading, history);
  std::vector<prognosis::PredictiveTails> tails = predictive(reading);
  const ChangedUnits before = changed_;
  Rng rng(seed, updates_);
  ChangedUnits born = newborn(y.place, rng);
  const Likelihoods of = likelihoods(y, born);
  const double length = std::max(0.0, y.place - last_place());
  prognosis::UpdateResult taken = base_->update(reading, history);
  if (!taken.counted) {
    changed_ = before;
    return taken;
  }
  ++updates_;
  log_unchanged_ += of.unchanged - shared_->prior.hazard * length;
  weigh(y, of, std::move(born), history, rng);
  const double changed = changed_.count() > 0 ? log_sum_exp(changed_.log_weight) : -infinity;
  const double both[] = {log_unchanged_, changed};
  const double all = log_sum_exp(both);
  if (all > -infinity) {
    log_unchanged_ -= all;
    for (double& each : changed_.log_weight) each -= all;
  } else {
    // No node explains the reading, but new ones do: the unit goes on from them.
    log_unchanged_ = 0;
    changed_ = {};
  }
  if (!tails.empty()) {
    taken.tails = std::move(tails);
    taken.p_value = 1;
    for (const auto& [below, above] : taken.tails)
      taken.p_value = std::min(taken.p_value, 2 * std::min(below, above));
    taken.p_value = std::min(1.0, taken.p_value * static_cast<double>(taken.tails.size()));
    taken.contradicts = taken.p_value < hardly;
  }
  return taken;
}

// Rows that depend on earlier ones: the same as if the reading had come in its order.
prognosis::UpdateResult RateChangeUnit::run_again(const prognosis::Reading& reading,
                                                  const prognosis::History& history) {
  prognosis::UpdateResult taken = base_->update(reading, history);
  if (!taken.counted) return taken;
  std::vector<std::pair<double, prognosis::Reading>> rows;
  const auto note = [&](const prognosis::Reading& each) {
    UnitReading row;
    if (shared_->tracked->problem(each, row).empty()) rows.emplace_back(row.place, each);
  };
  history(note);
  note(reading);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  auto fresh = std::make_unique<UnchangedUnit>(shared_->tracked, base_->unit_, base_->seen_);
  RateChangeUnit again(shared_, std::move(fresh));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    again.update_in_order(rows[i].second, [&](const auto& visit) {
      for (std::size_t j = 0; j < i; ++j) visit(rows[j].second);
    });
  }
  log_unchanged_ = again.log_unchanged_;
  changed_ = std::move(again.changed_);
  updates_ = again.updates_;
  return taken;
}

std::vector<prognosis::PredictiveTails> RateChangeUnit::mixed_tails(
    const UnitReading& reading, std::vector<prognosis::PredictiveTails> tails) const {
  Rng rng(seed, updates_);
  ChangedUnits units = newborn(reading.place, rng);
  if (changed_.count() > 0) units.append(changed_);
  if (units.count() == 0) return tails;
  const double length = std::max(0.0, reading.place - last_place());
  const double both[] = {log_unchanged_ - shared_->prior.hazard * length,
                         log_sum_exp(units.log_weight)};
  const double all = log_sum_exp(both);
  if (!(all > -infinity)) return tails;
  const double changed = std::exp(both[1] - all);
  NodeRows::Sample sample;
  normalize(units.log_weight, sample.weight);
  sample.node.resize(units.count());
  std::iota(sample.node.begin(), sample.node.end(), std::size_t{0});
  std::vector<double> value(units.count());
  ReadingPrediction prediction;
  const std::vector<double> places = units.places(reading.place);
  shared_->rows.look(units.nodes, reading, units.paths, nullptr, value, &sample, &prediction,
                     places.data());
  if (prediction.tails.size() != tails.size()) return tails;
  for (std::size_t m = 0; m < tails.size(); ++m) {
    tails[m].below += changed * (prediction.tails[m].below - tails[m].below);
    tails[m].above += changed * (prediction.tails[m].above - tails[m].above);
  }
  return tails;
}

std::vector<prognosis::PredictiveTails> RateChangeUnit::predictive(
    const prognosis::Reading& reading) const {
  std::vector<prognosis::PredictiveTails> tails = base_->predictive(reading);
  UnitReading y;
  if (tails.empty() || !shared_->tracked->problem(reading, y).empty()) return tails;
  return mixed_tails(y, std::move(tails));
}

}  // namespace wearwell::formula_model
