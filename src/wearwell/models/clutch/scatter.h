#pragma once

#include <optional>
#include <vector>

#include "wearwell/math/normality.h"
#include "wearwell/models/clutch/wear_law.h"
#include "wearwell/models/clutch/wear_map.h"

namespace wearwell::clutch {

/// One candidate for sigma_w, fitted (Haramina et al. 2025, section 3.4 and Table 6).
struct ScatterFit {
  ScatterLaw law;
  double negative_log_likelihood = 0;  ///< wear rates in mm^3/MJ
  double aic = 0;                      ///< 2 (parameters + negative log likelihood)
  bool converged = false;
  int starts = 0, agreeing = 0;  ///< number tried; number that reached the best
  KolmogorovTest kolmogorov, lilliefors;
};

struct ScatterSearch {
  std::vector<ScatterFit> candidates;  ///< in the order of scatter_kinds
  std::size_t best = 0;                ///< smallest AIC
  /// Floor of sigma_w: half the smallest at the fitted points, for each candidate.
  std::vector<double> floors;
};

/// Standard deviations of the wear rates of points: sqrt(sigma_w^2/(n_j factor_j^2) +
/// balance_sd^2). The scatter of a cycle does not grow with run-in and plate, so compensation
/// divides it too.
Eigen::VectorXd point_sd(const ScatterLaw& law, const WearPoints& points,
                         const Eigen::VectorXd& mean);

/// Fits each candidate to the residuals of `map` at the points it was fitted to, by maximum
/// likelihood from several starts, with sigma_w positive at every point:
///
///   e_j / sqrt(1 - h_j) ~ N(0, sigma_w^2/(n_j factor_j^2) + balance_sd_j^2).
///
/// The leverages h_j correct for the residuals that the fit of the map absorbs; the paper's formula
/// has e_j alone.
ScatterSearch fit_scatter(const WearPoints& points, const WearMap& map);

/// Those residuals divided by their standard deviation: N(0, 1) if the model is right.
Eigen::VectorXd scaled_residuals(const WearPoints& points, const WearMap& map,
                                 const ScatterLaw& law);

}  // namespace wearwell::clutch
