#include "wearwell/infer/maximize.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr int iterations = 300;
constexpr double longest_step = 30;  // in units
constexpr double plateau = 1e-9;     // curvature in units below which rounding determines the sign

using Indices = std::vector<Eigen::Index>;

class Climb {
 public:
  Climb(const LogDensity& density, const Eigen::VectorXd& unit, const Box& box, double enough)
      : density_(density), unit_(unit), box_(box), enough_(enough) {}

  Maximum from(const Eigen::VectorXd& start) const {
    Maximum maximum{inside(start), 0, Eigen::VectorXd(start.size()), {}, false};
    maximum.value = density_.value_and_gradient(view(maximum.x), view(maximum.gradient));
    if (!std::isfinite(maximum.value)) return maximum;
    Eigen::VectorXd difference = 1e-4 * unit_;
    for (int i = 0; i < iterations; ++i) {
      maximum.curvature = curvature(maximum.x, difference);
      if (!maximum.curvature.allFinite() || !maximum.gradient.allFinite()) return maximum;
      for (Eigen::Index a = 0; a < start.size(); ++a) {
        const double bend = maximum.curvature(a, a);
        if (bend > 0) difference[a] = 1e-4 * std::min(unit_[a], 1 / std::sqrt(bend));
      }
      const Step step = newton(maximum);
      if (step.concave && step.gain < enough_) {
        maximum.converged = true;
        return maximum;
      }
      if (!go(step.move, maximum)) {
        // No ascent is possible within rounding.
        maximum.converged = step.concave && step.gain < 1e-6;
        return maximum;
      }
    }
    return maximum;
  }

 private:
  struct Step {
    Eigen::VectorXd move;
    double gain;   // predicted gain
    bool concave;  // the density is concave along every free parameter
  };

  Eigen::VectorXd inside(const Eigen::VectorXd& x) const {
    return x.cwiseMax(box_.lower).cwiseMin(box_.upper);
  }

  Indices free_at(const Maximum& maximum) const {
    Indices free;
    for (Eigen::Index i = 0; i < maximum.x.size(); ++i) {
      const bool held = (maximum.x[i] <= box_.lower[i] && maximum.gradient[i] <= 0) ||
                        (maximum.x[i] >= box_.upper[i] && maximum.gradient[i] >= 0);
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
      // At least the resolution of x.
      const double by = std::max(difference[i], 1e-11 * std::abs(x[i]));
      Eigen::VectorXd up = x, down = x;
      up[i] = std::min(x[i] + by, box_.upper[i]);
      down[i] = std::max(x[i] - by, box_.lower[i]);
      if (!(up[i] > down[i])) {
        result.col(i).setZero();
        continue;
      }
      density_.value_and_gradient(view(up), view(above));
      density_.value_and_gradient(view(down), view(below));
      result.col(i) = (below - above) / (up[i] - down[i]);
    }
    return 0.5 * (result + result.transpose());
  }

  // The step to the maximum of the parabola within the box: while it crosses a bound, the first
  // such parameter is fixed at its bound and the others are optimized again.
  Step newton(const Maximum& maximum) const {
    Indices free = free_at(maximum);
    Step step{Eigen::VectorXd::Zero(maximum.x.size()), 0, true};
    Eigen::VectorXd gradient = maximum.gradient;
    while (!free.empty()) {
      const Eigen::VectorXd unit = unit_(free);
      const Eigen::VectorXd slope = gradient(free).cwiseProduct(unit);
      const Parabola top = parabola(maximum.curvature(free, free), unit, slope);
      if (step.move.isZero(0)) step.concave = top.concave;
      const Eigen::VectorXd move = top.move.cwiseProduct(unit);
      // The fraction of the step inside the box.
      double share = 1;
      std::size_t leaves = free.size();
      for (std::size_t j = 0; j < free.size(); ++j) {
        const double by = move[static_cast<Eigen::Index>(j)], at = maximum.x[free[j]];
        const double way = (by > 0 ? box_.upper : box_.lower)[free[j]] - at;
        if (std::abs(by) * share > std::abs(way)) {
          share = std::abs(way / by);
          leaves = j;
        }
      }
      if (leaves == free.size()) {
        step.move(free) = move;
        break;
      }
      const Eigen::Index held = free[leaves];
      step.move[held] =
          (move[static_cast<Eigen::Index>(leaves)] > 0 ? box_.upper : box_.lower)[held] -
          maximum.x[held];
      free.erase(free.begin() + static_cast<std::ptrdiff_t>(leaves));
      gradient -= step.move[held] * maximum.curvature.col(held);
    }
    step.gain = std::abs(step.move.dot(maximum.gradient));
    return step;
  }

  struct Parabola {
    Eigen::VectorXd move;  // in units
    bool concave;
  };

  // Scales by units, or by widths if smaller, because beside a width of 1e-8 the curvature of a
  // width of 1 is lost in rounding.
  static Parabola parabola(const Eigen::MatrixXd& curvature, const Eigen::VectorXd& unit,
                           const Eigen::VectorXd& slope) {
    Eigen::VectorXd width = Eigen::VectorXd::Ones(unit.size());
    for (Eigen::Index i = 0; i < unit.size(); ++i) {
      const double bend = curvature(i, i) * unit[i] * unit[i];
      if (bend > 1) width[i] = 1 / std::sqrt(bend);
    }
    const Eigen::VectorXd size = unit.cwiseProduct(width);
    const Eigen::MatrixXd scaled = size.asDiagonal() * curvature * size.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    const Eigen::VectorXd bend = eigen.eigenvalues().cwiseAbs();
    const double least = std::max(1e-12 * bend.maxCoeff(), 1e-300);
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * slope.cwiseProduct(width);
    Eigen::VectorXd move =
        width.cwiseProduct(eigen.eigenvectors() * along.cwiseQuotient(bend.cwiseMax(least)));
    const double reach = move.cwiseAbs().maxCoeff();
    if (reach > longest_step) move *= longest_step / reach;
    return {move, eigen.eigenvalues()[0] > -plateau * std::min(1.0, bend.maxCoeff())};
  }

  // Backtracking: the first shorter step that increases the density, along `move` or else along the
  // gradient.
  bool go(const Eigen::VectorXd& move, Maximum& maximum) const {
    const Eigen::VectorXd slope = maximum.gradient.cwiseProduct(unit_.cwiseAbs2());
    for (const Eigen::VectorXd& direction : {move, slope}) {
      double share = 1;
      for (int halving = 0; halving < 50; ++halving, share *= 0.5) {
        const Eigen::VectorXd x = inside(maximum.x + share * direction);
        const double expected = maximum.gradient.dot(x - maximum.x);
        if (!(expected > 0)) continue;
        if (!(density_.value(view(x)) > maximum.value + 1e-4 * expected)) continue;
        maximum.x = x;
        maximum.value = density_.value_and_gradient(view(x), view(maximum.gradient));
        return true;
      }
    }
    return false;
  }

  const LogDensity& density_;
  const Eigen::VectorXd& unit_;
  const Box& box_;
  double enough_;
};

}  // namespace

Maximum maximize(const LogDensity& density, const Eigen::VectorXd& start,
                 const Eigen::VectorXd& unit, const Box& box, double enough) {
  return Climb(density, unit, box, enough).from(start);
}

}  // namespace wearwell
