#pragma once

#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Which B-lives are told, and how far their lower bounds can be relied on.
struct LifeLevels {
  std::vector<double> percents;  ///< that have failed, between 0 and 100; empty where none are told
  double credible_level = 0.9;   ///< with which a B-life exceeds its bound
};

/// Reads predict.b_lives and predict.credible_level; where only the second stands, B1 and B10 are told.
/// Throws InputError.
LifeLevels read_life_levels(const TomlReader& predict);

/// "B10 life", "B0.1 remaining useful life".
std::string b_life_name(double percent, const std::string& life = "life");

/// What is asked of that B-life of what `life` is the life of; `life` itself where `of` is empty.
QuantityRequest b_life_request(double percent, const LifeLevels& levels,
                               const QuantityRequest& life, const std::string& of = {});

/// Of a B-life that is `known` so far (a Distribution or its like), and what it is for the next one.
template <class Known>
QuantityQuantiles b_life(const Known& known, double predictive, const LifeLevels& levels) {
  QuantityQuantiles q{known.quantile(0.05), known.quantile(0.5), known.quantile(0.95), 0, 0, 0};
  q.predictive = predictive;
  q.bound = known.quantile(1 - levels.credible_level);
  return q;
}

/// B-lives of one thing, whose life only the posterior spreads: its quantiles.
QuantityGroup b_lives_of_one(const LifeRequest& life, const std::string& of, const std::string& at,
                             const LifeLevels& levels);

/// B-lives of items like that of which `life` is, whose driver differs from item to item where the request
/// has a scatter.
QuantityGroup b_lives_of_items(const QuantityRequest& life, const std::string& of,
                               const LifeLevels& levels);

}  // namespace wearwell
