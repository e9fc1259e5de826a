#pragma once

#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Which B-lives are reported, and the credible level of their lower bounds.
struct LifeLevels {
  std::vector<double> percents;  ///< failed, between 0 and 100; empty: no B-lives
  double credible_level = 0.9;   ///< probability that a B-life exceeds its bound
};

/// Reads predict.b_lives and predict.credible_level; with the second alone, B1 and B10 are
/// reported. Throws InputError.
LifeLevels read_life_levels(const TomlReader& predict);

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
  q.bound = known.quantile(1 - levels.credible_level);
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
