#include "wearwell/infer/lattice.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "wearwell/base/monitor.h"
#include "wearwell/bayes/posterior_along.h"
#include "wearwell/infer/lattice_chart.h"
#include "wearwell/infer/ridge_map.h"
#include "wearwell/math/systematic.h"

// Longer than others: one rule, whose lines are filled, assessed and converted in the same
// coordinates.
namespace wearwell {
namespace {

constexpr int d = 4, outer = 3;
using Index = std::array<std::int16_t, outer>;
using Z = LatticeChart::Z;
using Steps = std::array<double, d>;  // steps between lines along each axis, and along the lines

constexpr double negligible_share = 1e-9;  // nodes with less mass are omitted
// Nodes with less mass have no cells; a sample of them represents their neighbours. In a normal
// posterior they are six of ten nodes with a thousandth of the mass.
constexpr double gathered_share = 3e-7;
// The limit of evaluations, and the error that is accepted and reported if the limit is reached.
constexpr double good_enough = 1e-3, acceptable = 5e-3;
constexpr long most_nodes = 6'000'000;
constexpr int farthest = 3000;  // steps along an axis; with more, the mass is considered unbounded
// Finer than sums require: with cells that suffice for sums, quantiles have errors of some
// hundredths of a standard deviation, which decrease with the fourth power of the step.
constexpr double widest_reported = 0.55;
constexpr int most_across = 80;  // steps along a line on either side of its mode
constexpr double longest_on_line = 0.7;

// Coordinates of an outer axis: v, in which steps are even, and u of the chart. With a finite `far`
// steps in u are nearly even about the center and grow exponentially beyond, so that long tails end
// after few lines.
struct Axis {
  double center = 0, far = INFINITY;
  struct Place {
    double u, slope;
  };
  Place at(double v) const {
    if (std::isinf(far)) return {center + v, 1};
    const double e = std::exp(v / far);
    return {center + 0.5 * far * (e - 1 / e), 0.5 * (e + 1 / e)};
  }
};
using Axes = std::array<Axis, outer>;

std::uint64_t key(const Index& index) {
  std::uint64_t packed = 0;
  for (const std::int16_t i : index) packed = packed << 16 | static_cast<std::uint16_t>(i);
  return packed;
}

// A node's natural parameters, and the log Jacobian of its position on the real line.
struct Located {
  Eigen::Matrix<double, d, 1, Eigen::DontAlign> natural;
  double log_jacobian = 0;
};

// One line: the fourth coordinate is middle + width t at t = 0, +-step, +-2 step, ...
struct Line {
  Index index{};
  double middle = 0, width = 1;
  int first = 0;               // t of the first value divided by the step
  std::vector<double> values;  // log density minus the reference
  double highest = -INFINITY;
  std::vector<Located> kept;  // of each value; empty if too many to store
};

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

// The estimated error of sums over a lattice, relative to mass and second moments.
struct ErrorEstimate {
  double lacks = 0;  // from the size of the steps
  double decay =
      1;  // decay of the transform of the terms over the last quarter of the lattice's frequency
};
struct ErrorEstimates {
  std::array<ErrorEstimate, d> along{};  // for each axis, the worst direction that involves it
  double steps = 0;                      // of all directions
  double beyond = 0;                     // mass at the edge of the lattice
};

// The assessed mass, first and second moments, relative to their sizes.
using Terms = Eigen::Array<double, 2 * d + 1, 1>;

// The error of a lattice sum is the Fourier transform of its terms at the lattice's frequencies.
// Half and quarter lattices give the transform at a half and a quarter of these; its decay between
// them, exp(-c frequency), is extrapolated. Smooth terms decay faster. The terms of one parameter
// are assessed together, because a single one may vanish at a sign change.
ErrorEstimate beyond_lattice(const Terms& quarter, const Terms& half) {
  ErrorEstimate worst;
  for (int i = 1; i <= d; ++i) {
    const double at_quarter = std::max(quarter[0], quarter[i]),
                 at_half = std::max(half[0], half[i]);
    const double decay = at_quarter > at_half ? at_half / at_quarter : 1;
    const double lacks = std::max(at_half, half[i + d]) * decay * decay;
    if (lacks > worst.lacks) worst = {lacks, decay};
  }
  return worst;
}

class Lattice {
 public:
  Lattice(const Posterior& posterior, const LatticeChart& chart, const Axes& axes,
          const Steps& steps)
      : posterior_(posterior), chart_(chart), axes_(axes), steps_(steps) {
    reference_ = density(place({}, -1, 0, 0));
  }
  Lattice(const Lattice&) = delete;
  Lattice& operator=(const Lattice&) = delete;
  // Freeing tens of thousands of lines takes time.
  ~Lattice() {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines_.size(), 256),
                      [&](const auto& part) {
                        for (std::size_t l = part.begin(); l != part.end(); ++l) lines_[l] = {};
                      });
  }

