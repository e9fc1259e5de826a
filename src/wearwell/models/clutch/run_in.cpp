#include "wearwell/models/clutch/run_in.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/clutch/plate_factors.h"

namespace wearwell::clutch {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Observation {
  Index plate;
  double from, to;  ///< energy, J
  double w, cycles, balance_sd;
};

/// Mean of exp(-E/scale) over a block, and its derivative by log scale.
struct Decay {
  double value, slope;
};

Decay decay(const Observation& o, double scale) {
  const double a = std::exp(-o.from / scale), b = std::exp(-o.to / scale);
  const double value = -a * std::expm1((o.from - o.to) / scale) * scale / (o.to - o.from);
  return {value, value + (o.from * a - o.to * b) / (o.to - o.from)};
}

/// Nonlinear unknowns: log eps2, log(eps1/eps2 - 1), so that eps1 > eps2, and the log factors of
/// all plates except the last, which is minus their sum.
class Problem {
 public:
  Problem(std::vector<Observation> observations, Index plates)
      : observations_(std::move(observations)), plates_(plates) {
    set_cycle_sd(0);
  }

  Index unknowns() const { return 2 + plates_ - 1; }
  Index rows() const { return static_cast<Index>(observations_.size()); }

  /// Weights for a scatter of one cycle; 0: for a perfect balance, up to a factor.
  void set_cycle_sd(double sd) {
    root_weight_.resize(rows());
    for (Index i = 0; i < rows(); ++i) {
      const Observation& o = at(i);
      const double relative = sd > 0 ? o.balance_sd / sd : 0;
      root_weight_[i] = 1 / std::sqrt(1 / o.cycles + relative * relative);
    }
  }

  static double fast(const VectorXd& x) { return std::exp(x[0]); }
  static double slow(const VectorXd& x) { return std::exp(x[0]) * (1 + std::exp(x[1])); }
  double log_factor(const VectorXd& x, Index plate) const {
    return plate < plates_ - 1 ? x[2 + plate] : -x.tail(plates_ - 1).sum();
  }

  struct State {
    VectorXd x;
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();  ///< w0, w1, w2
    VectorXd residuals;                                ///< weighted
    MatrixXd jacobian;  ///< of the weighted mean by w0, w1, w2, then x
    MatrixXd reduced;   ///< Kaufman's Jacobian of the residuals by x
    double sum = INFINITY;
  };

  State evaluate(const VectorXd& x) const {
    State state;
    state.x = x;
    MatrixXd basis(rows(), 3), slopes(rows(), 2);
    VectorXd response(rows());
    for (Index i = 0; i < rows(); ++i) {
      const Observation& o = at(i);
      const double scale = root_weight_[i] * std::exp(log_factor(x, o.plate));
      const Decay s = decay(o, slow(x)), f = decay(o, fast(x));
      basis.row(i) << scale, scale * s.value, scale * f.value;
      slopes.row(i) << scale * s.slope, scale * f.slope;
      response[i] = root_weight_[i] * o.w;
    }
    if (!basis.allFinite()) return state;
    // The best with w1, w2 >= 0: of four choices of the nonzero ones.
    std::vector<int> best;
    for (const std::vector<int>& active : {std::vector<int>{0, 1, 2}, std::vector<int>{0, 1},
                                           std::vector<int>{0, 2}, std::vector<int>{0}}) {
      const MatrixXd columns = basis(Eigen::all, active);
      const VectorXd b = columns.colPivHouseholderQr().solve(response);
      if ((b.array() < 0).any() || !b.allFinite()) continue;
      const VectorXd residuals = response - columns * b;
      if (residuals.squaredNorm() < state.sum) {
        state.sum = residuals.squaredNorm();
        state.residuals = residuals;
        state.linear.setZero();
        for (std::size_t j = 0; j < active.size(); ++j)
          state.linear[active[j]] = b[static_cast<Index>(j)];
        best = active;
      }
    }
    if (best.empty()) return state;
    const VectorXd mean = response - state.residuals;
    MatrixXd by_x = MatrixXd::Zero(rows(), unknowns());
    const double ratio = std::exp(x[1]);
    for (Index i = 0; i < rows(); ++i) {
      const double by_slow = state.linear[1] * slopes(i, 0);
      const double by_fast = state.linear[2] * slopes(i, 1);
      by_x(i, 0) = by_slow + by_fast;
      by_x(i, 1) = by_slow * ratio / (1 + ratio);
      const Index plate = at(i).plate;
      if (plate < plates_ - 1) {
        by_x(i, 2 + plate) = mean[i];
      } else {
        by_x.row(i).tail(plates_ - 1).setConstant(-mean[i]);
      }
    }
    const MatrixXd columns = basis(Eigen::all, best);
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
    state.reduced = -(by_x - columns * qr.solve(by_x));
    state.jacobian.resize(rows(), 3 + unknowns());
    state.jacobian << basis, by_x;
    return state;
  }

