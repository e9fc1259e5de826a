#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

#include "wearwell/models/clutch/run_in.h"
#include "wearwell/models/clutch/scatter.h"
#include "wearwell/models/clutch/wear_law.h"
#include "wearwell/models/clutch/wear_map.h"

namespace wearwell::clutch {

/// w = sum of coefficient ds^a Td^b Mz^c with ds = omega0^r t2^q, m^3/J; inputs as in
/// OperatingPoint.
struct WearPolynomial {
  struct Monomial {
    int ds = 0, temperature = 0, torque = 0;  ///< a, b, c; together at most 3
    double coefficient = 0;
  };
  double r = 1, q = 1;
  std::vector<Monomial> monomials;

  double operator()(const OperatingPoint& at) const;
};

/// A term of a fitted map with its scaling: x' = (x - minimum)/range.
struct ModelTerm {
  std::string name;  ///< "ds*Td"
  int ds = 0, temperature = 0, torque = 0;
  double minimum = 0, range = 1;
  double coefficient = 0;  ///< of x', m^3/J
};

/// A bootstrap replicate of the model: fitted to simulated measurements, with its own exponents and
/// terms, and a run-in drawn from its uncertainty.
struct Replicate {
  WearPolynomial w;
  RunIn run_in;
};

/// Everything that prediction needs.
struct WearModel {
  std::string title;
  double r = 1, q = 1;
  std::vector<ModelTerm> terms;
  Eigen::MatrixXd covariance;  ///< of the coefficients, m^6/J^2; allows for unequal scatter
  RunIn run_in;
  Eigen::Matrix4d run_in_covariance = Eigen::Matrix4d::Zero();
  ScatterLaw scatter;
  double scatter_floor = 0;        ///< floor of sigma_w, m^3/J
  double plate_sd = 0;             ///< of the log of a new plate's factor
  OperatingPoint lowest, highest;  ///< calibrated range: of the fitted points
  double worn_out = 0;             ///< volume, m^3
  std::vector<Replicate> replicates;

  WearPolynomial polynomial() const;
  double sigma(double w, const OperatingPoint& at) const {
    return std::max(scatter.formula(w, at), scatter_floor);
  }
};

/// The calibrated range is widened by this share at either end: conditions vary about their set
/// values.
inline constexpr double validity_slack = 0.01;

/// Inputs outside the calibrated range: bit i is `inputs[i]`.
unsigned outside(const WearModel& model, const OperatingPoint& at);
/// "slip_speed temperature"
std::string names_of_inputs(unsigned bits);

/// Covariance of the map's coefficients with the scatter of each point, instead of a common one
/// (White 1980): (X'X)^-1 X' diag(sd_j^2) X (X'X)^-1.
Eigen::MatrixXd robust_covariance(const WearMap& map, const Eigen::VectorXd& sd);

/// The monomials of a fitted map, without its scaling.
WearPolynomial unscaled(const WearMap& map);

/// Assembles a model. `replicates` are added by draw_replicates.
WearModel make_model(const std::string& title, const WearPoints& points, const WearMap& map,
                     const RunInFit& run_in, const ScatterSearch& scatter, double worn_out);

/// Parametric bootstrap of the whole fit, one for each of `run_ins` (repeat_run_in): measurements
/// are simulated from the map, the scatter of its points and the uncertainty of the plates'
/// factors, and compensated with that run-in, as the real ones were with the fitted one; its errors
/// are then in the map as well, where they largely cancel. For each set the best submodel is
/// searched exactly at every pair of a subset of `exponents` (six of each, and the map's own), so
/// that the choice of exponents and terms varies as with new data. Replicate b owns random stream
/// b. Does not depend on the number of threads.
std::vector<Replicate> draw_replicates(const WearPoints& points, const WearMap& map,
                                       const Eigen::VectorXd& sd, const RunInFit& run_in,
                                       const std::vector<RunIn>& run_ins,
                                       const std::vector<double>& exponents, std::uint64_t seed,
                                       int threads = 0, Progress* progress = nullptr);

/// One held-out point.
struct ValidationPoint {
  int number = 0;
  double measured = 0, predicted = 0;  ///< m^3/J
  double sd = 0;                       ///< of their difference
  double t = 0;  ///< studentized deletion residual: difference/sd, for a point outside the fit
  bool outlier = false;
};

struct Validation {
  struct Metrics {
    int points = 0;
    double r2 = 0;    ///< 1 - sum of squared differences/sum of squares about the mean
    double rmse = 0;  ///< m^3/J
    double bias = 0;  ///< mean difference, m^3/J
  };
  std::vector<ValidationPoint> points;
  double critical = 0;  ///< |t| above this is an outlier: 5 % for all points together (Bonferroni)
  Metrics all, without_outliers;
};

/// Compares a map with points outside its fit.
Validation validate(const WearMap& map, const Eigen::MatrixXd& covariance, const ScatterLaw& law,
                    const WearPoints& held_out);

/// The effect of averaging the inputs over a point (Table A3): volume predicted from the mean
/// inputs against the sum over its cycles, relative.
struct AveragingEffect {
  std::vector<int> point;
  std::vector<double> change;
  double total = 0;  ///< of all volumes together
};
AveragingEffect averaging_effect(const WearPolynomial& w, const std::vector<Cycle>& cycles,
                                 const std::vector<WornBlock>& blocks);

}  // namespace wearwell::clutch
