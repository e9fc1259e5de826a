#include "wearwell/infer/ridge_map.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// An affine map suffices if widths (log) and the ridge (in widths) change less than this along
// three standard deviations.
constexpr double straight = 0.02;

// Stations are half a standard deviation apart near the center and farther apart in the tails; they
// end where the log density has decreased by this much.
constexpr double first_step = 0.5, growth = 1.15, fallen = 40;
constexpr int steady = 8, most_modes = 60;

// A marginal density of a scale that has not decreased by this much (log) over this distance (log)
// is unbounded in extent.
constexpr double hardly = 8, endless_way = 100;

// Integration begins where the log marginal density of the axis has decreased by this much.
constexpr double begin = 14;

// Conditional widths of the others given the axis, from the covariance.
Eigen::VectorXd conditional_widths(const Eigen::MatrixXd& covariance, int axis) {
  const Eigen::Index d = covariance.rows();
  Eigen::VectorXd width(d - 1);
  for (Eigen::Index j = 0; j < d - 1; ++j) {
    const Eigen::Index from = j + (j >= axis);
    const double left =
        covariance(from, from) - std::pow(covariance(from, axis), 2) / covariance(axis, axis);
    width[j] = std::sqrt(std::max(left, 1e-6 * covariance(from, from)));
  }
  return width;
}

ConditionalMode visit_at(Slice& slice, double z, const Whitening& whitening,
                         const Eigen::MatrixXd& covariance, int axis, const ConditionalMode* last,
                         const ConditionalMode* before) {
  slice.at = z;
  if (last) {
    return visit(slice, guesses(before ? *before : *last, *last, z - last->at), last->width);
  }
  const Eigen::Index d = covariance.rows();
  // The conditional mean of a normal distribution.
  const Eigen::VectorXd center = without(whitening.center, axis);
  Eigen::VectorXd rest(d - 1);
  for (Eigen::Index j = 0; j < d - 1; ++j) {
    const Eigen::Index from = j + (j >= axis);
    rest[j] =
        center[j] + covariance(from, axis) / covariance(axis, axis) * (z - whitening.center[axis]);
  }
  return visit(slice, {rest, center}, conditional_widths(covariance, axis));
}

}  // namespace

