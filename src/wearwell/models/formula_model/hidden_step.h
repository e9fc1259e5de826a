#pragma once

#include <span>
#include <vector>

#include "wearwell/models/formula_model/formula_process.h"

namespace wearwell::formula_model {

/// One step of a gamma or an inverse Gaussian process on a lattice of width h, as weights of the
/// shifts by k widths, so that
///
///   E[g(x + W)] = sum over k of lag[k - first] g(x + k h)
///
/// for functions g that are smooth over three widths, as products of normal densities are:
/// expectations of the polynomials through twelve neighbours, by Gauss-Legendre rules on panels of
/// eight widths (fewer if the step is narrower than the lattice). The density may have a pole at 0,
/// or all its mass between 0 and the next lattice point: the first panel of a gamma step is a rule
/// with weight w^(shape - 1), by its moments of Legendre's polynomials; panels of an inverse
/// Gaussian step are halved towards 0. If steps begin far from 0, lag is h times the density.
/// Errors are at most about 1e-6 of g's maximum if g is a normal density with standard deviation 3
/// h and W is negligible, and smaller otherwise.
class HiddenStep {
 public:
  static constexpr int before = 5, stencil = 12;  ///< places of a polynomial: -5 .. 6

  /// Steps of `mean` above 0 with variance scale * mean; lags cover steps from `least` to `most`
  /// widths.
  void rebuild(Process process, double mean, double scale, double h, int least, int most);
  /// A step of zero.
  void place_nothing();

  int first = 0;
  std::vector<double> lag;

  /// Derivatives of the sum of `by` times `lag`, one value per lag.
  struct Slopes {
    double by_mean = 0, by_scale = 0;
  };
  Slopes slopes(const std::vector<double>& by) const;

 private:
  struct Node {
    double weight, by_mean, by_scale;
    int from;  // the first of its lags
    const double* stencil;
  };
  struct Distribution;
  void add_panel(const Distribution& increments, int panel, double shrink);
  void add_pole(const Distribution& increments, double shrink);
  void add_halves(const Distribution& increments, double shrink);
  void add(const Distribution& increments, double place, double log_place, double weight,
           double shrink, int from, const double* stencil);
  const double* own_stencil(double place, int& from);

  double h_ = 0, log_h_ = 0;
  bool none_ = false;
  std::vector<Node> nodes_;
  std::vector<std::vector<double>> own_;  // stencils that are not in a table
  std::size_t own_used_ = 0;
};

}  // namespace wearwell::formula_model
