#include "wearwell/infer/lattice.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <unordered_map>

#include "wearwell/base/monitor.h"
#include "wearwell/infer/ridge_map.h"

// Longer than others: one rule, whose lines are filled, judged and told in the same coordinates.
namespace wearwell {
namespace {

constexpr int d = 4, outer = 3;
using Index = std::array<std::int16_t, outer>;
using Z = std::array<double, d>;

constexpr double negligible_share = 1e-9;  // nodes with less of the mass are left out
constexpr double good_enough = 1e-3;       // where evaluations end before the tolerance is met
constexpr long most_nodes = 6'000'000;
constexpr int farthest = 3000;  // steps along an axis: beyond, the mass has no end
// Finer than sums ask for: quantiles of a posterior whose cells are as wide as those that sum well are wrong by some
// hundredths of a standard deviation, which falls with the fourth power of the step.
constexpr double widest_told = 0.55;
constexpr int most_across = 80;  // steps along a line on either side of its mode
// Of the step between lines that along them: half the lines are a lattice of finer dual than every second node of a line.
constexpr double line_share = 0.8, longest_on_line = 0.7;

std::uint64_t key(const Index& index) {
  std::uint64_t packed = 0;
  for (const std::int16_t i : index) packed = packed << 16 | static_cast<std::uint16_t>(i);
  return packed;
}

// Coordinates in which the posterior is to be round and of unit size: lines run along the last one.
class Chart {
 public:
  virtual ~Chart() = default;
  /// On the real line; returns the log of the volume of z by that of u, less log_scale().
  virtual double to_real(const Eigen::Vector4d& u, Z& z) const = 0;
  virtual double log_scale() const = 0;
};

// Of a parameter between two bounds the density on the real line falls no faster than exp(-|z|), so that a lattice has to
// go 22 units out: z = w sqrt(1 + (w/5)^2) is nearly the normal quantile of its uniform share, scaled to slope 1, and makes
// of that tail a normal one. Others stay as they are.
class Bending {
 public:
  explicit Bending(const Posterior& posterior) {
    for (std::size_t i = 0; i < d; ++i) {
      const Law& prior = posterior.parameters()[i].prior;
      bent_[i] = std::isfinite(prior.lower) && std::isfinite(prior.upper);
    }
  }

  double from_real(std::size_t i, double z) const {
    if (!bent_[i]) return z;
    const double square = 2 * z * z / (1 + std::sqrt(1 + 4 * z * z / (far * far)));
    return std::copysign(std::sqrt(square), z);
  }
  double slope(std::size_t i, double w) const {
    return bent_[i] ? (1 + 2 * square_of(w)) / std::sqrt(1 + square_of(w)) : 1;
  }
  // Makes z of w; returns the log of the product of the slopes.
  double to_real(Z& w) const {
    double slopes = 1;
    for (std::size_t i = 0; i < d; ++i) {
      if (!bent_[i]) continue;
      const double square = square_of(w[i]), root = std::sqrt(1 + square);
      slopes *= (1 + 2 * square) / root;
      w[i] *= root;
    }
    return std::log(slopes);
  }

 private:
  static constexpr double far = 5;
  static double square_of(double w) { return (w / far) * (w / far); }
  std::array<bool, d> bent_{};
};

// Lines along the parameter that the others hold closest, so that they follow a narrow ridge in it
// that bends; the others by their covariance.
class Straight final : public Chart {
 public:
  Straight(const Posterior& posterior, const Whitening& whitening) : bending_(posterior) {
    Eigen::Vector4d center, slopes;
    for (int i = 0; i < d; ++i) {
      const auto at = static_cast<std::size_t>(i);
      center[i] = bending_.from_real(at, whitening.center[i]);
      slopes[i] = bending_.slope(at, center[i]);
    }
    const Eigen::Matrix4d scale = slopes.cwiseInverse().asDiagonal() * whitening.scale;
    const Eigen::Matrix4d covariance = scale * scale.transpose();
    const Eigen::Matrix4d precision = covariance.inverse();
    // The smallest share of its variance that is left when the others are known.
    double least = INFINITY;
    for (int i = 0; i < d; ++i) {
      const double share = 1 / (precision(i, i) * covariance(i, i));
      if (share < least * (1 - 1e-9)) {
        least = share;
        line_ = i;
      }
    }
    for (int i = 0, at = 0; i < d; ++i) {
      if (i != line_) rest_[static_cast<std::size_t>(at++)] = i;
    }
    Eigen::Matrix3d block;
    for (int i = 0; i < outer; ++i) {
      center_[i] = center[rest_[static_cast<std::size_t>(i)]];
      for (int j = 0; j < outer; ++j)
        block(i, j) =
            covariance(rest_[static_cast<std::size_t>(i)], rest_[static_cast<std::size_t>(j)]);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block);
    scale_ = eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().asDiagonal();
    line_center_ = center[line_];
    line_scale_ = 1 / std::sqrt(precision(line_, line_));
  }

