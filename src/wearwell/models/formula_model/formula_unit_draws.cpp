#include "wearwell/models/formula_model/formula_unit_draws.h"

#include <algorithm>

#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_points = 500;
constexpr double negligible = 1e-7;  // of the unit's posterior: smaller nodes are left out

struct Nodes {
  std::vector<double> values, lower, upper;  // parameters, then effects; end of the node's cell
  std::vector<double> weights;

  void add(const Nodes& other) {
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(values, other.values);
    append(lower, other.lower);
    append(upper, other.upper);
    append(weights, other.weights);
  }
};

struct Part {
  const FormulaRows& rows;
  std::size_t unit;
  Nodes found = {};

  void add(const double* x, double weight) {
    const std::size_t d = rows.model().effects.size();
    struct Node {
      double weight;
      const double* z;
    };
    std::vector<Node> nodes;
    for (const latent::Sweep& sweep : rows.integrate(x).sweeps) {
      if (sweep.weight[unit] > negligible)
        nodes.push_back({sweep.weight[unit], &sweep.z[unit * d]});
    }
    std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return *a.z < *b.z; });
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double* const z = nodes[i].z;
      // With one effect a cell ends midway to the next node; with two the nodes are many, and each
      // is a point.
      double below = *z, above = *z;
      if (d == 1 && nodes.size() > 1) {
        const double before = i > 0 ? *z - *nodes[i - 1].z : *nodes[1].z - *z;
        const double after = i + 1 < nodes.size() ? *nodes[i + 1].z - *z : before;
        below -= 0.5 * before;
        above += 0.5 * after;
      }
      const auto put = [&](std::vector<double>& to, double first) {
        to.insert(to.end(), x, x + rows.model().parameters.size());
        to.push_back(first);
        to.insert(to.end(), z + 1, z + d);
      };
      put(found.values, *z);
      put(found.lower, below);
      put(found.upper, above);
      found.weights.push_back(weight * nodes[i].weight);
    }
  }
};

}  // namespace

WeightedDraws with_unit(const FormulaRows& rows, std::size_t unit, const WeightedDraws& draws) {
  const Nodes nodes = sum_over(ThinnedPosterior(draws, most_points), [&] {
    return Part{rows, unit};
  });
  const auto count = static_cast<Eigen::Index>(nodes.weights.size());
  const auto size =
      static_cast<Eigen::Index>(rows.model().parameters.size() + rows.model().effects.size());
  const auto points = [&](const std::vector<double>& values) -> Points {
    return Eigen::Map<const Points>(values.data(), count, size);
  };
  WeightedDraws all;
  all.values = points(nodes.values);
  all.weights = Eigen::Map<const Eigen::VectorXd>(nodes.weights.data(), count);
  all.weights /= all.weights.sum();
  all.lower = {points(nodes.lower)};
  all.upper = {points(nodes.upper)};
  return all;
}

}  // namespace wearwell::formula_model
