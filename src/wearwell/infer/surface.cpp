#include "wearwell/infer/surface.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr int most_parameters = 4;
constexpr std::size_t fewest_terms = 30, fewest_of_four = 20'000;
constexpr double reach = 7;      // standard deviations, by polynomials
constexpr double farthest = 21;  // by the parabola
constexpr double close = 1e-5;   // of log densities within `near` of the highest
constexpr double near = 15, roughly = 1e-2;
constexpr double gone = 18;  // required decrease of the log density where the parabola begins
constexpr std::array<int, 3> nodes_of_one = {17, 25, 33}, nodes_of_two = {11, 15, 19},
                             nodes_of_three = {9, 11, 13}, nodes_of_four = {7, 9, 11};

using U = std::array<double, most_parameters>;

// The derivative of the real line by the natural parameter.
double real_slope(const Parameter& parameter, double x) {
  const double lower = parameter.prior.lower, upper = parameter.prior.upper;
  if (std::isfinite(lower) && std::isfinite(upper)) {
    return (upper - lower) / ((x - lower) * (upper - x));
  }
  if (std::isfinite(lower)) return 1 / (x - lower);
  return std::isfinite(upper) ? -1 / (upper - x) : 1 / parameter.scale;
}

// A product of Chebyshev series of total degree below `n` on [-1, 1]^d.
class Series {
 public:
  // `values` at the products of Chebyshev's nodes, the first axis fastest.
  Series(int d, int n, std::vector<double> values) : d_(d), n_(n), coefficient_(std::move(values)) {
    std::size_t stride = 1;
    for (int a = 0; a < d; ++a, stride *= static_cast<std::size_t>(n)) transform(stride);
  }

  static double node(int n, int i) { return std::cos(M_PI * (i + 0.5) / n); }

  double operator()(const U& t, double* slope) const {
    std::array<std::array<double, 40>, most_parameters> value{}, derivative{};
    for (int a = 0; a < most_parameters; ++a) value[a][0] = 1;
    for (int a = 0; a < d_; ++a) {
      value[a][1] = t[a];
      derivative[a][1] = 1;
      for (int k = 2; k < n_; ++k) {
        value[a][k] = 2 * t[a] * value[a][k - 1] - value[a][k - 2];
        derivative[a][k] =
            2 * value[a][k - 1] + 2 * t[a] * derivative[a][k - 1] - derivative[a][k - 2];
      }
    }
    const int second = d_ > 1 ? n_ : 1, third = d_ > 2 ? n_ : 1, fourth = d_ > 3 ? n_ : 1;
    double sum = 0;
    U of{};
    for (int m = 0; m < fourth; ++m) {
      for (int l = 0; l < third - m; ++l) {
        for (int k = 0; k < second - l - m; ++k) {
          const double* c = &coefficient_[static_cast<std::size_t>(n_) *
                                          static_cast<std::size_t>(k + n_ * (l + n_ * m))];
          double line = 0, line_slope = 0;
          for (int j = 0; j < n_ - k - l - m; ++j) {
            line += c[j] * value[0][j];
            if (slope) line_slope += c[j] * derivative[0][j];
          }
          const double others = value[2][l] * value[3][m];
          sum += line * value[1][k] * others;
          if (!slope) continue;
          of[0] += line_slope * value[1][k] * others;
          of[1] += line * derivative[1][k] * others;
          of[2] += line * value[1][k] * derivative[2][l] * value[3][m];
          of[3] += line * value[1][k] * value[2][l] * derivative[3][m];
        }
      }
    }
    for (int a = 0; slope && a < d_; ++a) slope[a] = of[a];
    return sum;
  }

 private:
  void transform(std::size_t stride) {
    const auto n = static_cast<std::size_t>(n_);
    std::vector<double> line(n);
    for (std::size_t first = 0; first < coefficient_.size(); ++first) {
      if (first / stride % n != 0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
          sum += coefficient_[first + i * stride] *
                 std::cos(M_PI * static_cast<double>(k) * (static_cast<double>(i) + 0.5) / n_);
        }
        line[k] = (k == 0 ? 1.0 : 2.0) / n_ * sum;
      }
      for (std::size_t k = 0; k < n; ++k) coefficient_[first + k * stride] = line[k];
    }
  }

  int d_, n_;
  std::vector<double> coefficient_;
};

class Surface final : public LogDensity {
 public:
  Surface(const Posterior& whole, const Whitening& whitening, Series series)
      : whole_(whole),
        center_(whitening.center),
        to_u_(whitening.scale.inverse()),
        series_(std::move(series)) {}

  int dimension() const override { return whole_.dimension(); }
  double value(std::span<const double> x) const override {
    const Eigen::VectorXd u = place(x);
    const double farthest_out = u.cwiseAbs().maxCoeff();
    if (!(farthest_out <= farthest)) return whole_.likelihood()->value(x);
    return continued(u, nullptr);
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    const Eigen::VectorXd u = place(x);
    if (!(u.cwiseAbs().maxCoeff() <= farthest))
      return whole_.likelihood()->value_and_gradient(x, gradient);
    Eigen::VectorXd slope(u.size());
    const double value = continued(u, slope.data());
    const Eigen::VectorXd of_z = to_u_.transpose() * slope;
    for (std::size_t i = 0; i < x.size(); ++i) {
      gradient[i] = of_z[static_cast<Eigen::Index>(i)] * real_slope(whole_.parameters()[i], x[i]);
    }
    return value;
  }
  std::vector<double> pointwise(std::span<const double> x) const override {
    return whole_.likelihood()->pointwise(x);
  }
  std::vector<int> pointwise_counts() const override {
    return whole_.likelihood()->pointwise_counts();
  }

