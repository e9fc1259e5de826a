#include "wearwell/models/formula_model/life_at_point.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/mean_beyond.h"
#include "wearwell/prob/mean_residual_life.h"

namespace wearwell::formula_model {
namespace {

using LifeRule = boost::math::quadrature::gauss_kronrod<double, 31>;
constexpr unsigned deepest_cut = 12;

// How far the life in the middle may move from one node to the next, as a share of the units that fail by then.
constexpr double farthest_step = 0.2;
// Nodes that hold less do not decide on the rule.
constexpr double least_deciding = 1e-5;

}  // namespace

double log_survival_of(std::span<const Risk> risks, double life, const double* family_parameters) {
  double sum = 0;
  for (std::size_t r = 0; r < risks.size(); ++r)
    sum += risks[r].life.log_survival(life, family_parameters + r * most_response_parameters);
  return sum;
}

// Several risks are plain families.
std::size_t parameters_of(std::span<const Risk> risks) {
  return risks.size() == 1 ? risks.front().life.parameters()
                           : risks.size() * most_response_parameters;
}

LifeAtPoint::LifeAtPoint(std::span<const Risk> risks)
    : risks_(risks),
      positive_(risks.front().positive),
      model_(*risks.front().family_parameters->model),
      nodes_(model_.effects.size(), 6.5),
      new_units_(model_),
      stride_(parameters_of(risks)),
      varied_(risks.front().family_parameters->varied.get()) {
  for (const Risk& each : risks) paths_.emplace_back(*each.family_parameters);
  if (varied_) {
    rule_ = &varied_->rules.front();
    varied_at_.assign(rule_->columns, std::vector<double>(Path::most));
    z_.resize(Path::most * model_.effects.size());
  }
  family_parameters_.resize(stride_ * size());
}

void LifeAtPoint::move_to(const double* x) {
  check_stop();
  if (!varied_) return fill(x);
  for (const ConditionNodes& rule : varied_->rules) {
    rule_ = &rule;
    family_parameters_.resize(stride_ * size());
    fill(x);
    resolved_ = is_fine();
    if (resolved_) return;
  }
}

// Nodes of the effects under each condition, new unit by new unit.
void LifeAtPoint::fill(const double* x) {
  const std::size_t d = model_.effects.size(), effects = nodes_.weight.size(),
                    count = effects * conditions();
  std::vector<const double*> varied;
  for (const std::vector<double>& each : varied_at_) varied.push_back(each.data());
  for (std::size_t k = 0; k < new_units_.count(); ++k) {
    const double* const there = new_units_.at(k, x, model_.parameters.size());
    for (std::size_t r = 0; r < risks_.size(); ++r) {
      paths_[r].move_to(there);
      for (std::size_t at = 0; at < count; at += Path::most) {
        const std::size_t n = std::min(Path::most, count - at);
        for (std::size_t i = 0; varied_ && i < n; ++i) {
          const std::size_t effect = (at + i) % effects, condition = (at + i) / effects;
          std::copy_n(nodes_.z.begin() + static_cast<std::ptrdiff_t>(effect * d), d,
                      z_.begin() + static_cast<std::ptrdiff_t>(i * d));
          for (std::size_t c = 0; c < varied.size(); ++c)
            varied_at_[c][i] = rule_->at[condition * varied.size() + c];
        }
        const double* const z = d == 0 ? nullptr : varied_ ? z_.data() : &nodes_.z[at * d];
        paths_[r].evaluate(n, z, nullptr, varied);
        for (std::size_t i = 0; i < n; ++i) {
          double* const own =
              &family_parameters_[(k * count + at + i) * stride_ + r * most_response_parameters];
          for (std::size_t o = 0; o < risks_[r].places.size(); ++o)
            own[risks_[r].places[o]] = paths_[r].output(o, i);
        }
      }
    }
  }
}

double LifeAtPoint::weight(std::size_t i) const {
  const std::size_t count = nodes_.weight.size();
  if (!rule_) return nodes_.weight[i % count] * new_units_.share(i / count);
  const std::size_t among = i / count;
  return nodes_.weight[i % count] * rule_->share[among % rule_->count()] *
         new_units_.share(among / rule_->count());
}

// In the middle of the effects, along the last condition and then along the first. Between values of a list there are
// no units, so that their lives need not overlap.
bool LifeAtPoint::is_fine() const {
  const std::size_t effects = nodes_.weight.size(), count = rule_->count();
  const auto own = [&](std::size_t condition, std::size_t r) {
    return slots(condition * effects + effects / 2, r);
  };
  const auto overlap = [&](std::size_t a, std::size_t b) {
    for (std::size_t r = 0; r < risks_.size(); ++r) {
      const LifeMixture& life = risks_[r].life;
      const double here = life.middle(own(a, r)), there = life.middle(own(b, r));
      const double moved =
          std::exp(life.log_cdf(there, own(a, r))) - std::exp(life.log_cdf(here, own(a, r)));
      const double all = life.failing(own(a, r)) - life.dead_share(own(a, r));
      if (std::abs(moved) > farthest_step * all) return false;
    }
    return true;
  };
  const std::size_t columns = rule_->columns;
  for (std::size_t i = 0; i < count; ++i) {
    if (rule_->share[i] < least_deciding) continue;
    if (rule_->drawn.back() && i + 1 < count &&
        (columns == 1 || rule_->at[i * columns] == rule_->at[(i + 1) * columns]) &&
        !overlap(i, i + 1))
      return false;
    if (columns == 1 || !rule_->drawn.front()) continue;
    const double* const at = &rule_->at[i * columns];
    for (std::size_t j = i + 1; j < count; ++j) {  // the next with the same last condition
      const double* const next = &rule_->at[j * columns];
      if (next[columns - 1] != at[columns - 1]) continue;
      if (!overlap(i, j)) return false;
      break;
    }
  }
  return true;
}

std::optional<double> LifeAtPoint::undefined_condition() const {
  for (std::size_t i = 0; rule_ && i < size(); ++i) {
    for (std::size_t r = 0; r < risks_.size(); ++r) {
      for (const std::size_t place : risks_[r].places) {
        if (!std::isfinite(slots(i, r)[place]))
          return rule_->at[(i / nodes_.weight.size()) % rule_->count() * rule_->columns];
      }
    }
  }
  return {};
}

double LifeAtPoint::log_survival(std::size_t component, double life) const {
  return log_survival_of(risks_, life, slots(component));
}

double LifeAtPoint::log_density(std::size_t component, double life) const {
  if (risks_.size() == 1) return risks_.front().life.log_density(life, slots(component));
  double hazard = 0;
  for (std::size_t r = 0; r < risks_.size(); ++r) {
    const double* const own = slots(component, r);
    hazard +=
        std::exp(risks_[r].life.log_density(life, own) - risks_[r].life.log_survival(life, own));
  }
  return std::log(hazard) + log_survival(component, life);
}

double LifeAtPoint::cdf(double life) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    sum += weight(i) * (risks_.size() == 1 ? std::exp(risks_.front().life.log_cdf(life, slots(i)))
                                           : -std::expm1(log_survival(i, life)));
  }
  return sum;
}

