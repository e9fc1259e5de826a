#pragma once

#include <string>
#include <vector>

#include "wearwell/input/study_keys.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Which B-lives are reported, and with which bounds.
struct LifeLevels {
  std::vector<double> percents;  ///< failed, between 0 and 100; empty: no B-lives
  double credible_level = 0.9;   ///< probability of each one-sided bound, or between both
  BoundSides sides = BoundSides::lower;

  double below() const;  ///< the probability below a lower bound, and above an upper one
};

/// Reads predict.b_lives, predict.level (or predict.credible_level, the same) and predict.sides; with a level or sides alone,
/// B1 and B10 are reported. Throws InputError.
LifeLevels read_life_levels(const TomlReader& predict);

/// "lower", "upper" or "both"; empty for other texts.
std::optional<BoundSides> sides_named(const std::string& text);
inline constexpr const char* sides_refusal =
    "is \"lower\" or \"upper\" (the level is that of this bound) or \"both\" (that of the interval "
    "between both)";

/// The keys of both, for lists of keys: "B-lives and survival" have the bounds.
StudyKeys level_keys(const std::string& of);

/// Adds the bounds of a quantity whose posterior is `known` (a Distribution or similar).
template <class Known>
void add_bounds(const Known& known, const LifeLevels& levels, QuantityQuantiles& q) {
  if (has_lower(levels.sides)) q.bound = known.quantile(levels.below());
  if (has_upper(levels.sides)) q.upper_bound = known.quantile(1 - levels.below());
}
/// The same of a request.
void ask_bounds(const LifeLevels& levels, QuantityRequest& request);

/// "B10 life", "B0.1 remaining useful life".
std::string b_life_name(double percent, const std::string& life = "life");

/// The request for this B-life of the items of `life`; `life` itself if `of` is empty.
QuantityRequest b_life_request(double percent, const LifeLevels& levels,
                               const QuantityRequest& life, const std::string& of = {});

/// Quantiles of a B-life whose posterior is `known` (a Distribution or similar), with the
/// predictive value of the next item.
template <class Known>
QuantityQuantiles b_life(const Known& known, double predictive, const LifeLevels& levels) {
  QuantityQuantiles q{known.quantile(0.05), known.quantile(0.5), known.quantile(0.95), 0, 0, 0};
  q.predictive = predictive;
  add_bounds(known, levels, q);
  return q;
}

/// B-lives of one item, whose life is uncertain only through the posterior: quantiles of its life.
QuantityGroup b_lives_of_one(const LifeRequest& life, const std::string& of, const std::string& at,
                             const LifeLevels& levels);

/// B-lives of items like that of `life`, whose driver varies from item to item if the request has a
/// scatter.
QuantityGroup b_lives_of_items(const QuantityRequest& life, const std::string& of,
                               const LifeLevels& levels);

}  // namespace wearwell
