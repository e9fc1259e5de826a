#include "wearwell/law/state.h"

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace wearwell::law {
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

  // After `value`.
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

// From `from` to `to`. False where the state leaves all bounds before; NaN where it cannot be told.
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

}  // namespace

struct StateSolver::Body {
  Body(const StatePlan& plan, const StateStart& begins)
      : rate(plan),
        start(begins),
        one(make_stepper()),
        many(make_stepper()),
        x(plan.inputs.size() + 2),
        kept(x),
        partial(x.size()),
        single(1),
        single_kept(1) {}

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

  // The slopes of the state at the end by itself at the beginning and by each input, in `partial`
  // from 1 on.
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

  Rate rate;
  StateStart start;
  Stepper one;
  Stepper many;
  Numbers x, kept, partial, single, single_kept;
};

StateSolver::StateSolver(const StatePlan& plan, const StateStart& start)
    : body_(std::make_unique<Body>(plan, start)) {
  // The steppers take their memory at their first step.
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
  for (std::size_t i = 0; i < rows.count; ++i) {
    if (rows.starts[i] != 0 || i == 0) {
      now = rows.beginning[i];
      s = body_->first(rows, i);
    }
    body_->rate.set_inputs(rows, i);
    now = body_->advance(now, s, rows.axis[i]);
    s = rows.axis[i];
    state[i] = now;
  }
}

void StateSolver::reverse(const StateRows& rows, const double* state, const double* adjoint,
                          StateAdjoints& to) {
  double carried = 0;
  for (std::size_t i = rows.count; i-- > 0;) {
    const bool first = rows.starts[i] != 0 || i == 0;
    const double give = carried + adjoint[i];
    carried = 0;
    if (give != 0) {
      body_->rate.set_inputs(rows, i);
      const double before = first ? rows.beginning[i] : state[i - 1];
      const double from = first ? body_->first(rows, i) : rows.axis[i - 1];
      body_->sensitivities(before, from, rows.axis[i]);
      for (std::size_t j = 0; j < to.inputs.size(); ++j) {
        if (to.inputs[j] == nullptr) continue;
        to.inputs[j][rows.inputs[j].uniform ? 0 : i] += give * body_->partial[j + 2];
      }
      carried = give * body_->partial[1];
    }
    if (first && to.beginning != nullptr) to.beginning[rows.beginning.uniform ? 0 : i] += carried;
    if (first) carried = 0;
  }
}

}  // namespace wearwell::law