  double to_real(const Eigen::Vector4d& u, Z& z) const override {
    const Eigen::Vector3d three = center_ + scale_ * u.head<outer>();
    for (int i = 0; i < outer; ++i)
      z[static_cast<std::size_t>(rest_[static_cast<std::size_t>(i)])] = three[i];
    z[static_cast<std::size_t>(line_)] = line_center_ + line_scale_ * u[outer];
    return bending_.to_real(z);
  }
  double log_scale() const override {
    return std::log(std::abs(scale_.determinant()) * line_scale_);
  }

 private:
  Bending bending_;
  int line_ = 0;
  std::array<int, outer> rest_{};
  Eigen::Vector3d center_;
  Eigen::Matrix3d scale_;
  double line_center_ = 0, line_scale_ = 1;
};

// Along the ridge of a funnel. The lattice stands askew in the coordinates of the map: along an axis
// whole layers of cells would share one value of a parameter, whose distribution would have steps.
class AlongRidge final : public Chart {
 public:
  explicit AlongRidge(const RidgeMap& map) : map_(map) {
    const Eigen::Vector4d v =
        Eigen::Vector4d(1, std::sqrt(2), std::sqrt(3), std::sqrt(5)) / std::sqrt(11);
    askew_ = Eigen::Matrix4d::Identity() - 2 * v * v.transpose();
  }

  double to_real(const Eigen::Vector4d& u, Z& z) const override {
    RidgeMap::Coordinates turned;
    Eigen::Map<Eigen::Vector4d>(turned.data()).noalias() = askew_ * u;
    const RidgeMap::Frame frame = map_.at(turned[static_cast<std::size_t>(map_.axis())]);
    map_.to_real(frame, turned, z);
    return frame.log_jacobian;
  }
  double log_scale() const override { return map_.log_scale(); }

 private:
  const RidgeMap& map_;
  Eigen::Matrix4d askew_;
};

// One line: the fourth coordinate is middle + width t at t = 0, +-step, +-2 step, ...
struct Line {
  Index index{};
  double middle = 0, width = 1;
  int first = 0;               // t of the first value over the step
  std::vector<double> values;  // log density less the reference
  double highest = -INFINITY;
};

// What lies in a cell: along each axis the logarithm of the mass is the parabola through that of its node and of both
// neighbours, in cell lengths.
class CellShape {
 public:
  explicit CellShape(double node) : node_(node) {}

  void along(int axis, double below, double above) {
    auto& [mass, mean, square] = along_[static_cast<std::size_t>(axis)];
    // Beside nothing, at an edge, and where mass lies on both sides rather than here, the cell is filled evenly.
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
  // Gauss and Legendre's rule of five nodes on -1/2..1/2.
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

class Lattice {
 public:
  /// Filled down to `log_negligible` of the highest density.
  Lattice(const Posterior& posterior, const Chart& chart, double step, double line_step,
          double log_negligible)
      : posterior_(posterior),
        chart_(chart),
        step_(step),
        line_step_(line_step),
        log_negligible_(log_negligible) {
    reference_ = density(place({}, -1, 0, 0));
  }

  // Empty, or why it stopped.
  std::string fill(long most) {
    std::vector<Line> ring(1);
    known_.emplace(key(ring.front().index), 0);
    while (!ring.empty()) {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ring.size(), 8), [&](const auto& part) {
        for (std::size_t i = part.begin(); i != part.end(); ++i) integrate(ring[i]);
      });
      for (const Line& line : ring) {
        nodes_ += static_cast<long>(line.values.size());
        highest_ = std::max(highest_, line.highest);
      }
      const std::size_t before = lines_.size();
      std::move(ring.begin(), ring.end(), std::back_inserter(lines_));
      ring.clear();
      if (highest_ > 300 && !set_reference()) return "the density grows without bound";
      for (std::size_t i = before; i < lines_.size(); ++i) {
        const Line& line = lines_[i];
        if (line.highest < highest_ + log_negligible_) continue;
        for (int a = 0; a < outer; ++a) {
          for (const int way : {-1, 1}) {
            Line next;
            next.index = line.index;
            next.index[a] = static_cast<std::int16_t>(next.index[a] + way);
            if (std::abs(next.index[a]) > farthest) {
              return "its mass does not end: it is improper or far too wide";
            }
            next.middle = line.middle;
            next.width = line.width;
            if (known_.emplace(key(next.index), lines_.size() + ring.size()).second) {
              ring.push_back(std::move(next));
            }
          }
        }
      }
      if (nodes_ > most) return fmt::format("no convergence in {} evaluations", nodes_);
    }
    return {};
  }

