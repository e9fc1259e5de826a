#include "wearwell/models/ownlaw/node_lives.h"

#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/ownlaw/crossing_search.h"
#include "wearwell/models/ownlaw/own_first_passage.h"
#include "wearwell/models/ownlaw/own_limit.h"

namespace wearwell::ownlaw {
namespace {

constexpr std::size_t points_of_node = 4;  // of the law of a first passage

double normal_quantile(double p) {
  return -std::sqrt(2.0) * boost::math::erfc_inv(2 * p);
}

double fraction(std::size_t i, double of) {
  const double x = (static_cast<double>(i) + 0.5) * of;
  return x - std::floor(x);
}

// On the logarithms of neighbours in a table of normal scores -4, -3.6 .. 4, by the cubic through four of them.
double at_score(const double* values, double score) {
  const double x = std::clamp((score + 4) / 0.4, 0.0, 20.0);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(x), 1.0, 18.0));
  const double t = x - static_cast<double>(i);
  const double weight[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                           -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  double sum = 0;
  for (std::size_t j = 0; j < 4; ++j) sum += weight[j] * std::log(values[i + j - 1]);
  return std::exp(sum);
}

constexpr int parts = 4;             // of a node's place on its line
constexpr double negligible = 1e-8;  // nodes with less are left out

// What nodes of one line have, drawn out between them: a parabola through each and its neighbours, of the logarithm
// of the weight and of the number. The sum of the weights is that of the trapezoidal rule with a step so much finer.
template <class Put>
void draw_out(std::span<const double> weight, std::span<const double> number, const Put& put) {
  const std::size_t n = weight.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (!(weight[k] > negligible)) continue;
    const bool inner = k > 0 && k + 1 < n && weight[k - 1] > 0 && weight[k + 1] > 0 &&
                       std::isfinite(number[k - 1] + number[k] + number[k + 1]);
    if (!inner) {
      put(weight[k], number[k]);
      continue;
    }
    const double before = std::log(weight[k - 1] / weight[k]);
    const double behind = std::log(weight[k + 1] / weight[k]);
    const double below = number[k - 1] - number[k], above = number[k + 1] - number[k];
    for (int part = 0; part < parts; ++part) {
      const double t = (part + 0.5) / parts - 0.5;
      const double bend = 0.5 * t * t, slope = 0.5 * t;
      put(weight[k] / parts * std::exp(slope * (behind - before) + bend * (behind + before)),
          number[k] + slope * (above - below) + bend * (above + below));
    }
  }
}

double output(const NodeProgram& program, const NodeProgram::Scratch& scratch, std::size_t o,
              std::size_t i) {
  const std::span<const double> values = program.values(o, scratch);
  return values[values.size() == 1 ? 0 : i];
}

}  // namespace

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

// Nodes of one pass on their way.
struct NodeLives::Ahead {
  const NodeLives& lives;
  const Nodes& nodes;
  const UnitReading& last;
  const NodePath* path;  // of what is limited, where it runs
  NodeRow own, ahead;
  bool runs, changes = false;
  NodeProgram::Scratch scratch;
  std::size_t begin = 0, count = 0;
  double passed_by[most_crossings] = {};

  Ahead(const NodeLives& of, const Nodes& at, const UnitReading& row, const NodePath& limited)
      : lives(of),
        nodes(at),
        last(row),
        path(&limited),
        own(row.row),
        ahead(of.conditions(row.row)),
        runs(of.program_->running() > 0),
        scratch(*of.program_) {
    for (std::size_t c = 0; c < own.numbers.size(); ++c) {
      const bool differs = own.numbers[c] != ahead.numbers[c];
      changes |= of.program_->uses_column(c) && differs;
    }
    for (std::size_t l = 0; l < own.labels.size(); ++l) {
      changes |= of.program_->uses_label(l) && own.labels[l] != ahead.labels[l];
    }
    changes &= !runs;
  }

  // Where paths are looked at from.
  double from() const { return runs && path->begun ? path->place : lives.path_.begin; }

  void evaluate(const NodeRow& row, const double* place) {
    NodeProgram::GoesOn on;
    if (runs) {
      on = {from(), path->begun ? &path->carried : nullptr, &lives.steps_, lives.row_length_};
    }
    lives.program_->evaluate(nodes, begin, count, row, place, on, scratch);
  }
  double at(std::size_t o, std::size_t i) const { return output(*lives.program_, scratch, o, i); }

  // Output o of all nodes where the unit is now, under its own conditions.
  void now(std::size_t o, double* value) {
    double place[most_crossings];
    std::fill_n(place, count, last.place);
    evaluate(runs ? ahead : own, place);
    for (std::size_t i = 0; i < count; ++i) value[i] = at(o, i);
  }

  // Makes of places what remains: negative where the limit is behind. A path that goes on knows no place before
  // its last row: there as far as it has passed the limit, at the pace of the fastest of its neighbours.
  void count_from(const double* start, double* place) const {
    double pace = 0;
    for (std::size_t i = 0; i < count; ++i) {
      place[i] -= start[i];
      if (!(passed_by[i] < 0 && std::isfinite(place[i]))) continue;
      const double own_pace = place[i] / -passed_by[i];
      pace = pace > 0 ? std::min(pace, own_pace) : own_pace;
    }
    for (std::size_t i = 0; runs && i < count; ++i) {
      if (passed_by[i] >= 0) place[i] = -passed_by[i] * (pace > 0 ? pace : 1);
    }
  }

  void cross(const double* level, double* place) {
    search_crossings(
        lives.path_.rising, from(), lives.path_.scale, count, level,
        [&](const double* trial) { evaluate(ahead, trial); },
        [&](std::size_t i) { return at(0, i); }, place, passed_by);
  }
};

prognosis::Forecast NodeLives::forecast(const Nodes& nodes, const std::vector<double>& weight,
                                        const UnitReading& last,
                                        const std::vector<NodePath>& paths) const {
  prognosis::Forecast forecast;
  forecast.now = last.place;
  const double sign = path_.rising ? 1 : -1;
  std::vector<double> levels, level_weight, lives, life_weight;
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
      for (std::size_t i = 0; i < ahead.count; i += line) {
        draw_out(own.subspan(i, line), {level + i, line}, [&](double w, double value) {
          levels.push_back(value);
          level_weight.push_back(w);
        });
        draw_out(own.subspan(i, line), {place + i, line}, [&](double w, double life) {
          all += w;
          if (!(life > 0)) return;
          lives.push_back(life);
          life_weight.push_back(w);
          left_over += w;
        });
      }
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
  const prognosis::WeightedLives level(levels, level_weight);
  forecast.level05 = level.quantile(0.05);
  forecast.level50 = level.quantile(0.5);
  forecast.level95 = level.quantile(0.95);
  forecast.passed = all > 0 ? std::clamp(1 - left_over / all, 0.0, 1.0) : std::nan("");
  forecast.remaining = prognosis::WeightedLives(lives, life_weight);
  forecast.effective = square > 0 ? 1 / square : 0;
  return forecast;
}

}  // namespace wearwell::ownlaw
