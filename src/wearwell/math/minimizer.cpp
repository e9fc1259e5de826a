#include "wearwell/math/minimizer.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <nlopt.hpp>
#include <vector>

namespace wearwell {
namespace {

struct Search {
  const Objective& objective;
  Minimum best;
  std::exception_ptr failure = nullptr;  // NLopt would replace the exception by its own error

  double operator()(unsigned n, const double* x, double* gradient) {
    const std::span<double> slope = gradient ? std::span<double>(gradient, n) : std::span<double>();
    double value = 0;
    try {
      value = objective(std::span(x, n), slope);
    } catch (...) {
      failure = std::current_exception();
      throw nlopt::forced_stop();
    }
    if (std::isnan(value)) value = INFINITY;
    // Outside the domain the objective may not set the gradient, but NLopt reads it.
    if (!std::isfinite(value)) std::fill(slope.begin(), slope.end(), 0.0);
    if (value < best.value) {
      best.value = value;
      best.position = Eigen::Map<const Eigen::VectorXd>(x, n);
    }
    return value;
  }
};

}  // namespace

Minimum minimize(const Objective& objective, const Eigen::VectorXd& start, int max_evaluations) {
  const auto n = static_cast<unsigned>(start.size());
  Search search{objective, {start, INFINITY, false}};
  nlopt::opt optimizer(nlopt::LD_LBFGS, n);
  optimizer.set_min_objective(
      [](unsigned size, const double* x, double* gradient, void* data) {
        return (*static_cast<Search*>(data))(size, x, gradient);
      },
      &search);
  optimizer.set_ftol_rel(1e-13);
  optimizer.set_xtol_rel(1e-10);
  optimizer.set_maxeval(max_evaluations);
  std::vector<double> x(start.data(), start.data() + n);
  double value = 0;
  try {
    search.best.converged = optimizer.optimize(x, value) != nlopt::MAXEVAL_REACHED;
  } catch (const nlopt::roundoff_limited&) {
    search.best.converged = true;  // no further progress is possible in double precision
  } catch (const std::runtime_error&) {
    // NLopt's generic failure, such as a line search with only infinities; the best point is kept.
  }
  if (search.failure) std::rethrow_exception(search.failure);
  search.best.converged = search.best.converged && std::isfinite(search.best.value);
  return search.best;
}

}  // namespace wearwell
