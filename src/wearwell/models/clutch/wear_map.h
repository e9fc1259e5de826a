#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "wearwell/base/progress.h"
#include "wearwell/models/clutch/operating_point.h"
#include "wearwell/regress/least_squares.h"
#include "wearwell/regress/terms.h"

namespace wearwell::clutch {

/// Wear rates at operating points, compensated for run-in and plate.
struct WearPoints {
  std::vector<int> number;  ///< of the design point
  std::vector<OperatingPoint> at;
  Eigen::VectorXd w;           ///< m^3/J
  Eigen::VectorXd cycles;      ///< n_j
  Eigen::VectorXd balance_sd;  ///< of w, m^3/J
  /// Of compensated points, or empty: the divisor of w, for run-in and plate; the plate, and its
  /// absorbed energy before and after, J.
  Eigen::VectorXd factor;
  std::vector<int> plate;
  std::vector<double> from, to;

  Eigen::Index size() const { return w.size(); }
  /// The number of cycles with the same scatter without compensation: cycles factor^2.
  Eigen::VectorXd effective_cycles() const {
    return factor.size() == 0 ? cycles : cycles.cwiseProduct(factor.cwiseAbs2());
  }
};

/// Substitutes for two or three of the inputs (Haramina et al. 2025, section 3.3 and Table A1).
/// Only the distance is printed in the paper; the other two are our own.
enum class Surrogate {
  distance,  ///< ds = omega0^r t2^q, beside Td and Mz
  power,     ///< ps = omega0^r Mz^q, beside Td and t2
  energy     ///< es = (omega0 t2)^r Mz^q, beside Td
};
inline constexpr Surrogate surrogates[] = {Surrogate::distance, Surrogate::power,
                                           Surrogate::energy};
const char* name_of(Surrogate surrogate);

/// Names of the inputs of the polynomial, the surrogate first.
std::vector<std::string> input_names(Surrogate surrogate);
/// Their values, one row per point.
Eigen::MatrixXd input_values(Surrogate surrogate, double r, double q,
                             const std::vector<OperatingPoint>& at);

/// The best submodel at one pair of exponents.
struct PairBest {
  double r = 0, q = 0;
  double press = 0, r2 = 0, r2p = 0;
  std::vector<int> terms;  ///< of the full cubic
};

struct ExponentSearch {
  Surrogate surrogate = Surrogate::distance;
  std::vector<double> exponents;
  std::vector<PairBest> pairs;  ///< by r, then by q
  std::size_t best = 0;
  double submodels = 0;  ///< of each pair
  double seconds = 0;
};

/// The paper's exponents: 0.1, 0.2, ... 3.0.
std::vector<double> paper_exponents();

/// At every pair of exponents the best of all submodels of the cubic polynomial by leave-one-out,
/// exactly (regress/subset_search.h): 2^20 - 1 submodels for three inputs. `drop_temperature`
/// leaves out Td, for points of one temperature. Ties go to the smaller r, then q. Does not depend
/// on the number of threads. `progress`, if given, advances by one per pair. Throws InputError for
/// points that no polynomial can fit.
ExponentSearch search_exponents(const WearPoints& points, Surrogate surrogate,
                                const std::vector<double>& exponents, int threads = 0,
                                bool drop_temperature = false, Progress* progress = nullptr);

/// Only the best of those pairs, the same as from search_exponents: the search of a pair ends as
/// soon as it certainly cannot beat another. `start`: terms of a promising model, or empty; they
/// change only the time.
PairBest best_exponents(const WearPoints& points, Surrogate surrogate,
                        const std::vector<double>& exponents, const std::vector<int>& start,
                        int threads = 0, bool drop_temperature = false,
                        Progress* progress = nullptr);

/// A fitted polynomial of wear rates.
struct WearMap {
  std::string name;  ///< "selected", "linear", "full cubic", "temperature"
  Surrogate surrogate = Surrogate::distance;
  double r = 1, q = 1;
  Design design;           ///< all terms and their scaling
  std::vector<int> terms;  ///< chosen
  LinearFit fit;           ///< on the scaled terms

  Eigen::VectorXd predict(const std::vector<OperatingPoint>& at) const;
  /// Scaled terms, one row per point.
  Eigen::MatrixXd rows(const std::vector<OperatingPoint>& at) const;
};

/// Fits the chosen terms of the polynomial of `degree` by least squares, all of them if `terms` is
/// empty.
WearMap fit_map(const std::string& name, const WearPoints& points, Surrogate surrogate, double r,
                double q, int degree, std::vector<int> terms);

/// The baseline: a cubic in the temperature alone.
WearMap fit_temperature_map(const WearPoints& points);

/// Pearson's correlation of w with each of `inputs` (Table 1).
std::array<double, 4> correlations(const WearPoints& points);

}  // namespace wearwell::clutch