double LifeAtPoint::log_survival(double life) const {
  double most = -infinity, sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double term = log_survival(i, life);
    if (size() == 1) return term;
    if (term > most) {
      sum = sum * std::exp(most - term) + weight(i);
      most = term;
    } else if (term != -infinity) {
      sum += weight(i) * std::exp(term - most);
    }
  }
  return most + std::log(sum);
}

double LifeAtPoint::log_density(double life) const {
  double density = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double term = log_density(i, life);
    if (size() == 1) return term;
    density += weight(i) * std::exp(term);
  }
  return std::log(density);
}

double LifeAtPoint::hazard(double life) const {
  return std::exp(log_density(life) - log_survival(life));
}

double LifeAtPoint::quantile(double p) const {
  if (single()) return risks_.front().life.quantile(p, slots(0));
  if (!risks_.front().life.plain()) {
    if (p <= dead_share()) return 0;
    if (p >= failing()) return infinity;
    return quantile_of_cdf([&](double life) { return cdf(life); }, p,
                           risks_.front().life.middle(slots(size() / 2)), positive_);
  }
  const auto earliest = [&](double share) {
    double least = infinity;
    for (std::size_t r = 0; r < risks_.size(); ++r)
      least = std::min(least, risks_[r].life.quantile(share, slots(size() / 2, r)));
    return least;
  };
  const auto failed = [&](double life) { return cdf(life); };
  if (risks_.size() == 1) return quantile_of_cdf(failed, p, earliest(0.5), positive_);
  // Before `least` each of m risks leaves at least the m-th root of 1 - p; at `most` one has ended p alone.
  const double root = -std::expm1(std::log1p(-p) / static_cast<double>(risks_.size()));
  const double least = earliest(root), most = earliest(p);
  if (!(least > 0) || !std::isfinite(most))
    return quantile_of_cdf(failed, p, earliest(0.5), positive_);
  const double half = 0.5 * std::log(most / least);
  return quantile_of_cdf(failed, p, std::sqrt(least) * std::sqrt(most), positive_, half + 1e-9);
}