  long nodes() const { return nodes_; }

  // Sums of mass and second moments over the half lattices: of the lines by the parity of their
  // index, and along the lines. Relative differences, the largest.
  double error(bool moments) const {
    Eigen::Matrix<double, 2 * d + 1, 4> sums = Eigen::Matrix<double, 2 * d + 1, 4>::Zero();
    const Eigen::Vector4d middle = natural(at(lines_.front(), 0));
    for (const Line& line : lines_) {
      const int parity = (line.index[0] + line.index[1] + line.index[2]) & 1;
      for (std::size_t j = 0; j < line.values.size(); ++j) {
        const int t = line.first + static_cast<int>(j);
        const double mass = std::exp(line.values[j]) * line.width;
        if (mass == 0) continue;
        Eigen::Matrix<double, 2 * d + 1, 1> terms = Eigen::Matrix<double, 2 * d + 1, 1>::Zero();
        terms[0] = mass;
        if (moments) {
          const Eigen::Vector4d x = natural(at(line, t)) - middle;
          terms.segment<d>(1) = mass * x;
          terms.segment<d>(1 + d) = mass * x.cwiseAbs2();
        }
        sums.col(parity) += terms;
        sums.col(2 + (t & 1)) += terms;
      }
    }
    const Eigen::Matrix<double, 2 * d + 1, 1> all = sums.col(0) + sums.col(1);
    double worst = 0;
    for (int i = 0; i < 2 * d + 1; ++i) {
      // First moments are judged by the size of the second.
      const double size = i == 0 || i > d ? all[i] : std::sqrt(all[0] * all[i + d]);
      if (!(size > 0)) continue;
      for (const int pair : {0, 2}) {
        worst = std::max(worst, std::abs(sums(i, pair) - sums(i, pair + 1)) / size);
      }
    }
    return worst;
  }

  ExactPosterior result(bool moments) const {
    double mass = 0;
    for (const Line& line : lines_) {
      for (const double v : line.values) mass += std::exp(v) * line.width;
    }
    const Eigen::Vector4d middle = natural(at(lines_.front(), 0));
    Eigen::Vector4d first = Eigen::Vector4d::Zero();
    Eigen::Matrix4d second = Eigen::Matrix4d::Zero();
    double highest = -INFINITY;
    std::vector<std::pair<const Line*, int>> kept;
    for (const Line& line : lines_) {
      for (std::size_t j = 0; j < line.values.size(); ++j) {
        const double here = std::exp(line.values[j]) * line.width;
        if (here == 0) continue;
        const int t = line.first + static_cast<int>(j);
        if (here > negligible_share * mass) kept.emplace_back(&line, t);
        const Place there = at(line, t);
        highest = std::max(highest, reference_ + line.values[j] - there.log_jacobian);
        const Eigen::Vector4d x = natural(there) - middle;
        first += here / mass * x;
        second += here / mass * (x * x.transpose());
      }
    }
    ExactPosterior exact;
    exact.highest = highest;
    const auto n = static_cast<Eigen::Index>(kept.size());
    WeightedDraws& nodes = exact.nodes;
    nodes.values.resize(n, d);
    nodes.weights.resize(n);
    WeightedDraws::Cells& cells = nodes.cells;
    cells.mass.resize(n);
    cells.node = Points::Zero(n, d);
    cells.mean.resize(n, d);
    cells.square.resize(n, d);
    nodes.lower.assign(d, Points(n, d));
    nodes.upper.assign(d, Points(n, d));
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, n, 256), [&](const auto& part) {
      for (Eigen::Index row = part.begin(); row != part.end(); ++row) {
        const auto [line, t] = kept[static_cast<std::size_t>(row)];
        nodes.values.row(row) = natural(at(*line, t));
        const double weight = node_mass(*line, t);
        CellShape shape(weight);
        shape.along(outer, node_mass(*line, t - 1), node_mass(*line, t + 1));
        nodes.lower[outer].row(row) = natural(at(*line, t - 0.5));
        nodes.upper[outer].row(row) = natural(at(*line, t + 0.5));
        for (int a = 0; a < outer; ++a) {
          const Line &below = neighbour(*line, a, -1), &above = neighbour(*line, a, 1);
          shape.along(a, mass_in(below, *line, t), mass_in(above, *line, t));
          const auto axis = static_cast<std::size_t>(a);
          nodes.lower[axis].row(row) = natural(between(*line, below, above, a, -0.5, t));
          nodes.upper[axis].row(row) = natural(between(*line, above, below, a, 0.5, t));
        }
        nodes.weights[row] = weight;
        shape.write(row, cells);
      }
    });
    nodes.weights /= nodes.weights.sum();
    cells.mass /= cells.mass.sum();
    exact.mean = middle + first;
    exact.covariance = second - first * first.transpose();
    if (!moments) exact.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
    exact.sd = exact.covariance.diagonal().cwiseSqrt();
    bool proper = true;
    for (const Parameter& parameter : posterior_.parameters()) proper &= parameter.prior.proper;
    if (proper) {
      exact.log_evidence =
          reference_ + std::log(mass * line_step_) + outer * std::log(step_) + chart_.log_scale();
    }
    return exact;
  }