Splines::Splines(std::vector<double> at, Eigen::MatrixXd values)
    : at_(std::move(at)), values_(std::move(values)) {
  const auto n = static_cast<Eigen::Index>(at_.size());
  second_ = Eigen::MatrixXd::Zero(n, values_.cols());
  // Natural splines; Thomas algorithm for the tridiagonal system.
  Eigen::VectorXd above = Eigen::VectorXd::Zero(n);
  const auto gap = [&](Eigen::Index i) {
    return at_[static_cast<std::size_t>(i + 1)] - at_[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double a = gap(i - 1), b = gap(i);
    const Eigen::RowVectorXd bend =
        6 * ((values_.row(i + 1) - values_.row(i)) / b - (values_.row(i) - values_.row(i - 1)) / a);
    const double pivot = 2 * (a + b) - a * above[i - 1];
    above[i] = b / pivot;
    second_.row(i) = (bend - a * second_.row(i - 1)) / pivot;
  }
  for (Eigen::Index i = n - 2; i > 0; --i) second_.row(i) -= above[i] * second_.row(i + 1);
}

void Splines::operator()(double t, double* value) const {
  const std::size_t n = at_.size();
  const double inside = std::clamp(t, at_.front(), at_.back());
  const auto next = std::upper_bound(at_.begin() + 1, at_.end() - 1, inside);
  const std::size_t k = static_cast<std::size_t>(next - at_.begin()) - 1;
  const auto i = static_cast<Eigen::Index>(k);
  const double gap = at_[k + 1] - at_[k], b = (inside - at_[k]) / gap, a = 1 - b;
  const double of_a = (a * a * a - a) * gap * gap / 6, of_b = (b * b * b - b) * gap * gap / 6;
  for (Eigen::Index j = 0; j < values_.cols(); ++j) {
    value[j] =
        a * values_(i, j) + b * values_(i + 1, j) + of_a * second_(i, j) + of_b * second_(i + 1, j);
  }
  if (inside == t) return;
  const bool high = t > inside;
  const auto first = high ? static_cast<Eigen::Index>(n) - 2 : 0;
  for (Eigen::Index j = 0; j < values_.cols(); ++j) {
    const double slope = (values_(first + 1, j) - values_(first, j)) / gap +
                         (high ? second_(first, j) : -second_(first + 1, j)) * gap / 6;
    value[j] += slope * (t - inside);
  }
}

RidgeMap::RidgeMap(const Posterior& posterior, const Whitening& whitening, bool affine)
    : whitening_(whitening),
      d_(posterior.dimension()),
      highest_(posterior.value(view(whitening.center))),
      log_integral_(std::numeric_limits<double>::quiet_NaN()),
      highest_of_weight_(highest_) {
  if (d_ > 1 && !affine) choose_axis(posterior);
  if (!affine_) follow(posterior);
  if (affine_) highest_of_weight_ = highest_;
  log_scale_ = std::log(affine_ ? std::abs(whitening_.scale.determinant()) : unit_);
}

void RidgeMap::choose_axis(const Posterior& posterior) {
  const Eigen::MatrixXd covariance = whitening_.scale * whitening_.scale.transpose();
  double most_change = straight;
  for (int a = 0; a < d_; ++a) {
    Slice slice(posterior, a);
    const double z = whitening_.center[a], sd = std::sqrt(covariance(a, a));
    const auto visited = [&](double t) {
      return visit_at(slice, z + t * sd, whitening_, covariance, a, nullptr, nullptr);
    };
    const ConditionalMode below = visited(-1.5), middle = visited(0), above = visited(1.5);
    if (!below.converged || !middle.converged || !above.converged) continue;
    const Eigen::VectorXd widths = below.width.cwiseQuotient(above.width).array().log().matrix();
    const Eigen::VectorXd bend =
        (below.rest + above.rest - 2 * middle.rest).cwiseQuotient(middle.width);
    // A curved map costs evaluations; a map that is too narrow loses mass.
    const double change = widths.cwiseAbs().maxCoeff() + 0.25 * bend.cwiseAbs().maxCoeff();
    if (change > most_change) {
      most_change = change;
      axis_ = a;
      unit_ = sd;
      affine_ = false;
    }
  }
}

std::vector<ConditionalMode> RidgeMap::walk(const Posterior& posterior, int way) const {
  const Eigen::MatrixXd covariance = whitening_.scale * whitening_.scale.transpose();
  Slice slice(posterior, axis_);
  const double z = whitening_.center[axis_];
  std::vector<ConditionalMode> modes = {
      visit_at(slice, z, whitening_, covariance, axis_, nullptr, nullptr)};
  const Distribution& prior = posterior.parameters()[static_cast<std::size_t>(axis_)].prior;
  const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
  double t = 0, step = first_step, top = modes.front().log_marginal;
  while (static_cast<int>(modes.size()) < most_modes) {
    t += way * step;
    if (static_cast<int>(modes.size()) > steady) step *= growth;
    const ConditionalMode* before = modes.size() > 1 ? &modes[modes.size() - 2] : nullptr;
    ConditionalMode next =
        visit_at(slice, z + t * unit_, whitening_, covariance, axis_, &modes.back(), before);
    if (!next.converged) break;
    top = std::max(top, next.log_marginal);
    modes.push_back(std::move(next));
    if (modes.back().log_marginal < top - fallen) break;
    if (!whole_line && std::abs(t) * unit_ > endless_way) break;
  }
  return modes;
}

void RidgeMap::follow(const Posterior& posterior) {
  std::vector<ConditionalMode> modes = walk(posterior, -1);
  std::reverse(modes.begin(), modes.end());
  std::vector<ConditionalMode> up = walk(posterior, 1);
  modes.insert(modes.end(), std::make_move_iterator(up.begin() + 1),
               std::make_move_iterator(up.end()));

  const auto r = static_cast<Eigen::Index>(d_ - 1);
  std::vector<double> at;
  Eigen::MatrixXd values(modes.size(), r + r * (r + 1) / 2);
  double top = -INFINITY;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const ConditionalMode& mode = modes[i];
    at.push_back((mode.at - whitening_.center[axis_]) / unit_);
    // The Cholesky factor of the inverse curvature: logarithms of its diagonal, and the rest of
    // each column divided by it.
    const Eigen::MatrixXd scaled =
        mode.width.asDiagonal() * mode.curvature * mode.width.asDiagonal();
    const Eigen::MatrixXd factor =
        mode.width.asDiagonal() * scaled.inverse().llt().matrixL().toDenseMatrix();
    const auto row = static_cast<Eigen::Index>(i);
    values.row(row).head(r) = mode.rest.transpose();
    for (Eigen::Index j = 0, column = r; j < r; ++j) {
      values(row, column++) = std::log(factor(j, j));
      for (Eigen::Index k = j + 1; k < r; ++k) values(row, column++) = factor(k, j) / factor(j, j);
    }
    top = std::max(top, mode.log_marginal);
    highest_ = std::max(highest_, mode.log_density);
  }
  if (at.size() < 4 || !values.allFinite()) {
    affine_ = true;
    axis_ = 0;
    return;
  }
  const Distribution& prior = posterior.parameters()[static_cast<std::size_t>(axis_)].prior;
  if (std::isfinite(prior.lower) || std::isfinite(prior.upper)) {
    for (const ConditionalMode* end : {&modes.front(), &modes.back()}) {
      endless_ |= std::abs(end->at - whitening_.center[axis_]) > endless_way &&
                  end->log_marginal > top - hardly;
    }
  }
  double integral = 0;
  lower_ = -3;
  upper_ = 3;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const double here = std::exp(modes[i].log_marginal - top);
    const double left = i > 0 ? at[i] - at[i - 1] : 0;
    const double right = i + 1 < at.size() ? at[i + 1] - at[i] : 0;
    integral += here * 0.5 * (left + right);
    if (modes[i].log_marginal < top - begin) continue;
    highest_of_weight_ = std::max(highest_of_weight_, modes[i].log_density);
    lower_ = std::min(lower_, at[i]);
    upper_ = std::max(upper_, at[i]);
  }
  log_integral_ =
      top + std::log(integral * unit_) + 0.5 * static_cast<double>(r) * std::log(2 * M_PI);
  walked_from_ = at.front();
  walked_to_ = at.back();
  splines_ = Splines(std::move(at), std::move(values));
}