 private:
  Eigen::VectorXd place(std::span<const double> x) const {
    return to_u_ * (whole_.to_real(x) - center_);
  }

  // By polynomials; outside their box by the tangent parabola at the nearest point.
  double continued(const Eigen::VectorXd& u, double* slope) const {
    U t{};
    for (Eigen::Index a = 0; a < u.size(); ++a)
      t[static_cast<std::size_t>(a)] = std::clamp(u[a] / reach, -1.0, 1.0);
    U inner{};
    const bool outside = u.cwiseAbs().maxCoeff() > reach;
    double value = series_(t, slope || outside ? inner.data() : nullptr);
    for (Eigen::Index a = 0; a < u.size(); ++a) {
      const auto at = static_cast<std::size_t>(a);
      const double beyond = u[a] - reach * t[at];
      value += (inner[at] / reach - 0.5 * beyond) * beyond;
      if (slope) slope[a] = inner[at] / reach - beyond;
    }
    return value;
  }

  Posterior whole_;
  Eigen::VectorXd center_;
  Eigen::MatrixXd to_u_;
  Series series_;
};

class Trial {
 public:
  Trial(const Posterior& posterior, const Whitening& whitening)
      : posterior_(posterior),
        whitening_(whitening),
        d_(posterior.dimension()),
        highest_(posterior.value(view(whitening.center))) {}

  // Empty if it is not finite everywhere.
  std::optional<Series> series(int n) const {
    const auto count = static_cast<std::size_t>(std::pow(n, d_));
    std::vector<double> values(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      Eigen::VectorXd u(d_);
      std::size_t rest = i;
      for (int a = 0; a < d_; ++a, rest /= static_cast<std::size_t>(n)) {
        u[a] = reach * Series::node(n, static_cast<int>(rest % static_cast<std::size_t>(n)));
      }
      values[i] = likelihood(u);
    });
    for (const double each : values) {
      if (!std::isfinite(each)) return {};
    }
    return Series(d_, n, std::move(values));
  }

  // The error of the log-likelihood in the relevant region; infinite if not close enough.
  double error(const Posterior& quick) const {
    constexpr int inside = 60, outside = 30;
    std::array<double, inside + outside> off{};
    tbb::parallel_for(0, inside + outside, [&](int k) {
      Rng rng(20261122, static_cast<std::uint64_t>(k));
      Eigen::VectorXd u(d_);
      for (double& each : u) each = rng.uniform(-1, 1);
      // Points along rays in the box and beyond it.
      u *= (k < inside ? reach * std::pow(rng.uniform(), 0.5) : rng.uniform(reach, farthest)) /
           (k < inside ? 1 : u.cwiseAbs().maxCoeff());
      const Eigen::VectorXd z = whitening_(u);
      const double truth = posterior_.value(view(z)), here = quick.value(view(z));
      const auto at = static_cast<std::size_t>(k);
      if (k >= inside) {
        off[at] = truth < highest_ - gone && here < highest_ - gone ? 0 : INFINITY;
      } else if (truth > highest_ - near) {
        off[at] = std::abs(here - truth);
      } else {
        off[at] = std::abs(here - truth) <= roughly * (highest_ - truth) ? 0 : INFINITY;
      }
    });
    double largest = 0;
    for (const double each : off) largest = std::max(largest, std::isnan(each) ? INFINITY : each);
    return largest;
  }

 private:
  double likelihood(const Eigen::VectorXd& u) const {
    Eigen::VectorXd x(d_);
    const Eigen::VectorXd z = whitening_(u);
    posterior_.to_natural(view(z), view(x));
    return posterior_.likelihood()->value(view(x));
  }

  const Posterior& posterior_;
  const Whitening& whitening_;
  int d_;
  double highest_;
};

}  // namespace

std::optional<QuickPosterior> surrogate_posterior(const Posterior& posterior,
                                                  const Whitening& whitening) {
  const int d = posterior.dimension();
  if (d > most_parameters) return {};
  const bool slow = posterior.likelihood()->is_slow();
  Eigen::VectorXd x(d);
  posterior.to_natural(view(whitening.center), view(x));
  if (slow ? d == 4
           : posterior.likelihood()->pointwise(view(x)).size() <
                 (d < 4 ? fewest_terms : fewest_of_four))
    return {};
  const Trial trial(posterior, whitening);
  for (const int n : d == 1   ? nodes_of_one
                     : d == 2 ? nodes_of_two
                     : d == 3 ? nodes_of_three
                              : nodes_of_four) {
    std::optional<Series> series = trial.series(n);
    if (!series) return {};
    const auto quick = std::make_shared<const Posterior>(
        posterior.parameters(),
        std::make_shared<Surface>(posterior, whitening, std::move(*series)));
    const double error = trial.error(*quick);
    if (error <= close) return QuickPosterior{quick, error};
  }
  return {};
}

}  // namespace wearwell