  // Down to `log_negligible` relative to the highest density; what is there stays. Empty, or the
  // reason for stopping.
  std::string fill(double log_negligible, long most, Progress* progress) {
    log_negligible_ = log_negligible;
    std::vector<Line> ring;
    if (lines_.empty()) {
      ring.resize(1);
      known_.emplace(key(ring.front().index), 0);
    } else {
      lengthen(progress);
      if (const std::string failure = surround(0, ring); !failure.empty()) return failure;
    }
    while (!ring.empty()) {
      const std::size_t before = lines_.size();
      add(std::move(ring), progress);
      ring.clear();
      if (highest_ > 300 && !set_reference()) return "the density is unbounded";
      if (const std::string failure = surround(before, ring); !failure.empty()) return failure;
      if (nodes_ > most) return fmt::format("no convergence in {} evaluations", nodes_);
    }
    return {};
  }

  long nodes() const { return nodes_; }

  // Axes about the medians, stretched beyond the central mass.
  Axes stretched_axes() const {
    Axes axes;
    for (std::size_t a = 0; a < outer; ++a) {
      std::map<int, double> marginal;
      double all = 0;
      for (const Line& line : lines_) {
        double mass = 0;
        for (const double v : line.values) mass += std::exp(v) * line.width;
        marginal[line.index[a]] += mass;
        all += mass;
      }
      const auto quantile = [&](double p) {
        double below = 0;
        for (const auto& [index, mass] : marginal) {
          if (below + mass >= p * all) return steps_[a] * (index - 0.5 + (p * all - below) / mass);
          below += mass;
        }
        return steps_[a] * marginal.rbegin()->first;
      };
      constexpr double central = 0.9, normal = 1.645;
      const double sd = (quantile(0.5 + central / 2) - quantile(0.5 - central / 2)) / (2 * normal);
      axes[a] = {.center = quantile(0.5), .far = 5 * std::max(sd, 0.5 * steps_[a])};
    }
    return axes;
  }

  double log_of(double mass) const {
    for (const double step : steps_) mass *= step;
    return reference_ + std::log(mass) + chart_.log_scale();
  }

  ErrorEstimates error_estimates(bool moments) {
    const std::vector<LineSums> sums = line_sums(moments);
    ErrorEstimates error_estimates;
    // Each axis and each diagonal once.
    std::array<ErrorEstimate, directions> each;
    tbb::parallel_for(directions / 2 + 1, directions, [&](int direction) {
      const std::array<int, outer> way = way_of(direction);
      Terms real = Terms::Zero(), imaginary = real, half = real;
      for (std::size_t l = 0; l < lines_.size(); ++l) {
        int phase = 0;
        for (std::size_t a = 0; a < outer; ++a) phase += way[a] * lines_[l].index[a];
        const Terms& line = sums[l].all;
        ((phase & 1) != 0 ? imaginary : real) += (phase & 2) != 0 ? Terms(-line) : line;
        half += (phase & 1) != 0 ? Terms(-line) : line;
      }
      each[static_cast<std::size_t>(direction)] =
          beyond_lattice((real.square() + imaginary.square()).sqrt(), half.abs());
    });
    for (int direction = directions / 2 + 1; direction < directions; ++direction) {
      const ErrorEstimate& here = each[static_cast<std::size_t>(direction)];
      error_estimates.steps += here.lacks;
      for (std::size_t a = 0; a < outer; ++a) {
        if (way_of(direction)[a] != 0 && here.lacks > error_estimates.along[a].lacks)
          error_estimates.along[a] = here;
      }
    }
    Terms quarter[2] = {Terms::Zero(), Terms::Zero()}, half = Terms::Zero(),
          shell[2] = {half, half};
    for (const LineSums& line : sums) {
      for (const int i : {0, 1}) {
        quarter[i] += line.quarter[i];
        shell[i] += line.shell[i];
      }
      half += line.half;
    }
    error_estimates.along[outer] =
        beyond_lattice((quarter[0].square() + quarter[1].square()).sqrt(), half.abs());
    error_estimates.steps += error_estimates.along[outer].lacks;
    // The mass of the outer shells decreases; the ratio of the last two is extrapolated.
    for (const int i : {0, 5, 6, 7, 8}) {
      if (!(shell[0][i] > 0)) continue;
      const double falls = std::min(shell[0][i] / shell[1][i], 0.98);
      error_estimates.beyond = std::max(error_estimates.beyond, shell[0][i] * falls / (1 - falls));
    }
    return error_estimates;
  }

