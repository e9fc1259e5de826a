#include "wearwell/models/ownlaw/node_lives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/ownlaw/node_points.h"
#include "wearwell/models/ownlaw/nodes_ahead.h"
#include "wearwell/models/ownlaw/own_first_passage.h"
#include "wearwell/models/ownlaw/own_limit.h"
#include "wearwell/prognosis/weighted_quantiles.h"

namespace wearwell::ownlaw {
NodeLives::NodeLives(const TomlReader& root, std::shared_ptr<const OwnLaw> law)
    : law_(std::move(law)), limit_() {
  const auto predict = root.table("predict");
  if (!predict || !predict->has("limit") || !law_->along) {
    root.fail("predict",
              "has no limit: units are followed towards one; give along = \"distance\" and limit = "
              "{ wear = \"100 um\" }");
  }
  const Asked asked(*predict, law_, nullptr);
  given_ = asked.given;
  noun_ = asked.noun;
  const TomlReader limits = predict->required_table("limit");
  name_ = limits.keys().front();
  wanted_ = {{"[predict] limit", name_}};
  if (law_->has_process()) {
    while (column_ < law_->measured.size() &&
           !(law_->measured[column_].process && law_->measured[column_].column == name_)) {
      ++column_;
    }
    if (column_ == law_->measured.size()) limits.fail(name_, "is no process");
    process_ = law_->measured[column_].process;
    const auto& slots = law_->measured[column_].wanted;
    wanted_.assign(slots.begin(), slots.begin() + 2);
  }
  path_.next = make_path(law_, limits, name_, wanted_, true, conditions_of_unit(*law_, 0, given_));
  limit_ = limits.required_quantity(
      name_, law::si_text(process_ ? law_->measured[column_].powers
                                   : path_.next->program.outputs()[0].powers));
  path_.limit = limit_.si();
  set_reach(asked, path_);
  if (path_.next->running) {
    steps_ = path_.next->running->steps;
    row_length_ = path_.next->running->row_length;
  }
  program_ = std::make_unique<const NodeProgram>(*law_, wanted_, true);
}

std::string NodeLives::before_begin(double place, bool follows) const {
  if (!(place < path_.begin) || (path_.begin < 0 && !follows)) return {};
  const Unit& unit = law_->data.number(*law_->along)->unit.unit;
  return fmt::format("{} = {:.6g} {} lies before {:.6g}, where paths begin", *law_->along,
                     from_si(unit, place), unit.text, from_si(unit, path_.begin));
}

UnitReading NodeLives::before_rows() const {
  UnitReading row;
  for (const law::ColumnSymbol& each : law_->row_symbols.columns) {
    row.row.numbers.push_back(law_->data.number(each.name)->values.front());
    if (law_->along == each.name) row.row.numbers.back() = path_.begin;
  }
  for (const law::LabelSymbol& each : law_->row_symbols.labels) {
    row.row.labels.push_back(law_->data.label(each.name)->at.front());
  }
  row.row = conditions(row.row);
  row.place = path_.begin;
  return row;
}

NodeRow NodeLives::conditions(const NodeRow& last) const {
  NodeRow ahead = last;
  for (std::size_t c = 0; c < ahead.numbers.size(); ++c) {
    const auto at = given_.numbers.find(law_->row_symbols.columns[c].name);
    if (at != given_.numbers.end()) ahead.numbers[c] = at->second;
  }
  for (std::size_t l = 0; l < ahead.labels.size(); ++l) {
    const auto at = given_.labels.find(law_->row_symbols.labels[l].name);
    if (at != given_.labels.end()) ahead.labels[l] = at->second;
  }
  return ahead;
}

prognosis::Forecast NodeLives::forecast(const Nodes& nodes, const std::vector<double>& weight,
                                        const UnitReading& last,
                                        const std::vector<NodePath>& paths) const {
  prognosis::Forecast forecast;
  forecast.now = last.place;
  const double sign = path_.rising ? 1 : -1;
  std::vector<double> levels, level_weight, lives, life_weight;
  for (auto* each : {&levels, &level_weight, &lives, &life_weight})
    each->reserve(parts * nodes.count());
  Ahead ahead(*this, nodes, last, paths.back());
  double square = 0, left_over = 0, all = 0;
  for (const double each : weight) square += each * each;
  const std::size_t line = law_->effects.size() == 1 ? nodes.per_line : 1;
  const std::size_t pass = most_crossings / line * line;  // whole lines
  for (std::size_t begin = 0; begin < nodes.count(); begin += pass) {
    ahead.begin = begin;
    ahead.count = std::min(pass, nodes.count() - begin);
    const std::span<const double> own = std::span(weight).subspan(begin, ahead.count);
    if (std::all_of(own.begin(), own.end(), [](double w) { return w < 1e-14; })) continue;
    double level[most_crossings], start[most_crossings], place[most_crossings];
    ahead.now(0, level);
    std::fill_n(start, ahead.count, last.place);
    if (ahead.changes) ahead.cross(level, start);
    if (!process_) {
      double limit[most_crossings];
      std::fill_n(limit, ahead.count, path_.limit);
      ahead.cross(limit, place);
      ahead.count_from(start, place);
      const DrawnLines drawn(own, line);
      drawn.put({level, ahead.count}, [&](double w, double value) {
        levels.push_back(value);
        level_weight.push_back(w);
      });
      drawn.put({place, ahead.count}, [&](double w, double life) {
        all += w;
        if (!(life > 0)) return;
        lives.push_back(life);
        life_weight.push_back(w);
        left_over += w;
      });
      continue;
    }
    // A path whose increments are random: where it stands, and the law of its first passage from there.
    const NodePath& path = paths[column_];
    double far[most_crossings], scale[most_crossings];
    std::fill_n(far, ahead.count, std::max(last.place, path_.begin + path_.scale));
    ahead.evaluate(ahead.ahead, far);
    for (std::size_t i = 0; i < ahead.count; ++i) {
      const double spread = ahead.at(1, i);
      scale[i] = process_->by_sd ? spread * spread / std::abs(ahead.at(0, i)) : spread;
    }
    const bool noisy = path.measured && !path.variance.empty();
    for (std::size_t k = 0; k < points_of_node; ++k) {
      double target[most_crossings];
      std::vector<double> share(ahead.count);
      for (std::size_t i = 0; i < ahead.count; ++i) {
        const std::size_t node = begin + i;
        const double one = own[i] / points_of_node;
        all += one;
        const double p =
            (static_cast<double>(k) + fraction(node, 0.6180339887498949)) / points_of_node;
        const double stands = !path.measured ? 0 : noisy ? path.at[node] : path.reading;
        const double sd = noisy ? std::sqrt(path.variance[node]) : 0;
        double left = sign * (path_.limit - stands);
        levels.push_back(stands + (sd > 0 ? sd * normal_quantile(p) : 0));
        level_weight.push_back(one);
        const double below = sd > 0 ? normal_cdf(left / sd) : left > 0 ? 1 : 0;
        share[i] = one * below;
        target[i] = path.measured ? path.mean[node] : 0;
        if (!(share[i] > 1e-14)) continue;
        if (sd > 0) {  // where it stands, given that it is not there
          const double q = fraction(points_of_node * node + k, 0.7548776662466927);
          left -= sd * normal_quantile(std::max(q * below, 1e-300));
        }
        double values[ScoreTable::edges];
        ScoreTable::passages(process_->process).look_up(std::max(left, 1e-300), scale[i], values);
        target[i] += sign * at_score(values, normal_quantile(p));
      }
      ahead.cross(target, place);
      for (std::size_t i = 0; i < ahead.count; ++i) {
        // Passed since its last reading, where the last row has none.
        if (!(share[i] > 1e-14) || place[i] < start[i]) continue;
        left_over += share[i];
        lives.push_back(place[i] - start[i]);
        life_weight.push_back(share[i]);
      }
    }
  }
  const std::vector<double> level =
      prognosis::weighted_quantiles(levels, level_weight, std::array{0.05, 0.5, 0.95});
  forecast.level05 = level[0];
  forecast.level50 = level[1];
  forecast.level95 = level[2];
  forecast.passed = all > 0 ? std::clamp(1 - left_over / all, 0.0, 1.0) : std::nan("");
  forecast.remaining = prognosis::WeightedLives(lives, life_weight);
  forecast.effective = square > 0 ? 1 / square : 0;
  return forecast;
}

}  // namespace wearwell::ownlaw
