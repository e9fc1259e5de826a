#include "wearwell/infer/maxima_mixture.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/view.h"

namespace wearwell {
namespace {

using Map = Eigen::Map<const Eigen::VectorXd>;

Map map(std::span<const double> z) {
  return {z.data(), static_cast<Eigen::Index>(z.size())};
}

// Degrees of freedom for assigning posterior points to maxima.
constexpr double counting_freedom = 5;

}  // namespace

MaximaMixture::MaximaMixture(std::span<const LocalMaximum> maxima, double freedom, double evenly)
    : freedom_(freedom) {
  double total = 0;
  for (const LocalMaximum& each : maxima) total += each.share;
  for (const LocalMaximum& each : maxima) {
    Component component{whitening_at(each.mode), {}};
    component.inverse = component.round.scale.inverse();
    component.weight =
        (1 - evenly) * each.share / total + evenly / static_cast<double>(maxima.size());
    component.log_height =
        std::log(component.weight) + std::log(std::abs(component.inverse.determinant()));
    components_.push_back(std::move(component));
  }
}

double MaximaMixture::log_term(std::span<const double> z, const Component& component) const {
  const Eigen::Index d = component.round.center.size();
  double square = 0;
  for (Eigen::Index i = 0; i < d; ++i) {
    const double u = component.inverse.row(i).dot(map(z) - component.round.center);
    square += u * u;
  }
  return component.log_height -
         0.5 * (freedom_ + static_cast<double>(d)) * std::log1p(square / freedom_);
}

double MaximaMixture::log_density(std::span<const double> z) const {
  double top = -INFINITY, sum = 0;
  for (const Component& each : components_) {
    const double term = log_term(z, each);
    sum = term > top ? sum * std::exp(top - term) + 1 : sum + std::exp(term - top);
    top = std::max(top, term);
  }
  return top + std::log(sum);
}

void MaximaMixture::add_slope(std::span<const double> z, const Component& component, double factor,
                              std::span<double> gradient) const {
  const auto d = static_cast<double>(z.size());
  const Eigen::VectorXd u = component.inverse * (map(z) - component.round.center);
  const Eigen::VectorXd slope = component.inverse.transpose() * u;
  const double by = -factor * (freedom_ + d) / (freedom_ + u.squaredNorm());
  for (std::size_t i = 0; i < z.size(); ++i)
    gradient[i] += by * slope[static_cast<Eigen::Index>(i)];
}

double MaximaMixture::log_share(std::span<const double> z, std::size_t k,
                                std::span<double> gradient) const {
  const double all = log_density(z), share = log_term(z, components_[k]) - all;
  if (gradient.empty()) return share;
  std::fill(gradient.begin(), gradient.end(), 0.0);
  add_slope(z, components_[k], 1, gradient);
  for (const Component& each : components_) {
    add_slope(z, each, -std::exp(log_term(z, each) - all), gradient);
  }
  return share;
}

std::size_t MaximaMixture::nearest(std::span<const double> z) const {
  std::size_t best = 0;
  double most = -INFINITY;
  for (std::size_t k = 0; k < components_.size(); ++k) {
    const double term = log_term(z, components_[k]);
    if (term > most) best = k;
    most = std::max(most, term);
  }
  return best;
}

Eigen::VectorXd MaximaMixture::draw(Rng& rng) const {
  double left = rng.uniform();
  std::size_t k = 0;
  while (k + 1 < components_.size() && left > components_[k].weight)
    left -= components_[k++].weight;
  const Component& component = components_[k];
  Eigen::VectorXd u(component.round.center.size());
  for (double& each : u) each = rng.normal();
  double chi_squared = 0;
  for (int i = 0; i < static_cast<int>(freedom_); ++i) chi_squared += std::pow(rng.normal(), 2);
  return component.round(u * std::sqrt(freedom_ / chi_squared));
}

MaximaMixture counting_mixture(const Maxima& maxima) {
  return {maxima.found, counting_freedom};
}

void measure_shares(const Posterior& posterior, const WeightedDraws& points, Maxima& maxima) {
  const MaximaMixture mixture = counting_mixture(maxima);
  std::vector<double> mass(maxima.found.size(), 0.0);
  double total = 0;
  for (Eigen::Index i = 0; i < points.values.rows(); ++i) {
    if (!(points.weights[i] > 0)) continue;
    const Eigen::VectorXd x = points.values.row(i);
    const Eigen::VectorXd z = posterior.to_real(view(x));
    mass[mixture.nearest(view(z))] += points.weights[i];
    total += points.weights[i];
  }
  for (std::size_t k = 0; k < mass.size(); ++k) maxima.found[k].share = mass[k] / total;
}

}  // namespace wearwell
