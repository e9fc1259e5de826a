#include "wearwell/infer/maximum_likelihood.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "wearwell/math/root.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Curvature in units of the widths below which a direction is a plateau.
constexpr double least_information = 1e-7;

// A logarithm farther than this from every start is on its way to 0 or infinity.
constexpr double farthest_logarithm = 40;

constexpr double greatest_logarithm = 690;

// A search that ends this much higher than the maximum ended elsewhere.
constexpr double clearly_higher = 0.01;

// A root nearer than this to its bracket's end, in standard errors, is none.
constexpr double widest_root = 1e4;

bool is_concave(const Maximum& summit, const Eigen::VectorXd& unit) {
  const Eigen::MatrixXd scaled = unit.asDiagonal() * summit.curvature * unit.asDiagonal();
  return scaled.allFinite() &&
         Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues()[0] >
             least_information;
}

}  // namespace

double to_normal_scale(NormalScale scale, double x) {
  if (scale == NormalScale::logarithm) return std::log(x);
  return scale == NormalScale::logit ? std::log(x) - std::log1p(-x) : x;
}

double from_normal_scale(NormalScale scale, double z) {
  if (scale == NormalScale::logarithm) return std::exp(z);
  return scale == NormalScale::logit ? 1 / (1 + std::exp(-z)) : z;
}

// The likelihood as a function of the parameters on their scales.
class MaximumLikelihood::OnScale final : public LogDensity {
 public:
  OnScale(std::shared_ptr<const LogDensity> likelihood, std::vector<NormalScale> scales)
      : likelihood_(std::move(likelihood)), scales_(std::move(scales)) {}

  int dimension() const override { return likelihood_->dimension(); }

  double value(std::span<const double> z) const override {
    const Eigen::VectorXd x = natural(z);
    return x.allFinite() ? likelihood_->value(view(x)) : -std::numeric_limits<double>::infinity();
  }

  double value_and_gradient(std::span<const double> z, std::span<double> gradient) const override {
    const Eigen::VectorXd x = natural(z);
    if (!x.allFinite()) return -std::numeric_limits<double>::infinity();
    const double value = likelihood_->value_and_gradient(view(x), gradient);
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double at = x[static_cast<Eigen::Index>(i)];
      if (is_logarithm(i)) gradient[i] *= at;
      if (scales_[i] == NormalScale::logit) gradient[i] *= at * (1 - at);
    }
    return value;
  }

  bool is_logarithm(std::size_t i) const { return scales_[i] == NormalScale::logarithm; }
  /// On a scale without a unit, of about 1.
  bool is_plain(std::size_t i) const { return scales_[i] != NormalScale::natural; }

  Eigen::VectorXd natural(std::span<const double> z) const {
    Eigen::VectorXd x(static_cast<Eigen::Index>(z.size()));
    for (std::size_t i = 0; i < z.size(); ++i)
      x[static_cast<Eigen::Index>(i)] = from_normal_scale(scales_[i], z[i]);
    return x;
  }

  Eigen::VectorXd on_scale(const Eigen::VectorXd& x) const {
    Eigen::VectorXd z = x;
    for (Eigen::Index i = 0; i < z.size(); ++i)
      z[i] = to_normal_scale(scales_[static_cast<std::size_t>(i)], x[i]);
    return z;
  }

 private:
  std::shared_ptr<const LogDensity> likelihood_;
  std::vector<NormalScale> scales_;
};

MaximumLikelihood::MaximumLikelihood(std::shared_ptr<const LogDensity> likelihood,
                                     std::vector<NormalScale> scales,
                                     const std::vector<Eigen::VectorXd>& starts,
                                     const Eigen::VectorXd& widths)
    : density_(std::make_shared<const OnScale>(std::move(likelihood), std::move(scales))) {
  const Eigen::Index n = widths.size();
  Box box{Eigen::VectorXd::Constant(n, -std::numeric_limits<double>::infinity()),
          Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity())};
  Eigen::VectorXd unit = widths;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!density_->is_plain(static_cast<std::size_t>(i))) continue;
    unit[i] = 1;
    box.lower[i] = -greatest_logarithm;
    box.upper[i] = greatest_logarithm;
  }
  std::optional<Maximum> best, highest;
  for (const Eigen::VectorXd& start : starts) {
    const Eigen::VectorXd from = density_->on_scale(start);
    if (!from.allFinite()) continue;
    Maximum summit = maximize(*density_, from, unit, box);
    if (!std::isfinite(summit.value)) continue;
    if (!highest || summit.value > highest->value) {
      highest = summit;
      (summit.x - from).cwiseQuotient(unit).cwiseAbs().maxCoeff(&rising_);
    }
    bool near = summit.converged && summit.curvature.allFinite() && is_concave(summit, unit);
    for (Eigen::Index i = 0; near && i < n; ++i)
      near = !density_->is_plain(static_cast<std::size_t>(i)) ||
             std::abs(summit.x[i] - from[i]) < farthest_logarithm;
    if (near && (!best || summit.value > best->value)) best = std::move(summit);
  }
  if (highest) highest_ = density_->natural(view(highest->x));
  if (!best) return;
  found_ = true;
  higher_elsewhere_ = highest->value > best->value + clearly_higher;
  covariance_ = best->curvature.inverse();
  maximum_ = {best->x, best->value, covariance_.diagonal().cwiseSqrt(), std::move(box)};
  position_ = density_->natural(view(best->x));
}

ClassicalBounds MaximumLikelihood::of_parameter(Eigen::Index i, double level) const {
  const double z = boost::math::quantile(boost::math::normal(), 0.5 * (1 + level));
  const double at = maximum_.position[i], error = maximum_.unit[i];
  return {at, error, at - z * error, at + z * error,
          profile_interval(*density_, maximum_, i, level)};
}