  // Without cells the nodes are valid only for sums.
  ExactPosterior result(bool moments, bool with_cells) {
    const Eigen::Vector4d middle = natural(at(lines_.front(), 0));
    const double mass = total();
    constexpr std::size_t part = 256;  // lines per part, independent of the number of threads
    std::vector<Moments> parts((lines_.size() + part - 1) / part);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      for (std::size_t l = i * part; l < std::min((i + 1) * part, lines_.size()); ++l)
        add_moments(lines_[l], middle, mass, parts[i]);
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
    exact.nodes = nodes_of(sums.kept, cells);
    exact.mean = middle + sums.first;
    exact.covariance = sums.second - sums.first * sums.first.transpose();
    if (!moments) exact.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
    exact.sd = exact.covariance.diagonal().cwiseSqrt();
    bool proper = true;
    for (const Parameter& parameter : posterior_.parameters()) proper &= parameter.prior.proper;
    exact.log_mass = log_of(mass);
    if (proper) exact.log_evidence = exact.log_mass;
    return exact;
  }

 private:
  static constexpr int directions = 27;     // directions of the outer axes, with opposites and zero
  static constexpr double shell_depth = 3;  // of log density

  // Fills these lines.
  void add(std::vector<Line> ring, Progress* progress) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ring.size(), 8), [&](const auto& part) {
      Sides sides;
      for (std::size_t i = part.begin(); i != part.end(); ++i) integrate(ring[i], sides);
    });
    std::move(ring.begin(), ring.end(), std::back_inserter(lines_));
    count(lines_.size() - ring.size(), progress);
  }

  // Continues lines that ended at a higher density than is negligible now.
  void lengthen(Progress* progress) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines_.size(), 8), [&](const auto& part) {
      Sides sides;
      for (std::size_t i = part.begin(); i != part.end(); ++i) lengthen(lines_[i], sides);
    });
    nodes_ = 0;
    count(0, progress);
  }

  // Counts the nodes of lines from `first` on.
  void count(std::size_t first, Progress* progress) {
    constexpr long most_kept = 1'500'000;  // some tens of megabytes
    for (std::size_t i = first; i < lines_.size(); ++i) {
      nodes_ += static_cast<long>(lines_[i].values.size());
      highest_ = std::max(highest_, lines_[i].highest);
    }
    if (progress && nodes_ > reported_)
      progress->advance(nodes_ - std::exchange(reported_, nodes_));
    if (!keeps_ || nodes_ <= most_kept) return;
    keeps_ = false;
    for (Line& line : lines_) std::vector<Located>().swap(line.kept);
  }

  // Adds to `ring` the unknown neighbours of lines from `first` on with mass that matters. Empty, or
  // the reason for stopping.
  std::string surround(std::size_t first, std::vector<Line>& ring) {
    for (std::size_t i = first; i < lines_.size(); ++i) {
      const Line& line = lines_[i];
      if (line.highest < highest_ + log_negligible_) continue;
      for (std::size_t a = 0; a < outer; ++a) {
        for (const int way : {-1, 1}) {
          Line next;
          next.index = line.index;
          next.index[a] = static_cast<std::int16_t>(next.index[a] + way);
          if (std::abs(next.index[a]) > farthest)
            return "its mass is unbounded: the posterior is improper or far too wide";
          if (!known_.emplace(key(next.index), lines_.size() + ring.size()).second) continue;
          next.middle = line.middle;
          next.width = line.width;
          ring.push_back(std::move(next));
        }
      }
    }
    return {};
  }

  // The direction of a wave: -1, 0 or 1 along each outer axis.
  static std::array<int, outer> way_of(int direction) {
    return {direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 % 3 - 1};
  }

  // Sums over all nodes, in the order of lines for any number of threads.
  double total() const {
    std::vector<double> masses(lines_.size(), 0.0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines_.size(), 256),
                      [&](const auto& part) {
                        for (std::size_t l = part.begin(); l != part.end(); ++l) {
                          for (const double v : lines_[l].values)
                            masses[l] += std::exp(v) * lines_[l].width;
                        }
                      });
    return std::accumulate(masses.begin(), masses.end(), 0.0);
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
  void add_moments(const Line& line, const Eigen::Vector4d& middle, double mass,
                   Moments& sums) const {
    for (std::size_t j = 0; j < line.values.size(); ++j) {
      const double here = std::exp(line.values[j]) * line.width;
      if (here == 0) continue;
      if (here > negligible_share * mass)
        sums.kept.push_back({&line, line.first + static_cast<int>(j), here});
      const Located there = located(line, j);
      sums.highest = std::max(sums.highest, reference_ + line.values[j] - there.log_jacobian);
      const Eigen::Vector4d x = there.natural - middle;
      sums.first += here / mass * x;
      sums.second += here / mass * (x * x.transpose());
    }
  }

  // Moves nodes with cells to the front and returns their number. Nodes with less mass than `least`
  // are sampled in the order of the lattice; a sampled node represents its neighbours.
  static Eigen::Index gather(std::vector<Node>& nodes, double least) {
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

  // The first `with_cells` of them have cells.
  WeightedDraws nodes_of(const std::vector<Node>& kept, Eigen::Index with_cells) const {
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
            located(*node.line, static_cast<std::size_t>(node.t - node.line->first)).natural;
        nodes.weights[row] = node_mass(*node.line, node.t);
        if (row < with_cells) write_cell(node, row, nodes);
      }
    });
    nodes.weights /= nodes.weights.sum();
    if (with_cells > 0) cells.mass /= cells.mass.sum();
    return nodes;
  }

  void write_cell(const Node& node, Eigen::Index row, WeightedDraws& nodes) const {
    const Line& line = *node.line;
    const int t = node.t;
    CellShape shape(nodes.weights[row]);
    shape.along(outer, node_mass(line, t - 1), node_mass(line, t + 1));
    nodes.lower[outer].row(row) = natural(at(line, t - 0.5));
    nodes.upper[outer].row(row) = natural(at(line, t + 0.5));
    for (int a = 0; a < outer; ++a) {
      const Line &below = neighbour(line, a, -1), &above = neighbour(line, a, 1);
      shape.along(a, mass_in(below, line, t), mass_in(above, line, t));
      const auto axis = static_cast<std::size_t>(a);
      nodes.lower[axis].row(row) = natural(between(line, below, above, a, -0.5, t));
      nodes.upper[axis].row(row) = natural(between(line, above, below, a, 0.5, t));
    }
    shape.write(row, nodes.cells);
    nodes.cells.mass[row] *= node.mass / nodes.weights[row];
  }

  Located locate(const Line& line, std::size_t j) const {
    const Place there = at(line, line.first + static_cast<int>(j));
    return {natural(there), there.log_jacobian};
  }
  Located located(const Line& line, std::size_t j) const {
    return line.kept.empty() ? locate(line, j) : line.kept[j];
  }

  // For one line: its sum, the sum with alternating signs, the sums at a quarter of the frequency,
  // and the two outermost shells.
  struct LineSums {
    Terms all = Terms::Zero(), half = all, quarter[2] = {all, all}, shell[2] = {all, all};
  };

  // Terms about the mean, scaled; first moments by the scale of the second.
  std::vector<LineSums> line_sums(bool moments) const {
    const Eigen::Vector4d middle = natural(at(lines_.front(), 0));
    std::vector<LineSums> sums(lines_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines_.size(), 64), [&](const auto& part) {
      for (std::size_t i = part.begin(); i != part.end(); ++i)
        sums[i] = sum_of(lines_[i], middle, moments);
    });
    Terms all = Terms::Zero();
    for (const LineSums& line : sums) all += line.all;
    const Eigen::Array4d mean = all.segment<d>(1) / all[0];
    const auto about_mean = [&](Terms& terms) {
      terms.segment<d>(1 + d) += mean * (mean * terms[0] - 2 * terms.segment<d>(1));
      terms.segment<d>(1) -= mean * terms[0];
    };
    Terms size = all;
    about_mean(size);
    size.segment<d>(1) = (all[0] * size.segment<d>(1 + d)).sqrt();
    for (int i = 0; i < 2 * d + 1; ++i) {
      if (!(size[i] > 0)) size[i] = INFINITY;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sums.size(), 256), [&](const auto& part) {
      for (std::size_t i = part.begin(); i != part.end(); ++i) {
        LineSums& line = sums[i];
        for (Terms* terms : {&line.all, &line.half, &line.quarter[0], &line.quarter[1],
                             &line.shell[0], &line.shell[1]}) {
          about_mean(*terms);
          *terms /= size;
        }
      }
    });
    return sums;
  }

  LineSums sum_of(const Line& line, const Eigen::Vector4d& middle, bool moments) const {
    LineSums sums;
    for (std::size_t j = 0; j < line.values.size(); ++j) {
      const int t = line.first + static_cast<int>(j);
      const double mass = std::exp(line.values[j]) * line.width;
      if (mass == 0) continue;
      Terms here = Terms::Zero();
      here[0] = mass;
      if (moments) {
        const Eigen::Array4d x = (located(line, j).natural - middle).array();
        here.segment<d>(1) = mass * x;
        here.segment<d>(1 + d) = mass * x * x;
      }
      sums.all += here;
      sums.half += (t & 1) != 0 ? Terms(-here) : here;
      sums.quarter[t & 1] += (t & 2) != 0 ? Terms(-here) : here;
      const double over_end = line.values[j] - highest_ - log_negligible_;
      if (over_end > 0 && over_end < 2 * shell_depth)
        sums.shell[over_end < shell_depth ? 0 : 1] += here;
    }
    return sums;
  }

  // A point of a line, or near it.
  struct Place {
    Z z;                      // on the real line
    double log_jacobian = 0;  // of z with respect to u
  };
  // The three coordinates: step (index + shift along one axis).
  Place place(const Index& index, int axis, double shift, double on_line) const {
    Eigen::Vector4d along;
    double slopes = 1;
    for (int i = 0; i < outer; ++i) {
      const auto a = static_cast<std::size_t>(i);
      const Axis::Place there = axes_[a].at(steps_[a] * (index[a] + (i == axis ? shift : 0)));
      along[i] = there.u;
      slopes *= there.slope;
    }
    along[outer] = on_line;
    Place place;
    place.log_jacobian = chart_.to_real(along, place.z) + std::log(slopes);
    return place;
  }
  Place at(const Line& line, double t) const {
    return place(line.index, -1, 0, line.middle + line.width * steps_[outer] * t);
  }
  double density(const Place& there) const {
    return posterior_.value(there.z) + there.log_jacobian;
  }
  // Half way to a neighbour, at the same position across the ridge, whose curve is the parabola
  // through both neighbours.
  Place between(const Line& line, const Line& other, const Line& opposite, int axis, double shift,
                int t) const {
    const auto half_way = [](double here, double there, double back) {
      return 0.375 * there + 0.75 * here - 0.125 * back;
    };
    return place(line.index, axis, shift,
                 half_way(line.middle, other.middle, opposite.middle) +
                     half_way(line.width, other.width, opposite.width) * steps_[outer] * t);
  }

  Eigen::Vector4d natural(const Place& there) const {
    Eigen::Vector4d x;
    posterior_.to_natural(there.z, std::span<double>(x.data(), d));
    return x;
  }

  const Line& neighbour(const Line& line, int axis, int way) const {
    Index index = line.index;
    index[axis] = static_cast<std::int16_t>(index[axis] + way);
    const auto found = known_.find(key(index));
    return found == known_.end() ? line : lines_[found->second];
  }

  double node_mass(const Line& line, int t) const {
    const int j = t - line.first;
    if (j < 0 || j >= static_cast<int>(line.values.size())) return 0;
    return std::exp(line.values[static_cast<std::size_t>(j)]) * line.width;
  }
  // Beyond the outermost lines there is nothing.
  double mass_in(const Line& other, const Line& line, int t) const {
    return &other == &line ? 0 : node_mass(other, t);
  }

  // Makes the highest density so far the reference, if the walk began far below the mode. False if
  // it was moved so often that the density is unbounded.
  bool set_reference() {
    constexpr int most = 20;
    if (++moves_ > most || !std::isfinite(highest_)) return false;
    for (Line& line : lines_) {
      line.highest -= highest_;
      for (double& value : line.values) value -= highest_;
    }
    reference_ += highest_;
    highest_ = 0;
    return true;
  }

  // The density along one line, and the positions of its points.
  class Walk {
   public:
    Walk(const Lattice& lattice, const Line& line) : lattice_(lattice), index_(line.index) {
      const auto parameter = lattice.chart_.line_parameter();
      if (!parameter) return;
      there_ = lattice.place(index_, -1, 0, line.middle);
      along_.emplace(lattice.posterior_, there_.z, *parameter);
      others_ = there_.log_jacobian - lattice.chart_.on_line(line.middle).log_slope;
    }

    double value(double on_line) {
      if (!along_) {
        there_ = lattice_.place(index_, -1, 0, on_line);
        return lattice_.density(there_) - lattice_.reference_;
      }
      const LatticeChart::OnLine here = lattice_.chart_.on_line(on_line);
      there_.log_jacobian = others_ + here.log_slope;
      return along_->value(here.z) + there_.log_jacobian - lattice_.reference_;
    }
    // Of the last evaluated point.
    Located located() const {
      if (!along_) return {lattice_.natural(there_), there_.log_jacobian};
      return {Eigen::Map<const Eigen::Vector4d>(along_->natural().data()), there_.log_jacobian};
    }

   private:
    const Lattice& lattice_;
    Index index_;
    Place there_;
    std::optional<PosteriorAlong> along_;
    double others_ = 0;  // log Jacobian of the fixed parameters
  };

  // Workspace of a walk: nodes in the negative and the positive direction.
  struct Sides {
    std::array<std::vector<double>, 2> values;
    std::array<std::vector<Located>, 2> kept;
  };

  // Finds the line's mode by parabolas, starting from its neighbor's mode, then walks outward on
  // both sides.
  void integrate(Line& line, Sides& sides) const {
    Walk walk(*this, line);
    double middle = walk.value(line.middle);
    for (int iteration = 0; iteration < 6; ++iteration) {
      const double reach = 0.7 * line.width;
      const double below = walk.value(line.middle - reach), above = walk.value(line.middle + reach);
      const double bend = 2 * middle - below - above;
      if (!std::isfinite(bend) || !(bend > 1e-8)) break;
      const double slope = 0.5 * (above - below);
      const double width = reach / std::sqrt(bend);
      // Far from the mode the parabola is only a direction.
      const double move = std::clamp(slope / bend * reach, -8 * line.width, 8 * line.width);
      const double there = walk.value(line.middle + move);
      if (!(there >= middle)) break;
      line.middle += move;
      line.width = std::clamp(width, 0.25 * line.width, 4 * line.width);
      middle = there;
      if (std::abs(move) < 0.05 * line.width) break;
    }
    line.values.push_back(walk.value(line.middle));
    line.highest = line.values.front();
    if (keeps_) line.kept.push_back(walk.located());
    walk_outward(walk, line, sides);
  }

  // Nodes of a line beyond its present ones.
  void lengthen(Line& line, Sides& sides) const {
    const double end = std::max(line.highest, highest_) + log_negligible_;
    if (!(line.values.front() > end) && !(line.values.back() > end)) return;
    Walk walk(*this, line);
    walk_outward(walk, line, sides);
  }

  void walk_outward(Walk& walk, Line& line, Sides& sides) const {
    const auto farther = [&](double value) {
      return value > std::max(line.highest, highest_) + log_negligible_;
    };
    const int last = line.first + static_cast<int>(line.values.size()) - 1;
    for (const int way : {-1, 1}) {
      std::vector<double>& values = sides.values[way < 0 ? 0 : 1];
      std::vector<Located>& kept = sides.kept[way < 0 ? 0 : 1];
      values.clear();
      kept.clear();
      double v = way < 0 ? line.values.front() : line.values.back();
      const bool first = line.values.size() == 1;
      for (int t = (way < 0 ? line.first : last) + way;
           std::abs(t) <= most_across && (farther(v) || (first && values.empty())); t += way) {
        v = walk.value(line.middle + t * steps_[outer] * line.width);
        values.push_back(v);
        if (keeps_) kept.push_back(walk.located());
        line.highest = std::max(line.highest, v);
      }
    }
    const auto join = [](auto& here, const auto& both) {
      here.reserve(here.size() + both[0].size() + both[1].size());
      here.insert(here.begin(), both[0].rbegin(), both[0].rend());
      here.insert(here.end(), both[1].begin(), both[1].end());
    };
    line.first -= static_cast<int>(sides.values[0].size());
    join(line.values, sides.values);
    if (keeps_) join(line.kept, sides.kept);
  }

  const Posterior& posterior_;
  const LatticeChart& chart_;
  Axes axes_;
  Steps steps_;
  double log_negligible_ = 0;
  double reference_;
  double highest_ = -INFINITY;
  long nodes_ = 0, reported_ = 0;
  int moves_ = 0;      // of the reference
  bool keeps_ = true;  // whether positions of nodes are stored
  std::vector<Line> lines_;
  std::unordered_map<std::uint64_t, std::size_t> known_;
};

