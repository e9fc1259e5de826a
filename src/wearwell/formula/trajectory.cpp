#include "wearwell/formula/trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/formula/vector_math.h"

// Longer than others: one solution, its panels, their evaluation and their derivatives.
namespace wearwell::formula {
namespace {

constexpr std::size_t lanes = RateShape::lanes;
using Lanes = RateShape::Lanes;
using Powers = std::array<double, lanes + 1>;

constexpr double most_error = 1e-13;       // of y, of a panel
constexpr double most_rate_error = 1e-11;  // of g, of a panel
constexpr double most_bend = 25;           // of a panel: the integral of dg/dy
constexpr std::size_t most_panels = 1000;
constexpr double nearly_there = 1e-10;  // relative to the time to a pole; the rest is negligible

// Chebyshev nodes x of a panel (-1, 1), with the matrices from values to coefficients and to
// integrals from -1 to each node.
struct Rule {
  Lanes x;
  std::array<Lanes, lanes> coefficient;  // [k][j]: weight of value j in coefficient k
  std::array<Lanes, lanes + 1>
      integral;  // [i][j]: weight of value j in the integral to x_i; the last row is to 1

  Rule() {
    const double n = lanes, pi = 3.14159265358979323846;
    for (std::size_t j = 0; j < lanes; ++j) {
      const double angle = pi * (static_cast<double>(j) + 0.5) / n;
      x[j] = -std::cos(angle);
      for (std::size_t k = 0; k < lanes; ++k) {
        const double at = std::cos(static_cast<double>(k) * (pi - angle));
        coefficient[k][j] = (k == 0 ? 1 : 2) / n * at;
      }
    }
    for (std::size_t i = 0; i <= lanes; ++i) {
      const double at = i == lanes ? 1 : x[i];
      for (std::size_t j = 0; j < lanes; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k < lanes; ++k) sum += coefficient[k][j] * integral_to(k, at);
        integral[i][j] = sum;
      }
    }
  }

 private:
  static double chebyshev(double k, double at) { return std::cos(k * std::acos(at)); }
  static double integral_to(std::size_t k, double at) {
    if (k == 0) return at + 1;
    if (k == 1) return 0.5 * (at * at - 1);
    const auto up = static_cast<double>(k + 1), down = static_cast<double>(k - 1);
    const double here = chebyshev(up, at) / up - chebyshev(down, at) / down;
    const double sign = k % 2 == 0 ? -1 : 1;  // T(-1) of both neighbours
    return 0.5 * (here - sign * (1 / up - 1 / down));
  }
};

const Rule& rule() {
  static const Rule made;
  return made;
}

// half * integrals of f to each node, and to the end in the last entry.
void integrate(const Lanes& f, double half, Powers& to) {
  for (std::size_t i = 0; i <= lanes; ++i) {
    const Lanes& row = rule().integral[i];
    double lane[4] = {};
    for (std::size_t j = 0; j < lanes; j += 4) {
      for (std::size_t l = 0; l < 4; ++l) lane[l] += row[j + l] * f[j + l];
    }
    to[i] = half * ((lane[0] + lane[2]) + (lane[1] + lane[3]));
  }
}

void coefficients_of(const double* values, double* to) {
  for (std::size_t k = 0; k < lanes; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < lanes; ++j) sum += rule().coefficient[k][j] * values[j];
    to[k] = sum;
  }
}

// A polynomial in powers of x. Coefficients decrease by 10^-11 or more over a panel, so there is no
// cancellation.
double value_of(const double* c, double x) {
  const double x2 = x * x, x4 = x2 * x2;
  const auto four = [&](const double* p) { return (p[0] + p[1] * x) + (p[2] + p[3] * x) * x2; };
  const double low = four(c) + four(c + 4) * x4, high = four(c + 8) + four(c + 12) * x4;
  return low + (high + c[16] * (x4 * x4)) * (x4 * x4);
}

