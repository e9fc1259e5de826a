#include "wearwell/formula/state.h"

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "wearwell/formula/trajectory.h"

// Longer than others: one solver, by steps and along trajectories, forward and backward.
namespace wearwell::formula {
namespace {

namespace odeint = boost::numeric::odeint;

using Numbers = std::vector<double>;

constexpr int most_steps = 20000;
constexpr double relative = 1e-11;

// The rate and its derivatives, on numbers.
class Rate {
 public:
  explicit Rate(const StatePlan& plan)
      : plan_(plan), numbers_(plan.numbers), adjoints_(plan.numbers.size()) {}

  void set_inputs(const StateRows& rows, std::size_t i) {
    for (std::size_t j = 0; j < rows.inputs.size(); ++j)
      numbers_[static_cast<std::size_t>(plan_.first_input) + j] = rows.inputs[j][i];
  }

  double value(double state, double axis) {
    if (plan_.state >= 0) numbers_[static_cast<std::size_t>(plan_.state)] = state;
    if (plan_.running >= 0) numbers_[static_cast<std::size_t>(plan_.running)] = axis;
    for (const Step& step : plan_.steps)
      step.kernels.forward(at(step.a), at(step.b), at(step.c), &number(step.out), 1, step.extra);
    return number(plan_.result);
  }

  // Call after `value`.
  void differentiate() {
    std::fill(adjoints_.begin(), adjoints_.end(), 0.0);
    adjoints_[static_cast<std::size_t>(plan_.result)] = 1;
    for (std::size_t i = plan_.steps.size(); i-- > 0;) {
      const Step& step = plan_.steps[i];
      step.kernels.reverse(at(step.a), at(step.b), at(step.c), &number(step.out), adjoint(step.out),
                           adjoint(step.a), adjoint(step.b), adjoint(step.c), 1, step.extra, 0);
    }
  }
  double by_state() const {
    return plan_.state < 0 ? 0 : adjoints_[static_cast<std::size_t>(plan_.state)];
  }
  double by_input(std::size_t j) const {
    return adjoints_[static_cast<std::size_t>(plan_.first_input) + j];
  }

 private:
  double& number(int i) { return numbers_[static_cast<std::size_t>(i)]; }
  const double* at(int i) { return i < 0 ? nullptr : &number(i); }
  double* adjoint(int i) { return i < 0 ? nullptr : &adjoints_[static_cast<std::size_t>(i)]; }

  const StatePlan& plan_;
  Numbers numbers_, adjoints_;
};

using Fehlberg = odeint::runge_kutta_fehlberg78<Numbers>;
using Stepper = odeint::controlled_runge_kutta<Fehlberg>;

Stepper make_stepper() {
  using Checker =
      odeint::default_error_checker<double, Fehlberg::algebra_type, Fehlberg::operations_type>;
  return Stepper(Checker(std::numeric_limits<double>::min(), relative));
}

// From `from` to `to`. False if the state diverges before the end; NaN if it cannot be computed.
template <class F>
bool integrate(Stepper& stepper, const F& rate, Numbers& x, Numbers& kept, double from, double to) {
  double s = from, h = to - from;
  for (int i = 0; i < most_steps && s < to; ++i) {
    if (!(h > 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(s), to - from)))
      return false;
    const bool last = s + h >= to;
    if (last) h = to - s;
    kept = x;
    const double before = s, tried = h;
    const auto outcome = stepper.try_step(rate, x, s, h);
    if (!std::all_of(x.begin(), x.end(), [](double each) { return std::isfinite(each); })) {
      if (!std::isfinite(kept[0])) return true;
      x = kept;
      s = before;
      h = 0.1 * tried;
      continue;
    }
    if (outcome == odeint::success && last) return true;
  }
  if (s < to) x[0] = std::numeric_limits<double>::quiet_NaN();
  return true;
}

// Trajectories of the shape, and the positions of a call's rows on them.
class SharedPaths {
 public:
  explicit SharedPaths(const StatePlan& plan) : plan_(plan), key_(plan.inputs.size()) {}

  struct Row {
    Trajectory* on = nullptr;    // null: solved by steps
    double before = 0, now = 0;  // positions on it at the previous row and here
  };
  const Row& row(std::size_t i) const { return rows_[i]; }

  void begin_call(std::size_t rows) {
    constexpr std::size_t most_kept = 64;
    if (used_ > most_kept) used_ = 0;
    rows_.assign(rows, {});
  }

