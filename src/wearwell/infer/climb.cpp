#include "wearwell/infer/climb.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr int iterations = 300;
constexpr double longest_step = 30;  // in units

using Indices = std::vector<Eigen::Index>;

class Climb {
 public:
  Climb(const LogDensity& density, const Eigen::VectorXd& unit, const Box& box)
      : density_(density), unit_(unit), box_(box) {}

  Summit from(const Eigen::VectorXd& start) const {
    Summit summit{inside(start), 0, Eigen::VectorXd(start.size()), {}, false};
    summit.value = density_.value_and_gradient(view(summit.x), view(summit.gradient));
    if (!std::isfinite(summit.value)) return summit;
    Eigen::VectorXd difference = 1e-4 * unit_;
    for (int i = 0; i < iterations; ++i) {
      summit.curvature = curvature(summit.x, difference);
      if (!summit.curvature.allFinite() || !summit.gradient.allFinite()) return summit;
      for (Eigen::Index a = 0; a < start.size(); ++a) {
        const double bend = summit.curvature(a, a);
        if (bend > 0) difference[a] = 1e-4 * std::min(unit_[a], 1 / std::sqrt(bend));
      }
      const Step step = newton(summit);
      if (step.hill && step.gain < 1e-14) {
        summit.converged = true;
        return summit;
      }
      if (!go(step.move, summit)) {
        // Rounding leaves no way up.
        summit.converged = step.hill && step.gain < 1e-6;
        return summit;
      }
    }
    return summit;
  }

 private:
  struct Step {
    Eigen::VectorXd move;
    double gain;  // that it promises
    bool hill;    // the density is curved downwards along every free parameter
  };

  Eigen::VectorXd inside(const Eigen::VectorXd& x) const {
    return x.cwiseMax(box_.lower).cwiseMin(box_.upper);
  }

  Indices free_at(const Summit& summit) const {
    Indices free;
    for (Eigen::Index i = 0; i < summit.x.size(); ++i) {
      const bool held = (summit.x[i] <= box_.lower[i] && summit.gradient[i] <= 0) ||
                        (summit.x[i] >= box_.upper[i] && summit.gradient[i] >= 0);
      if (!held) free.push_back(i);
    }
    return free;
  }

  // By central differences of the gradient, one-sided at a bound.
  Eigen::MatrixXd curvature(const Eigen::VectorXd& x, const Eigen::VectorXd& difference) const {
    const Eigen::Index n = x.size();
    Eigen::MatrixXd result(n, n);
    Eigen::VectorXd above(n), below(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::VectorXd up = x, down = x;
      up[i] = std::min(x[i] + difference[i], box_.upper[i]);
      down[i] = std::max(x[i] - difference[i], box_.lower[i]);
      density_.value_and_gradient(view(up), view(above));
      density_.value_and_gradient(view(down), view(below));
      result.col(i) = (below - above) / (up[i] - down[i]);
    }
    return 0.5 * (result + result.transpose());
  }

  Step newton(const Summit& summit) const {
    const Indices free = free_at(summit);
    Step step{Eigen::VectorXd::Zero(summit.x.size()), 0, true};
    if (free.empty()) return step;
    const Eigen::VectorXd unit = unit_(free);
    const Eigen::MatrixXd scaled =
        unit.asDiagonal() * summit.curvature(free, free) * unit.asDiagonal();
    const Eigen::VectorXd slope = summit.gradient(free).cwiseProduct(unit);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    step.hill = eigen.eigenvalues()[0] > 0;
    const Eigen::VectorXd bend = eigen.eigenvalues().cwiseAbs();
    const double least = std::max(1e-12 * bend.maxCoeff(), 1e-300);
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * slope;
    Eigen::VectorXd move = eigen.eigenvectors() * along.cwiseQuotient(bend.cwiseMax(least));
    const double reach = move.cwiseAbs().maxCoeff();
    if (reach > longest_step) move *= longest_step / reach;
    step.gain = move.dot(slope);
    step.move(free) = move.cwiseProduct(unit);
    return step;
  }

  // The first of ever shorter steps that goes up, along `move` or else along the gradient.
  bool go(const Eigen::VectorXd& move, Summit& summit) const {
    const Eigen::VectorXd slope = summit.gradient.cwiseProduct(unit_.cwiseAbs2());
    for (const Eigen::VectorXd& direction : {move, slope}) {
      double share = 1;
      for (int halving = 0; halving < 50; ++halving, share *= 0.5) {
        const Eigen::VectorXd x = inside(summit.x + share * direction);
        const double expected = summit.gradient.dot(x - summit.x);
        if (!(expected > 0)) continue;
        if (!(density_.value(view(x)) > summit.value + 1e-4 * expected)) continue;
        summit.x = x;
        summit.value = density_.value_and_gradient(view(x), view(summit.gradient));
        return true;
      }
    }
    return false;
  }

  const LogDensity& density_;
  const Eigen::VectorXd& unit_;
  const Box& box_;
};

}  // namespace

Summit climb(const LogDensity& density, const Eigen::VectorXd& start, const Eigen::VectorXd& unit,
             const Box& box) {
  return Climb(density, unit, box).from(start);
}

}  // namespace wearwell
