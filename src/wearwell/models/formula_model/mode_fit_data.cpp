#include "wearwell/models/formula_model/mode_fit_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "wearwell/infer/judged_counts.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_fit_data.h"
#include "wearwell/models/formula_model/joint_failures.h"
#include "wearwell/models/formula_model/life_at_point.h"

namespace wearwell::formula_model {
namespace {

// A failure as it can have been: a life and its mode.
struct Drawn {
  double life;
  std::size_t mode;
};

class Drawing {
 public:
  Drawing(std::span<const ResponseFamily> families, const double* family_parameters, Rng& rng)
      : families_(families), family_parameters_(family_parameters), rng_(rng) {}

  Drawn draw(const JointFailure& failure) {
    if (failure.from == failure.until)
      return {failure.from, mode_at(failure.from, failure.possible)};
    // A life of the part within the interval, and its mode: accepted if it is a possible one.
    constexpr int most_tries = 200;
    Drawn drawn{};
    for (int i = 0; i < most_tries; ++i) {
      drawn.life = life_within(failure);
      drawn.mode = mode_at(drawn.life, all_of_them());
      if (failure.possible >> drawn.mode & 1) return drawn;
    }
    return {drawn.life, mode_at(drawn.life, failure.possible)};
  }

 private:
  std::uint32_t all_of_them() const { return (std::uint32_t{1} << families_.size()) - 1; }
  const double* own(std::size_t k) const {
    return family_parameters_ + k * most_response_parameters;
  }

  double log_survival_of_part(double life) const {
    double sum = 0;
    for (std::size_t k = 0; k < families_.size(); ++k)
      sum += log_survival(families_[k], life, own(k));
    return sum;
  }

  double life_within(const JointFailure& failure) {
    const double before = failure.from > 0 ? log_survival_of_part(failure.from) : 0;
    const double fails = -std::expm1(log_survival_of_part(failure.until) - before);
    const double share = rng_.uniform() * fails;
    double low = failure.from, high = failure.until;
    for (int i = 0; i < 60 && low < high; ++i) {
      const double middle = 0.5 * (low + high);
      (-std::expm1(log_survival_of_part(middle) - before) < share ? low : high) = middle;
    }
    return high;
  }

  std::size_t mode_at(double life, std::uint32_t possible) {
    std::vector<double> hazard(families_.size());
    double sum = 0;
    for (std::size_t k = 0; k < families_.size(); ++k) {
      if (!(possible >> k & 1)) continue;
      hazard[k] = std::exp(log_response_value(families_[k], {Censoring::none, life}, own(k)) -
                           log_survival(families_[k], life, own(k)));
      if (!(hazard[k] >= 0)) hazard[k] = 0;
      sum += hazard[k];
    }
    double left = rng_.uniform() * sum;
    std::size_t last = static_cast<std::size_t>(std::countr_zero(possible));
    for (std::size_t k = 0; k < families_.size(); ++k) {
      if (!(hazard[k] > 0)) continue;
      last = k;
      left -= hazard[k];
      if (left < 0) break;
    }
    return last;
  }

  std::span<const ResponseFamily> families_;
  const double* family_parameters_;
  Rng& rng_;
};

// What the check judges: rows with their counts. A failure that is drawn given the parameters is drawn for each of its
// items: one draw for all of them would scatter too much.
struct JudgedItems {
  std::vector<std::size_t> first;  // of each row; one more for the end
  std::vector<std::size_t> row;
  std::vector<int> count;
  double share = 1;  // of the items of each row

  explicit JudgedItems(const FormulaModel& model) {
    const std::size_t n = model.lives.rows.size();
    const std::vector<int> judged = judged_counts(model.lives.counts, n, n, share);
    std::vector<bool> is_drawn(n);
    for (const JointFailure& each : model.joint) is_drawn[each.row] = true;
    for (std::size_t i = 0; i < n; ++i) {
      first.push_back(row.size());
      const int items = is_drawn[i] ? std::max(1, judged[i]) : 1;
      row.insert(row.end(), static_cast<std::size_t>(items), i);
      count.insert(count.end(), static_cast<std::size_t>(items),
                   is_drawn[i] ? std::min(1, judged[i]) : judged[i]);
    }
    first.push_back(row.size());
  }

  // The same for each mode.
  template <class T>
  std::vector<T> for_each_mode(const FormulaModel& model, const std::vector<T>& by_row) const {
    std::vector<T> all;
    for (std::size_t k = 0; k < model.measured.size(); ++k)
      for (const std::size_t i : row) all.push_back(by_row[i]);
    return all;
  }
};

class ModeScores {
 public:
  ModeScores(std::shared_ptr<const FormulaRows> rows, std::shared_ptr<const JudgedItems> items)
      : rows_(std::move(rows)), items_(std::move(items)) {}