  // The state at row i, a distance `way` along the axis after `state`; empty if no trajectory
  // covers it.
  std::optional<double> advance(const StateRows& rows, std::size_t i, bool first, double state,
                                double way) {
    Row& row = rows_[i];
    const bool stays = !first && rows_[i - 1].on != nullptr && same_inputs(rows, i);
    if (stays) {
      row = {rows_[i - 1].on, rows_[i - 1].now, 0};
    } else {
      if (first) anchor_ = rows.anchor[i];
      if (!std::isfinite(state)) return {};
      row.on = find(rows, i);
      row.before = row.on->place(state);
    }
    row.now = row.before + factor(rows, i) * way;
    if (!(row.now >= row.before)) {  // decreasing, or NaN
      row.on = nullptr;
      return {};
    }
    if (row.now == row.before) return state;
    if (row.on->reach(row.now)) return row.on->state(row.now);
    const bool blown = row.on->blows_up();
    const double sign = row.on->sign();
    row.on = nullptr;
    if (!blown) return {};
    return std::copysign(std::numeric_limits<double>::infinity(), sign);
  }

  double factor(const StateRows& rows, std::size_t i) const {
    if (plan_.factor < 0) return 1;
    const std::size_t j = factor_input();
    return j < plan_.inputs.size() ? rows.inputs[j][i]
                                   : plan_.numbers[static_cast<std::size_t>(plan_.factor)];
  }
  // Its index is beyond the inputs if the factor is constant.
  std::size_t factor_input() const {
    return static_cast<std::size_t>(plan_.factor - plan_.first_input);
  }

 private:
  bool same_inputs(const StateRows& rows, std::size_t i) const {
    for (std::size_t j = 0; j < rows.inputs.size(); ++j) {
      if (!plan_.shape_inputs[j] || rows.inputs[j].uniform) continue;
      if (rows.inputs[j][i] != rows.inputs[j][i - 1]) return false;
    }
    return true;
  }

  Trajectory* find(const StateRows& rows, std::size_t i) {
    for (std::size_t j = 0; j < key_.size(); ++j) key_[j] = rows.inputs[j][i];
    for (std::size_t k = used_; k-- > 0;) {
      if (all_[k]->is(anchor_, key_)) return all_[k].get();
    }
    if (used_ == all_.size()) all_.push_back(std::make_unique<Trajectory>(plan_));
    all_[used_]->begin(anchor_, key_);
    return all_[used_++].get();
  }

  const StatePlan& plan_;
  std::vector<std::unique_ptr<Trajectory>> all_;
  std::size_t used_ = 0;
  std::vector<Row> rows_;
  Numbers key_;
  double anchor_ = 0;
};

}  // namespace

struct StateSolver::Body {
  Body(const StatePlan& plan_of, const StateStart& begins)
      : plan(plan_of),
        rate(plan_of),
        start(begins),
        one(make_stepper()),
        many(make_stepper()),
        x(plan.inputs.size() + 2),
        kept(x),
        partial(x.size()),
        single(1),
        single_kept(1) {
    if (plan.shape >= 0) shared.emplace(plan);
  }

  double first(const StateRows& rows, std::size_t i) const {
    if (rows.from != nullptr) return rows.from[i];
    return start.at_first_row ? rows.axis[i] : start.at;
  }

  // The state at the end of an interval.
  double advance(double state, double from, double to) {
    if (to == from || !std::isfinite(state)) return state;
    single[0] = state;
    const auto slope = [&](const Numbers& at, Numbers& result, double s) {
      result[0] = rate.value(at[0], s);
    };
    const double direction = rate.value(state, from);
    if (std::isnan(direction)) return direction;
    if (integrate(one, slope, single, single_kept, from, to)) return single[0];
    const double towards = rate.value(single_kept[0], to);
    if (std::isnan(towards)) return towards;
    return std::copysign(std::numeric_limits<double>::infinity(), towards);
  }

  // The derivatives of the final state by the initial state and by each input, in `partial` from
  // index 1.
  void sensitivities(double state, double from, double to) {
    std::fill(x.begin(), x.end(), 0.0);
    x[0] = state;
    x[1] = 1;
    const auto slope = [&](const Numbers& at, Numbers& result, double s) {
      result[0] = rate.value(at[0], s);
      rate.differentiate();
      const double by_state = rate.by_state();
      result[1] = by_state * at[1];
      for (std::size_t j = 2; j < at.size(); ++j)
        result[j] = by_state * at[j] + rate.by_input(j - 2);
    };
    if (to > from) integrate(many, slope, x, kept, from, to);
    partial = x;
  }

