#include "wearwell/models/formula_model/tracked_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "wearwell/formula/kernels.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/lanes.h"

namespace wearwell::formula_model {
namespace {

constexpr double least_effective =
    0.5;  // of the effective number when nodes were built: below it they are rebuilt
constexpr double hardly_possible = 1e-4;  // a smaller p-value contradicts
constexpr std::size_t most_sampled = 128;
constexpr double doubtful = 0.05;  // a smaller p-value is summed over all nodes

bool has_noiseless_process(const FormulaModel& model) {
  return std::any_of(model.measured.begin(), model.measured.end(),
                     [](const Measured& m) { return m.process && m.wanted.size() < 3; });
}

}  // namespace

Tracked::Tracked(const TomlReader& root, std::shared_ptr<const FormulaModel> formula_model,
                 const WeightedDraws& posterior, std::string print)
    : model(std::move(formula_model)),
      reader(model),
      lives(root, model),
      rows(model, lives.wanted()),
      population(model, posterior),
      fingerprint(std::move(print)) {}

std::string Tracked::problem(const prognosis::Reading& from, UnitReading& reading) const {
  std::string why = reader.read(from, reading);
  return why.empty() ? lives.before_begin(reading.place, rows.follows()) : why;
}

TrackedUnit::TrackedUnit(std::shared_ptr<const Tracked> tracked, std::string unit,
                         std::vector<UnitReading> seen)
    : tracked_(std::move(tracked)), unit_(std::move(unit)), seen_(std::move(seen)) {
  rebuild({});
}

// All rows, those of the study first.
void TrackedUnit::rebuild(std::vector<UnitReading> all) {
  all.insert(all.begin(), seen_.begin(), seen_.end());
  sort_along(all);
  nodes_ = place_nodes(tracked_->population, seen_, all, nodes_);
  log_weight_ = std::move(nodes_.log_before);
  paths_ = look_at_all(nodes_, all, log_weight_);
  if (!all.empty()) {
    last_ = all.back();
    any_row_ = true;
  }
  ++laid_;
  weigh();
  laid_effective_ = effective_;
}

// Adds the log-likelihood of all rows, along the axis, to the nodes' weights; returns their paths.
std::vector<NodePath> TrackedUnit::look_at_all(const UnitNodes& nodes,
                                               const std::vector<UnitReading>& all,
                                               std::vector<double>& log_weight) const {
  std::vector<NodePath> paths = tracked_->rows.paths(), after = paths;
  std::vector<double> value(log_weight.size());
  for (const UnitReading& each : all) {
    tracked_->rows.look(nodes.nodes, each, paths, &after, value, nullptr, nullptr);
    for (std::size_t i = 0; i < value.size(); ++i) log_weight[i] += value[i];
    std::swap(paths, after);
  }
  return paths;
}

// Sums of the present weights: the effective number of nodes, and the representative ones.
void TrackedUnit::weigh() {
  sample_.node.clear();
  sample_.weight.clear();
  effective_ = 0;
  const double top = highest_of(log_weight_);
  if (!(top > -infinity)) return;
  static thread_local std::vector<double> weight, exponent;
  weight.resize(log_weight_.size());
  exponent.resize(log_weight_.size());
  // In single precision, as states are saved: weights to a relative 1e-6.
  for (std::size_t i = 0; i < weight.size(); ++i) {
    exponent[i] = log_weight_[i] = static_cast<float>(log_weight_[i] - top);
  }
  static const formula::Kernels exponential = formula::kernels_of(formula::Op::exp, 0);
  exponential.forward(exponent.data(), nullptr, nullptr, weight.data(), weight.size(), 0);
  const auto [sum, square] = sums_of(weight);
  effective_ = sum * sum / square;
  const double share = sum / most_sampled;
  double before = 0;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    before += weight[i];
    double own = 0;
    for (; drawn < most_sampled && before > (static_cast<double>(drawn) + 0.5) * share; ++drawn) {
      own += 1.0 / most_sampled;
    }
    if (!(own > 0)) continue;
    sample_.node.push_back(i);
    sample_.weight.push_back(own);
  }
}

std::vector<UnitReading> TrackedUnit::all_of(const prognosis::History& history) const {
  std::vector<UnitReading> all;
  history([&](const prognosis::Reading& each) {
    UnitReading reading;
    if (tracked_->reader.read(each, reading).empty()) all.push_back(std::move(reading));
  });
  return all;
}

// Rebuilds nodes for all readings with this one; false and unchanged if no node allows them.
bool TrackedUnit::rebuild_with(const UnitReading& reading, const prognosis::History& history) {
  TrackedUnit before = *this;
  std::vector<UnitReading> all = all_of(history);
  all.push_back(reading);
  rebuild(std::move(all));
  if (effective_ > 0) return true;
  *this = std::move(before);
  return false;
}

ReadingPrediction TrackedUnit::predict(const UnitReading& reading, std::span<double> value,
                                       std::vector<NodePath>* after) const {
  ReadingPrediction prediction;
  tracked_->rows.look(nodes_.nodes, reading, paths_, after, value, &sample_, &prediction);
  return prediction.p_value > doubtful ? prediction : predict_by_all(reading);
}

