#include "wearwell/infer/lattice_result.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

#include "wearwell/math/systematic.h"

namespace wearwell::lattice {
namespace {

constexpr double negligible_share = 1e-9;  // nodes with less mass are omitted
// Nodes with less mass have no cells; a sample of them represents their neighbours. In a normal
// posterior they are six of ten nodes with a thousandth of the mass.
constexpr double gathered_share = 3e-7;

// The content of a cell: along each axis the log mass is the parabola through the node and both
// neighbours, in cell lengths.
class CellShape {
 public:
  explicit CellShape(double node) : node_(node) {}

  void along(int axis, double below, double above) {
    auto& [mass, mean, square] = along_[static_cast<std::size_t>(axis)];
    // At an edge, beside zero mass, and between larger masses on both sides, the cell is filled
    // evenly.
    if (!(below > 1e-12 * node_ && above > 1e-12 * node_)) return;
    const double tilt = 0.5 * std::log(above / below),
                 bend = std::log(above / node_) + std::log(below / node_);
    if (!(bend < 3 && std::abs(tilt) < 12)) return;
    double sums[3] = {};
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double t = places[i], here = weights[i] * std::exp(t * (tilt + 0.5 * bend * t));
      sums[0] += here;
      sums[1] += t * here;
      sums[2] += t * t * here;
    }
    mass = sums[0];
    mean = sums[1] / sums[0];
    square = sums[2] / sums[0];
  }

  void write(Eigen::Index row, WeightedDraws::Cells& cells) const {
    double mass = node_;
    for (int axis = 0; axis < d; ++axis) {
      const Along& along = along_[static_cast<std::size_t>(axis)];
      mass *= along.mass;
      cells.mean(row, axis) = along.mean;
      cells.square(row, axis) = along.square;
    }
    cells.mass[row] = mass;
  }

 private:
  // The Gauss-Legendre rule with five nodes on -1/2..1/2.
  static constexpr std::array<double, 5> places = {-0.4530899229693320, -0.2692346550528415, 0,
                                                   0.2692346550528415, 0.4530899229693320};
  static constexpr std::array<double, 5> weights = {0.1184634425280945, 0.2393143352496832,
                                                    0.2844444444444444, 0.2393143352496832,
                                                    0.1184634425280945};
  struct Along {
    double mass = 1, mean = 0, square = 1.0 / 12;
  };
  double node_;
  std::array<Along, d> along_{};
};

// Sums over all nodes, in the order of lines for any number of threads.
double total(const Lines& lines) {
  std::vector<double> masses(lines.all().size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, masses.size(), 256), [&](const auto& part) {
    for (std::size_t l = part.begin(); l != part.end(); ++l) masses[l] = mass_of(lines.all()[l]);
  });
  return std::accumulate(masses.begin(), masses.end(), 0.0);
}

// Beyond the outermost lines there is nothing.
double mass_in(const Line& other, const Line& line, int t) {
  return &other == &line ? 0 : node_mass(other, t);
}

struct Node {
  const Line* line;
  int t;
  double mass;  // of its cell
};

// Moments about the middle relative to the mass, and the relevant nodes.
struct Moments {
  Eigen::Matrix<double, d, 1, Eigen::DontAlign> first = Eigen::Vector4d::Zero();
  Eigen::Matrix<double, d, d, Eigen::DontAlign> second = Eigen::Matrix4d::Zero();
  double highest = -INFINITY;
  std::vector<Node> kept;
};
void add_moments(const Lines& lines, const Line& line, const Eigen::Vector4d& middle, double mass,
                 Moments& sums) {
  for (std::size_t j = 0; j < line.values.size(); ++j) {
    const double here = std::exp(line.values[j]) * line.width;
    if (here == 0) continue;
    if (here > negligible_share * mass)
      sums.kept.push_back({&line, line.first + static_cast<int>(j), here});
    const Located there = lines.located(line, j);
    sums.highest = std::max(sums.highest, lines.reference() + line.values[j] - there.log_jacobian);
    const Eigen::Vector4d x = there.natural - middle;
    sums.first += here / mass * x;
    sums.second += here / mass * (x * x.transpose());
  }
}

