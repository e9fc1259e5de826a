#include "wearwell/models/formula_model/subpopulation_answers.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <functional>

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/models/formula_model/part_lives.h"
#include "wearwell/study/never_reached.h"

namespace wearwell::formula_model {
namespace {

using Known = LifeDistribution::Known;

struct Share {
  std::string name;
  std::function<Known(const LifeDistribution&, const WeightedDraws&)> value;
};

std::vector<Share> shares_of(const AskedOfMixture& asked) {
  std::vector<Share> all;
  const LifeMixture& life = asked.model->measured.front().life;
  if (life.limited)
    all.push_back(
        {share_failing, [](const auto& part, const auto& draws) { return part.failing(draws); }});
  if (!asked.model->subpopulations) return all;
  const std::vector<std::string>& names = asked.model->subpopulations->names;
  for (std::size_t k = 0; k < names.size(); ++k)
    all.push_back({"share of " + names[k], [k](const auto& part, const auto& draws) {
                     return part.share_among_survivors(draws, k, 0);
                   }});
  for (const Quantity& each : asked.part.survival) {
    for (std::size_t k = 0; k < names.size(); ++k)
      all.push_back({fmt::format("share of {} among survivors of {}", names[k], description(each)),
                     [k, at = each.si()](const auto& part, const auto& draws) {
                       return part.share_among_survivors(draws, k, at);
                     }});
  }
  return all;
}

void add_shares(const AskedOfMixture& asked, PosteriorStudy& study) {
  const std::vector<Share> shares = shares_of(asked);
  if (shares.empty()) return;
  QuantityGroup group;
  for (const Share& each : shares) {
    group.requests.push_back(request(each.name, asked.noun, asked.words, Unit{"%", 0.01, 0}));
    group.requests.back().safe_end = 0.95;
  }
  group.from_draws = [part = asked.part.life, shares](const WeightedDraws& draws) {
    std::vector<QuantityQuantiles> all(shares.size());
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
      const QuantityDistribution of = shares[i].value(*part, draws).distribution;
      all[i] = {of.quantile(0.05), of.quantile(0.5), of.quantile(0.95), 0, 0, 0};
    });
    return all;
  };
  study.quantity_groups.push_back(std::move(group));
}

}  // namespace

void add_mixture_answers(const AskedOfMixture& asked, PosteriorStudy& study) {
  add_shares(asked, study);
  if (!asked.model->subpopulations) return;
  const std::string key = asked.predict.has("given") ? "given" : "";
  const std::vector<std::string>& names = asked.model->subpopulations->names;
  for (std::size_t k = 0; k < names.size(); ++k) {
    AskedOfLife own = asked.part;
    own.life = life_of_subpopulation(asked.predict, key, asked.model, asked.conditions, k);
    add_lives_of(own, fmt::format("{} of {}", asked.noun, names[k]), asked.words,
                 asked.model->measured.front().unit, study);
  }
}

}  // namespace wearwell::formula_model