// Converts 17 Chebyshev coefficients to powers.
void make_powers(Powers& c) {
  static const auto table = [] {
    std::array<Powers, lanes + 1> t{};  // [k][power]
    t[0][0] = t[1][1] = 1;
    for (std::size_t k = 2; k <= lanes; ++k) {
      for (std::size_t p = 0; p <= lanes; ++p) {
        t[k][p] = (p > 0 ? 2 * t[k - 1][p - 1] : 0) - t[k - 2][p];
      }
    }
    return t;
  }();
  Powers sum{};
  for (std::size_t k = 0; k <= lanes; ++k) {
    for (std::size_t p = k % 2; p <= k; p += 2) sum[p] += c[k] * table[k][p];
  }
  c = sum;
}

double largest(const double* values, std::size_t count) {
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, std::abs(values[i]));
  return most;
}

bool all_finite(const double* values) {
  double sum = 0;
  for (std::size_t i = 0; i < lanes; ++i) sum += values[i] * 0;
  return sum == 0;
}

}  // namespace

RateShape::RateShape(const StatePlan& plan)
    : steps_(plan.shape_steps),
      numbers_(plan.numbers.size() * lanes),
      adjoints_(numbers_.size()),
      state_(plan.state),
      first_input_(plan.first_input),
      result_(plan.shape) {
  for (Step& step : steps_) step.kernels = kernels_of(step.op, 0);
  for (std::size_t i = 0; i < plan.numbers.size(); ++i) {
    std::fill_n(number(static_cast<int>(i)), lanes, plan.numbers[i]);
  }
}

void RateShape::set_input(std::size_t j, double value) {
  std::fill_n(number(first_input_ + static_cast<int>(j)), lanes, value);
}

const double* RateShape::operator()(const Lanes& state) {
  std::copy(state.begin(), state.end(), number(state_));
  const auto at = [&](int i) { return i < 0 ? nullptr : number(i); };
  for (const Step& step : steps_) {
    step.kernels.forward(at(step.a), at(step.b), at(step.c), number(step.out), lanes, step.extra);
  }
  return number(result_);
}

void RateShape::differentiate() {
  std::fill(adjoints_.begin(), adjoints_.end(), 0.0);
  std::fill_n(adjoint(result_), lanes, 1.0);
  const auto at = [&](int i) { return i < 0 ? nullptr : number(i); };
  const auto to = [&](int i) { return i < 0 ? nullptr : adjoint(i); };
  for (std::size_t i = steps_.size(); i-- > 0;) {
    const Step& step = steps_[i];
    if (step.kernels.reverse == nullptr) continue;
    step.kernels.reverse(at(step.a), at(step.b), at(step.c), number(step.out), to(step.out),
                         to(step.a), to(step.b), to(step.c), lanes, step.extra, 0);
  }
}

Trajectory::Trajectory(const StatePlan& plan)
    : shape_(plan), counts_(plan.shape_inputs), inputs_(plan.inputs.size()) {}

void Trajectory::begin(double anchor, const std::vector<double>& inputs) {
  anchor_ = anchor;
  inputs_ = inputs;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    if (counts_[j]) shape_.set_input(j, inputs[j]);
  }
  panels_ = sloped_ = last_ = 0;
  ended_ = blown_ = false;
  first_step();
}

bool Trajectory::is(double anchor, const std::vector<double>& inputs) const {
  if (anchor != anchor_) return false;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    if (counts_[j] && inputs[j] != inputs_[j]) return false;
  }
  return true;
}

// The first panel reaches half of the way to twice the anchor; from 0, as far as the rate is nearly
// constant.
void Trajectory::first_step() {
  Lanes at;
  at.fill(anchor_);
  rate_ = shape_(at)[0];
  direction_ = rate_ < 0 ? -1 : 1;
  ended_ = !std::isfinite(rate_) || rate_ == 0 || !std::isfinite(anchor_);
  if (ended_) return;
  double way = 0.5 * std::abs(anchor_);
  if (way == 0) {
    double size = 1e-24;
    for (int part = 0; part < 3; ++part) {
      for (double& each : at) {
        each = direction_ * size;
        size *= 10;
      }
      const double* g = shape_(at);
      std::size_t i = 0;
      while (i < lanes && std::abs(g[i] - rate_) < 0.5 * std::abs(rate_)) ++i;
      if (i > 0) way = std::abs(at[i - 1]);
      if (i < lanes) break;
    }
  }
  step_ = way / std::abs(rate_);
  ended_ = !(step_ > 0 && std::isfinite(step_));
}