RidgeMap::Frame RidgeMap::at(double t) const {
  Frame frame;
  frame.scale.fill(0);
  if (affine_) {
    for (int i = 0; i < d_; ++i) {
      frame.center[i] = whitening_.center[i] + whitening_.scale(i, 0) * t;
      for (int j = 1; j < d_; ++j) frame.scale[most * j + i] = whitening_.scale(i, j);
    }
    return frame;
  }
  std::array<double, 9> value;
  splines_(t, value.data());
  const int r = d_ - 1;
  frame.center[axis_] = whitening_.center[axis_] + unit_ * t;
  for (int j = 0, column = r; j < r; ++j) {
    const int of_u = j + (j >= axis_);
    frame.center[of_u] = value[j];
    frame.log_jacobian += value[column];
    const double diagonal = std::exp(value[column++]);
    frame.scale[most * of_u + of_u] = diagonal;
    for (int k = j + 1; k < r; ++k) {
      frame.scale[most * of_u + k + (k >= axis_)] = value[column++] * diagonal;
    }
  }
  return frame;
}

RidgeMap::Coordinates RidgeMap::from_real(const Eigen::VectorXd& z) const {
  Coordinates u{};
  if (affine_) {
    const Eigen::VectorXd there = whitening_.scale.partialPivLu().solve(z - whitening_.center);
    std::copy(there.begin(), there.end(), u.begin());
    return u;
  }
  u[axis_] = (z[axis_] - whitening_.center[axis_]) / unit_;
  // The scale of the others is lower triangular.
  const Frame frame = at(u[axis_]);
  Coordinates left{};
  for (int i = 0; i < d_; ++i) left[i] = z[i] - frame.center[i];
  for (int j = 0; j < d_; ++j) {
    if (j == axis_) continue;
    u[j] = left[j] / frame.scale[most * j + j];
    for (int k = j + 1; k < d_; ++k) left[k] -= frame.scale[most * j + k] * u[j];
  }
  return u;
}

bool RidgeMap::reaches(const Eigen::VectorXd& z) const {
  if (affine_) return true;
  const double t = (z[axis_] - whitening_.center[axis_]) / unit_;
  return walked_from_ <= t && t <= walked_to_;
}

void RidgeMap::to_real(const Frame& frame, const Coordinates& u, Coordinates& z) const {
  z = frame.center;
  for (int j = 0; j < d_; ++j) {
    if (j == axis_) continue;
    for (int i = 0; i < d_; ++i) z[i] += frame.scale[most * j + i] * u[j];
  }
}

}  // namespace wearwell
