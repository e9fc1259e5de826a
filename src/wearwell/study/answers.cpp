#include "wearwell/study/answers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string_view>

#include "wearwell/present/html.h"
#include "wearwell/present/table.h"
#include "wearwell/study/posterior_tables.h"

namespace wearwell {
namespace {

constexpr std::size_t most_headlines = 6;

// The life that is left to an item that was seen: "remaining useful life", not "B10 remaining
// useful life".
bool is_remaining(const QuantitySummary& each) {
  return each.is_life && each.name == "remaining useful life" && !each.of.starts_with("new ");
}

bool has_passed(const QuantitySummary& each) {
  return is_remaining(each) && each.best().q95 == 0;
}

// The parts of "to wear = 100 um, force = 20 N from 30 km on".
struct Course {
  std::string end, conditions, from;

  explicit Course(const std::string& at) {
    const std::size_t start = at.rfind(" from ");
    const bool counted = start != at.npos && at.ends_with(" on");
    if (counted) from = at.substr(start + 6, at.size() - start - 9);
    end = at.substr(0, counted ? start : at.size());
    if (end.starts_with("to ")) end = end.substr(3);
    const std::size_t comma = end.find(", ");
    if (comma == end.npos) return;
    conditions = end.substr(comma + 2);
    end.resize(comma);
  }
};

// Conditions after a name: "at 400 MPa" unchanged, "temperature = 10 degC" after "at".
std::string behind(const std::string& at) {
  if (at.empty()) return "";
  for (const char* word :
       {"at ", "to ", "for ", "after ", "in ", "over ", "under ", "from ", "until "})
    if (at.starts_with(word)) return " " + at;
  return " at " + at;
}

class Clauses {
 public:
  explicit Clauses(Script script) : script_(script) {}

  std::vector<std::string> all;

  void life(const PosteriorSummary& result) {
    const LifeSummary& summary = *result.life;
    const Life& life = summary.best();
    const std::string limit = given(summary.limit, summary.limit_unit);
    if (summary.passed_beyond_risk()) {
      all.push_back(fmt::format(
          "the limit of {} is already passed with a probability of {}; the tolerated risk is {}",
          limit, probability_text(life.passed), given(100 * summary.risk, "%")));
    }
    all.push_back(fmt::format(
        "the {}{} reaches {} after {} (median); {}, one in ten before {}", result.quantity,
        of_whom(summary), limit, lifetime(life.b50, summary.unit),
        interval(life.q05, life.q95, summary.unit, true), lifetime(life.b10, summary.unit)));
    if (std::isinf(life.inspect_within)) {
      all.push_back(
          fmt::format("no inspection is due: the risk of ever reaching the limit is below {}",
                      given(100 * summary.risk, "%")));
      return;
    }
    all.push_back(fmt::format(
        "inspect {} within {}{}: {} risk of reaching the limit before",
        summary.now > 0 ? "again" : "a new one", lifetime(life.inspect_within, summary.unit),
        life.passed > 0 && summary.now > 0 ? ", unless the limit is passed" : "",
        given(100 * summary.risk, "%")));
  }

  void passed(const std::vector<const QuantitySummary*>& items) {
    constexpr std::size_t most_named = 6;
    std::vector<std::string> names;
    for (const QuantitySummary* each : items) {
      if (names.size() < most_named) names.push_back(each->of);
    }
    std::string who = fmt::format("{}", fmt::join(names, ", "));
    if (items.size() > most_named) who += fmt::format(" and {} more", items.size() - most_named);
    const Course course(items.front()->at);
    all.push_back(fmt::format("{} {} already passed {}", who, items.size() == 1 ? "has" : "have",
                              numbers(course.end)));
  }

  void remaining(const QuantitySummary& each, bool is_first) {
    const QuantityQuantiles& q = each.best();
    const Course course(each.at);
    all.push_back(
        fmt::format("{} reaches {}{} in {} (median){}; {}, one in ten within {}{}", each.of,
                    numbers(course.end), is_first ? " first," : "", lifetime(q.q50, each.unit),
                    course.conditions.empty() ? "" : " at " + numbers(course.conditions),
                    interval(q.q05, q.q95, each.unit, true), lifetime(q.b10, each.unit),
                    course.from.empty() ? "" : "; counted from " + numbers(course.from) + " on"));
  }