  std::vector<NormalScore> operator()(const double* x) const {
    const FormulaModel& model = rows_->model();
    const std::size_t n = items_->row.size();
    UnitRows& units = rows_->mine().rows;
    units.move_to(x);
    const std::vector<std::vector<double>> family_parameters = units.each_family_parameter({});
    std::vector<NormalScore> scores(n * model.measured.size());
    for (std::size_t k = 0; k < model.measured.size(); ++k) {
      const Measured& mode = model.measured[k];
      for (std::size_t i = 0; i < mode.observed.rows.size(); ++i)
        scores[k * n + items_->first[mode.observed.rows[i]]] =
            score_of(*mode.form, mode.observed.responses[i],
                     &family_parameters[k][i * most_response_parameters]);
    }
    Rng rng = lots_at(x, model.parameters.size());
    JointFailures joint(model, model.lives.rows.size());
    joint.evaluate({x, model.parameters.size()});
    for (std::size_t i = 0; i < joint.failures().size(); ++i) {
      const JointFailure& failure = joint.failures()[i];
      Drawing drawing(joint.families(), joint.family_parameters(i), rng);
      for (std::size_t e = items_->first[failure.row]; e < items_->first[failure.row + 1]; ++e) {
        const Drawn drawn = drawing.draw(failure);
        Response y = model.lives.responses[failure.row];
        y.at = drawn.life;
        for (std::size_t k = 0; k < model.measured.size(); ++k) {
          y.seen = k == drawn.mode ? Censoring::none : Censoring::right;
          scores[k * n + e] =
              as_drawn(score_of(*model.measured[k].form, y,
                                joint.family_parameters(i) + k * most_response_parameters));
        }
      }
    }
    return scores;
  }

 private:
  std::shared_ptr<const FormulaRows> rows_;
  std::shared_ptr<const JudgedItems> items_;
};

void add_conditions(const FormulaModel& model, const JudgedItems& items, FitData& data) {
  for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
    const bool used =
        std::any_of(model.measured.begin(), model.measured.end(),
                    [c](const Measured& each) { return each.program.uses_column(c); });
    const std::string& name = model.row_symbols.columns[c].name;
    if (used)
      data.drivers.push_back({name, items.for_each_mode(model, model.data.number(name)->values)});
  }
  for (const LabelColumn& column : model.data.labels) {
    if (column.name == "status") continue;
    const std::vector<std::size_t> level(column.at.begin(), column.at.end());
    data.labels.push_back({column.name, items.for_each_mode(model, level)});
  }
}

MeasuredValues exact_lives(std::shared_ptr<const FormulaRows> rows,
                           std::shared_ptr<const JudgedItems> items) {
  const FormulaModel& model = rows->model();
  const Unit& unit = model.measured.front().unit;
  const std::size_t n = model.lives.rows.size();
  MeasuredValues values;
  for (std::size_t k = 0; k < model.measured.size(); ++k) {
    for (const std::size_t i : items->row) {
      const bool exact = model.modes->possible[i] == std::uint32_t{1} << k &&
                         model.lives.responses[i].seen == Censoring::none;
      values.value.push_back(exact ? from_si(unit, model.lives.responses[i].at) : NAN);
      values.unit.push_back(unit.scale);
    }
  }
  values.log_density = [rows, items, n](const double* x) {
    UnitRows& units = rows->mine().rows;
    units.move_to(x);
    std::vector<double> by_row(n);
    const auto terms = units.each_term({});
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const std::vector<std::size_t>& row = rows->model().measured[k].observed.rows;
      for (std::size_t i = 0; i < row.size(); ++i) by_row[row[i]] += terms[k][i];
    }
    return items->for_each_mode(rows->model(), by_row);
  };
  return values;
}

}  // namespace

NormalScore as_drawn(const NormalScore& score) {
  constexpr double width = 1e-9;
  if (!score.exact() || !std::isfinite(score.low)) return score;
  return {score.low, score.low + width * (1 + std::abs(score.low))};
}

FitData mode_fit_data(std::shared_ptr<const FormulaRows> rows) {
  const FormulaModel& model = rows->model();
  FitData data;
  const auto items = std::make_shared<const JudgedItems>(model);
  data.scores = ModeScores(rows, items);
  for (std::size_t k = 0; k < model.measured.size(); ++k)
    data.counts.insert(data.counts.end(), items->count.begin(), items->count.end());
  data.share = items->share;
  data.terms = false;  // a row is one factor, but has a residual for each mode
  data.noun = "residual";
  for (std::size_t k = 0; k < model.measured.size(); ++k) {
    for (const std::size_t i : items->row) {
      data.column.push_back(k);
      data.names.push_back(fmt::format("row {}, as to {},", i + 1, model.modes->modes[k]));
    }
  }
  add_conditions(model, *items, data);
  data.measured = exact_lives(rows, items);
  data.remedies.scatter =
      "Use an expression of conditions for the scatter (or shape) of the mode, or another family.";
  return data;
}

}  // namespace wearwell::formula_model