 private:
  // A point of a line, or beside it.
  struct Place {
    Z z;                      // on the real line
    double log_jacobian = 0;  // of z by u
  };
  // Where the three coordinates are step (index + shift along one axis).
  Place place(const Index& index, int axis, double shift, double on_line) const {
    Eigen::Vector4d along;
    for (int i = 0; i < outer; ++i)
      along[i] = step_ * (index[static_cast<std::size_t>(i)] + (i == axis ? shift : 0));
    along[outer] = on_line;
    Place place;
    place.log_jacobian = chart_.to_real(along, place.z);
    return place;
  }
  Place at(const Line& line, double t) const {
    return place(line.index, -1, 0, line.middle + line.width * line_step_ * t);
  }
  double density(const Place& there) const {
    return posterior_.value(there.z) + there.log_jacobian;
  }
  // Half way to a neighbour, at the same place across the ridge, which bends like the parabola
  // through it and the neighbour on the other side.
  Place between(const Line& line, const Line& other, const Line& opposite, int axis, double shift,
                int t) const {
    const auto half_way = [](double here, double there, double back) {
      return 0.375 * there + 0.75 * here - 0.125 * back;
    };
    return place(line.index, axis, shift,
                 half_way(line.middle, other.middle, opposite.middle) +
                     half_way(line.width, other.width, opposite.width) * line_step_ * t);
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

  // Makes the highest density so far the reference: the walk began far below the mode. False when
  // it was moved so often that there is none.
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

  // Finds the line's mode by parabolas from its neighbour's, then walks outward on both sides.
  void integrate(Line& line) const {
    const auto value = [&](double on_line) {
      return density(place(line.index, -1, 0, on_line)) - reference_;
    };
    double middle = value(line.middle);
    for (int iteration = 0; iteration < 6; ++iteration) {
      const double reach = 0.7 * line.width;
      const double below = value(line.middle - reach), above = value(line.middle + reach);
      const double bend = 2 * middle - below - above;
      if (!std::isfinite(bend) || !(bend > 1e-8)) break;
      const double slope = 0.5 * (above - below);
      const double width = reach / std::sqrt(bend);
      // Far from the mode the parabola is only a direction.
      const double move = std::clamp(slope / bend * reach, -8 * line.width, 8 * line.width);
      const double there = value(line.middle + move);
      if (!(there >= middle)) break;
      line.middle += move;
      line.width = std::clamp(width, 0.25 * line.width, 4 * line.width);
      middle = there;
      if (std::abs(move) < 0.05 * line.width) break;
    }
    std::vector<double> below;
    line.values = {middle};
    line.highest = middle;
    for (const int way : {-1, 1}) {
      std::vector<double>& side = way < 0 ? below : line.values;
      for (int t = 1; t <= most_across; ++t) {
        const double v = value(line.middle + way * t * line_step_ * line.width);
        side.push_back(v);
        line.highest = std::max(line.highest, v);
        if (!(v > std::max(line.highest, highest_) + log_negligible_)) break;
      }
    }
    line.first = -static_cast<int>(below.size());
    line.values.insert(line.values.begin(), below.rbegin(), below.rend());
  }

  const Posterior& posterior_;
  const Chart& chart_;
  double step_, line_step_, log_negligible_;
  double reference_;
  double highest_ = -INFINITY;
  long nodes_ = 0;
  int moves_ = 0;  // of the reference
  std::vector<Line> lines_;
  std::unordered_map<std::uint64_t, std::size_t> known_;
};

// Of the highest density, where the lattice ends: what is left out goes with the tolerance.
double log_negligible(double tolerance) {
  return std::max(-22.0, -22 + std::log(tolerance / 1e-5));
}

// A lattice that is filled, or why it could not be.
struct Filled {
  std::unique_ptr<Lattice> lattice;
  std::string failure;
  double error = INFINITY;  // where it was filled