// The relative density at which the lattice ends; it depends on the tolerance.
double log_negligible(double tolerance) {
  return std::max(-22.0, -22 + std::log(tolerance / 1e-5));
}

Steps steps_of(double step) {
  return {step, step, step, std::min(step, longest_on_line)};
}

// A filled lattice, or the reason of its failure.
struct Filled {
  Lattice lattice;
  std::string failure;
  ErrorEstimates error_estimates;
  double error = INFINITY;  // infinite unless filled
  long evaluations = 0;     // of the last filling

  Filled(const Posterior& posterior, const LatticeChart& chart, const Axes& axes,
         const Steps& steps, double log_negligible, long most, const ExactSettings& settings)
      : lattice(posterior, chart, axes, steps) {
    fill(log_negligible, most, settings);
  }

  void fill(double log_negligible, long most, const ExactSettings& settings) {
    const long before = lattice.nodes();
    failure = lattice.fill(log_negligible, most, settings.progress);
    evaluations = lattice.nodes() - before;
    error = INFINITY;
    if (!failure.empty()) return;
    error_estimates = lattice.error_estimates(settings.second_moments);
    error = error_estimates.steps + error_estimates.beyond;
  }
};

// Refines each axis separately, so that a narrow axis does not refine the others. Errors decay as
// exp(-c/step), faster for coarse steps.
Steps next_steps(const Steps& steps, const ErrorEstimates& error_estimates, double tolerance,
                 const Steps& widest) {
  constexpr double share = 0.2, least = 1.15, most = 2.5, coarse = 0.6;
  Steps next;
  for (std::size_t a = 0; a < d; ++a) {
    const ErrorEstimate& error_estimate = error_estimates.along[a];
    const double too_much = std::log(error_estimate.lacks / (share * tolerance));
    const double faster = steps[a] > coarse ? 1.5 : 1;
    const double finer =
        1 + too_much / (-4 * faster * std::log(std::min(error_estimate.decay, 0.9)));
    const bool refined = too_much > 0 && error_estimates.steps > 0.5 * tolerance;
    const double step = refined ? steps[a] / std::clamp(finer, least, most) : steps[a];
    next[a] = std::min(widest[a], step);
  }
  return next;
}

