#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/damage_sum.h"
#include "wearwell/models/fatigue/life.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// A requested stress.
struct StressPoint {
  std::string name;  ///< "type A"
  fatigue::Stress stress;
};

/// The alternating stress under which a share of items outlasts a life.
struct AllowedStress {
  Quantity life;
  double reliability = 0;
  fatigue::StressLine line;
};

/// The requests in [predict] of an S-N study.
struct SnPredictions {
  std::vector<StressPoint> points;
  std::vector<double> percents;  ///< of the B-lives
  bool mean = false;             ///< the mean lives
  LifeLevels levels;             ///< of the bounds
  std::vector<Quantity> survival_to;
  std::vector<AllowedStress> allowed;
};

/// The tested stresses, by the type of specimen if there are types; a type tested under several
/// stresses occurs with each.
std::vector<StressPoint> tested_points(const fatigue::SnLaw& law, const SnData& data);

/// Reads [predict]. Throws InputError.
SnPredictions read_sn_predictions(const TomlReader& predict, const fatigue::SnLaw& law,
                                  const SnData& data);

/// The damage sum at which tracked parts fail (predict.damage_sum): 1 if it is not given. Throws
/// InputError.
fatigue::DamageSum read_part_damage_sum(const TomlReader& predict, const fatigue::SnLaw& law);

/// Lives, B-lives, survival and allowed stresses, as quantities of the study.
void add_sn_quantities(const fatigue::SnLaw& law, const SnData& data,
                       const SnPredictions& predictions, PosteriorStudy& study);

/// The life of the next item under a stress. It has no draws: its distribution is a mixture over
/// the posterior.
fatigue::MixedLife next_life(const fatigue::SnLaw& law, const WeightedDraws& draws,
                             const fatigue::Stress& stress);

/// The alternating stress [Pa] along a line under which the next item outlasts `life` with
/// probability `reliability`.
double next_allowed(const fatigue::SnLaw& law, const WeightedDraws& draws,
                    const fatigue::StressLine& line, double life, double reliability);

/// The score of each test in the predictive life of its stress.
CoverageTable sn_coverage(const fatigue::SnLaw& law, const SnData& data,
                          const WeightedDraws& draws);

/// Whether requested stresses and lives are in the tested range, and whether the number of tests
/// supports the percentiles.
std::vector<Check> sn_checks(const fatigue::SnLaw& law, const SnData& data,
                             const SnPredictions& predictions, const Fit& fit);

/// "271.1 MPa about 1005.5 MPa": alternating and mean stress.
std::string description(const fatigue::SnLaw& law, const SnData& data,
                        const fatigue::Stress& stress);

}  // namespace wearwell