  const Observation& at(Index i) const { return observations_[static_cast<std::size_t>(i)]; }
  Observation& at(Index i) { return observations_[static_cast<std::size_t>(i)]; }
  Index plates() const { return plates_; }

 private:
  std::vector<Observation> observations_;
  Index plates_;
  VectorXd root_weight_;
};

struct Search {
  Problem::State state;
  bool converged = false;
};

/// Levenberg-Marquardt on the problem with the linear unknowns eliminated.
Search descend(const Problem& problem, const VectorXd& start) {
  constexpr int most_steps = 300;
  Search search{problem.evaluate(start), false};
  double damping = 1e-3;
  for (int step = 0; step < most_steps && std::isfinite(search.state.sum); ++step) {
    const MatrixXd& j = search.state.reduced;
    const VectorXd gradient = j.transpose() * search.state.residuals;
    MatrixXd normal = j.transpose() * j;
    const double typical = normal.diagonal().maxCoeff();
    normal.diagonal().array() += damping * (normal.diagonal().array() + 1e-9 * typical);
    const VectorXd move = normal.ldlt().solve(-gradient);
    if (!move.allFinite()) return search;
    Problem::State next = problem.evaluate(search.state.x + move);
    if (next.sum < search.state.sum) {
      const double gained = search.state.sum - next.sum;
      search.state = std::move(next);
      damping = std::max(1e-12, damping / 5);
      if (gained < 1e-12 * search.state.sum) {
        search.converged = true;
        return search;
      }
    } else {
      damping *= 4;
      if (damping > 1e12) {
        search.converged = true;  // no step improves it
        return search;
      }
    }
  }
  return search;
}

/// Blocks of run-in and run-out; plates are numbered by first occurrence.
std::vector<Observation> observe(const std::vector<WornBlock>& blocks,
                                 std::map<int, Index>& number) {
  std::vector<Observation> observations;
  for (const WornBlock& b : blocks) {
    if (b.block != Block::run_in && b.block != Block::run_out) continue;
    const Index plate = number.try_emplace(b.plate, std::ssize(number)).first->second;
    observations.push_back(
        {plate, b.energy_before, b.energy_before + b.energy, b.w, b.cycles(), b.balance_sd});
  }
  return observations;
}

// From several starts, then again with the balance's share of the variance.
Search search_from_starts(Problem& problem, double most_energy, double freedom, RunInFit& fit) {
  std::optional<Search> best;
  std::vector<double> sums;
  for (const double share : {0.01, 0.03, 0.1}) {
    for (const double ratio : {3.0, 10.0, 30.0}) {
      VectorXd start = VectorXd::Zero(problem.unknowns());
      start[0] = std::log(share * most_energy);
      start[1] = std::log(ratio - 1);
      Search search = descend(problem, start);
      sums.push_back(search.state.sum);
      if (!best || search.state.sum < best->state.sum) best = std::move(search);
    }
  }
  fit.starts = static_cast<int>(sums.size());
  fit.agreeing = static_cast<int>(std::count_if(
      sums.begin(), sums.end(), [&](double sum) { return sum < best->state.sum * (1 + 1e-6); }));
  for (int i = 0; i < 2 && std::isfinite(best->state.sum); ++i) {
    fit.cycle_sd = std::sqrt(best->state.sum / freedom);
    problem.set_cycle_sd(fit.cycle_sd);
    best = descend(problem, best->state.x);
  }
  if (!std::isfinite(best->state.sum))
    throw InputError("run-in: no start leads to non-negative wear rates");
  fit.converged = best->converged;
  fit.cycle_sd = std::sqrt(best->state.sum / freedom);
  fit.residual_sum = best->state.sum / freedom;
  return *std::move(best);
}

// Of w0, w1, w2 and the nonlinear unknowns.
MatrixXd covariance_of(const MatrixXd& jacobian, double cycle_sd) {
  // Columns are of very different size: invert after scaling.
  const VectorXd length = jacobian.colwise().norm().cwiseMax(1e-300).transpose();
  const MatrixXd scaled = jacobian * length.cwiseInverse().asDiagonal();
  const MatrixXd inverse =
      (scaled.transpose() * scaled).completeOrthogonalDecomposition().pseudoInverse();
  return cycle_sd * cycle_sd *
         (length.cwiseInverse().asDiagonal() * inverse * length.cwiseInverse().asDiagonal());
}

}  // namespace