  void headline(const QuantitySummary& each) {
    const QuantityQuantiles& q = each.best();
    const std::string of =
        each.of == "specimen" ? "" : " of " + item_text(each.of, each.is_bounded());
    const std::string name = numbers(each.name), at = numbers(behind(each.at));
    const std::string what = fmt::format("the {}{}{}", name, of, at);
    if (each.is_bounded()) {
      const std::string bounds = q.bound && q.upper_bound
                                     ? value(each, *q.bound) + " to " + value(each, *q.upper_bound)
                                 : q.bound ? "at least " + value(each, *q.bound)
                                           : "at most " + value(each, *q.upper_bound);
      all.push_back(fmt::format("{}{} is {} ({} confidence)", what,
                                at.find(", ") != at.npos ? "," : "", bounds,
                                given(100 * *each.credible_level, "%")));
    } else if (each.is_life && std::isinf(q.q50)) {
      all.push_back(fmt::format(
          "{} has no median: more than half never fail{}", what,
          std::isinf(q.q05) ? "" : ", one in twenty has less than " + value(each, q.q05)));
    } else if (each.is_life) {
      all.push_back(fmt::format("{} is {} (median); {}, one in ten has less than {}", what,
                                value(each, q.q50), interval(q.q05, q.q95, each.unit, true),
                                value(each, q.b10)));
    } else {
      const bool low = each.safe_end.value_or(0.05) < 0.5;
      all.push_back(fmt::format("design with a {} of {}{}{}, the {} 5 % (median {})", name,
                                value(each, low ? q.q05 : q.q95),
                                of.empty() ? "" : " for " + item_text(each.of), at,
                                low ? "lower" : "upper", value(each, q.q50)));
    }
  }

  void prediction(const PosteriorSummary& result) {
    const PredictionSummary& p = result.predictions.back();
    all.push_back(
        fmt::format("at {}{}{} the {}{} is {} (mean); {}", given_text(p.at, script_), hard_space,
                    p.at_word(), result.quantity, p.mean_of.empty() ? "" : " of the " + p.mean_of,
                    number(p.best().mean, p.unit), interval(p.best().ci05, p.best().ci95, p.unit)));
  }

  // Reports 10^x for a parameter x that is a decimal logarithm; quantiles transform with it.
  void parameter(const ParameterSummary& first) {
    const ExactSummary k = first.best();
    if (const auto natural = of_logarithm(first)) {
      all.push_back(
          fmt::format("{} is {}{}; {}", natural->meaning, number(natural->q50, natural->unit),
                      natural->meaning.find("median") == std::string::npos ? " (median)" : "",
                      interval(natural->q05, natural->q95, natural->unit)));
      return;
    }
    const ParameterValue shown = headline_value(k);
    all.push_back(fmt::format("the {} {} is {} ({}); {}", first.meaning, first.name,
                              number(shown.value, first.unit), shown.is_median ? "median" : "mean",
                              interval(k.q05, k.q95, first.unit)));
  }

 private:
  static constexpr const char* hard_space = "\u00a0";

  std::string joined(const std::string& text, const std::string& unit_text) const {
    const std::string u = unit_description(unit_text, script_);
    return u.empty() ? text : text + hard_space + u;
  }

  std::string numbers(const std::string& text) const { return numbers_text(text, script_); }

  std::string number(double x, const std::string& unit_text) const {
    return joined(shown_number(x, 3, script_), unit_text);
  }

  std::string given(double x, const std::string& unit_text) const {
    return joined(given_text(x, script_), unit_text);
  }

  // "18 200 to 26 600 cycles (90 %)"
  std::string interval(double low, double high, const std::string& unit_text,
                       bool is_life = false) const {
    const bool finite = std::isfinite(low) && std::isfinite(high);
    if (is_life && !finite)
      return fmt::format("{} to {} (90{}%)", lifetime(low, unit_text), lifetime(high, unit_text),
                         hard_space);
    return fmt::format("{} (90{}%)", joined(range_text(low, high, 3, script_), unit_text),
                       hard_space);
  }

  std::string lifetime(double x, const std::string& unit_text) const {
    if (std::isinf(x) && x > 0) return "never";
    return joined(description(x, life_format(unit_text, 3), script_), unit_text);
  }

  std::string value(const QuantitySummary& each, double x) const {
    const bool life = each.is_life || each.name.ends_with("life");
    return life ? lifetime(x, each.unit) : number(x, each.unit);
  }