double mean_step(const Steps& steps) {
  return std::pow(steps[0] * steps[1] * steps[2] * steps[3], 1.0 / d);
}

// Coordinates and a coarse lattice in them.
struct Coordinates {
  const LatticeChart* chart = nullptr;
  Axes axes;
  std::shared_ptr<Filled> coarse;
};

// The lattice with the least error, if it is acceptable, or the reason of its failure.
struct Refined {
  std::shared_ptr<Filled> best;
  std::string failure;  // empty if the error is below the tolerance
  long evaluations = 0;
};

constexpr double coarsest = 1;

// Refines and deepens until the error is at most `enough` and steps are at most `widest`.
Refined refine(const Posterior& posterior, const Coordinates& in, double enough,
               const Steps& widest, const ExactSettings& settings) {
  const double first_end = log_negligible(settings.tolerance);
  double end = first_end;
  bool may_deepen = true;
  std::shared_ptr<Filled> filled = in.coarse;
  Refined refined;
  double before = INFINITY, step_before = coarsest;
  for (Steps steps = steps_of(coarsest); refined.evaluations < settings.max_evaluations;) {
    if (settings.stop.stop_requested()) throw Cancelled();
    if (!filled)
      filled =
          std::make_shared<Filled>(posterior, *in.chart, in.axes, steps, end, most_nodes, settings);
    refined.evaluations += filled->evaluations;
    if (!filled->failure.empty()) {
      refined.failure = filled->failure;
      if (end == first_end) break;
      // Too many nodes in the tails; the mass beyond is then reported.
      end = first_end;
      may_deepen = false;
      if (refined.best == filled) refined.best.reset();
      filled.reset();
      continue;
    }
    const double error = filled->error;
    const ErrorEstimates error_estimates = filled->error_estimates;
    if (error <= std::max(enough, acceptable) && !(refined.best && refined.best->error < error))
      refined.best = filled;
    const bool fine = std::equal(steps.begin(), steps.end(), widest.begin(), std::less_equal<>());
    if (error <= enough && fine) {
      refined.failure.clear();
      break;
    }
    refined.failure = fmt::format("no convergence in {} evaluations", refined.evaluations);
    // With a kink or a jump errors decrease only by a power of the step; a refinement that exceeds
    // the evaluations is not started. A small change of the step shows no power.
    const double step = mean_step(steps);
    if (!std::isfinite(before) || step < 0.9 * step_before) {
      const double power = std::log(before / error_estimates.steps) / std::log(step_before / step);
      const bool hopeless =
          std::isfinite(before) &&
          (error_estimates.steps >= before || std::pow(error_estimates.steps / enough, 4 / power) *
                                                      static_cast<double>(refined.evaluations) >
                                                  static_cast<double>(settings.max_evaluations));
      before = error_estimates.steps;
      step_before = step;
      if (hopeless && refined.best && refined.best->error <= good_enough) break;
    }
    const Steps finer = next_steps(steps, error_estimates, enough, widest);
    // The mass beyond is about proportional to the density at the end.
    const double most_beyond = 0.5 * enough;
    const bool deeper = may_deepen && error_estimates.beyond > most_beyond;
    if (deeper) end -= std::clamp(1.5 * std::log(error_estimates.beyond / most_beyond), 1.0, 4.0);
    if (finer != steps) {
      steps = finer;
      filled.reset();
    } else if (deeper) {
      filled->fill(end, most_nodes, settings);
    } else {
      break;
    }
  }
  return refined;
}

}  // namespace

