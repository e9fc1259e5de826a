#include "wearwell/models/formula_model/mismatch_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/models/formula_model/chebyshev_series.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t terms = MismatchTable::terms;

}  // namespace

double MismatchTable::unit_place(double theta) const {
  if (!(theta_high_ > theta_low_)) return 0;
  return 2 * (theta - theta_low_) / (theta_high_ - theta_low_) - 1;
}

MismatchSlice::MismatchSlice(std::shared_ptr<const MismatchTable> table)
    : table_(std::move(table)),
      theta_(std::numeric_limits<double>::quiet_NaN()),
      order_(std::max(MismatchTable::map_orders, table_->orders_)),
      order_slope_(order_.size()),
      at_(table_->units_),
      collapsed_(table_->units_ * table_->panels_ * terms),
      collapsed_slope_(collapsed_.size()),
      fresh_(table_->units_ * table_->panels_),
      fresh_slope_(fresh_.size()) {}

bool MismatchSlice::move(double theta) {
  if (theta == theta_) return inside_;
  theta_ = theta;
  inside_ = table_->holds(theta);
  if (!inside_) return false;
  chebyshev_polynomials(table_->unit_place(theta), order_, order_slope_);
  for (std::size_t u = 0; u < at_.size(); ++u) {
    at_[u] = {chebyshev_sum(table_->center_[u], order_), chebyshev_sum(table_->half_[u], order_),
              chebyshev_sum(table_->best_[u], order_),
              chebyshev_sum(table_->center_[u], order_slope_),
              chebyshev_sum(table_->half_[u], order_slope_)};
  }
  std::fill(fresh_.begin(), fresh_.end(), std::uint8_t{0});
  std::fill(fresh_slope_.begin(), fresh_slope_.end(), std::uint8_t{0});
  return true;
}

MismatchSlice::Spot MismatchSlice::spot(std::size_t unit, double x) const {
  const auto panels = static_cast<double>(table_->panels_);
  const double s = (x - at_[unit].center) / at_[unit].half, along = 0.5 * (s + 1) * panels;
  const double panel = std::clamp(std::floor(along), 0.0, panels - 1);
  return {static_cast<std::size_t>(panel), 2 * (along - panel) - 1, s};
}

namespace {

// The polynomials of all orders in theta, each times its coefficient.
void collapse(const double* from, const double* order, std::size_t orders, double* to) {
  std::fill_n(to, terms, 0.0);
  for (std::size_t k = 0; k < orders; ++k) {
    for (std::size_t i = 0; i < terms; ++i) to[i] += order[k] * from[k * terms + i];
  }
}

}  // namespace

const double* MismatchSlice::polynomial(std::size_t unit, std::size_t panel) {
  const std::size_t i = unit * table_->panels_ + panel;
  if (!fresh_[i]) {
    collapse(&table_->coefficients_[i * table_->orders_ * terms], order_.data(), table_->orders_,
             &collapsed_[i * terms]);
    fresh_[i] = 1;
  }
  return &collapsed_[i * terms];
}

const double* MismatchSlice::theta_polynomial(std::size_t unit, std::size_t panel) {
  const std::size_t i = unit * table_->panels_ + panel;
  if (!fresh_slope_[i]) {
    collapse(&table_->coefficients_[i * table_->orders_ * terms], order_slope_.data(),
             table_->orders_, &collapsed_slope_[i * terms]);
    fresh_slope_[i] = 1;
  }
  return &collapsed_slope_[i * terms];
}

namespace {

double value_of(const double* c, double t) {
  const double t2 = t * t, t4 = t2 * t2;
  const auto four = [&](const double* p) { return (p[0] + p[1] * t) + (p[2] + p[3] * t) * t2; };
  static_assert(terms == 14);
  return four(c) + (four(c + 4) + (four(c + 8) + (c[12] + c[13] * t) * t4) * t4) * t4;
}

}  // namespace

double MismatchSlice::value(std::size_t unit, double x) {
  const Spot at = spot(unit, x);
  return value_of(polynomial(unit, at.panel), at.t);
}

MismatchSlice::Place MismatchSlice::place(std::size_t unit, double x) {
  const Spot at = spot(unit, x);
  const double* c = polynomial(unit, at.panel);
  double value = 0, slope = 0, bend = 0;
  for (std::size_t i = terms; i-- > 0;) {
    bend = bend * at.t + slope;
    slope = slope * at.t + value;
    value = value * at.t + c[i];
  }
  const double rate = static_cast<double>(table_->panels_) / at_[unit].half;  // of t by x
  return {value, slope * rate, 2 * bend * rate * rate};
}

double MismatchSlice::by_theta(std::size_t unit, double x) {
  if (table_->orders_ == 1) return 0;
  const Spot at = spot(unit, x);
  const Frame& frame = at_[unit];
  const double direct = value_of(theta_polynomial(unit, at.panel), at.t);
  const double moved = -place(unit, x).slope * (frame.center_slope + at.s * frame.half_slope);
  return 2 / (table_->theta_high_ - table_->theta_low_) * (direct + moved);
}

}  // namespace wearwell::formula_model