double LifeAtPoint::middle() const {
  if (single()) return risks_.front().life.middle(slots(0));
  return quantile(0.5 * (dead_share() + failing()));
}

double LifeAtPoint::failing() const {
  if (single()) return risks_.front().life.failing(slots(0));
  if (risks_.front().life.plain()) return 1;
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) sum += weight(i) * risks_.front().life.failing(slots(i));
  return sum;
}

double LifeAtPoint::dead_share() const {
  if (single()) return risks_.front().life.dead_share(slots(0));
  if (risks_.front().life.plain()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i)
    sum += weight(i) * risks_.front().life.dead_share(slots(i));
  return sum;
}

double LifeAtPoint::share_among_survivors(std::size_t k, double life) const {
  const LifeMixture& mixture = risks_.front().life;
  if (single()) return mixture.share_among_survivors(k, life, slots(0));
  double of_k = 0, all = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double left = weight(i) * std::exp(mixture.log_survival(life, slots(i)));
    of_k += left * mixture.share_among_survivors(k, life, slots(i));
    all += left;
  }
  return of_k / all;
}

double LifeAtPoint::failing_within(double age, double use) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i)
    sum += weight(i) * risks_.front().life.failing_within(age, use, slots(i));
  return sum;
}

double LifeAtPoint::mean_beyond(double from) const {
  if (single() && risks_.front().life.plain()) {
    const auto closed = mean_residual_life(risks_.front().life.families.front(), from, slots(0));
    if (closed) return *closed;
  }
  if (failing() < 1 - 1e-12) return infinity;
  // Of those that are not dead on arrival; these count as lives of 0.
  const double works = 1 - dead_share();
  const double mean = wearwell::mean_beyond(
      [&, log_works = std::log(works)](double life) { return log_survival(life) - log_works; },
      middle(), from);
  return from > 0 ? mean : works * mean;
}

double LifeAtPoint::share_of_mean_beyond(double from, double life) const {
  if (!(life > from)) return 1;
  const double all = mean_beyond(from);
  if (all == infinity) return 1;
  const double left = std::exp(log_survival(life) - (from > 0 ? log_survival(from) : 0));
  return left > 0 ? left * (life - from + mean_beyond(life)) / all : 0;
}

double LifeAtPoint::outlives(const LifeAtPoint& other) const {
  constexpr double tail = 1e-10;
  // Those of the other that are dead on arrival end at 0.
  const double dead = other.dead_share();
  const double at_once = dead > 0 ? dead * std::exp(log_survival(0)) : 0;
  const double ending = other.failing() - dead;
  const double low = other.quantile(dead + tail * ending),
               high = other.quantile(dead + (1 - tail) * ending);
  if (!(low < high)) return at_once + ending * std::exp(log_survival(low));  // all have one life
  const bool logarithmic = positive_ && low > 0;
  const auto integrand = [&](double at) {
    const double life = logarithmic ? std::exp(at) : at;
    return std::exp(other.log_density(life) + log_survival(life) + (logarithmic ? at : 0));
  };
  // The rule adapts, because the integrand is a peak of any width.
  return at_once + (logarithmic ? LifeRule::integrate(integrand, std::log(low), std::log(high),
                                                      deepest_cut, 1e-8)
                                : LifeRule::integrate(integrand, low, high, deepest_cut, 1e-8));
}

double LifeAtPoint::incidence(std::size_t risk, double life) const {
  // What is left out at the ends, relative to the share of this risk alone.
  constexpr double before = 1e-9, beyond = 1e-13;
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double* const own = slots(i, risk);
    const double alone = std::exp(risks_[risk].life.log_cdf(life, own));
    if (!(alone > 0)) continue;
    double end = life;
    for (std::size_t r = 0; r < risks_.size(); ++r)
      end = std::min(end, risks_[r].life.quantile(1 - beyond, slots(i, r)));
    const double begin = std::max(risks_[risk].life.quantile(before * alone, own), 1e-300);
    if (!(end > begin)) continue;
    const auto density = [&](double log_life) {
      const double here = std::exp(log_life);
      double log_share = risks_[risk].life.log_density(here, own) + log_life;
      for (std::size_t r = 0; r < risks_.size(); ++r)
        if (r != risk) log_share += risks_[r].life.log_survival(here, slots(i, r));
      return std::exp(log_share);
    };
    sum +=
        weight(i) * LifeRule::integrate(density, std::log(begin), std::log(end), deepest_cut, 1e-7);
  }
  return sum;
}

}  // namespace wearwell::formula_model