ExactPosterior integrate_on_lattice(const Posterior& posterior, const Whitening& whitening,
                                    const ExactSettings& settings) {
  std::optional<RidgeMap> map;
  std::unique_ptr<const LatticeChart> straight, along;
  if (settings.along_ridge != true) straight = straight_chart(posterior, whitening);
  if (settings.along_ridge != false) {
    map.emplace(posterior, whitening);
    along = ridge_chart(*map);
  }
  // Error estimates of coarse lattices are several times too large.
  const bool coarse = settings.tolerance >= good_enough;
  const double enough = coarse ? 5 * settings.tolerance : settings.tolerance;
  const auto filled_on = [&](const LatticeChart& chart, const Axes& axes, double step, long most) {
    return std::make_shared<Filled>(posterior, chart, axes, steps_of(step),
                                    log_negligible(settings.tolerance), most, settings);
  };
  Coordinates in;
  in.chart = straight ? straight.get() : along.get();
  in.coarse = filled_on(*in.chart, {}, coarsest, most_nodes);
  // Chooses between the charts by lattices of medium steps. If one is expensive, chooses the other.
  constexpr double telling = 0.7;
  constexpr long few_nodes = 140'000, enough_nodes = 400'000;
  if (!settings.along_ridge && !map->affine() && !(in.coarse->error <= enough)) {
    const bool expensive = !in.coarse->failure.empty() || in.coarse->lattice.nodes() > few_nodes;
    // A chart whose coarse lattice has 50 % more nodes is not better; few nodes suffice to see
    // this.
    const auto rounder = [&] {
      return filled_on(*along, {}, coarsest, in.coarse->lattice.nodes() / 2 * 3)->failure.empty() &&
             filled_on(*along, {}, telling, enough_nodes)->error <
                 filled_on(*straight, {}, telling, enough_nodes)->error;
    };
    if (expensive ? filled_on(*along, {}, coarsest, few_nodes)->failure.empty() : rounder()) {
      in.chart = along.get();
      in.coarse = filled_on(*in.chart, {}, coarsest, most_nodes);
    }
  }
  const Steps widest = steps_of(coarse ? coarsest : widest_reported);
  Refined refined;
  // Long tails take most nodes. If axes that end them soon do not converge, even ones remain.
  constexpr long long_tails = 30'000;
  if (in.coarse->failure.empty() && in.coarse->lattice.nodes() > long_tails) {
    Coordinates stretched = in;
    stretched.axes = in.coarse->lattice.stretched_axes();
    const long most = in.coarse->lattice.nodes() / 2;
    stretched.coarse = filled_on(*in.chart, stretched.axes, coarsest, most);
    if (stretched.coarse->failure.empty())
      refined = refine(posterior, stretched, enough, widest, settings);
  }
  if (!refined.best || !refined.failure.empty()) {
    Refined even = refine(posterior, in, enough, widest, settings);
    even.evaluations += refined.evaluations;
    if (even.best || !refined.best) refined = std::move(even);
  }
  ExactPosterior exact;
  if (refined.best) {
    exact = refined.best->lattice.result(settings.second_moments, settings.cells);
    exact.error = refined.best->error;
  } else {
    exact.failure = refined.failure;
  }
  exact.evaluations = refined.evaluations;
  exact.along_ridge = in.chart == along.get();
  return exact;
}

}  // namespace wearwell
