#pragma once

#include <span>
#include <vector>

#include "wearwell/models/formula_model/formula_process.h"

namespace wearwell::formula_model {

/// One step of a gamma or an inverse Gaussian process on a lattice of width h: what each number k of widths counts, so that
///
///   E[g(x + W)] = sum over k of lag[k - first] g(x + k h)
///
/// for functions g that are smooth over three widths, as products of normal densities are: expectations of the polynomials
/// through twelve neighbours, by Gauss and Legendre's rule on panels of eight widths (fewer where the step is narrower than
/// the lattice). At 0 the density may have a pole, or none of its mass may be on the lattice: the first panel of a gamma step
/// is a rule with weight w^(shape - 1), by its moments about Legendre's polynomials; panels of an inverse Gaussian one are
/// halved towards 0. Where steps begin far from 0, lag is h times the density. Errors are about 1e-6 of g's highest value where
/// g is a normal density with standard deviation 3 h and W is next to nothing, less elsewhere.
class HiddenStep {
 public:
  static constexpr int before = 5, stencil = 12;  ///< places of a polynomial: -5 .. 6

  /// Steps of `mean` above 0 with variance scale * mean; the lags that steps from `least` to `most` widths reach.
  void lay(Process process, double mean, double scale, double h, int least, int most);
  /// A step that is none.
  void lay_nothing();

  int first = 0;
  std::vector<double> lag;

  /// Derivatives of the sum of `by` times `lag`, one number of a lag.
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
  std::vector<std::vector<double>> own_;  // stencils that no table has
  std::size_t own_used_ = 0;
};

}  // namespace wearwell::formula_model