// Newton's method: the correction solves the equation linearized at the current solution, by its
// integrating factor.
bool Trajectory::solve(double y0, double g0, double bend, double length, Panel& panel) {
  const double half = 0.5 * length;
  Lanes y, residual, by_state;
  Powers to, exponent;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double t = half * (rule().x[i] + 1), u = bend * t;
    y[i] = y0 + g0 * t * (std::abs(u) < 1e-8 ? 1 : (vector_exp(u) - 1) / u);
  }
  const auto moves = [&](const double* g) {  // moves, and in the same direction
    bool same = all_finite(g);
    for (std::size_t i = 0; i < lanes; ++i) same &= g[i] * direction_ > 0;
    return same;
  };
  bool close = false;
  for (int round = 0; round < 10 && !close; ++round) {
    const double* g = shape_(y);
    if (!moves(g)) return false;
    shape_.differentiate();
    Lanes rate;
    std::copy_n(g, lanes, rate.begin());
    std::copy_n(shape_.by_state(), lanes, by_state.begin());
    integrate(rate, half, to);
    for (std::size_t i = 0; i < lanes; ++i) residual[i] = y0 + to[i] - y[i];
    integrate(by_state, half, exponent);
    if (!(largest(exponent.data(), lanes + 1) < most_bend)) return false;
    Lanes grown;
    for (std::size_t i = 0; i < lanes; ++i) {
      grown[i] = vector_exp(exponent[i]);
      rate[i] = by_state[i] * residual[i] / grown[i];
    }
    integrate(rate, half, to);
    double change = 0, size = std::abs(y0);
    for (std::size_t i = 0; i < lanes; ++i) {
      const double move = residual[i] + grown[i] * to[i];
      y[i] += move;
      change = std::max(change, std::abs(move));
      size = std::max(size, std::abs(y[i]));
    }
    if (!std::isfinite(change)) return false;
    close = change <= 1e-10 * size;
  }
  if (!close) return false;
  const double* g = shape_(y);
  if (!moves(g)) return false;
  panel.g[lanes] = 0;
  coefficients_of(g, panel.g.data());
  panel.nodes = y;
  panel.length = length;
  panel.first = y0;
  // The integral of the sum of g.
  panel.y.fill(0);
  const auto c = [&](std::size_t k) { return k < lanes ? panel.g[k] : 0; };
  for (std::size_t k = 1; k <= lanes; ++k) {
    panel.y[k] = half * ((k == 1 ? 2 : 1) * c(k - 1) - c(k + 1)) / (2 * static_cast<double>(k));
  }
  double at_begin = 0;
  for (std::size_t k = 1; k <= lanes; ++k) at_begin += k % 2 == 0 ? panel.y[k] : -panel.y[k];
  panel.y[0] = y0 - at_begin;
  double last = 0;
  for (const double each : panel.y) last += each;
  panel.last = last;
  panel.left = largest(&panel.g[lanes - 3], 3);
  panel.size = largest(panel.g.data(), lanes);
  make_powers(panel.y);
  make_powers(panel.g);
  return std::isfinite(last) && (last - y0) * direction_ > 0;
}

// Near a pole g grows from panel to panel as these become shorter; beside a jump of g it does not.
bool Trajectory::rises_steeply() const {
  constexpr std::size_t some = 8;
  return panels_ > some && panel_[panels_ - 1].size > 4 * panel_[panels_ - 1 - some].size;
}

bool Trajectory::extend() {
  if (ended_ || panels_ == most_panels) return false;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  if (panels_ == panel_.size()) panel_.emplace_back();
  Panel& panel = panel_[panels_];
  panel.begin = end();
  const double y0 = panels_ == 0 ? anchor_ : panel_[panels_ - 1].last;
  Lanes at;
  at.fill(y0);
  const double g0 = shape_(at)[0];
  shape_.differentiate();
  const double bend = shape_.by_state()[0];
  if (std::abs(bend) * step_ > 10) step_ = 10 / std::abs(bend);
  const bool rises = rises_steeply();
  const double least = (rises ? nearly_there : 4 * epsilon) * panel.begin;
  for (int attempt = 0; attempt < 60 && step_ > least; ++attempt) {
    if (!solve(y0, g0, bend, step_, panel)) {
      step_ *= 0.4;
      continue;
    }
    const double size = std::max(std::abs(y0), std::abs(panel.last));
    const double excess = std::max(panel.left * step_ / (2 * lanes) / (most_error * size),
                                   panel.left / (most_rate_error * panel.size));
    const double next = 0.8 * std::pow(std::max(excess, 1e-12), -1.0 / (lanes - 2));
    if (excess <= 1) {
      step_ *= std::min(next, 4.0);
      ++panels_;
      return true;
    }
    step_ *= std::clamp(next, 0.1, 0.8);
  }
  ended_ = true;
  blown_ = rises && !(step_ > least);
  return false;
}