// Moves nodes with cells to the front and returns their number. Nodes with less mass than `least`
// are sampled in the order of the lattice; a sampled node represents its neighbours.
Eigen::Index gather(std::vector<Node>& nodes, double least) {
  const auto small = std::stable_partition(nodes.begin(), nodes.end(),
                                           [&](const Node& node) { return node.mass >= least; });
  tbb::parallel_sort(small, nodes.end(), [](const Node& a, const Node& b) {
    return std::tie(a.line->index, a.t) < std::tie(b.line->index, b.t);
  });
  Systematic sample(least);
  std::vector<Node> without;
  auto end = small;
  for (auto node = small; node != nodes.end(); ++node) {
    if (sample.takes(node->mass)) {
      *end++ = {node->line, node->t, least};
    } else {
      without.push_back(*node);
    }
  }
  std::copy(without.begin(), without.end(), end);
  return end - nodes.begin();
}

void write_cell(const Lines& lines, const Node& node, Eigen::Index row, WeightedDraws& nodes) {
  const Line& line = *node.line;
  const int t = node.t;
  CellShape shape(nodes.weights[row]);
  shape.along(outer, node_mass(line, t - 1), node_mass(line, t + 1));
  nodes.lower[outer].row(row) = lines.natural(lines.at(line, t - 0.5));
  nodes.upper[outer].row(row) = lines.natural(lines.at(line, t + 0.5));
  for (int a = 0; a < outer; ++a) {
    const Line &below = lines.neighbour(line, a, -1), &above = lines.neighbour(line, a, 1);
    shape.along(a, mass_in(below, line, t), mass_in(above, line, t));
    const auto axis = static_cast<std::size_t>(a);
    nodes.lower[axis].row(row) = lines.natural(lines.between(line, below, above, a, -0.5, t));
    nodes.upper[axis].row(row) = lines.natural(lines.between(line, above, below, a, 0.5, t));
  }
  shape.write(row, nodes.cells);
  nodes.cells.mass[row] *= node.mass / nodes.weights[row];
}

// The first `with_cells` of them have cells.
WeightedDraws nodes_of(const Lines& lines, const std::vector<Node>& kept, Eigen::Index with_cells) {
  const auto n = static_cast<Eigen::Index>(kept.size());
  WeightedDraws nodes;
  nodes.values.resize(n, d);
  nodes.weights.resize(n);
  WeightedDraws::Cells& cells = nodes.cells;
  if (with_cells > 0) {
    cells.mass.resize(with_cells);
    cells.node = Points::Zero(with_cells, d);
    cells.mean.resize(with_cells, d);
    cells.square.resize(with_cells, d);
    nodes.lower.assign(d, Points(with_cells, d));
    nodes.upper.assign(d, Points(with_cells, d));
  }
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, n, 256), [&](const auto& part) {
    for (Eigen::Index row = part.begin(); row != part.end(); ++row) {
      const Node& node = kept[static_cast<std::size_t>(row)];
      nodes.values.row(row) =
          lines.located(*node.line, static_cast<std::size_t>(node.t - node.line->first)).natural;
      nodes.weights[row] = node_mass(*node.line, node.t);
      if (row < with_cells) write_cell(lines, node, row, nodes);
    }
  });
  nodes.weights /= nodes.weights.sum();
  if (with_cells > 0) cells.mass /= cells.mass.sum();
  return nodes;
}

}  // namespace

ExactPosterior result_of(const Lines& lines, bool moments, bool with_cells) {
  const Eigen::Vector4d middle = lines.natural(lines.at(lines.all().front(), 0));
  const double mass = total(lines);
  constexpr std::size_t part = 256;  // lines per part, independent of the number of threads
  std::vector<Moments> parts((lines.all().size() + part - 1) / part);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    for (std::size_t l = i * part; l < std::min((i + 1) * part, lines.all().size()); ++l)
      add_moments(lines, lines.all()[l], middle, mass, parts[i]);
  });
  Moments sums;
  for (const Moments& each : parts) {
    sums.first += each.first;
    sums.second += each.second;
    sums.highest = std::max(sums.highest, each.highest);
    sums.kept.insert(sums.kept.end(), each.kept.begin(), each.kept.end());
  }
  ExactPosterior exact;
  exact.highest = sums.highest;
  const Eigen::Index cells = with_cells ? gather(sums.kept, gathered_share * mass) : 0;
  exact.nodes = nodes_of(lines, sums.kept, cells);
  exact.mean = middle + sums.first;
  exact.covariance = sums.second - sums.first * sums.first.transpose();
  if (!moments) exact.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  exact.sd = exact.covariance.diagonal().cwiseSqrt();
  bool proper = true;
  for (const Parameter& parameter : lines.posterior().parameters())
    proper &= parameter.prior.proper;
  exact.log_mass = lines.log_of(mass);
  if (proper) exact.log_evidence = exact.log_mass;
  return exact;
}
}  // namespace wearwell::lattice
