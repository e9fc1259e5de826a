#include "wearwell/models/formula_model/life_answers.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <functional>

#include "wearwell/study/mean_tail.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::formula_model {
namespace {

using Known = LifeDistribution::Known;

struct Question {
  std::function<Known()> value;
  std::optional<double> mean_from = {};  // of a mean life: of survivors of this

  Question(std::function<Known()> of_value, std::optional<double> from = {})
      : value(std::move(of_value)), mean_from(from) {}
};

// Those with a posterior; all run in parallel.
std::vector<Question> known_answers(const AskedOfLife& asked, const WeightedDraws& draws,
                                    double points) {
  std::vector<Question> all;
  const LifeDistribution& life = *asked.life;
  for (const double percent : asked.levels.percents)
    all.emplace_back([=, &draws, &life] { return life.quantile(draws, percent / 100, points); });
  if (asked.mean)
    all.emplace_back([=, &draws, &life] { return life.mean_beyond(draws, 0, points); }, 0.0);
  if (asked.survived) {
    const double from = asked.survived->si();
    for (const double percent : asked.levels.percents)
      all.emplace_back(
          [=, &draws, &life] { return life.quantile_beyond(draws, percent / 100, from, points); });
    if (asked.mean)
      all.emplace_back([=, &draws, &life] { return life.mean_beyond(draws, from, points); }, from);
  }
  for (const Quantity& each : asked.survival)
    all.emplace_back([=, &draws, &life] { return life.survival(draws, each.si(), points); });
  if (asked.other) {
    const LifeDistribution& other = *asked.other;
    all.emplace_back([=, &draws, &life, &other] { return life.outliving(draws, other, points); });
    for (const double percent : asked.levels.percents)
      all.emplace_back(
          [=, &draws, &life, &other] { return life.ratio(draws, other, percent / 100, points); });
    for (const Quantity& each : asked.survival)
      all.emplace_back([=, &draws, &life, &other] {
        return life.survival_difference(draws, other, each.si(), points);
      });
  }
  for (const Quantity& each : asked.hazard)
    all.emplace_back([=, &draws, &life] { return life.hazard(draws, each.si(), points); });
  if (asked.fast)
    all.emplace_back(
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

// Of a mean life of survivors of `from`.
std::optional<MeanTail> tail_of(const AskedOfLife& asked, const WeightedDraws& draws, double from,
                                const Known& mean) {
  const auto highest = share_of_highest(mean.distribution);
  if (!highest) return {};
  MeanTail tail{*highest, asked.observed.longest(*asked.life, draws), {}};
  if (!tail.longest) return tail;
  tail.beyond = asked.life->share_of_mean_beyond(draws, from, *tail.longest);
  if (!std::isfinite(*tail.beyond)) tail.longest = tail.beyond = {};
  return tail;
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
    const Question& question = known[i - 1];
    const Known value = question.value();
    found[i - 1] = answer_of(value, asked.levels);
    if (question.mean_from && points == 1)
      found[i - 1].quantiles.mean_tail = tail_of(asked, draws, *question.mean_from, value);
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
