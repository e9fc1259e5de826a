#pragma once

#include <Eigen/Dense>
#include <string>
#include <unordered_map>
#include <vector>

#include "wearwell/models/clutch/energy_balance.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// Consecutive cycles by column, SI and Celsius as in Cycle.
struct CycleColumns {
  std::vector<double> plate, number;  ///< whole
  Eigen::ArrayXd slip_speed, torque, temperature, closing_time, energy;

  Eigen::Index size() const { return energy.size(); }
};

/// The state of a plate after its cycles so far.
struct PlateWear {
  int plate = 0;
  std::string name = {};  ///< if plates have names; else empty
  long long cycles = 0, last_number = 0;
  double energy = 0;                   ///< Ec, J
  double closings = 0;                 ///< J, 1/2 Mz omega0 t2 of the same cycles (EnergyBalance)
  double volume = 0;                   ///< V, m^3
  double variance = 0;                 ///< variance of V by the scatter of cycles, m^6
  EnergyOutliers outliers = {};        ///< cycles with an energy that no closing can have
  std::array<long long, 4> outside{};  ///< cycles outside the calibrated range, by input
  long long outside_any = 0;
  long long clamped = 0;      ///< cycles where the map is negative: counted as no wear
  long long skipped = 0;      ///< cycles without a finite value: skipped (NotFinite::skip)
  Eigen::ArrayXd replicates;  ///< V of each replicate; empty if not requested

  std::string description() const { return name.empty() ? std::to_string(plate) : name; }
  EnergyBalance balance() const { return {energy, closings}; }
  double sd() const { return std::sqrt(variance); }
  /// Includes the uncertainty of coefficients, exponents, terms, run-in (mean square of the
  /// replicates about V) and of the plate's factor.
  double full_sd(double plate_sd) const;
};

/// The treatment of a cycle at which the model, or the sum, is not finite.
enum class NotFinite { refuse, skip };

/// The cycle-wise sum (Haramina et al. 2025, section 3.5):
///
///   V_k = V_{k-1} + g(Ec) w_mu E_k,   var_k = var_{k-1} + (w_sigma E_k)^2,
///
/// for any number of plates. First `rates` of some cycles (any thread), then `add` in the order of
/// the cycles. The division of the cycles into pieces does not change a bit of the result.
class CycleSum {
 public:
  /// Without replicates it is about ten times as fast, and full_sd lacks their part.
  CycleSum(const WearModel& model, bool with_replicates, NotFinite not_finite = NotFinite::refuse);

  /// The known names of plate 1, 2, ..., if plates have names.
  void name_plates(std::vector<std::string> names) { names_ = std::move(names); }

  struct Rates {
    Eigen::ArrayXd w, sigma;        ///< m^3/J
    std::vector<unsigned> outside;  ///< inputs, as outside(); then `negative`, `no_number`
    Eigen::ArrayXXd replicates;     ///< w of each, a column each
  };
  static constexpr unsigned negative = 1u << inputs.size(), no_number = negative << 1;
  void rates(const CycleColumns& cycles, Rates& rates) const;

  /// Volume and variance after each cycle, if requested. Throws InputError, naming row (counted
  /// from `first_row`), plate and cycle, for a cycle number that does not follow the plate's
  /// previous one; and for a cycle without a finite value, unless such cycles are skipped.
  struct Trace {
    std::vector<double> volume, sd;
    std::vector<double> full_sd;  ///< empty without replicates
    std::vector<bool> skipped;
  };
  void add(const CycleColumns& cycles, const Rates& rates, std::size_t first_row = 0,
           Trace* trace = nullptr);

  bool with_replicates() const { return with_replicates_; }

  /// By first occurrence.
  const std::vector<PlateWear>& plates() const { return plates_; }
  /// Continues from here: plates in the form of plates().
  void restore(std::vector<PlateWear> plates);

 private:
  PlateWear& plate(int number);
  bool step(PlateWear& p, const CycleColumns& cycles, const Rates& rates, Eigen::Index i);

  const WearModel& model_;
  WearPolynomial polynomial_;
  bool with_replicates_;
  NotFinite not_finite_;
  Eigen::ArrayXd slow_, fast_, slow_energy_, fast_energy_;  ///< of the replicates
  Eigen::ArrayXd g_, worn_;                                 ///< likewise, storage of `step`
  std::vector<PlateWear> plates_;
  std::unordered_map<int, std::size_t> place_;  ///< in plates_
  std::size_t current_ = 0;
  std::vector<std::string> names_;
};

}  // namespace wearwell::clutch
