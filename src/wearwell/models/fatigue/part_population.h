#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/fatigue/damage_sum.h"
#include "wearwell/models/fatigue/part_damage.h"
#include "wearwell/models/fatigue/part_reading.h"
#include "wearwell/models/fatigue/part_run.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/models/fatigue/stress_lives.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell::fatigue {

/// What all tracked parts of a study share.
struct PartPopulation {
  SnLaw law;
  SnData data;
  PartReading reading;
  ThinnedPosterior few;
  DamageSum sum;                           ///< predict.damage_sum; 1 without it
  std::optional<Stress> ahead;             ///< of a part without readings
  std::vector<std::string> seen;           ///< run-outs
  std::map<std::string, std::size_t> row;  ///< of each part of the study
  std::string fingerprint;

  /// Throws InputError.
  PartPopulation(const TomlReader& root, const prognosis::CarriedState& state);

  /// Why a part of the study cannot be tracked: it failed there. Empty if it can.
  std::string refusal(const std::string& part) const;
  /// Its run-out in the study, which the posterior contains; empty for a new part.
  PartRun studied(const std::string& part) const;

  /// Whether its life is one of the study's lives under that stress, without sums of damage.
  bool is_constant(const PartRun& run, const Stress& ahead) const {
    return sum.is_one() && run.is_under(ahead);
  }
  /// The lives under one stress. Tables of a few stresses are cached; this does not change results.
  std::shared_ptr<const StressLives> lives(const Stress& stress) const;
  PartDamage damage(const PartRun& run, const Stress& ahead) const {
    return PartDamage(law, few, run.cycles, ahead, sum);
  }
  /// log P(a part survives this run), given that it has survived `studied`, at each point of the
  /// posterior.
  std::vector<double> log_survival(const PartRun& run, const Stress& ahead,
                                   const PartRun& studied) const;

 private:
  mutable std::mutex lock_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<const StressLives>> lives_;
};

}  // namespace wearwell::fatigue