  // The contributions of row i to the inputs and to the previous state; false if no trajectory
  // covers it.
  bool give_along(const StateRows& rows, std::size_t i, double way, double give, StateAdjoints& to,
                  double& carried) {
    constexpr double least = 1e-9;  // relative rate below which the ratio of rates is unreliable
    if (!shared) return false;
    const SharedPaths::Row& row = shared->row(i);
    if (row.on == nullptr) return false;
    if (row.now == row.before) {
      carried = give;
      return true;
    }
    if (last.on != row.on || last.t != row.now) {
      last = {row.on, row.now, 0, std::move(last.by_input)};
      row.on->slopes(row.now, last.rate, last.by_input);
    }
    next = {row.on, row.before, row.on->rate_at_anchor(), std::move(next.by_input)};
    if (row.before > 0) {
      row.on->slopes(row.before, next.rate, next.by_input);
    } else {
      next.by_input.assign(plan.inputs.size(), 0.0);
    }
    if (!(std::abs(next.rate) > least * std::abs(row.on->rate_at_anchor()))) return false;
    const double ratio = last.rate / next.rate;
    carried = give * ratio;
    for (std::size_t j = 0; j < to.inputs.size(); ++j) {
      if (to.inputs[j] == nullptr) continue;
      double by = j == shared->factor_input() ? last.rate * way : 0;
      if (plan.shape_inputs[j]) by += last.by_input[j] - ratio * next.by_input[j];
      to.inputs[j][rows.inputs[j].uniform ? 0 : i] += give * by;
    }
    std::swap(last, next);
    return true;
  }

  // A position on a trajectory.
  struct Place {
    const Trajectory* on = nullptr;
    double t = 0, rate = 0;
    Numbers by_input;
  };

  const StatePlan& plan;
  Place last, next;  // the beginning of the last row, and of the row before it
  Rate rate;
  std::optional<SharedPaths> shared;
  StateStart start;
  Stepper one;
  Stepper many;
  Numbers x, kept, partial, single, single_kept;
};

StateSolver::StateSolver(const StatePlan& plan, const StateStart& start)
    : body_(std::make_unique<Body>(plan, start)) {
  // The steppers allocate at their first step.
  const auto rest = [](const Numbers& at, Numbers& result, double) {
    result.assign(at.size(), 0.0);
  };
  double s = 0, h = 1;
  Numbers one(1), many(plan.inputs.size() + 2);
  body_->one.try_step(rest, one, s, h);
  body_->many.try_step(rest, many, s, h);
}
StateSolver::StateSolver(StateSolver&&) noexcept = default;
StateSolver& StateSolver::operator=(StateSolver&&) noexcept = default;
StateSolver::~StateSolver() = default;

void StateSolver::forward(const StateRows& rows, double* state) {
  double now = 0, s = 0;
  if (body_->shared) body_->shared->begin_call(rows.count);
  for (std::size_t i = 0; i < rows.count; ++i) {
    const bool first = rows.starts[i] != 0 || i == 0;
    if (first) {
      now = rows.beginning[i];
      s = body_->first(rows, i);
    }
    std::optional<double> known;
    if (body_->shared) known = body_->shared->advance(rows, i, first, now, rows.axis[i] - s);
    if (!known) {
      body_->rate.set_inputs(rows, i);
      known = body_->advance(now, s, rows.axis[i]);
    }
    s = rows.axis[i];
    state[i] = now = *known;
  }
}

void StateSolver::reverse(const StateRows& rows, const double* state, const double* adjoint,
                          StateAdjoints& to) {
  double carried = 0;
  body_->last.on = nullptr;
  for (std::size_t i = rows.count; i-- > 0;) {
    const bool first = rows.starts[i] != 0 || i == 0;
    const double give = carried + adjoint[i];
    carried = 0;
    if (give != 0) {
      const double from = first ? body_->first(rows, i) : rows.axis[i - 1];
      if (!body_->give_along(rows, i, rows.axis[i] - from, give, to, carried)) {
        body_->rate.set_inputs(rows, i);
        body_->sensitivities(first ? rows.beginning[i] : state[i - 1], from, rows.axis[i]);
        for (std::size_t j = 0; j < to.inputs.size(); ++j) {
          if (to.inputs[j] == nullptr) continue;
          to.inputs[j][rows.inputs[j].uniform ? 0 : i] += give * body_->partial[j + 2];
        }
        carried = give * body_->partial[1];
      }
    }
    if (first && to.beginning != nullptr) to.beginning[rows.beginning.uniform ? 0 : i] += carried;
    if (first) carried = 0;
  }
}

}  // namespace wearwell::formula