  Script script_;
};

std::vector<const QuantitySummary*> chosen(const std::vector<QuantitySummary>& quantities,
                                           bool (*choose)(const QuantitySummary&)) {
  std::vector<const QuantitySummary*> found;
  for (const QuantitySummary& each : quantities) {
    if (choose(each)) found.push_back(&each);
  }
  return found;
}

// The observed item that is expected to fail first.
const QuantitySummary* first_to_fail(const std::vector<QuantitySummary>& quantities) {
  const QuantitySummary* first = nullptr;
  for (const QuantitySummary& each : quantities) {
    if (!is_remaining(each) || has_passed(each) || !(each.best().q50 >= 0)) continue;
    if (!first || each.best().q50 < first->best().q50) first = &each;
  }
  return first;
}

}  // namespace

std::optional<NaturalParameter> of_logarithm(const ParameterSummary& parameter) {
  constexpr std::string_view words = "logarithm of ", prefix = "log10(";
  const std::string& unit = parameter.unit;
  const bool has_unit = unit.starts_with(prefix) && unit.ends_with(')');
  if (!parameter.name.starts_with("log10_") || !parameter.meaning.starts_with(words) ||
      !(has_unit || unit == "1"))
    return {};
  const std::string meaning = parameter.meaning.substr(words.size());
  const ExactSummary x = parameter.best();
  return NaturalParameter{
      meaning, has_unit ? unit.substr(prefix.size(), unit.size() - prefix.size() - 1) : "1",
      std::pow(10, x.q05), std::pow(10, x.q50), std::pow(10, x.q95)};
}

ParameterValue headline_value(const ExactSummary& parameter) {
  const ExactSummary& p = parameter;
  const bool has_quantiles = p.q05 < p.q50 && p.q50 < p.q95;
  const double apart = std::abs(p.mean - p.q50);
  const bool skewed =
      has_quantiles && !(apart <= 0.1 * std::abs(p.q50)) && !(apart <= 0.05 * (p.q95 - p.q05));
  return skewed ? ParameterValue{p.q50, true} : ParameterValue{p.mean, false};
}

std::string item_text(const std::string& of, bool is_kind) {
  const auto begins = [&](const char* word) { return of.starts_with(word); };
  if (begins("new ")) return "a " + of;
  if (begins("median ")) return "the " + of;
  if (begins("my ") || begins("our ") || begins("the ") || begins("one ") || begins("unit "))
    return of;
  const bool has_label = of.find(' ') != of.npos && (!is_kind || begins("type "));
  return has_label ? of : "the " + of;
}

std::vector<const QuantitySummary*> headlines(const PosteriorSummary& result) {
  const auto marked = chosen(result.quantities, [](const auto& each) { return each.headline; });
  if (!marked.empty() || result.life) return marked;
  if (const QuantitySummary* first = first_to_fail(result.quantities)) return {first};
  for (auto each = result.quantities.rbegin(); each != result.quantities.rend(); ++each) {
    if (each->is_life && !has_passed(*each)) return {&*each};
  }
  return {};
}

std::string titled(const ParameterSummary& parameter) {
  if (parameter.meaning == meaning_not_stated) return parameter.name;
  if (parameter.meaning.ends_with("'s")) return parameter.meaning + " " + parameter.name;
  return parameter.name + ", " + parameter.meaning;
}

std::string of_whom(const LifeSummary& summary) {
  return summary.of.empty() ? "" : (summary.now > 0 ? " of " : " of a ") + summary.of;
}

std::vector<std::string> answers(const PosteriorSummary& result, Script script) {
  Clauses clauses(script);
  if (!result.nothing_seen.check.empty()) clauses.all.push_back(result.nothing_seen.clause);
  if (result.life) clauses.life(result);
  if (const auto passed = chosen(result.quantities, has_passed); !passed.empty())
    clauses.passed(passed);
  const auto first = headlines(result);
  const bool several = chosen(result.quantities, is_remaining).size() > 1;
  for (std::size_t i = 0; i < std::min(first.size(), most_headlines); ++i) {
    if (is_remaining(*first[i])) {
      clauses.remaining(*first[i], several);
    } else {
      clauses.headline(*first[i]);
    }
  }
  if (first.size() > most_headlines)
    clauses.all.push_back(fmt::format("{} more: see the table", first.size() - most_headlines));
  if (!result.predictions.empty()) clauses.prediction(result);
  if (!result.curve.empty()) {
    clauses.all.push_back(script == Script::page ? html::raised(result.curve) : result.curve);
  } else if (!result.parameters.empty()) {
    clauses.parameter(result.parameters.front());
  }
  return std::move(clauses.all);
}

std::string results_title(const std::vector<QuantitySummary>& quantities) {
  constexpr std::string_view next = "new ";
  for (const QuantitySummary& each : quantities) {
    if (each.of.starts_with(next)) return "Results by " + each.of.substr(next.size());
  }
  return "Results";
}

std::string default_priors(const std::vector<ParameterSummary>& parameters) {
  std::string names;
  for (const ParameterSummary& p : parameters) {
    if (p.prior_is_default) names += (names.empty() ? "" : ", ") + p.name;
  }
  return names;
}

std::string standard_error_text(const Loo& loo) {
  return loo.observations() < 2 ? "one observation, so no standard error"
                                : fmt::format("standard error {:.2f}", loo.se());
}

}  // namespace wearwell
