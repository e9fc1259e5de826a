#include "wearwell/models/formula_model/node_lives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/formula_model/formula_first_passage.h"
#include "wearwell/models/formula_model/formula_limit.h"
#include "wearwell/models/formula_model/node_points.h"
#include "wearwell/models/formula_model/nodes_ahead.h"
#include "wearwell/prognosis/weighted_quantiles.h"

namespace wearwell::formula_model {
NodeLives::NodeLives(const TomlReader& root, std::shared_ptr<const FormulaModel> model)
    : model_(std::move(model)), limit_() {
  const auto predict = root.table("predict");
  if (!predict || !predict->has("limit") || !model_->along) {
    root.fail("predict",
              "has no limit: units are tracked towards a failure threshold; add along = "
              "\"distance\" and limit = { wear = \"100 um\" }");
  }
  const Asked asked(*predict, model_, nullptr);
  given_ = asked.given;
  noun_ = asked.noun;
  const TomlReader limits = predict->required_table("limit");
  name_ = limits.keys().front();
  wanted_ = {{"[predict] limit", name_}};
  if (model_->has_process()) {
    while (column_ < model_->measured.size() &&
           !(model_->measured[column_].process && model_->measured[column_].column == name_)) {
      ++column_;
    }
    if (column_ == model_->measured.size()) limits.fail(name_, "is not a process");
    process_ = model_->measured[column_].process;
    const auto& family_parameters = model_->measured[column_].wanted;
    wanted_.assign(family_parameters.begin(), family_parameters.begin() + 2);
  }
  path_.next =
      make_path(model_, limits, name_, wanted_, true, conditions_of_unit(*model_, 0, given_));
  limit_ = limits.required_quantity(
      name_, formula::si_text(process_ ? model_->measured[column_].powers
                                       : path_.next->program.outputs()[0].powers));
  path_.limit = limit_.si();
  set_reach(asked, path_);
  if (path_.next->running) {
    steps_ = path_.next->running->steps;
    row_length_ = path_.next->running->row_length;
  }
  program_ = std::make_shared<const NodeProgram>(*model_, wanted_, true);
}

std::string NodeLives::before_begin(double place, bool follows) const {
  if (!(place < path_.begin) || (path_.begin < 0 && !follows)) return {};
  const Unit& unit = model_->data.number(*model_->along)->unit.unit;
  return fmt::format("{} = {:.6g} {} lies before {:.6g}, the start of paths", *model_->along,
                     from_si(unit, place), unit.text, from_si(unit, path_.begin));
}

UnitReading NodeLives::before_rows() const {
  UnitReading row;
  for (const formula::ColumnSymbol& each : model_->row_symbols.columns) {
    row.row.numbers.push_back(model_->data.number(each.name)->values.front());
    if (model_->along == each.name) row.row.numbers.back() = path_.begin;
  }
  for (const formula::LabelSymbol& each : model_->row_symbols.labels) {
    row.row.labels.push_back(model_->data.label(each.name)->at.front());
  }
  row.row = conditions(row.row);
  row.place = path_.begin;
  return row;
}

NodeRow NodeLives::conditions(const NodeRow& last) const {
  NodeRow ahead = last;
  for (std::size_t c = 0; c < ahead.numbers.size(); ++c) {
    const auto at = given_.numbers.find(model_->row_symbols.columns[c].name);
    if (at != given_.numbers.end()) ahead.numbers[c] = at->second;
  }
  for (std::size_t l = 0; l < ahead.labels.size(); ++l) {
    const auto at = given_.labels.find(model_->row_symbols.labels[l].name);
    if (at != given_.labels.end()) ahead.labels[l] = at->second;
  }
  return ahead;
}

namespace {

// Lives over all nodes of a unit together.
struct OfAll : LivesSample {
  std::size_t level_count = 0, life_count = 0;

  // At most so many points will come.
  void begin(std::size_t most) {
    for (auto* each : {&levels, &level_weight, &lives, &life_weight}) each->resize(most);
    level_count = life_count = 0;
    left_over = all = 0;
  }
  void end() {
    for (auto* each : {&levels, &level_weight}) each->resize(level_count);
    for (auto* each : {&lives, &life_weight}) each->resize(life_count);
  }

  void level(double weight, double value) {
    levels[level_count] = value;
    level_weight[level_count++] = weight;
  }
  void stands(std::size_t, double weight) { all += weight; }
  void lasts(std::size_t, double weight, double life) {
    left_over += weight;
    lives[life_count] = life;
    life_weight[life_count++] = weight;
  }
};

// The same line by line, lives only.
struct OfLines {
  struct Line {
    std::vector<double> lives, weight;
    double left_over = 0, all = 0;
  };
  std::size_t per_line;
  std::vector<Line> lines;

