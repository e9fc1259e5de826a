#include "wearwell/models/formula_model/limit_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/study/mean_tail.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::formula_model {

LimitWishes read_limit_wishes(const Asked& asked, LimitedPath& path) {
  LimitWishes wishes{read_life_levels(asked.predict), {}, false};
  path.survived = path.begin;
  const auto survived =
      asked.predict.quantity("survived", formula::si_text(asked.axis().unit.powers));
  if (survived) {
    if (!(survived->si() > path.begin)) {
      asked.predict.fail("survived", fmt::format("must lie beyond {:.6g} {}, the start of paths",
                                                 from_si(asked.axis().unit.unit, path.begin),
                                                 asked.axis().unit.unit.text));
    }
    path.survived = survived->si();
    wishes.survived = survived;
  }
  for (const double percent : wishes.levels.percents) path.shares.push_back(percent / 100);
  wishes.mean = path.mean = asked.predict.boolean("mean_life").value_or(false);
  return wishes;
}

// Lives conditional on survival to a given point.
struct LimitGroup::Remaining {
  CellMixture lives;
  double survival = 1;  // the probability that the unit survives to this point

  bool any() const { return lives.mass() > 1e-6; }
  // If units hardly ever survive to this point, the rest is undetermined; if the limit is
  // certainly passed, nothing remains.
  double quantile(double p) const {
    if (survival < 1e-3) return std::nan("");
    return any() ? lives.quantile(p) : 0;
  }
  double mean() const {
    if (survival < 1e-3) return std::nan("");
    return any() ? lives.mean() : 0;
  }
  double cdf(double x) const { return any() ? lives.cdf(x) : 1; }
  QuantityQuantiles quantiles() const {
    const double middle = quantile(0.5);
    return {quantile(0.05), middle, quantile(0.95), quantile(0.01), quantile(0.1), middle};
  }
};

LimitGroup::LimitGroup(const Asked& asked, const std::string& name, const Quantity& limit,
                       std::shared_ptr<const LimitedPath> path, LimitWishes wishes)
    : path_(std::move(path)), wishes_(std::move(wishes)) {
  const Unit& unit = asked.axis().unit.unit;
  const std::string to = fmt::format("to {} = {}", name, description(limit));
  const std::string at = joined(to, asked.given.words);
  const auto from = [&](double place) {
    return fmt::format("{} from {:.6g} {} on", at, from_si(unit, place), unit.text);
  };
  if (path_->next) add_life("life", "new " + asked.noun, at, unit);
  if (path_->next && wishes_.survived) {
    add_life("remaining useful life", "new " + asked.noun, from(path_->survived), unit);
  }
  for (std::size_t u = 0; u < path_->seen.size(); ++u) {
    add_life("remaining useful life", asked.unit(path_->seen[u].unit), from(begin_of(u)), unit);
  }
  const std::size_t lives = requests_.size();
  if (wishes_.survived) {
    const std::string survival = "survival to " + description(*wishes_.survived);
    const auto add = [&](const std::string& of) {
      requests_.push_back(request(survival, of, at, Unit{"%", 0.01, 0}));
    };
    if (path_->next) add("new " + asked.noun);
    for (std::size_t u = 0; u < path_->seen.size(); ++u) add(asked.unit(path_->seen[u].unit));
  }
  for (std::size_t i = path_->next && wishes_.survived ? 1 : 0; i < lives; ++i) {
    for (const double percent : wishes_.levels.percents) {
      const QuantityRequest life = requests_[i];
      const bool next = path_->next && i == (wishes_.survived ? 1 : 0);
      requests_.push_back(
          b_life_request(percent, wishes_.levels, life, next ? asked.noun : life.of));
    }
    if (wishes_.mean)
      add_mean(requests_[i], path_->next && i == (wishes_.survived ? 1 : 0), asked.noun);
  }
}

// The mean over new units has a posterior; that of one unit is averaged over it, one number without an interval.
void LimitGroup::add_mean(const QuantityRequest& life, bool next, const std::string& noun) {
  const QuantityRequest own = life;
  requests_.push_back(request("mean " + own.name, next ? noun : own.of, own.at, own.unit));
  if (!next) return;
  requests_.back().safe_end = 0.05;
  ask_bounds(wishes_.levels, requests_.back());
}