  Filled(const Posterior& posterior, const Chart& chart, double step, long most,
         const ExactSettings& settings)
      : lattice(std::make_unique<Lattice>(posterior, chart, step,
                                          std::min(line_share * step, longest_on_line),
                                          log_negligible(settings.tolerance))),
        failure(lattice->fill(most)) {
    if (failure.empty()) error = lattice->error(settings.second_moments);
  }
};

// The next step, by how far the error is from the tolerance: it falls between exp(-c/step) and exp(-c/step^2) where the
// density is smooth.
double next_step(double step, double error, double tolerance, long nodes, long left) {
  const double a_little = step / std::sqrt(2.0);
  if (error >= 1) return a_little;
  const double next =
      step * std::clamp(std::pow(std::log(error) / std::log(tolerance), 0.67), 0.5, 0.95);
  return next < a_little && 16 * nodes > left ? a_little : next;
}

}  // namespace

ExactPosterior integrate_on_lattice(const Posterior& posterior, const Whitening& whitening,
                                    const ExactSettings& settings) {
  const RidgeMap map(posterior, whitening);
  const Straight straight(posterior, whitening);
  const AlongRidge along(map);
  // Each chart is round where the other is not; lattices of middling steps tell. Where one is dear, the one that ends
  // soon.
  constexpr double coarsest = 1, telling = 0.7;
  constexpr long few_nodes = 140'000, enough_nodes = 400'000;
  const Chart* chart = &straight;
  std::optional<Filled> filled(std::in_place, posterior, straight, coarsest, most_nodes, settings);
  if (!map.affine() && !(filled->error <= settings.tolerance)) {
    const bool dear = !filled->failure.empty() || filled->lattice->nodes() > few_nodes;
    const auto error = [&](const Chart& of) {
      return Filled(posterior, of, telling, enough_nodes, settings).error;
    };
    if (dear ? Filled(posterior, along, coarsest, few_nodes, settings).failure.empty()
             : error(along) < error(straight)) {
      chart = &along;
      filled.reset();
    }
  }
  ExactPosterior exact;
  std::optional<Filled> best;
  long evaluations = 0;
  double before = INFINITY, step_before = coarsest;
  for (double step = coarsest; evaluations < settings.max_evaluations;) {
    if (settings.stop.stop_requested()) throw Cancelled();
    if (!filled) filled.emplace(posterior, *chart, step, most_nodes, settings);
    const long nodes = filled->lattice->nodes();
    evaluations += nodes;
    if (!filled->failure.empty()) {
      exact.failure = filled->failure;
      break;
    }
    const double error = filled->error;
    const double widest = settings.tolerance < good_enough ? widest_told : coarsest;
    if (error <= std::max(settings.tolerance, good_enough)) best = std::move(filled);
    if (error <= settings.tolerance && step <= widest) break;
    // Across a kink or a jump errors fall by a power of the step: what the evaluations will not suffice
    // for is not begun.
    const double power = std::log(before / error) / std::log(step_before / step);
    const bool hopeless = std::isfinite(before) &&
                          (error >= before || std::pow(error / settings.tolerance, 4 / power) *
                                                      static_cast<double>(evaluations) >
                                                  static_cast<double>(settings.max_evaluations));
    before = error;
    step_before = step;
    if (hopeless && error <= good_enough) break;
    exact.failure = fmt::format("no convergence in {} evaluations", evaluations);
    step = std::min(widest, next_step(step, error, settings.tolerance, nodes,
                                      settings.max_evaluations - evaluations));
    filled.reset();
  }
  if (best) {
    exact = best->lattice->result(settings.second_moments);
    exact.error = best->error;
  }
  exact.evaluations = evaluations;
  return exact;
}

}  // namespace wearwell
