#include "wearwell/plan/demonstrate.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/plan/demonstration_result.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell::plan {
namespace {

using Json = nlohmann::ordered_json;

std::string pass_rule(std::size_t allowed) {
  return allowed == 0 ? "none fails" : fmt::format("at most {} fail", allowed);
}

std::string life_text(const DemonstrationGoal& goal, double time) {
  const std::string unit = goal.goal.unit.text == "1" ? "" : " " + goal.goal.unit.text;
  return plain_number(goal.shown(time)) + unit;
}

// The first plan in a sentence.
std::string plan_sentence(const Demonstration& result) {
  const DemonstrationPlan& plan = result.plans.front();
  const std::string specimens =
      fmt::format("{} specimen{}", plain_given(present::count(plan.test.specimens)),
                  plan.test.specimens == 1 ? "" : "s");
  const std::string time = life_text(result.goal, plan.test.time);
  if (result.sought == Sought::confidence)
    return fmt::format("{} tested for {} each show it with {:.4g} % confidence if {}: {}.",
                       specimens, time, 100 * plan.confidence, pass_rule(plan.test.allowed),
                       plan.confidence >= result.goal.confidence * (1 - 1e-12)
                           ? fmt::format("enough for {:.6g} %", 100 * result.goal.confidence)
                           : fmt::format("too few for {:.6g} %", 100 * result.goal.confidence));
  return fmt::format("Test {} for {} each. The test passes if {}.", specimens, time,
                     pass_rule(plan.test.allowed));
}

// What the shape, or its prior, does.
std::string shape_sentence(const Demonstration& result) {
  const DemonstrationGoal& goal = result.goal;
  const DemonstrationPlan& plan = result.plans.front();
  if (!goal.spread) {
    if (goal.time && *goal.time > 1)
      return "Without --shape a test counts as one of the life to show, however much longer it is.";
    return "Each specimen is tested for the life to show; the distribution of lives has no part "
           "(success run, Clopper and Pearson 1934).";
  }
  if (std::abs(plan.test.time - 1) < 1e-12)
    return fmt::format(
        "Tests as long as the life to show need no {0}: it only sets the probability to pass.",
        goal.spread_name());
  if (!goal.spread->uncertain)
    return fmt::format(
        "This rests on the {} {}, which the test does not check. {}", goal.spread_name(),
        goal.spread->text,
        plan.test.time > 1
            ? fmt::format("Tests longer than the life to show need more specimens if "
                          "the {} is {}.",
                          goal.weibull() ? "true shape" : "true sigma",
                          goal.weibull() ? "smaller" : "larger")
            : fmt::format("Tests shorter than the life to show need more specimens "
                          "if the {} is {}.",
                          goal.weibull() ? "true shape" : "true sigma",
                          goal.weibull() ? "larger" : "smaller"));
  const auto said = [&](const std::optional<double>& value) {
    if (!value) return std::string("no plan");
    return result.sought == Sought::specimens ? fmt::format("{} specimens", plain_given(*value))
           : result.sought == Sought::time    ? life_text(goal, *value)
                                              : fmt::format("{:.4g} % confidence", 100 * *value);
  };
  std::string text = fmt::format(
      "The prior's part: the confidence is averaged over the {0}. With {0} {1:.4g} (5 % quantile) "
      "the answer would be {2}, with {3:.4g} (95 %) {4}.",
      goal.spread_name(), goal.spread->at(z05), said(plan.low), goal.spread->at(z95),
      said(plan.high));
  if (plan.posterior)
    text += fmt::format(
        " After a test without failure the posterior probability of the goal is {:.4g} %, with a "
        "flat prior of -log reliability.",
        100 * *plan.posterior);
  return text;
}

std::string exposure_sentence(const Demonstration& result) {
  if (!result.plans.front().exposure) return {};
  return fmt::format(
      "By exposure (Weibayes, chi-square): the goal is also shown as soon as the sum of "
      "(t/life)^shape over all specimens, failed ones included, reaches {} with no more failures "
      "than are allowed.",
      plain_number(*result.plans.front().exposure));
}

Json demonstration_json(const Demonstration& result) {
  const DemonstrationGoal& goal = result.goal;
  static constexpr const char* soughts[] = {"specimens", "time", "confidence"};
  const auto number = [](const std::optional<double>& x) { return x ? Json(*x) : Json(); };
  const auto sought = [&](const std::optional<double>& x) {
    return x && result.sought == Sought::time ? Json(goal.shown(*x)) : number(x);
  };
  Json json = {{"question", "demonstrate"},
               {"goal", goal_json(goal)},
               {"sought", soughts[static_cast<int>(result.sought)]}};
  for (const DemonstrationPlan& plan : result.plans) {
    Json each = {{"failures", plan.test.allowed},
                 {"specimens", plan.test.specimens},
                 {"time", goal.shown(plan.test.time)},
                 {"confidence", plan.confidence},
                 {"enough", plan.confidence >= goal.confidence * (1 - 1e-12)}};
    each[goal.spread ? "passes_90_if_life" : "passes_90_if_reliability"] =
        goal.spread ? goal.shown(plan.passing) : 1 - plan.passing;
    if (goal.spread && goal.spread->uncertain) {
      each["at_q05"] = sought(plan.low);
      each["at_q95"] = sought(plan.high);
      each["posterior"] = number(plan.posterior);
    }
    if (plan.exposure) {
      each["exposure"] = *plan.exposure;
      each["by_exposure"] = sought(plan.by_exposure);
    }
    json["plans"].push_back(std::move(each));
  }
  json["probability_to_pass"] = Json::array();
  for (const LifePoint& truth : true_lives(goal)) {
    Json each = {{"true", truth.text}, {"probability", Json::array()}};
    for (const DemonstrationPlan& plan : result.plans)
      each["probability"].push_back(pass_probability(
          plan.test, goal.scatter, truth.failing, goal.spread ? truth.life / goal.goal.life : 1));
    json["probability_to_pass"].push_back(std::move(each));
  }
  json["sample_against_time"] = Json::array();
  for (const SampleAgainstTime& row : result.sample_sizes) {
    Json each = {{"specimens", row.specimens}, {"time", Json::array()}};
    for (const auto& time : row.times)
      each["time"].push_back(time ? Json(goal.shown(*time)) : Json());
    json["sample_against_time"].push_back(std::move(each));
  }
  return json;
}

std::vector<present::Section> demonstration_sections(const Demonstration& result) {
  present::Section plan{"plan", "Plan"};
  plan.add(present::Prose{plan_sentence(result), true});
  plan.add(present::Prose{html::capital(goal_text(result.goal)) + "; " + scatter_text(result.goal) +
                          "."});
  plan.add(present::Prose{shape_sentence(result)});
  plan.add(present::Figures{{sample_size_figure(result), characteristic_figure(result)}});
  plan.add(plans_table(result));
  if (const std::string text = exposure_sentence(result); !text.empty())
    plan.add(present::Prose{text});
  present::Section passing{"passing", "Probability to pass"};
  passing.add(pass_table(result));
  std::vector<present::Section> sections = {plan, passing};
  if (!result.sample_sizes.empty()) {
    present::Section sample{"sample-size", "Sample size against time"};
    sample.add(sample_size_table(result));
    sections.push_back(sample);
  }
  return sections;
}

std::string demonstration_text(const Demonstration& result) {
  const DemonstrationGoal& goal = result.goal;
  std::string text =
      "Show " + wrapped(printable(goal.goal.text), 0, 2) + wrapped(goal_text(goal), 2, 4) +
      wrapped(printable(scatter_text(goal)), 2, 4) + "\n" + wrapped(plan_sentence(result), 0, 2) +
      wrapped(printable(shape_sentence(result)), 2, 2) + "\n" + present::text(plans_table(result));
  if (const std::string exposure = exposure_sentence(result); !exposure.empty())
    text += wrapped(exposure, 2, 2);
  text += "\n" + present::text(pass_table(result));
  if (!result.sample_sizes.empty() && !goal.specimens && !goal.time)
    text += "\n" + present::text(sample_size_table(result));
  return text;
}

}  // namespace

Answer demonstrate(const DemonstrateQuestion& question) {
  const DemonstrationGoal goal = read_demonstration(question);
  if (goal.groups) return sudden_death_answer(goal);
  const Demonstration result = demonstration_of(goal);
  return {"Show " + goal.goal.text, demonstration_text(result), demonstration_sections(result),
          demonstration_json(result)};
}

}  // namespace wearwell::plan
