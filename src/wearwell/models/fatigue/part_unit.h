#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/part_population.h"
#include "wearwell/models/fatigue/part_run.h"
#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::fatigue {

/// The first text of its saved state.
inline constexpr std::string_view part_mark = "wearwell part 2";

/// One part that has not failed (part_tracker.h).
class PartUnit final : public prognosis::TrackedUnit {
 public:
  PartUnit(std::shared_ptr<const PartPopulation> parts, std::string name);

  prognosis::UpdateResult update(const prognosis::Reading& reading,
                                 const prognosis::History& history) override;
  prognosis::Forecast forecast() const override;
  std::vector<prognosis::PredictiveTails> predictive(
      const prognosis::Reading& reading) const override;
  std::vector<prognosis::ForecastBand> ahead(std::span<const double> places) const override;
  std::optional<prognosis::InPopulations> in_populations(
      const prognosis::History& history) const override;
  std::size_t readings() const override { return readings_; }
  std::string save() const override;
  void load(prognosis::ByteReader& from);

 private:
  /// The posterior's points weighted by the survival of the part; the weights sum to `survival`.
  struct Weights {
    std::vector<double> weight;
    double survival = 0;
  };
  bool has_forecast() const;
  bool is_late(const RunReading& reading) const;
  std::string problem_of(const prognosis::Reading& reading, RunReading& read) const;
  std::string stress_problem(const RunReading& read) const;
  std::string run_problem(const PartRun& run) const;
  std::string two_stresses(double cycles, const Stress& one, const Stress& other) const;
  Weights weights(const PartRun& run, const Stress& ahead) const;
  prognosis::UpdateResult take_late(const RunReading& reading, const prognosis::History& history);
  double survival_until(const PartRun& run) const;

  std::shared_ptr<const PartPopulation> parts_;
  std::string name_, refusal_;
  PartRun studied_;     // its run-out
  PartRun run_;         // with the readings since; `last` is the stress ahead
  bool bound_ = false;  // the stress ahead is its own, not that of every new part
  std::size_t readings_ = 0;
};

}  // namespace wearwell::fatigue