std::vector<LimitGroup::Remaining> LimitGroup::remaining(const LimitedLives& lives) const {
  std::vector<Remaining> all;
  if (path_->next) all.push_back({lives.next});
  if (path_->next && wishes_.survived) {
    all.push_back({lives.next.beyond(path_->survived)});
    all.back().survival = all.back().lives.mass() / lives.next.mass();
  }
  for (std::size_t u = 0; u < path_->seen.size(); ++u) {
    const double more = begin_of(u) - path_->seen[u].now, now = lives.remaining[u].mass();
    all.push_back({more > 0 ? lives.remaining[u].beyond(more) : lives.remaining[u]});
    const double survival = all.back().lives.mass() / (now + lives.passed[u]);
    if (wishes_.survived) all.back().survival = survival;
  }
  return all;
}

std::vector<QuantityQuantiles> LimitGroup::answers(const LimitedLives& lives) const {
  const std::vector<Remaining> all = remaining(lives);
  std::vector<QuantityQuantiles> found;
  for (const Remaining& each : all) found.push_back(each.quantiles());
  const std::size_t first = path_->next && wishes_.survived ? 1 : 0;
  for (std::size_t i = first; wishes_.survived && i < all.size(); ++i) {
    const double p = all[i].survival;
    found.push_back({p, p, p, 0, 0, 0});
  }
  for (std::size_t i = first; i < all.size(); ++i) {
    const bool next = path_->next && i == first;
    for (std::size_t k = 0; k < wishes_.levels.percents.size(); ++k) {
      const double predictive = all[i].quantile(wishes_.levels.percents[k] / 100);
      found.push_back(
          next ? b_life(Remaining{lives.by_share[k], all[i].survival}, predictive, wishes_.levels)
               : b_life(all[i], predictive, wishes_.levels));
      if (next && k < lives.share_misfit.size())
        found.back().numerical_error = lives.share_misfit[k];
    }
    if (!wishes_.mean) continue;
    const double mean = all[i].mean();
    if (!next) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      found.push_back({none, none, none, 0, 0, 0});
      found.back().mean = mean;
      if (!std::isnan(mean))
        found.back().mean_tail = MeanTail{share_of_highest(all[i].lives), {}, {}};
      continue;
    }
    found.push_back(b_life(Remaining{lives.mean, all[i].survival}, mean, wishes_.levels));
    found.back().numerical_error = lives.mean_misfit;
    if (!std::isnan(mean)) found.back().mean_tail = MeanTail{share_of_highest(lives.mean), {}, {}};
  }
  return found;
}

std::vector<QuantityQuantiles> LimitGroup::answers(
    const LimitedLives& lives, const std::optional<LimitedLives>& coarse) const {
  std::vector<QuantityQuantiles> found = answers(lives);
  if (coarse) estimate_numerical_errors(found, answers(*coarse));
  return found;
}

std::vector<PredictiveLife> LimitGroup::predictive(
    const LimitedLives& lives, const std::optional<LimitedLives>& coarse) const {
  std::vector<QuantityQuantiles> errors;
  if (coarse) errors = answers(lives, coarse);
  std::vector<PredictiveLife> all;
  for (Remaining& each : remaining(lives)) {
    const auto one = std::make_shared<const Remaining>(std::move(each));
    all.push_back(
        {{[one](double x) { return one->cdf(x); }, [one](double p) { return one->quantile(p); }},
         one->survival});
    // Lives come first in the list of requests.
    if (coarse) all.back().numerical_error = errors[all.size() - 1].numerical_error;
  }
  return all;
}

// Start of the remaining useful life of a unit: its last row, or later.
double LimitGroup::begin_of(std::size_t u) const {
  return wishes_.survived ? std::max(path_->seen[u].now, path_->survived) : path_->seen[u].now;
}

void LimitGroup::add_life(const std::string& name, const std::string& of, const std::string& at,
                          const Unit& unit) {
  requests_.push_back(request(name, of, at, unit));
  requests_.back().is_life = true;
  requests_.back().safe_end = 0.05;
}

}  // namespace wearwell::formula_model
