#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/rate_change.h"

namespace wearwell::formula_model {

/// A unit whose rate does not change.
using UnchangedUnit = TrackedUnit;

/// A tracked unit whose rate may change once (docs/how-to/rate-change.md).
///
/// The unit without a change has the nodes of TrackedUnit; those with one are particles. Each
/// reading adds particles that have changed since the reading before it, drawn from the nodes and
/// the prior of the change, and multiplies all weights by its likelihood. Where few particles would
/// carry the weight, they are resampled and moved (rate_change_moves.h; resample-move, Gilks and
/// Berzuini 2001). Random numbers follow from the readings, so the same sequence gives the same bits.
class RateChangeUnit final : public prognosis::TrackedUnit {
 public:
  RateChangeUnit(std::shared_ptr<const RateChanges> shared,
                 std::unique_ptr<UnchangedUnit> unchanged);
  /// Throws InputError.
  static std::unique_ptr<RateChangeUnit> restore(
      std::shared_ptr<const RateChanges> shared, const std::string& bytes,
      const std::function<std::vector<UnitReading>(const std::string& unit)>& seen);

  prognosis::UpdateResult update(const prognosis::Reading& reading,
                                 const prognosis::History& history) override;
  prognosis::Forecast forecast() const override;
  std::vector<prognosis::PredictiveTails> predictive(
      const prognosis::Reading& reading) const override;
  std::vector<prognosis::ForecastBand> ahead(std::span<const double> places) const override;
  void set_restored(double amount) override { base_->set_restored(amount); }
  std::size_t readings() const override { return base_->readings(); }
  std::string save() const override;

  static constexpr std::size_t usual = 1024;  ///< particles after resampling

 private:
  ChangedUnits newborn(double until, Rng& rng) const;
  ChangedUnits drawn_from_base(const std::vector<std::size_t>& which, Rng& rng) const;
  struct Likelihoods {
    std::vector<double> changed, born;  // of each particle
    double unchanged = 0;               // of the unit without a change
  };
  Likelihoods likelihoods(const UnitReading& reading, ChangedUnits& born);
  void thin(ChangedUnits& born, Rng& rng) const;
  std::vector<UnitReading> all_readings(const UnitReading& last,
                                        const prognosis::History& history) const;
  void weigh(const UnitReading& reading, Likelihoods of, ChangedUnits born,
             const prognosis::History& history, Rng& rng);
  prognosis::UpdateResult update_in_order(const prognosis::Reading& reading,
                                          const prognosis::History& history);
  prognosis::UpdateResult run_again(const prognosis::Reading& reading,
                                    const prognosis::History& history);
  double probability() const;  // that the rate has changed
  double last_place() const;
  UnitReading last_row() const;
  NodeAxis future(std::size_t nodes) const;
  std::vector<prognosis::PredictiveTails> mixed_tails(
      const UnitReading& reading, std::vector<prognosis::PredictiveTails> tails) const;

  std::shared_ptr<const RateChanges> shared_;
  std::unique_ptr<UnchangedUnit> base_;  // without a change
  double start_ = 0;                     // no change before: the last row of the study
  double log_unchanged_ = 0;             // its weight, as those of the particles
  ChangedUnits changed_;
  std::size_t updates_ = 0;
};

}  // namespace wearwell::formula_model