RunInFit fit_run_in(const std::vector<WornBlock>& blocks) {
  std::map<int, Index> number;
  std::vector<Observation> observations = observe(blocks, number);
  double most_energy = 0;
  for (const WornBlock& b : blocks) {
    if (b.block == Block::run_in) most_energy = std::max(most_energy, b.energy_before + b.energy);
  }
  const Index plates = std::ssize(number);
  if (plates == 0 || std::ssize(observations) <= 5 + plates - 1 || !(most_energy > 0))
    throw InputError(
        fmt::format("run-in: {} blocks of run-in and run-out on {} plates are too few for 5 "
                    "constants and the plates' factors",
                    observations.size(), plates));
  Problem problem(std::move(observations), plates);
  RunInFit fit;
  fit.blocks = static_cast<std::size_t>(problem.rows());
  const double freedom = static_cast<double>(problem.rows() - 5 - (plates - 1));
  const Problem::State state = search_from_starts(problem, most_energy, freedom, fit).state;
  const MatrixXd covariance = covariance_of(state.jacobian, fit.cycle_sd);
  const double slow = Problem::slow(state.x), fast = Problem::fast(state.x);
  fit.parameters << state.linear, slow, fast;
  MatrixXd to_parameters = MatrixXd::Zero(5, covariance.cols());
  to_parameters.topLeftCorner(3, 3).setIdentity();
  to_parameters(3, 3) = slow;
  to_parameters(3, 4) = fast * std::exp(state.x[1]);
  to_parameters(4, 3) = fast;
  fit.covariance = to_parameters * covariance * to_parameters.transpose();

  const double w0 = state.linear[0];
  if (!(w0 > 0)) throw InputError("run-in: the settled wear rate w0 is not positive");
  fit.run_in = {state.linear[1] / w0, state.linear[2] / w0, slow, fast};
  Eigen::Matrix<double, 4, 5> to_g = Eigen::Matrix<double, 4, 5>::Zero();
  to_g(0, 0) = -fit.run_in.slow / w0;
  to_g(0, 1) = 1 / w0;
  to_g(1, 0) = -fit.run_in.fast / w0;
  to_g(1, 2) = 1 / w0;
  to_g(2, 3) = to_g(3, 4) = 1;
  fit.run_in_covariance = to_g * fit.covariance * to_g.transpose();

  for (const auto& [plate, index] : number) {
    VectorXd by_x = VectorXd::Zero(covariance.cols());
    if (index < plates - 1) {
      by_x[5 + index] = 1;
    } else {
      by_x.tail(plates - 1).setConstant(-1);
    }
    fit.plates.push_back(
        {plate, problem.log_factor(state.x, index), std::sqrt(by_x.dot(covariance * by_x)), 0, 0});
  }
  shrink_factors(fit);
  return fit;
}

std::vector<RunIn> repeat_run_in(const std::vector<WornBlock>& blocks, const RunInFit& fit,
                                 int count, std::uint64_t seed) {
  std::map<int, Index> number;
  std::vector<Observation> observations = observe(blocks, number);
  Problem problem(std::move(observations), std::ssize(number));
  problem.set_cycle_sd(fit.cycle_sd);
  VectorXd x(problem.unknowns());
  const RunIn& centre = fit.run_in;
  x[0] = std::log(centre.fast_energy);
  x[1] = std::log(centre.slow_energy / centre.fast_energy - 1);
  for (const PlateFactor& plate : fit.plates) {
    const Index p = number.at(plate.plate);
    if (p + 1 < problem.plates()) x[2 + p] = plate.log_factor;  // the last follows from the others
  }
  std::vector<RunIn> run_ins;
  for (int b = 0; b < count; ++b) {
    Rng rng(seed, static_cast<std::uint64_t>(b));
    for (Index i = 0; i < problem.rows(); ++i) {
      Observation& o = problem.at(i);
      const double w = fit.parameters[0] * centre.mean(o.from, o.to);
      const double sd = std::hypot(fit.cycle_sd / std::sqrt(o.cycles), o.balance_sd);
      o.w = w * std::exp(problem.log_factor(x, o.plate)) + sd * rng.normal();
    }
    const Problem::State state = descend(problem, x).state;
    // A settled rate that is negligible beside the modes cannot serve as a scale.
    const double w0 = std::max(state.linear[0], 1e-6 * state.linear.sum());
    run_ins.push_back(w0 > 0 && std::isfinite(state.sum)
                          ? RunIn{state.linear[1] / w0, state.linear[2] / w0,
                                  Problem::slow(state.x), Problem::fast(state.x)}
                          : centre);
  }
  return run_ins;
}

}  // namespace wearwell::clutch