  void level(double, double) {}
  void stands(std::size_t node, double weight) { lines[node / per_line].all += weight; }
  void lasts(std::size_t node, double weight, double life) {
    Line& line = lines[node / per_line];
    line.left_over += weight;
    line.lives.push_back(life);
    line.weight.push_back(weight);
  }
};

constexpr std::array shown = {0.05, 0.5, 0.95};

double passed_of(double left_over, double all) {
  return all > 0 ? std::clamp(1 - left_over / all, 0.0, 1.0) : std::nan("");
}

}  // namespace

// Paths with random increments: the position of each, and the distribution of its first passage
// from there.
template <class Sums>
void NodeLives::pass(Ahead& ahead, std::span<const double> own, const double* start,
                     const NodePath& path, std::size_t points, Sums& sums) const {
  const double sign = path_.rising ? 1 : -1;
  double far[most_crossings], scale[most_crossings], place[most_crossings];
  ahead.here(far);
  for (std::size_t i = 0; i < ahead.count; ++i)
    far[i] = std::max(far[i], path_.begin + path_.scale);
  ahead.evaluate(ahead.ahead, far);
  for (std::size_t i = 0; i < ahead.count; ++i) {
    const double spread = ahead.at(1, i);
    scale[i] = process_->by_sd ? spread * spread / std::abs(ahead.at(0, i)) : spread;
  }
  const bool noisy = path.measured && !path.variance.empty();
  for (std::size_t k = 0; k < points; ++k) {
    double target[most_crossings];
    std::vector<double> share(ahead.count);
    for (std::size_t i = 0; i < ahead.count; ++i) {
      const std::size_t node = ahead.begin + i;
      const double one = own[i] / static_cast<double>(points);
      sums.stands(node, one);
      const double p = (static_cast<double>(k) + fraction(node, 0.6180339887498949)) /
                       static_cast<double>(points);
      const double stands = !path.measured ? 0 : noisy ? path.at[node] : path.reading;
      const double sd = noisy ? std::sqrt(path.variance[node]) : 0;
      double left = sign * (path_.limit - stands);
      sums.level(one, stands + (sd > 0 ? sd * normal_quantile(p) : 0));
      const double below = sd > 0 ? normal_cdf(left / sd) : left > 0 ? 1 : 0;
      share[i] = one * below;
      target[i] = path.measured ? path.mean[node] : 0;
      if (!(share[i] > 1e-14)) continue;
      if (sd > 0) {  // its position, given that it has not passed
        const double q = fraction(points * node + k, 0.7548776662466927);
        left -= sd * normal_quantile(std::max(q * below, 1e-300));
      }
      double values[ScoreTable::edges];
      ScoreTable::passages(process_->process).look_up(std::max(left, 1e-300), scale[i], values);
      target[i] += sign * at_score(values, normal_quantile(p));
    }
    ahead.cross(target, place);
    for (std::size_t i = 0; i < ahead.count; ++i) {
      // Passed since its last reading, if the last row has none.
      if (!(share[i] > 1e-14) || place[i] < start[i]) continue;
      sums.lasts(ahead.begin + i, share[i], ahead.use_of(i, place[i] - start[i]));
    }
  }
}

// `points`: of the distribution of a first passage, for each node.
template <class Sums>
void NodeLives::look_ahead(const Nodes& nodes, const std::vector<double>& weight,
                           const UnitReading& last, const std::vector<NodePath>& paths,
                           std::size_t points, Sums& sums, const NodeAxis* axis) const {
  Ahead ahead(*this, nodes, last, paths.back(), axis);
  const std::size_t line = model_->effects.size() == 1 ? nodes.per_line : 1;
  const std::size_t most = most_crossings / line * line;  // whole lines
  for (std::size_t begin = 0; begin < nodes.count(); begin += most) {
    ahead.begin = begin;
    ahead.count = std::min(most, nodes.count() - begin);
    const std::span<const double> own = std::span(weight).subspan(begin, ahead.count);
    if (std::all_of(own.begin(), own.end(), [](double w) { return w < 1e-14; })) continue;
    double level[most_crossings], start[most_crossings], place[most_crossings];
    ahead.now(0, level);
    ahead.here(start);
    if (ahead.changes) ahead.cross(level, start);
    if (process_) {
      pass(ahead, own, start, paths[column_], points, sums);
      continue;
    }
    double limit[most_crossings];
    std::fill_n(limit, ahead.count, path_.limit);
    ahead.cross(limit, place);
    ahead.count_from(start, place);
    for (std::size_t i = 0; i < ahead.count; ++i) place[i] = ahead.use_of(i, place[i]);
    const DrawnLines drawn(own, line);
    drawn.put({level, ahead.count},
              [&](std::size_t, double w, double value) { sums.level(w, value); });
    drawn.put({place, ahead.count}, [&](std::size_t k, double w, double life) {
      sums.stands(begin + k, w);
      if (life > 0) sums.lasts(begin + k, w, life);
    });
  }
}

void LivesSample::add(const LivesSample& other, double weight) {
  const auto append = [&](const std::vector<double>& from, std::vector<double>& to, double times) {
    to.reserve(to.size() + from.size());
    for (const double each : from) to.push_back(times * each);
  };
  append(other.levels, levels, 1);
  append(other.level_weight, level_weight, weight);
  append(other.lives, lives, 1);
  append(other.life_weight, life_weight, weight);
  left_over += weight * other.left_over;
  all += weight * other.all;
}

prognosis::Forecast LivesSample::forecast() const {
  prognosis::Forecast forecast;
  const std::vector<double> level = prognosis::weighted_quantiles(levels, level_weight, shown);
  forecast.level05 = level[0];
  forecast.level50 = level[1];
  forecast.level95 = level[2];
  forecast.passed = passed_of(left_over, all);
  forecast.remaining = prognosis::WeightedLives(lives, life_weight);
  return forecast;
}

prognosis::ForecastQuantiles LivesSample::quantiles() const {
  const std::vector<double> level = prognosis::weighted_quantiles(levels, level_weight, shown);
  const std::vector<double> life = prognosis::weighted_quantiles(lives, life_weight, shown);
  const bool any = !std::isnan(life[0]);
  return {0,
          level[0],
          level[1],
          level[2],
          passed_of(left_over, all),
          any ? life[0] : 0,
          any ? life[1] : 0,
          any ? life[2] : 0};
}

// One for each thread: a forecast would otherwise spend a tenth of its time on memory.
const LivesSample& NodeLives::sample(const Nodes& nodes, const std::vector<double>& weight,
                                     const UnitReading& last, const std::vector<NodePath>& paths,
                                     const NodeAxis* axis) const {
  static thread_local OfAll sums;
  sums.begin(parts * nodes.count());
  look_ahead(nodes, weight, last, paths, points_of_node, sums, axis);
  sums.end();
  return sums;
}

LivesSample NodeLives::lives(const Nodes& nodes, const std::vector<double>& weight,
                             const UnitReading& last, const std::vector<NodePath>& paths,
                             const NodeAxis* axis) const {
  return sample(nodes, weight, last, paths, axis);
}

prognosis::Forecast NodeLives::forecast(const Nodes& nodes, const std::vector<double>& weight,
                                        const UnitReading& last,
                                        const std::vector<NodePath>& paths) const {
  prognosis::Forecast forecast = sample(nodes, weight, last, paths).forecast();
  forecast.now = last.place;
  double square = 0;
  for (const double each : weight) square += each * each;
  forecast.effective = square > 0 ? 1 / square : 0;
  return forecast;
}

prognosis::ForecastQuantiles NodeLives::quantiles(const Nodes& nodes,
                                                  const std::vector<double>& weight,
                                                  const UnitReading& last,
                                                  const std::vector<NodePath>& paths) const {
  prognosis::ForecastQuantiles quantiles = sample(nodes, weight, last, paths).quantiles();
  quantiles.now = last.place;
  return quantiles;
}

prognosis::InPopulations NodeLives::by_line(const Nodes& nodes, const std::vector<double>& weight,
                                            const UnitReading& last,
                                            const std::vector<NodePath>& paths) const {
  // of one line, which have their own distribution of life
  constexpr std::size_t most_points = 160;
  OfLines sums{nodes.per_line, std::vector<OfLines::Line>(nodes.lines())};
  look_ahead(nodes, weight, last, paths, std::max(points_of_node, most_points / nodes.per_line),
             sums);
  prognosis::InPopulations found;
  for (const OfLines::Line& line : sums.lines) {
    found.passed.push_back(passed_of(line.left_over, line.all));
    found.remaining.emplace_back(line.lives, line.weight);
  }
  return found;
}

}  // namespace wearwell::formula_model
