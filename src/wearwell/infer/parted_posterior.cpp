#include "wearwell/infer/parted_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/infer/lattice.h"
#include "wearwell/infer/maxima_mixture.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Heavier tails reduce a part at the far end of a broad neighbour, lighter ones at the neighbour's
// maximum.
constexpr double freedom = 8;

// The likelihood times the share of one maximum.
class Part final : public LogDensity {
 public:
  Part(const Posterior& whole, const MaximaMixture& mixture, std::size_t k)
      : whole_(whole), mixture_(mixture), k_(k) {}

  int dimension() const override { return whole_.dimension(); }
  double value(std::span<const double> x) const override {
    const double likelihood = whole_.likelihood()->value(x);
    if (!std::isfinite(likelihood)) return likelihood;
    const Eigen::VectorXd z = whole_.to_real(x);
    return likelihood + mixture_.log_share(view(z), k_, {});
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    const double likelihood = whole_.likelihood()->value_and_gradient(x, gradient);
    if (!std::isfinite(likelihood)) return likelihood;
    const Eigen::VectorXd z = whole_.to_real(x);
    std::array<double, max_dimension> slope;
    const std::span<double> of_share(slope.data(), x.size());
    const double share = mixture_.log_share(view(z), k_, of_share);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      gradient[i] += slope[i] / whole_.transforms()[i].from_real(z[at]).slope;
    }
    return likelihood + share;
  }

 private:
  const Posterior& whole_;
  const MaximaMixture& mixture_;
  std::size_t k_;
};

std::vector<LocalMaximum> all_maxima(const Posterior& posterior, const Whitening& whitening,
                                     const ExactSettings& settings) {
  const Eigen::MatrixXd inverse = whitening.scale.inverse();
  std::vector<LocalMaximum> all = {{{whitening.center, posterior.value(view(whitening.center)),
                                     inverse.transpose() * inverse, true}}};
  for (const Mode& each : settings.maxima) all.push_back({each});
  double top = -INFINITY;
  const auto log_mass = [](const LocalMaximum& each) {
    return each.mode.log_density - 0.5 * std::log(each.mode.curvature.determinant());
  };
  for (const LocalMaximum& each : all) top = std::max(top, log_mass(each));
  for (LocalMaximum& each : all) each.share = std::exp(log_mass(each) - top);
  return all;
}

// Combines all parts: first the nodes with cells, then those without.
WeightedDraws joined(const std::vector<ExactPosterior>& parts, const std::vector<double>& shares) {
  const Eigen::Index d = parts.front().nodes.values.cols();
  Eigen::Index cells = 0, nodes = 0;
  for (const ExactPosterior& part : parts) {
    cells += part.nodes.cells.mass.size();
    nodes += part.nodes.values.rows();
  }
  WeightedDraws all;
  all.values.resize(nodes, d);
  all.weights.resize(nodes);
  all.cells.mass.resize(cells);
  for (Points* each : {&all.cells.node, &all.cells.mean, &all.cells.square}) each->resize(cells, d);
  if (cells > 0) {
    all.lower.assign(static_cast<std::size_t>(d), Points(cells, d));
    all.upper.assign(static_cast<std::size_t>(d), Points(cells, d));
  }
  Eigen::Index cell = 0, node = cells;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const WeightedDraws& part = parts[k].nodes;
    const Eigen::Index with = part.cells.mass.size(), without = part.values.rows() - with;
    all.values.middleRows(cell, with) = part.values.topRows(with);
    all.values.middleRows(node, without) = part.values.bottomRows(without);
    all.weights.segment(cell, with) = shares[k] * part.weights.head(with);
    all.weights.segment(node, without) = shares[k] * part.weights.tail(without);
    node += without;
    if (with == 0) continue;
    all.cells.mass.segment(cell, with) = shares[k] * part.cells.mass;
    all.cells.node.middleRows(cell, with) = part.cells.node;
    all.cells.mean.middleRows(cell, with) = part.cells.mean;
    all.cells.square.middleRows(cell, with) = part.cells.square;
    for (std::size_t a = 0; a < all.lower.size(); ++a) {
      all.lower[a].middleRows(cell, with) = part.lower[a];
      all.upper[a].middleRows(cell, with) = part.upper[a];
    }
    cell += with;
  }
  return all;
}

}  // namespace

ExactPosterior integrate_by_parts(const Posterior& posterior, const Whitening& whitening,
                                  const ExactSettings& settings) {
  const std::vector<LocalMaximum> maxima = all_maxima(posterior, whitening, settings);
  const MaximaMixture mixture(maxima, freedom);
  std::vector<ExactPosterior> parts;
  ExactPosterior all;
  for (std::size_t k = 0; k < maxima.size(); ++k) {
    const Posterior part(posterior.parameters(), std::make_shared<Part>(posterior, mixture, k));
    ExactSettings of_part = settings;
    of_part.maxima.clear();
    parts.push_back(integrate_on_lattice(part, whitening_at(maxima[k].mode), of_part));
    all.evaluations += parts.back().evaluations;
    if (parts.back().failure.empty()) continue;
    all.failure = parts.back().failure;
    return all;
  }
  double top = -INFINITY, total = 0;
  for (const ExactPosterior& part : parts) top = std::max(top, part.log_mass);
  std::vector<double> shares;
  for (const ExactPosterior& part : parts)
    total += shares.emplace_back(std::exp(part.log_mass - top));
  for (double& share : shares) share /= total;
  all.log_mass = top + std::log(total);
  all.highest = -INFINITY;
  const Eigen::Index d = posterior.dimension();
  all.mean = Eigen::VectorXd::Zero(d);
  all.covariance = Eigen::MatrixXd::Zero(d, d);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    all.error += shares[k] * parts[k].error;
    all.highest = std::max(all.highest, parts[k].highest);
    all.mean += shares[k] * parts[k].mean;
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Eigen::VectorXd off = parts[k].mean - all.mean;
    all.covariance += shares[k] * (parts[k].covariance + off * off.transpose());
  }
  all.sd = all.covariance.diagonal().cwiseSqrt();
  if (parts.front().log_evidence) all.log_evidence = all.log_mass;
  all.nodes = joined(parts, shares);
  return all;
}

}  // namespace wearwell
