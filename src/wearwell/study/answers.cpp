#include "wearwell/study/answers.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/present/html.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/table.h"
#include "wearwell/study/posterior_tables.h"

namespace wearwell {
namespace {

constexpr std::size_t most_headlines = 6;

class Clauses {
 public:
  explicit Clauses(Wording wording) : page_(wording == Wording::page) {}

  std::vector<std::string> all;

  void life(const PosteriorSummary& result) {
    const LifeSummary& summary = *result.life;
    const Life& life = summary.best();
    const std::string limit = given(summary.limit, summary.limit_unit);
    if (summary.passed_beyond_risk()) {
      all.push_back(fmt::format(
          "the limit of {} is passed already with a probability of {}, more than the {} % that "
          "is tolerated",
          limit, probability_in_words(life.passed), given(100 * summary.risk, "1")));
    }
    all.push_back(fmt::format(
        "the {}{} reaches the limit of {} after about {} {} (90 % interval {}; one in ten before "
        "{})",
        result.quantity, of_whom(summary), limit, lifetime(life.b50, summary.unit),
        unit(summary.unit), lifetimes(life.q05, life.q95, summary.unit),
        lifetime(life.b10, summary.unit)));
    all.push_back(fmt::format("{}inspect {} within {} {}, at a risk of {} % of reaching it before",
                              life.passed > 0 ? "if it is not passed already, " : "",
                              summary.now > 0 ? "again" : "a new one",
                              lifetime(life.inspect_within, summary.unit), unit(summary.unit),
                              given(100 * summary.risk, "1")));
  }

  void headline(const QuantitySummary& each) {
    const QuantityQuantiles& q = each.best();
    const std::string of = each.of == "specimen" ? "" : (q.bound ? " of the " : " of a ") + each.of;
    const std::string what =
        fmt::format("the {}{}{}{}", each.name, of, each.at.empty() ? "" : " ", each.at);
    if (q.bound) {
      all.push_back(fmt::format("{} is at least {}, with {} % confidence", what,
                                value(each, *q.bound), given(100 * *each.credible_level, "1")));
    } else if (each.is_life) {
      all.push_back(fmt::format(
          "{} is {} in the median (90 % interval {} to {}), and one in ten has less than {}", what,
          value(each, q.q50), lifetime(q.q05, each.unit), lifetime(q.q95, each.unit),
          value(each, q.b10)));
    } else {
      const bool low = each.safe_end.value_or(0.05) < 0.5;
      all.push_back(fmt::format("{} is {} in the median; design with {}, the {} 5 %", what,
                                value(each, q.q50), value(each, low ? q.q05 : q.q95),
                                low ? "lower" : "upper"));
    }
  }

  void prediction(const PosteriorSummary& result) {
    const PredictionSummary& p = result.predictions.back();
    all.push_back(
        fmt::format("at {} {} the {}{} is {} (90 % interval {})", given(p.at, "1"), p.at_word(),
                    result.quantity, p.mean_of.empty() ? "" : " of the " + p.mean_of,
                    number(p.best().mean, p.unit), range(p.best().ci05, p.best().ci95, p.unit)));
  }

  void parameter(const ParameterSummary& first) {
    const ExactSummary k = first.best();
    all.push_back(fmt::format("the {} {} is {} (90 % interval {})", first.meaning, first.name,
                              number(k.mean, first.unit), range(k.q05, k.q95, first.unit)));
  }

 private:
  std::string unit(const std::string& text) const {
    if (page_) return html::unit(text);
    return text == "1" ? "" : text.starts_with("1e") ? "x " + text : text;
  }

  std::string joined(const std::string& text, const std::string& unit_text) const {
    const std::string u = unit(unit_text);
    return u.empty() ? text : text + (page_ ? "\u00a0" : " ") + u;
  }

  std::string number(double x, const std::string& unit_text) const {
    return page_ ? html::quantity(x, unit_text, 3) : joined(plain_number(x, 3), unit_text);
  }

  std::string given(double x, const std::string& unit_text) const {
    return joined(page_ ? html::given(x) : fmt::format("{:.9g}", x), unit_text);
  }

  std::string range(double low, double high, const std::string& unit_text) const {
    return joined(page_ ? html::range(low, high, 3)
                        : fmt::format("{} to {}", plain_number(low, 3), plain_number(high, 3)),
                  unit_text);
  }

  std::string lifetime(double x, const std::string& unit_text) const {
    if (std::isinf(x) && x > 0) return "never";
    return page_ ? present::in_words(x, life_format(unit_text, 3)) : plain_number(x, 3);
  }

  std::string lifetimes(double low, double high, const std::string& unit_text) const {
    return page_ && std::isfinite(low) && std::isfinite(high)
               ? html::range(low, high, 3)
               : lifetime(low, unit_text) + " to " + lifetime(high, unit_text);
  }

  std::string value(const QuantitySummary& each, double x) const {
    const bool life = each.is_life || each.name.ends_with("life");
    return joined(life ? lifetime(x, each.unit) : (page_ ? html::number(x, 3) : plain_number(x, 3)),
                  each.unit);
  }

  bool page_;
};

}  // namespace

std::vector<const QuantitySummary*> headlines(const PosteriorSummary& result) {
  std::vector<const QuantitySummary*> found;
  for (const QuantitySummary& each : result.quantities) {
    if (each.headline) found.push_back(&each);
  }
  if (!found.empty() || result.life) return found;
  for (auto each = result.quantities.rbegin(); each != result.quantities.rend(); ++each) {
    if (each->is_life) return {&*each};
  }
  return found;
}

std::string of_whom(const LifeSummary& summary) {
  return summary.of.empty() ? "" : (summary.now > 0 ? " of " : " of a ") + summary.of;
}

std::vector<std::string> answers(const PosteriorSummary& result, Wording wording) {
  Clauses clauses(wording);
  if (!result.nothing_seen.check.empty()) clauses.all.push_back(result.nothing_seen.clause);
  if (result.life) clauses.life(result);
  const auto first = headlines(result);
  for (std::size_t i = 0; i < std::min(first.size(), most_headlines); ++i)
    clauses.headline(*first[i]);
  if (first.size() > most_headlines)
    clauses.all.push_back(fmt::format("{} more: see the table", first.size() - most_headlines));
  if (!result.predictions.empty()) clauses.prediction(result);
  if (!result.curve.empty()) {
    clauses.all.push_back(wording == Wording::page ? html::raised(result.curve) : result.curve);
  } else if (!result.parameters.empty()) {
    clauses.parameter(result.parameters.front());
  }
  return std::move(clauses.all);
}

std::string default_priors(const std::vector<ParameterSummary>& parameters) {
  std::string names;
  for (const ParameterSummary& p : parameters) {
    if (p.prior_is_default) names += (names.empty() ? "" : ", ") + p.name;
  }
  return names;
}

std::string standard_error_in_words(const Loo& loo) {
  return loo.observations() < 2 ? "of one observation without a standard error"
                                : fmt::format("standard error {:.2f}", loo.se());
}

}  // namespace wearwell