bool Trajectory::reach(double t) {
  while (end() < t) {
    if (!extend()) return false;
  }
  return panels_ > 0;
}

std::size_t Trajectory::panel_of(double t) const {
  std::size_t i = std::min(last_, panels_ - 1);
  while (i > 0 && t < panel_[i].begin) --i;
  while (i + 1 < panels_ && t >= panel_[i + 1].begin) ++i;
  return last_ = i;
}

double Trajectory::state(double t) const {
  const Panel& panel = panel_[panel_of(t)];
  return value_of(panel.y.data(), 2 * (t - panel.begin) / panel.length - 1);
}

// s' = (dg/dy) s + dg/dinput along the panel.
void Trajectory::find_slopes(std::size_t p) {
  Panel& panel = panel_[p];
  const double half = 0.5 * panel.length;
  panel.slopes.resize(inputs_.size());
  shape_(panel.nodes);
  shape_.differentiate();
  Lanes by, grown;
  Powers exponent, to;
  std::copy_n(shape_.by_state(), lanes, by.begin());
  integrate(by, half, exponent);
  for (std::size_t i = 0; i < lanes; ++i) grown[i] = vector_exp(exponent[i]);
  for (std::size_t j = 0; j < inputs_.size(); ++j) {
    if (!counts_[j]) continue;
    const double before = p == 0 ? 0 : panel_[p - 1].slopes[j].last;
    for (std::size_t i = 0; i < lanes; ++i) by[i] = shape_.by_input(j)[i] / grown[i];
    integrate(by, half, to);
    Lanes s;
    for (std::size_t i = 0; i < lanes; ++i) s[i] = grown[i] * (before + to[i]);
    Slope& slope = panel.slopes[j];
    slope.powers[lanes] = 0;
    coefficients_of(s.data(), slope.powers.data());
    make_powers(slope.powers);
    slope.last = vector_exp(exponent[lanes]) * (before + to[lanes]);
  }
}

void Trajectory::slopes(double t, double& rate, std::vector<double>& by_input) {
  const std::size_t p = panel_of(t);
  while (sloped_ <= p) find_slopes(sloped_++);
  const Panel& panel = panel_[p];
  const double x = 2 * (t - panel.begin) / panel.length - 1;
  rate = value_of(panel.g.data(), x);
  by_input.resize(inputs_.size());
  for (std::size_t j = 0; j < inputs_.size(); ++j) {
    if (counts_[j]) by_input[j] = value_of(panel.slopes[j].powers.data(), x);
  }
}

double Trajectory::place(double y) {
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  if (y == anchor_) return 0;
  const auto beyond = [&](double at) { return (y - at) * direction_ > 0; };
  if (!beyond(anchor_) || !std::isfinite(y)) return nowhere;
  while (panels_ == 0 || beyond(panel_[panels_ - 1].last)) {
    if (!extend()) return nowhere;
  }
  std::size_t p = 0;
  while (beyond(panel_[p].last)) ++p;
  const Panel& panel = panel_[p];
  double low = -1, high = 1, x = 2 * (y - panel.first) / (panel.last - panel.first) - 1;
  for (int round = 0; round < 60; ++round) {
    const double off = y - value_of(panel.y.data(), x);
    (off * direction_ > 0 ? low : high) = x;
    const double move = off / (0.5 * panel.length * value_of(panel.g.data(), x));
    double next = x + move;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const bool there = std::abs(next - x) < 1e-15;
    x = next;
    if (there) break;
  }
  return panel.begin + 0.5 * (x + 1) * panel.length;
}

}  // namespace wearwell::formula