ReadingPrediction TrackedUnit::predict_by_all(const UnitReading& reading) const {
  NodeRows::Sample all;
  std::vector<double> weight;
  normalize(log_weight_, weight);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (!(weight[i] > 0)) continue;
    all.node.push_back(i);
    all.weight.push_back(weight[i]);
  }
  return tracked_->rows.predict(nodes_.nodes, reading, paths_, all);
}

// Among rows that depend on earlier ones, a row cannot be added before the last.
bool TrackedUnit::is_late(const UnitReading& reading) const {
  return any_row_ && tracked_->rows.follows() && reading.place <= last_.place;
}

std::vector<prognosis::PredictiveTails> TrackedUnit::predictive(
    const prognosis::Reading& reading) const {
  UnitReading y;
  if (!tracked_->problem(reading, y).empty() || is_late(y)) return {};
  const ReadingPrediction prediction = tracked_->rows.predict(nodes_.nodes, y, paths_, sample_);
  return prediction.p_value > doubtful ? prediction.tails : predict_by_all(y).tails;
}

prognosis::UpdateResult TrackedUnit::update(const prognosis::Reading& reading,
                                            const prognosis::History& history) {
  static const std::string impossible =
      "no unit of the population can show this after its earlier readings";
  prognosis::UpdateResult taken;
  UnitReading y;
  taken.problem = tracked_->problem(reading, y);
  if (!taken.problem.empty()) return taken;
  taken.p_value = 1;
  if (is_late(y)) {
    taken.problem = two_at_one_place(y, history);
    if (!taken.problem.empty()) return taken;
    taken.impossible = !rebuild_with(y, history);
  } else {
    static thread_local std::vector<double> value;
    value.resize(log_weight_.size());
    std::vector<NodePath> after = paths_;
    ReadingPrediction prediction = predict(y, value, &after);
    taken.p_value = prediction.p_value;
    taken.tails = std::move(prediction.tails);
    const bool any = std::any_of(value.begin(), value.end(), [&](const double& each) {
      return each + log_weight_[static_cast<std::size_t>(&each - value.data())] > -infinity;
    });
    if (any) {
      for (std::size_t i = 0; i < value.size(); ++i) log_weight_[i] += value[i];
      paths_ = std::move(after);
      weigh();
      if (!any_row_ || y.place >= last_.place) last_ = y;
      any_row_ = true;
      if (effective_ < least_effective * laid_effective_) rebuild_with(y, history);
    } else {
      taken.impossible = !rebuild_with(y, history);
    }
  }
  if (taken.impossible) {
    taken.problem = impossible;
    return taken;
  }
  ++readings_;
  taken.counted = true;
  taken.contradicts = taken.p_value < hardly_possible;
  return taken;
}

// A process without noise has one path.
std::string TrackedUnit::two_at_one_place(const UnitReading& reading,
                                          const prognosis::History& history) const {
  if (!has_noiseless_process(*tracked_->model)) return {};
  std::vector<UnitReading> all = all_of(history);
  all.insert(all.end(), seen_.begin(), seen_.end());
  const bool there = std::any_of(
      all.begin(), all.end(), [&](const UnitReading& each) { return each.place == reading.place; });
  return there
             ? fmt::format(
                   "there is another reading at the same {}; this process has no measurement error",
                   *tracked_->model->along)
             : "";
}

prognosis::Forecast TrackedUnit::forecast() const {
  std::vector<double> weight;
  normalize(log_weight_, weight);
  prognosis::Forecast forecast = lives().forecast(
      nodes_.nodes, weight, any_row_ ? last_ : tracked_->lives.before_rows(), paths_);
  move_levels(forecast, -moved_);
  return forecast;
}

prognosis::ForecastQuantiles TrackedUnit::quantiles() const {
  static thread_local std::vector<double> weight;
  normalize(log_weight_, weight);
  prognosis::ForecastQuantiles quantiles = lives().quantiles(
      nodes_.nodes, weight, any_row_ ? last_ : tracked_->lives.before_rows(), paths_);
  move_levels(quantiles, -moved_);
  return quantiles;
}

void TrackedUnit::set_restored(double amount) {
  const double by = tracked_->lives.rising() ? amount : -amount;
  if (by == moved_) return;
  moved_ = by;
  restored_ = by == 0 ? nullptr : std::make_shared<const NodeLives>(tracked_->lives.moved(by));
}

std::vector<prognosis::ForecastBand> TrackedUnit::ahead(std::span<const double> places) const {
  const UnitReading last = any_row_ ? last_ : tracked_->lives.before_rows();
  if (std::any_of(places.begin(), places.end(), [&](double x) { return !(x >= last.place); })) {
    throw std::invalid_argument("a position that is not ahead");
  }
  std::vector<double> weight;
  normalize(log_weight_, weight);
  std::vector<prognosis::ForecastBand> bands =
      lives().ahead(nodes_.nodes, weight, last, paths_, places);
  for (prognosis::ForecastBand& each : bands) move_levels(each, -moved_);
  return bands;
}

}  // namespace wearwell::formula_model
