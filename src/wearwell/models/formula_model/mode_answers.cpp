#include "wearwell/models/formula_model/mode_answers.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/models/formula_model/mode_figures.h"
#include "wearwell/models/formula_model/part_lives.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::formula_model {
namespace {

// Some of the modes, and how a report names a part that can fail by them only.
struct SomeModes {
  std::uint32_t modes;
  std::string of;       // "with mode 1 alone"
  std::string at = {};  // other words for the same
};

// Of two modes, a part with one alone is the part without the other.
std::vector<SomeModes> selections(const std::vector<std::string>& modes) {
  const std::uint32_t every = (std::uint32_t{1} << modes.size()) - 1;
  std::vector<SomeModes> all;
  if (modes.size() < 2) return all;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    all.push_back({std::uint32_t{1} << k, fmt::format("with {} alone", modes[k])});
    if (modes.size() == 2) all.back().at = "without " + modes[1 - k];
  }
  for (std::size_t k = 0; modes.size() > 2 && k < modes.size(); ++k)
    all.push_back({every & ~(std::uint32_t{1} << k), "without " + modes[k]});
  return all;
}

void add_lives(const AskedOfModes& asked, const SomeModes& some, PosteriorStudy& study) {
  const Unit& unit = asked.model->measured.front().unit;
  const std::string noun = asked.noun + " " + some.of, at = joined(asked.words, some.at);
  AskedOfLife own = asked.part;
  own.life = life_distribution(asked.predict, asked.predict.has("given") ? "given" : "",
                               asked.model, asked.conditions, some.modes);
  add_lives_of(own, noun, at, unit, study);
}

std::vector<QuantityQuantiles> shares_failed(std::size_t modes, const AskedOfLife& asked,
                                             const WeightedDraws& draws, double points) {
  const std::vector<Quantity>& by = asked.survival;
  std::vector<QuantityQuantiles> all(modes * by.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    const LifeDistribution::Known known =
        asked.life->incidence(draws, i % modes, by[i / modes].si(), points);
    const QuantityDistribution& of = known.distribution;
    all[i] = {of.quantile(0.05), of.quantile(0.5), of.quantile(0.95), 0, 0, 0};
    // The probability that the next one fails so is the mean of the shares.
    all[i].predictive = of.mean();
    add_bounds(of, asked.levels, all[i]);
    all[i].numerical_error = known.misfit;
  });
  return all;
}

void add_shares(const AskedOfModes& asked, PosteriorStudy& study) {
  const std::vector<Quantity>& by = asked.part.survival;
  const std::vector<std::string>& modes = asked.model->modes->modes;
  if (by.empty()) return;
  QuantityGroup group;
  for (const Quantity& each : by) {
    for (const std::string& mode : modes) {
      group.requests.push_back(request(fmt::format("failed by {} to {}", mode, description(each)),
                                       asked.noun, asked.words, Unit{"%", 0.01, 0}));
      group.requests.back().safe_end = 0.95;
      ask_bounds(asked.part.levels, group.requests.back());
    }
  }
  group.from_draws = [of = asked.part, count = modes.size()](const WeightedDraws& draws) {
    std::vector<QuantityQuantiles> found = shares_failed(count, of, draws, 1);
    if (!of.life->over_all())
      estimate_numerical_errors(found, shares_failed(count, of, draws, fewer_points));
    return found;
  };
  study.quantity_groups.push_back(std::move(group));
}

}  // namespace

void add_mode_answers(const AskedOfModes& asked, PosteriorStudy& study) {
  add_shares(asked, study);
  for (const SomeModes& each : selections(asked.model->modes->modes)) add_lives(asked, each, study);
  show_incidence(asked.model, asked.part.life, asked.words, study);
}

}  // namespace wearwell::formula_model
