#include "wearwell/models/formula_model/life_answers.h"

#include <tbb/parallel_for.h>

#include <functional>

#include "wearwell/study/numerical_error.h"

namespace wearwell::formula_model {
namespace {

using Known = LifeDistribution::Known;

// Those with a posterior; all run in parallel.
std::vector<std::function<Known()>> known_answers(const AskedOfLife& asked,
                                                  const WeightedDraws& draws, double points) {
  std::vector<std::function<Known()>> all;
  const LifeDistribution& life = *asked.life;
  for (const double percent : asked.levels.percents)
    all.push_back([=, &draws, &life] { return life.quantile(draws, percent / 100, points); });
  if (asked.mean) all.push_back([=, &draws, &life] { return life.mean_beyond(draws, 0, points); });
  if (asked.survived) {
    const double from = asked.survived->si();
    for (const double percent : asked.levels.percents)
      all.push_back(
          [=, &draws, &life] { return life.quantile_beyond(draws, percent / 100, from, points); });
    if (asked.mean)
      all.push_back([=, &draws, &life] { return life.mean_beyond(draws, from, points); });
  }
  for (const Quantity& each : asked.survival)
    all.push_back([=, &draws, &life] { return life.survival(draws, each.si(), points); });
  if (asked.other) {
    const LifeDistribution& other = *asked.other;
    all.push_back([=, &draws, &life, &other] { return life.outliving(draws, other, points); });
    for (const double percent : asked.levels.percents)
      all.push_back(
          [=, &draws, &life, &other] { return life.ratio(draws, other, percent / 100, points); });
    for (const Quantity& each : asked.survival)
      all.push_back([=, &draws, &life, &other] {
        return life.survival_difference(draws, other, each.si(), points);
      });
  }
  for (const Quantity& each : asked.hazard)
    all.push_back([=, &draws, &life] { return life.hazard(draws, each.si(), points); });
  if (asked.fast)
    all.push_back(
        [=, &draws, &life, &asked] { return life.ratio_of_middles(draws, *asked.fast, points); });
  return all;
}

// The predictive life, and the remaining life given survival.
std::vector<QuantityQuantiles> lives_of_next(const AskedOfLife& asked,
                                             const LifeDistribution::Next& next) {
  const auto quantiles = [](const auto& q) {
    return QuantityQuantiles{q(0.05), q(0.5), q(0.95), q(0.01), q(0.1), q(0.5)};
  };
  std::vector<QuantityQuantiles> all = {quantiles([&](double p) { return next.quantile(p); })};
  if (asked.survived)
    all.push_back(quantiles([&](double p) { return next.quantile(p, asked.survived->si()); }));
  return all;
}

struct Answer {
  QuantityQuantiles quantiles;
  double mean = 0;
};

Answer answer_of(const Known& known, const LifeLevels& levels) {
  const QuantityDistribution& of = known.distribution;
  Answer answer{{of.quantile(0.05), of.quantile(0.5), of.quantile(0.95), 0, 0, 0}, of.mean()};
  add_bounds(of, levels, answer.quantiles);
  answer.quantiles.numerical_error = known.misfit;
  return answer;
}

std::vector<QuantityQuantiles> answers_from(const AskedOfLife& asked, const WeightedDraws& draws,
                                            double points) {
  const auto known = known_answers(asked, draws, points);
  std::vector<Answer> found(known.size());
  LifeDistribution::Next next, other;
  tbb::parallel_for(std::size_t{0}, known.size() + 1, [&](std::size_t i) {
    if (i == 0) {
      next = asked.life->next(draws, points);
      if (asked.other) other = asked.other->next(draws, points);
      return;
    }
    found[i - 1] = answer_of(known[i - 1](), asked.levels);
  });
  std::vector<QuantityQuantiles> all;
  auto answer = found.begin();
  const auto add = [&](std::optional<double> predictive) {
    all.push_back((answer++)->quantiles);
    all.back().predictive = predictive;
    if (!predictive) all.back().bound = all.back().upper_bound = {};
  };
  const std::vector<double>& percents = asked.levels.percents;
  const std::vector<QuantityQuantiles> lives = lives_of_next(asked, next);
  all.push_back(lives.front());
  for (const double percent : percents) add(next.quantile(percent / 100));
  // The mean life of the next item is the mean of the mean lives.
  if (asked.mean) add(answer->mean);
  if (asked.survived) {
    all.push_back(lives.back());
    for (const double percent : percents) add(next.quantile(percent / 100, asked.survived->si()));
    if (asked.mean) add(answer->mean);
  }
  for (const Quantity& each : asked.survival) add(1 - next.cdf(each.si()));
  if (asked.other) {
    add(answer->mean);
    for (const double percent : percents)
      add(next.quantile(percent / 100) / other.quantile(percent / 100));
    for (const Quantity& each : asked.survival) add(other.cdf(each.si()) - next.cdf(each.si()));
  }
  while (answer != found.end()) add({});
  return all;
}

}  // namespace

std::vector<QuantityQuantiles> life_answers(const AskedOfLife& asked, const WeightedDraws& draws) {
  std::vector<QuantityQuantiles> found = answers_from(asked, draws, 1);
  const auto few = [](const auto& life) { return life && !life->over_all(); };
  if (few(asked.life) || few(asked.other) || few(asked.fast))
    estimate_numerical_errors(found, answers_from(asked, draws, fewer_points));
  return found;
}

std::vector<PredictiveLife> predictive_lives(const AskedOfLife& asked, const WeightedDraws& draws) {
  const LifeDistribution& life = *asked.life;
  const auto next = std::make_shared<const LifeDistribution::Next>(life.next(draws));
  std::vector<PredictiveLife> all = {{{[next](double x) { return next->cdf(x); },
                                       [next](double p) { return next->quantile(p); }}}};
  std::vector<QuantityQuantiles> errors;
  if (!life.over_all()) {
    errors = lives_of_next(asked, *next);
    estimate_numerical_errors(errors, lives_of_next(asked, life.next(draws, fewer_points)));
  }
  if (!errors.empty()) all.front().numerical_error = errors.front().numerical_error;
  if (!asked.survived) return all;
  const double from = asked.survived->si(), gone = next->cdf(from);
  all.push_back({{[=](double x) { return (next->cdf(from + x) - gone) / (1 - gone); },
                  [=](double p) { return next->quantile(p, from); }},
                 1 - gone});
  if (!errors.empty()) all.back().numerical_error = errors.back().numerical_error;
  return all;
}

}  // namespace wearwell::formula_model