// Of a function of the parameters on their scales, by central differences.
Eigen::VectorXd MaximumLikelihood::gradient(const Quantity& at_scale) const {
  Eigen::VectorXd slopes(maximum_.position.size()), z = maximum_.position;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double middle = z[i], step = 1e-3 * maximum_.unit[i];
    const auto at = [&](double by) {
      z[i] = middle + by;
      return at_scale(z.data());
    };
    // Of fourth order.
    slopes[i] = (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
    z[i] = middle;
  }
  return slopes;
}

// The likelihood with a quantity in the place of one parameter, which is solved for.
class MaximumLikelihood::WithQuantity final : public LogDensity {
 public:
  WithQuantity(const OnScale& density, const ProfiledMaximum& maximum, const Comparison& above,
               Eigen::Index solved, double sign, double error)
      : density_(density),
        maximum_(maximum),
        above_(above),
        solved_(solved),
        sign_(sign),
        error_(error) {}

  int dimension() const override { return density_.dimension(); }

  double value(std::span<const double> y) const override {
    const Eigen::VectorXd z = solve(y);
    return z.allFinite() ? density_.value(view(z)) : -std::numeric_limits<double>::infinity();
  }

  double value_and_gradient(std::span<const double> y, std::span<double> gradient) const override {
    const Eigen::VectorXd z = solve(y);
    if (!z.allFinite()) return -std::numeric_limits<double>::infinity();
    Eigen::VectorXd slope(z.size());
    const double value = density_.value_and_gradient(view(z), view(slope));
    // By implicit differentiation: the comparison stays 0.
    const double at = y[static_cast<std::size_t>(solved_)];
    const Eigen::VectorXd by = slopes(z, at);
    const double step = 1e-4 * error_;
    const double by_value = (above(z, at + step) - above(z, at - step)) / (2 * step);
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const double share = (i == solved_ ? by_value : by[i]) / by[solved_];
      gradient[static_cast<std::size_t>(i)] =
          (i == solved_ ? 0 : slope[i]) - slope[solved_] * share;
    }
    return value;
  }

 private:
  double above(const Eigen::VectorXd& z, double value) const {
    const Eigen::VectorXd x = density_.natural(view(z));
    return above_(x.data(), value);
  }

  Eigen::VectorXd slopes(Eigen::VectorXd z, double value) const {
    Eigen::VectorXd found(z.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const double middle = z[i], step = 1e-4 * maximum_.unit[i];
      z[i] = middle + step;
      const double up = above(z, value);
      z[i] = middle - step;
      const double down = above(z, value);
      z[i] = middle;
      found[i] = (up - down) / (2 * step);
    }
    return found;
  }

  Eigen::VectorXd solve(std::span<const double> y) const {
    Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(y.data(), dimension());
    const double value = z[solved_], middle = maximum_.position[solved_];
    const double unit = maximum_.unit[solved_];
    const double low = std::max(middle - widest_root * unit, maximum_.box.lower[solved_]);
    const double high = std::min(middle + widest_root * unit, maximum_.box.upper[solved_]);
    const double root = solve_increasing(
        [&](double own) {
          z[solved_] = own;
          return sign_ * above(z, value);
        },
        middle, 0.5 * unit, {.absolute = 1e-13 * unit, .relative = 1e-15}, low, high);
    z[solved_] = root > low && root < high ? root : std::nan("");
    return z;
  }

  const OnScale& density_;
  const ProfiledMaximum& maximum_;
  const Comparison& above_;
  Eigen::Index solved_;
  double sign_, error_;  // `error_` is about the possible change of the quantity
};

ClassicalBounds MaximumLikelihood::of(const Quantity& quantity, const Comparison& above,
                                      double level) const {
  const auto n = static_cast<std::size_t>(maximum_.position.size());
  const Quantity at_scale = [&](const double* z) {
    const Eigen::VectorXd x = density_->natural({z, n});
    return quantity(x.data());
  };
  ClassicalBounds bounds;
  bounds.estimate = at_scale(maximum_.position.data());
  const Eigen::VectorXd slopes = gradient(at_scale);
  bounds.error = std::sqrt(slopes.dot(covariance_ * slopes));
  const double deviate = boost::math::quantile(boost::math::normal(), 0.5 * (1 + level));
  bounds.lower = bounds.estimate - deviate * bounds.error;
  bounds.upper = bounds.estimate + deviate * bounds.error;
  if (!std::isfinite(bounds.estimate) || !(bounds.error > 0) || !std::isfinite(bounds.error)) {
    const ProfileEnd open{std::nan(""), "it has no finite value or error at the maximum"};
    bounds.likelihood_ratio = {open, open};
    return bounds;
  }
  // The parameter that moves the quantity most gives way to it.
  Eigen::Index solved = 0;
  slopes.cwiseProduct(maximum_.unit).cwiseAbs().maxCoeff(&solved);
  const WithQuantity density(*density_, maximum_, above, solved, slopes[solved] < 0 ? -1 : 1,
                             bounds.error);
  ProfiledMaximum maximum = maximum_;
  maximum.position[solved] = bounds.estimate;
  maximum.unit[solved] = bounds.error;
  maximum.box.lower[solved] = -std::numeric_limits<double>::infinity();
  maximum.box.upper[solved] = std::numeric_limits<double>::infinity();
  bounds.likelihood_ratio = profile_interval(density, maximum, solved, level);
  return bounds;
}

}  // namespace wearwell
