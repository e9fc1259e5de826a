#include "wearwell/infer/loo.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// Over observations: their number, the sum of a value and the sum of squared deviations from its
// mean.
struct Sums {
  double n = 0, sum = 0, scatter = 0;
};
template <class Value>
Sums sums_of(std::size_t terms, const Value& value, const auto& count) {
  Sums sums;
  for (std::size_t i = 0; i < terms; ++i) {
    sums.n += count(i);
    sums.sum += count(i) * value(i);
  }
  for (std::size_t i = 0; i < terms; ++i) {
    sums.scatter += count(i) * std::pow(value(i) - sums.sum / sums.n, 2);
  }
  return sums;
}

// sqrt(n) times the standard deviation.
double standard_error(const Sums& sums) {
  return std::sqrt(sums.n * sums.scatter / (sums.n - 1));
}

}  // namespace

double Loo::observations() const {
  double n = 0;
  for (const LooTerm& term : terms) n += term.count;
  return n;
}

double Loo::elpd() const {
  double sum = 0;
  for (const LooTerm& term : terms) sum += term.count * term.elpd;
  return sum;
}

double Loo::se() const {
  return standard_error(sums_of(
      terms.size(), [&](std::size_t i) { return terms[i].elpd; },
      [&](std::size_t i) { return terms[i].count; }));
}

double Loo::p_loo() const {
  double sum = 0;
  for (const LooTerm& term : terms) sum += term.count * (term.lpd - term.elpd);
  return sum;
}

double Loo::khat_max() const {
  double highest = -infinity;
  for (const LooTerm& term : terms) highest = std::max(highest, term.khat);
  return highest;
}

bool Loo::doubtful(const LooTerm& term) const {
  return !term.refitted && !(term.khat <= threshold);
}

Check loo_check(const Loo& loo, const std::string& noun, int parameters) {
  Findings findings("leave-one-out");
  if (!(loo.p_loo() <= p_loo_warns_above(parameters))) {
    findings.add(loo.p_loo() <= p_loo_fails_above(parameters) ? Verdict::warn : Verdict::fail,
                 fmt::format("the effective number of parameters, {:.4g}, is much larger than the "
                             "number of parameters, {}",
                             loo.p_loo(), parameters),
                 fmt::format("The model does not describe some {}, or the computation failed: "
                             "examine the residuals and the digits of the data.",
                             noun));
  }
  std::vector<std::string> doubtful, refitted;
  for (std::size_t i = 0; i < loo.terms.size(); ++i) {
    const LooTerm& term = loo.terms[i];
    const std::string name = fmt::format("{} {} ({:.2f})", noun, i + 1, term.khat);
    if (term.refitted) refitted.push_back(name);
    if (loo.doubtful(term)) doubtful.push_back(name);
  }
  constexpr std::size_t most_named = 8;
  const auto list = [&](std::vector<std::string> names) {
    const std::size_t all = names.size();
    names.resize(std::min(all, most_named));
    return fmt::format("{}{}", fmt::join(names, ", "),
                       all > most_named ? fmt::format(" and {} more", all - most_named) : "");
  };
  if (!doubtful.empty()) {
    findings.add(Verdict::warn,
                 fmt::format("leaving out one observation changes the posterior too much to "
                             "estimate its prediction from the draws: Pareto k above {:.2f} for {}",
                             loo.threshold, list(doubtful)),
                 fmt::format("Do not compare models by elpd here; check each such {} for an error, "
                             "or whether the model does not describe it.",
                             noun));
  }
  return findings.result(
      refitted.empty()
          ? fmt::format("Pareto k at most {:.2f} (up to {:.2f} is good)", loo.khat_max(),
                        loo.threshold)
          : fmt::format("Pareto k above {:.2f} for {}: refitted without each, by quadrature",
                        std::min(loo.threshold, refit_above), list(refitted)));
}

ElpdDifference elpd_difference(std::span<const LooTerm> a, std::span<const LooTerm> b) {
  const auto alike = [](const LooTerm& x, const LooTerm& y) { return x.count == y.count; };
  if (!std::equal(a.begin(), a.end(), b.begin(), b.end(), alike)) {
    throw std::invalid_argument("elpd of different observations");
  }
  const Sums sums = sums_of(
      a.size(), [&](std::size_t i) { return a[i].elpd - b[i].elpd; },
      [&](std::size_t i) { return a[i].count; });
  return {sums.sum, standard_error(sums)};
}

}  // namespace wearwell
